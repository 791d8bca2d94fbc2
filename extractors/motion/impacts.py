"""Sudden motion: how fast bodies meet, and when one falls freely."""

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.geometry import Places, Series, Vector
from extractors.bodies.bodies import BodyGeometry
from extractors.bodies.poses import rotation_matrices
from extractors.signals.filters import speed, velocity
from extractors.signals.intervals import Interval, intervals, time_step
from extractors.thresholds import Thresholds

GRAVITY_MPS2 = 9.81
"""Standard acceleration of free fall, rounded [m/s^2]."""

APPROACH_S = 0.05
"""How long before a contact the speed of approach is taken [s].

No threshold: it is the time over which the low-pass filter blurs a blow.
"""


LATE_S = 0.03
"""By how much a filter may let a blow touch later [s]: half of the filter's blur."""

SWING_S = 0.13
"""For how long before a blow its acceleration is taken for steady [s].

A limb swings for a fifth of a second at least; over less, the noise of a slow clock's few frames
would decide how fast the blow was.
"""

FEWEST_PLACES = 4
"""A steady acceleration has three unknowns, and one place more shows what is noise [1]."""


def closing_speed(
    body: BodyGeometry, other: BodyGeometry, frame: int, normal: Vector | None = None
) -> float:
    """How fast two bodies approach each other, where they meet, just before a frame [m/s].

    Of what goes along the surface that is met nothing counts. The fastest approach of the
    low-passed motion in the last twentieth of a second or, if more, that of the motion as it was
    recorded, at the end of a steady acceleration: a filter rounds a blow that ends in a halt, and
    lets it touch later. Zero where either is lost or the contact begins the capture.

    ``normal``: the unit normal of their contact, from the other to the body; None if unknown.
    """
    times = body.poses.filled.times
    boxes = [body.boxes, other.boxes]
    low, high = (np.array([box[side][frame] for box in boxes]) for side in (0, 1))
    place = (low.max(axis=0) + high.min(axis=0)) / 2.0
    axis = np.eye(3) if normal is None else np.asarray(normal)[:, None]

    def offset(first: int, *, recorded: bool) -> Float[np.ndarray, "some axes"]:
        one = _material_point(body, place, frame, first, recorded=recorded)
        two = _material_point(other, place, frame, first, recorded=recorded)
        return np.asarray((one - two) @ axis)

    first = _before(times, frame, APPROACH_S)
    way = offset(first, recorded=False)
    if frame == 0 or len(way) < 2 or np.isnan(way).any():
        return 0.0
    speeds = geometry.lengths(np.diff(way, axis=0)) / np.diff(times[first : frame + 1])
    begin = _before(times, frame, LATE_S + SWING_S)
    met, clock = offset(begin, recorded=True), times[begin : frame + 1]
    ends = range(_before(times, frame, LATE_S), frame + 1)
    spans = (slice(max(_before(times, end, SWING_S) - begin, 0), end + 1 - begin) for end in ends)
    return max(float(speeds.max()), *(_speed_at_end(met[s], clock[s]) for s in spans))


def _material_point(
    body: BodyGeometry, place: Vector, frame: int, first: int, *, recorded: bool
) -> Places:
    """Where the point of a body that is at a place [m] at a frame was from a first frame on."""
    known = body.poses
    stream = known.filled if recorded else known.settled if known.rests else known.smooth
    span = slice(first, frame + 1)
    turns = rotation_matrices(stream.orientations[span])
    arm = turns[-1].T @ (place - stream.positions[frame])
    return np.asarray(stream.positions[span] + turns @ arm)


def _before(times: Series, frame: int, span_s: float) -> int:
    """The frame nearest to so long before another [s]: a slow clock has one, if not within it."""
    wanted = times[frame] - span_s
    later = int(np.searchsorted(times, wanted))
    nearer = later > 0 and wanted - times[later - 1] < times[later] - wanted
    return later - 1 if nearer else later


def release_speed(thing: BodyGeometry, frame: int) -> float:
    """How fast a body's middle goes at a frame [m/s]; zero where it is lost there."""
    about = slice(max(frame - 1, 0), frame + 2)
    places, times = thing.middles[about], thing.poses.smooth.times[about]
    pace = float(speed(places, times)[frame - about.start])
    return 0.0 if np.isnan(pace) else pace


def recorded_middles(body: BodyGeometry, span: slice) -> Float[np.ndarray, "some 3"]:
    """The middles of a body's box at some frames [m], not low-passed."""
    stream = body.poses.filled
    offset = np.zeros(3) if body.shape is None else body.shape.bounds.mean(axis=0)
    return np.asarray(
        stream.positions[span] + rotation_matrices(stream.orientations[span]) @ offset
    )


def _speed_at_end(
    places: Float[np.ndarray, "some axes"], times: Float[np.ndarray, "some"]
) -> float:
    """Speed at the end of a steadily accelerated motion, fitted by least squares [m/s]."""
    if len(places) < FEWEST_PLACES or np.isnan(places).any():
        return 0.0
    early = times - times[-1]
    powers = np.stack([np.ones_like(early), early, early**2], axis=1)
    return float(np.linalg.norm(np.linalg.lstsq(powers, places, rcond=None)[0][1]))


def falls(body: BodyGeometry, thresholds: Thresholds) -> tuple[Interval, ...]:
    """Closed intervals of frames in which a body's acceleration is that of free fall.

    It is taken over five frames, against noise; where the shortest fall has fewer, over three, all
    of which fall then.
    """
    times = body.poses.smooth.times
    slow = 4.0 * time_step(times) > thresholds.fall_minimum_s
    if slow:
        rate = np.zeros_like(body.middles)
        rate[1:-1] = np.diff(body.middles, 2, axis=0) / time_step(times) ** 2
    else:
        rate = velocity(velocity(body.middles, times), times)
    apart = geometry.lengths(rate + np.array([0.0, 0.0, GRAVITY_MPS2]))
    with np.errstate(invalid="ignore"):
        free = apart < thresholds.fall_share * GRAVITY_MPS2
    if slow:
        free[1:] |= free[:-1].copy()
        free[:-1] |= free[1:].copy()
    return tuple(intervals(free, times, dropout_s=0.0, minimum_s=thresholds.fall_minimum_s))
