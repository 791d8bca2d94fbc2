"""All measurements of a capture, as ground facts and the arrays that later stages need."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from operator import attrgetter
from typing import Any, cast

import numpy as np
from jaxtyping import Float, Int

from capar.model.calibration import Calibration
from capar.model.capture import (
    Capture,
    Notice,
    Purpose,
    Role,
    Sensor,
    TagObject,
    TagType,
)
from capar.model.facts import (
    MEASURED,
    Displaced,
    Fact,
    ForceTransfer,
    Frames,
    Gap,
    Intended,
    Link,
    LookingAt,
    Moving,
    OfAgent,
    Pause,
    RateMhz,
    Tag,
    Touching,
    ZeroCrossing,
)
from extractors.bodies.bodies import Bodies, bodies_of
from extractors.bodies.poses import Poses
from extractors.calibration import calibrated, check_clock, thresholds_of
from extractors.contact.arrivals import arrivals
from extractors.contact.blows import blows
from extractors.contact.contacts import Contact, contacts
from extractors.contact.earlier_answers import EarlierAnswers
from extractors.contact.surfaces import surface
from extractors.contact.touch_distances import forget_touchable
from extractors.faults.faults import faults
from extractors.handling_facts import handling
from extractors.measurement_notices import LOSS, notices_of
from extractors.motion.motion_edges import motion_edges
from extractors.motion.object_motion import Floor, moving, rest_poses
from extractors.relations.attention import Attention, attention, seeing
from extractors.relations.company import company
from extractors.relations.guides import Guide, guide_of
from extractors.relations.running_sums import FROM_THE_BEGINNING, Sums
from extractors.signals.filters import speed
from extractors.signals.intervals import Interval
from extractors.signals.zero_crossings import horizon_frames, pauses, zero_crossings
from extractors.thresholds import Thresholds

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
    def speed_mps(self) -> Float[np.ndarray, "frames"]:
        """How fast it is [m/s]; NaN where lost. Computed again each time."""
        return speed(self.positions, self.poses.smooth.times)

    @property
    def positions(self) -> Float[np.ndarray, "frames 3"]:
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
    capture: Capture,
    calibration: Calibration | None = None,
    since: Sums = FROM_THE_BEGINNING,
) -> Measurements:
    """Measure a capture: zero crossings, contacts, motions and looks, as facts.

    Args:
        capture: The trial, or a part of it.
        calibration: What was decided for the whole recording; None decides it by this capture.
        since: Ways and turns before, where the capture is a later part of a recording.

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

    Args:
        capture: The trial, or a part of it.
        calibration: What was decided for the whole recording.
        bodies: The bodies of the capture.
        since: Ways and turns before, where the capture is a later part of a recording.
        answers: Contacts that were asked about in an earlier part that overlaps.
        notices: Whether losses and faults are sought, too.
        whole: Whether this is a whole recording: angles that stay small in it are left out.
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
        yield _intended(rank, purpose)


def _intended(rank: int, purpose: Purpose) -> Intended:
    return Intended(
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
