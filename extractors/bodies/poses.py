"""A body's pose at every frame as extraction uses it: gaps filled, noise taken out, fixed held."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.calibration import BodyCalibration, FixedPose
from capar.model.capture import Sensor, Stream, TagObject, TagType
from capar.model.geometry import Holds, Places, Quaternion, Turns, Vector
from extractors.signals.filters import (
    Noise,
    fill_gaps,
    lowpass,
    lowpass_orientations,
    noise_at_rest,
)
from extractors.thresholds import Thresholds


class LowPassed(Stream):
    """A stream without what is faster than the cutoff.

    It is filtered when its poses are asked for, and again after they were forgotten.
    """

    _source: Stream
    _thresholds: Thresholds

    def __init__(self, source: Stream, thresholds: Thresholds) -> None:
        """Filter a stream when that is asked for."""
        object.__setattr__(self, "times", source.times)
        object.__setattr__(self, "_source", source)
        object.__setattr__(self, "_thresholds", thresholds)

    @cached_property
    def positions(self) -> Places:
        """Origin of the body in the world [m]; NaN where it was lost."""
        return _read_only(lowpass(self._source.positions, self.times, self._thresholds))

    @cached_property
    def orientations(self) -> Turns:
        """Unit quaternions w x y z, body to world, of continuous sign; NaN where it was lost."""
        turns = lowpass_orientations(self._source.orientations, self.times, self._thresholds)
        return _read_only(geometry.continuous(geometry.unit(turns)))

    def forget(self) -> None:
        """Keep no poses until they are asked for again."""
        for filtered in ("positions", "orientations"):
            vars(self).pop(filtered, None)


def _read_only(values: Float[np.ndarray, "frames axes"]) -> Float[np.ndarray, "frames axes"]:
    values.flags.writeable = False
    return values


@dataclass(frozen=True, eq=False)
class Poses:
    """One body through the capture."""

    name: str
    filled: Stream
    """As recorded, short gaps filled."""

    smooth: Stream
    """Low-passed."""

    settled: Stream
    """For contact and sight: smooth if the stream is noisy, else filled; fixed bodies stand."""

    noise: Noise
    still: bool
    """Whether the recorded pose is one and the same in every frame."""

    fixed: FixedPose | None = None
    """Of a fixed object, the pose at which it is taken to stand."""

    longer: "Stream | None" = None
    """Of a window of a recording, the low-passed poses from longer ago up to the window's end:
    where the body rests is told by the whole of its rest."""

    @property
    def rests(self) -> bool:
        """Whether ``settled`` is one pose throughout."""
        return self.still or self.fixed is not None

    def forget(self) -> None:
        """Keep no low-passed poses until they are asked for again."""
        if isinstance(self.smooth, LowPassed):
            self.smooth.forget()

    @property
    def lost(self) -> Holds:
        """Where the pose is not known, even so."""
        return self.settled.lost


def poses_of(
    body: Sensor | TagObject, thresholds: Thresholds, known: BodyCalibration | None = None
) -> Poses:
    """The poses of a sensor or an object.

    A fixed object stands at the median of its places throughout: what its tracker shows besides
    is noise, which at the rim of a large table would exceed any tolerance.
    """
    filled = fill_gaps(body.stream, gap_s=thresholds.gap_s)
    places, turns = filled.positions, filled.orientations
    still = (
        bool((places == places[0]).all() and (turns == turns[0]).all())
        if known is None
        else known.still
    )
    smooth = filled if still or filled.lost.all() else LowPassed(filled, thresholds)
    if known is None:
        fixed = _fixed_pose(body, filled)
        low = smooth.positions if isinstance(smooth, LowPassed) and fixed is None else None
        noise = noise_at_rest(filled, thresholds, low)
    else:
        noise, fixed = Noise(known.noise_m, known.noise_rad), known.fixed
    if fixed is not None:
        settled = _held(filled, fixed)
    else:
        settled = smooth if noise.position_m > thresholds.smoothing_noise_m else filled
    return Poses(body.name, filled, smooth, settled, noise, still, fixed)


def poses_in(poses: Poses, base: Poses, thresholds: Thresholds) -> Poses:
    """Poses in the axes of another body, which stands where it was first known.

    Lost where either is. The noise of the other's place and turning adds to its own.
    """
    filled = _stream_in(poses.filled, base.filled)
    apart = geometry.lengths(poses.filled.positions - base.filled.positions)
    lever_m = 0.0 if np.isnan(apart).all() else float(np.nanmean(apart))
    one, two = poses.noise, base.noise
    swing_m = lever_m * two.orientation_rad
    noise = Noise(
        float(np.linalg.norm([one.position_m, two.position_m, swing_m])),
        float(np.hypot(one.orientation_rad, two.orientation_rad)),
    )
    smooth = filled if filled.lost.all() else LowPassed(filled, thresholds)
    longer = None
    if poses.longer is not None and base.longer is not None:
        longer = _stream_in(poses.longer, base.longer)
    return Poses(poses.name, filled, smooth, smooth, noise, still=False, longer=longer)


def _stream_in(stream: Stream, base: Stream) -> Stream:
    """A stream in the axes of another one, which stands where it was first known."""
    if base.lost.all():
        return base
    first = int(np.argmin(base.lost))
    there, turn = base.positions[first], base.orientations[first : first + 1]
    change = geometry.products(turn, base.orientations * [1.0, -1.0, -1.0, -1.0])
    offset = stream.positions - base.positions
    places = there + np.einsum("fij,fj->fi", rotation_matrices(change), offset)
    turns = geometry.products(change, stream.orientations)
    return Stream(stream.times, places, turns)


def standing(poses: Poses) -> Poses:
    """Poses of a body that stays where it was first known."""
    filled = poses.filled
    first = 0 if filled.lost.all() else int(np.argmin(filled.lost))
    x, y, z = map(float, filled.positions[first])
    w, i, j, k = map(float, filled.orientations[first])
    if filled.lost.all():
        return poses
    held = _held(filled, FixedPose((x, y, z), (w, i, j, k)))
    return Poses(poses.name, held, held, held, Noise(0.0, 0.0), still=True)


def median_pose(stream: Stream, frames: slice) -> tuple[Vector, Quaternion]:
    """The middle of the known poses of some frames in a row: median place [m], mean orientation.

    The median is taken about each axis of the world's own frame, its middle half averaged; it
    hardly depends on how the axes lie.
    """
    known = ~stream.lost[frames]
    places, turns = stream.positions[frames][known], stream.orientations[frames][known]
    near = geometry.lengths(places - _median(places))
    core = near <= _median(near)
    return places[core].mean(axis=0), geometry.mean_orientation(turns[core])


def _median(values: Float[np.ndarray, "known *axes"]) -> Float[np.ndarray, "*axes"]:
    """The median along the first axis; ``numpy.median`` looks for NaN, in four times the time."""
    half = len(values) // 2
    if len(values) % 2:
        return np.asarray(np.partition(values, half, axis=0)[half])
    parted = np.partition(values, (half - 1, half), axis=0)
    return np.asarray((parted[half - 1] + parted[half]) / 2.0)


def _fixed_pose(body: Sensor | TagObject, stream: Stream) -> FixedPose | None:
    """The median pose of a fixed object; None for what is not fixed, or lost throughout."""
    if not isinstance(body, TagObject) or body.tag is not TagType.FIXED or stream.lost.all():
        return None
    position, orientation = median_pose(stream, slice(None))
    x, y, z = map(float, position)
    w, i, j, k = map(float, orientation)
    return FixedPose((x, y, z), (w, i, j, k))


def _held(stream: Stream, pose: FixedPose) -> Stream:
    """That pose in every frame of a stream: one row, repeated without memory of its own."""
    frames = len(stream.times)
    positions, orientations = np.array([pose.position_m]), np.array([pose.orientation])
    two = Stream(stream.times[:2], positions.repeat(2, axis=0), orientations.repeat(2, axis=0))
    return Stream.of_checked(
        stream.times,
        np.broadcast_to(two.positions[0], (frames, 3)),
        np.broadcast_to(two.orientations[0], (frames, 4)),
    )


def rotation_matrices(orientations: Turns) -> Float[np.ndarray, "frames 3 3"]:
    """Rotation matrices of unit quaternions; those of lost frames are NaN."""
    if len(orientations) == 1:
        return np.array([_rows(*orientations[0].tolist())])
    rows = _rows(*orientations.T)
    out = np.empty((len(orientations), 3, 3))
    for i, row in enumerate(rows):
        for j, entry in enumerate(row):
            out[:, i, j] = entry
    return out


def _rows(w: Any, x: Any, y: Any, z: Any) -> list[list[Any]]:
    """The entries of rotation matrices, row by row, of numbers or of columns of them."""
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
