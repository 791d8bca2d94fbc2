"""BVH: a skeleton's joints, by forward kinematics to poses in the world."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import notice
from capar.model.errors import FileError
from extractors.readers.file_access import number_of, opens_with, read_rows, read_text, source_of
from extractors.readers.recording import Recording, track, uniform_clock

CHANNELS = tuple(f"{axis}{kind}" for kind in ("position", "rotation") for axis in "XYZ")


@dataclass
class Joint:
    """One joint of the hierarchy."""

    name: str
    parent: int
    """Index of its parent; -1 for a root."""

    offset: tuple[float, ...] = (0.0, 0.0, 0.0)
    channels: tuple[str, ...] = ()


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file opens with a hierarchy."""
    return opens_with(head, b"HIERARCHY")


def read(path: Path, options: Any) -> Recording:
    """The joints of a BVH file; unit and axes are not in the format.

    Raises:
        FileError: The hierarchy is broken, or frames are missing.
    """
    lines = read_text(path).splitlines()
    joints, motion_at = _hierarchy(path, lines)
    values, frame_time = _motion(path, lines, motion_at, sum(len(each.channels) for each in joints))
    times = uniform_clock(len(values), 1.0 / frame_time)
    doubtful = [
        each.name
        for each in joints
        if any(each.offset) and any(name.endswith("position") for name in each.channels)
    ]
    return Recording(
        source=source_of(path, "bvh"),
        bodies={
            joint.name: track(joint.name, times, positions, geometry.quaternions(turned))
            for joint, (positions, turned) in zip(joints, forward(joints, values), strict=True)
        },
        parents={each.name: joints[each.parent].name for each in joints if each.parent >= 0},
        notices=(notice("offset-and-position", *doubtful),) if doubtful else (),
    )


def _hierarchy(path: Path, lines: list[str]) -> tuple[list[Joint], int]:
    """The joints, parents first, and the index of the line ``MOTION``."""
    joints: list[Joint] = []
    inside: list[int] = []
    waiting: int | None = None  # the joint that the next brace opens; -1 for an end
    for number, line in enumerate(lines, 1):
        where, words = f"{path}:{number}", line.split()
        word = words[0].upper() if words else ""
        if word == "MOTION" and joints and not inside:
            return joints, number - 1
        if word in {"ROOT", "JOINT"}:
            name = " ".join(words[1:])
            if not name or any(each.name == name for each in joints):
                raise FileError(where, f"a joint needs a name of its own, not {name!r}.")
            joints.append(Joint(name, inside[-1] if inside else -1))
            waiting = len(joints) - 1
        elif word == "END":
            waiting = -1
        elif word == "{" and waiting is not None:
            inside.append(waiting)
            waiting = None
        elif word == "}" and inside:
            inside.pop()
        elif word in {"OFFSET", "CHANNELS"} and inside:
            if inside[-1] >= 0:
                _describe(where, words, joints[inside[-1]])
        elif word not in {"", "HIERARCHY"}:
            raise FileError(where, f"{line.strip()[:40]!r} cannot stand here in a BVH.")
    raise FileError(path, "ends inside the hierarchy, before MOTION.", "Export it again.")


def _describe(where: str, words: list[str], joint: Joint) -> None:
    """Take a joint's offset or channels."""
    if words[0].upper() == "OFFSET":
        joint.offset = tuple(_finite(where, each) for each in words[1:4])
        if len(joint.offset) != 3:
            raise FileError(where, "OFFSET takes three numbers.")
        return
    known = {each.lower(): each for each in CHANNELS}
    joint.channels = tuple(known.get(each.lower(), "") for each in words[2:])
    if not all(joint.channels) or words[1:2] != [str(len(joint.channels))]:
        raise FileError(where, f"CHANNELS takes a count and as many of {', '.join(CHANNELS)}.")


def _finite(where: str, word: str) -> float:
    value = number_of(word)
    if value is None or not np.isfinite(value):
        raise FileError(where, f"{word[:40]!r} is no number.")
    return value


def _motion(
    path: Path, lines: list[str], at: int, columns: int
) -> tuple[Float[np.ndarray, "frames columns"], float]:
    """The channels' values, and the time of a frame [s]."""
    header: dict[str, float] = {}
    row = at + 1
    while row < len(lines) and len(header) < 2:
        key, _, value = lines[row].partition(":")
        row += 1
        if key.strip():
            header[" ".join(key.lower().split())] = _finite(f"{path}:{row}", value.strip())
    if set(header) != {"frames", "frame time"}:
        raise FileError(f"{path}:{at + 1}", "after MOTION come 'Frames:' and 'Frame Time:'.")
    frame_time = header["frame time"]
    if frame_time <= 0.0:
        raise FileError(path, f"a frame time of {frame_time:g} s; it must be positive.")
    values = read_rows(lines[row:], path=path, first_line=row + 1, columns=columns, delimiter=None)
    if len(values) != header["frames"]:
        raise FileError(
            path,
            f"states {header['frames']:g} frames and holds {len(values)}.",
            "It is cut short or its header is wrong; export it again.",
        )
    return values, frame_time


def forward(
    joints: list[Joint], values: Float[np.ndarray, "frames columns"]
) -> list[tuple[Float[np.ndarray, "frames 3"], Rotation]]:
    """World position and rotation of every joint; channels apply in the order they are named."""
    out: list[tuple[np.ndarray, Rotation]] = []
    columns = iter(values.T)
    for joint in joints:
        place = np.tile(np.asarray(joint.offset), (len(values), 1))
        turn = Rotation.identity(len(values))
        for channel, own in zip(joint.channels, columns, strict=False):
            axis = "XYZ".index(channel[0])
            if channel.endswith("position"):
                place[:, axis] = own + (joint.offset[axis] if joint.parent < 0 else 0.0)
            else:
                turn *= Rotation.from_euler(channel[0].lower(), own[:, None], degrees=True)
        if joint.parent >= 0:
            at, turned = out[joint.parent]
            place, turn = at + turned.apply(place), turned * turn
        out.append((place, turn))
    return out
