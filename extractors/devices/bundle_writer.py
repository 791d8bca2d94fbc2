"""A recording of live frames as a capture bundle: motion.csv and capture.toml.

Time is the device's where it sends one. Otherwise the frames' arrival jitters with everything
that delays them; where cycles are counted, a straight line through arrival by cycle number takes
its place, from one connection to the next. Arrival itself is kept only for polled trackers.
"""

import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar.model.errors import FileError, UnknownNameError
from extractors.devices.recording import NO_CYCLE, Recording

PARTS = ("x", "y", "z", "qx", "qy", "qz", "qw", "valid")
END_EFFECTORS = ("hand", "foot", "head")
SIDES = ("right", "left")
FEWEST = 20
"""Frames of a connection through which a line is laid; fewer keep their arrival."""


@dataclass(frozen=True)
class Mount:
    """What a sensor rides on: a body segment, or an object where ``end_effector`` is empty."""

    end_effector: str = ""
    side: str = "none"

    @property
    def attends(self) -> bool:
        """Whether it shows where the performer looks, rather than what is done."""
        return self.end_effector == "head"


def usual_mount(name: str) -> Mount:
    """What a name says: ``right_hand`` rides on the right hand, ``mug`` on an object."""
    side, _, rest = name.partition("_")
    part = rest if side in SIDES else name
    if part not in END_EFFECTORS:
        return Mount()
    return Mount(part, side if side in SIDES else "none")


def frame_times(recording: Recording) -> Float[np.ndarray, "frames"]:
    """When each frame was measured [s], from the first on; it does not always increase."""
    device_s = recording.device_s
    if np.isfinite(device_s).all() and (np.diff(device_s) > 0.0).all():
        times = device_s
    else:
        times = _straightened(recording)
    return np.asarray(times - times[0])


def _straightened(recording: Recording) -> np.ndarray:
    """Arrival, on a line by cycle number within each connection."""
    times, cycles = recording.host_s.copy(), recording.cycles
    starts = [0, *(np.flatnonzero(np.diff(cycles) <= 0) + 1).tolist(), len(cycles)]
    for first, end in pairwise(starts):
        part = slice(first, end)
        if end - first >= FEWEST and cycles[first] != NO_CYCLE:
            slope, offset = np.polyfit(cycles[part], times[part], 1)
            times[part] = offset + slope * cycles[part]
    return times


def write_bundle(
    recording: Recording, folder: Path | str, mounts: Mapping[str, Mount] | None = None
) -> None:
    """Write a recording as a capture bundle, whole or not at all.

    Args:
        recording: What was recorded.
        folder: A folder that does not exist yet.
        mounts: What the sensors ride on; otherwise their names say it.

    Raises:
        FileError: The folder exists, or the recording is too short or lacks positions or
            orientations.
        UnknownNameError: A mount is of no sensor.
    """
    folder = Path(folder)
    _check(recording, folder, mounts or {})
    times = frame_times(recording)
    later = np.maximum.accumulate(np.append(-np.inf, times[:-1]))
    kept = np.flatnonzero(times > later)
    folder.parent.mkdir(parents=True, exist_ok=True)
    made = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        _write_table(made / "motion.csv", recording, times, kept)
        late = len(times) - len(kept)
        text = _capture_toml(recording, folder.name, mounts or {}, late)
        (made / "capture.toml").write_text(text, encoding="utf-8")
        made.chmod(0o755)
        made.rename(folder)
    except OSError as error:
        raise FileError(folder, f"cannot be written: {error}.") from None
    finally:
        shutil.rmtree(made, ignore_errors=True)


def _check(recording: Recording, folder: Path, mounts: Mapping[str, Mount]) -> None:
    description = recording.description
    for name in mounts:
        if name not in description.sensors:
            raise UnknownNameError("sensor", name, description.sensors, where=recording.address)
    if not description.has_positions or not description.has_orientations:
        raise FileError(
            folder,
            "a capture needs positions and orientations, and the recording lacks one of them.",
            "Record with format=pos_quat.",
        )
    if len(recording.host_s) < 2:
        frames = len(recording.host_s)
        raise FileError(folder, f"the recording has {frames} frames; a capture has at least two.")
    if folder.exists():
        raise FileError(folder, "exists already.", "Bundles are never overwritten.")


def _write_table(path: Path, recording: Recording, times: np.ndarray, kept: np.ndarray) -> None:
    names = recording.description.sensors
    lines = [",".join(["t_s", *(f"{name}_{part}" for name in names for part in PARTS)])]
    for frame in kept:
        cells = [f"{times[frame]:.6f}"]
        for place, turned in zip(
            recording.positions[frame], recording.orientations[frame], strict=True
        ):
            seen = bool(np.isfinite(place).all() and np.isfinite(turned).all())
            cells += [f"{value:.6f}" if seen else "nan" for value in place]
            cells += [f"{value:.7f}" if seen else "nan" for value in np.roll(turned, -1)]
            cells.append(str(int(seen)))
        lines.append(",".join(cells))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _capture_toml(recording: Recording, name: str, mounts: Mapping[str, Mount], late: int) -> str:
    whole = "ended" if recording.counts is not None else "cut off"
    head = [
        f"# Recorded live from {recording.address}",
        f"# at {recording.started}; the recording was {whole}.",
    ]
    if late:
        head.append(f"# {late} frames came with a time that was not later, and are left out.")
    head += [f"# {event.message}" for event in recording.events]
    out = [each.replace("\n", " ") for each in head]
    out += [
        f'name = "{_bare(name)}"',
        f'recorded = "{recording.started}"',
        'unit = "m"',
        'up = "z"',
        "",
        "[files]",
    ]
    out += ['motion = "motion.csv"', "", "[agent]", 'name = "agent"']
    names = recording.description.sensors
    rides = {each: mounts.get(each, usual_mount(each)) for each in names}
    if not any(each.end_effector for each in rides.values()):
        out += ["", "# No sensor's name says what it rides on: correct end_effector and side."]
        rides = {each: Mount(each) for each in names}
    for each, mount in rides.items():
        out += ["", *_body(each, mount)]
    return "\n".join(out) + "\n"


def _body(name: str, mount: Mount) -> list[str]:
    if not mount.end_effector:
        return ["[[object]]", f'name = "{name}"', 'tag = "mobile"', f'body = "{name}"']
    out = ["[[sensor]]", f'name = "{name}"', f'end_effector = "{mount.end_effector}"']
    out += [f'side = "{mount.side}"'] if mount.side != "none" else []
    out += ['role = "attends"'] if mount.attends else []
    return [*out, f'body = "{name}"']


def _bare(name: str) -> str:
    return "".join(each if each.isalnum() or each in "-_." else "_" for each in name)
