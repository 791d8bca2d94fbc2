"""Each quantity that a claim rests on as a panel over time, with its limits and its numbers."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from capar.model.facts import (
    Leans,
    Moving,
    Opening,
    Resting,
    Swings,
    Touching,
)
from capar.model.geometry import from_mean, from_middle
from capar.pipelines.explanation import AXES
from capar.pipelines.measured_relations import RELATIONS, Series
from capar.pipelines.shown_recording import CENTI, MILLI, Recording, held, told_beside
from capar.views.lettering import Span
from capar.views.panels import Curve, Limit, Mark, Panel
from capar_rules.borders.times import constants
from capar_rules.explain.claimed_measures import Measure
from capar_rules.explain.claims import Quantity
from capar_rules.explain.quantities import (
    LEAST_M,
    angle_bound,
    apart,
    degrees,
    extreme,
    length,
    spread,
)
from capar_rules.explain.quantities import change as change_of
from capar_rules.explain.told_motions import COURSES
from extractors.calibration import thresholds_of
from extractors.motion.leaning import lean, spin_steps
from extractors.motion.object_motion import motion_floor, pace_at_rest, paces
from extractors.motion.turning_points import most_turns
from extractors.relations.places import turned_and_gone
from extractors.signals.clock import frame_rate
from extractors.thresholds import Thresholds

FAST = 10.0
"""A speed is shown up to so many times what may be rest [1]."""


def _way(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    middles = known.body(name).middles
    away = np.linalg.norm(middles - middles[told.first], axis=1)
    curves = [known.curve(CENTI * away, "straight")]
    moved = known.seen.explainer.measured.ways
    winding = moved is not None and "way" in forms and moved(name, told.first, told.last).winding
    end = float(away[told.last])
    placed = end
    if forms & {"place", "not_near", "not_slid"}:  # told by places in whole millimetres
        ends = np.rint(MILLI * middles[[told.first, told.last]])
        placed = float(np.linalg.norm(ends[1] - ends[0])) / MILLI
    short = placed < LEAST_M and (winding or "way" not in forms)
    limits = [known.floor(name)] if "way" in forms and known.is_object(name) else []
    for form in sorted(forms & set(WAYS)):
        limits.append(_limit(*WAYS[form]))
    label = f"less than {length(LEAST_M)}" if short else _length(CENTI * placed, limits)
    marks = [Mark(known.at(told.last), CENTI * end, label)]
    if winding:
        steps = np.nan_to_num(np.linalg.norm(np.diff(middles, axis=0), axis=1))
        path = np.concatenate([[0.0], np.cumsum(steps)])
        path -= path[told.first]
        inside = np.where(np.arange(len(path)) < told.first, np.nan, path)
        curves.append(known.curve(CENTI * inside, "along its path"))
        marks.append(Mark(known.at(told.last), CENTI * path[told.last], length(path[told.last])))
    return Panel(
        f"{known.called(name)}: way from where it was at {known.at(told.first):.2f} s",
        "cm",
        tuple(curves),
        tuple(limits),
        tuple(marks),
        known.bars(Moving, object=name),
        "counts as moving",
        held(Moving, name),
        "no motion that counts in the time shown" if known.is_object(name) else "",
    )


WAYS = {
    "place": ("aside_mm", "near is within {}"),
    "not_near": ("aside_mm", "near is within {}"),
    "not_slid": ("slide_mm", "a slide takes {}"),
    "away": ("aside_mm", "back there is within {}"),
    "back": ("aside_mm", "back there is within {}"),
}
"""By the format of a way: the constant of the rules that it is compared with, and how it reads."""


def _length(centimetres: float, limits: Sequence[Limit]) -> str:
    """A length as it is told, beside those that it is compared with."""
    return told_beside(centimetres, limits, lambda far: length(far / CENTI), " cm")


def _limit(constant: str, label: str, *, sign: float = 1.0) -> Limit:
    """A length of the rules, in centimetres."""
    metres = constants()[constant] / 1000.0
    return Limit(sign * CENTI * metres, label.format(length(metres)))


def _spread(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    middles = known.body(name).middles
    away = from_middle(middles, slice(told.first, told.last + 1))
    far = told.first + int(np.nanargmax(away[told.first : told.last + 1]))
    thing = known.is_object(name)
    return Panel(
        f"{known.called(name)}: distance from the middle of where it was",
        "cm",
        (known.curve(CENTI * away),),
        (known.floor(name),),
        (Mark(known.at(far), CENTI * away[far], f"at most {spread(away[far])}"),),
        known.bars(Moving, object=name) if thing else known.rests(name),
        "counts as moving" if thing else "counts as at rest",
        held(Moving if thing else Resting, name),
        lost=known.lost(name),
    )


def _angle_mark(known: Recording, frame: int, degrees_: float, label: str) -> Mark:
    """A mark of an angle that bounds others."""
    return Mark(known.at(frame), degrees_, label.format(angle_bound(math.radians(degrees_))))


def _turned(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    orientations = known.body(name).orientations
    angle = np.degrees(from_mean(orientations, slice(told.first, told.last + 1)))
    most = told.first + int(np.nanargmax(angle[told.first : told.last + 1]))
    return Panel(
        f"{known.called(name)}: angle to its mean orientation",
        "°",
        (known.curve(angle),),
        (known.turn_floor(name),),
        (_angle_mark(known, most, float(angle[most]), "at most {}"),),
    )


def _turn_in_all(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    turned = turned_and_gone(known.body(name))[1]
    turned = turned - turned[told.first]
    least, end = constants()["half_turn_mrad"] / 1000.0, float(turned[told.last])
    return Panel(
        f"{known.called(name)}: turned in all, about any axis, since {known.at(told.first):.2f} s",
        "°",
        (known.curve(np.degrees(turned)),),
        (Limit(math.degrees(least), f"half a turn: {math.degrees(least):.0f}°"),),
        (Mark(known.at(told.last), math.degrees(end), f"{math.degrees(end):.0f}°"),),
    )


def _path(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    gone, turned, _ = turned_and_gone(known.body(name))
    gone = gone - gone[told.first]
    angle, end = float(turned[told.last] - turned[told.first]), float(gone[told.last])
    about = constants()["wrist_mm"] / 1000.0 * angle
    return Panel(
        f"{known.called(name)}: length of its path since {known.at(told.first):.2f} s",
        "cm",
        (known.curve(CENTI * gone),),
        (Limit(CENTI * about, f"turned so far about the wrist: up to {length(about)}"),),
        (Mark(known.at(told.last), CENTI * end, length(end)),),
    )


def _height(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    height = known.body(name).middles[:, 2]
    up = height - height[told.first]
    end = float(up[told.last])
    rounded = np.diff(np.rint(MILLI * height[[told.first, told.last]]))[0] / MILLI
    limits = (
        _limit("height_mm", "up: {} or more"),
        _limit("height_mm", "down: {} or more", sign=-1.0),
    )
    sign = MINUS * bool(rounded < 0.0)
    label = _beside_other(known, told, forms)[0] or _length(CENTI * abs(rounded), limits)
    marks = [Mark(known.at(told.last), CENTI * end, sign + label)]
    inside, least = up[told.first : told.last + 1], constants()["height_mm"] / MILLI
    if forms & set(COURSES) and np.nanmax(inside) - max(end, 0.0) >= least:
        top = told.first + int(np.nanargmax(inside))
        marks.append(Mark(known.at(top), CENTI * float(up[top]), f"{extreme(up[top])} at most"))
    if forms & set(COURSES) and min(end, 0.0) - np.nanmin(inside) >= least:
        low = told.first + int(np.nanargmin(inside))
        marks.append(
            Mark(known.at(low), CENTI * float(up[low]), f"{MINUS}{extreme(-up[low])} at most")
        )
    return Panel(
        f"{known.called(name)}: height above where it was at {known.at(told.first):.2f} s",
        "cm",
        (known.curve(CENTI * up),),
        tuple(limit for limit in limits if limit.value * end >= 0.0),
        tuple(marks),
    )


COMPARED = {"not_up", "not_down", "not_aside"}
"""Forms that compare a way up or down with one to the side."""


def _beside_other(known: Recording, told: Quantity, forms: frozenset[str]) -> tuple[str, str]:
    """The way up or down and that to the side, where they are compared and would read alike."""
    (name,) = told.bodies
    x, y, z = np.diff(np.rint(MILLI * known.body(name).middles[[told.first, told.last]]), axis=0)[0]
    alike = length(abs(z) / MILLI) == length(math.hypot(x, y) / MILLI)
    return apart(abs(z), math.hypot(x, y)) if forms & COMPARED and alike else ("", "")


MINUS = "\u2212"


def _aside(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    level = known.body(name).middles[:, :2]
    limits = [_limit("aside_mm", "aside: {} or more")] * bool(forms - {"direction"})
    limits += [_limit("slide_mm", "a direction counts from {} on")] * ("direction" in forms)
    away = np.linalg.norm(level - level[told.first], axis=1)
    end = float(away[told.last])
    rounded = np.diff(np.rint(MILLI * level[[told.first, told.last]]), axis=0)[0] / MILLI
    label = _beside_other(known, told, forms)[1] or _length(CENTI * math.hypot(*rounded), limits)
    return Panel(
        f"{known.called(name)}: way to the side from where it was at {known.at(told.first):.2f} s",
        "cm",
        (known.curve(CENTI * away),),
        tuple(limits),
        (Mark(known.at(told.last), CENTI * end, label),),
    )


def _lean(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    measurements = known.seen.measurements
    upright = np.array(measurements.calibration.body(name).upright)
    angle = np.degrees(lean(known.body(name).orientations, upright))
    ends = [round(MILLI * math.radians(angle[frame])) for frame in (told.first, told.last)]
    limits, labels = [], [degrees(end) for end in ends]
    marks = [
        Mark(known.at(frame), float(angle[frame]), label)
        for frame, label in zip((told.first, told.last), labels, strict=True)
    ]
    far = math.degrees(thresholds_of(measurements.calibration).lean_rad)
    if forms & {"far_over", "leaning"}:
        limits.append(Limit(far, f"far over from {far:.0f}° on"))
    if "far_over" in forms:
        most = told.first + int(np.nanargmax(angle[told.first : told.last + 1]))
        marks.append(_angle_mark(known, most, float(angle[most]), "{} at most"))
    inside = angle[told.first : told.last + 1]
    most = told.first + int(np.nanargmax(inside))
    change_deg = math.degrees(constants()["turn_mrad"] / MILLI)
    beyond = float(np.nanmax(inside)) - max(inside[0], inside[-1]) >= change_deg
    if "not_leant" in forms and beyond and "far_over" not in forms:
        marks.append(_angle_mark(known, most, float(angle[most]), "{} at most"))
    if forms & {"lean", "not_leant"}:
        change = math.degrees(constants()["turn_mrad"] / 1000.0)
        start = float(angle[told.first])
        marks[1] = replace(marks[1], label=f"{labels[1]} (a change of {change_of(*ends)})")
        limits += [
            Limit(value, f"{change:.0f}° {sense} than at the start")
            for value, sense in ((start + change, "more"), (start - change, "less"))
            if value > 0.0
        ]
    return Panel(
        f"{known.called(name)}: lean from {known.seen.explainer.measured.upright(name)}",
        "°",
        (known.curve(angle),),
        tuple(limits),
        tuple(marks),
        known.bars(Leans, object=name),
        f"counts as a far lean: beyond {far:.0f}°, with tipping over before and righting after it",
        held(Leans, name),
    )


def _turn(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    turned = np.concatenate([[0.0], np.cumsum(spin_steps(known.body(name).orientations))])
    turned -= turned[told.first]
    turned *= -1.0 if turned[told.last] < 0.0 else 1.0
    least = constants()["turn_mrad"]
    end = float(turned[told.last])
    limits = (Limit(math.degrees(least / MILLI), f"a turn: {degrees(least)} or more"),)
    label = told_beside(
        math.degrees(end), limits, lambda angle: degrees(round(MILLI * math.radians(angle))), "°"
    )
    return Panel(
        f"{known.called(name)}: turn about the vertical since {known.at(told.first):.2f} s",
        "°",
        (known.curve(np.degrees(turned)),),
        limits,
        (Mark(known.at(told.last), math.degrees(end), label),),
    )


def _speed(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    poses, pace = known.body(name).poses, _Pace.of(known, name)
    slow, since = MILLI * pace.slow_mps, ""
    if forms & SINCE_BEGIN:
        known = replace(known, span=(0, known.span[1]))
        since = " since the recording began"
    turning = f"and {pace.turning_deg:.0f} °/s of turning"
    if not _only_turns(known, name, pace):
        turning = f"its turning there is slow too, below {pace.turning_deg:.0f} °/s"
    free = ", touching nothing" * bool(since)
    rest = (
        f"at rest for {constants()['rest_ms'] / MILLI:.2f} s or more{free}: {pace.within} of a "
        "place, from the first to the last slow moment there; rests without a gap are one"
    )
    return Panel(
        f"{known.called(name)}: speed{since}",
        "mm/s",
        (known.curve(MILLI * paces(poses.smooth, pace.rate, pace.thresholds)[0]),),
        (Limit(slow, f"slow: below {slow:.0f} mm/s ({turning})"),),
        bars=_free_rests(known, name) if since else known.rests(name),
        bars_label=f"counts as {rest}",
        held=held(Resting, name),
        unheld=f"nowhere {rest}",
        highest=FAST * slow,
        beyond="what is faster",
        lost=known.lost(name),
        span_s=(known.at(known.span[0]), known.at(known.span[1])) if since else None,
    )


def _turning(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel | None:
    """How fast it turns, where that and not its speed keeps it from being at rest."""
    (name,) = told.bodies
    if forms & SINCE_BEGIN:
        return None
    pace = _Pace.of(known, name)
    if not _only_turns(known, name, pace):
        return None
    turning = paces(known.body(name).poses.smooth, pace.rate, pace.thresholds)[1]
    return Panel(
        f"{known.called(name)}: speed of turning, which is slow too where a rest begins and ends",
        "°/s",
        (known.curve(np.degrees(turning)),),
        (Limit(pace.turning_deg, f"slow: below {pace.turning_deg:.0f} °/s"),),
        highest=FAST * pace.turning_deg,
        beyond="what is faster",
        lost=known.lost(name),
    )


def _only_turns(known: Recording, name: str, pace: "_Pace") -> bool:
    """Whether a body turns fast somewhere in the time shown, where it is slow else."""
    speed, turning = paces(known.body(name).poses.smooth, pace.rate, pace.thresholds)
    with np.errstate(invalid="ignore"):
        alone = (speed < pace.slow_mps) & (np.degrees(turning) >= pace.turning_deg)
    return bool(alone[known.span[0] : known.span[1] + 1].any())


@dataclass(frozen=True)
class _Pace:
    """What a body may do at rest."""

    thresholds: Thresholds
    rate: float
    slow_mps: float
    turning_deg: float
    """Below which speed [m/s] and turning [degrees a second] it is slow."""

    within: str
    """How far it may be from the place where it rests."""

    @classmethod
    def of(cls, known: Recording, name: str) -> Self:
        """As calibrated for a body."""
        poses = known.body(name).poses
        limits = thresholds_of(known.seen.measurements.calibration)
        rate = frame_rate(poses.smooth.times)
        slow_mps, turning = pace_at_rest(poses.noise, rate, limits)
        floor = motion_floor(poses.noise, rate, own_m=None, thresholds=limits)
        within = f"within {length(floor.position_m)} and {math.degrees(floor.rotation_rad):.0f}°"
        return cls(limits, rate, slow_mps, math.degrees(turning), within)


def _free_rests(known: Recording, name: str) -> tuple[Span, ...]:
    """Rests of an end-effector that are long enough and in which it touches nothing."""
    met = known.bars(Touching, body=name)
    return tuple(
        rest
        for rest in known.rests(name)
        if not any(one.start_s <= rest.end_s and one.end_s >= rest.start_s for one in met)
    )


def _to_and_fro(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel | None:
    (name,) = told.bodies
    stream = known.body(name).poses.smooth
    limits = thresholds_of(known.seen.measurements.calibration)
    axis, turns = most_turns(stream, (told.first, told.last), limits)
    places = stream.positions[:, axis]
    places = CENTI * (places - np.nanmean(places[told.first : told.last + 1]))
    least = length(limits.swing_m)
    halts = "; halt: turns back where the hand halts" * bool(told.halts)
    return Panel(
        f"{known.called(name)}: place of its origin {AXES[axis]}; red: turns back between ways of "
        f"{least} or more{halts}",
        "cm",
        (known.curve(places),),
        marks=(
            *(Mark(known.at(int(at)), float(places[at])) for at in turns),
            *(Mark(known.at(at), float(places[at]), "halt") for at in sorted(told.halts)),
        ),
        bars=known.bars(Swings, body=name),
        bars_label="counts as to and fro",
        held=held(Swings, name),
    )


def _opening(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel | None:
    (name,) = told.bodies
    facts = [
        fact
        for fact in known.seen.observation.facts
        if isinstance(fact, Opening) and fact.object == name and known.inside(fact.frame)
    ]
    if not facts:
        return None
    guide = known.seen.measurements.guides[name]
    unit = "m" if guide.fit.kind == "rail" else "rad"
    facts.sort(key=lambda fact: fact.frame)
    values = {fact.frame: fact.amount / MILLI for fact in facts}
    return Panel(
        f"{known.called(name)}: how far it is open",
        unit,
        (Curve(np.array([known.at(frame) for frame in values]), np.array(list(values.values()))),),
        (),
        tuple(
            Mark(known.at(frame), values[frame], f"{values[frame]:.2f} {unit}")
            for frame in (told.first, told.last)
            if frame in values
        ),
    )


SINCE_BEGIN = frozenset({"away", "back"})
"""Formats that tell of earlier rests: what is shown for them begins with the recording."""

SERIES: Mapping[Measure, Series] = {
    **RELATIONS,
    Measure.WAY: _way,
    Measure.SPREAD: _spread,
    Measure.HEIGHT: _height,
    Measure.ASIDE: _aside,
    Measure.LEAN: _lean,
    Measure.TURN: _turn,
    Measure.TURNED: _turned,
    Measure.TURN_IN_ALL: _turn_in_all,
    Measure.PATH: _path,
    Measure.SPEED: _speed,
    Measure.TO_AND_FRO: _to_and_fro,
    Measure.OPENING: _opening,
}
"""The panel of each quantity."""

BESIDE: Mapping[Measure, tuple[Series, ...]] = {Measure.SPEED: (_turning,)}
"""What more is shown of a quantity, where it decides too."""
