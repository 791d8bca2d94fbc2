"""Each quantity that a claim rests on as a panel over time, with its limits and its numbers."""

from collections.abc import Mapping

import numpy as np

from capar.model.facts import (
    Opening,
    Swings,
)
from capar.pipelines.explanation import AXES
from capar.pipelines.measured.recording import CENTI, MILLI, Recording, held
from capar.pipelines.measured.relations import RELATIONS, Series
from capar.pipelines.measured.rests import SPEEDS
from capar.pipelines.measured.turns import TURNS
from capar.pipelines.measured.ways import WAYS_SHOWN
from capar.views.panels import Curve, Mark, Panel
from capar_rules.explain.claimed_measures import Measure
from capar_rules.explain.claims import Quantity
from capar_rules.explain.quantities import (
    length,
)
from extractors.calibration import thresholds_of
from extractors.motion.phases import most_turns


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


SERIES: Mapping[Measure, Series] = {
    **RELATIONS,
    **WAYS_SHOWN,
    **TURNS,
    **SPEEDS,
    Measure.TO_AND_FRO: _to_and_fro,
    Measure.OPENING: _opening,
}
"""The panel of each quantity."""
