"""Quaternions in another order than declared, by bodies that turn as one.

To exchange the components of quaternions keeps all angles between them: speeds of turning, rests
and jumps stay the same, and show nothing. What changes is the axis of every turn, and so where a
body lies in the frame of another one: what is carried, worn or joined stays there in the right
order, and wanders in the wrong one.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import permutations

import numpy as np
from jaxtyping import Float

from capar.model.capture import Stream
from capar.model.notices import Notice, notice
from extractors.bodies.poses import rotation_matrices
from extractors.signals.intervals import frame_rate
from extractors.thresholds import Thresholds

SAMPLES = 16  # So many frames of each stretch are compared [1].
SHIFT = {"xyzw": ("wxyz", -1), "wxyz": ("xyzw", 1)}
"""The other order of each, and how far components w x y z shift where that one is right."""


@dataclass(frozen=True, eq=False)
class _Sampled:
    """A body at the sampled frames of each stretch."""

    times: Float[np.ndarray, "stretches samples"]
    positions: Float[np.ndarray, "stretches samples 3"]
    orientations: Float[np.ndarray, "stretches samples 4"]
    shift: int

    @cached_property
    def matrices(self) -> tuple[Float[np.ndarray, "stretches samples 3 3"], ...]:
        """Rotation matrices by the declared order, and by the other one."""
        turns = self.orientations, np.roll(self.orientations, self.shift, axis=-1)
        shape = *self.orientations.shape[:2], 3, 3
        return tuple(rotation_matrices(each.reshape(-1, 4)).reshape(shape) for each in turns)


def order_notices(
    bodies: Mapping[str, Stream],
    orders: Mapping[str, str],
    unit_m: float,
    thresholds: Thresholds,
) -> Iterator[Notice]:
    """A notice for each order that was declared for bodies of a file and cannot be theirs.

    In stretches of a second two bodies turn as one if either lies steadily in the other's frame,
    while the direction between them turns in the world. Each such stretch in which the orders
    disagree is evidence for one of them.

    ``bodies``: poses of the file by name. ``orders``: the declared order of each, ``xyzw``
    or ``wxyz``. ``unit_m``: metres per unit of the file.
    """
    for declared, (likely, shift) in SHIFT.items():
        sampled = {
            name: _sampled(bodies[name], shift, thresholds)
            for name in sorted(orders)
            if orders[name] == declared
        }
        right = 0
        wrong: list[tuple[float, str, str]] = []
        # Ordered pairs, spread evenly over all there are where those are too many.
        every = list(permutations(sampled, 2))
        step = max(1, -(-len(every) // thresholds.order_pairs))
        for first, second in every[::step]:
            votes, strays_m = _votes(sampled[first], sampled[second], unit_m, thresholds)
            right += votes
            wrong += [(stray_m, first, second) for stray_m in strays_m]
            if right + len(wrong) >= thresholds.order_enough:
                break
        least = max(thresholds.order_stretches, right / thresholds.order_share)
        if len(wrong) >= least:
            stray_m, first, second = max(wrong)
            yield notice(
                "order-contradicted",
                first,
                second,
                declared=declared,
                order=likely,
                stray_m=round(stray_m, 3),
                stretches=len(wrong),
            )


def _sampled(stream: Stream, shift: int, thresholds: Thresholds) -> _Sampled:
    step = max(1, round(frame_rate(stream.times) * thresholds.order_stretch_s / SAMPLES))
    count = len(stream.times[::step]) // SAMPLES

    def stretches(values: np.ndarray) -> np.ndarray:
        return values[::step][: count * SAMPLES].reshape(count, SAMPLES, *values.shape[1:])

    return _Sampled(
        stretches(stream.times),
        stretches(stream.positions),
        stretches(stream.orientations),
        shift,
    )


def _votes(
    body: _Sampled, other: _Sampled, unit_m: float, thresholds: Thresholds
) -> tuple[int, tuple[float, ...]]:
    """Stretches that support the declared order, and how far bodies stray in the others [m]."""
    if not np.array_equal(body.times, other.times):
        return 0, ()
    between = other.positions - body.positions
    lengths = np.linalg.norm(between, axis=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        joined = np.ptp(lengths, axis=1) <= thresholds.joined_share * lengths.max(axis=1)
        along = between / lengths[:, :, None]
        cosines = np.einsum("bsi,bi->bs", along, along[:, 0]).min(axis=1)
        some = np.flatnonzero(joined & (cosines < np.cos(thresholds.turned_rad)))
    declared, turned = (unit_m * _strays(each[some], between[some]) for each in body.matrices)
    right = (declared <= thresholds.joined_m) & (turned >= thresholds.wander_m)
    wrong = (turned <= thresholds.joined_m) & (declared >= thresholds.wander_m)
    return int(right.sum()), tuple(map(float, declared[wrong]))


def _strays(
    turns: Float[np.ndarray, "some samples 3 3"], between: Float[np.ndarray, "some samples 3"]
) -> Float[np.ndarray, "some"]:
    """How far a place strays from its mean in a body's frame, in the unit of the file."""
    inside = np.einsum("bsji,bsj->bsi", turns, between)
    apart = np.linalg.norm(inside - inside.mean(axis=1, keepdims=True), axis=2)
    return np.asarray(apart.max(axis=1, initial=0.0))
