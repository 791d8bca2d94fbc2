"""Time stamps that were rounded to milliseconds are read as the steady clock that made them."""

from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from extractors.readers.recording import unrounded
from extractors.readers.registry import read_recording

HEADER = (
    "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
    "{rate}\t{rate}\t{frames}\t1\tmm\n"
    "Frame#\tTime\tC7\t\t\n\t\tX1\tY1\tZ1\n\n"
)


def _clock(rate_hz: float, frames: int, first: int) -> np.ndarray:
    return (first + np.arange(frames)) / rate_hz


@given(st.sampled_from([30.0, 60.0, 119.88, 120.0]), st.integers(3, 400), st.integers(0, 10_000))
def test_rounding_to_milliseconds_is_taken_back(rate_hz: float, frames: int, first: int) -> None:
    true = _clock(rate_hz, frames, first)
    times = unrounded(np.round(true, 3), rate_hz)
    assert np.allclose(np.diff(times), 1.0 / rate_hz, atol=1e-9)
    assert np.abs(times - true).max() < 0.0012


def test_a_trc_of_60_hz_is_read_as_60_hz(tmp_path: Path) -> None:
    times = np.round(_clock(60.0, 50, 184), 3)
    rows = "\n".join(f"{n}\t{t:.3f}\t1\t2\t3" for n, t in enumerate(times, 185))
    path = tmp_path / "walk.trc"
    path.write_text(HEADER.format(rate="60.00", frames=50) + rows + "\n")
    read = read_recording(path).marker_times
    assert np.allclose(np.diff(read), 1.0 / 60.0)
    assert read[0] == times[0]
