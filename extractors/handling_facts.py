"""What is measured of bodies that handle and are handled, beside contact and motion."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations

import numpy as np
from jaxtyping import Float

from capar.model.calibration import Calibration
from capar.model.capture import Capture, Sensor, TagType
from capar.model.facts import (
    Between,
    ClosingSpeed,
    ContactNormal,
    Displaced,
    DrawsBack,
    Fact,
    Flies,
    Guided,
    Leans,
    Lengthwise,
    Lies,
    Moving,
    Opening,
    Passage,
    Phase,
    PressDirection,
    ReleaseSpeed,
    Resting,
    Reverses,
    Rides,
    Rolls,
    SightNormal,
    Swings,
    Touching,
)
from extractors.bodies.bodies import Bodies
from extractors.bodies.body_geometry import BodyGeometry
from extractors.bodies.trunk import trunk_sensor
from extractors.contact.normals import contact_normal
from extractors.contact.touching_part import touching_part
from extractors.motion.impacts import closing_speed, falls, release_speed
from extractors.motion.leaning import leaning
from extractors.motion.lengthwise import lengthwise
from extractors.motion.phases import phases, turns_of_height
from extractors.motion.rest import resting
from extractors.motion.rolling import rolling
from extractors.motion.turning_points import level_turns, swings
from extractors.relations.arrangement import ARRANGEMENTS, Holds, Pair, between, sides
from extractors.relations.attention import seeing, sight
from extractors.relations.grips import shifts
from extractors.relations.guides import Guide, turns_on_guide
from extractors.relations.loads import rides
from extractors.relations.places import distances, places, trunk_places
from extractors.relations.rooms import rooms
from extractors.relations.running_sums import FROM_THE_BEGINNING, Sums
from extractors.relations.seated import seated
from extractors.relations.weight_bearing import bearing
from extractors.sample_frames import boundary_frames
from extractors.signals.intervals import Interval, intervals
from extractors.thresholds import Thresholds

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

    Args:
        capture: The trial.
        bodies: Its bodies.
        known: Contacts and motions, as facts.
        calibration: What was decided for the whole recording.
        thresholds: What the measurements decide by.
        guides: The hinge or rail of each object that moves on one.
        since: Ways and turns before, of which this capture is the continuation.
        whole: Whether this is a whole recording, and no part of one.
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
    upright: Float[np.ndarray, "3"],
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
    capture: Capture,
    things: Mapping[str, BodyGeometry],
    known: list[Fact],
    thresholds: Thresholds,
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


def _sides(
    touch: Touching, normal: Float[np.ndarray, "3"], capture: Capture, bodies: Bodies
) -> Iterator[Fact]:
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
