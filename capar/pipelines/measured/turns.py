"""Turns and leans of bodies as panels over time."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from capar.model.facts import (
    Leans,
)
from capar.model.geometry import from_mean
from capar.pipelines.measured.recording import MILLI, Recording, held, told_beside
from capar.pipelines.measured.relations import Series
from capar.views.panels import Limit, Mark, Panel
from capar_rules.borders.ticks import constants
from capar_rules.explain.claimed_measures import Measure
from capar_rules.explain.claims import Quantity
from capar_rules.explain.quantities import (
    angle_bound,
    degrees,
)
from capar_rules.explain.quantities import change as change_of
from extractors.calibration import thresholds_of
from extractors.motion.phases import lean, spin_steps
from extractors.relations.places import turned_and_gone


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


TURNS: Mapping[Measure, Series] = {
    Measure.LEAN: _lean,
    Measure.TURN: _turn,
    Measure.TURNED: _turned,
    Measure.TURN_IN_ALL: _turn_in_all,
}
"""The panel of each quantity that is an angle."""
