"""Where the numbers of a panel stand: beside their marks, and on no line, bar or other number."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from jaxtyping import Float

Box = tuple[float, float, float, float]
"""Left, right, bottom and top, from the lower left corner of the panel [inches]."""

Place = tuple[float, float]
"""Rightward and upward from that corner [inches]."""

BESIDE_IN, CLEAR_IN, DOT_IN = 0.07, 0.025, 0.045
"""How far a number is from its mark, and at least from lines; half the size of a mark [inches]."""

ASIDE_IN = (0.0, 0.2, 0.45, 0.8)
"""How much further to the side a number may stand [inches]."""

STEP_IN = 0.03
"""Steps of height at which a place is tried, and of the samples of a curve [inches]."""

LED_IN = 0.16
"""Further from its mark than this a number has a line to it [inches]."""

OUTSIDE, MET, CURVE, LIMIT, BAR, LOST = 1000.0, 100.0, 8.0, 8.0, 12.0, 3.0
"""How bad it is to leave the panel, and to stand on a number or mark, a line, a bar or a gap."""

FAR, TURN = 12.0, 0.4
"""How bad each inch from the mark is, and each side after the right one."""


@dataclass(frozen=True)
class Drawn:
    """What is drawn in a panel beside its numbers."""

    size: tuple[float, float]
    """Width and height of the panel [inches]."""

    curves: tuple[Float[np.ndarray, "points 2"], ...] = ()
    """Places of their points; NaN where a curve has a gap."""

    limits: tuple[float, ...] = ()
    """Heights of lines across the panel [inches]."""

    bars: tuple[Box, ...] = ()
    lost: tuple[Box, ...] = ()

    @cached_property
    def samples(self) -> Float[np.ndarray, "samples 2"]:
        """Places along the curves, nowhere further apart than a step."""
        return np.concatenate([np.zeros((0, 2)), *map(self._sampled, self.curves)])

    def _sampled(self, curve: Float[np.ndarray, "points 2"]) -> Float[np.ndarray, "samples 2"]:
        near = np.clip(curve, -0.5, np.array(self.size) + 0.5)
        lengths = np.linalg.norm(np.diff(near, axis=0), axis=1)
        parts = [near[np.isfinite(near).all(axis=1)]]
        for index in np.flatnonzero(lengths > STEP_IN):
            shares = np.arange(0.0, 1.0, STEP_IN / lengths[index])[:, None]
            parts.append(near[index] + shares * (near[index + 1] - near[index]))
        return np.concatenate(parts)


def place_numbers(
    dots: Sequence[Place], sizes: Sequence[tuple[float, float]], drawn: Drawn
) -> list[Box]:
    """What each number covers, in turn where it hides least and is nearest to its mark.

    Args:
        dots: Where the marks are.
        sizes: Width and height of the number of each; none stands for a mark without a width.
        drawn: What else there is.
    """
    marks = [_grown((x, x, y, y), DOT_IN) for x, y in dots]
    taken: list[Box] = []
    for index, (dot, size) in enumerate(zip(dots, sizes, strict=True)):
        others = [*taken, *(mark for other, mark in enumerate(marks) if other != index)]
        tries = _tries(dot, size, drawn)
        costs = [cost + _cost(box, dot, others, drawn) for box, cost in tries]
        taken.append(tries[int(np.argmin(costs))][0])
    return taken


def is_led(box: Box, dot: Place) -> bool:
    """Whether a number is so far from its mark that a line leads to it."""
    return distance(box, dot) > LED_IN


def distance(box: Box, place: Place) -> float:
    """How far a place is from a box [inches]."""
    aside = max(box[0] - place[0], place[0] - box[1], 0.0)
    return float(np.hypot(aside, max(box[2] - place[1], place[1] - box[3], 0.0)))


def meet(one: Box, other: Box) -> bool:
    """Whether two boxes have a place in common."""
    return one[0] <= other[1] and other[0] <= one[1] and one[2] <= other[3] and other[2] <= one[3]


def _tries(dot: Place, size: tuple[float, float], drawn: Drawn) -> list[tuple[Box, float]]:
    """Each place that a number may have, with what its side alone costs."""
    wide, tall = size
    sides = [(dot[0] + BESIDE_IN + more, 0.0) for more in ASIDE_IN]
    sides += [(dot[0] - BESIDE_IN - wide - more, TURN) for more in ASIDE_IN]
    sides.append((dot[0] - wide / 2.0, 2.0 * TURN))
    beside = (dot[1] + BESIDE_IN / 2.0, dot[1] - BESIDE_IN / 2.0 - tall)
    heights = [*beside, *np.arange(CLEAR_IN, drawn.size[1] - tall, STEP_IN)]
    boxes = [((x, x + wide, y, y + tall), cost) for (x, cost), y in product(sides, heights)]
    return [(box, cost) for box, cost in boxes if distance(box, dot) >= BESIDE_IN / 2.0]


def _cost(box: Box, dot: Place, others: Sequence[Box], drawn: Drawn) -> float:
    wide, tall = drawn.size
    outside = box[0] < 0.0 or box[1] > wide or box[2] < 0.0 or box[3] > tall
    left, right, low, high = clear = _grown(box, CLEAR_IN)
    x, y = drawn.samples.T
    covered = int(((x > left) & (x < right) & (y > low) & (y < high)).sum())
    return (
        OUTSIDE * outside
        + MET * sum(meet(clear, other) for other in others)
        + CURVE * min(covered, 1)
        + covered * CURVE * STEP_IN
        + LIMIT * sum(low < limit < high for limit in drawn.limits)
        + BAR * sum(meet(box, bar) for bar in drawn.bars)
        + LOST * sum(meet(box, gap) for gap in drawn.lost)
        + FAR * distance(box, dot)
    )


def _grown(box: Box, by_in: float) -> Box:
    return box[0] - by_in, box[1] + by_in, box[2] - by_in, box[3] + by_in
