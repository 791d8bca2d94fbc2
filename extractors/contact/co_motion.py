"""Where two bodies move as one: evidence that they touch, whatever their surfaces say (spec 10)."""

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from capar.model import geometry
from capar.model.capture import Stream
from extractors.bodies.poses import rotation_matrices
from extractors.signals.clock import frame_rate
from extractors.thresholds import Thresholds

Points = Float[np.ndarray, "frames 3"]


def travelling(stream: Stream, thresholds: Thresholds) -> Bool[np.ndarray, "frames"]:
    """Where a body covers some way in the world within the window of co-motion."""
    return spread(stream.positions, stream, thresholds) >= thresholds.co_motion_way_m


def steady_in(carrier: Stream, thing: Stream, thresholds: Thresholds) -> Bool[np.ndarray, "frames"]:
    """Where a thing covers some way in the world and stays where it is in a carrier's frame.

    Or the carrier stays where it is in the thing's frame, as a hand does that takes a large thing
    by its rim and tips it: its origin, far from the hand, then strays in the hand's frame. Steady
    means that it strays there by no more than a centimetre, or by no more than a share of
    its way through the world, within the window of co-motion.

    Only where it travels, and half a window about, are its places in the other's frame asked for.
    """
    way = spread(thing.positions, thing, thresholds)
    out = np.zeros(len(way), dtype=bool)
    reach = _half_window(thing, thresholds)
    with np.errstate(invalid="ignore"):
        travels = np.asarray(way >= thresholds.co_motion_way_m)
    for begin, end in geometry.runs(_widened(travels, reach)):
        some = slice(begin, end + 1)
        places = in_either_frame(carrier, thing, some)
        stray = np.minimum(*(spread(each, thing, thresholds) for each in places))
        limit = np.maximum(thresholds.co_motion_stray_m, thresholds.co_motion_share * way[some])
        with np.errstate(invalid="ignore"):
            out[some] = travels[some] & (stray <= limit)
    return out


def in_either_frame(one: Stream, other: Stream, some: slice) -> tuple[Points, Points]:
    """The origin of each of two bodies in the other's frame [m], at some frames."""
    return relative(one, other, some), relative(other, one, some)


def relative(frame_of: Stream, thing: Stream, some: slice) -> Points:
    """A body's origin in another's frame [m] at some frames; NaN where either is lost."""
    turns = rotation_matrices(frame_of.orientations[some])
    offset = thing.positions[some] - frame_of.positions[some]
    return np.asarray(np.einsum("fji,fj->fi", turns, offset))


def spread(points: Points, stream: Stream, thresholds: Thresholds) -> Float[np.ndarray, "frames"]:
    """Diagonal of the box that points cover within the window around each frame [m].

    It is NaN where one of them is not known.
    """
    size = 2 * _half_window(stream, thresholds) + 1
    lost = np.isnan(points).any(axis=1)
    known = np.where(lost[:, None], 0.0, points)
    high = maximum_filter1d(known, size, axis=0, mode="nearest")
    low = minimum_filter1d(known, size, axis=0, mode="nearest")
    out = np.linalg.norm(high - low, axis=1)
    unknown = maximum_filter1d(lost.astype(np.uint8), size, mode="nearest").astype(bool)
    return np.where(unknown, np.nan, out)


def _half_window(stream: Stream, thresholds: Thresholds) -> int:
    """Frames of the window of co-motion to either side [1]."""
    return max(1, round(0.5 * thresholds.co_motion_window_s * frame_rate(stream.times)))


def _widened(holds: Bool[np.ndarray, "frames"], reach: int) -> Bool[np.ndarray, "frames"]:
    """Where something holds at a frame no further away than so many."""
    wide = maximum_filter1d(holds.view(np.uint8), 2 * reach + 1, mode="nearest")
    return np.asarray(wide.astype(bool))
