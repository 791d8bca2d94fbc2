"""A C3D says the same in the numbers of every processor that it may be written on."""

import struct
from pathlib import Path

import numpy as np
import pytest

from extractors.readers.registry import read_recording

PLACES_MM = np.array([[[1.0, -2.5, 900.0]], [[1.5, -2.0, 901.0]], [[2.5, 1e-3, 902.5]]])
RATE_HZ = 100.0
PC, DEC, SGI = 84, 85, 86


def written(values: np.ndarray, processor: int) -> bytes:
    """Real numbers as a processor stores them."""
    if processor == DEC:
        halves = (4.0 * values).astype("<f4").reshape(-1).view("<u2").reshape(-1, 2)
        return halves[:, ::-1].tobytes()
    return values.astype(">f4" if processor == SGI else "<f4").tobytes()


def write(path: Path, processor: int) -> Path:
    """A C3D of one point, with real numbers."""
    order = ">" if processor == SGI else "<"

    def entry(name: str, kind: int, sizes: list[int], data: bytes) -> bytes:
        body = struct.pack("bB", kind, len(sizes)) + bytes(sizes) + data + b"\0"
        step = struct.pack(f"{order}h", len(body) + 2)
        return struct.pack("bb", len(name), 1) + name.encode() + step + body

    section = bytes([1, 0x50, 1, processor])
    section += b"\x05\xffPOINT" + struct.pack(f"{order}hB", 3, 0)
    section += entry("USED", 2, [], struct.pack(f"{order}H", 1))
    section += entry("RATE", 4, [], written(np.array([RATE_HZ]), processor))
    section += entry("UNITS", -1, [2], b"mm") + entry("LABELS", -1, [4, 1], b"hand")
    header = bytes([2, 0x50]) + struct.pack(f"{order}5H", 1, 0, 1, len(PLACES_MM), 0)
    header += written(np.array([-1.0]), processor) + struct.pack(f"{order}2H", 3, 0)
    header += written(np.array([RATE_HZ]), processor)
    rows = np.concatenate([PLACES_MM, np.zeros((len(PLACES_MM), 1, 1))], axis=2)
    path.write_bytes(
        header.ljust(512, b"\0") + section.ljust(512, b"\0") + written(rows, processor)
    )
    return path


@pytest.mark.parametrize("processor", [PC, DEC, SGI])
def test_points_and_times_are_those_that_were_written(processor: int, tmp_path: Path) -> None:
    recording = read_recording(write(tmp_path / "m.c3d", processor))
    assert np.allclose(recording.times, np.arange(len(PLACES_MM)) / RATE_HZ)
    found = recording.markers["hand"] * 1e3 * float(recording.unit_m or 1.0)
    assert np.allclose(found, PLACES_MM[:, 0], rtol=1e-6)
