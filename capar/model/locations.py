"""Places on objects: normalised local transforms, constraint locations, guides, sampled tracks."""

from base64 import b64decode, b64encode
from binascii import Error as Base64Error
from dataclasses import dataclass
from math import isfinite

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.errors import ParError
from capar.model.par import Nlt as Nlt

NO_EXTENT_M = 1e-6  # a size below this is none [m]


def normalised(
    point: Float[np.ndarray, "3"],
    orientation: Float[np.ndarray, "4"],
    size_m: Float[np.ndarray, "3"],
) -> Nlt:
    """The NLT of a place [m] and an orientation in the frame of an object of a size [m]."""
    x, y, z = map(float, point / _divisors(size_m))
    w, i, j, k = map(float, orientation * (-1.0 if orientation[0] < 0.0 else 1.0))
    return Nlt((x, y, z), (w, i, j, k))


def restored(
    nlt: Nlt, size_m: Float[np.ndarray, "3"]
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "4"]]:
    """The place [m] and orientation that an NLT means in the frame of an object of a size [m]."""
    return np.asarray(nlt.position) * _divisors(size_m), np.asarray(nlt.orientation)


def relative_orientation(
    base: Float[np.ndarray, "4"], other: Float[np.ndarray, "4"]
) -> Float[np.ndarray, "4"]:
    """An orientation in the frame of another one, both given in the world (w x y z)."""
    return geometry.quaternions(geometry.rotations(base).inv() * geometry.rotations(other))


def local_point(
    position: Float[np.ndarray, "3"],
    orientation: Float[np.ndarray, "4"],
    point: Float[np.ndarray, "3"],
) -> Float[np.ndarray, "3"]:
    """A point of the world [m] in the frame of a body at a position [m] and orientation."""
    return np.asarray(geometry.rotations(orientation).inv().apply(point - position))


def _divisors(size_m: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    return np.where(np.asarray(size_m) > NO_EXTENT_M, size_m, 1.0)


@dataclass(frozen=True, slots=True)
class ConstraintLocation:
    """Where a constraint was made, stored with the kind of object (thesis Fig 4.8)."""

    action: str
    purpose: str
    ee: str  #: The end-effector that made it
    side: str
    frame: int
    dominant: str  #: The object of ``ee_nlt``; empty if the end-effector alone made the contact
    goal: str  #: The object of ``goal_nlt``
    ee_nlt: Nlt | None
    goal_nlt: Nlt | None
    seen: str = ""  #: The object of ``v_nlt``; empty if nothing was looked at
    v_nlt: Nlt | None = None


@dataclass(frozen=True, slots=True)
class GuideLocation:
    """Where on an object its hinge or rail is: a constraint location that always holds (spec 10).

    The constraint's x axis is the line of the hinge or the rail, in the sense in which the object
    opens, along the rail or right-handed about the hinge.
    """

    object: str  #: The door, lid or drawer
    base: str  #: The object that bears the hinge or the rail, fixed or not
    kind: str  #: ``hinge`` or ``rail``
    object_nlt: Nlt
    base_nlt: Nlt
    #: How far from its closed place it was seen at most: [rad] on a hinge, [m] on a rail
    opened: float
    #: Root mean square of how far its poses are off the fitted line, turning included [m]
    residual_m: float


UNIT_M = 1e-4  # places are kept to this [m]
LOST = np.iinfo(np.int32).min  # what a coordinate is while the body was lost


@dataclass(frozen=True, slots=True)
class SampledTrack:
    """The places of a body's origin in the world, from the first frame on."""

    body: str
    step_s: float  #: Time between two samples [s]; zero where one sample holds throughout
    #: Base64 of x, y, z of each sample as little-endian 32-bit integers in units of ``UNIT_M``
    samples: str

    def __post_init__(self) -> None:
        """Check that the samples are Base64 of places and the step is a time; else ParError."""
        try:
            size = len(b64decode(self.samples, validate=True))
        except Base64Error:
            size = 1
        if size == 0 or size % 12:
            raise ParError(f"the samples of {self.body!r} are no Base64 of x, y, z in 32 bits each")
        if not isfinite(self.step_s) or self.step_s < 0.0 or (self.step_s == 0.0 and size > 12):
            raise ParError(
                f"the samples of {self.body!r} are {self.step_s} s apart, which is no step"
            )

    @property
    def positions(self) -> Float[np.ndarray, "samples 3"]:
        """World positions [m]; NaN where the body was lost."""
        counts = np.frombuffer(b64decode(self.samples), dtype="<i4").reshape(-1, 3)
        return np.where(counts == LOST, np.nan, counts * UNIT_M)

    def lost_around(self, time_s: float) -> tuple[float, float] | None:
        """From when to when the body was lost about a time [s]; none where it was seen.

        The ends are the samples beside, in which it was seen, or those of the track.
        """
        lost = np.isnan(self.positions).any(axis=1)
        at = time_s / self.step_s if self.step_s else 0.0
        before, after = (min(int(whole(at)), len(lost) - 1) for whole in (np.floor, np.ceil))
        if not (lost[before] or lost[after]):
            return None
        seen = np.flatnonzero(~lost)
        first = int(seen[seen < after].max(initial=0))
        last = int(seen[seen > before].min(initial=len(lost) - 1))
        return first * self.step_s, last * self.step_s


def sampled_track(
    body: str, step_s: float, positions: Float[np.ndarray, "samples 3"]
) -> SampledTrack:
    """The track of a body, by its places [m] at equal steps of time; NaN where it was lost."""
    lost = np.isnan(positions)
    counts = np.where(lost, LOST, np.rint(np.where(lost, 0.0, positions) / UNIT_M))
    return SampledTrack(body, step_s, b64encode(counts.astype("<i4").tobytes()).decode())
