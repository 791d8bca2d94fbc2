"""What a picture of an observation shows, row by row, before any of it is drawn."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto
from typing import TypeVar

import numpy as np
from jaxtyping import Bool, Float

from capar.model.facts import LookingAt, Moving, Touching, ZeroCrossing
from capar.model.geometry import runs
from capar.model.observation import (
    JointAction,
    Observation,
    ObservedLink,
    ObservedObject,
    Segment,
)
from capar.views.lettering import Span

Speeds = Mapping[str, tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]]]
"""Of each end-effector: times [s] and speeds [m/s]."""

Lost = Mapping[str, Bool[np.ndarray, "frames"]]
"""Of each body: whether tracking had lost it."""

ASSUMED, STAND_IN = "*", "†"
"""Marks of an object that is assumed, and of a shape that stands in for the true one."""

MOST_NAMED = 4
"""So many who take part in one action are named one by one."""

MOST_DETAILED = 8
"""With more links than these speeds and zero crossings are left out, and those that handle objects
stand first: a whole body with its fingers is looked at as a whole."""

_Name = TypeVar("_Name", str, tuple[str, ...])


class Kind(Enum):
    """How a row is drawn."""

    HEADING = auto()
    SEGMENTS = auto()
    TICKS = auto()
    BARS = auto()
    MOTION = auto()
    NAMES = auto()
    CURVE = auto()


@dataclass(frozen=True)
class Row:
    """One row: what stands at its left, and what along time."""

    kind: Kind
    label: str
    spans: tuple[Span, ...] = ()
    ticks: tuple[float, ...] = ()
    curve: tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]] | None = None
    borders: tuple[float, ...] = ()
    """Times at which a fine line crosses the row: the borders of its link's segments."""

    lost: tuple[Span, ...] = ()
    """When tracking had lost a body that the row is about."""

    about: tuple[str, ...] = ()
    """The bodies whose contact or motion its bars show."""


def rows(observation: Observation, speeds: Speeds, lost: Lost | None = None) -> tuple[Row, ...]:
    """Every row, from the top: each link, what several do as one action, objects, and gaze."""
    clock = frame_clock(observation, speeds)
    out: list[Row] = []
    for link in _links(observation):
        out += _link_rows(observation, link, speeds, clock)
    out += _joint_rows(observation, clock)
    out += _object_rows(observation, clock)
    out = [replace(each, lost=_lost(each.about, lost or {}, clock)) for each in out]
    return (*out, *_gaze_rows(observation, clock))


def is_detailed(observation: Observation) -> bool:
    """Whether there are so few links that each has its speed and its zero crossings."""
    return len(observation.links) <= MOST_DETAILED


def _links(observation: Observation) -> list[ObservedLink]:
    """The links as they are, or, of many, those first that handle objects."""
    if is_detailed(observation):
        return list(observation.links)
    return sorted(
        observation.links, key=lambda link: not any(each.objects for each in link.segments)
    )


def _lost(about: Sequence[str], lost: Lost, clock: Callable[[int], float]) -> tuple[Span, ...]:
    found = [lost[name] for name in about if name in lost]
    missing = runs(np.logical_or.reduce(found)) if found else []
    return tuple(Span(clock(first), clock(last), "") for first, last in missing)


def frame_clock(observation: Observation, speeds: Speeds) -> Callable[[int], float]:
    """The time of a frame [s].

    It is exact where a speed is given for every frame; else it is interpolated between the
    segments' borders, whose times are known.
    """
    for times, _ in speeds.values():
        if len(times) == observation.frames:
            exact = np.asarray(times, dtype=float)
            return lambda frame: float(exact[min(max(frame, 0), len(exact) - 1)])
    known = {0: 0.0, observation.frames - 1: observation.duration_s}
    known |= {each.first: each.start_s for each in observation.segments}
    known |= {each.last: each.end_s for each in observation.segments}
    frames = sorted(known)
    seconds = [known[frame] for frame in frames]
    return lambda frame: float(np.interp(frame, frames, seconds))


def spoken(name: str) -> str:
    """A name as people write it."""
    return name.replace("_", " ")


def marked(observation: Observation, name: str) -> str:
    """An object's name with the marks that the footnote explains."""
    mark = ASSUMED if any(each.assumed for each in _objects(observation, name)) else ""
    return spoken(name) + mark + (STAND_IN if name in stand_ins(observation) else "")


def stand_ins(observation: Observation) -> dict[str, str]:
    """What stands in for the true shape of a body, by the body's name, as its notice says."""
    return {
        each.bodies[0]: str(each["shape"])
        for each in observation.notices
        if each.code == "stand-in-shape"
    }


def _objects(observation: Observation, name: str) -> list[ObservedObject]:
    return [each for each in observation.objects if each.name == name]


def _link_rows(
    observation: Observation, link: ObservedLink, speeds: Speeds, clock: Callable[[int], float]
) -> list[Row]:
    spans = tuple(
        Span(clock(each.first), clock(each.last), each.name, kind_of(each))
        for each in link.segments
    )
    borders = tuple(sorted({each.start_s for each in spans} | {each.end_s for each in spans}))
    crossings = sorted(
        each.frame
        for each in observation.facts
        if isinstance(each, ZeroCrossing) and each.ee == link.ee
    )
    out = [Row(Kind.SEGMENTS, marked(observation, link.ee), spans, borders=borders)]
    ticks = tuple(clock(each) for each in crossings)
    if ticks and is_detailed(observation):
        out.append(Row(Kind.TICKS, "zero crossings", ticks=ticks, borders=borders))
    touched = [each for each in _touching(observation) if each.body == link.ee]
    for name in _in_order(each.other for each in touched):
        bars = tuple(_span(each, clock) for each in touched if each.other == name)
        label = f"touches {marked(observation, name)}"
        out.append(Row(Kind.BARS, label, bars, borders=borders, about=(link.ee, name)))
    if link.ee in speeds and is_detailed(observation):
        out.append(Row(Kind.CURVE, "speed", curve=speeds[link.ee], borders=borders))
    return out


def _joint_rows(observation: Observation, clock: Callable[[int], float]) -> list[Row]:
    """For those who act together: what they do as one action."""
    rows = []
    kinds = _kinds(observation)
    for ees in _in_order(each.who for each in observation.joint):
        joint = [each for each in observation.joint if each.who == ees]
        spans = tuple(
            Span(clock(each.first), clock(each.last), each.name, kinds.get(each.name, each.name))
            for each in joint
        )
        rows.append(Row(Kind.SEGMENTS, _who(observation, joint[0]), spans))
    return rows


def _who(observation: Observation, joint: JointAction) -> str:
    """Who takes part, in few words: of many the first two are named."""
    if len(joint.who) <= MOST_NAMED:
        return observation.who(joint)
    first, second = (spoken(each) for each in joint.who[:2])
    return f"{first}, {second} and {len(joint.who) - 2} more"


def kind_of(segment: Segment) -> str:
    """What kind of action a segment is: the most general name that it specialises, or its own."""
    return segment.general[-1] if segment.general else segment.name


def _kinds(observation: Observation) -> dict[str, str]:
    """The kind of each name that segments have or specialise."""
    return {
        name: kind_of(each) for each in observation.segments for name in (*each.general, each.name)
    }


def _object_rows(observation: Observation, clock: Callable[[int], float]) -> list[Row]:
    acting = {each.ee for each in observation.links}
    between = [each for each in _touching(observation) if each.body not in acting]
    pairs: dict[frozenset[str], list[Touching]] = {}
    for relation in between:
        pairs.setdefault(frozenset((relation.body, relation.other)), []).append(relation)
    out = []
    for found in pairs.values():
        names = (found[0].body, found[0].other)
        label = " touches ".join(marked(observation, each) for each in names)
        bars = tuple(dict.fromkeys(_span(each, clock) for each in found))
        out.append(Row(Kind.BARS, label, bars, about=names))
    moves = sorted(each for each in observation.facts if isinstance(each, Moving))
    for name in _in_order(each.object for each in moves):
        bars = tuple(_span(each, clock) for each in moves if each.object == name)
        label = f"{marked(observation, name)} moves"
        out.append(Row(Kind.MOTION, label, bars, about=(name,)))
    return [Row(Kind.HEADING, "objects"), *out] if out else []


def _gaze_rows(observation: Observation, clock: Callable[[int], float]) -> list[Row]:
    looks = [each for each in observation.facts if isinstance(each, LookingAt)]
    looks.sort(key=lambda each: (each.first, each.last, each.object))
    out = []
    for sensor in _in_order(each.sensor for each in looks):
        spans = tuple(
            Span(clock(each.first), clock(each.last), marked(observation, each.object))
            for each in looks
            if each.sensor == sensor
        )
        out.append(Row(Kind.NAMES, f"{spoken(sensor)} looks at", spans))
    return [Row(Kind.HEADING, "attention"), *out] if out else []


def _touching(observation: Observation) -> list[Touching]:
    found = [each for each in observation.facts if isinstance(each, Touching)]
    return sorted(found, key=lambda each: (each.first, each.last, each.body, each.other))


def _span(fact: Touching | Moving, clock: Callable[[int], float]) -> Span:
    return Span(clock(fact.first), clock(fact.last), "")


def _in_order(names: Iterable[_Name]) -> list[_Name]:
    """Each once, as first met."""
    return list(dict.fromkeys(names))
