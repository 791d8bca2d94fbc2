"""BVH: the skeleton and its motion, y up and facing z, in centimetres, as animators expect."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.human import Human, Poses, poses_of

UNIT_M = 0.01
"""Metres per unit of the file [m]."""

AXES = [1, 2, 0]
"""Our axes that are the file's x, y and z: left, up, forward."""

ORDER = "ZXY"
"""Rotations apply in this order, each about the axis that the ones before have turned."""

DECIMALS = 5


def bvh_text(human: Human, times: Float[np.ndarray, "frames"], motion: np.ndarray) -> str:
    """A motion as the text of a BVH file; its frames are as far apart as the first and last say.

    Args:
        human: The body.
        times: When each frame is [s].
        motion: A posture a frame.
    """
    poses = poses_of(human, motion)
    step = float(times[-1] - times[0]) / max(len(times) - 1, 1) or 1.0
    lines = ["HIERARCHY", *_joint(human, poses, 0, 0)]
    lines += ["MOTION", f"Frames: {len(motion)}", f"Frame Time: {step:.8f}"]
    table = _table(poses)
    lines += [" ".join(f"{value:.{DECIMALS}f}" for value in row) for row in table]
    return "\n".join(lines) + "\n"


def _joint(human: Human, poses: Poses, number: int, depth: int) -> Iterator[str]:
    pad, name = "  " * depth, poses.names[number]
    offset = poses.offsets[number] if number else np.zeros(3)
    rotations = " ".join(f"{axis}rotation" for axis in ORDER)
    places = "Xposition Yposition Zposition "
    yield f"{pad}{'JOINT' if number else 'ROOT'} {name}"
    yield f"{pad}{{"
    yield f"{pad}  OFFSET {_text(offset)}"
    yield f"{pad}  CHANNELS {3 if number else 6} {'' if number else places}{rotations}"
    children = _children(poses, number)
    for child in children:
        yield from _joint(human, poses, child, depth + 1)
    if not children:
        bone = human.segments[name]
        yield f"{pad}  End Site"
        yield f"{pad}  {{"
        yield f"{pad}    OFFSET {_text(bone.tip - bone.origin)}"
        yield f"{pad}  }}"
    yield f"{pad}}}"


def _children(poses: Poses, number: int) -> list[int]:
    return [each for each, parent in enumerate(poses.parents) if parent == number]


def _in_order(poses: Poses, number: int = 0) -> Iterator[int]:
    """Segments in the order of the hierarchy: each before its children, these in a row."""
    yield number
    for child in _children(poses, number):
        yield from _in_order(poses, child)


def _text(offset: Float[np.ndarray, "3"]) -> str:
    return " ".join(f"{value / UNIT_M:.{DECIMALS}f}" for value in offset[AXES])


def _table(poses: Poses) -> Float[np.ndarray, "frames channels"]:
    """Positions of the pelvis, then three angles a segment [deg]."""
    columns = [poses.positions[:, 0][:, AXES] / UNIT_M]
    for number in _in_order(poses):
        w, x, y, z = poses.turns[:, number].T
        own = np.stack([w, *(np.array([x, y, z])[AXES])], axis=1)
        angles = Rotation.from_quat(own, scalar_first=True).as_euler(ORDER)
        columns.append(np.degrees(np.unwrap(angles, axis=0)))
    return np.concatenate(columns, axis=1)
