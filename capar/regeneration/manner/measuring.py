"""The effort of a performed motion, measured against the plan without an effort."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq, least_squares
from scipy.spatial.transform import RigidTransform

from capar.regeneration.drafts import Draft
from capar.regeneration.hand_paths import Care
from capar.regeneration.manner.profiles import OVERSHOOT, paused, shaped, timed
from capar.regeneration.manner.reshaping import (
    Stretch,
    hand_edges,
    hand_stretches,
    turned_way,
)
from capar.regeneration.motions import Motion
from capar.regeneration.planning import Plan, led
from capar.regeneration.quality import performed_hands
from capar.regeneration.styles import Style

WORTH_M = 0.1
"""Shorter ways tell no effort [m]."""

FREE = 0.05
"""Bound flow that is less cannot be told from free flow where no way ends free [1]."""

MOST = 1.5
"""How far beyond the poles an effort is measured [1]."""


@dataclass(frozen=True)
class MeasuredEffort:
    """Parameters that can be measured in a performed motion; None for those that cannot."""

    time: float | None
    weight: float | None
    space: float | None
    flow: float | None

    @property
    def values(self) -> dict[str, float | None]:
        """By parameter."""
        return {"time": self.time, "weight": self.weight, "space": self.space, "flow": self.flow}

    def __str__(self) -> str:
        """For people."""
        return ", ".join(
            f"{name} {value:+.2f}" if value is not None else f"{name} not measured"
            for name, value in self.values.items()
        )


@dataclass(frozen=True, eq=False)
class _Pair:
    """A stretch of a hand's way as planned without an effort, and as it was performed."""

    stretch: Stretch
    old: RigidTransform
    new: RigidTransform
    other_detour: bool
    """Whether they are led around things otherwise."""


def measured_effort(motion: Motion, style: Style) -> MeasuredEffort:
    """Fit the profiles of an effort to the ways of the performed hands.

    They are compared with what the same body would do in the same scene without an effort. Time,
    weight and bound flow are those with which the share of each free way that is covered comes
    nearest to the performed one, by least squares; the last free ways, which free flow overshoots,
    are left out. Free flow is told by how far a hand goes beyond the end of these. Space is the one
    with which the ways become as much longer than straight as the performed ones are; ways that
    are led around something otherwise than without an effort are left out.

    Args:
        motion: What was performed.
        style: How it was recorded, without an effort.
    """
    pairs = list(_pairs(motion, style))
    inner = [pair for pair in pairs if not pair.stretch.ends_free]
    last = [pair for pair in pairs if pair.stretch.ends_free and _chord_m(pair.new) >= WORTH_M]
    time = weight = bound = None
    if inner:
        time, weight, bound = _timing(inner)
    beyond = [_beyond(pair.new) - _beyond(pair.old) for pair in last]
    flow = bound if last or (bound or 0.0) > FREE else None
    if beyond and max(beyond) > 0.1 * OVERSHOOT:
        flow = -float(np.mean(beyond)) / OVERSHOOT
    straight = [pair for pair in inner if not pair.other_detour and _chord_m(pair.old) >= WORTH_M]
    return MeasuredEffort(time, weight, _space(straight, weight or 0.0), flow)


def _pairs(motion: Motion, style: Style) -> Iterator[_Pair]:
    plan, usual = motion.plan, _without_effort(motion, style)
    for side, new in performed_hands(motion).items():
        turns = [frame for hand, frame in {*plan.detours, *usual.detours} if hand == side]
        other = [f for f in turns if plan.detours.get((side, f)) != usual.detours.get((side, f))]
        edges = hand_edges(plan.source, side)
        for stretch in hand_stretches(plan.source, side):
            part = slice(stretch.first, stretch.last + 1)
            old, start = usual.hands[side][part], max(e for e in edges if e <= stretch.first)
            if turned_way(old)[-1] >= WORTH_M and len(old) > 4:
                yield _Pair(stretch, old, new[part], start in other)


def _without_effort(motion: Motion, style: Style) -> Plan:
    """What the same body would do in the same scene with the same grips."""
    plan = motion.plan
    draft = Draft(plan.source, plan.scene, plan.human, style)
    draft.grips = plan.grips
    return led(draft, Care())


def _timing(pairs: list[_Pair]) -> tuple[float, float, float]:
    """Time, weight and bound flow by least squares on the shares of the way."""

    def off(values: Float[np.ndarray, "3"]) -> Float[np.ndarray, "rows"]:
        rows = []
        for pair in pairs:
            shares = timed(_shares(pair.old), values[0], values[1])
            rows.append(paused(shares, values[2], pair.stretch.pauses) - _shares(pair.new))
        return np.concatenate(rows)

    low, high = [-MOST, -MOST, -1e-9], [MOST, MOST, MOST]
    found = least_squares(off, [0.0, 0.0, 0.05], bounds=(low, high), diff_step=1e-4)
    time, weight, bound = (float(value) for value in found.x)
    return time, weight, bound


def _space(pairs: list[_Pair], weight: float) -> float | None:
    """The effort of space by the mean of how much longer than straight ways are."""
    if not pairs:
        return None
    wanted = np.mean([_detour(pair.new.translation) for pair in pairs])

    def off(space: float) -> float:
        made = []
        for pair in pairs:
            free = np.ones(len(pair.old))
            made.append(_detour(shaped(pair.old.translation, space, weight, free)))
        return float(np.mean(made) - wanted)

    low, high = off(-MOST), off(1.0)
    if low <= 0.0 or high >= 0.0:
        return -MOST if low <= 0.0 else 1.0
    return float(brentq(off, -MOST, 1.0, xtol=1e-3))


def _shares(path: RigidTransform) -> Float[np.ndarray, "frames"]:
    length = turned_way(path)
    return np.asarray(length / length[-1])


def _detour(spots: Float[np.ndarray, "frames 3"]) -> float:
    """How much longer than straight a way is [1]."""
    length = float(np.linalg.norm(np.diff(spots, axis=0), axis=1).sum())
    return length / float(np.linalg.norm(spots[-1] - spots[0])) - 1.0


def _beyond(path: RigidTransform) -> float:
    """How far a way goes beyond its end, along the straight way [1, of that]."""
    chord = path.translation[-1] - path.translation[0]
    along = (path.translation - path.translation[0]) @ chord / float(chord @ chord)
    return float(along.max() - 1.0)


def _chord_m(path: RigidTransform) -> float:
    return float(np.linalg.norm(path.translation[-1] - path.translation[0]))
