"""Phases of a motion: rising, level, sinking, turning, rolling, leaning, reversing, lengthwise."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Stream
from capar.model.geometry import Holds, Places, Series, Turns, Vector
from extractors.bodies.bodies import BodyGeometry
from extractors.bodies.poses import Poses, rotation_matrices
from extractors.motion.object_motion import RestPose, slopes
from extractors.signals.filters import derivative, velocity
from extractors.signals.intervals import Interval, frame_rate, intervals
from extractors.thresholds import Thresholds

RISING, LEVEL, SINKING, TURNING, STILL = "rising", "level", "sinking", "turning", "still"
HEADINGS = {1: RISING, 0: LEVEL, -1: SINKING}
"""Phases of a path that leads anywhere, by whether it goes up, aside or down."""


@dataclass(frozen=True, slots=True)
class Phase:
    """A part of a motion; it begins at the frame at which the one before ends."""

    kind: str
    first: int
    last: int


def phases(
    body: BodyGeometry, motions: tuple[Interval, ...], thresholds: Thresholds
) -> tuple[Phase, ...]:
    """The phases of each motion of a body, in time.

    The path is steep where it goes up or down more than aside: at 45 degrees, where a straight
    line is fitted to the places around each frame. A phase changes only where the path has become
    clearly steep or clearly flat, and the change is placed where it passed 45 degrees, or, if the
    body hardly moves meanwhile, in the middle of that time. Phases that lead nowhere are part of
    their neighbours.
    """
    stream = body.poses.smooth
    rate_hz = frame_rate(stream.times)
    found: list[Phase] = []
    for motion in motions:
        for first, last in geometry.runs(~stream.lost[motion[0] : motion[1] + 1]):
            span = slice(motion[0] + first, motion[0] + last + 1)
            found += _joined(_parts(body, span, rate_hz, thresholds), body.middles, thresholds)
    return tuple(found)


def turns_of_height(
    found: tuple[Phase, ...], middles: Places, met: Collection[int], thresholds: Thresholds
) -> tuple[int, ...]:
    """Frames at which a body that rose steeply by a real way begins to sink by one.

    They lie in the middle of the longest level part between the two, of those before its first
    pause if there are any (where it is lost is no pause); or, where there is none, in the middle
    between the end of the rise and the beginning of the sink, which a pause in the air alone makes
    needless. Where the body comes to touch another in between, its way has ended there. A sink that
    such a frame begins ends at the next one, if the body then rises again.

    ``found``: phases, in time; a motion's follow each other without a gap. ``middles``: places of
    the body [m]. ``met``: frames at which it begins to touch another body that does not move it.
    """
    frames: list[int] = []
    before: Phase | None = None
    after_top = False
    between: list[Phase] = []
    for phase in found:
        rise_m = abs(float(middles[phase.last, 2] - middles[phase.first, 2]))
        if rise_m < thresholds.reversal_m or phase.kind not in (RISING, SINKING):
            between.append(phase)
            continue
        if before is not None and any(before.first < frame < phase.first for frame in met):
            before, after_top = None, False
        if before and before.kind != phase.kind and (before.kind == RISING or after_top):
            frames += _turn(before, between, phase, middles)
            after_top = True
        before, between = phase, []
    return tuple(frames)


def _turn(rise: Phase, between: Sequence[Phase], sink: Phase, middles: Places) -> list[int]:
    parts = [rise, *between, sink]
    gaps = [row for row, (one, two) in enumerate(pairwise(parts), 1) if one.last != two.first]
    rests = [row for row in gaps if not _lost_between(parts[row - 1], parts[row], middles)]
    first = parts[: rests[0]] if rests else parts
    level = [phase for phase in first if phase.kind == LEVEL]
    level = level or [phase for phase in between if phase.kind == LEVEL]
    if level:
        longest = max(level, key=lambda phase: _way(phase, middles))
        return [(longest.first + longest.last) // 2]
    return [] if gaps else [(rise.last + sink.first) // 2]


def _lost_between(one: Phase, other: Phase, middles: Places) -> bool:
    """Whether a body is lost between two phases, rather than at rest."""
    return bool(np.isnan(middles[one.last : other.first + 1]).any())


def _parts(body: BodyGeometry, span: slice, rate_hz: float, thresholds: Thresholds) -> list[Phase]:
    """The phases of one stretch of known frames, however short they are."""
    half = max(1, round(0.5 * thresholds.rest_window_s * rate_hz))
    way = slopes(body.middles[span], half) * rate_hz
    turn = 2.0 * geometry.lengths(slopes(body.poses.smooth.orientations[span], half))
    slow = geometry.lengths(way) < thresholds.rest_speed_mps
    if slow.all():
        turning = bool((turn * rate_hz >= thresholds.rest_speed_radps).any())
        return [Phase(TURNING if turning else STILL, span.start, span.stop - 1)]
    heading = _headings(way, slow, thresholds)
    kinds = np.array([HEADINGS[int(index)] for index in heading], dtype=object)
    still = turn * rate_hz < thresholds.rest_speed_radps
    least = round(thresholds.rest_minimum_s * rate_hz)
    for first, last in geometry.runs(slow):
        if last - first + 1 >= least and first > 0 and last < len(slow) - 1:
            kinds[first : last + 1] = STILL if still[first : last + 1].all() else TURNING
    edges = [0, *(np.flatnonzero(kinds[1:] != kinds[:-1]) + 1), len(kinds) - 1]
    return [
        Phase(str(kinds[first]), span.start + int(first), span.start + int(last))
        for first, last in pairwise(edges)
        if last > first
    ]


def _headings(way: Places, slow: Series, thresholds: Thresholds) -> Int[np.ndarray, "frames"]:
    """Up, aside or down at each frame, with hysteresis; while it is slow, as the nearest does."""
    angle = np.arctan2(way[:, 2], np.hypot(way[:, 0], way[:, 1]))
    known = np.flatnonzero(~slow)
    # Each slow frame takes the direction of the nearest one that is not.
    middle = (known[1:] + known[:-1] + 1) // 2
    angle = angle[known[np.searchsorted(middle, np.arange(len(angle)), side="right")]]
    plain = np.where(np.abs(angle) < thresholds.bend_rad, 0, np.sign(angle)).astype(np.int64)
    flat = np.abs(angle) < thresholds.flat_rad
    sure = np.where(np.abs(angle) > thresholds.steep_rad, np.sign(angle), 0).astype(np.int64)
    out = plain.copy()
    state = int(plain[0])
    for frame in range(len(angle)):
        clear = int(sure[frame])
        if clear != state and (clear or flat[frame]):
            state = clear
            begin = frame
            while begin > 0 and plain[begin - 1] == state:
                begin -= 1
            out[begin:frame] = state
        out[frame] = state
    return out


def _joined(parts: list[Phase], middles: Places, thresholds: Thresholds) -> list[Phase]:
    """The same without phases that lead nowhere: the shortest first, half to either neighbour."""
    out = list(parts)
    while len(out) > 1:
        ways = [_way(phase, middles) for phase in out]
        place = int(np.argmin(ways))
        if ways[place] >= thresholds.motion_floor_m:
            break
        gone = out.pop(place)
        middle = (gone.first + gone.last) // 2
        if place == 0:
            out[0] = replace(out[0], first=gone.first)
        elif place == len(out):
            out[-1] = replace(out[-1], last=gone.last)
        elif out[place - 1].kind == out[place].kind:
            out[place - 1] = replace(out[place - 1], last=out.pop(place).last)
        else:
            out[place - 1] = replace(out[place - 1], last=middle)
            out[place] = replace(out[place], first=middle)
    return out


def _way(phase: Phase, middles: Places) -> float:
    """How far a phase leads [m]; being still or turning is meant to lead nowhere."""
    if phase.kind in (TURNING, STILL):
        return float("inf")
    return float(np.linalg.norm(middles[phase.last] - middles[phase.first]))


def rolling(body: BodyGeometry, thresholds: Thresholds) -> tuple[Interval, ...]:
    """Closed intervals of frames in which a body rolls, as on a level through its lowest point.

    The material point straight below its middle, at the height of its lowest point, has the
    velocity v + w x r. Where the body rolls without slipping that point is at rest while the
    middle goes. Nothing here knows whether there is a support at that height; on a slope of more
    than about fifteen degrees the point of contact lies too far uphill for it to be this one.
    """
    if body.poses.rests or body.shape is None:
        return ()
    stream = body.poses.smooth
    goes = velocity(body.middles, stream.times)
    turns = angular_velocity(stream.orientations, stream.times)
    arm = np.zeros_like(goes)
    arm[:, 2] = body.boxes[0][:, 2] - body.middles[:, 2]
    pace = geometry.lengths(goes)
    slip = geometry.lengths(goes + np.cross(turns, arm))
    level = geometry.lengths(turns[:, :2])
    with np.errstate(invalid="ignore"):
        # The middle goes, the axis lies, and the point below the middle stays behind.
        holds = (pace > thresholds.rest_speed_mps) & (slip <= thresholds.slip_share * pace)
        holds &= np.abs(turns[:, 2]) <= level
    found = intervals(
        holds,
        stream.times,
        dropout_s=thresholds.dropout_s,
        minimum_s=thresholds.contact_minimum_s,
    )
    # What is not known adds nothing to the angle turned so far.
    rate = np.nan_to_num(geometry.lengths(turns))
    steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(stream.times)
    angle = np.concatenate(([0.0], np.cumsum(steps)))
    return tuple(
        (first, last) for first, last in found if angle[last] - angle[first] >= thresholds.roll_rad
    )


def angular_velocity(orientations: Turns, times: Series) -> Places:
    """Angular velocity in the world by central differences [rad/s]; NaN beside lost frames."""
    before = np.maximum(np.arange(len(times)) - 1, 0)
    after = np.minimum(np.arange(len(times)) + 1, len(times) - 1)
    lost = np.isnan(orientations[before, 0]) | np.isnan(orientations[after, 0])
    known = np.where(np.isnan(orientations), 0.5, orientations)
    rotation = Rotation.from_quat(known, scalar_first=True)
    out = (rotation[after] * rotation[before].inv()).as_rotvec()
    out /= (times[after] - times[before])[:, None]
    out[lost] = np.nan
    return np.asarray(out)


def leaning(body: BodyGeometry, upright: Vector, thresholds: Thresholds) -> tuple[Interval, ...]:
    """Closed intervals of frames in which an object leans, from when it began to lean over.

    It leans while its axis is far from the vertical. The interval also covers the tipping over
    before and the righting after, as long as it turns faster than a body at rest does, and turns
    rather than travels: its middle goes no farther meanwhile than its turning moves one end about
    the other.

    ``upright``: the axis that points up while it stands, in its own frame.
    """
    stream = body.poses.smooth
    angle = lean(stream.orientations, upright)
    pace = derivative(angle, stream.times)
    speed = geometry.lengths(derivative(body.middles, stream.times))
    with np.errstate(invalid="ignore"):
        far = angle > thresholds.lean_rad
        over, back = pace >= thresholds.rest_speed_radps, pace <= -thresholds.rest_speed_radps
    reach = np.abs(pace) * (float(body.shape.size.max()) if body.shape else 0.0)
    lapse = round(thresholds.dropout_s * frame_rate(stream.times))
    found: list[Interval] = []
    for first, last in intervals(
        far, stream.times, dropout_s=thresholds.dropout_s, minimum_s=thresholds.contact_minimum_s
    ):
        before, after = slice(first - 1, None, -1) if first else slice(0, 0), slice(last + 1, None)
        begin = first - _run(over[before] & _turns(speed[before], reach[before]), lapse)
        end = last + _run(back[after] & _turns(speed[after], reach[after]), lapse)
        if found and begin <= found[-1][1]:
            begin = found[-1][1] + 1
        found.append((begin, end))
    return tuple(found)


def _turns(speed: Series, reach: Series) -> Holds:
    """Up to which frames it has come no farther than its turning takes it; not where it is lost."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.cumsum(speed) <= np.cumsum(reach))


def _run(holds: Holds, lapse: int) -> int:
    """For how many frames from the first on it holds, but for lapses of fewer frames than so many.

    Noise makes such lapses in what is told by a rate of change.
    """
    known = np.flatnonzero(holds)
    ends = np.flatnonzero(np.diff(known, prepend=-1) > lapse)
    known = known[: ends[0]] if ends.size else known
    return int(known[-1]) + 1 if known.size else 0


def upright_axis(poses: Poses, rest: RestPose | None) -> Vector:
    """The axis that points up where a body first rests, or else in its first known frame."""
    known = np.flatnonzero(~poses.smooth.lost)
    up = np.array([0.0, 0.0, 1.0])
    if rest is not None:
        turn = rest.orientation
    elif known.size:
        turn = poses.smooth.orientations[known[0]]
    else:
        return up
    return np.asarray(rotation_matrices(turn[None])[0].T @ up)


def lean(orientations: Turns, upright: Vector) -> Series:
    """Angle of an axis of the body from the vertical at each frame [rad]."""
    up = (rotation_matrices(orientations) @ upright)[:, 2]
    return np.arccos(np.clip(up, -1.0, 1.0))


def spin_steps(orientations: Turns) -> Float[np.ndarray, "steps"]:
    """Angle by which a body turns about the vertical from each frame to the next [rad].

    It is the twist of the step's rotation; lost frames add nothing.
    """
    (w0, x0, y0, z0), (w1, x1, y1, z1) = orientations[:-1].T, orientations[1:].T
    # The step's quaternion: the later orientation times the inverse of the earlier one.
    w = w1 * w0 + x1 * x0 + y1 * y0 + z1 * z0
    x = -w1 * x0 + x1 * w0 - y1 * z0 + z1 * y0
    y = -w1 * y0 + x1 * z0 + y1 * w0 - z1 * x0
    z = -w1 * z0 - x1 * y0 + y1 * x0 + z1 * w0
    length = np.sqrt(x * x + y * y + z * z)
    with np.errstate(invalid="ignore", divide="ignore"):
        angle = 2.0 * np.arctan2(length, np.abs(w)) * np.where(w < 0.0, -1.0, 1.0)
        steps = np.where(length > 0.0, angle * z / length, 0.0)
    lost = np.isnan(orientations[:, 0])
    steps[lost[1:] | lost[:-1]] = 0.0
    return np.asarray(steps)


def lengthwise(
    body: BodyGeometry, swinging: Iterable[Interval], thresholds: Thresholds
) -> tuple[Interval, ...]:
    """Those of the stretches in which a body goes along its own length rather than across.

    ``swinging``: closed intervals of frames in which it moves to and fro.
    """
    axis = long_axis(body, thresholds)
    if axis is None:
        return ()
    least = thresholds.lengthwise_share
    out = []
    for first, last in swinging:
        part = slice(first, last + 1)
        steps = np.diff(body.poses.smooth.positions[part], axis=0)
        lengths = (body.turns_at(part) @ axis)[:-1]
        way = np.nansum(geometry.lengths(steps))
        along = np.nansum(np.abs(np.einsum("ij,ij->i", steps, lengths)))
        if way > 0.0 and along / way >= least:
            out.append((first, last))
    return tuple(out)


def long_axis(body: BodyGeometry, thresholds: Thresholds) -> Vector | None:
    """The unit axis of a long, thin body in its own frame; None for any other body.

    The axis is the principal one of its outermost points; its length along the axis is so many
    times the largest distance across that two of the points have.
    """
    points = body.corners - body.corners.mean(axis=0)
    if len(points) < 2:
        return None
    axes = np.linalg.svd(points, full_matrices=False)[2]
    along = points @ axes[0]
    across = points - np.outer(along, axes[0])
    wide = np.linalg.norm(across[:, None] - across[None], axis=2).max()
    return axes[0] if np.ptp(along) >= thresholds.slender_ratio * wide else None


def turning_points(values: Series, least: float) -> Int[np.ndarray, "turns"]:
    """Frames of extrema that lie at least so far from the extremum before and the one after.

    ``values``: A coordinate over time, known throughout. ``least``: the least way between
    neighbouring extrema, in the coordinate's unit.
    """
    found: list[int] = []
    low = high = direction = 0
    for frame, value in enumerate(values):
        if direction >= 0 and value > values[high]:
            high = frame
        if direction <= 0 and value < values[low]:
            low = frame
        if direction >= 0 and values[high] - value >= least:
            found += [high] if direction else []
            direction, low = -1, frame
        elif direction <= 0 and value - values[low] >= least:
            found += [low] if direction else []
            direction, high = 1, frame
    return np.array(found, dtype=np.int64)


def level_turns(
    middles: Places, motions: Iterable[Interval], thresholds: Thresholds
) -> tuple[int, ...]:
    """Frames at which a body turns back on the level, after a real way and before another one.

    ``middles``: the middles of the body [m]; a motion in which it is lost is left out.
    """
    found: list[int] = []
    for first, last in motions:
        part = middles[first : last + 1]
        if np.isnan(part).any() or len(part) < 2:
            continue
        offsets = part - part.mean(axis=0)
        axis = np.linalg.svd(offsets, full_matrices=False)[2][0]
        if abs(axis[2]) < thresholds.steep:
            found += [
                first + int(at) for at in turning_points(offsets @ axis, thresholds.reversal_m)
            ]
    return tuple(found)


def swings(
    poses: Poses, moving: tuple[Interval, ...], thresholds: Thresholds
) -> tuple[Interval, ...]:
    """Closed intervals of frames in which a body moves to and fro along an axis of the world.

    To and fro is a chain of turning points, each soon after the one before, whose strokes add up
    to more than the way from the first to the last: what bobs as it is carried along does not
    swing. Several axes that swing at a time are one swinging. It begins and ends with the motion
    itself, if that is soon before or after and no further than one stroke.
    """
    stream = poses.smooth
    chains: list[Interval] = []
    known = [
        (first + begin, first + end)
        for first, last in moving
        for begin, end in geometry.runs(~stream.lost[first : last + 1])
    ]
    for first, last in known:
        part = stream.positions[first : last + 1]
        for axis in range(3):
            turns = first + turning_points(part[:, axis], thresholds.swing_m)
            for chain in _chains(turns, stream.times, thresholds):
                way = np.linalg.norm(stream.positions[chain[-1]] - stream.positions[chain[0]])
                if np.abs(np.diff(stream.positions[chain, axis])).sum() > way:
                    chains.append(_whole(chain, (first, last), stream, axis, thresholds))
    out: list[Interval] = []
    for first, last in sorted(chains):
        if out and first <= out[-1][1]:
            out[-1] = (out[-1][0], max(last, out[-1][1]))
        else:
            out.append((first, last))
    return tuple(out)


def most_turns(
    stream: Stream, span: Interval, thresholds: Thresholds
) -> tuple[int, Int[np.ndarray, "turns"]]:
    """The axis of the world along which a body turns back most between two frames, and where.

    ``span``: first and last frame.

    Returns:
        The number of the axis, and the frames of its turning points.
    """
    first, last = span
    part = stream.positions[first : last + 1]
    known = np.flatnonzero(~stream.lost[first : last + 1])
    if not known.size:
        return 0, np.array([], dtype=np.int64)
    every = np.arange(len(part))
    paths = [np.interp(every, known, part[known, axis]) for axis in range(3)]
    found = [first + turning_points(path, thresholds.swing_m) for path in paths]
    axis = max(range(3), key=lambda one: (len(found[one]), float(np.ptp(paths[one]))))
    return axis, found[axis]


def _chains(
    turns: Int[np.ndarray, "turns"], times: Series, thresholds: Thresholds
) -> list[Int[np.ndarray, "turns"]]:
    if not len(turns):
        return []
    breaks = np.flatnonzero(np.diff(times[turns]) > thresholds.swing_s) + 1
    groups = np.split(turns, breaks)
    return [each for each in groups if len(each) >= thresholds.swing_turns]


def _whole(
    turns: Int[np.ndarray, "turns"],
    moving: Interval,
    stream: Stream,
    axis: int,
    thresholds: Thresholds,
) -> Interval:
    """Between its first and last turning point, or the rest that is no more than a stroke away."""
    stroke = np.abs(np.diff(stream.positions[turns, axis])).max()

    def near(edge: int, turn: int) -> bool:
        way = np.linalg.norm(stream.positions[edge] - stream.positions[turn])
        soon = abs(stream.times[edge] - stream.times[turn]) <= thresholds.swing_s
        return bool(soon and way <= stroke)

    first, last = int(turns[0]), int(turns[-1])
    return (
        moving[0] if near(moving[0], first) else first,
        moving[1] if near(moving[1], last) else last,
    )
