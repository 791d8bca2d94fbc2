"""C3D: markers, and bodies from ROTATION data."""

import math
import re
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model.capture import Stream
from capar.model.errors import FileError
from extractors.readers.file_access import read_bytes, source_of
from extractors.readers.recording import UNITS, Recording, track_of_matrices, uniform_clock

BLOCK = 512
_ORDERS = {84: "<", 85: "<", 86: ">"}
_NAME = re.compile(r"[A-Z0-9_ ]+")
_ROTATION = 17  # Numbers a rotation: a matrix of 4 x 4 by columns, and its reliability.

Value = list[str] | np.ndarray


@dataclass(frozen=True)
class Layout:
    """What the header and the parameters say."""

    points: int
    analogs: int
    """Analog values in a frame, all channels and samples."""

    frames: int
    data_start: int
    """Offset of the first frame [B]."""

    rate_hz: float
    scale: float
    """Negative where points are stored as real numbers."""

    order: str
    vax: bool
    parameters: Mapping[tuple[str, str], Value]

    def number(self, group: str, name: str, default: float) -> float:
        """The first number of a parameter."""
        value = self.parameters.get((group, name))
        return float(value[0]) if isinstance(value, np.ndarray) and value.size else default

    def texts(self, group: str, name: str) -> list[str]:
        """The strings of a parameter."""
        value = self.parameters.get((group, name), [])
        return value if isinstance(value, list) else []


def reals(data: bytes, order: str, *, vax: bool) -> np.ndarray:
    """Real numbers of 4 bytes, of which a VAX swaps the halves and counts exponents from 2 more."""
    if not vax:
        return np.frombuffer(data, order + "f4").astype(float)
    words = np.frombuffer(data, "<u2").reshape(-1, 2)[:, ::-1]
    return np.ascontiguousarray(words).view("<f4").ravel().astype(float) / 4.0


def recognises(path: Path, head: bytes) -> bool:
    """Whether the second byte is the format's own, and the parameters name a processor."""
    if len(head) < BLOCK or head[1] != 0x50 or head[0] == 0:
        return False
    processor = (head[0] - 1) * BLOCK + 3
    return processor >= len(head) or head[processor] in _ORDERS


def read(path: Path, options: Any) -> Recording:
    """Markers and bodies; a residual of -1 or a NaN is a missing sample.

    Raises:
        FileError: Counts and sizes in the file contradict each other, or it is cut short.
    """
    data = read_bytes(path)
    layout = _layout(path, data)
    markers = _markers(path, data, layout) if layout.points else {}
    unit = (layout.texts("POINT", "UNITS") or [""])[0].lower()
    return Recording(
        source=source_of(path, "c3d"),
        bodies=_bodies(path, data, layout),
        markers=markers,
        marker_times=uniform_clock(layout.frames if markers else 0, layout.rate_hz),
        unit_m=UNITS.get(unit),
    )


def _layout(path: Path, data: bytes) -> Layout:
    """The header and parameters, checked against each other and the file's length."""
    start = (data[0] - 1) * BLOCK
    if len(data) < max(start + 4, BLOCK) or data[start + 3] not in _ORDERS:
        raise FileError(path, "is cut short before its parameters.", "Export it again.")
    order, vax = _ORDERS[data[start + 3]], data[start + 3] == 85
    end = start + data[start + 2] * BLOCK
    if end == start or end > len(data):
        raise FileError(path, f"promises {data[start + 2]} blocks of parameters and ends before.")
    parameters = _parameters(path, data[start:end], order, vax)
    points, analogs, first, last = struct.unpack_from(f"{order}4H", data, 2)
    scale, rate = (float(reals(data[at : at + 4], order, vax=vax)[0]) for at in (12, 20))
    (block,) = struct.unpack_from(f"{order}H", data, 16)
    count, start = last - first + 1, (block - 1) * BLOCK
    layout = Layout(points, analogs, count, start, rate, scale, order, vax, parameters)
    if last == 65535:  # 16 bits do not hold long trials
        frames = max(count, int(layout.number("POINT", "FRAMES", count)))
        layout = Layout(points, analogs, frames, start, rate, scale, order, vax, parameters)
    used = layout.number("POINT", "USED", -1.0)
    if used != points:
        raise FileError(path, f"counts {points} points in its header and {used:g} in POINT:USED.")
    needed = layout.frames * (points * 4 + analogs) * (4 if scale < 0.0 else 2)
    if start < BLOCK or layout.frames <= 0 or needed > len(data) - start:
        raise FileError(
            path,
            f"promises {layout.frames} frames of {points} points ({needed} bytes) and has "
            f"room for {max(len(data) - start, 0)} bytes.",
            "It is cut short; copy or export it again.",
        )
    return layout


def _parameters(path: Path, data: bytes, order: str, vax: bool) -> dict[tuple[str, str], Value]:
    """Every parameter by its group's and its own name."""

    def part(at: int, size: int) -> bytes:
        if at + size > len(data):
            raise FileError(path, "has a parameter that reaches beyond its section.")
        return data[at : at + size]

    def value(at: int, name: str) -> Value:
        kind, ranks = struct.unpack("bB", part(at, 2))
        if kind not in {-1, 1, 2, 4} or ranks > 7:
            raise FileError(path, f"has parameter {name!r} of unknown kind {kind}.")
        sizes = list(part(at + 2, ranks))
        own = part(at + 2 + ranks, math.prod(sizes) * abs(kind))
        if kind == -1:
            width = sizes[0] if sizes else 1
            rows = range(0, len(own), width) if width else range(0)
            return [own[n : n + width].decode("latin-1").strip(" \0") for n in rows]
        if kind == 4:
            return reals(own, order, vax=vax)
        return np.frombuffer(own, "u1" if kind == 1 else f"{order}u2").astype(float)

    groups: dict[int, str] = {}
    found: list[tuple[int, str, Value]] = []
    at = 4
    while at + 2 <= len(data):
        length, number = struct.unpack_from("bb", data, at)
        if length == 0 or number == 0:
            break
        end = at + 2 + abs(length)
        name = part(at + 2, abs(length)).decode("latin-1").upper()
        if length == -128 or not _NAME.fullmatch(name):
            raise FileError(path, f"has a parameter called {name[:20]!r}; it is damaged.")
        (step,) = struct.unpack(f"{order}h", part(end, 2))
        if number < 0:
            groups[-number] = name
        else:
            found.append((number, name, value(end + 2, name)))
        if step <= 0:
            break
        at = end + step
    return {(groups.get(number, ""), name): each for number, name, each in found}


def _labels(path: Path, layout: Layout, group: str, count: int) -> list[str]:
    """Labels with their continuations (LABELS2 ...), and a number where there is none."""
    given = layout.texts(group, "LABELS")
    for number in range(2, 2 + count // 255 + 1):
        given = given + layout.texts(group, f"LABELS{number}")
    given = [*given, *[""] * count][:count]
    names = [each or f"point{n}" for n, each in enumerate(given)]
    twice = sorted({each for each in names if names.count(each) > 1})
    if twice:
        raise FileError(path, f"two of {group} are called {twice[0]!r}.")
    return names


def _markers(path: Path, data: bytes, layout: Layout) -> dict[str, Float[np.ndarray, "frames 3"]]:
    real, width = layout.scale < 0.0, layout.points * 4 + layout.analogs
    size = layout.frames * width * (4 if real else 2)
    part = data[layout.data_start : layout.data_start + size]
    if real:
        values = reals(part, layout.order, vax=layout.vax)
    else:
        values = np.frombuffer(part, f"{layout.order}i2").astype(float)
    frames = values.reshape(layout.frames, width)[:, : layout.points * 4]
    points = frames.reshape(layout.frames, layout.points, 4)
    places = points[..., :3] * (1.0 if real else layout.scale)
    places = np.where((points[..., 3] < 0.0)[..., None], np.nan, places)
    names = _labels(path, layout, "POINT", layout.points)
    return {name: np.array(places[:, index]) for index, name in enumerate(names)}


def _bodies(path: Path, data: bytes, layout: Layout) -> dict[str, Stream]:
    """Bodies of 4x4 matrices, at a whole multiple of the markers' rate."""
    count = int(layout.number("ROTATION", "USED", 0.0))
    ratio = max(1, int(layout.number("ROTATION", "RATIO", 1.0)))
    start = (int(layout.number("ROTATION", "DATA_START", 0.0)) - 1) * BLOCK
    if count == 0:
        return {}
    frames = layout.frames * ratio
    size = frames * count * _ROTATION * 4
    if start < BLOCK or start + size > len(data):
        raise FileError(path, f"promises {frames} frames of {count} rotations and ends before.")
    values = reals(data[start : start + size], layout.order, vax=layout.vax)
    table = values.reshape(frames, count, _ROTATION)
    times = uniform_clock(frames, layout.rate_hz * ratio)
    out = {}
    for index, name in enumerate(_labels(path, layout, "ROTATION", count)):
        poses = table[:, index, :16].reshape(-1, 4, 4).transpose(0, 2, 1)
        lost = (table[:, index, 16] < 0.0) | ~np.isfinite(poses).all(axis=(1, 2))
        out[name] = track_of_matrices(name, times, poses[:, :3, 3], poses[:, :3, :3], lost)
    return out
