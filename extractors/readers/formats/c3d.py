"""C3D: markers, and bodies from ROTATION data."""

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
from extractors.readers.files import read_bytes, source_of
from extractors.readers.formats.qualisys import rotation_quaternions
from extractors.readers.recording import UNITS, Recording, track, uniform_clock

BLOCK = 512
_ORDERS = {84: "<", 85: "<", 86: ">"}
_NAME = re.compile(r"[A-Z0-9_ ]+")

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

    def numbers(self, group: str, name: str, default: float) -> float:
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


def read_layout(path: Path, data: bytes) -> Layout:
    """The header and parameters.

    Raises:
        FileError: They contradict each other or the file's length.
    """
    start = (data[0] - 1) * BLOCK
    if len(data) < max(start + 4, BLOCK) or data[start + 3] not in _ORDERS:
        raise FileError(path, "is cut short before its parameters.", "Export it again.")
    order, vax = _ORDERS[data[start + 3]], data[start + 3] == 85
    end = start + data[start + 2] * BLOCK
    if end == start or end > len(data):
        raise FileError(path, f"promises {data[start + 2]} blocks of parameters and ends before.")
    parameters = _Section(path, data[start:end], order, vax).walk()
    points, analogs, first, last = struct.unpack_from(f"{order}4H", data, 2)
    scale, rate = (float(reals(data[at : at + 4], order, vax=vax)[0]) for at in (12, 20))
    (block,) = struct.unpack_from(f"{order}H", data, 16)
    frames = _frames(parameters, first, last)
    layout = Layout(
        points, analogs, frames, (block - 1) * BLOCK, rate, scale, order, vax, parameters
    )
    _check(path, data, layout)
    return layout


def _frames(parameters: Mapping[tuple[str, str], Value], first: int, last: int) -> int:
    """The number of frames; the header's 16 bits do not hold long trials."""
    count = last - first + 1
    stated = parameters.get(("POINT", "FRAMES"))
    if last == 65535 and isinstance(stated, np.ndarray) and stated.size:
        return max(count, int(stated[0]))
    return count


def _check(path: Path, data: bytes, layout: Layout) -> None:
    used = layout.numbers("POINT", "USED", -1.0)
    if used != layout.points:
        raise FileError(
            path, f"counts {layout.points} points in its header and {used:g} in POINT:USED."
        )
    width = 4 if layout.scale < 0.0 else 2
    needed = layout.frames * (layout.points * 4 + layout.analogs) * width
    room = len(data) - layout.data_start
    if layout.data_start < BLOCK or layout.frames <= 0 or needed > room:
        raise FileError(
            path,
            f"promises {layout.frames} frames of {layout.points} points ({needed} bytes) and has "
            f"room for {max(room, 0)} bytes.",
            "It is cut short; copy or export it again.",
        )


@dataclass(frozen=True)
class _Section:
    """The bytes of the parameters."""

    path: Path
    data: bytes
    order: str
    vax: bool

    def walk(self) -> dict[tuple[str, str], Value]:
        """Every parameter by its group's and its own name."""
        groups: dict[int, str] = {}
        found: list[tuple[int, str, Value]] = []
        at = 4
        while at + 2 <= len(self.data):
            length, number = struct.unpack_from("bb", self.data, at)
            if length == 0 or number == 0:
                break
            end = at + 2 + abs(length)
            name = self._part(at + 2, abs(length)).decode("latin-1").upper()
            if length == -128 or not _NAME.fullmatch(name):
                raise FileError(self.path, f"has a parameter called {name[:20]!r}; it is damaged.")
            (step,) = struct.unpack(f"{self.order}h", self._part(end, 2))
            if number < 0:
                groups[-number] = name
            else:
                found.append((number, name, self._value(end + 2, name)))
            if step <= 0:
                break
            at = end + step
        return {(groups.get(number, ""), name): value for number, name, value in found}

    def _part(self, at: int, size: int) -> bytes:
        if at + size > len(self.data):
            raise FileError(self.path, "has a parameter that reaches beyond its section.")
        return self.data[at : at + size]

    def _value(self, at: int, name: str) -> Value:
        kind, ranks = struct.unpack("bB", self._part(at, 2))
        sizes = list(self._part(at + 2, ranks)) if ranks <= 7 else []
        if kind not in {-1, 1, 2, 4} or ranks > 7:
            raise FileError(self.path, f"has parameter {name!r} of unknown kind {kind}.")
        count = 1
        for size in sizes:
            count *= size
        data = self._part(at + 2 + ranks, count * abs(kind))
        if kind == -1:
            width = sizes[0] if sizes else 1
            rows = range(0, len(data), width) if width else range(0)
            return [data[n : n + width].decode("latin-1").strip(" \0") for n in rows]
        if kind == 4:
            return reals(data, self.order, vax=self.vax)
        return np.frombuffer(data, {1: "u1", 2: f"{self.order}u2"}[kind]).astype(float)


_ROTATION = 17  # Numbers a rotation: a matrix of 4 x 4 by columns, and its reliability.


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
