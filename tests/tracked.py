"""What a driver received, held against what its simulator sent, as the second decoder reads it."""

import struct
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from flock_bits import decode, poses_of
from scipy.spatial.transform import Rotation

from extractors.devices.simulator import Sent
from extractors.devices.tracker import Frame, LiveTracker

TO_WORLD = Rotation.from_euler("x", 180.0, degrees=True)
SAME = 1e-6
NEAR = 500
"""How many records ahead a pose is looked for first."""


def collect(tracker: LiveTracker, seconds: float) -> list[Frame]:
    """The frames of a tracker that is open, for a while."""
    frames: list[Frame] = []
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0.0:
        frames += tracker.poll(min(0.1, left))
    return frames


def take(tracker: LiveTracker, count: int, *, within_s: float = 60.0) -> list[Frame]:
    """So many frames, or a few more, of a tracker that is open; however busy the computer is."""
    frames: list[Frame] = []
    end = time.monotonic() + within_s
    while len(frames) < count and time.monotonic() < end:
        frames += tracker.poll(0.1)
    assert len(frames) >= count, f"{len(frames)} of {count} frames in {within_s:g} s"
    return frames


@dataclass(frozen=True)
class Held:
    """How the frames of one sensor compare with what was sent."""

    sent: int
    """Records up to the last one that arrived."""

    intact: int
    """Those of them that nothing had happened to."""

    accepted: int
    wrong: int
    """Poses that no record, in order, was."""

    unread: int
    """Records after the last one that arrived."""


def poses(frames: Sequence[Frame], sensor: int) -> np.ndarray:
    """The poses of a sensor where it has one, in rows of seven; what it lacks is zero."""
    rows = np.array([np.r_[each.positions[sensor], each.orientations[sensor]] for each in frames])
    rows = rows.reshape(-1, 7)
    return signed(np.nan_to_num(rows[~np.isnan(rows).all(axis=1)]))


def sent_poses(sent: Sequence[Sent], form: str, *, group: bool, range_inch: float) -> np.ndarray:
    """The same of what was sent."""
    data = decode(b"".join(each.data for each in sent), form, group=group, range_inch=range_inch)
    return in_rows(len(sent), data.positions, data.rotations)


def in_rows(count: int, positions: np.ndarray | None, rotations: Rotation | None) -> np.ndarray:
    """Poses in the transmitter's frame as rows of seven in the world."""
    rows = np.zeros((count, 7))
    if positions is not None:
        rows[:, :3] = TO_WORLD.apply(positions)
    if rotations is not None:
        rows[:, 3:] = (TO_WORLD * rotations).as_quat(scalar_first=True)
    return signed(rows)


def compare(got: np.ndarray, sent: np.ndarray, intact: Sequence[bool]) -> Held:
    """Match poses in order, each with the next one sent that is the same."""
    at, last, wrong, row = 0, -1, 0, 0
    while row < len(got):
        block = min(NEAR, len(got) - row, len(sent) - at)
        differ = np.abs(sent[at : at + block] - got[row : row + block]).max(axis=1) >= SAME
        same = int(differ.argmax()) if differ.any() else block
        at, row = at + same, row + same
        last = at - 1 if same else last
        if row == len(got) or (same == block and same):
            continue
        for window in (NEAR, len(sent)):
            ahead = np.flatnonzero(np.abs(sent[at : at + window] - got[row]).max(axis=1) < SAME)
            if len(ahead):
                last = at + int(ahead[0])
                at = last + 1
                break
        else:
            wrong += 1
        row += 1
    return Held(last + 1, sum(intact[: last + 1]), len(got), wrong, len(sent) - last - 1)


def held_by_flock(
    frames: Sequence[Frame], log: Sequence[Sent], form: str, *, group: bool, range_inch: float
) -> list[Held]:
    """The comparison, sensor by sensor.

    A unit on its own answers the POINT by which the driver ends what may be streaming; that
    first record is no frame.
    """
    out = []
    addresses = sorted({each.address for each in log})
    for index, address in enumerate(addresses):
        mine = [each for each in log if each.address == address][len(addresses) == 1 :]
        truth = sent_poses(mine, form, group=group, range_inch=range_inch)
        out.append(compare(poses(frames, index), truth, [each.intact for each in mine]))
    return out


def held_by_motionstar(frames: Sequence[Frame], log: Sequence[Sent], form: str) -> list[Held]:
    """The comparison for packets, whose words are whole."""
    out = []
    sensors = len(frames[0].positions)
    bodies = np.array([np.frombuffer(each.data, ">i2") for each in log])
    for index in range(sensors):
        words = bodies.reshape(len(log), sensors, -1)[:, index, 1:].astype(float)
        truth = in_rows(len(log), *poses_of(words, form, range_inch=144.0))
        out.append(compare(poses(frames, index), truth, [each.intact for each in log]))
    return out


def held_by_fastrak(
    frames: Sequence[Frame], log: Sequence[Sent], form: str, *, binary: bool
) -> list[Held]:
    """The comparison for a Fastrak's records."""
    out = []
    for index in range(len(frames[0].positions)):
        mine = [each for each in log if each.address == index + 1]
        rows = np.array([_fastrak_numbers(each.data, binary=binary) for each in mine])
        rotations = None
        if form == "pos_quat":
            rotations = Rotation.from_quat(rows[:, [4, 5, 6, 3]])
        elif form == "pos_ang":
            rotations = Rotation.from_euler("ZYX", rows[:, 3:], degrees=True)
        truth = in_rows(len(mine), rows[:, :3] / 100.0, rotations)
        out.append(compare(poses(frames, index), truth, [each.intact for each in mine]))
    return out


def held_by_vrpn(frames: Sequence[Frame], log: Sequence[Sent]) -> list[Held]:
    """The comparison for a VRPN server's poses."""
    out = []
    for index in range(len(frames[0].positions)):
        mine = [struct.unpack(">8x7d", each.data) for each in log if each.address == index]
        turns = Rotation.from_quat([each[3:] for each in mine])
        rows = np.c_[[each[:3] for each in mine], turns.as_quat(scalar_first=True)]
        out.append(compare(poses(frames, index), signed(rows), [True] * len(mine)))
    return out


def _fastrak_numbers(data: bytes, *, binary: bool) -> list[float]:
    """A record's numbers, read by their columns."""
    if binary:
        return list(struct.unpack(f"<{(len(data) - 5) // 4}f", data[3:-2]))
    return [float(data[at : at + 7]) for at in range(3, len(data) - 2, 7)]


def signed(rows: np.ndarray) -> np.ndarray:
    """Quaternions of the sign whose largest part is positive."""
    largest = np.abs(rows[:, 3:]).argmax(axis=1)
    signs = np.sign(rows[np.arange(len(rows)), 3 + largest])
    rows[:, 3:] *= np.where(signs == 0.0, 1.0, signs)[:, None]
    return rows
