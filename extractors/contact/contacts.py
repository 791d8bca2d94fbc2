"""When two bodies touch: pairs by distance, where contacts truly begin and end, and blows."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.calibration import Calibration, Found, MovingGround, PairCalibration
from capar.model.capture import Capture, PivotContact, Sensor, Stream, TagObject, TagType
from capar.model.facts import Fact, Moving
from capar.model.geometry import Holds, Series, runs
from extractors.bodies.bodies import Bodies, BodyGeometry, blocks
from extractors.contact.proximity import Body, body, distance, near, screened
from extractors.contact.surfaces import surface
from extractors.contact.touch_distances import (
    Evidence,
    TouchPoints,
    estimated_pair,
    stated_pair,
    touchable,
    with_gaps,
)
from extractors.cores import shared
from extractors.motion.object_motion import resting, slopes
from extractors.signals.filters import gains, speed
from extractors.signals.intervals import Interval, duration, frame_rate, intervals, mask
from extractors.thresholds import Thresholds

FOOT = "foot"
"""The general type of an end-effector that may stand."""


def soles(capture: Capture) -> Mapping[str, str]:
    """The agent of each sensor that is an acting foot, or is part of one, by sensor."""
    feet = (each for each in capture.acting if each.end_effector == FOOT)
    parts = (part for foot in feet for part in capture.parts_of(foot.name))
    return {part.name: capture.agent_of(part) for part in parts}


def gliding(
    foot: BodyGeometry,
    ground: BodyGeometry,
    thresholds: Thresholds,
    ground_mps: tuple[float, float] = (0.0, 0.0),
) -> Holds:
    """Frames in which no part of a foot's underside is nearly still against the ground.

    Only a foot whose middle is above the whole ground can glide over it; what it does to walls is
    not asked here, nor is a slope or a room whose floor and walls are one body.

    ``ground_mps``: the level velocity of the ground's surface [m/s].
    """
    pace = np.linalg.norm(sole_velocities(foot, thresholds, ground_mps) - ground_mps, axis=1)
    with np.errstate(invalid="ignore"):
        above = foot.middles[:, 2] > ground.boxes[1][:, 2]
        return np.asarray(above & (pace > thresholds.foot_glides_mps))


def sole_velocities(
    foot: BodyGeometry, thresholds: Thresholds, ground_mps: tuple[float, float] = (0.0, 0.0)
) -> Float[np.ndarray, "frames 2"]:
    """Level velocity of the lowest part of a foot that is stillest against the ground [m/s].

    A foot rolls over its heel and its ball: while any of its lowest points is still, it stands.
    Beside a loss of tracking the nearest velocity that is known is taken.
    """
    count = len(foot.middles)
    out = np.full((count, 2), np.nan)
    if count < 2:
        return out
    stream = foot.poses.smooth
    for block in blocks(count):
        first, last = max(block.start - 1, 0), min(block.stop + 1, count)
        points = foot.middles[first:last, None] + np.swapaxes(
            foot.turns_at(slice(first, last)) @ foot.corners.T, 1, 2
        )
        moves = np.gradient(points[:, :, :2], stream.times[first:last], axis=0)
        height = points[:, :, 2]
        lowest = height <= height.min(axis=1, keepdims=True) + thresholds.patch_m
        pace = np.linalg.norm(moves - ground_mps, axis=2)
        pace = np.where(lowest & ~np.isnan(pace), pace, np.inf)
        stillest = moves[np.arange(len(moves)), pace.argmin(axis=1)]
        out[block] = stillest[block.start - first : block.stop - first]
    unknown = ~geometry.is_known(out)
    known = np.flatnonzero(~unknown)
    for frame in np.flatnonzero(unknown & ~foot.poses.lost) if known.size else ():
        out[frame] = out[known[np.abs(known - frame).argmin()]]
    return out


def moving_grounds(
    capture: Capture, bodies: Bodies, touch_m: Mapping[tuple[str, str], float], limits: Thresholds
) -> Iterator[MovingGround]:
    """Grounds over which the two feet of an agent go by steadily: the belts of treadmills.

    A ground is taken to move if neither foot ever rests in the world, and if each of them, through
    most of its contact with the ground, has the same velocity, beyond that of a foot that is set
    down. Against a belt that has stopped for a while feet rest, and no velocity is found; who
    glides on skates without a rest cannot be told from who walks on a belt.

    ``touch_m``: distance up to which each pair of bodies touches [m].
    """
    feet: dict[str, list[BodyGeometry]] = {}
    for name, agent in soles(capture).items():
        feet.setdefault(agent, []).append(bodies.sensors[name])
    grounds = [thing.name for thing in capture.objects if thing.tag is TagType.FIXED]
    for agent, own in feet.items():
        if len(own) < 2 or any(resting(foot.poses, limits) for foot in own):
            continue
        for name in grounds:
            distances = [touch_m.get((foot.name, name)) for foot in own]
            velocity = _common_velocity(own, bodies.objects[name], distances, limits)
            if velocity is not None:
                yield MovingGround(agent, name, velocity)


def _common_velocity(
    feet: Sequence[BodyGeometry],
    ground: BodyGeometry,
    distances_m: Sequence[float | None],
    limits: Thresholds,
) -> tuple[float, float] | None:
    """The velocity that every foot has through most of its contact with a ground [m/s]."""
    moves = []
    for foot, distance_m in zip(feet, distances_m, strict=True):
        surfaces = touchable(foot), touchable(ground)
        if distance_m is None or surfaces[0] is None or surfaces[1] is None:
            return None
        down = near(surfaces[0], surfaces[1], distance_m=distance_m)
        own = sole_velocities(foot, limits)[down]
        own = own[geometry.is_known(own)]
        times = foot.poses.smooth.times
        if len(own) * float(times[1] - times[0]) < limits.rest_minimum_s:
            return None
        moves.append(own)
    middle = np.median([np.median(own, axis=0) for own in moves], axis=0)
    if np.hypot(*middle) <= limits.foot_glides_mps:
        return None
    steady = [np.linalg.norm(own - middle, axis=1) <= limits.foot_glides_mps for own in moves]
    if min(frames.mean() for frames in steady) < limits.belt_share:
        return None
    with_it = np.concatenate([own[frames] for own, frames in zip(moves, steady, strict=True)])
    x, y = (float(value) for value in np.median(with_it, axis=0))
    return x, y


HAND = "hand"
JAW = "jaw"
"""A part of a gripper, between which and another it has what it grips."""


def with_meeting_hands(capture: Capture) -> Capture:
    """The capture in which hands of one person that meet are things to touch as well: SELF objects.

    That holds for hands with shapes that come together while neither has a mobile object at its
    surface; those that hold or pass something meet by the way. Who declares one of the two hands
    as an object has said which meetings are watched. Where the capture states a tolerance larger
    than noise accounts for, its surfaces are off by so much that two hands beside each other would
    meet: there they have to be declared.
    """
    limits = Thresholds()
    tolerance_m = capture.contact_tolerance_m or limits.tolerance_most_m
    if tolerance_m > limits.tolerance_most_m:
        return capture
    found: dict[str, Sensor] = {}
    objects = {each.name for each in capture.objects}
    hands = [
        each
        for each in capture.acting
        if each.end_effector == HAND and each.shape is not None and each.name not in objects
    ]
    for one, other in combinations(hands, 2):
        same = capture.agent_of(one) == capture.agent_of(other) and one.side != other.side
        if same and _meet_free(capture, one, other, tolerance_m):
            found |= {one.name: one, other.name: other}
    if not found:
        return capture
    added = tuple(
        TagObject(each.name, TagType.SELF, each.stream, each.shape, HAND, agent=each.agent)
        for each in found.values()
    )
    return replace(capture, objects=(*capture.objects, *added))


def _meet_free(capture: Capture, one: Sensor, other: Sensor, tolerance_m: float) -> bool:
    """Whether two hands ever meet with nothing mobile at either."""
    met = _near_any(capture.parts_of(one.name), [other], tolerance_m)
    met |= _near_any(capture.parts_of(other.name), [one], tolerance_m)
    if not met.any():
        return False
    hands = (*capture.parts_of(one.name), *capture.parts_of(other.name))
    mobile = [each for each in capture.objects if each.tag is TagType.MOBILE]
    busy = _near_any(hands, mobile, tolerance_m)
    return any(not busy[first : last + 1].any() for first, last in runs(met))


def _near_any(
    some: Iterable[Sensor], others: Iterable[Sensor | TagObject], tolerance_m: float
) -> Holds:
    """At which frames any of some bodies is at any of others; those without shapes are at none."""
    some, others = list(some), list(others)
    out = np.zeros(len(some[0].stream.times), dtype=bool)
    for one in some:
        for other in others:
            if one.shape is not None and other.shape is not None:
                first = body(surface(one.shape), one.stream, rests=False)
                second = body(surface(other.shape), other.stream, rests=False)
                out |= near(first, second, distance_m=tolerance_m)
    return out


def counted_meetings(
    capture: Capture,
    bodies: Bodies,
    meetings: Iterable[tuple[str, str, Interval]],
    thresholds: Thresholds,
) -> Iterator[bool]:
    """Whether each contact counts: one of two hands of an agent does not always.

    It does not while either touches a mobile object, and it is not that of a hand that rests when
    the other one comes to it. Nor does one with something fixed over which the hand only passes.

    ``meetings``: contacts: who touches what, and when.
    """
    known = list(meetings)
    hands = {each.name: each for each in capture.acting if each.end_effector == HAND}
    mobile = {each.name for each in capture.objects if each.tag is TagType.MOBILE}
    fixed = {thing.name for thing in capture.objects if thing.tag is TagType.FIXED}
    held = [(one, span) for one, other, span in known if one in hands and other in mobile]
    for one, other, span in known:
        if one in hands and other in fixed:
            busy = [its for name, its in held if name == one]
            yield not _passes_over(bodies.sensors[one], span, busy, thresholds)
            continue
        own = one in hands and other in hands
        if not own or capture.agent_of(hands[one]) != capture.agent_of(hands[other]):
            yield True
        elif any(
            name in (one, other) and span[0] <= busy[1] and busy[0] <= span[1]
            for name, busy in held
        ):
            yield False
        else:
            waits = _rests(bodies, one, span[0], thresholds)
            yield not (waits and not _rests(bodies, other, span[0], thresholds))


def _passes_over(
    hand: BodyGeometry, span: Interval, busy: Sequence[Interval], thresholds: Thresholds
) -> bool:
    """Whether a hand touches something fixed by the way, as it goes to a thing or leaves one.

    It touches a mobile object soon before or after. While it touches none it neither halts there
    nor turns back, and soon is off again.

    ``span``: the contact. ``busy``: when it touches mobile objects.
    """
    times = hand.poses.smooth.times
    if not any(
        times[low] - times[span[1]] <= thresholds.passing_by_s
        and times[span[0]] - times[high] <= thresholds.passing_by_s
        for low, high in busy
    ):
        return False
    begin, alone = span[0], np.ones(span[1] - span[0] + 1, dtype=bool)
    for low, high in busy:
        alone[max(low - begin, 0) : max(high - begin + 1, 0)] = False
    still = resting(hand.poses, thresholds)
    for first, last in ((begin + low, begin + high) for low, high in geometry.runs(alone)):
        whole = (first, last) == span
        if first == 0 or last == len(times) - 1:
            return False
        if duration((first, last), times, float(times[1] - times[0])) >= thresholds.brushing_s:
            return False
        rests = (min(last, end) - max(first, start) + 1 for start, end in still)
        stands = sum(each for each in rests if each > 0) / frame_rate(times)
        if stands >= thresholds.rest_minimum_s or (whole and not _keeps_on(hand, span, thresholds)):
            return False
    return True


def _keeps_on(hand: BodyGeometry, span: Interval, thresholds: Thresholds) -> bool:
    """Whether a hand goes on through a contact faster than it strokes, not to and fro."""
    way = hand.middles[span[0] : span[1] + 1]
    gone_m = float(np.linalg.norm(way[-1] - way[0]))
    length_m = np.linalg.norm(np.diff(way, axis=0), axis=1).sum()
    last_s = float(np.ptp(hand.poses.smooth.times[list(span)]))
    return bool(
        gone_m >= thresholds.passing_share * length_m and gone_m >= thresholds.passing_mps * last_s
    )


def _rests(bodies: Bodies, hand: str, frame: int, thresholds: Thresholds) -> bool:
    spans = resting(bodies.sensors[hand].poses, thresholds)
    return any(first <= frame <= last for first, last in spans)


ASIDE_S = 0.05
"""How long before and after a contact the course of two bodies is taken [s].

No threshold: it is the time over which the low-pass filter blurs what happens at once.
"""


def in_passing(
    one: BodyGeometry, other: BodyGeometry, contact: Interval, thresholds: Thresholds
) -> bool:
    """Whether two bodies keep their course relative to each other through a brief contact.

    A blow turns that course back or ends it, a grasp ends it, and what is pushed or struck away
    takes it over. A hand that brushes past a thing goes on as before.
    """
    first, last = contact
    times = one.poses.smooth.times
    if duration(contact, times, float(times[1] - times[0])) >= thresholds.passing_s:
        return False
    begin = int(np.searchsorted(times, times[first] - ASIDE_S - 1e-9))
    end = int(np.searchsorted(times, times[last] + ASIDE_S - 1e-9))
    if not 0 <= begin < first or not last < end < len(times):
        return False
    frames = np.array([begin, first, last, end])
    offsets = one.middles[frames] - other.middles[frames]
    before = (offsets[1] - offsets[0]) / (times[first] - times[begin])
    after = (offsets[3] - offsets[2]) / (times[end] - times[last])
    pace = float(np.linalg.norm(before))
    if not pace >= thresholds.passing_mps:
        return False
    return bool(before @ after >= thresholds.passing_share * pace**2)


@dataclass(frozen=True, slots=True)
class Contact:
    """Two bodies that touch through a closed interval of frames; an end-effector is first."""

    first: str
    second: str
    interval: Interval
    gap_m: float
    """How far they are apart at its first frame [m]; zero where they cut each other."""

    lingers: bool = False
    """Whether they have stayed near each other since, up to the last frame: if they touch again
    before they part, the contact lasts."""

    by_part: bool = False
    """Whether the first touches the second, the base of a thing, by a part of it alone."""


def contact_tolerance(capture: Capture, bodies: Bodies, thresholds: Thresholds) -> float:
    """Distance up to which bodies count as touching [m].

    The capture's own, else three deviations of the noisiest acting sensor, between 5 and 10 mm.
    """
    if capture.contact_tolerance_m is not None:
        return capture.contact_tolerance_m
    noises_m = [bodies.sensors[each.name].poses.noise.position_m for each in capture.acting]
    noise = max(noises_m, default=0.0)
    wide = thresholds.tolerance_sigmas * noise
    return min(max(wide, thresholds.tolerance_least_m), thresholds.tolerance_most_m)


def pair_distances(
    capture: Capture, bodies: Bodies, tolerance_m: float, thresholds: Thresholds
) -> Iterator[PairCalibration]:
    """At which distances each pair that is watched begins and ceases to touch.

    Where the capture states none and one of the two has no surface, the recording tells.

    ``tolerance_m``: distance up to which surfaces count as touching [m].
    """
    evidence = Evidence(capture, bodies, thresholds)
    left = thresholds.release_sigmas * gains(frame_rate(capture.times), thresholds)[0]
    found: list[PairCalibration] = []
    for first, second in watched(capture, bodies):
        pivot = _pivot(capture, first.name, second.name)
        if pivot is not None:
            found.append(stated_pair(capture, first, second, evidence, pivot.distance_m))
        elif first.shape is None or second.shape is None:
            found.append(estimated_pair(capture, first, second, evidence, tolerance_m))
        else:
            # Room for what noise is left in the distance of two bodies; none for quiet ones.
            poses = [each.poses for each in (first, second) if not each.poses.rests]
            noises = [each.noise.position_m for each in poses]
            noisy = [each for each in noises if each > thresholds.smoothing_noise_m]
            margin = left * float(np.linalg.norm(noisy)) if noisy else 0.0
            release = tolerance_m + min(margin, tolerance_m)
            found.append(PairCalibration(first.name, second.name, tolerance_m, release))
    yield from with_gaps(found, bodies, evidence)


def contacts(
    capture: Capture,
    bodies: Bodies,
    calibration: Calibration,
    limits: Thresholds,
) -> tuple[Contact, ...]:
    """Every contact that is watched for: acting sensors and mobile objects with tag objects.

    What merely brushes past is none, nor is a foot that glides over the ground fast.

    A contact that is there before and after a body was lost is taken to last in between, however
    long; one that is there on one side alone ends, or begins, where the body was last, or first,
    seen (spec 3).
    """
    pairs = tuple(watched(capture, bodies))
    surfaces = {each: touchable(each) for pair in pairs for each in pair}
    tasks = [partial(_of_pair, capture, *pair, calibration, limits) for pair in pairs]
    found = [each for some in shared(tasks, len(capture.times)) for each in some]
    direct = tuple(_direct(capture, found, surfaces, calibration))
    whole = tuple(of_end_effectors(capture, direct, calibration, limits))
    met = [(each.first, each.second, each.interval) for each in whole]
    counted = counted_meetings(capture, bodies, met, limits)
    return tuple(each for each, counts in zip(whole, counted, strict=True) if counts)


def _of_pair(
    capture: Capture,
    first: BodyGeometry,
    second: BodyGeometry,
    calibration: Calibration,
    limits: Thresholds,
) -> list[Contact]:
    """The contacts of two bodies by their distance alone."""
    pair = calibration.pair(first.name, second.name)
    if pair.found is Found.NEVER:
        return []
    one, two = touchable(first), touchable(second)
    near_by = np.zeros(len(capture.times), dtype=bool)
    if pair.pivots:
        apart = points_apart(pair, first, second)
        touching = np.nan_to_num(apart, nan=np.inf) <= pair.touch_m
    else:
        touching = near(one, two, distance_m=pair.touch_m)
        if pair.release_m > pair.touch_m and touching.any():
            near_by = near(one, two, distance_m=pair.release_m)
            edge = round(calibration.contact_dropout_s * frame_rate(capture.times))
            touching = bridged(touching, near_by, edge=edge)
    # Where a body was lost nothing begins or ends: what touched before and after has touched.
    touching = bridged(touching, first.poses.lost | second.poses.lost)
    feet = soles(capture)
    if first.name in feet and second.poses.fixed is not None and touching.any():
        ground_mps = calibration.ground_velocity(feet[first.name], second.name)
        touching &= ~gliding(first, second, limits, ground_mps)
    found: list[Contact] = []
    for interval in intervals(
        touching,
        capture.times,
        dropout_s=calibration.contact_dropout_s,
        minimum_s=calibration.contact_minimum_s,
    ):
        if in_passing(first, second, interval, limits):
            continue
        gap = float(apart[interval[0]]) if pair.pivots else distance(one, two, interval[0])
        lingers = interval[1] + 1 < len(near_by) and bool(near_by[interval[1] + 1 :].all())
        found.append(Contact(first.name, second.name, interval, gap, lingers=lingers))
    return found


def of_end_effectors(
    capture: Capture, found: Iterable[Contact], calibration: Calibration, limits: Thresholds
) -> Iterator[Contact]:
    """Contacts with those of the parts of an end-effector as its own: it touches where any does.

    What a gripper grips it touches as long as two of its parts do: one jaw may meet the thing
    shortly before the other, or leave it later.
    """
    wholes = {each.name: each.part_of for each in capture.sensors if each.part_of}
    jaws = {each.name for each in capture.sensors if each.end_effector == JAW}
    several: dict[tuple[str, str], list[Contact]] = {}
    for contact in found:
        whole = wholes.get(contact.first, contact.first)
        if whole in wholes.values():
            several.setdefault((whole, contact.second), []).append(contact)
        else:
            yield contact
    for (whole, other), parts in several.items():
        touching = mask([each.interval for each in parts], len(capture.times))
        dropout_s = calibration.contact_dropout_s
        by_part = {each.first: mask([], len(capture.times)) for each in parts}
        for each in parts:
            by_part[each.first] |= mask([each.interval], len(capture.times))
        gripped = np.sum(list(by_part.values()), axis=0) > 1
        for met in intervals(touching, capture.times, dropout_s=dropout_s, minimum_s=0.0):
            jawed = jaws & by_part.keys()
            interval = _gripped(met, gripped, capture.times, limits.jaws_s) if jawed else met
            spans = ((each.gap_m, *each.interval) for each in parts)
            gap_m = min(gap_m for gap_m, first, last in spans if first <= interval[0] <= last)
            yield Contact(whole, other, interval, gap_m)


def _gripped(
    contact: Interval, gripped: Holds, times: Float[np.ndarray, "frames"], jaws_s: float
) -> Interval:
    """A contact without what one part alone has of it shortly before and after a grip."""
    first, last = contact
    inside = first + np.flatnonzero(gripped[first : last + 1])
    if inside.size and times[inside[0]] - times[first] <= jaws_s:
        first = int(inside[0])
    if inside.size and times[last] - times[inside[-1]] <= jaws_s:
        last = int(inside[-1])
    return first, last


def _direct(
    capture: Capture,
    found: list[Contact],
    surfaces: Mapping[BodyGeometry, Body | None],
    calibration: Calibration,
) -> Iterator[Contact]:
    """The contacts without the stretches in which a mobile object is between the two."""
    mobile = [each.name for each in capture.objects if each.tag is TagType.MOBILE]
    bodies = {each.name: shape for each, shape in surfaces.items() if shape is not None}
    met = [(each.first, each.second, each.interval) for each in found]
    reach_m = calibration.contact_tolerance_m
    hidden = screened(met, bodies, mobile, reach_m=reach_m)
    for contact, parts in zip(found, hidden, strict=True):
        if not parts:
            yield contact
            continue
        count = len(capture.times)
        holds = mask([contact.interval], count) & ~mask(list(parts), count)
        for interval in intervals(
            holds, capture.times, dropout_s=0.0, minimum_s=calibration.contact_minimum_s
        ):
            yield replace(contact, interval=interval)


def watched(capture: Capture, bodies: Bodies) -> Iterator[tuple[BodyGeometry, BodyGeometry]]:
    """Pairs of bodies whose contact matters, each once.

    Each acting sensor with each tag object but itself; each mobile object with each other tag
    object. Of an object that is also an acting sensor both are watched: it may be handled too. The
    parts of an end-effector are watched as it is, if they have shapes or a stated distance.
    """
    for sensor in capture.acting:
        own = capture.parts_of(sensor.name)
        for part in own:
            for each in capture.objects:
                if each.name in {one.name for one in own}:
                    continue
                if not part.part_of or part.shape or _pivot(capture, part.name, each.name):
                    yield bodies.sensors[part.name], bodies.objects[each.name]
    mobile = sorted(thing.name for thing in capture.objects if thing.tag is TagType.MOBILE)
    for name in mobile:
        for thing in sorted(capture.objects, key=lambda other: other.name):
            if thing.name != name and not (thing.tag is TagType.MOBILE and thing.name < name):
                yield bodies.objects[name], bodies.objects[thing.name]


def bridged(touching: Holds, near_by: Holds, *, edge: int = 0) -> Holds:
    """Contact that also lasts between two of its frames if the bodies stay near by throughout.

    ``touching``: whether they touch, at each frame. ``near_by``: whether they are near by.
    ``edge``: an interruption of fewer frames than so many that the recording's begin or end cuts
    off counts as one between two frames of contact: nobody sees that it lasts, and a filter takes
    least noise away there.
    """
    out = touching.copy()
    for first, last in geometry.runs(near_by | touching):
        inside = first + np.flatnonzero(touching[first : last + 1])
        if inside.size:
            begin = 0 if first == 0 and inside[0] < edge else inside[0]
            cut_off = last == len(out) - 1 and last - inside[-1] < edge
            out[begin : (last if cut_off else inside[-1]) + 1] = True
    return out


def _pivot(capture: Capture, first: str, second: str) -> PivotContact | None:
    known = (
        each for each in capture.pivot_contacts if {each.first, each.second} == {first, second}
    )
    return next(known, None)


def points_apart(pair: PairCalibration, first: BodyGeometry, second: BodyGeometry) -> Series:
    """Distance of the points by which two bodies touch [m]; NaN where either is lost."""
    points = TouchPoints(pair.first_point, pair.second_point)
    return points.apart(first.poses.settled, second.poses.settled)


Motions = Mapping[str, Iterable[Interval]]
"""When each object moves, by its name."""


def blows(
    capture: Capture,
    bodies: Bodies,
    calibration: Calibration,
    known: Iterable[Contact],
    motions: Motions,
    thresholds: Thresholds,
) -> Iterator[Contact]:
    """Contacts of end-effectors, and of what they hold, with things that they set going."""
    acting = [each.name for each in capture.acting]
    touches = tuple(known)
    for name, spans in motions.items():
        thing = bodies.objects[name]
        for frame in set_going(thing, spans, thresholds):
            around = _around(thing, frame, thresholds)
            # What may strike besides end-effectors moves and is touched all that time.
            held = {
                each.second
                for each in touches
                if each.first in acting
                and each.second not in acting
                and each.second in set(motions) - {name}
                and each.interval[0] <= around[0]
                and around[1] <= each.interval[1]
            }
            strikers = {*acting, *held}
            if any(
                name in (each.first, each.second)
                and (each.first in strikers or each.second in strikers)
                and each.interval[0] <= around[1]
                and around[0] <= each.interval[1]
                for each in touches
            ):
                continue
            pairs = [
                (part, thing, part.name, name, other, name)
                for other in acting
                if other != name
                for part in bodies.on_end_effector(other)
                if part.shape is not None
            ]
            for each in sorted(held):
                first, second = min(each, name), max(each, name)
                pairs.append(
                    (bodies.objects[first], bodies.objects[second], first, second, first, second)
                )
            found: set[tuple[str, str]] = set()
            for one, two, first, second, whole, other in pairs:
                pair = calibration.pair(first, second)
                if (whole, other) in found or pair.pivots:
                    continue
                met = blow(one, two, frame, pair.touch_m, thresholds)
                if met is not None:
                    found.add((whole, other))
                    yield Contact(whole, other, met, 0.0)


def _around(thing: BodyGeometry, frame: int, thresholds: Thresholds) -> Interval:
    """The frames that are so near that a filter may have moved what happened there."""
    times = thing.poses.filled.times
    first = int(np.searchsorted(times, times[frame] - thresholds.blow_s))
    last = int(np.searchsorted(times, times[frame] + thresholds.blow_s, side="right")) - 1
    return first, last


def _cut(stream: Stream, part: slice) -> Stream:
    return Stream(stream.times[part], stream.positions[part], stream.orientations[part])


def set_going(
    thing: BodyGeometry, motions: Iterable[Interval], thresholds: Thresholds
) -> Iterator[int]:
    """Frames at which a thing that rested is set going at once, as nothing but a blow does.

    It is as fast as a struck thing within the time by which the filter blurs a motion.
    """
    times = thing.poses.smooth.times
    pace = speed(thing.middles, times)
    for first, _ in motions:
        soon = int(np.searchsorted(times, times[first] + thresholds.blow_s))
        with np.errstate(invalid="ignore"):
            if first > 0 and (pace[first : soon + 1] >= thresholds.struck_mps).any():
                yield first


def blow(
    one: BodyGeometry, other: BodyGeometry, frame: int, distance_m: float, thresholds: Thresholds
) -> Interval | None:
    """When two bodies met of which one is set going at a frame, by their poses as recorded.

    A low-pass that is longer than the contact takes the two apart; what was recorded has
    the noise of one frame instead, for which the tolerance of contact is meant.

    ``distance_m``: distance up to which the two touch [m].

    Returns:
        The stretch of contact nearest to the frame; None if there is none.
    """
    if one.shape is None or other.shape is None:
        return None
    first, last = _around(one, frame, thresholds)
    part = slice(first, last + 1)
    first_body = body(surface(one.shape), _cut(one.poses.filled, part), rests=False)
    second_body = body(surface(other.shape), _cut(other.poses.filled, part), rests=False)
    found = geometry.runs(near(first_body, second_body, distance_m=distance_m))
    if not len(found):
        return None
    begin, end = min(found, key=lambda each: (abs(first + each[0] - frame), each[0]))
    return first + int(begin), first + int(end)


SETTLES = (Found.CO_MOTION, Found.SETTLING)
"""Distances with room for a hand that opens: with them it is seen when it arrives and leaves."""


def arrivals(
    capture: Capture,
    bodies: Bodies,
    calibration: Calibration,
    touches: Iterable[Contact],
    moves: Iterable[Fact],
    thresholds: Thresholds,
) -> Iterator[Contact]:
    """Contacts, those by an estimated distance from when an end-effector arrives until it leaves.

    What moves beyond its floor as the end-effector comes is touched already, and what moves so as
    it goes is touched still; what merely wobbles as it is grasped or let go is not.

    ``moves``: when things move, by their floors.
    """
    motions = [each for each in moves if isinstance(each, Moving)]
    for touch in touches:
        pair = calibration.sought(touch.first, touch.second)
        settles = pair is not None and pair.pivots and pair.found in SETTLES
        if pair is None or not settles or touch.first not in bodies.sensors:
            yield touch
            continue
        one, two = bodies.sensors[touch.first], bodies.objects[touch.second]
        apart = points_apart(pair, one, two)
        first, last = settled_ends(apart, touch.interval, capture.times, thresholds)
        comes, goes = touch.interval
        first = min([first, *(max(m.first, comes) for m in motions if _in(m, touch, comes, first))])
        last = max([last, *(min(m.last, goes) for m in motions if _in(m, touch, last, goes))])
        yield replace(touch, interval=(first, last), gap_m=float(apart[first]))


def _in(move: Moving, touch: Contact, first: int, last: int) -> bool:
    """Whether it is a motion of what is touched at some of these frames."""
    return move.object == touch.second and move.first <= last and move.last >= first


def settled_ends(
    apart: Series, contact: Interval, times: Series, thresholds: Thresholds
) -> Interval:
    """The closed interval within a contact from the end of the approach to the begin of departure.

    An estimated distance has room for fingers that open. The hand has arrived when the distance no
    longer shrinks, and leaves when it begins to grow, faster than a body at rest moves.

    ``apart``: distance of the points by which the two touch [m]; NaN where either is lost.

    Returns:
        The contact itself where the two never settle.
    """
    rate_hz = frame_rate(times)
    half = max(1, round(0.5 * thresholds.rest_window_s * rate_hz))
    first, last = contact
    begin, end = max(first - half, 0), min(last + half + 1, len(apart))
    opening = slopes(apart[begin:end, None], half)[:, 0] * rate_hz
    opening = opening[first - begin : last + 1 - begin]
    # A comparison with an unknown speed is false: where either was lost nothing is settled later.
    arrived = np.flatnonzero(~(opening < -thresholds.rest_speed_mps))
    there = np.flatnonzero(~(opening > thresholds.rest_speed_mps))
    if not arrived.size or not there.size or arrived[0] >= there[-1]:
        return contact
    # A speed is that of a window about its frame, so it tells of both some frames within.
    here, gone = int(arrived[0]), int(there[-1])
    within = apart[first : last + 1]
    settled = within <= np.fmin.reduce(within[here : gone + 1]) + thresholds.edge_m
    coming, going = np.flatnonzero(~settled[:here]), np.flatnonzero(~settled[gone + 1 :])
    begins = int(coming[-1]) + 1 if coming.size else 0
    ends = gone + int(going[0]) if going.size else len(within) - 1
    return first + begins, first + ends
