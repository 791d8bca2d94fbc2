"""Measure a capture: every extractor in one table, and the facts and notices that they state."""

import math
from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, partial
from itertools import combinations
from operator import attrgetter
from typing import Any, cast

import numpy as np
from jaxtyping import Int

from capar.model import geometry
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
    PartOf,
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
from capar.model.locations import GuideLocation
from capar.model.notices import Notice, Value, notice
from extractors.bodies.bodies import Bodies, BodyGeometry, bodies_of, trunk_sensor
from extractors.bodies.poses import Poses
from extractors.calibration import calibrated, check_clock, thresholds_of
from extractors.contact.contacts import Contact, arrivals, blows, contacts
from extractors.contact.normals import contact_normal
from extractors.contact.touch_distances import forget_touchable, touching_part
from extractors.cores import shared
from extractors.faults.faults import faults
from extractors.motion.impacts import closing_speed, falls, release_speed
from extractors.motion.motion_edges import motion_edges, standstills, true_rests
from extractors.motion.object_motion import Floor, moving
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
from extractors.relations.guides import (
    HINGE,
    Guide,
    Part,
    guide_location,
    parts,
    turns_on_guide,
)
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
from extractors.signals.intervals import Interval, intervals, mask
from extractors.signals.zero_crossings import horizon_frames, pauses, zero_crossings
from extractors.thresholds import Thresholds

PASSED = ("inside", "above")
"""Arrangements that a body may pass through."""

SHIFTS, NEAR, BY_PART = "shifts", "near", "by_part"
"""An end-effector goes to another place on what it touches; it is within reach, without touch; it
touches a thing by a part alone."""

BESIDE_M = 1e-6
"""A thing that is touched by its part is so much farther than the part [m]: the part is named."""

ANY = "any"
"""What an empty field of a purpose is in a fact."""


def boundary_frames(
    facts: Iterable[Fact], acting: Iterable[str], last_frame: int
) -> Mapping[str, Sequence[int]]:
    """For each end-effector every frame where something that concerns it begins or ends.

    For each object that it touches, those of these frames at which it touches it, with the one
    before and the one after. Frames are ascending.
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
            low = max(bisect_left(ordered, touch.first) - 1, 0)
            out[touch.other].update(ordered[low : bisect_right(ordered, touch.last) + 1])
    return {name: tuple(sorted(out[name])) for name in sorted(out)}


@dataclass(frozen=True, eq=False)
class _Trial:
    """A capture with its bodies and what its measuring decides by."""

    capture: Capture
    bodies: Bodies
    calibration: Calibration
    limits: Thresholds
    since: Sums
    whole: bool
    """Whether this is a whole recording, and no part of one."""

    @cached_property
    def acting(self) -> dict[str, BodyGeometry]:
        """The acting end-effectors by name."""
        return {each.name: self.bodies.sensors[each.name] for each in self.capture.acting}

    @cached_property
    def mobile(self) -> tuple[str, ...]:
        """Names of the objects that can be moved."""
        return tuple(e.name for e in self.capture.objects if e.tag is TagType.MOBILE)

    def upright(self, name: str) -> Vector:
        """The axis of a body that points up where it first rests, in its own frame."""
        return np.array(self.calibration.body(name).upright)

    @cached_property
    def parts(self) -> dict[str, Part]:
        """The parts of things by name: those that are stated, or that a whole recording shows."""
        floors = {name: self._own_floor(name) for name in self.mobile}
        free = set(self.mobile) - set(self.acting) if self.whole else ()
        return parts(self.capture, self.bodies.objects, floors, free, self.limits)

    @cached_property
    def guides(self) -> dict[str, Guide]:
        """The hinge or rail of each mobile object that moves on one throughout."""
        return {name: part.guide for name, part in self.parts.items() if part.guide}

    @cached_property
    def wholes(self) -> dict[str, str]:
        """The base of each part of a thing whose base can be moved."""
        bases = {name: part.base.name for name, part in self.parts.items()}
        return {name: base for name, base in bases.items() if base in self.mobile}

    def guide_locations(self) -> Iterator[GuideLocation]:
        """Where on objects and their bases hinges and rails are."""
        for name, guide in sorted(self.guides.items()):
            yield guide_location(self.parts[name].body, self.parts[name].base, guide)

    def guide_notices(self) -> Iterator[Notice]:
        """What hinges and rails were found."""
        for name, guide in sorted(self.guides.items()):
            axis = guide.fit.axis @ self.parts[name].base.turn(guide.closed)
            opened = float(np.nanmax(guide.opening))
            turns = guide.fit.kind == HINGE
            yield notice(
                "guide",
                name,
                guide.base,
                kind=guide.kind,
                axis=", ".join(f"{round(float(part), 2) + 0.0:.2f}" for part in axis),
                residual_m=guide.fit.residual_m,
                **({"opened_deg": math.degrees(opened)} if turns else {"opened_m": opened}),
            )

    def floor(self, name: str) -> Floor:
        """The floor of motion of an object."""
        if name in self.parts:
            return self.parts[name].floor
        return self._own_floor(name)

    def _own_floor(self, name: str) -> Floor:
        known = self.calibration.tag_object(name)
        return Floor(known.motion_floor_m, known.motion_floor_rad)

    def moved_poses(self, name: str) -> Poses:
        """The poses by which an object moves: a part of a thing, in the axes of its base."""
        parts = self.parts
        return parts[name].body.poses if name in parts else self.bodies.objects[name].poses

    def spans(self, holds: Holds, one: BodyGeometry) -> list[Interval]:
        """The intervals in which something holds of a body, as those of contacts are made."""
        return intervals(
            holds,
            one.poses.smooth.times,
            dropout_s=self.limits.dropout_s,
            minimum_s=self.limits.contact_minimum_s,
        )

    def scene(self) -> Iterator[Fact]:
        """Who acts, what there is, and what the user states."""
        capture = self.capture
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
        for name, base in sorted(self.wholes.items()):
            yield PartOf(name, base)
        if capture.force_transfer:
            yield ForceTransfer()
        for rank, end in enumerate(capture.purposes):
            action, thing_name, goal = (e or ANY for e in (end.action, end.object, end.goal))
            yield Intended(rank, action, thing_name, goal, end.purpose)

    def contacts(self, touches: Iterable[Contact]) -> Iterator[Fact]:
        """Contacts; of two mobile objects either may be the dominant one: stated both ways."""
        movable = set(self.mobile) - set(self.acting)
        for touch in touches:
            orders = [(touch.first, touch.second)]
            if {touch.first, touch.second} <= movable:
                orders.append((touch.second, touch.first))
            for first, second in orders:
                if first not in self.wholes:
                    yield Touching(first, second, *touch.interval)
                    yield Gap(first, second, touch.interval[0], round(1e6 * touch.gap_m))
            if touch.by_part:
                yield Lies(touch.first, BY_PART, touch.second, *touch.interval)
        for name, base in self.wholes.items():
            # A hinge holds both together throughout, wherever their meshes meet.
            yield Touching(name, base, 0, len(self.capture.times) - 1)
            yield Gap(name, base, 0, 0)

    def of_things(self, touches: Sequence[Contact], moves: Iterable[Fact]) -> Iterator[Contact]:
        """Contacts, of which those with a part are with the whole thing too (spec 11).

        Part and base do not meet each other. Who has hold of both has hold of the thing alone,
        unless the part moves in the base meanwhile and nobody takes it off the base.
        """
        whole, count = self.wholes, len(self.capture.times)
        moved = [(fact.object, fact.ends()) for fact in moves if isinstance(fact, Displaced)]
        pairs: dict[tuple[str, str], list[Contact]] = defaultdict(list)
        for touch in touches:
            first, second = (whole.get(name, name) for name in (touch.first, touch.second))
            if first != second:
                pairs[first, second].append(touch)

        def of_base(hand: str, base: str) -> list[Interval]:
            touching = pairs.get((hand, base), ())
            return [touch.interval for touch in touching if touch.second == base]

        def stays(hand: str, base: str, span: tuple[int, ...]) -> bool:
            return any(low <= span[0] and span[1] <= high for low, high in of_base(hand, base))

        def steadied(touch: Contact, ends: tuple[int, ...]) -> bool:
            base = whole[touch.second]
            return stays(touch.first, base, ends) and any(
                other.second == touch.second and _meet(other.interval, ends)
                for hand in self.acting
                for other in pairs.get((hand, base), ())
                if hand != touch.first and not stays(hand, base, ends)
            )

        for (first, second), found in list(pairs.items()):
            own = [touch for touch in found if (touch.first, touch.second) == (first, second)]
            if own == found:
                yield from own
                continue
            for span in geometry.runs(mask([touch.interval for touch in found], count)):
                begins = min(found, key=lambda touch: (touch.interval[0] - span[0]) % count)
                gap_m = begins.gap_m + BESIDE_M * (begins not in own)
                part = {name for touch in found for name in (touch.first, touch.second)} & set(
                    whole
                )
                worked = [ends for name, ends in moved if name in part and _meet(ends, span)]
                has_both = any(_meet(base, span) for base in of_base(first, second)) and all(
                    stays(first, second, ends) for ends in worked
                )
                yield Contact(first, second, span, gap_m, begins.lingers, not has_both)
                for touch in found:
                    if touch in own or not _meet(touch.interval, span):
                        continue
                    if first not in self.acting or not any(
                        _meet(base, span) for base in of_base(first, second)
                    ):
                        yield touch
                        continue
                    own_work = [ends for ends in worked if not steadied(touch, ends)]
                    if own_work:
                        # Before, it steadied the thing, if somebody else worked the part.
                        late = own_work != worked
                        begin = max(touch.interval[0], min(own_work)[0] if late else 0)
                        yield replace(touch, interval=(begin, touch.interval[1]))

    def motion(
        self, name: str, poses: Poses, touches: Iterable[Contact]
    ) -> "Iterator[Fact | Arriving]":
        """When an object moves, by its floor, and when that truly began and ended.

        And that it has come to rest so recently that its place is not known yet.
        """
        floor = self.floor(name)
        rests = standstills(poses, floor, self.limits)
        for interval in moving(poses, rests, floor, self.limits):
            yield Moving(name, *interval)
            partners = self._touched(name, interval, touches)
            edges = motion_edges(poses, interval, rests, floor, self.limits, partners)
            yield Displaced(name, *edges)
        if rests and rests[-1].missing:
            yield Arriving(rests[-1].interval[0], rests[-1].missing)

    def _touched(self, name: str, motion: Interval, touches: Iterable[Contact]) -> list[Poses]:
        """Poses of what an object touches as it moves and what is not fixed."""
        others = {
            touch.second if touch.first == name else touch.first
            for touch in touches
            if name in (touch.first, touch.second)
            and touch.interval[0] <= motion[1]
            and motion[0] <= touch.interval[1]
        }
        own = self.bodies.objects[name].poses
        found = (self.bodies.named(other).poses for other in sorted(others))
        return [poses for poses in found if not poses.rests and poses is not own]

    def courses(self, known: Sequence[Fact]) -> list[Callable[[], Iterable[Any]]]:
        """Rest, company, contact's details and courses of bodies: each measured by itself.

        Handled are the acting end-effectors and every mobile object that one of them touches.
        """
        capture, bodies, limits = self.capture, self.bodies, self.limits
        calibration, held = self.calibration, self._held(known)
        handled = (name for name in self.mobile if name in held)
        return [
            partial(self._contact_details, known),
            *(
                partial(company, [name], capture, bodies, calibration, limits)
                for name in self.mobile
            ),
            *(partial(self._resting, name) for name in self.acting),
            *(partial(self._course, bodies.objects[name], known) for name in handled),
        ]

    def _resting(self, name: str) -> Iterator[Fact]:
        return (Resting(name, *rest) for rest in true_rests(self.acting[name].poses, self.limits))

    def _held(self, known: Iterable[Fact]) -> set[str]:
        """What acting end-effectors touch."""
        return {f.other for f in known if isinstance(f, Touching) and f.body in self.acting}

    def handling(self, known: Sequence[Fact]) -> Iterator[Fact]:
        """Arrangements and places of handled bodies, at what is known to begin and to end."""
        things, last = self.bodies.objects, len(self.capture.times) - 1
        touches = [fact for fact in known if isinstance(fact, Touching)]
        borders, held = boundary_frames(known, self.acting, last), self._held(known)
        others = (name for name in self.mobile if name in held and name not in self.acting)
        bodies = (*self.acting.values(), *(things[name] for name in others))
        tasks = [
            *(
                partial(self._placed, one, tuple(borders.get(one.name, ())), touches)
                for one in bodies
            ),
            *(partial(self._let_go, name, touches) for name in self.acting),
        ]
        found = [fact for facts in shared(tasks, last + 1) for fact in facts]
        kinds = {thing.name: thing.kind for thing in self.capture.objects}
        yield from found
        yield from rooms(things, kinds, touches, (*known, *found), self.limits)

    def _let_go(self, name: str, touches: Iterable[Touching]) -> Iterator[Fact]:
        """How a hand goes elsewhere on what it touches, and how fast that is when it leaves it."""
        for touch in touches:
            if touch.body == name != touch.other and touch.other in self.mobile:
                hand, thing = self.acting[name], self.bodies.objects[touch.other]
                for span in shifts(hand, thing, (touch.first, touch.last), self.limits):
                    yield Lies(name, SHIFTS, touch.other, *span)
                speed_mm = round(1000.0 * release_speed(thing, touch.last))
                yield ReleaseSpeed(name, touch.other, touch.first, speed_mm)

    def _course(self, one: BodyGeometry, known: Sequence[Fact]) -> Iterator[Fact]:
        """Phases, turning points, swings, leaning, falls and rolling of a handled object."""
        name, guide, limits = one.name, self.guides.get(one.name), self.limits
        moves, displaced = (
            tuple((f.first, f.last) for f in known if isinstance(f, kind) and f.object == name)
            for kind in (Moving, Displaced)
        )
        found = phases(one, displaced, limits)
        yield from (Phase(name, phase.kind, phase.first, phase.last) for phase in found)
        if guide is None:
            met = [fact.first for fact in known if isinstance(fact, Touching) and fact.body == name]
            turns = turns_of_height(found, one.middles, met, limits)
        else:
            turns = turns_on_guide(guide, displaced, limits)
            yield Guided(name, guide.kind, guide.base)
        swinging = swings(one.poses, moves, limits)
        leans = leaning(one, self.upright(name), limits)
        yield from (Reverses(name, frame) for frame in turns)
        yield from (DrawsBack(name, f) for f in level_turns(one.middles, displaced, limits))
        yield from (Swings(name, *span) for span in swinging)
        yield from (Lengthwise(name, *span) for span in lengthwise(one, swinging, limits))
        yield from (Leans(name, *span) for span in leans)
        yield from (Flies(name, *span) for span in falls(one, limits))
        yield from (Rolls(name, *span) for span in rolling(one, limits))

    def _placed(
        self,
        one: BodyGeometry,
        frames: tuple[int, ...],
        touches: list[Touching],
    ) -> Iterator[Fact]:
        """Where a body is at some frames, and how it is arranged to each object."""
        things = self.bodies.objects
        yield from places(one, self.upright(one.name), frames, self.since)
        trunk = self._trunks.get(one.name)
        if trunk:
            upright = self.upright(trunk)
            yield from trunk_places(one, self.bodies.sensors[trunk], upright, frames)
        if one.name in self.guides:
            opening = self.guides[one.name].opening
            for frame in frames:
                if not np.isnan(opening[frame]):
                    yield Opening(one.name, frame, round(1000.0 * float(opening[frame])))
        for other in things.values():
            if other.name != one.name:
                yield from distances(one, other, frames, self.since, whole=self.whole)
                if not self._one_thing(one.name, other.name):
                    yield from self._arranged(one, other, touches)
        others = sorted(
            (each for each in things.values() if not self._one_thing(one.name, each.name)),
            key=attrgetter("name"),
        )
        for first, second in combinations(others, 2):
            for span in self.spans(between(one, first, second), one):
                yield Between(one.name, first.name, second.name, *span)

    def _one_thing(self, name: str, other: str) -> bool:
        """Whether two names are of one body, or of bodies of one thing that can be moved."""
        return self.wholes.get(name, name) == self.wholes.get(other, other)

    def _arranged(
        self, one: BodyGeometry, other: BodyGeometry, touches: list[Touching]
    ) -> Iterator[Fact]:
        pair = Pair(one, other, self.limits)
        for how, arrangement in ARRANGEMENTS.items():
            for span in self.spans(arrangement(pair), one):
                yield Lies(one.name, how, other.name, *span)
                if how in PASSED and span[0] > 0 and span[1] < len(one.middles) - 1:
                    ends = sides(one, other, np.array(span))
                    yield Passage(one.name, how, other.name, span[0], ends)
        met = [t for t in touches if (t.body, t.other) == (one.name, other.name)]
        for first, last in self.spans(pair.near, one):
            if not any(touch.first <= last and touch.last >= first for touch in met):
                yield Lies(one.name, NEAR, other.name, first, last)

    @cached_property
    def _trunks(self) -> dict[str, str]:
        """The trunk of the agent whose each end-effector is, where one is tracked."""
        capture = self.capture
        own: dict[str, list[Sensor]] = defaultdict(list)
        for sensor in capture.sensors:
            own[capture.agent_of(sensor)].append(sensor)
        trunks = {agent: trunk_sensor(sensors) for agent, sensors in own.items()}
        found = ((sensor.name, trunks[capture.agent_of(sensor)]) for sensor in capture.acting)
        return {name: trunk.name for name, trunk in found if trunk and trunk.name != name}

    def _contact_details(self, known: Sequence[Fact]) -> Iterator[Fact]:
        """What is down on what and borne by it, from where bodies touch, and how fast they met."""
        things, limits = self.bodies.objects, self.limits
        touches = [fact for fact in known if isinstance(fact, Touching)]
        yield from seated(things, self.acting, touches, known, limits)
        yield from bearing(self.capture, self.bodies, touches, self.calibration, limits)
        yield from self._normals(touches)
        moves = _motions(known)
        for touch in touches:
            if {touch.body, touch.other} <= set(self.mobile):
                load, bearer, span = things[touch.body], things[touch.other], touch.ends()
                if rides(load, bearer, (span[0], span[1]), moves[touch.other], limits):
                    yield Rides(touch.body, touch.other, touch.first)

    def _normals(self, touches: list[Touching]) -> Iterator[Fact]:
        """From where bodies touch, and how fast they met."""
        upward: dict[tuple[str, str, int], int] = {}
        for touch in touches:
            names, frame = (touch.body, touch.other), touch.first
            other = self.bodies.objects[touch.other]
            if touch.body in self.acting:
                body = touching_part(self.bodies, touch.body, other, frame)
            else:
                body = self.bodies.objects[touch.body]
            normal = contact_normal(body, other, frame, self.limits)
            swapped = upward.get((touch.other, touch.body, frame))
            if swapped is not None:
                yield ContactNormal(*names, frame, -swapped)
            elif normal is not None:
                upward[*names, frame] = round(1000.0 * float(normal[2]))
                yield ContactNormal(*names, frame, upward[*names, frame])
                if touch.body in self.acting:
                    yield from self._sides(touch, normal)
            speed_mm = round(1000.0 * closing_speed(body, other, frame, normal))
            yield ClosingSpeed(*names, frame, speed_mm)

    def _sides(self, touch: Touching, normal: Vector) -> Iterator[Fact]:
        """On which side an end-effector touches what can be moved, and what looks somewhere."""
        names, first = (touch.body, touch.other), touch.first
        if touch.other in self.mobile:
            x, y = (round(-1000.0 * float(part)) for part in normal[:2])
            yield PressDirection(*names, first, x, y)
        for head in seeing(self.capture):
            if head.name == touch.other:
                ahead = sight(head, self.bodies.sensors[touch.other].poses)[1][first]
                along = float(normal @ ahead)
                if not np.isnan(along):
                    yield SightNormal(*names, first, round(1000.0 * along))


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
    """How often a body was lost for long, and when at most; without times if it was throughout."""
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
    guides: tuple[GuideLocation, ...]
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
    notices: bool = True,
    whole: bool = False,
) -> Measurements:
    """The same with bodies that were made by the calibration.

    ``since``: ways and turns before, where the capture is a later part of a recording. ``notices``:
    whether losses and faults are sought, too. ``whole``: whether this is a whole recording: angles
    that stay small in it are left out.
    """
    limits, frames = thresholds_of(calibration), len(capture.times)
    trial = _Trial(capture, bodies, calibration, limits, since, whole)
    tracks = {
        name: _track(body.poses, calibration.sensor(name).highest_speed_mps, limits)
        for name, body in trial.acting.items()
    }
    looks = {sensor.name: attention(capture, sensor, bodies, limits) for sensor in seeing(capture)}
    near = contacts(capture, bodies, calibration, limits)
    poses = {name: trial.moved_poses(name) for name in trial.mobile}
    moved = shared([partial(trial.motion, *each, near) for each in poses.items()], frames)
    moves = [each for found in moved for each in found if not isinstance(each, Arriving)]
    last = ((name, found[-1]) for name, found in zip(poses, moved, strict=True) if found)
    arriving = {name: each for name, each in last if isinstance(each, Arriving)}
    touches = tuple(arrivals(capture, bodies, calibration, near, moves, limits))
    touches += tuple(blows(capture, bodies, calibration, touches, _motions(moves), limits))
    # Kept for contacts alone, and filtered poses of what handles nothing.
    forget_touchable([*bodies.sensors.values(), *bodies.objects.values()])
    for body in capture.sensors:
        if body.role is not Role.ACTS:
            bodies.sensors[body.name].poses.forget()
    touches = tuple(trial.of_things(touches, moves))
    facts = [*trial.scene(), *trial.contacts(touches), *moves]
    for name, track in tracks.items():
        facts += (ZeroCrossing(name, int(frame)) for frame in track.crossings)
        facts += (Pause(name, int(frame)) for frame in track.pauses)
    for sensor, look in looks.items():
        facts += (LookingAt(sensor, name, *interval) for name, interval in look.looks)
    courses: list[Callable[[], Iterable[Any]]] = trial.courses(tuple(facts))
    if notices:
        courses.append(partial(faults, capture, bodies, touches, _motions(moves), limits))
    found = shared(courses, frames)
    wrong = found.pop() if notices else []
    facts += (fact for some in found for fact in some)
    facts += list(trial.handling(tuple(facts)))
    own = [notice for notice in capture.notices if notice.code != LOSS]
    if notices:
        # Who carries a thing need not be near each part of it.
        own += (
            each
            for each in notices_of(capture, calibration, limits)
            if each.code != "mount-gap" or not set(each.bodies) & set(trial.wholes)
        )
        own += trial.guide_notices()
        own += wrong
    return Measurements(
        _ordered(facts),
        tuple(own),
        calibration,
        tracks,
        looks,
        bodies.without_caches(),
        tuple(trial.guide_locations()),
        {(each.first, each.second): each.interval[1] for each in near if each.lingers},
        arriving,
    )


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


def _meet(one: tuple[int, ...], other: tuple[int, ...]) -> bool:
    """Whether two closed intervals share a frame."""
    return one[0] <= other[1] and other[0] <= one[1]


def _motions(moves: Iterable[Fact]) -> dict[str, list[Interval]]:
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
