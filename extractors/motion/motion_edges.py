"""True edges of motion: when a body set off and came to rest, and where it was seated."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from jaxtyping import Float, Int

from capar.model import geometry
from capar.model.capture import Stream
from capar.model.geometry import Quaternion, Series, Vector
from extractors.bodies.bodies import BodyGeometry
from extractors.bodies.poses import Poses, median_pose, rotation_matrices
from extractors.motion.object_motion import (
    Floor,
    RestPose,
    motion_floor,
    moving,
    rest_poses,
    resting,
    rests_at,
)
from extractors.signals.filters import gains
from extractors.signals.intervals import Interval, first_where, frame_rate, last_where, mask
from extractors.thresholds import Thresholds

Ways = Series

STROKES_S = tuple(0.15 * 40.0 ** (step / 11.0) for step in range(12))
"""Durations of smooth strokes (minimum jerk; Flash and Hogan 1985) that are tried [s]: from the
least duration of a rest to 6 s; longer ones begin alike."""

_PACES = np.array([1.0 / stroke_s for stroke_s in STROKES_S])

USUAL_S, RATIO = 1.0, 2.5
"""Most strokes of people's arms last for this [s], or up to so many times more or less [1]: a place
of rest is reached in half a second, a bowl is emptied in two."""

CANDIDATES = 24
"""How many beginnings are tried at once [1], then about the likely ones."""

_SPREAD = np.linspace(0.0, 1.0, CANDIDATES // 2) ** 2
"""Where they lie between when a motion is first seen and the limits [1]: the farther, the wider."""

ABOUT = 3.0
"""How many deviations about the likely beginning the next ones are tried [1]."""

STRAY = 0.1
"""Share of itself by which a displacement strays from any profile [1]: people move less smoothly
than a formula. So small displacements tell of the beginning, as far as noise lets them."""

QUIET = 0.05
"""Noise is taken for at least this share of the unit [1]: what is recorded without any drifts."""

UNEXPLAINED = 9.0
"""What no profile explains is taken for at most so many times the variance of noise [1]: then it is
followed back for a third of the longest time."""

_STROKE = np.exp(-0.5 * (np.log(np.array(STROKES_S) / USUAL_S) / np.log(RATIO)) ** 2)
_PRIOR = np.concatenate([[1.0], _STROKE * len(STROKES_S) / _STROKE.sum()])
"""How likely each profile is beforehand [1]: a steady speed is one among all strokes."""

FEWEST_FRAMES = 4
"""Fewer frames tell nothing of how a displacement grew [1]."""


def onset(
    way: Ways,
    smooth: Ways,
    seen: int,
    *,
    noise: Ways,
    place: float,
    most: int,
    rest: int,
    rate_hz: float,
) -> int:
    """The frame at which a displacement began to grow from nothing.

    ``way``: the displacement along one direction, from a place of rest to where it is well beyond,
    in units of what is seen of it [1]; NaN where it was lost. ``smooth``: the same, low-passed.
    ``seen``: the frame at which it is first seen to have left the place. ``noise``: deviation of
    each displacement that is not low-passed [1]. ``place``: deviation of the place from where it
    was taken to be [1]. ``most``: how many frames before it is seen it began at most. ``rest``: how
    many frames are looked at before that.
    """
    lost = np.isnan(way)
    before, after = np.flatnonzero(lost[:seen]), np.flatnonzero(lost[seen:])
    start = max(seen - most - rest, int(before[-1]) + 1 if before.size else 0)
    stop = seen + int(after[0]) if after.size else len(way)
    if stop <= seen or stop - start < FEWEST_FRAMES:
        return seen
    times = (np.arange(start, stop) - seen) / rate_hz
    spread = np.maximum(noise[start:stop], QUIET) ** 2 + (STRAY * smooth[start:stop]) ** 2
    earliest_s = max(float(times[0]), -most / rate_hz)
    track = Growth(way[start:stop], times, 1.0 / spread, place)
    begin_s = beginning_s(track, earliest_s, float(times[-1]))
    return seen + round(begin_s * rate_hz)


@dataclass(frozen=True, slots=True, eq=False)
class Growth:
    """A displacement along one direction, from a place on, and how well it is known."""

    way: Ways
    """How far it is from the place [1]."""

    times: Ways
    """When [s]; it is first seen at 0."""

    told: Ways
    """How much each frame tells of the beginning: its inverse variance [1]."""

    place: float
    """Deviation of the place from where it was taken to be [1]."""


def beginning_s(track: Growth, earliest_s: float, latest_s: float) -> float:
    """When a displacement began to grow from nothing [s]: the mean over all that may explain it.

    Each beginning is tried with each profile: at once, by a steady speed, or smoothly, by a stroke
    of some duration. The size of a profile is the one that fits best (weighted least squares). What
    it leaves tells how likely it is, if noise is normal; beforehand all beginnings are as likely,
    and strokes by how long they last (Bayesian model averaging; Hoeting, Madigan, Raftery and
    Volinsky 1999). The mean moves little when noise, or a frame more or less, changes which one is
    the likeliest. The farther the way is from every profile, as that of what wobbles is, the less
    far back it is followed: by as many times less as what is left is larger than noise (reduced
    chi-squared). Neither limit excludes 0.
    """
    if earliest_s >= latest_s:
        return latest_s
    tries = np.unique(np.concatenate([earliest_s * _SPREAD, latest_s * _SPREAD]))
    misfit = _misfit(track, tries)
    left = float(misfit.min()) / len(track.way)
    if left > 1.0:
        earliest_s /= float(np.sqrt(min(left, UNEXPLAINED)))
        tries = np.unique(np.concatenate([earliest_s * _SPREAD, latest_s * _SPREAD]))
        misfit = _misfit(track, tries)
    mean_s, spread_s = _mean(misfit, tries)
    half_s = ABOUT * spread_s + float(np.interp(mean_s, tries, np.gradient(tries)))
    tries = np.linspace(
        max(mean_s - half_s, earliest_s), min(mean_s + half_s, latest_s), CANDIDATES
    )
    return _mean(_misfit(track, tries), tries)[0]


def _mean(
    misfit: Float[np.ndarray, "profiles tries"], tries: Float[np.ndarray, "tries"]
) -> tuple[float, float]:
    """The mean of some beginnings by how likely they are, and their deviation from it [s]."""
    likely = _PRIOR @ np.exp(-0.5 * (misfit - misfit.min())) * np.gradient(tries)
    likely /= likely.sum()
    mean_s = float(likely @ tries)
    return mean_s, float(np.sqrt(likely @ (tries - mean_s) ** 2))


def _misfit(
    track: Growth, tries: Float[np.ndarray, "tries"]
) -> Float[np.ndarray, "profiles tries"]:
    """The weighted sum of squares that each profile leaves, from each beginning.

    All displacements are from one place: an error of it is common to all frames, so that the
    inverse of their covariance has a second term (Sherman and Morrison 1950).
    """
    since = np.maximum(track.times[None, :] - tries[:, None], 0.0)
    profiles = np.empty((1 + len(_PACES), *since.shape))
    # A steady speed, and the way done of strokes of least jerk.
    profiles[0], strokes = since, profiles[1:]
    part = np.minimum(np.multiply(since, _PACES[:, None, None], out=strokes), 1.0)
    np.multiply(part, 6.0, out=strokes)
    strokes -= 15.0
    strokes *= part
    strokes += 10.0
    cubes = part * part
    cubes *= part
    strokes *= cubes
    told, common = track.told, track.place**2 / (1.0 + track.place**2 * track.told.sum())
    sums, way_sum = profiles @ told, track.way @ told
    power = (profiles * profiles) @ told - common * sums * sums
    shared = np.maximum((profiles * track.way) @ told - common * sums * way_sum, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        explained = np.where(power > 0.0, shared**2 / power, 0.0)
    whole = (track.way * track.way) @ told - common * way_sum * way_sum
    return np.asarray(whole - explained)


AS_ONE = 2.0
"""Poses of two that move as one differ by so many deviations of what noise the filter leaves [1];
the more they differ beyond that, the less the one tells of the other."""

REFINED = 2
"""How often it is estimated how the one sits on the other [1]: from the motion, then from all
frames in which the two agree with that."""

Frames = Int[np.ndarray, "frames"]
Places = Float[np.ndarray, "frames 3"]
Turns = Float[np.ndarray, "frames 4"]


@dataclass(frozen=True, slots=True, eq=False)
class Direction:
    """Where a body goes to, or about what it turns, from a place."""

    stay: RestPose
    to: Vector
    """Direction in the world, in units of displacement [1/m or 1/rad]."""

    turns: bool
    """Whether it is an axis that the body turns about."""

    def along(self, places: Places, turns: Turns) -> Ways:
        """Displacement along it at each pose [1]; NaN where the pose is unknown."""
        return np.asarray(
            (_turned(turns, self.stay) if self.turns else places - self.stay.position) @ self.to
        )

    def noise(self, poses: Poses, lever_m: float = 0.0) -> float:
        """Deviation along it [1] of a body as recorded, or of a point so far from its origin."""
        noise = poses.noise
        goes = float(np.hypot(noise.position_m, lever_m * noise.orientation_rad))
        along = noise.orientation_rad if self.turns else goes
        return max(float(np.linalg.norm(self.to)) * along, QUIET)


def way_out(
    poses: Poses,
    partners: Collection[Poses],
    frames: Frames,
    seen: int,
    stay: RestPose,
    unit: Floor,
    left: float,
) -> tuple[Ways, Ways, Ways]:
    """How far a body goes toward its last pose, or turns, whichever is clearer.

    Where a hand holds a thing the pose of the thing follows from the hand's, whose sensor has noise
    of its own: the mean of both, weighted by inverse variances, has less noise than either. What
    the two differ by beyond noise, as while the hand still comes near, adds to the variance of what
    the hand tells.

    ``seen``: index of the one at which it is first seen to have left the place. ``stay``: the
    place. ``unit``: the unit of displacement. ``left``: what the filter leaves of a deviation of
    noise [1].

    Returns:
        Displacement as recorded and low-passed, and the deviation of each recorded one [1].
    """
    ahead = _direction(poses, int(frames[-1]), stay, unit)
    way, smooth = (ahead.along(*_at(stream, frames)) for stream in (poses.filled, poses.smooth))
    own = ahead.noise(poses)
    told = np.full(len(frames), own**-2)
    total = told * way
    for partner in partners:
        held = np.arange(len(frames)) >= seen
        for _ in range(REFINED):
            lever, turn = _mount(poses, partner, frames, held.astype(float))
            its = ahead.noise(partner, float(np.linalg.norm(lever)))
            calm = ahead.along(*_carried(partner.smooth, frames, lever, turn))
            differ = (smooth - calm) ** 2 - (AS_ONE * left) ** 2 * (own**2 + its**2)
            held = its**2 / (its**2 + np.maximum(differ, 0.0))
        raw = ahead.along(*_carried(partner.filled, frames, lever, turn))
        known = ~np.isnan(raw * held)
        total[known] += (raw * held)[known] / its**2
        told[known] += held[known] / its**2
    return total / told, smooth, np.asarray(told**-0.5)


def _at(stream: Stream, frames: Frames) -> tuple[Places, Turns]:
    return stream.positions[frames], stream.orientations[frames]


def _direction(poses: Poses, last: int, stay: RestPose, unit: Floor) -> Direction:
    """Where a body goes to until a frame, or about what it turns."""
    places, turns = _at(poses.smooth, np.array([last]))
    way, turn = places[0] - stay.position, _turned(turns, stay)[0]
    goes = np.linalg.norm(way) / unit.position_m >= np.linalg.norm(turn) / unit.rotation_rad
    to, one = (way, unit.position_m) if goes else (turn, unit.rotation_rad)
    return Direction(stay, to / (np.linalg.norm(to) * one), not goes)


def _carried(
    stream: Stream, frames: Frames, lever: Vector, turn: Quaternion
) -> tuple[Places, Turns]:
    """Poses of a body by those of another on which it sits."""
    places, turns = _at(stream, frames)
    return places + rotation_matrices(turns) @ lever, geometry.products(turns, turn[None])


def _mount(body: Poses, other: Poses, frames: Frames, held: Ways) -> tuple[Vector, Quaternion]:
    """A body's origin [m] and orientation in the frame of another on which it sits."""
    places, turns = _at(body.smooth, frames)
    origins, bearings = _at(other.smooth, frames)
    known = ~np.isnan(places[:, 0] + origins[:, 0]) & (held > 0.0)
    if not known.any():
        return np.full(3, np.nan), np.full(4, np.nan)
    offsets = (places - origins)[known, None, :] @ rotation_matrices(bearings[known])
    within = geometry.products(_inverse(bearings[known]), turns[known])
    turn = held[known] @ within
    lever = np.average(offsets[:, 0], axis=0, weights=held[known])
    return lever, turn / np.linalg.norm(turn)


def _inverse(turns: Turns) -> Turns:
    return turns * np.array([1.0, -1.0, -1.0, -1.0])


def _turned(orientations: Turns, stay: RestPose) -> Places:
    """Rotation vectors from the orientation of a place [rad]; NaN where the body is lost."""
    turn = geometry.products(orientations, _inverse(stay.orientation[None]))
    turn = np.where(turn[:, :1] < 0.0, -turn, turn)
    sine = np.linalg.norm(turn[:, 1:], axis=1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, turn[:, :1])
    # As the angle vanishes, the vector is twice the quaternion's.
    return np.asarray(turn[:, 1:] * np.where(sine > 0.0, angle / np.maximum(sine, 1e-300), 2.0))


GROWN = 8.0
"""How many times as far as it can first be seen a motion is looked at again [1].

No threshold: as displacement grows with the cube of time, that is twice as long after it began.
"""

RETURNED = 0.5
"""A stroke is over where no more than this share of its way is left, and a hair less [1]."""


def motion_edges(
    poses: Poses,
    moved: Interval,
    rests: tuple[RestPose, ...],
    floor: Floor,
    thresholds: Thresholds,
    partners: Collection[Poses] = (),
) -> Interval:
    """The interval of a motion, from when the object left one place to when it was at another.

    It began when the object was last where it had rested, and ended when it first was where it
    rests afterwards, within noise and at least a hair's width; what passed before follows from how
    it grew (``onset``). A drift is no motion, and what was nudged sets off from there.

    ``moved``: frames in which it is beyond the floor of motion.
    """
    before = [each for each in rests if each.interval[0] < moved[0]]
    after = [each for each in rests if each.interval[1] > moved[1]]
    first, last = moved
    creeps = round(thresholds.creep_s * frame_rate(poses.filled.times))
    if before:
        first = _edge(poses, before[-1], moved, 1, floor, thresholds, partners)
        grows = _well_beyond(poses, before[-1], moved, floor, floor) - moved[0]
        first = min(max(first, moved[0] - max(creeps, grows)), moved[0])
    if after:
        last = _edge(poses, after[0].at_first, moved, -1, floor, thresholds, partners)
        grows = moved[1] - _well_beyond(poses, after[0], moved[::-1], floor, floor)
        last = max(min(last, moved[1] + max(creeps, grows)), moved[1])
    return first, last


def true_rests(poses: Poses, thresholds: Thresholds) -> list[Interval]:
    """Closed intervals in which a body is slow at a place of rest, from about when it settled.

    What sets off slowly is slow for long: it is at rest for at most as long after it has set off as
    a motion usually takes until it is seen, and likewise before it has settled.
    """
    rate_hz = frame_rate(poses.filled.times)
    floor = motion_floor(poses.noise, rate_hz, own_m=None, thresholds=thresholds)
    rests = standstills(poses, floor, thresholds)
    least, unseen = (
        round(each * rate_hz) for each in (thresholds.moving_minimum_s, thresholds.onset_s)
    )
    away = np.zeros(len(poses.smooth.times), dtype=bool)
    for moved in moving(poses, rests, floor, thresholds):
        if moved[1] - moved[0] >= least:
            first, last = motion_edges(poses, moved, rests, floor, thresholds)
            away[min(first + unseen, moved[0]) : max(last - unseen, moved[1]) + 1] = True
    there = mask([each.interval for each in rests], len(away)) & ~away
    return geometry.runs(there & mask(resting(poses, thresholds), len(away)))


STEADY = 1.0 / 3.0
"""Who crosses a place on a slow way goes at least this share of his mean pace throughout [1]."""


def standstills(poses: Poses, floor: Floor, thresholds: Thresholds) -> tuple[RestPose, ...]:
    """The places where a body rests, less those that it crosses steadily on a slow way."""
    found: list[RestPose] = []
    for stay in rest_poses(poses, floor, thresholds):
        frames = np.linspace(*stay.interval, 5).round().astype(int)
        stream, first = poses.smooth, frames[0]
        start = replace(
            stay, position=stream.positions[first], orientation=stream.orientations[first]
        )
        steps = np.diff(growth(poses, frames, start, floor))
        crosses = steps.sum() >= CROSSES and steps.min() >= STEADY * steps.mean()
        if not crosses:
            found.append(stay)
    return tuple(found)


CROSSES = 1.5
"""Displacement across a place from end to end [floors of motion]: at most two, its diameter."""


def _edge(
    poses: Poses,
    stay: RestPose,
    moved: Interval,
    step: int,
    floor: Floor,
    thresholds: Thresholds,
    partners: Collection[Poses],
) -> int:
    """When an object left a place (``step`` 1), or was at a place to stay (``step`` -1)."""
    near = hair(poses, thresholds)
    begin, end = moved[::step]
    edge = _away(poses, stay, begin, step, near)
    nudged = _nudged(poses, np.arange(begin, edge - step, -step), stay, near, thresholds)
    if nudged is not None:
        stay, edge = nudged, _away(poses, nudged, begin, step, near)
    motion = edge, max(end, edge) if step > 0 else min(end, edge)
    return _onset(poses, stay, motion, step, floor, thresholds, partners)


def _away(poses: Poses, stay: RestPose, begin: int, step: int, near: Floor) -> int:
    """The frame next to a motion at which an object is first, or last, not at a place."""
    at_place = partial(rests_at, poses.smooth, stay=stay, floor=near)
    if step > 0:
        there = last_where(at_place, begin - 1)
        return stay.interval[0] if there is None else there + 1
    there = first_where(at_place, begin + 1, len(poses.smooth.times))
    return stay.interval[1] if there is None else there - 1


def _nudged(
    poses: Poses,
    frames: Int[np.ndarray, "some"],
    stay: RestPose,
    near: Floor,
    thresholds: Thresholds,
) -> RestPose | None:
    """Where an object stood beside its place of rest, next to its motion; None if it did not."""
    # Noise hides that it creeps on, the longer the larger it is.
    least_s = thresholds.rest_minimum_s * near.position_m / thresholds.edge_m
    window = max(1, round(least_s * frame_rate(poses.filled.times)))
    grows = growth(poses, frames, stay, near)
    with np.errstate(invalid="ignore"):
        stands = np.flatnonzero(grows[:-window] <= grows[window:])
    if not stands.size:
        return None
    ends = frames[stands[0]], frames[stands[0] + window]
    first, last = int(min(ends)), int(max(ends))
    place = median_pose(poses.smooth, slice(first, last + 1))
    return RestPose((first, last), *place, last + 1 - first)


def growth(
    poses: Poses, frames: Int[np.ndarray, "some"] | slice, stay: RestPose, unit: Floor
) -> Float[np.ndarray, "some"]:
    """How far an object is from a place, or turned, in units of a displacement [1]; NaN if lost."""
    stream = poses.smooth
    distance = geometry.lengths(stream.positions[frames] - stay.position)
    angle = geometry.angle_between(stream.orientations[frames], stay.orientation[None])
    return np.asarray(np.maximum(distance / unit.position_m, angle / unit.rotation_rad))


def _onset(
    poses: Poses,
    stay: RestPose,
    motion: tuple[int, int],
    step: int,
    floor: Floor,
    thresholds: Thresholds,
    partners: Collection[Poses],
) -> int:
    """The frame at which a motion out of a place truly began, or one into it truly ended."""
    near, rate_hz = hair(poses, thresholds), frame_rate(poses.filled.times)
    rest = round(thresholds.rest_minimum_s * rate_hz)
    edge, start = motion[0], stay.interval[0 if step > 0 else 1]
    far = _well_beyond(poses, stay, motion, near, floor)
    most = max(longest(poses, near, thresholds), step * (far - edge))
    seen = max(min(step * (edge - start), most + rest), 0)
    frames = np.arange(edge - step * seen, far + step, step)
    if len(frames) <= seen + 1:
        return edge
    left = gains(rate_hz, thresholds)[0]
    way, smooth, noise = way_out(poses, partners, frames, seen, stay, near, left)
    # A place is the mean of the middle half of the poses there.
    place = float(np.median(noise)) / np.sqrt(0.5 * stay.frames)
    begin = onset(
        way, smooth, seen, noise=noise, place=place, most=most, rest=rest, rate_hz=rate_hz
    )
    return int(frames[begin])


def _well_beyond(
    poses: Poses, stay: RestPose, motion: tuple[int, int], near: Floor, floor: Floor
) -> int:
    """The frame, from the first of a motion to the last, at which it is clear how it grew."""
    step = 1 if motion[0] <= motion[1] else -1
    frames = np.arange(motion[0], motion[1] + step, step)
    reach = min(floor.position_m / near.position_m, floor.rotation_rad / near.rotation_rad)
    grows = growth(poses, frames, stay, near)
    lost = np.flatnonzero(np.isnan(grows))
    grows = grows[: int(lost[0])] if lost.size else grows
    if not grows.size:
        return int(frames[0])
    farthest = np.maximum.accumulate(grows)
    back = np.flatnonzero(grows < np.minimum(RETURNED * farthest, farthest - 1.0))
    grows = grows[: int(back[0])] if back.size else grows
    beyond = np.flatnonzero(grows >= max(reach, GROWN))
    return int(frames[beyond[0] if beyond.size else np.argmax(grows)])


def longest(poses: Poses, near: Floor, thresholds: Thresholds) -> int:
    """How many frames a motion lasts at most until it is seen: longer where noise hides more."""
    share = float(np.cbrt(near.position_m / thresholds.edge_m))
    return round(thresholds.onset_s * share * frame_rate(poses.filled.times))


def hair(poses: Poses, thresholds: Thresholds) -> Floor:
    """Displacement that noise does not explain, and at least a hair's width."""
    times = poses.filled.times
    rate_hz = frame_rate(times)
    left = thresholds.motion_sigmas * gains(rate_hz, thresholds)[0]
    return Floor(
        max(thresholds.edge_m, left * poses.noise.position_m),
        max(thresholds.edge_rad, left * poses.noise.orientation_rad),
    )


REACHES = 3
"""How far beyond a contact a height is followed, in the longest times until it is seen [1]."""

POWERS = (1.0, 3.0)
"""With which power of time a displacement grows [1]: at once, by a steady push, smoothly."""

AGREEMENT = 0.1
"""A beginning is sure if both estimates of how long ago it was differ by no larger share [1]."""

UNSURE = 1.0 / 3.0
"""Share of the longest time by which a motion may have begun earlier if that is not sure [1]: what
drifts, or is recorded at few frames, grows with no power of time."""

LEAST = 0.01
"""A displacement is taken for at least this [1], since less is noise."""


def seat(
    body: BodyGeometry,
    other: BodyGeometry,
    contact: Interval,
    motions: Collection[Interval],
    thresholds: Thresholds,
) -> Interval:
    """The closed interval within a contact in which the body is down on the other.

    Bodies touch within a tolerance, so that a contact begins before the body has come down and
    lasts after it has risen. It is down until it begins to rise to where the contact ends: until
    its lowest point was last no more than a hair above its level before that, as far back as it was
    no higher than a hair above the lowest; and likewise at the beginning. What rises as soon as it
    has come down is down where it was lowest.
    """
    first, last = contact
    height = body.boxes[0][:, 2] - other.middles[:, 2]
    near = hair(body.poses, thresholds)
    most = longest(body.poses, near, thresholds)
    least = near.position_m
    lies = max(1, round(thresholds.rest_begins_s * frame_rate(body.poses.filled.times)))
    begin = first + _settled(height[first : last + 1], height[:first][::-1], least, most, lies)
    end = last - _settled(height[first : last + 1][::-1], height[last + 1 :], least, most, lies)
    coming = max((m[1] for m in motions if m[0] <= first <= m[1]), default=first)
    going = min((m[0] for m in motions if m[0] <= last <= m[1]), default=last)
    begin, end = min(begin, coming), max(end, going)
    if begin <= end:
        return begin, end
    # It rose as soon as it had come down.
    lowest = end + int(np.nanargmin(height[end : begin + 1]))
    return lowest, lowest


def _settled(
    height: Series, outside: Float[np.ndarray, "others"], least: float, most: int, lies: int
) -> int:
    """How many frames pass before it is down, from the first on, as far as it was not lost."""
    lost = np.flatnonzero(np.isnan(height))
    height = height[: lost[0]] if lost.size else height
    if not height.size:
        return 0
    lowest = np.minimum.accumulate(height)
    higher = np.flatnonzero(height > lowest + least)
    end = int(higher[0]) if higher.size else len(height)
    since = np.searchsorted(-lowest, -(lowest + least))
    long = np.flatnonzero(np.arange(len(height)) - since >= lies - 1)
    end = min(end, int(long[0]) + 1) if long.size else end
    down = np.flatnonzero(height[:end] <= lowest[end - 1] + least)[0]
    level = float(np.median(height[down:end]))
    passed = int(np.flatnonzero(height[:end] <= level + least)[0])
    way = np.concatenate([height[: passed + 1][::-1], outside[: REACHES * most]])
    later = before_seen((way - level) / least, GROWN, most)
    return min(passed + later, end - 1)


def before_seen(grows: Float[np.ndarray, "some"], reach: float, most: int) -> int:
    """How many frames before it is 1 a displacement that grows with a power of time was none.

    The power is the one of ``POWERS`` that agrees best with when it was half as large, in powers
    of ten, as in the end.

    ``grows``: the displacement, from where it is about 1 on. ``reach``: how large it should have
    grown for this to be told [1]; less if it never is. ``most``: the answer at most.
    """
    if not grows.size or np.isnan(grows[0]):
        return 0
    large = np.flatnonzero(grows >= reach)
    far = int(large[0]) if large.size else int(np.nanargmax(grows))
    begin, end = max(float(grows[0]), LEAST), float(grows[far])
    if end <= begin:
        return 0
    middle = float(np.sqrt(begin * end))
    half = int(np.flatnonzero(grows[: far + 1] >= middle)[0])
    tries = []
    for power in POWERS:
        first, second, last = (value ** (1.0 / power) for value in (begin, middle, end))
        # How long it took to ``begin`` if it then takes so many frames to the end or the middle.
        tries.append((far * first / (last - first), half * first / (second - first)))
    whole, part = min(tries, key=lambda both: abs(1.0 - both[1] / both[0]))
    if abs(1.0 - part / whole) > AGREEMENT:
        most = round(most * UNSURE)
    return min(round(whole), most)
