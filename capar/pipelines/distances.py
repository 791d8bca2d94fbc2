"""How far bodies are apart over time, as their contact is told."""

import math
from collections.abc import Iterator
from functools import cache

import numpy as np
from jaxtyping import Float, Int

from capar.model.calibration import Found, PairCalibration
from capar_rules.explain.measured import Apart
from capar_rules.explain.reaches import Between, Reach
from extractors.contact.blows import SETTLES
from extractors.contact.contacts import points_apart
from extractors.contact.proximity import separation
from extractors.contact.touch_distances import touchable
from extractors.measure import Measurements

OUTLYING_M = 0.01
"""An origin that lies so far outside of a body's box, or from its middle [m], is told to."""

SAMPLES = 120
"""At so many frames of a span at most distances of surfaces are measured [1]."""


def frames_between(first: int, last: int) -> Int[np.ndarray, "some"]:
    """The frames of a span at which distances are measured, evenly, with the first and last."""
    step = max(1, math.ceil((last - first + 1) / SAMPLES))
    return np.unique([*range(first, last + 1, step), last])


def distances(
    measurements: Measurements, pair: PairCalibration, frames: Int[np.ndarray, "some"]
) -> Float[np.ndarray, "some"]:
    """How far the first of a pair, or the nearest of its parts, is from the second [m].

    Args:
        measurements: What was measured of a capture.
        pair: Two of its bodies, and how their contact is counted.
        frames: Where to measure; NaN where either is lost, infinity where no part can touch.
    """
    return np.asarray(np.min(list(_of_parts(measurements, pair, frames)), axis=0))


def _of_parts(
    measurements: Measurements, pair: PairCalibration, frames: Int[np.ndarray, "some"]
) -> Iterator[Float[np.ndarray, "some"]]:
    bodies, calibration = measurements.bodies, measurements.calibration
    other = bodies.objects[pair.second]
    hand = pair.first in bodies.sensors
    parts = bodies.on_end_effector(pair.first) if hand else (bodies.objects[pair.first],)
    for part in parts:
        own = calibration.sought(part.name, other.name)
        if own is None or own.found is Found.NEVER:
            yield np.full(len(frames), np.inf)
        elif own.pivots:
            yield points_apart(own, part, other)[frames]
        else:
            yield separation(touchable(part), touchable(other), frames)


def apart_within(measurements: Measurements) -> Apart:
    """How far bodies were apart, at the frames at which pictures show it."""

    @cache
    def range_of(one: str, other: str, first: int, last: int) -> tuple[float, float] | None:
        pair = measurements.calibration.sought(one, other)
        pair = pair or measurements.calibration.sought(other, one)
        if pair is None:
            return None
        found = distances(measurements, pair, frames_between(first, last))
        known = np.isfinite(found).any()
        return (float(np.nanmin(found)), float(np.nanmax(found))) if known else None

    return range_of


def reaches(measurements: Measurements) -> dict[tuple[str, str], Reach]:
    """Up to which distance, and of what, two bodies are counted as touching, in either order."""
    return {
        names: Reach(
            max(pair.touch_m, pair.release_m),
            _measured_between(pair, measurements),
            pair.touch_m,
            tuple(
                name
                for name in (pair.first, pair.second)
                if measurements.bodies.named(name).shape is None
            ),
            _outlying(pair, measurements),
            offsets=_offsets(pair, measurements),
            settles=pair.pivots
            and pair.found in SETTLES
            and pair.first in measurements.bodies.sensors,
        )
        for pair in measurements.calibration.pairs
        if pair.found is not Found.NEVER
        for names in ((pair.first, pair.second), (pair.second, pair.first))
    }


def _outlying(
    pair: PairCalibration, measurements: Measurements
) -> tuple[tuple[str, str, float], ...]:
    """The bodies of a pair whose origins are compared and are not where they seem to be.

    Returns:
        For each its name, where its origin lies, in words, and how far from there [m].
    """
    if _measured_between(pair, measurements) is not Between.ORIGINS:
        return ()
    found = []
    for name in (pair.first, pair.second):
        shape = measurements.bodies.named(name).shape
        if shape is not None:
            low, high = shape.bounds
            far = float(np.linalg.norm(np.maximum(np.maximum(low, -high), 0.0)))
            off = float(np.linalg.norm(0.5 * (low + high)))
            if far >= OUTLYING_M:
                found.append((name, "outside of it", far))
            elif off >= OUTLYING_M:
                found.append((name, "from its middle", off))
    return tuple(found)


def _offsets(pair: PairCalibration, measurements: Measurements) -> tuple[tuple[str, float], ...]:
    """How far the points of a pair that are compared lie from the origins of their bodies."""
    if _measured_between(pair, measurements) is not Between.POINTS:
        return ()
    points = (pair.first, pair.first_point), (pair.second, pair.second_point)
    return tuple((name, math.hypot(*point)) for name, point in points)


def _measured_between(pair: PairCalibration, measurements: Measurements) -> Between:
    if not pair.pivots:
        bodies = (measurements.bodies.named(name) for name in (pair.first, pair.second))
        shaped = all(body.shape is not None for body in bodies)
        return Between.SURFACES if shaped else Between.POINT
    stated = pair.found in (Found.STATED, Found.TOLERANCE)
    return Between.ORIGINS if stated else Between.POINTS
