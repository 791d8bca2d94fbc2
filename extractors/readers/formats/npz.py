"""NPZ: arrays whose meaning capture.toml states."""

import math
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from numpy.lib import format as npy

from capar.model.errors import FileError, UnknownNameError
from extractors.readers.file_access import EXPANDED_LIMIT, check_zip, source_of
from extractors.readers.formats.csv_table import ORDERS
from extractors.readers.recording import Recording, check_rate, track, uniform_clock

OPTIONS = frozenset({"arrays", "time", "fps", "rate_hz"})
"""``arrays``: a list of ``{positions, quaternions, order, names | body}``; ``time``: the array of
seconds; ``fps``: the array that holds the rate; ``rate_hz``: the rate itself."""


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file is a zip archive of NumPy arrays."""
    return head.startswith(b"PK\x03\x04") and b".npy" in head[:512]


def read(path: Path, options: Mapping[str, Any]) -> Recording:
    """The bodies (with quaternions) and points (without) that the options name.

    Raises:
        FileError: The archive is damaged or too large, or shapes disagree.
        UnknownNameError: The options name an array that is not there.
    """
    arrays = _load_arrays(path)
    if "arrays" not in options:
        shapes = ", ".join(f"{name} {each.shape}" for name, each in sorted(arrays.items()))
        raise FileError(
            path,
            f"holds arrays and does not say what they are: {shapes}.",
            'Say it in capture.toml: arrays = [{ names = "...", positions = "...", '
            'quaternions = "...", order = "xyzw" }].',
        )
    groups = [_group(path, arrays, each) for each in options["arrays"]]
    times = _times(path, arrays, options, len(groups[0][1]))
    bodies, markers, orders = {}, {}, {}
    for group, (names, positions, quaternions) in zip(options["arrays"], groups, strict=True):
        for index, name in enumerate(names):
            if quaternions is None:
                markers[name] = positions[:, index]
            else:
                bodies[name] = track(name, times, positions[:, index], quaternions[:, index])
                orders[name] = str(group["order"])
    clock = times if markers else np.empty(0)
    return Recording(
        source=source_of(path, "npz"),
        bodies=bodies,
        orders=orders,
        markers=markers,
        marker_times=clock,
    )


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


def _array(path: Path, arrays: Mapping[str, np.ndarray], name: object) -> np.ndarray:
    if name not in arrays:
        raise UnknownNameError("array", str(name), arrays, where=str(path))
    return arrays[str(name)]


def _group(
    path: Path, arrays: Mapping[str, np.ndarray], group: Mapping[str, Any]
) -> tuple[list[str], np.ndarray, np.ndarray | None]:
    positions = _stacked(path, _array(path, arrays, group.get("positions")), 3)
    names = [str(group.get("body"))]
    if "body" not in group:
        stated = group.get("names")
        own = stated if isinstance(stated, list) else _array(path, arrays, stated)
        names = [str(each) for each in np.atleast_1d(own)]
    if len(names) != positions.shape[1]:
        raise FileError(path, f"{len(names)} names for {positions.shape[1]} bodies.")
    if "quaternions" not in group:
        return names, positions, None
    order = str(group.get("order", ""))
    if order not in ORDERS:
        raise UnknownNameError("order of quaternions", order, ORDERS, where=str(path))
    quaternions = _stacked(path, _array(path, arrays, group["quaternions"]), 4)[..., ORDERS[order]]
    if quaternions.shape[:2] != positions.shape[:2]:
        raise FileError(path, f"positions {positions.shape} and quaternions {quaternions.shape}.")
    return names, positions, quaternions


def _stacked(path: Path, array: np.ndarray, width: int) -> Float[np.ndarray, "frames bodies width"]:
    if array.dtype.kind not in "fiu" or array.ndim not in {2, 3} or array.shape[-1] != width:
        raise FileError(
            path,
            f"an array {array.dtype} {array.shape} where (frames, {width}) or "
            f"(frames, bodies, {width}) of numbers is needed.",
        )
    return np.asarray(array, dtype=float).reshape(len(array), -1, width)


def _times(
    path: Path, arrays: Mapping[str, np.ndarray], options: Mapping[str, Any], frames: int
) -> Float[np.ndarray, "frames"]:
    if "time" in options:
        times = np.asarray(_array(path, arrays, options["time"]), dtype=float).reshape(-1)
        check_rate(times, options)
        return times
    if "fps" in options:
        return uniform_clock(frames, float(_array(path, arrays, options["fps"])))
    if "rate_hz" in options:
        return uniform_clock(frames, float(options["rate_hz"]))
    raise FileError(path, "no clock is stated.", 'Say time = "array", fps = "array" or rate_hz.')
