"""BVH: a skeleton's joints, by forward kinematics to poses in the world."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Notice, notice
from capar.model.errors import FileError
from extractors.readers.files import read_rows, read_text, source_of
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
    return head.removeprefix(b"\xef\xbb\xbf").lstrip()[:9].upper() == b"HIERARCHY"


def read(path: Path, options: Any) -> Recording:
    """The joints of a BVH file; unit and axes are not in the format.

    Raises:
        FileError: The hierarchy is broken, or frames are missing.
    """
    lines = read_text(path).splitlines()
    joints, motion_at = read_hierarchy(path, lines)
    values, frame_time = _motion(path, lines, motion_at, sum(len(each.channels) for each in joints))
    times = uniform_clock(len(values), 1.0 / frame_time)
    bodies = {
        joint.name: track(joint.name, times, positions, geometry.quaternions(turned))
        for joint, (positions, turned) in zip(joints, forward(joints, values), strict=True)
    }
    return Recording(
        source=source_of(path, "bvh"),
        bodies=bodies,
        parents={each.name: joints[each.parent].name for each in joints if each.parent >= 0},
        notices=tuple(_doubtful(joints)),
    )


def read_hierarchy(path: Path, lines: list[str]) -> tuple[list[Joint], int]:
    """The joints, parents first, and the index of the line ``MOTION``."""
    joints: list[Joint] = []
    open_joints: list[int] = []
    waiting: int | None = None
    for index, line in enumerate(lines):
        words = line.split()
        word = words[0].upper() if words else ""
        if word == "MOTION":
            if open_joints or not joints:
                raise FileError(f"{path}:{index + 1}", "MOTION before the hierarchy is closed.")
            return joints, index
        if word in {"ROOT", "JOINT"}:
            joints.append(_joint(path, index, words, joints, open_joints))
            waiting = len(joints) - 1
        elif word == "END":
            waiting = -1
        elif word == "{":
            open_joints.append(_opened(path, index, waiting))
            waiting = None
        elif word == "}":
            _opened(path, index, open_joints.pop() if open_joints else None)
        elif word in {"OFFSET", "CHANNELS"}:
            _describe(path, index, words, joints, open_joints)
        elif word not in {"", "HIERARCHY"}:
            raise FileError(f"{path}:{index + 1}", f"{line.strip()[:40]!r} is no part of a BVH.")
    raise FileError(path, "ends inside the hierarchy, before MOTION.", "Export it again.")


def _joint(
    path: Path, index: int, words: list[str], joints: list[Joint], open_joints: list[int]
) -> Joint:
    name = " ".join(words[1:])
    if not name or any(each.name == name for each in joints):
        raise FileError(f"{path}:{index + 1}", f"a joint needs a name of its own, not {name!r}.")
    return Joint(name, open_joints[-1] if open_joints else -1)


def _opened(path: Path, index: int, joint: int | None) -> int:
    if joint is None:
        raise FileError(f"{path}:{index + 1}", "a brace that belongs to no joint.")
    return joint


def _describe(
    path: Path, index: int, words: list[str], joints: list[Joint], open_joints: list[int]
) -> None:
    where = f"{path}:{index + 1}"
    if not open_joints:
        raise FileError(where, f"{words[0]} outside a joint.")
    if open_joints[-1] < 0:
        return
    joint = joints[open_joints[-1]]
    if words[0].upper() == "OFFSET":
        joint.offset = tuple(_finite(where, each) for each in words[1:4])
        if len(joint.offset) != 3:
            raise FileError(where, "OFFSET takes three numbers.")
        return
    known = {each.lower(): each for each in CHANNELS}
    names = tuple(known.get(each.lower(), "") for each in words[2:])
    if not all(names) or len(words) < 2 or words[1] != str(len(names)):
        raise FileError(where, f"CHANNELS takes a count and as many of {', '.join(CHANNELS)}.")
    joint.channels = names


def _finite(where: str, word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise FileError(where, f"{word[:40]!r} is no number.")
    return value


def _motion(
    path: Path, lines: list[str], at: int, columns: int
) -> tuple[Float[np.ndarray, "frames columns"], float]:
    header: dict[str, float] = {}
    row = at + 1
    while row < len(lines) and len(header) < 2:
        key, _, value = lines[row].partition(":")
        if key.strip():
            header[" ".join(key.lower().split())] = _finite(f"{path}:{row + 1}", value.strip())
        row += 1
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
    column = 0
    for joint in joints:
        own = values[:, column : column + len(joint.channels)]
        column += len(joint.channels)
        place, turn = _local(joint, own)
        if joint.parent >= 0:
            at, turned = out[joint.parent]
            place, turn = at + turned.apply(place), turned * turn
        out.append((place, turn))
    return out


def _local(
    joint: Joint, values: Float[np.ndarray, "frames channels"]
) -> tuple[Float[np.ndarray, "frames 3"], Rotation]:
    place = np.tile(np.asarray(joint.offset), (len(values), 1))
    turn = Rotation.identity(len(values))
    for index, channel in enumerate(joint.channels):
        axis = "XYZ".index(channel[0])
        if channel.endswith("position"):
            place[:, axis] = values[:, index] + (joint.offset[axis] if joint.parent < 0 else 0.0)
        else:
            turn = turn * Rotation.from_euler(channel[0].lower(), values[:, [index]], degrees=True)
    return place, turn


def _doubtful(joints: list[Joint]) -> list[Notice]:
    """Joints whose offset and position channels could be read in two ways."""
    moved = [
        each.name
        for each in joints
        if any(each.offset) and any(name.endswith("position") for name in each.channels)
    ]
    return [notice("offset-and-position", *moved)] if moved else []
