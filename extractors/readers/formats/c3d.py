"""C3D: markers, and bodies from ROTATION data."""

from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model.capture import Stream
from capar.model.errors import FileError
from extractors.readers.files import read_bytes, source_of
from extractors.readers.formats.c3d_layout import BLOCK, Layout, read_layout, reals
from extractors.readers.formats.qualisys import rotation_quaternions
from extractors.readers.recording import UNITS, Recording, track, uniform_clock

_ROTATION = 17
"""Numbers a rotation: a matrix of 4 x 4 by columns, and its reliability."""


def recognises(path: Path, head: bytes) -> bool:
    """Whether the second byte is the format's own, and the parameters name a processor."""
    if len(head) < 512 or head[1] != 0x50 or head[0] == 0:
        return False
    processor = (head[0] - 1) * BLOCK + 3
    return processor >= len(head) or head[processor] in {84, 85, 86}


def read(path: Path, options: Any) -> Recording:
    """Markers and bodies; a residual of -1 or a NaN is a missing sample.

    Raises:
        FileError: Counts and sizes in the file contradict each other, or it is cut short.
    """
    data = read_bytes(path)
    layout = read_layout(path, data)
    markers = _markers(path, data, layout) if layout.points else {}
    unit = (layout.texts("POINT", "UNITS") or [""])[0].lower()
    return Recording(
        source=source_of(path, "c3d"),
        bodies=_bodies(path, data, layout),
        markers=markers,
        marker_times=uniform_clock(layout.frames if markers else 0, layout.rate_hz),
        unit_m=UNITS.get(unit),
    )


def _labels(path: Path, layout: Layout, group: str, count: int) -> list[str]:
    """Labels with their continuations (LABELS2 ...), and a number where there is none."""
    given = layout.texts(group, "LABELS")
    for number in range(2, 2 + count // 255 + 1):
        given = given + layout.texts(group, f"LABELS{number}")
    names = [each or f"point{n}" for n, each in enumerate(given[:count])]
    names += [f"point{n}" for n in range(len(names), count)]
    twice = sorted({each for each in names if names.count(each) > 1})
    if twice:
        raise FileError(path, f"two of {group} are called {twice[0]!r}.")
    return names


def _markers(path: Path, data: bytes, layout: Layout) -> dict[str, Float[np.ndarray, "frames 3"]]:
    width = layout.points * 4 + layout.analogs
    size = layout.frames * width * (4 if layout.scale < 0.0 else 2)
    part = data[layout.data_start : layout.data_start + size]
    if layout.scale < 0.0:
        values = reals(part, layout.order, vax=layout.vax)
    else:
        values = np.frombuffer(part, f"{layout.order}i2").astype(float)
    frames = values.reshape(layout.frames, width)[:, : layout.points * 4]
    points = frames.reshape(layout.frames, layout.points, 4)
    places = points[..., :3] * (1.0 if layout.scale < 0.0 else layout.scale)
    places = np.where((points[..., 3] < 0.0)[..., None], np.nan, places)
    names = _labels(path, layout, "POINT", layout.points)
    return {name: np.array(places[:, index]) for index, name in enumerate(names)}


def _bodies(path: Path, data: bytes, layout: Layout) -> dict[str, Stream]:
    """Bodies of 4x4 matrices, at a whole multiple of the markers' rate."""
    count = int(layout.numbers("ROTATION", "USED", 0.0))
    ratio = max(1, int(layout.numbers("ROTATION", "RATIO", 1.0)))
    start = (int(layout.numbers("ROTATION", "DATA_START", 0.0)) - 1) * BLOCK
    if count == 0:
        return {}
    frames = layout.frames * ratio
    size = frames * count * _ROTATION * 4
    if start < BLOCK or start + size > len(data):
        raise FileError(path, f"promises {frames} frames of {count} rotations and ends before.")
    values = reals(data[start : start + size], layout.order, vax=layout.vax)
    table = values.reshape(frames, count, _ROTATION)
    times = uniform_clock(frames, layout.rate_hz * ratio)
    names = _labels(path, layout, "ROTATION", count)
    return {name: _body(name, times, table[:, index]) for index, name in enumerate(names)}


def _body(
    name: str, times: Float[np.ndarray, "frames"], values: Float[np.ndarray, "frames 17"]
) -> Stream:
    poses = values[:, :16].reshape(-1, 4, 4).transpose(0, 2, 1)
    lost = ~np.isfinite(poses).all(axis=(1, 2)) | (poses[:, :3, :3] == 0.0).all(axis=(1, 2))
    lost |= values[:, 16] < 0.0
    orientations = np.full((len(poses), 4), np.nan)
    orientations[~lost] = rotation_quaternions(name, poses[~lost, :3, :3])
    positions = np.where(lost[:, None], np.nan, poses[:, :3, 3])
    return track(name, times, positions, orientations)
