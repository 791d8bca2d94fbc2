"""Bodies of a trial: their poses through time, their surfaces, and what they are to it."""

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from hashlib import sha256
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int

from capar.model import geometry
from capar.model.errors import CaptureError

if TYPE_CHECKING:
    from scipy.spatial.transform import RigidTransform


class TagType(StrEnum):
    """Whether a tag object is of the agent, fast in the world, or can be moved (thesis 3.2.3)."""

    SELF = "self"
    FIXED = "fixed"
    MOBILE = "mobile"


class Role(StrEnum):
    """What a tracking sensor's motion shows (spec 2)."""

    ACTS = "acts"
    ATTENDS = "attends"


class ShapeSource(StrEnum):
    """Where a shape comes from: the true surface, a stand-in of stated size, or an assumption."""

    MESH = "mesh"
    STAND_IN = "stand-in"
    ASSUMED = "assumed"


@dataclass(frozen=True, eq=False)
class Stream:
    """One rigid body's pose over time; a frame is lost where its pose is NaN."""

    times: Float[np.ndarray, "frames"]
    """Seconds since the first frame, strictly increasing."""

    positions: Float[np.ndarray, "frames 3"]
    """Origin of the body in the world [m]; NaN where it was lost."""

    orientations: Float[np.ndarray, "frames 4"]
    """Unit quaternions w x y z that take the body's axes to the world's, of continuous sign."""

    def __post_init__(self) -> None:
        """Check the stream, and make signs continuous and arrays read-only."""
        frames = len(self.times)
        if self.positions.shape != (frames, 3) or self.orientations.shape != (frames, 4):
            raise CaptureError(
                f"{frames} times, but positions {self.positions.shape} and orientations "
                f"{self.orientations.shape}; they are (frames, 3) and (frames, 4)"
            )
        _check_times(self.times)
        if np.isinf(self.positions).any():
            raise CaptureError("an infinite position; lost frames are NaN")
        lost = np.isnan(self.positions).any(axis=1) | np.isnan(self.orientations).any(axis=1)
        positions = np.where(lost[:, None], np.nan, self.positions)
        orientations = np.where(lost[:, None], np.nan, self.orientations)
        object.__setattr__(self, "times", _frozen(self.times))
        object.__setattr__(self, "positions", _owned(positions))
        turned = geometry.continuous(geometry.unit(orientations))
        object.__setattr__(self, "orientations", _owned(turned))

    @classmethod
    def of_checked(
        cls,
        times: Float[np.ndarray, "frames"],
        positions: Float[np.ndarray, "frames 3"],
        orientations: Float[np.ndarray, "frames 4"],
    ) -> "Stream":
        """A stream of arrays that were a stream's before: neither checked nor copied.

        They may lie on disk, so that a long recording needs no memory until it is read.

        Args:
            times: Seconds since the first frame, strictly increasing.
            positions: Origin of the body in the world [m]; NaN where it was lost.
            orientations: Unit quaternions w x y z, body to world.
        """
        stream = cls.__new__(cls)
        object.__setattr__(stream, "times", times)
        object.__setattr__(stream, "positions", positions)
        object.__setattr__(stream, "orientations", orientations)
        return stream

    @cached_property
    def lost(self) -> Bool[np.ndarray, "frames"]:
        """Where the pose is not known."""
        return np.isnan(self.positions[:, 0])

    def pose(self, frame: int) -> "RigidTransform":
        """``T_world_body`` at a frame."""
        return geometry.transforms(self.positions[frame], self.orientations[frame])


@dataclass(frozen=True, eq=False)
class Shape:
    """A body's surface as triangles, in the body's own frame."""

    vertices: Float[np.ndarray, "vertices 3"]
    """Corners [m]."""

    faces: Int[np.ndarray, "faces 3"]
    """Indices of corners, counter-clockwise seen from outside."""

    source: ShapeSource = ShapeSource.MESH
    description: str = ""
    """What it is, for people: a file's name, or a form with its sizes in metres."""

    def __post_init__(self) -> None:
        """Check the triangles and make the arrays read-only."""
        if not np.isfinite(self.vertices).all() or len(self.vertices) == 0:
            raise CaptureError(f"shape {self.description!r} has no corners or infinite ones")
        if len(self.faces) == 0 or self.faces.min() < 0 or self.faces.max() >= len(self.vertices):
            raise CaptureError(f"shape {self.description!r} has no faces, or faces without corners")
        object.__setattr__(self, "vertices", _frozen(self.vertices))
        object.__setattr__(self, "faces", _frozen(np.asarray(self.faces, dtype=np.int32)))

    @cached_property
    def bounds(self) -> Float[np.ndarray, "2 3"]:
        """Lowest and highest corner of the box along the body's axes [m]."""
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    @cached_property
    def digest(self) -> bytes:
        """The same for equal triangles, and otherwise another."""
        return sha256(self.vertices.tobytes() + b"/" + self.faces.tobytes()).digest()

    @property
    def size(self) -> Float[np.ndarray, "3"]:
        """Lengths of that box [m]: what NLTs are normalised by (thesis 4.4.2.2)."""
        return np.asarray(self.bounds[1] - self.bounds[0])


@dataclass(frozen=True, eq=False)
class Sensor:
    """A tracking sensor: the body segment it rides on, and the link that the segment ends."""

    name: str
    end_effector: str
    """General type, without side: ``hand``, ``foot``, ``head`` (thesis 4.4.1)."""

    side: str
    """``right``, ``left``, or ``none`` for what has no side."""

    link: str
    """The kinematic chain that the segment ends: ``right_arm``."""

    stream: Stream
    shape: Shape | None = None
    role: Role = Role.ACTS
    gaze: tuple[float, float, float] = (1.0, 0.0, 0.0)
    """Direction of sight in the sensor's frame, for a sensor that attends or a head."""

    eye: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where sight starts, in the sensor's frame [m]."""

    agent: str = ""
    """Name of the agent whose body it rides on; empty for the capture's first, or only, one."""

    part_of: str = ""
    """Name of the sensor whose end-effector this one rides on too, as a finger's does on a hand's:
    it makes no segments of its own, and what it touches that end-effector touches."""


@dataclass(frozen=True, eq=False)
class TagObject:
    """An object or body part watched for contact (thesis 3.2.3)."""

    name: str
    tag: TagType
    stream: Stream
    shape: Shape | None = None
    kind: str = ""
    """Its noun (``mug``), under which the Actionary keeps what is known of such objects."""

    assumed: str = ""
    """How its pose and size were derived, where the recording lacks it; else empty."""

    deformable: bool = False
    motion_floor_m: float | None = None
    """Displacement below which it counts as still [m], where it differs from the capture's."""

    mass_kg: float | None = None
    agent: str = ""
    """Of a SELF object, the agent whose body part it is; empty as for a sensor."""


@dataclass(frozen=True)
class PivotContact:
    """Contact of two bodies without shapes: their origins are nearer than a distance."""

    first: str
    second: str
    distance_m: float


def _check_times(times: Float[np.ndarray, "frames"]) -> None:
    if len(times) < 2:
        raise CaptureError(f"{len(times)} frames; motion needs at least two")
    if not np.isfinite(times).all():
        raise CaptureError(f"time stamp {np.flatnonzero(~np.isfinite(times))[0]} is no number")
    steps = np.diff(times)
    if (steps <= 0).any():
        frame = int(np.flatnonzero(steps <= 0)[0]) + 1
        raise CaptureError(
            f"time goes from {times[frame - 1]:.6g} s to {times[frame]:.6g} s at frame {frame}; "
            "time stamps must increase"
        )


def _frozen(array: np.ndarray) -> np.ndarray:
    """The array read-only: itself if nobody can write to it, else a copy."""
    if array.base is None and not array.flags.writeable:
        return array
    out = np.array(array)
    out.flags.writeable = False
    return out


def _owned(array: np.ndarray) -> np.ndarray:
    """An array that was made here, read-only without a copy."""
    array.flags.writeable = False
    return array
