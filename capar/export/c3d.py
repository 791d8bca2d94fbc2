"""C3D: every segment's pose as ROTATION data, and its origin as a point, z up, in millimetres."""

import struct
from collections.abc import Iterator

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.human import Human, Poses, poses_of
from capar.model.errors import CaparError

UNIT_M = 0.001
"""Metres per unit of the file [m]."""

BLOCK = 512
MOST_FRAMES = 65535
"""So many a file can count for every reader: programs differ on how it states more."""

FIRST_PARAMETER_BLOCK = 2
INTEL = 84
"""The processor whose numbers are little-endian."""

Value = str | int | float | list[str]


def c3d_bytes(human: Human, times: Float[np.ndarray, "frames"], motion: np.ndarray) -> bytes:
    """A motion as a C3D file: 4 x 4 matrices of all segments, and points where they begin.

    Matrices are those of the segments in the world, whose axes are x forward, y left, z up of
    somebody who stands facing x; points bear the segments' names with ``_origin`` added.

    Args:
        human: The body.
        times: When each frame is [s]; the file holds their mean rate.
        motion: A posture a frame.

    Raises:
        CaparError: There are more frames than such a file can count.
    """
    if len(motion) > MOST_FRAMES:
        raise CaparError(
            f"the motion has {len(motion)} frames, and a C3D file holds {MOST_FRAMES} at most; "
            "cut it, or write BVH, GLB, CSV or NPZ"
        )
    poses = poses_of(human, motion)
    span = float(times[-1] - times[0])
    rate_hz = (len(times) - 1) / span if span > 0.0 else 1.0
    points, matrices = _points(poses), _matrices(poses)
    sizes = [_blocks(len(points)), _blocks(len(matrices))]
    starts = (0, 0)
    blocks = _blocks(len(_parameters(poses, rate_hz, starts)))
    starts = (FIRST_PARAMETER_BLOCK + blocks, FIRST_PARAMETER_BLOCK + blocks + sizes[0])
    parts = [
        _header(poses, rate_hz, starts[0]),
        _parameters(poses, rate_hz, starts),
        points,
        matrices,
    ]
    return b"".join(part + bytes(-len(part) % BLOCK) for part in parts)


def _blocks(size: int) -> int:
    return -(-size // BLOCK)


def _header(poses: Poses, rate_hz: float, start: int) -> bytes:
    """The first block: counts, frames, the scale of real numbers, and where data begin."""
    counts = struct.pack("<4H", len(poses.names), 0, 1, len(poses.positions))
    return bytes([FIRST_PARAMETER_BLOCK, 0x50]) + counts + struct.pack(
        "<HfHHf", 0, -1.0, start, 0, rate_hz
    )  # fmt: skip


def _points(poses: Poses) -> bytes:
    """Origins [mm] with a residual of zero, segment by segment, frame by frame."""
    table = np.zeros((*poses.positions.shape[:2], 4), "<f4")
    table[..., :3] = poses.positions / UNIT_M
    return table.tobytes()


def _matrices(poses: Poses) -> bytes:
    """Matrices by columns, each with a reliability of zero, which says that it is known."""
    frames, segments = poses.positions.shape[:2]
    matrices = np.zeros((frames, segments, 4, 4))
    turns = Rotation.from_quat(poses.orientations.reshape(-1, 4), scalar_first=True)
    matrices[..., :3, :3] = turns.as_matrix().reshape(frames, segments, 3, 3)
    matrices[..., :3, 3] = poses.positions / UNIT_M
    matrices[..., 3, 3] = 1.0
    table = np.zeros((frames, segments, 17), "<f4")
    table[..., :16] = matrices.swapaxes(2, 3).reshape(frames, segments, 16)
    return table.tobytes()


def _parameters(poses: Poses, rate_hz: float, starts: tuple[int, int]) -> bytes:
    """The parameter section, for data that begin in such blocks."""
    count, frames = len(poses.names), len(poses.positions)
    groups: dict[str, dict[str, Value]] = {
        "POINT": {
            "USED": count,
            "SCALE": -1.0,
            "RATE": rate_hz,
            "DATA_START": starts[0],
            "FRAMES": frames,
            "UNITS": "mm",
            "X_SCREEN": "+X",
            "Y_SCREEN": "+Z",
            "LABELS": [f"{name}_origin" for name in poses.names],
        },
        "ANALOG": {"USED": 0},
        "ROTATION": {
            "USED": count,
            "RATE": rate_hz,
            "RATIO": 1,
            "DATA_START": starts[1],
            "LABELS": list(poses.names),
        },
    }
    body = b"".join(_records(groups))
    blocks = _blocks(4 + len(body) + 2)
    return bytes([1, 0x50, blocks, INTEL]) + body + bytes(2)


def _records(groups: dict[str, dict[str, Value]]) -> Iterator[bytes]:
    """Groups, which have negative numbers, each followed by its parameters."""
    for number, (group, values) in enumerate(groups.items(), start=1):
        yield _record(group, -number, b"")
        for name, value in values.items():
            yield _record(name, number, _value(value))


def _record(name: str, number: int, content: bytes) -> bytes:
    """A name, how far the next record is from there on, the content, and no description."""
    tail = content + bytes([0])
    head = struct.pack("<bb", len(name), number) + name.encode("ascii")
    return head + struct.pack("<H", 2 + len(tail)) + tail


def _value(value: Value) -> bytes:
    """Its kind, its dimensions and its numbers or characters."""
    if isinstance(value, int):
        return struct.pack("<bBH", 2, 0, value)
    if isinstance(value, float):
        return struct.pack("<bBf", 4, 0, value)
    if isinstance(value, str):
        return struct.pack("<bBB", -1, 1, len(value)) + value.encode("ascii")
    wide = max(map(len, value))
    text = "".join(word.ljust(wide) for word in value)
    return struct.pack("<bBBB", -1, 2, wide, len(value)) + text.encode("ascii")
