"""Whatever bytes a file holds, only our own errors come out, and soon."""

import contextlib
import time
import tomllib
from pathlib import Path
from typing import Any

import demonstration_files
import motion_files as samples
import pytest
from combinations import EVERY
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from capar.model.errors import CaparError
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.bundle.shapes import read_mesh
from extractors.readers.registry import read_recording
from extractors.readers.schema.capture import CaptureFile
from extractors.readers.schema.entry import Location, line_numbers, validated
from extractors.readers.schema.reference import TABLES

EDITS = st.lists(
    st.tuples(
        st.floats(0.0, 1.0, exclude_max=True),
        st.sampled_from(["set", "cut", "insert"]),
        st.binary(min_size=1, max_size=4),
    ),
    min_size=1,
    max_size=6,
)
FILES = {**samples.WRITERS, "hdf5": ("m.hdf5", demonstration_files.write)}
WORDS = sorted({name for kind in TABLES.values() for name in kind.model_fields})
QUICK = settings(
    max_examples=60 if EVERY else 20,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def edited(data: bytes, edits: list[tuple[float, str, bytes]]) -> bytes:
    """Data with bytes overwritten, cut out or put in at shares of its length."""
    out = bytearray(data)
    for share, how, text in edits:
        at = int(share * len(out))
        width = {"set": len(text), "cut": len(text), "insert": 0}[how]
        out[at : at + width] = b"" if how == "cut" else text
    return bytes(out)


@pytest.mark.parametrize("kind", sorted(FILES))
@QUICK
@given(edits=EDITS)
def test_a_damaged_file_of_motion_raises_nothing_but_our_own_errors(
    kind: str, edits: list[tuple[float, str, bytes]], tmp_path: Path
) -> None:
    name, write = FILES[kind]
    whole = tmp_path / f"whole_{name}"
    if not whole.exists():
        write(whole)
    path = tmp_path / name
    path.write_bytes(edited(whole.read_bytes(), edits))
    start = time.monotonic()
    with contextlib.suppress(CaparError):
        read_recording(path, options=samples.options(kind))
    assert time.monotonic() - start < 5.0


@pytest.mark.parametrize("kind", ["stl", "ply", "obj", "off", "glb"])
@QUICK
@given(edits=EDITS)
def test_a_damaged_mesh_raises_nothing_but_our_own_errors(
    kind: str, edits: list[tuple[float, str, bytes]], tmp_path: Path
) -> None:
    import trimesh

    whole = tmp_path / f"whole.{kind}"
    if not whole.exists():
        trimesh.creation.box().export(whole)
    path = tmp_path / f"m.{kind}"
    path.write_bytes(edited(whole.read_bytes(), edits))
    start = time.monotonic()
    with contextlib.suppress(CaparError):
        read_mesh(path)
    assert time.monotonic() - start < 5.0


CAPTURE = """takes = ["m", { take = "n", side = "left" }]
unit = "m"
up = "y"
rate_hz = 60
[files]
motion = { path = "{take}.csv", order = "xyzw" }
[agent]
measures = { stature = 1.7 }
[[sensor]]
name = "right_hand"
end_effector = "hand"
body = "hand"
offset = { position = [0, 0, 0.1] }
shape = { parts = [{ sphere = 0.05 }, { capsules = "children", radius_m = 0.02 }] }
[[objects_from]]
file = "motion"
touched_by = "right_hand"
touched_within_m = 0.1
[objects_from.kinds]
hand = { name = "thing", tag = "mobile", shape = { box = [0.1, 0.1, 0.1] } }
[[object]]
name = "table"
tag = "fixed"
top_at_bottom_of = "thing"
at_s = 0.1
shape = { cylinder = [0.4, 0.02] }
[[purpose]]
purpose = "PutDown"
goal = "table"
"""


def test_the_capture_toml_to_be_damaged_is_right(tmp_path: Path) -> None:
    samples.write_csv(tmp_path / "m.csv")
    (tmp_path / "capture.toml").write_text(CAPTURE)
    assert len(read_capture(f"{tmp_path}:m").objects) == 2


@settings(QUICK, max_examples=300 if EVERY else 100)
@given(edits=EDITS)
def test_a_damaged_capture_toml_raises_nothing_but_our_own_errors(
    edits: list[tuple[float, str, bytes]], tmp_path: Path
) -> None:
    samples.write_csv(tmp_path / "m.csv")
    (tmp_path / "capture.toml").write_bytes(edited(CAPTURE.encode(), edits))
    with contextlib.suppress(CaparError):
        read_capture(f"{tmp_path}:m")


VALUES = st.recursive(
    st.one_of(st.text(max_size=5), st.integers(-9, 9), st.floats(), st.booleans()),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(st.sampled_from([*WORDS, "x"]), inner, max_size=4),
    ),
    max_leaves=8,
)


@settings(QUICK, max_examples=300 if EVERY else 100)
@given(path=st.lists(st.integers(0, 20), min_size=1, max_size=5), value=VALUES)
def test_a_value_of_any_type_anywhere_is_read_or_told_with_its_line(
    path: list[int], value: object
) -> None:
    data = tomllib.loads(CAPTURE)
    place: Any = data
    for index in path:
        keys = list(place) if isinstance(place, dict) else list(range(len(place)))
        if not keys:
            break
        key = keys[index % len(keys)]
        if not isinstance(place[key], dict | list) or index == path[-1]:
            place[key] = value
            break
        place = place[key]
    with contextlib.suppress(CaparError):
        validated(CaptureFile, data, Location(Path("capture.toml"), line_numbers(CAPTURE)))
