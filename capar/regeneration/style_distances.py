"""How far two ways of doing the same are apart, and whose a way is."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from jaxtyping import Float

from capar.regeneration.errors import PlanError
from capar.regeneration.path_mapping import arc_shares

SAMPLES = 17
"""Of the shape at equal steps of the way, and of the timing at equal steps of time [1]."""

APART_M, APART_SHARE = 0.05, 0.05
"""A shape so far aside counts as much as a timing that is so far off: one unit of distance."""

LEAST_SPREAD = 0.03
"""Every single number of a style is taken to vary at least so much, in units of distance [1]."""

SHORTEST_M = 0.05
"""A shorter way has no direction from which anything could deviate [m]."""


@dataclass(frozen=True, eq=False)
class WayStyle:
    """The style of one way: PathStyle as a sampled shape, VelStyle as a sampled timing."""

    shape: Float[np.ndarray, "samples 3"]
    """Deviations from the straight way, along it, to its left and upwards [m]."""

    timing: Float[np.ndarray, "samples"]
    """Shares of the way covered at equal steps of time [1]."""


def way_style(positions: Float[np.ndarray, "frames 3"]) -> WayStyle:
    """The style of a way from its first to its last place.

    Args:
        positions: Places at equal steps of time [m].

    Raises:
        PlanError: It is too short to have a direction.
    """
    chord = positions[-1] - positions[0]
    if np.linalg.norm(chord) < SHORTEST_M:
        raise PlanError(f"a way of {np.linalg.norm(chord):.3f} m has no style of its own")
    shares = arc_shares(positions)
    steps = np.linspace(0.0, 1.0, SAMPLES)
    even = np.stack([np.interp(steps, shares, column) for column in positions.T], axis=1)
    aside = even - positions[0] - np.outer(steps, chord)
    timing = np.interp(steps, np.linspace(0.0, 1.0, len(shares)), shares)
    return WayStyle(aside @ _axes(chord), timing)


def style_distance(one: WayStyle, other: WayStyle) -> float:
    """Root mean square of how far shapes and timings are apart, in units of both [1]."""
    shape = np.sum((one.shape - other.shape) ** 2, axis=1).mean() / APART_M**2
    timing = float(np.mean((one.timing - other.timing) ** 2)) / APART_SHARE**2
    return float(np.sqrt(shape + timing))


def nearest_performer(style: WayStyle, trials: Mapping[str, Sequence[WayStyle]]) -> str:
    """Whose trials a style is nearest to, in the mean; the first by name where equally near."""
    return min(
        sorted(trials),
        key=lambda name: np.mean([style_distance(style, trial) for trial in trials[name]]),
    )


@dataclass(frozen=True, eq=False)
class StyleMetric:
    """A distance that counts a difference by how little it varies without meaning anything.

    Two things change a style though the performer is the same: a performer's trials vary, and
    another body in another scene cannot keep it all, as where a way is lifted clear of a table.
    """

    weights: Float[np.ndarray, "features features"]
    """Inverse of the covariance of both."""

    def distance(self, one: WayStyle, other: WayStyle) -> float:
        """How far two styles are apart, in standard deviations (Mahalanobis 1936) [1]."""
        apart = _features(one) - _features(other)
        return float(np.sqrt(apart @ self.weights @ apart))

    def nearest_performer(self, style: WayStyle, trials: Mapping[str, Sequence[WayStyle]]) -> str:
        """Whose trials a style is nearest to, in the mean; the first by name if equally near."""
        return min(
            sorted(trials),
            key=lambda name: np.mean([self.distance(style, trial) for trial in trials[name]]),
        )


def style_metric(
    trials: Mapping[str, Sequence[WayStyle]], performed: Sequence[tuple[WayStyle, WayStyle]]
) -> StyleMetric:
    """The metric of some performers' trials and of what performing changes.

    Args:
        trials: Of each performer, at least two of one of them.
        performed: Styles that were borrowed, each with that of the motion that came of it.
    """
    rows = [np.array([_features(trial) for trial in some]) for some in trials.values()]
    off = np.concatenate([some - some.mean(axis=0) for some in rows])
    within = off.T @ off / (len(off) - len(rows))
    lost = np.array([_features(made) - _features(given) for given, made in performed])
    changed = lost.T @ lost / len(lost) if len(lost) else np.zeros_like(within)
    least = LEAST_SPREAD**2 * np.eye(len(within))
    return StyleMetric(np.linalg.inv(within + changed + least))


def _features(style: WayStyle) -> Float[np.ndarray, "features"]:
    """Shape and timing, whose difference has ``style_distance`` as its length [1]."""
    shape, timing = style.shape.ravel() / APART_M, style.timing / APART_SHARE
    return np.concatenate([shape, timing]) / np.sqrt(SAMPLES)


def within_distance(trials: Mapping[str, Sequence[WayStyle]]) -> float:
    """Mean distance of two trials of one performer [1]."""
    return _mean(pair for some in trials.values() for pair in combinations(some, 2))


def between_distance(trials: Mapping[str, Sequence[WayStyle]]) -> float:
    """Mean distance of two trials of different performers [1]."""
    pairs = combinations(trials.values(), 2)
    return _mean(pair for one, other in pairs for pair in product(one, other))


def nearest_between(trials: Mapping[str, Sequence[WayStyle]]) -> float:
    """Mean distance of trials of the two performers that are nearest to each other [1]."""
    pairs = combinations(trials.values(), 2)
    return min(_mean(product(one, other)) for one, other in pairs)


def _mean(pairs: Iterable[tuple[WayStyle, WayStyle]]) -> float:
    return float(np.mean([style_distance(one, other) for one, other in pairs]))


def _axes(chord: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """Columns: along the way on the level, to the left of it, and up."""
    along = np.array([chord[0], chord[1], 0.0])
    length = float(np.linalg.norm(along))
    along = along / length if length > SHORTEST_M else np.array([1.0, 0.0, 0.0])
    up = np.array([0.0, 0.0, 1.0])
    return np.stack([along, np.cross(up, along), up], axis=1)
