"""When a motion truly begins and ends, within the floor that separates motion from rest."""

from extractors.bodies.poses import Poses
from extractors.motion.object_motion import Floor, RestPose, rests_at
from extractors.signals.clock import frame_rate
from extractors.signals.filters import gains
from extractors.signals.intervals import Interval, first_where, last_where
from extractors.thresholds import Thresholds


def motion_edges(
    poses: Poses, moved: Interval, rests: tuple[RestPose, ...], thresholds: Thresholds
) -> Interval:
    """The interval of a motion, from when the object left one place to when it was at another.

    A motion is recognised by a displacement that no handling without it makes; once recognised, it
    began when the object was last where it had rested, and ended when it first was where it
    rests afterwards: within what noise alone makes, and at least a hair's width.

    Args:
        poses: The object's poses.
        moved: Frames in which it is beyond the floor of motion.
        rests: Places where it rests, in time.
        thresholds: Least displacement, and deviations of noise that it must exceed.
    """
    floor = hair(poses, thresholds)
    before = [each for each in rests if each.interval[0] < moved[0]]
    after = [each for each in rests if each.interval[1] > moved[1]]
    stream = poses.smooth
    first, last = moved
    if before:
        stay = before[-1]
        there = last_where(lambda frames: rests_at(stream, frames, stay, floor), first - 1)
        first = stay.interval[0] if there is None else there + 1
    if after:
        come = after[0]
        count = len(stream.times)
        there = first_where(lambda frames: rests_at(stream, frames, come, floor), last + 1, count)
        last = come.interval[1] if there is None else there - 1
    return first, last


def onset(edge: int, floor: int, poses: Poses, least: Floor, thresholds: Thresholds) -> int:
    """The frame at which a motion began, or ended, by the frames at which it passed two distances.

    People start and stop smoothly: displacement grows with the cube of time (minimum jerk; Flash
    and Hogan 1985). With the times at which it was a hair and the floor of motion that gives the
    beginning; it is no further from the edge than thresholds allow.

    Args:
        edge: Where it was a hair away from where it rests.
        floor: Where it was as far away as the floor of motion, later than the edge if it begins.
        poses: The object's poses.
        least: The floor of its motion.
        thresholds: What a hair is, and how far a beginning may be from it.
    """
    share = (least.position_m / hair(poses, thresholds).position_m) ** (1.0 / 3.0)
    if share <= 1.0:
        return edge
    rate_hz = frame_rate(poses.filled.times)
    most = round(thresholds.onset_s * rate_hz)
    before = min(round(abs(floor - edge) / (share - 1.0)), most)
    frame = edge - before if edge <= floor else edge + before
    return min(max(frame, 0), len(poses.filled.times) - 1)


def hair(poses: Poses, thresholds: Thresholds) -> Floor:
    """Displacement that noise does not explain, and at least a hair's width."""
    times = poses.filled.times
    rate_hz = frame_rate(times)
    left = thresholds.motion_sigmas * gains(rate_hz, thresholds)[0]
    return Floor(
        max(thresholds.edge_m, left * poses.noise.position_m),
        max(thresholds.edge_rad, left * poses.noise.orientation_rad),
    )
