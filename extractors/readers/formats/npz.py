"""NPZ: arrays whose meaning capture.toml states."""

import math
import re
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from numpy.lib import format as npy

from capar.model.capture import Source
from capar.model.errors import FileError, UnknownNameError
from extractors.readers.file_access import EXPANDED_LIMIT, check_zip, source_of
from extractors.readers.formats.csv_table import ORDERS
from extractors.readers.recording import (
    ROTATIONS,
    Recording,
    check_rate,
    quaternions_of,
    track,
    uniform_clock,
)

OPTIONS = frozenset({"arrays", "time", "fps", "rate_hz"})
"""``arrays``: a list of ``{positions, quaternions | rotations, order, names | body}``; ``time``:
the array of seconds; ``fps``: the array that holds the rate; ``rate_hz``: the rate itself."""

NAMING = ("positions", "quaternions", "rotations")
"""The keys of a group that name arrays, or parts of them."""


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file is a zip archive of NumPy arrays."""
    return head.startswith(b"PK\x03\x04") and b".npy" in head[:512]


def read(path: Path, options: Mapping[str, Any]) -> Recording:
    """The bodies (with orientations) and points (without) that the options name.

    Raises:
        FileError: The archive is damaged or too large, or shapes disagree.
        UnknownNameError: The options name an array that is not there.
    """
    arrays = Arrays(path, "array", _load_arrays(path))
    if not options.get("arrays"):
        shapes = ", ".join(f"{name} {each.shape}" for name, each in sorted(arrays.values.items()))
        raise FileError(
            path,
            f"holds arrays and does not say what they are: {shapes}.",
            'Say it in capture.toml: arrays = [{ names = "...", positions = "...", '
            'quaternions = "...", order = "xyzw" }].',
        )
    groups = options["arrays"]
    times = _times(arrays, options, len(arrays.stacked(groups[0].get("positions"), 3)))
    return arrays.recording(source_of(path, "npz"), groups, times)


@dataclass(frozen=True)
class Arrays:
    """Arrays of a file by their names, of which a capture.toml says what is what."""

    path: Path
    kind: str
    """What messages call one of them."""

    values: Mapping[str, np.ndarray]
    components: Mapping[str, Sequence[str]] = field(default_factory=dict)
    """Names of the numbers along an array's last axis, where the file has them."""

    def recording(
        self,
        source: Source,
        groups: Sequence[Mapping[str, Any]],
        times: Float[np.ndarray, "frames"],
    ) -> Recording:
        """The bodies and points of all groups.

        Raises:
            FileError: Shapes disagree.
            UnknownNameError: A group names an array, or a part of one, that is not there.
        """
        bodies, markers, orders = {}, {}, {}
        for group in groups:
            names, positions, turns = self._group(group)
            for index, name in enumerate(names):
                if turns is None:
                    markers[name] = positions[:, index]
                else:
                    bodies[name] = track(name, times, positions[:, index], turns[:, index])
                    if "quaternions" in group:
                        orders[name] = str(group["order"])
        return Recording(
            source=source,
            bodies=bodies,
            orders=orders,
            markers=markers,
            marker_times=times if markers else np.empty(0),
        )

    def part(self, text: object) -> np.ndarray:
        """An array, or a part of its last axis: ``state[0:3]``, ``state[x,y]``.

        Raises:
            FileError: A number is out of range.
            UnknownNameError: There is no such array, or no such component.
        """
        if text in self.values:
            return self.values[str(text)]
        name, bracket, inside = str(text).partition("[")
        if name not in self.values:
            raise UnknownNameError(self.kind, name, self.values, where=str(self.path))
        array = self.values[name]
        if not bracket:
            return array
        if array.ndim < 2 or not inside.endswith("]"):
            problem = f"{text}: a part is named like {name}[0:3], of an array of several numbers."
            raise FileError(self.path, problem)
        parts = [each.strip() for each in inside[:-1].split(",")]
        columns = [n for each in parts for n in self._columns(name, each, array.shape[-1])]
        return np.asarray(array[..., columns])

    def _columns(self, name: str, part: str, width: int) -> Sequence[int]:
        """The places of a component, or of a range of them as in Python."""
        names = list(self.components.get(name, ()))
        if part in names:
            return [names.index(part)]
        match = re.fullmatch(r"(-?\d+)|(-?\d*):(-?\d*)", part)
        if match is None:
            known = names or [str(n) for n in range(width)]
            raise UnknownNameError(f"component of {name}", part, known, where=str(self.path))
        first, last = (int(each) if each else None for each in match.groups()[1:])
        if match[1]:
            first = int(match[1])
            last = first + 1 or None
        found = range(width)[first:last]
        if not found or not all(-width <= each <= width for each in (first or 0, last or 0)):
            shown = f" ({', '.join(names)})" if names else ""
            problem = f"{name}[{part}] is out of range: {name} has {width} components{shown}."
            raise FileError(self.path, problem, f"They are counted from 0: {name}[0:{width}].")
        return found

    def _group(
        self, group: Mapping[str, Any]
    ) -> tuple[list[str], np.ndarray, Float[np.ndarray, "frames bodies 4"] | None]:
        """Names, positions, and orientations as quaternions w x y z."""
        positions = self.stacked(group.get("positions"), 3)
        names = [str(group.get("body"))]
        if "body" not in group:
            stated = group.get("names")
            own = stated if isinstance(stated, list) else self.part(stated)
            names = [str(each) for each in np.atleast_1d(own)]
        if len(names) != positions.shape[1]:
            raise FileError(self.path, f"{len(names)} names for {positions.shape[1]} bodies.")
        key = next((each for each in NAMING[1:] if each in group), None)
        if key is None:
            return names, positions, None
        known = ORDERS if key == "quaternions" else ROTATIONS
        order = str(group.get("order", ""))
        if order not in known:
            raise UnknownNameError(f"order of {key}", order, known, where=str(self.path))
        turns = self.stacked(group[key], 4 if key == "quaternions" else 3)
        if turns.shape[:2] != positions.shape[:2]:
            raise FileError(self.path, f"positions {positions.shape} and {key} {turns.shape}.")
        if key == "quaternions":
            return names, positions, turns[..., ORDERS[order]]
        flat = quaternions_of(turns.reshape(-1, 3), order)
        return names, positions, flat.reshape(*turns.shape[:2], 4)

    def stacked(self, text: object, width: int) -> Float[np.ndarray, "frames bodies width"]:
        """An array, or a part of one, of so many numbers for each frame and body.

        Raises:
            FileError: It is of another shape, or of no numbers.
        """
        array = self.part(text)
        if array.dtype.kind not in "fiu" or array.ndim not in {2, 3} or array.shape[-1] != width:
            raise FileError(
                self.path,
                f"{text} is {array.dtype} {array.shape} where (frames, {width}) or "
                f"(frames, bodies, {width}) of numbers is needed.",
            )
        return np.asarray(array, dtype=float).reshape(len(array), -1, width)


def _load_arrays(path: Path) -> dict[str, np.ndarray]:
    """Every array of an archive whose header promises what is there, and no Python objects."""
    out = {}
    check_zip(path)
    with zipfile.ZipFile(path) as archive:
        for member in sorted(each for each in archive.namelist() if each.endswith(".npy")):
            size = archive.getinfo(member).file_size
            with archive.open(member) as file:
                first = npy.read_magic(file) == (1, 0)
                read_header = npy.read_array_header_1_0 if first else npy.read_array_header_2_0
                shape, _, dtype = read_header(file)
            if dtype.hasobject:
                raise FileError(path, f"{member} holds Python objects, which are never read.")
            promised = math.prod(shape) * dtype.itemsize
            if promised > min(size, EXPANDED_LIMIT):
                raise FileError(path, f"{member} promises {promised} bytes and holds {size}.")
            with archive.open(member) as file:
                out[member[:-4]] = np.asarray(npy.read_array(file, allow_pickle=False))
    return out


def _times(arrays: Arrays, options: Mapping[str, Any], frames: int) -> Float[np.ndarray, "frames"]:
    if "time" in options:
        times = np.asarray(arrays.part(options["time"]), dtype=float).reshape(-1)
        check_rate(times, options)
        return times
    if "fps" in options:
        return uniform_clock(frames, float(arrays.part(options["fps"])))
    if "rate_hz" in options:
        return uniform_clock(frames, float(options["rate_hz"]))
    raise FileError(
        arrays.path, "no clock is stated.", 'Say time = "array", fps = "array" or rate_hz.'
    )
