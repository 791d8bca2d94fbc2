"""What one motion file holds, before anyone says what in it is what."""

import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import UTC, date, datetime, timedelta
from types import MappingProxyType
from typing import Any

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import UNITS as UNITS
from capar.model.capture import Notice, Shape, Source, Stream
from capar.model.errors import CaptureError


@dataclass(frozen=True, eq=False)
class Recording:
    """Bodies and markers of one file, in the file's own unit and axes, each on its own clock."""

    source: Source
    bodies: Mapping[str, Stream] = field(default_factory=dict)
    """Poses by the file's own names; positions in the file's unit."""

    orders: Mapping[str, str] = field(default_factory=dict)
    """The order in which quaternions of a body were read, ``xyzw`` or ``wxyz``, where the file does
    not state it."""

    markers: Mapping[str, Float[np.ndarray, "frames 3"]] = field(default_factory=dict)
    """Points by the file's own names, in the file's unit; NaN where they were not seen."""

    marker_times: Float[np.ndarray, "frames"] = field(default_factory=lambda: np.empty(0))
    """The clock of all markers [s]."""

    unit_m: float | None = None
    """Metres per unit, if the file states it."""

    up: str | None = None
    """The axis that points up (``y``, ``-z``), if the file states it."""

    parents: Mapping[str, str] = field(default_factory=dict)
    """Each joint's parent, where the file holds a skeleton."""

    shapes: Mapping[str, Shape] = field(default_factory=dict)
    """Surfaces of bodies in their own frames [m], where the file holds them."""

    notices: tuple[Notice, ...] = ()

    def __post_init__(self) -> None:
        """Check the markers against their clock and make the mappings read-only."""
        frames = len(self.marker_times)
        for name, points in self.markers.items():
            if points.shape != (frames, 3):
                raise CaptureError(f"marker {name!r} has {points.shape}, its clock {frames} frames")
            if np.isinf(points).any():
                raise CaptureError(f"marker {name!r} is at infinity; missing points are NaN")
        if self.markers:
            still = np.zeros((frames, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (frames, 1))
            Stream(self.marker_times, *still)  # checks the clock
        if not self.markers and not self.bodies:
            raise CaptureError("neither a body nor a marker in it")
        object.__setattr__(self, "bodies", MappingProxyType(dict(self.bodies)))
        object.__setattr__(self, "orders", MappingProxyType(dict(self.orders)))
        object.__setattr__(self, "markers", MappingProxyType(dict(self.markers)))
        object.__setattr__(self, "parents", MappingProxyType(dict(self.parents)))

    @property
    def format(self) -> str:
        """The name of the file's format."""
        return self.source.format

    @property
    def times(self) -> Float[np.ndarray, "frames"]:
        """The clock of the file's frames [s]: the markers', else that of the first body."""
        if self.markers:
            return self.marker_times
        return next(iter(self.bodies.values())).times

    @property
    def names(self) -> list[str]:
        """Every body and marker, sorted."""
        return sorted({*self.bodies, *self.markers})


def track(
    name: str,
    times: Float[np.ndarray, "frames"],
    positions: Float[np.ndarray, "frames 3"],
    orientations: Float[np.ndarray, "frames 4"],
) -> Stream:
    """A body's poses, validated; errors name the body.

    Raises:
        CaptureError: Time goes back, a quaternion is not unit, or shapes disagree.
    """
    try:
        return Stream(times=times, positions=positions, orientations=orientations)
    except CaptureError as error:
        raise CaptureError(f"body {name!r}: {error}") from error


def track_of_matrices(
    name: str,
    times: Float[np.ndarray, "frames"],
    positions: Float[np.ndarray, "frames 3"],
    matrices: Float[np.ndarray, "frames 3 3"],
    lost: Bool[np.ndarray, "frames"],
) -> Stream:
    """A body's poses, validated; it is also lost where its matrix is zero.

    Raises:
        CaptureError: A matrix is a reflection, or no rotation at all.
    """
    seen = ~lost & ~(matrices == 0.0).all(axis=(1, 2))
    found = matrices[seen]
    skew = np.abs(found @ found.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2), initial=0.0)
    bad = np.flatnonzero(~(skew < 0.02))
    if bad.size:
        raise CaptureError(f"body {name!r}: no rotation matrix at frame {bad[0]}")
    determinants = np.linalg.det(found)
    mirrored = np.flatnonzero(determinants < 0.0)
    if mirrored.size:
        raise CaptureError(
            f"body {name!r}: the matrix at frame {mirrored[0]} is a reflection (determinant "
            f"{determinants[mirrored[0]]:.3f}), in {mirrored.size} of {len(found)} frames; "
            "axes of the body and of the world are of different handedness"
        )
    orientations = np.full((len(times), 4), np.nan)
    if seen.any():
        orientations[seen] = geometry.quaternions(Rotation.from_matrix(found))
    return track(name, times, np.where(seen[:, None], positions, np.nan), orientations)


ROTATIONS = {"helical": "", "euler_xyz": "XYZ", "rpy": "xyz"}
"""What three numbers of an orientation are: a vector along the axis, as long as the angle; angles
about axes that turn with the body; roll, pitch and yaw about fixed axes. With scipy's sequences."""


def quaternions_of(
    turns: Float[np.ndarray, "frames 3"], kind: str, *, degrees: bool = False
) -> Float[np.ndarray, "frames 4"]:
    """Orientations of three numbers, of one of ``ROTATIONS``, as quaternions w x y z."""
    if kind == "helical":
        return geometry.quaternions(Rotation.from_rotvec(turns, degrees=degrees))
    return geometry.quaternions(Rotation.from_euler(ROTATIONS[kind], turns, degrees=degrees))


def uniform_clock(frames: int, rate_hz: float) -> Float[np.ndarray, "frames"]:
    """Time stamps of frames at a steady rate, from zero [s].

    Raises:
        CaptureError: The rate is not positive.
    """
    if not (np.isfinite(rate_hz) and rate_hz > 0.0):
        raise CaptureError(f"a rate of {rate_hz:g} frames a second; it must be positive")
    return np.arange(frames) / rate_hz


ROUNDED_S = 0.0006
"""Time stamps that differ less from a steady clock are that clock, rounded to milliseconds [s]."""


def unrounded(
    times: Float[np.ndarray, "frames"], stated_hz: float | None
) -> Float[np.ndarray, "frames"]:
    """Time stamps without the rounding to milliseconds of a steady clock.

    The clock has the stated rate or, where that does not fit, the one that fits best. Time stamps
    that no steady clock explains stay as they are.
    """
    if len(times) < 3 or not np.isfinite(times).all() or not times[-1] > times[0]:
        return times
    fitted_hz = 1.0 / float(np.polyfit(np.arange(len(times)), times, 1)[0])
    for rate_hz in (stated_hz, fitted_hz):
        if rate_hz and rate_hz > 0.0:
            steady = np.arange(len(times)) / rate_hz
            steady += float(np.mean(times - steady))
            if np.abs(steady - times).max() <= ROUNDED_S:
                return steady - steady[0] + times[0]
    return times


SAME_RATE = 0.05
"""A stated rate that differs from that of the time stamps by a larger share contradicts them."""


def contradicted_rate(times: Float[np.ndarray, "frames"], stated_hz: float) -> float | None:
    """The rate of the time stamps [Hz], if the stated one contradicts it."""
    steps = np.diff(times)
    if not len(steps) or not float(np.median(steps)) > 0.0:
        return None
    rate_hz = 1.0 / float(np.median(steps))
    return rate_hz if abs(stated_hz / rate_hz - 1.0) > SAME_RATE else None


def check_rate(times: Float[np.ndarray, "frames"], options: Mapping[str, Any]) -> None:
    """Check that a ``rate_hz`` in a file's options is the rate of its time stamps.

    Raises:
        CaptureError: It is not; the message has both rates.
    """
    stated_hz = options.get("rate_hz")
    if stated_hz is None:
        return
    rate_hz = contradicted_rate(times, float(stated_hz))
    if rate_hz is not None:
        raise CaptureError(
            f"rate_hz = {stated_hz:g}, but the time stamps have {rate_hz:.4g} frames a second; "
            "leave rate_hz out, or correct the time stamps"
        )


EARLIEST = datetime(1990, 1, 1, tzinfo=UTC)
"""Stamps since 1970 that are earlier count from when a computer or a simulation started."""


def iso_time(text: str) -> str:
    """A date, or a date and time, as ISO 8601; empty if the text is neither.

    What the text leaves open, such as the time of day or the time zone, stays open.
    """
    stripped = text.strip()
    with suppress(ValueError):
        if re.fullmatch(r"\d{4}-\d\d-\d\d", stripped):
            return date.fromisoformat(stripped).isoformat()
        return _iso(datetime.fromisoformat(stripped.replace(", ", " ")))  # Qualisys has a comma
    return ""


def iso_of_stamp(nanoseconds: int) -> str:
    """Nanoseconds since 1970 as ISO 8601 in UTC, to the microsecond; empty before ``EARLIEST``."""
    try:
        time = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(microseconds=nanoseconds // 1000)
    except OverflowError:
        return ""
    return _iso(time) if time >= EARLIEST else ""


def _iso(time: datetime) -> str:
    """The time with as many decimals as it needs; of UTC with ``Z``."""
    decimals = "milliseconds" if time.microsecond else "seconds"
    whole = time.isoformat(timespec="microseconds" if time.microsecond % 1000 else decimals)
    return whole.replace("+00:00", "Z")
