"""When the ticks and segments of an answer are, and what was measured there, for sentences."""

import math
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from capar.model.body_names import is_plural
from capar.model.facts import (
    ClosingSpeed,
    ContactNormal,
    Displaced,
    Fact,
    FlickerCorrection,
    Lies,
    Link,
    Moving,
    Phase,
    Place,
    Posture,
    PressDirection,
    Resting,
    Shapeless,
    Swings,
    Tag,
    Touching,
    Travelled,
)
from capar_rules.explain.quantities import Over, Turns, Way
from capar_rules.explain.reaches import Reach

_SEGMENT = re.compile(r"seg\((\w+),(\d+)\)")

HANDS = ("hand", "index", "middle", "ring", "pinky", "thumb", "finger")
"""How kinds of end-effectors begin that are hands or parts of them."""

FEET = ("foot", "toe")
"""Kinds of end-effectors that may stand."""

Ways = Callable[[str, int, int], Way]
"""How a body moved between two frames."""

Leans = Callable[[str, int, int], float]
"""How far a body leant at most between two frames [rad]."""

TurnsBack = Callable[[str, int, int], Turns]
"""How often a body turned back between two frames."""

Heights = Callable[[str, int, int], tuple[float, float]]
"""How low and how high a body was between two frames, from where it was at the first [m]."""

Apart = Callable[[str, str, int, int], tuple[float, float] | None]
"""How far two bodies were apart at least and at most between two frames [m]; None if unmeasured."""

Places = Callable[[str, str, int], Over]
"""Where a body is to another one at a frame."""

Pair = tuple[str, str]
Pressing = tuple[int, int]
Frames = tuple[int, int]
"""First and last frame."""


def fewer_frames(least_s: float, rate_hz: float) -> str:
    """What is shorter than a time, in frames."""
    return f"fewer than {math.ceil(least_s * rate_hz - 1e-9)} frames ({least_s:.2f} s)"


@dataclass(frozen=True)
class Measured:
    """What was measured of bodies, for sentences."""

    ways: Ways | None = None
    """How bodies moved; None where that is not known."""

    moving: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames of the measured motions, by object."""

    displaced: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames at which objects truly left and reached a place, by object."""

    rests: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames of the measured rests, by end-effector."""

    places: Mapping[tuple[str, int], tuple[int, int, int]] = field(default_factory=dict)
    """Where bodies were, by name and frame [mm]."""

    postures: Mapping[tuple[str, int], tuple[int, int]] = field(default_factory=dict)
    """How far they leant and had turned about the vertical, by name and frame [1/1000 rad]."""

    names: Mapping[str, str] = field(default_factory=dict)
    """What bodies are called, where it is not their name."""

    reaches: Mapping[tuple[str, str], Reach] = field(default_factory=dict)
    """Up to which distance two bodies count as touching, by their names in either order."""

    turned: Leans | None = None
    """By what angle bodies were turned at most from their mean orientation between two frames."""

    turn_floors: Mapping[str, float] = field(default_factory=dict)
    """From what angle on a body counts as moved, by body [rad]."""

    stand_ins: Mapping[str, str] = field(default_factory=dict)
    """The shapes of bodies that stand in for the true ones, in words, by body."""

    floors: Mapping[str, float] = field(default_factory=dict)
    """From what distance on a body counts as moved, by body [m]."""

    leans: Leans | None = None
    """How far bodies leant; None where that is not known."""

    far_over_rad: float = 0.0
    """From what angle on a body leans far over [rad]; zero where that is not known."""

    turns: TurnsBack | None = None
    """How often bodies turned back; None where that is not known."""

    level: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames of the level parts of objects' motions, by object."""

    swings: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames of the measured motions to and fro, by object."""

    travelled: Mapping[tuple[str, int], tuple[int, int]] = field(default_factory=dict)
    """How far bodies had gone [mm] and turned in all [1/1000 rad], by name and frame."""

    held: Mapping[str, Sequence[tuple[str, int, int]]] = field(default_factory=dict)
    """Which end-effectors touched an object from when to when, by object."""

    rate_hz: float = 0.0
    """Frames a second [Hz]; zero where that is not known."""

    tracked: bool = True
    """Whether there is an object that could be touched."""

    contacts: Mapping[Pair, Sequence[Frames]] = field(default_factory=dict)
    """First and last frames of the measured contacts, by the two bodies."""

    normals: Mapping[Pair, Mapping[int, int]] = field(default_factory=dict)
    """By two bodies and the first frame of their contact: how far its normal points up, from the
    second to the first [1/1000]."""

    closing: Mapping[Pair, Mapping[int, int]] = field(default_factory=dict)
    """By two bodies and the first frame of their contact: how fast they came together [mm/s]."""

    presses: Mapping[Pair, Mapping[int, Pressing]] = field(default_factory=dict)
    """The same: which way the first presses aside on the second [1/1000]."""

    flickers: Mapping[Pair, Sequence[Frames]] = field(default_factory=dict)
    """First and last frames in which two bodies are taken to touch that were measured apart."""

    lies: Mapping[tuple[str, str, str], Sequence[Frames]] = field(default_factory=dict)
    """First and last frames of how a body lies to another, by that and the two bodies."""

    heights: Heights | None = None
    """How low and how high bodies were; None where that is not known."""

    over: Places | None = None
    """Where a body is to another one; None where that is not known."""

    apart: Apart | None = None
    """How far bodies were apart; None where that is not known."""

    gap_frames: str = ""
    """How long the gaps are that end no contact; empty where that is not known."""

    brief_frames: str = ""
    """How long what is too brief for a contact is; empty where that is not known."""

    movable: frozenset[str] = frozenset()
    """Objects that can be moved."""

    lost: Mapping[str, Sequence[Frames]] = field(default_factory=dict)
    """First and last frames of the gaps in the tracks of bodies that are long enough to matter."""

    unrested: frozenset[str] = frozenset()
    """Objects that never rest; from how others first rest their lean is measured."""

    shapeless: frozenset[str] = frozenset()
    """Objects of which no shape is known."""

    feet: frozenset[str] = frozenset()
    """End-effectors that are feet or toes."""

    hands: frozenset[str] = frozenset()
    """End-effectors that are hands or parts of them."""

    def grasps(self, body: str) -> bool:
        """Whether it is a hand, a foot, or a part of one, which is where it seems to be."""
        return body in self.hands or body in self.feet

    def stands_uncounted(self, body: str) -> bool:
        """Whether it is a foot of which no contact with anything fixed is looked for."""
        pairs = (pair for pair in self.reaches if body in pair)
        return body in self.feet and all({*pair} & self.movable for pair in pairs)

    def upright(self, body: str) -> str:
        """The posture from which a body's lean is measured, in words."""
        several = is_plural(self.names.get(body, body.replace("_", " ")))
        it, was = ("they", "were") if several else ("it", "was")
        if body in self.unrested:
            return f"how {it} {was} first seen"
        moving = min(self.moving.get(body, ()), default=(1, 1))
        later = f" (after {moving[1] / self.rate_hz:.2f} s)" * (
            not moving[0] and bool(self.rate_hz)
        )
        return f"how {it} first rested{later}"

    def contact(self, one: str, other: str, frame: int, slack: float) -> Frames | None:
        """The contact of two bodies at a frame, or the nearest so few frames from it."""
        found = [*self.contacts.get((one, other), ()), *self.contacts.get((other, one), ())]
        near = [
            (max(first - frame, frame - last, 0), first, last)
            for first, last in found
            if first - slack <= frame <= last + slack
        ]
        return min(near)[1:] if near else None

    def upward(self, one: str, other: str, first: int) -> int | None:
        """How far the normal of the contact that begins then points up, to the first [1/1000]."""
        own = self.normals.get((one, other), {}).get(first)
        opposite = self.normals.get((other, one), {}).get(first)
        return -opposite if own is None and opposite is not None else own

    def near(self, one: str, other: str) -> bool:
        """Whether two bodies that count as touching may be apart, so that they are told as near."""
        reach = self.reaches.get((one, other))
        rough = one in self.stand_ins or other in self.stand_ins
        return reach is not None and (rough or not reach.is_touch)


def measured_by(facts: Iterable[Fact], known: Measured) -> Measured:
    """What is known of bodies, with what facts say of their motions, places and postures."""
    moving: dict[str, list[tuple[int, int]]] = defaultdict(list)
    displaced: dict[str, list[tuple[int, int]]] = defaultdict(list)
    rests: dict[str, list[tuple[int, int]]] = defaultdict(list)
    swings: dict[str, list[tuple[int, int]]] = defaultdict(list)
    level: dict[str, list[tuple[int, int]]] = defaultdict(list)
    held: dict[str, list[tuple[str, int, int]]] = defaultdict(list)
    places, postures, travelled, touched = {}, {}, {}, False
    every = list(facts)
    links = [fact for fact in every if isinstance(fact, Link)]
    acting = {link.ee for link in links}
    for fact in every:
        match fact:
            case Moving():
                moving[fact.object].append((fact.first, fact.last))
            case Displaced():
                displaced[fact.object].append((fact.first, fact.last))
            case Resting():
                rests[fact.ee].append((fact.first, fact.last))
            case Place():
                places[fact.body, fact.frame] = fact.x, fact.y, fact.z
            case Posture():
                postures[fact.body, fact.frame] = fact.lean, fact.spin
            case Phase(kind="level"):
                level[fact.object].append((fact.first, fact.last))
            case Swings():
                swings[fact.body].append((fact.first, fact.last))
            case Travelled():
                travelled[fact.body, fact.frame] = fact.way, fact.turn
            case Touching() if fact.body in acting:
                touched = True
                held[fact.other].append((fact.body, fact.first, fact.last))
            case Tag(type="mobile" | "fixed"):
                touched = True
            case _:
                pass
    found = replace(
        known, moving=moving, level=level, rests=rests, places=places, postures=postures
    )
    found = _of_pairs(every, found)
    return replace(
        found,
        displaced=displaced,
        swings=swings,
        travelled=travelled,
        held=held,
        tracked=touched,
        feet=frozenset(link.ee for link in links if link.kind in FEET),
        hands=frozenset(link.ee for link in links if link.kind.startswith(HANDS)),
    )


def _of_pairs(facts: Iterable[Fact], known: Measured) -> Measured:
    """What is known, with what facts say of two bodies and of shapes."""
    contacts: dict[Pair, list[Frames]] = defaultdict(list)
    normals: dict[Pair, dict[int, int]] = defaultdict(dict)
    presses: dict[Pair, dict[int, Pressing]] = defaultdict(dict)
    closing: dict[Pair, dict[int, int]] = defaultdict(dict)
    lies: dict[tuple[str, str, str], list[Frames]] = defaultdict(list)
    flickers: dict[Pair, list[Frames]] = defaultdict(list)
    shapeless: set[str] = set()
    movable: set[str] = set()
    for fact in facts:
        match fact:
            case Touching():
                contacts[fact.body, fact.other].append((fact.first, fact.last))
            case ContactNormal():
                normals[fact.body, fact.other][fact.first] = fact.permille
            case ClosingSpeed():
                closing[fact.body, fact.other][fact.first] = fact.speed
            case PressDirection():
                presses[fact.body, fact.other][fact.first] = fact.x, fact.y
            case FlickerCorrection(taken="touching"):
                flickers[fact.body, fact.other].append((fact.first, fact.last))
            case Lies():
                lies[fact.how, fact.body, fact.other].append((fact.first, fact.last))
            case Shapeless():
                shapeless.add(fact.object)
            case Tag(type="mobile"):
                movable.add(fact.object)
            case _:
                pass
    found = replace(known, contacts=contacts, normals=normals, presses=presses, lies=lies)
    return replace(
        found,
        closing=closing,
        flickers=flickers,
        shapeless=frozenset(shapeless),
        movable=frozenset(movable),
    )


@dataclass(frozen=True)
class Clock:
    """Times of ticks and segments for sentences."""

    rate_hz: float
    frames: Mapping[str, Sequence[int]]
    """Frames of the ticks, by end-effector."""

    ends: Mapping[tuple[str, int], int] = field(default_factory=dict)
    """The tick where the segment ends that begins at a tick."""

    measured: Measured = field(default_factory=Measured)
    objects: Mapping[str, str] = field(default_factory=dict)
    """The object that each segment is about, by the segment's term."""

    listed: Mapping[str, Sequence[str]] = field(default_factory=dict)
    """The objects of each segment in the order of its features, by the segment's term."""

    met: Mapping[tuple[str, str, str], Sequence[str]] = field(default_factory=dict)
    """What a body touches at a side of a segment, by segment, side and body."""

    strokes: Mapping[str, Sequence[int]] = field(default_factory=dict)
    """At which halts of the hand what a segment moves turned back, by the segment's term."""

    own: str = ""
    """The term of the segment that is explained."""

    @cached_property
    def several(self) -> tuple[str, ...]:
        """What the bodies that places are known of are called, if it is a plural."""
        bodies = {name for name, _ in self.measured.places} | {*self.measured.moving}
        return tuple(each for name in sorted(bodies) if is_plural(each := self.called(name)))

    def called(self, name: str) -> str:
        """A body as sentences call it."""
        return self.measured.names.get(name, name.replace("_", " "))

    def it(self, name: str, *, object_: bool = False) -> str:
        """The pronoun of a body, as a subject or as an object."""
        if self.called(name) in self.several:
            return "them" if object_ else "they"
        return "it"

    def at(self, frame: int) -> str:
        """A frame as a time."""
        return f"{frame / self.rate_hz:.2f} s"

    def border(self, segment: str, side: str) -> str:
        """When a segment starts or ends."""
        span = self.span(segment)
        return f"its {side}" if span is None else self.at(span[side == "end"])

    def about(self, segment: str) -> str:
        """The object that a segment is about."""
        return self.called(self.objects.get(segment, "object"))

    def motion(self, name: str, span: tuple[int, int]) -> tuple[int, int]:
        """From when to when an object was measured to move within a span; the span if never."""
        return _within(self.measured.moving.get(name, ()), span)

    @property
    def closed_gaps(self) -> str:
        """Up to how long bodies may be too far apart within a contact, after how far they were."""
        return f": gaps of {self.measured.gap_frames} end no contact"

    def displacement(self, name: str, span: tuple[int, int]) -> tuple[int, int]:
        """The same from when it truly left its place until it truly reached another."""
        found = self.measured.displaced.get(name) or self.measured.moving.get(name, ())
        return _within(found, span)

    def span(self, segment: str) -> tuple[int, int] | None:
        """First and last frame of the segment that a term names."""
        found = _SEGMENT.fullmatch(segment)
        if found is None:
            return None
        ee, first = found[1], int(found[2])
        last = self.ends.get((ee, first))
        return None if last is None else (self.frames[ee][first], self.frames[ee][last])

    def side(self, ee: str, tick: int) -> str:
        """Whether a tick is the start or the end of the explained segment, or before its start."""
        found = _SEGMENT.fullmatch(self.own)
        if found is None or found[1] != ee:
            return ""
        if int(found[2]) == tick:
            return "start"
        if tick < int(found[2]):
            return "before"
        return "end" if self.ends.get((ee, int(found[2]))) == tick else ""


def _within(spans: Sequence[tuple[int, int]], span: tuple[int, int]) -> tuple[int, int]:
    """From the first to the last frame of what lies within a span; the span if nothing does."""
    parts = [(max(first, span[0]), min(last, span[1])) for first, last in spans]
    parts = [part for part in parts if part[0] < part[1]]
    return (min(parts)[0], max(last for _, last in parts)) if parts else span
