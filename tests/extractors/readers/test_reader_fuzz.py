"""Whatever bytes a file holds, only our own errors come out, and soon."""

import contextlib
import time
from pathlib import Path

import motion_files as samples
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from capar.model.errors import CaparError
from extractors.readers.bundle.mesh import read_mesh
from extractors.readers.registry import read_recording

EDITS = st.lists(
    st.tuples(
        st.floats(0.0, 1.0, exclude_max=True),
        st.sampled_from(["set", "cut", "insert"]),
        st.binary(min_size=1, max_size=4),
    ),
    min_size=1,
    max_size=6,
)
QUICK = settings(
    max_examples=60,
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


@pytest.mark.parametrize("kind", sorted(samples.WRITERS))
@QUICK
@given(edits=EDITS)
def test_a_damaged_file_of_motion_raises_nothing_but_our_own_errors(
    kind: str, edits: list[tuple[float, str, bytes]], tmp_path: Path
) -> None:
    name, write = samples.WRITERS[kind]
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
