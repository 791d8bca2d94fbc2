"""Measure a capture: every extractor in one table, and the facts and notices that they state."""

import math
from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from itertools import combinations
from operator import attrgetter
from typing import Any, cast

import numpy as np
from jaxtyping import Int

from capar.model.calibration import Calibration, Found
from capar.model.capture import Capture, Role, Sensor, ShapeSource, TagObject, TagType
from capar.model.facts import (
    MEASURED,
    Between,
    ClosingSpeed,
    ContactNormal,
    Displaced,
    DrawsBack,
    Fact,
    Flies,
    ForceTransfer,
    Frames,
    Gap,
    Guided,
    Intended,
    Leans,
    Lengthwise,
    Lies,
    Link,
    LookingAt,
    Moving,
    Observed,
    OfAgent,
    Opening,
    Passage,
    Pause,
    Phase,
    PressDirection,
    RateMhz,
    ReleaseSpeed,
    Resting,
    Reverses,
    Rides,
    Rolls,
    SightNormal,
    Swings,
    Tag,
    Touching,
    ZeroCrossing,
)
from capar.model.geometry import Places, Series, Vector
from capar.model.notices import Notice, Value, notice
from extractors.bodies.bodies import Bodies, BodyGeometry, bodies_of, trunk_sensor
from extractors.bodies.poses import Poses
from extractors.calibration import calibrated, check_clock, thresholds_of
from extractors.contact.blows import arrivals, blows
from extractors.contact.contacts import Contact, EarlierAnswers, contacts
from extractors.contact.normals import contact_normal
from extractors.contact.surfaces import surface
from extractors.contact.touch_distances import forget_touchable, touching_part
from extractors.faults.faults import faults
from extractors.motion.impacts import closing_speed, falls, release_speed
from extractors.motion.motion_edges import motion_edges
from extractors.motion.object_motion import Floor, moving, rest_poses, resting
from extractors.motion.phases import (
    leaning,
    lengthwise,
    level_turns,
    phases,
    rolling,
    swings,
    turns_of_height,
)
from extractors.relations.arrangement import (
    ARRANGEMENTS,
    Holds,
    Pair,
    between,
    company,
    shifts,
    sides,
)
from extractors.relations.attention import Attention, attention, seeing, sight
from extractors.relations.guides import Guide, guide_of, turns_on_guide
from extractors.relations.places import (
    FROM_THE_BEGINNING,
    Sums,
    distances,
    places,
    rooms,
    trunk_places,
)
from extractors.relations.support import bearing, rides, seated
from extractors.signals.filters import long_gaps, speed
from extractors.signals.intervals import Interval, intervals
from extractors.signals.zero_crossings import horizon_frames, pauses, zero_crossings
from extractors.thresholds import Thresholds

FramesByBody = Mapping[str, Sequence[int]]
"""Frames by body, ascending."""


def boundary_frames(facts: Iterable[Fact], acting: Iterable[str], last_frame: int) -> FramesByBody:
    """For each end-effector every frame where something that concerns it begins or ends.

    For each object that it touches, those of these frames at which it touches it, with the one
    before and the one after.

    ``acting``: the end-effectors. ``last_frame``: the capture's last frame.
    """
    frames: dict[str, set[int]] = defaultdict(set)
    touches: dict[str, list[Touching]] = defaultdict(list)
    for fact in facts:
        if isinstance(fact, Observed) and fact.declaration.border:
            frames[fact.subject()].update(fact.ends())
        if isinstance(fact, Touching):
            touches[fact.body].append(fact)
    out: dict[str, set[int]] = defaultdict(set)
    for ee in acting:
        own = {0, last_frame} | frames[ee]
        for name in {each.other for each in touches[ee]}:
            own |= frames[name]
        out[ee] |= own
        ordered = sorted(own)
        for touch in touches[ee]:
            out[touch.other].update(_around(ordered, touch.first, touch.last))
    return {name: tuple(sorted(out[name])) for name in sorted(out)}


def _around(ordered: Sequence[int], first: int, last: int) -> Sequence[int]:
    low = max(bisect_left(ordered, first) - 1, 0)
    return ordered[low : bisect_right(ordered, last) + 1]


PASSED = ("inside", "above")
"""Arrangements that a body may pass through."""

SHIFTS = "shifts"
"""That an end-effector goes to another place on what it touches."""

NEAR = "near"
"""That it is within reach of another for a while and does not touch it."""


def handling(
    capture: Capture,
    bodies: Bodies,
    known: Iterable[Fact],
    calibration: Calibration,
    thresholds: Thresholds,
    guides: Mapping[str, Guide],
    since: Sums = FROM_THE_BEGINNING,
    *,
    whole: bool = False,
) -> tuple[Fact, ...]:
    """Rest, turning points, leaning, falls, arrangements and places of handled bodies.

    Handled are the acting end-effectors and every mobile object that one of them touches.

    ``since``: ways and turns before, of which this capture is the continuation. ``whole``: whether
    this is a whole recording, and no part of one.
    """
    seen = list(known)
    touches = [fact for fact in seen if isinstance(fact, Touching)]
    acting = [sensor.name for sensor in capture.acting]
    held = {touch.other for touch in touches if touch.body in acting}
    hands = {sensor.name: bodies.sensors[sensor.name] for sensor in capture.acting}
    things = bodies.objects
    mobile = [
        thing for thing in capture.objects if thing.tag is TagType.MOBILE and thing.name in held
    ]
    mobiles = {body.name for body in mobile}
    upright = {thing.name: np.array(thing.upright) for thing in calibration.objects}
    upright |= {sensor.name: np.array(sensor.upright) for sensor in calibration.sensors}
    trunks = _trunks(capture)
    out: list[Fact] = []
    for name, hand in hands.items():
        out += (Resting(name, *rest) for rest in resting(hand.poses, thresholds))
    for body in mobile:
        guide = guides.get(body.name)
        out += _motion(things[body.name], seen, upright[body.name], thresholds, guide)
    out += seated(things, hands, touches, seen, thresholds)
    out += bearing(capture, bodies, touches, calibration, thresholds)
    borders = boundary_frames([*seen, *out], acting, len(capture.times) - 1)
    others = (things[body.name] for body in mobile if body.name not in hands)
    for one in (*hands.values(), *others):
        frames = tuple(borders.get(one.name, ()))
        out += places(one, upright[one.name], frames, since)
        if one.name in trunks:
            trunk = bodies.sensors[trunks[one.name]]
            out += trunk_places(one, trunk, upright[trunk.name], frames)
        out += _openings(one.name, guides, frames)
        for other in things.values():
            if other.name != one.name:
                out += distances(one, other, frames, since, whole=whole)
                out += _arranged(one, other, touches, thresholds)
        out += _between(one, [other for other in things.values() if other is not one], thresholds)
    for touch in touches:
        if touch.body in hands and touch.other in mobiles and touch.body != touch.other:
            touching = (touch.first, touch.last)
            spans = shifts(hands[touch.body], things[touch.other], touching, thresholds)
            out += (Lies(touch.body, SHIFTS, touch.other, *span) for span in spans)
            left_mps = release_speed(things[touch.other], touch.last)
            out.append(ReleaseSpeed(touch.body, touch.other, touch.first, round(1000.0 * left_mps)))
    kinds = {thing.name: thing.kind for thing in capture.objects}
    out += rooms(things, kinds, touches, tuple(out), thresholds)
    out += _contacts(capture, bodies, touches, thresholds)
    out += _loads(capture, things, seen, thresholds)
    return tuple(out)


def _trunks(capture: Capture) -> dict[str, str]:
    """The trunk of the agent whose each end-effector is, where one is tracked."""
    own: dict[str, list[Sensor]] = defaultdict(list)
    for sensor in capture.sensors:
        own[capture.agent_of(sensor)].append(sensor)
    trunks = {agent: trunk_sensor(sensors) for agent, sensors in own.items()}
    found = ((sensor.name, trunks[capture.agent_of(sensor)]) for sensor in capture.acting)
    return {name: trunk.name for name, trunk in found if trunk and trunk.name != name}


def _motion(
    one: BodyGeometry,
    known: list[Fact],
    upright: Vector,
    thresholds: Thresholds,
    guide: Guide | None,
) -> Iterator[Fact]:
    pose = one.poses
    moves = tuple(
        (fact.first, fact.last)
        for fact in known
        if isinstance(fact, Moving) and fact.object == one.name
    )
    motions = tuple(
        (fact.first, fact.last)
        for fact in known
        if isinstance(fact, Displaced) and fact.object == one.name
    )
    found = phases(one, motions, thresholds)
    yield from (Phase(one.name, phase.kind, phase.first, phase.last) for phase in found)
    if guide is None:
        met = [fact.first for fact in known if isinstance(fact, Touching) and fact.body == one.name]
        turns = turns_of_height(found, one.middles, met, thresholds)
    else:
        turns = turns_on_guide(guide, motions, thresholds)
        yield Guided(one.name, guide.fit.kind, guide.base)
    yield from (Reverses(one.name, frame) for frame in turns)
    back = level_turns(one.middles, motions, thresholds)
    yield from (DrawsBack(one.name, frame) for frame in back)
    swinging = swings(pose, moves, thresholds)
    yield from (Swings(one.name, *span) for span in swinging)
    yield from (Lengthwise(one.name, *span) for span in lengthwise(one, swinging, thresholds))
    length_m = float(one.shape.size.max()) if one.shape else 0.0
    leans = leaning(pose, upright, thresholds, length_m=length_m)
    yield from (Leans(one.name, *span) for span in leans)
    yield from (Flies(one.name, *span) for span in falls(one, thresholds))
    yield from (Rolls(one.name, *span) for span in rolling(one, thresholds))


def _openings(name: str, guides: Mapping[str, Guide], frames: tuple[int, ...]) -> Iterator[Fact]:
    """How far a body on a guide is from its closed place at some frames; lost ones are left out."""
    if name in guides:
        opening = guides[name].opening
        for frame in frames:
            if not np.isnan(opening[frame]):
                yield Opening(name, frame, round(1000.0 * float(opening[frame])))


def _arranged(
    one: BodyGeometry, other: BodyGeometry, touches: Iterable[Touching], thresholds: Thresholds
) -> Iterator[Fact]:
    pair = Pair(one, other, thresholds)
    for how, arrangement in ARRANGEMENTS.items():
        for span in _spans(arrangement(pair), one, thresholds):
            yield Lies(one.name, how, other.name, *span)
            if how in PASSED and span[0] > 0 and span[1] < len(one.middles) - 1:
                yield Passage(one.name, how, other.name, span[0], sides(one, other, np.array(span)))
    touching = [
        (touch.first, touch.last)
        for touch in touches
        if (touch.body, touch.other) == (one.name, other.name)
    ]
    for first, last in _spans(pair.near, one, thresholds):
        if not any(begin <= last and end >= first for begin, end in touching):
            yield Lies(one.name, NEAR, other.name, first, last)


def _between(
    one: BodyGeometry, others: list[BodyGeometry], thresholds: Thresholds
) -> Iterator[Fact]:
    for first, second in combinations(sorted(others, key=lambda body: body.name), 2):
        for span in _spans(between(one, first, second), one, thresholds):
            yield Between(one.name, first.name, second.name, *span)


def _spans(holds: Holds, one: BodyGeometry, thresholds: Thresholds) -> list[Interval]:
    return intervals(
        holds,
        one.poses.smooth.times,
        dropout_s=thresholds.dropout_s,
        minimum_s=thresholds.contact_minimum_s,
    )


def _loads(
    capture: Capture, things: Mapping[str, BodyGeometry], known: list[Fact], thresholds: Thresholds
) -> Iterator[Fact]:
    """What mobile objects bear in or on them and take along."""
    mobile = {body.name for body in capture.objects if body.tag is TagType.MOBILE}
    motions: dict[str, list[Interval]] = defaultdict(list)
    for fact in known:
        if isinstance(fact, Moving):
            motions[fact.object].append((fact.first, fact.last))
    for fact in known:
        if isinstance(fact, Touching) and {fact.body, fact.other} <= mobile:
            load, bearer = things[fact.body], things[fact.other]
            span = fact.first, fact.last
            if rides(load, bearer, span, motions[fact.other], thresholds):
                yield Rides(fact.body, fact.other, fact.first)


def _sides(touch: Touching, normal: Vector, capture: Capture, bodies: Bodies) -> Iterator[Fact]:
    """On which side an end-effector touches what can be moved, and what looks somewhere."""
    body, other, first = touch.body, touch.other, touch.first
    if any(body.name == other and body.tag is TagType.MOBILE for body in capture.objects):
        x, y = (round(-1000.0 * float(part)) for part in normal[:2])
        yield PressDirection(body, other, first, x, y)
    for head in seeing(capture):
        if head.name == other:
            along = float(normal @ sight(head, bodies.sensors[other].poses)[1][first])
            if not np.isnan(along):
                yield SightNormal(body, other, first, round(1000.0 * along))


def _contacts(
    capture: Capture, bodies: Bodies, touches: Iterable[Touching], thresholds: Thresholds
) -> Iterator[Fact]:
    upward: dict[tuple[str, str, int], int] = {}
    acting = {sensor.name for sensor in capture.acting}
    for touch in touches:
        other = bodies.objects[touch.other]
        if touch.body in acting:
            body = touching_part(bodies, touch.body, other, touch.first)
        else:
            body = bodies.objects[touch.body]
        swapped = upward.get((touch.other, touch.body, touch.first))
        if swapped is not None:
            yield ContactNormal(touch.body, touch.other, touch.first, -swapped)
        elif (normal := contact_normal(body, other, touch.first, thresholds)) is not None:
            permille = upward[touch.body, touch.other, touch.first] = round(
                1000.0 * float(normal[2])
            )
            yield ContactNormal(touch.body, touch.other, touch.first, permille)
            if touch.body in acting:
                yield from _sides(touch, normal, capture, bodies)
        speed = closing_speed(body, other, touch.first)
        yield ClosingSpeed(touch.body, touch.other, touch.first, round(1000.0 * speed))


LOSS = "long-gap"
"""The notice of a body that was lost for long: one a body, in place of the reader's one a gap."""


def notices_of(
    capture: Capture, calibration: Calibration, thresholds: Thresholds
) -> Iterator[Notice]:
    """What a reader of facts should know: how bodies touch, what is assumed, and what was lost."""
    stated = capture.contact_tolerance_m is not None
    yield notice("contact-tolerance", tolerance_m=calibration.contact_tolerance_m, stated=stated)
    yield from _distance_notices(calibration)
    found = [pair for pair in calibration.pairs if pair.found is not Found.NEVER]
    known = {name for pair in found for name in (pair.first, pair.second)}
    touching: tuple[Sensor | TagObject, ...] = (*capture.acting, *capture.objects)
    for body in touching:
        if body.shape is None and body.name not in known:
            yield notice("no-shape", body.name)
        elif body.shape is not None and body.shape.source is ShapeSource.STAND_IN:
            yield notice("stand-in-shape", body.name, shape=body.shape.description)
    yield from _pose_notices(capture, thresholds)
    for belt in calibration.moving_grounds:
        pace = math.hypot(*belt.velocity_mps)
        yield notice("moving-ground", belt.ground, agent=belt.agent, speed_mps=pace)


def _distance_notices(calibration: Calibration) -> Iterator[Notice]:
    """How bodies without surfaces touch, and where the recording contradicts what is taken."""
    for pair in calibration.pairs:
        names, taken = (pair.first, pair.second), pair.touch_m
        if pair.found is Found.STATED:
            yield notice("pivot-distance", *names, distance_m=taken)
        elif pair.found not in (Found.TOLERANCE, Found.NEVER):
            how = pair.found.value
            yield notice("touch-estimated", *names, touch_m=taken, found=how, frames=pair.frames)
        if pair.shown_m is not None:
            code = "mount-gap" if pair.found is Found.TOLERANCE else "distance-contradicted"
            values = {"touch_m": taken, "shown_m": pair.shown_m, "frames": pair.frames}
            yield notice(code, *names, **values)


def _pose_notices(capture: Capture, thresholds: Thresholds) -> Iterator[Notice]:
    everything: tuple[Sensor | TagObject, ...] = (*capture.sensors, *capture.objects)
    for body in everything:
        if isinstance(body, TagObject) and body.assumed:
            yield notice("assumed-support", body.name, assumed=body.assumed)
        lost = [
            (first, last)
            for first, last in long_gaps(body.stream, gap_s=thresholds.gap_s)
            if last - first + 1 >= thresholds.gap_s * capture.rate_hz
        ]
        if lost:
            fixed = isinstance(body, TagObject) and body.tag is TagType.FIXED
            yield _loss(body, lost, capture.times, fixed=fixed)


def _loss(
    body: Sensor | TagObject, lost: list[tuple[int, int]], times: Series, *, fixed: bool
) -> Notice:
    """How often a body was lost for long, and when at most; without times if it was throughout.

    With times, also for how long in all [s], of how much [s]; and how far it was then [m] from
    where it was before, where that is known.
    """
    first, last = max(lost, key=lambda gap: gap[1] - gap[0])
    if last - first + 1 == len(times):
        return notice(LOSS, body.name, times=len(lost), fixed=fixed)
    values: dict[str, Value] = {
        "times": len(lost),
        "fixed": fixed,
        "lost_s": float(sum(times[until] - times[since] for since, until in lost)),
        "of_s": float(times[-1] - times[0]),
    }
    if first > 0 and last < len(times) - 1:
        places = body.stream.positions[[first - 1, last + 1]]
        values["moved_m"] = float(np.linalg.norm(places[1] - places[0]))
    start_s, end_s = float(times[first]), float(times[last])
    return notice(LOSS, body.name, start_s=start_s, end_s=end_s, **values)


LONG_S = 600.0
"""A recording of this length [s] or more takes so long to measure that to make the offset surfaces
of its bodies once more, some seconds, hardly counts."""

ANY = "any"
"""What an empty field of a purpose is in a fact."""


@dataclass(frozen=True, eq=False)
class Track:
    """The low-passed motion of one tracking sensor."""

    poses: Poses
    """Of the sensor."""

    crossings: Int[np.ndarray, "crossings"]
    """Frames at which its acceleration crosses zero."""

    pauses: Int[np.ndarray, "pauses"]
    """Those of them between which it is faster."""

    @property
    def speed_mps(self) -> Series:
        """How fast it is [m/s]; NaN where lost. Computed again each time."""
        return speed(self.positions, self.poses.smooth.times)

    @property
    def positions(self) -> Places:
        """World positions [m]; NaN where lost."""
        return self.poses.smooth.positions


@dataclass(frozen=True, slots=True)
class Arriving:
    """A rest that has just begun: later frames tell its place, and by it when it began."""

    first: int
    """Its first frame, as far as it is known."""

    missing: int
    """Frames of it that are still to be seen [1]."""


@dataclass(frozen=True, eq=False)
class Measurements:
    """What was measured in a capture; no word of what was done."""

    facts: tuple[Fact, ...]
    """In the order of ``capar.model.facts.MEASURED``, then by value."""

    notices: tuple[Notice, ...]
    """What the capture's user ought to know, the capture's own first."""

    calibration: Calibration
    """What was decided for the whole recording."""

    tracks: Mapping[str, Track]
    """By acting sensor."""

    attention: Mapping[str, Attention]
    """By sensor that attends, and by head that acts."""

    bodies: Bodies
    guides: Mapping[str, Guide]
    """The hinge or rail of each object that moves on one, by object."""

    lingering: Mapping[tuple[str, str], int] = field(default_factory=dict)
    """Bodies that have stayed so near each other, since the last frame of their contact, that it
    lasts if they touch again; with that frame."""

    arriving: Mapping[str, Arriving] = field(default_factory=dict)
    """Objects whose last rest is not seen for so long yet that its place is told."""


def measure(
    capture: Capture, calibration: Calibration | None = None, since: Sums = FROM_THE_BEGINNING
) -> Measurements:
    """Measure a capture: zero crossings, contacts, motions and looks, as facts.

    ``since``: ways and turns before, where the capture is a later part of a recording.

    Raises:
        CaptureError: The calibration is for another rate.
        UnknownNameError: The calibration lacks a body of the capture.
    """
    if calibration is None:
        calibration, bodies = calibrated(capture, Thresholds())
    else:
        check_clock(capture, calibration)
        bodies = bodies_of(capture, thresholds_of(calibration), calibration)
    whole = since is FROM_THE_BEGINNING
    return measured(capture, calibration, bodies, since, whole=whole)


def measured(
    capture: Capture,
    calibration: Calibration,
    bodies: Bodies,
    since: Sums = FROM_THE_BEGINNING,
    *,
    answers: EarlierAnswers | None = None,
    notices: bool = True,
    whole: bool = False,
) -> Measurements:
    """The same with bodies that were made by the calibration.

    ``since``: ways and turns before, where the capture is a later part of a recording. ``notices``:
    whether losses and faults are sought, too. ``whole``: whether this is a whole recording: angles
    that stay small in it are left out.
    """
    limits = thresholds_of(calibration)
    tracks = {
        sensor.name: _track(
            bodies.sensors[sensor.name].poses,
            calibration.sensor(sensor.name).highest_speed_mps,
            limits,
        )
        for sensor in capture.acting
    }
    looks = {sensor.name: attention(capture, sensor, bodies, limits) for sensor in seeing(capture)}
    near = contacts(capture, bodies, calibration, limits, answers)
    moves = tuple(_moving(capture, bodies, calibration, near, limits))
    touches = tuple(arrivals(capture, bodies, calibration, near, moves, limits))
    touches += tuple(blows(capture, bodies, calibration, touches, _motions(moves), limits))
    _forget(capture, bodies)
    facts = [
        *_scene(capture),
        *(
            ZeroCrossing(sensor.name, int(frame))
            for sensor in capture.acting
            for frame in tracks[sensor.name].crossings
        ),
        *(
            Pause(sensor.name, int(frame))
            for sensor in capture.acting
            for frame in tracks[sensor.name].pauses
        ),
        *_touching(capture, touches),
        *moves,
        *(
            LookingAt(sensor, name, *interval)
            for sensor, look in looks.items()
            for name, interval in look.looks
        ),
    ]
    facts += company(capture, bodies, calibration, limits)
    guides = dict(_guides(capture, bodies, calibration, limits))
    facts += handling(capture, bodies, facts, calibration, limits, guides, since, whole=whole)
    own = [notice for notice in capture.notices if notice.code != LOSS]
    if notices:
        own += notices_of(capture, calibration, limits)
        own += faults(capture, bodies, touches, _motions(moves), limits)
    return Measurements(
        _ordered(facts),
        tuple(own),
        calibration,
        tracks,
        looks,
        bodies.without_caches(),
        guides,
        {(each.first, each.second): each.interval[1] for each in near if each.lingers},
        dict(_arriving(capture, bodies, calibration, limits)),
    )


def _forget(capture: Capture, bodies: Bodies) -> None:
    """Keep nothing for contacts alone, nor filtered poses of what handles nothing.

    After a long recording that goes for offset surfaces, too, though the next one may ask for them.
    """
    forget_touchable([*bodies.sensors.values(), *bodies.objects.values()])
    if capture.times[-1] - capture.times[0] >= LONG_S:
        for body in (*bodies.sensors.values(), *bodies.objects.values()):
            if body.shape is not None:
                surface(body.shape).forget_offsets()
    for sensor in capture.sensors:
        if sensor.role is not Role.ACTS:
            bodies.sensors[sensor.name].poses.forget()


def _track(poses: Poses, highest_mps: float, thresholds: Thresholds) -> Track:
    stream = poses.smooth
    pace = speed(stream.positions, stream.times)
    crossings = zero_crossings(
        pace,
        stream.times,
        noise_m=poses.noise.position_m,
        highest_mps=highest_mps,
        thresholds=thresholds,
    )
    reach = horizon_frames(stream.times, thresholds)
    return Track(poses, crossings, pauses(pace, crossings, reach))


def _scene(capture: Capture) -> Iterator[Fact]:
    yield Frames(0, len(capture.times) - 1)
    yield RateMhz(round(1000.0 * capture.rate_hz))
    for sensor in capture.acting:
        yield Link(sensor.name, sensor.end_effector, sensor.side)
    for thing in capture.objects:
        yield Tag(thing.name, thing.tag.value)
    if capture.others:
        own = [thing for thing in capture.objects if thing.tag is TagType.SELF]
        bodies: tuple[Sensor | TagObject, ...] = (*capture.acting, *seeing(capture), *own)
        for body in bodies:
            yield OfAgent(body.name, capture.agent_of(body))
    if capture.force_transfer:
        yield ForceTransfer()
    for rank, purpose in enumerate(capture.purposes):
        yield Intended(
            rank, purpose.action or ANY, purpose.object or ANY, purpose.goal or ANY, purpose.purpose
        )


def _guides(
    capture: Capture, bodies: Bodies, calibration: Calibration, thresholds: Thresholds
) -> Iterator[tuple[str, Guide]]:
    """The hinge or rail of each mobile object that moves on one throughout."""
    fixed = [bodies.objects[body.name] for body in capture.objects if body.tag is TagType.FIXED]
    for thing in capture.objects:
        if thing.tag is TagType.MOBILE:
            known = calibration.tag_object(thing.name)
            floor = Floor(known.motion_floor_m, known.motion_floor_rad)
            guide = guide_of(bodies.objects[thing.name], fixed, floor, thresholds)
            if guide is not None:
                yield thing.name, guide


def _touching(capture: Capture, touches: tuple[Contact, ...]) -> Iterator[Fact]:
    """Each contact; of two mobile objects either may be the dominant one: stated both ways."""
    mobile = {thing.name for thing in capture.objects if thing.tag is TagType.MOBILE}
    acting = {sensor.name for sensor in capture.acting}
    for touch in touches:
        orders = [(touch.first, touch.second)]
        if touch.first in mobile - acting and touch.second in mobile - acting:
            orders.append((touch.second, touch.first))
        for first, second in orders:
            yield Touching(first, second, *touch.interval)
            yield Gap(first, second, touch.interval[0], round(1e6 * touch.gap_m))


def _moving(
    capture: Capture,
    bodies: Bodies,
    calibration: Calibration,
    touches: Iterable[Contact],
    thresholds: Thresholds,
) -> Iterator[Fact]:
    """When each object moves, by its floor, and when that truly began and ended."""
    for thing in capture.objects:
        if thing.tag is TagType.MOBILE:
            pose = bodies.objects[thing.name].poses
            known = calibration.tag_object(thing.name)
            floor = Floor(known.motion_floor_m, known.motion_floor_rad)
            rests = rest_poses(pose, floor, thresholds)
            for interval in moving(pose, rests, floor, thresholds):
                yield Moving(thing.name, *interval)
                partners = _touched(thing.name, interval, touches, bodies)
                edges = motion_edges(pose, interval, rests, floor, thresholds, partners)
                yield Displaced(thing.name, *edges)


def _arriving(
    capture: Capture, bodies: Bodies, calibration: Calibration, thresholds: Thresholds
) -> Iterator[tuple[str, Arriving]]:
    """The mobile objects that have come to rest so recently that its place is not told yet."""
    for thing in capture.objects:
        if thing.tag is TagType.MOBILE:
            known = calibration.tag_object(thing.name)
            floor = Floor(known.motion_floor_m, known.motion_floor_rad)
            rests = rest_poses(bodies.objects[thing.name].poses, floor, thresholds)
            if rests and rests[-1].missing:
                yield thing.name, Arriving(rests[-1].interval[0], rests[-1].missing)


def _touched(
    name: str, motion: Interval, touches: Iterable[Contact], bodies: Bodies
) -> list[Poses]:
    """Poses of what an object touches as it moves and what is not fixed."""
    others = {
        touch.second if touch.first == name else touch.first
        for touch in touches
        if name in (touch.first, touch.second)
        and touch.interval[0] <= motion[1]
        and motion[0] <= touch.interval[1]
    }
    own = bodies.objects[name].poses
    found = (bodies.named(other).poses for other in sorted(others))
    return [poses for poses in found if not poses.rests and poses is not own]


def _motions(moves: tuple[Fact, ...]) -> dict[str, list[Interval]]:
    """When each object moves, by its name."""
    found: dict[str, list[Interval]] = defaultdict(list)
    for fact in moves:
        if isinstance(fact, Moving):
            found[fact.object].append((fact.first, fact.last))
    return found


def _ordered(facts: list[Fact]) -> tuple[Fact, ...]:
    """Facts by kind, then by value, each once."""
    groups: dict[type[Fact], list[Fact]] = defaultdict(list)
    for fact in facts:
        groups[type(fact)].append(fact)
    return tuple(
        fact
        for kind in MEASURED
        for fact in sorted(set(groups.pop(kind, ())), key=_values(cast(Any, kind)))
    )


def _values(kind: Any) -> Callable[[Fact], Any]:
    """What facts of a kind are sorted by: their arguments, read without rebuilding the fact."""
    names = [field.name for field in fields(kind)]
    return attrgetter(*names) if names else str
