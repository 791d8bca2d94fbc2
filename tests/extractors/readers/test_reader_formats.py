"""Every format gives back the motion that was written, and refuses what is cut short."""

import gzip
import lzma
from pathlib import Path

import motion_files as samples
import numpy as np
import pytest

from capar.model import geometry
from capar.model.errors import CaparError, FileError
from extractors.readers.registry import read_recording

KINDS = sorted(samples.WRITERS)


def written(kind: str, folder: Path) -> Path:
    name, write = samples.WRITERS[kind]
    return write(folder / name)


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_gives_back_the_motion_that_was_written(kind: str, tmp_path: Path) -> None:
    recording = read_recording(written(kind, tmp_path), options=samples.options(kind))
    unit = recording.unit_m or (0.01 if kind == "bvh" else 1.0)
    assert np.allclose(recording.times - recording.times[0], samples.TIMES, atol=1e-6)
    if recording.markers:
        assert list(recording.markers) == list(samples.NAMES)
        points = np.stack(list(recording.markers.values()), axis=1) * unit
        assert np.allclose(points, samples.markers(), atol=1e-6)
    else:
        body = next(iter(recording.bodies.values()))
        assert np.allclose(body.positions * unit, samples.PLACES, atol=1e-6)
        turns = samples.TURNS.as_quat(scalar_first=True)
        assert np.degrees(geometry.angle_between(body.orientations, turns)).max() < 1e-3


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_file_is_does_not_depend_on_its_suffix(kind: str, tmp_path: Path) -> None:
    path = written(kind, tmp_path)
    if kind == "bag":
        pytest.skip("the library that reads bags goes by the suffix .bag")
    recording = read_recording(path, options=samples.options(kind))
    other = path.rename(tmp_path / "motion.dat")
    assert read_recording(other, options=samples.options(kind)).format == recording.format


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_cut_short_is_refused(kind: str, tmp_path: Path) -> None:
    path = written(kind, tmp_path)
    data = path.read_bytes()
    for share in (0.3, 0.8):
        path.write_bytes(data[: int(len(data) * share)])
        with pytest.raises(CaparError, match=str(path)):
            recording = read_recording(path, options=samples.options(kind))
            raise AssertionError(f"{kind} at {share}: {len(recording.times)} frames")


@pytest.mark.parametrize("pack", [gzip.compress, lzma.compress])
@pytest.mark.parametrize("kind", ["bvh", "csv", "tsv", "trc", "motive", "nexus", "json"])
def test_text_is_read_through_gzip_and_xz(kind: str, pack, tmp_path: Path) -> None:
    path = written(kind, tmp_path)
    plain = read_recording(path)
    path.write_bytes(pack(path.read_bytes()))
    packed = read_recording(path)
    assert packed.format == plain.format
    assert np.array_equal(packed.times, plain.times)


@pytest.mark.parametrize(("storage", "suffix"), [("SQLITE3", "db3"), ("MCAP", "mcap")])
def test_a_ros2_bag_is_read_from_its_folder_and_from_its_file(
    storage: str, suffix: str, tmp_path: Path
) -> None:
    path = samples.write_bag2(tmp_path / "bag2", storage=storage)
    (file,) = path.glob(f"*.{suffix}")
    alone = tmp_path / f"alone.{suffix}"
    alone.write_bytes(file.read_bytes())
    for place in (path, file, alone):
        body = read_recording(place).bodies["hand"]
        assert np.allclose(body.positions, samples.PLACES)


def test_missing_points_are_lost_frames(tmp_path: Path) -> None:
    path = samples.write_tsv(tmp_path / "m.tsv")
    lines = path.read_text().splitlines()
    cells = lines[-3].split("\t")
    lines[-3] = "\t".join(["0", "0", "0", *cells[3:]])
    path.write_text("\n".join(lines))
    points = read_recording(path).markers["a"]
    assert list(np.flatnonzero(np.isnan(points[:, 0]))) == [samples.FRAMES - 3]


def test_an_invalid_sample_of_a_table_is_lost(tmp_path: Path) -> None:
    path = samples.write_csv(tmp_path / "m.csv")
    path.write_text(path.read_text().replace(",1\n", ",0\n", 1))
    assert list(np.flatnonzero(read_recording(path).bodies["hand"].lost)) == [0]


def test_c3d_is_read_as_the_reference_library_reads_it() -> None:
    import ezc3d

    path = samples.recordings_folder() / "pyomeca_box_lift" / "markers_analogs.c3d"
    theirs = ezc3d.c3d(str(path))
    ours = read_recording(path)
    assert list(ours.markers) == theirs["parameters"]["POINT"]["LABELS"]["value"]
    points = np.stack(list(ours.markers.values()), axis=1)
    assert np.allclose(points.transpose(2, 1, 0), theirs["data"]["points"][:3], equal_nan=True)


def test_rotation_data_of_a_c3d_makes_bodies(tmp_path: Path) -> None:
    path = samples.write_c3d_rotations(tmp_path / "r.c3d")
    recording = read_recording(path)
    body = recording.bodies["hand"]
    assert np.allclose(body.positions, samples.PLACES, atol=1e-6)
    turns = samples.TURNS.as_quat(scalar_first=True)
    assert np.degrees(geometry.angle_between(body.orientations, turns)).max() < 0.05
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(FileError, match="rotations and ends before"):
        read_recording(path)
