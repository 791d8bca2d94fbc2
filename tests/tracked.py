"""What a driver received, held against what its simulator sent, as the second decoder reads it."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from flock_bits import decode
from scipy.spatial.transform import Rotation

from extractors.devices.simulated_line import Sent
from extractors.devices.tracker import Frame, Tracker

TO_WORLD = Rotation.from_euler("x", 180.0, degrees=True)
SAME = 1e-6


def collect(tracker: Tracker, seconds: float) -> list[Frame]:
    """The frames of a tracker that is open, for a while."""
    frames: list[Frame] = []
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0.0:
        frames += tracker.poll(min(0.1, left))
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
    at, last, wrong = 0, -1, 0
    for row in got:
        ahead = np.flatnonzero(np.abs(sent[at:] - row).max(axis=1) < SAME)
        if not len(ahead):
            wrong += 1
            continue
        last = at + int(ahead[0])
        at = last + 1
    return Held(last + 1, sum(intact[: last + 1]), len(got), wrong, len(sent) - last - 1)


def held(
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


def signed(rows: np.ndarray) -> np.ndarray:
    """Quaternions of the sign whose largest part is positive."""
    largest = np.abs(rows[:, 3:]).argmax(axis=1)
    signs = np.sign(rows[np.arange(len(rows)), 3 + largest])
    rows[:, 3:] *= np.where(signs == 0.0, 1.0, signs)[:, None]
    return rows
