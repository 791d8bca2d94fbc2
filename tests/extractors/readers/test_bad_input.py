"""Motion and meshes that no one should trust are refused in words."""

import json
import time
import zipfile
from pathlib import Path

import motion_files as samples
import numpy as np
import pytest

from capar.model.errors import CaparError, CaptureError, FileError
from extractors.readers.bundle.shapes import MESH_LIMIT, read_mesh
from extractors.readers.file_access import EXPANDED_LIMIT
from extractors.readers.registry import read_recording


def test_time_that_goes_back_is_told_with_its_frame(tmp_path: Path) -> None:
    path = samples.write_csv(tmp_path / "m.csv")
    lines = path.read_text().splitlines()
    lines[5], lines[6] = lines[6], lines[5]
    path.write_text("\n".join(lines))
    with pytest.raises(CaptureError, match=r"time goes from .* at frame 5"):
        read_recording(path)


def test_a_quaternion_that_is_not_unit_is_told_with_its_body(tmp_path: Path) -> None:
    path = samples.write_csv(tmp_path / "m.csv")
    lines = path.read_text().splitlines()
    cells = lines[4].split(",")
    cells[7] = "1.7"
    lines[4] = ",".join(cells)
    path.write_text("\n".join(lines))
    with pytest.raises(CaptureError, match=r"m\.csv.*'hand'.*norm"):
        read_recording(path)


def test_a_matrix_that_is_a_reflection_is_told(tmp_path: Path) -> None:
    path = samples.write_json(tmp_path / "m.json")
    data = json.loads(path.read_text())
    for each in data:
        each["rotation"] = (np.array(each["rotation"]) @ np.diag([1, 1, -1])).tolist()
    path.write_text(json.dumps(data))
    with pytest.raises(CaptureError, match="reflection"):
        read_recording(path)


def test_a_count_that_no_file_could_hold_is_refused_at_once(tmp_path: Path) -> None:
    path = samples.write_bvh(tmp_path / "m.bvh")
    text = path.read_text().replace(f"Frames: {samples.FRAMES}", "Frames: 1000000000000")
    path.write_text(text)
    start = time.monotonic()
    with pytest.raises(FileError, match="states 1e"):
        read_recording(path)
    assert time.monotonic() - start < 2.0


def test_an_archive_that_promises_more_than_it_holds_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "m.npz"
    header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000, 3), }"
    header += b" " * (128 - 10 - len(header) - 1) + b"\n"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("p.npy", b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header)
    with pytest.raises(FileError, match="promises"):
        read_recording(path, options=samples.NPZ)


def test_arrays_of_objects_are_never_unpickled(tmp_path: Path) -> None:
    path = tmp_path / "m.npz"
    np.savez(path, names=np.array([{"a": 1}], dtype=object))
    with pytest.raises(FileError, match="Python objects"):
        read_recording(path, options=samples.NPZ)


def test_a_zip_bomb_is_refused_before_it_is_expanded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert EXPANDED_LIMIT <= 1 << 30
    motion = samples.zip_bomb(tmp_path / "m.npz", "p.npy", 1100)
    model = samples.zip_bomb(tmp_path / "m.3mf", "3D/3dmodel.model", (MESH_LIMIT >> 20) + 1)
    start = time.monotonic()
    with pytest.raises(FileError, match="would expand to"):
        read_recording(motion, options=samples.NPZ)
    with pytest.raises(FileError, match="would expand to"):
        read_mesh(model)
    assert time.monotonic() - start < 2.0


ENTITIES = b"""<?xml version="1.0"?><!DOCTYPE lolz [<!ENTITY lol "lol"><!ENTITY l2 "&lol;&lol;">]>
<COLLADA>&l2;</COLLADA>"""


@pytest.mark.parametrize("name", ["m.dae", "m.x3d", "m.3mf"])
def test_xml_entities_are_never_expanded(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    if name.endswith(".3mf"):
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("3D/3dmodel.model", ENTITIES)
    else:
        path.write_bytes(ENTITIES)
    with pytest.raises(FileError, match="never expanded"):
        read_mesh(path)


def test_a_mesh_that_is_damaged_missing_or_of_no_known_kind_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.stl").write_bytes(b"solid nothing\n")
    (tmp_path / "a.ply").write_bytes(
        b"ply\nformat binary_little_endian 1.0\nelement vertex 999999\n"
    )
    (tmp_path / "a.doc").write_bytes(b"x")
    for name in ("a.stl", "a.ply", "a.doc", "none.stl"):
        with pytest.raises(CaparError, match=name):
            read_mesh(tmp_path / name)


@pytest.mark.parametrize("rest", ["", "\n", "\n\n\n"])
def test_a_table_without_rows_is_said_to_hold_no_frames(rest: str, tmp_path: Path) -> None:
    path = samples.write_csv(tmp_path / "m.csv")
    path.write_text(path.read_text().splitlines()[0] + rest)
    with pytest.raises(FileError, match=r"m\.csv: holds no frames"):
        read_recording(path)
