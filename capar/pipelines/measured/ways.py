"""Ways of bodies as panels over time: how far, how high, to the side, along their paths."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from capar.model.facts import (
    Moving,
    Resting,
)
from capar.model.geometry import from_middle
from capar.pipelines.measured.recording import CENTI, MILLI, Recording, held, told_beside
from capar.pipelines.measured.relations import Series
from capar.views.panels import Limit, Mark, Panel
from capar_rules.borders.ticks import constants
from capar_rules.explain.claimed_measures import Measure
from capar_rules.explain.claims import Quantity
from capar_rules.explain.quantities import (
    LEAST_M,
    apart,
    extreme,
    length,
    spread,
)
from capar_rules.explain.told_motions import COURSES
from extractors.relations.places import turned_and_gone

WAYS = {
    "place": ("aside_mm", "near is within {}"),
    "not_near": ("aside_mm", "near is within {}"),
    "not_slid": ("slide_mm", "a slide takes {}"),
    "away": ("aside_mm", "back there is within {}"),
    "back": ("aside_mm", "back there is within {}"),
}
"""By the format of a way: the constant of the rules that it is compared with, and how it reads."""

COMPARED = {"not_up", "not_down", "not_aside"}
"""Forms that compare a way up or down with one to the side."""

MINUS = "\u2212"


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


def _beside_other(known: Recording, told: Quantity, forms: frozenset[str]) -> tuple[str, str]:
    """The way up or down and that to the side, where they are compared and would read alike."""
    (name,) = told.bodies
    x, y, z = np.diff(np.rint(MILLI * known.body(name).middles[[told.first, told.last]]), axis=0)[0]
    alike = length(abs(z) / MILLI) == length(math.hypot(x, y) / MILLI)
    return apart(abs(z), math.hypot(x, y)) if forms & COMPARED and alike else ("", "")


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


WAYS_SHOWN: Mapping[Measure, Series] = {
    Measure.WAY: _way,
    Measure.SPREAD: _spread,
    Measure.HEIGHT: _height,
    Measure.ASIDE: _aside,
    Measure.PATH: _path,
}
"""The panel of each quantity that is a way."""
