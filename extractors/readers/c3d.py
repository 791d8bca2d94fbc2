"""C3D: markers, and bodies from ROTATION data, through ezc3d."""

from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model.capture import Stream
from capar.model.errors import FileError
from extractors.readers.c3d_layout import check_layout
from extractors.readers.opening import source_of
from extractors.readers.qualisys import rotation_quaternions
from extractors.readers.recording import Recording, track, uniform_clock
from extractors.readers.trc import UNITS


def recognises(path: Path, head: bytes) -> bool:
    """Whether the second byte is the format's own, and the parameters name a processor."""
    if len(head) < 512 or head[1] != 0x50 or head[0] == 0:
        return False
    processor = (head[0] - 1) * 512 + 3
    return processor >= len(head) or head[processor] in {84, 85, 86}


def read(path: Path, options: Any) -> Recording:
    """Markers and bodies; a residual of -1 or a NaN is a missing sample.

    Raises:
        FileError: Counts and sizes in the file contradict each other, or it is cut short.
    """
    import ezc3d

    check_layout(path, path.read_bytes())
    file = ezc3d.c3d(str(path))
    parameters = file["parameters"]
    rate = float(file["header"]["points"]["frame_rate"])
    source, unit = source_of(path, "c3d"), _unit(path, parameters)
    markers = _markers(path, file)
    frames = next(iter(markers.values())).shape[0] if markers else 0
    clock = uniform_clock(frames, rate) if markers else np.empty(0)
    bodies = _bodies(parameters, file["data"]["rotations"], rate)
    return Recording(source=source, bodies=bodies, markers=markers, marker_times=clock, unit_m=unit)


def _unit(path: Path, parameters: Any) -> float | None:
    value = parameters["POINT"].get("UNITS", {}).get("value", [])
    return UNITS.get(str(value[0]).strip().lower()) if len(value) else None


def _labels(group: Any, count: int) -> list[str]:
    """Labels with their continuations (LABELS2 ...), and a number where there is none."""
    keys = sorted((k for k in group if k.startswith("LABELS")), key=lambda k: (len(k), k))
    given = [str(each).strip() for key in keys for each in group[key]["value"]]
    named = [each or f"point{n}" for n, each in enumerate(given[:count])]
    return named + [f"point{n}" for n in range(len(named), count)]


def _markers(path: Path, file: Any) -> dict[str, Float[np.ndarray, "frames 3"]]:
    points = np.asarray(file["data"]["points"], dtype=float)
    residuals = np.asarray(file["data"]["meta_points"]["residuals"])[0]
    names = _labels(file["parameters"]["POINT"], points.shape[1])
    if len(set(names)) != len(names):
        twice = sorted({each for each in names if names.count(each) > 1})
        raise FileError(path, f"two markers are called {twice[0]!r}.")
    places = np.where((residuals < 0.0)[None], np.nan, points[:3])
    return {name: np.array(places[:, index].T) for index, name in enumerate(names)}


def _bodies(
    parameters: Any, rotations: Float[np.ndarray, "4 4 bodies frames"], rate: float
) -> dict[str, Stream]:
    """Bodies of 4x4 matrices, at their own rate."""
    if rotations.ndim != 4 or 0 in rotations.shape:
        return {}
    group = parameters.get("ROTATION", {})
    names = _labels(group, rotations.shape[2])
    ratio = group.get("RATIO", {}).get("value", [1])
    times = uniform_clock(rotations.shape[3], rate * float(ratio[0]))
    return {n: _body(n, times, rotations[:, :, i]) for i, n in enumerate(names)}


def _body(
    name: str, times: Float[np.ndarray, "frames"], matrices: Float[np.ndarray, "4 4 frames"]
) -> Stream:
    poses = np.moveaxis(np.asarray(matrices, dtype=float), -1, 0)
    lost = ~np.isfinite(poses).all(axis=(1, 2)) | (poses[:, :3, :3] == 0.0).all(axis=(1, 2))
    orientations = np.full((len(poses), 4), np.nan)
    orientations[~lost] = rotation_quaternions(name, poses[~lost, :3, :3])
    positions = np.where(lost[:, None], np.nan, poses[:, :3, 3])
    return track(name, times, positions, orientations)
