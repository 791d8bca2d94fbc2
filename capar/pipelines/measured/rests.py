"""Speeds of bodies as panels over time, beside those that count as rest."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from capar.model.facts import (
    Resting,
    Touching,
)
from capar.pipelines.measured.recording import MILLI, Recording, held
from capar.pipelines.measured.relations import Series
from capar.views.lettering import Span
from capar.views.panels import Limit, Panel
from capar_rules.borders.ticks import constants
from capar_rules.explain.claimed_measures import Measure
from capar_rules.explain.claims import Quantity
from capar_rules.explain.quantities import (
    length,
)
from extractors.calibration import thresholds_of
from extractors.motion.object_motion import motion_floor, pace_at_rest, paces
from extractors.signals.intervals import frame_rate
from extractors.thresholds import Thresholds

FAST = 10.0
"""A speed is shown up to so many times what may be rest [1]."""

SINCE_BEGIN = frozenset({"away", "back"})
"""Formats that tell of earlier rests: what is shown for them begins with the recording."""


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


SPEEDS: Mapping[Measure, Series] = {Measure.SPEED: _speed}
"""The panel of each quantity that is a speed."""

BESIDE: Mapping[Measure, tuple[Series, ...]] = {Measure.SPEED: (_turning,)}
"""What more is shown of a quantity, where it decides too."""
