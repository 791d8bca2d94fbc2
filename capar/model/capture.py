"""Captures as every stage sees them: bodies, surfaces and poses, in metres, seconds and w x y z."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from hashlib import sha256
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int

from capar.model import geometry
from capar.model.errors import CaptureError, UnknownNameError, named
from capar.model.notices import Notice as Notice
from capar.model.notices import notice as notice

if TYPE_CHECKING:
    from scipy.spatial.transform import RigidTransform, Rotation


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

    times: Float[np.ndarray, "frames"]  #: Seconds since the first frame, strictly increasing
    #: Origin of the body in the world [m]; NaN where it was lost
    positions: Float[np.ndarray, "frames 3"]
    #: Unit quaternions w x y z that take the body's axes to the world's, of continuous sign
    orientations: Float[np.ndarray, "frames 4"]

    def __post_init__(self) -> None:
        """Check the stream, and make signs continuous and arrays read-only."""
        frames = len(self.times)
        if self.positions.shape != (frames, 3) or self.orientations.shape != (frames, 4):
            raise CaptureError(
                f"{frames} times, but positions {self.positions.shape} and orientations "
                f"{self.orientations.shape}; they are (frames, 3) and (frames, 4)"
            )
        if frames < 2:
            raise CaptureError(f"{frames} frames; motion needs at least two")
        if not np.isfinite(self.times).all():
            stamp = np.flatnonzero(~np.isfinite(self.times))[0]
            raise CaptureError(f"time stamp {stamp} is no number")
        if (np.diff(self.times) <= 0).any():
            frame = int(np.flatnonzero(np.diff(self.times) <= 0)[0]) + 1
            raise CaptureError(
                f"time goes from {self.times[frame - 1]:.6g} s to {self.times[frame]:.6g} s at "
                f"frame {frame}; time stamps must increase"
            )
        if np.isinf(self.positions).any():
            raise CaptureError("an infinite position; lost frames are NaN")
        lost = ~(geometry.is_known(self.positions) & geometry.is_known(self.orientations))
        positions = np.where(lost[:, None], np.nan, self.positions)
        turned = np.where(lost[:, None], np.nan, self.orientations)
        turned = geometry.continuous(geometry.unit(turned))
        positions.flags.writeable = turned.flags.writeable = False
        object.__setattr__(self, "times", _frozen(self.times))
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "orientations", turned)

    @classmethod
    def of_checked(
        cls,
        times: Float[np.ndarray, "frames"],
        positions: Float[np.ndarray, "frames 3"],
        orientations: Float[np.ndarray, "frames 4"],
    ) -> "Stream":
        """A stream of arrays that were a stream's before: neither checked nor copied.

        They may lie on disk, so that a long recording needs no memory until it is read.
        """
        stream = cls.__new__(cls)
        own = {"times": times, "positions": positions, "orientations": orientations}
        for name, array in own.items():
            object.__setattr__(stream, name, array)
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

    vertices: Float[np.ndarray, "vertices 3"]  #: Corners [m]
    faces: Int[np.ndarray, "faces 3"]  #: Indices of corners, counter-clockwise seen from outside
    source: ShapeSource = ShapeSource.MESH
    #: What it is, for people: a file's name, or a form with its sizes in metres
    description: str = ""

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
    end_effector: str  #: General type, without side: ``hand``, ``foot``, ``head`` (thesis 4.4.1)
    side: str  #: ``right``, ``left``, or ``none`` for what has no side
    link: str  #: The kinematic chain that the segment ends: ``right_arm``
    stream: Stream
    shape: Shape | None = None
    role: Role = Role.ACTS
    #: Direction of sight in the sensor's frame, for a sensor that attends or a head
    gaze: tuple[float, float, float] = (1.0, 0.0, 0.0)
    #: Where sight starts, in the sensor's frame [m]
    eye: tuple[float, float, float] = (0.0, 0.0, 0.0)
    #: Name of the agent whose body it rides on; empty for the capture's first, or only, one
    agent: str = ""
    #: Name of the sensor whose end-effector this one rides on too, as a finger's does on a hand's:
    #: it makes no segments of its own, and what it touches that end-effector touches
    part_of: str = ""


@dataclass(frozen=True, eq=False)
class TagObject:
    """An object or body part watched for contact (thesis 3.2.3)."""

    name: str
    tag: TagType
    stream: Stream
    shape: Shape | None = None
    #: Its noun (``mug``), under which the Actionary keeps what is known of such objects
    kind: str = ""
    #: How its pose and size were derived, where the recording lacks it; else empty
    assumed: str = ""
    deformable: bool = False
    #: Displacement below which it counts as still [m], where it differs from the capture's
    motion_floor_m: float | None = None
    mass_kg: float | None = None
    part_of: str = ""  #: The object whose part it is, on a hinge or a rail; empty if not stated
    #: Its turn on its hinge [degrees] or shift on its rail [m] where it is closed. Counted from
    #: where its axes are parallel to its base's, and its origin level with its base's, about or
    #: along the axis whose largest part in the base's frame is positive.
    closed_deg: float | None = None
    closed_m: float | None = None
    agent: str = ""  #: Of a SELF object, the agent whose body part it is; empty as for a sensor


@dataclass(frozen=True)
class PivotContact:
    """Contact of two bodies without shapes: their origins are nearer than a distance."""

    first: str
    second: str
    distance_m: float


def _frozen(array: np.ndarray) -> np.ndarray:
    """The array read-only: itself if nobody can write to it, else a copy."""
    if array.base is None and not array.flags.writeable:
        return array
    out = np.array(array)
    out.flags.writeable = False
    return out


#: Metres per unit, by the names that headers and capture.toml use
UNITS: Mapping[str, float] = {
    "m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048,
}  # fmt: skip
#: The rotation that brings each axis to z: about which axis, and by how much [degrees]
UP: Mapping[str, tuple[str, float]] = {
    "z": ("x", 0.0), "y": ("x", 90.0), "x": ("y", -90.0),
    "-z": ("x", 180.0), "-y": ("x", -90.0), "-x": ("y", 90.0),
}  # fmt: skip
#: A direction is an axis's if the cosine of the angle between them is at least this [1]
AXIS_COSINE = 0.9


def upward(axis: str) -> "Rotation":
    """The rotation that brings an axis of ``UP`` to z."""
    from scipy.spatial.transform import Rotation

    about, angle_deg = UP[axis]
    return Rotation.from_euler(about, angle_deg, degrees=True)


@dataclass(frozen=True, slots=True)
class Conventions:
    """What a file's numbers were taken to mean, as a capture.toml states it."""

    unit_m: float = 1.0  #: Metres per unit
    up: str = "z"  #: Upward axis of the file, or of its mirror image in x if it is left-handed
    left_handed: bool = False

    def __post_init__(self) -> None:
        """Check that the axis is one."""
        if self.up not in UP:
            raise UnknownNameError("upward axis", self.up, UP)

    def axis(self, direction: Float[np.ndarray, "3"]) -> str | None:
        """The axis of the file along a direction of the world; None where none is near it."""
        for name in UP:
            along = (upward(self.up) * upward(name).inv()).apply(np.array([0.0, 0.0, 1.0]))
            if float(along @ direction) >= AXIS_COSINE * float(np.linalg.norm(direction)):
                return name
        return None

    def unit(self, factor: float, share: float) -> str | None:
        """The unit by which lengths are so many times longer, to within a share [1]; else None."""
        wanted = self.unit_m * factor
        near = min(UNITS, key=lambda name: abs(np.log(UNITS[name] / wanted)))
        return near if abs(UNITS[near] / wanted - 1.0) <= share else None


#: What sensors and objects may be called: such a name is a constant of the rules, unquoted
NAME = re.compile(r"[a-z][A-Za-z0-9_]*")


@dataclass(frozen=True)
class Agent:
    """The performer, with such measures as are known."""

    name: str = "agent"
    kind: str = "person"
    #: Lengths [m] and ``mass`` [kg] by name: ``stature``, ``upper_arm``
    measures: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Make the measures read-only."""
        object.__setattr__(self, "measures", MappingProxyType(dict(self.measures)))

    def __reduce__(self) -> "tuple[type[Agent], tuple[str, str, dict[str, float]]]":
        """Pickle it by its fields: a read-only mapping cannot be pickled itself."""
        return Agent, (self.name, self.kind, dict(self.measures))


@dataclass(frozen=True)
class Purpose:
    """The end to which a step is done, as the user states it (thesis 4.4.2.2).

    An empty field fits every step that is about an object.
    """

    purpose: str
    action: str = ""
    object: str = ""
    goal: str = ""


@dataclass(frozen=True)
class Source:
    """A file that a capture was read from."""

    path: str
    format: str
    sha256: str
    #: When it says that it was recorded: ISO 8601, a date or a date and time, with or without a
    #: time zone. Empty if it does not say
    recorded_at: str = ""


def recorded_at(sources: Sequence[Source]) -> str:
    """When a capture was recorded (ISO 8601): by its capture.toml, else by the earliest file.

    Empty if none of them says.
    """
    stated = [source.recorded_at for source in sources if source.format == "capture.toml"]
    return next(filter(None, stated), "") or min(
        (source.recorded_at for source in sources if source.recorded_at), default=""
    )


@dataclass(frozen=True, eq=False)
class Capture:
    """One recorded trial: every stream on one clock, the scene, and who performed."""

    name: str
    sensors: tuple[Sensor, ...]
    objects: tuple[TagObject, ...]
    agent: Agent = field(default_factory=Agent)
    #: Distance up to which bodies count as touching [m]; None takes it from the sensors' noise
    contact_tolerance_m: float | None = None
    #: A shorter interruption of a contact is closed [s]; None takes the usual time
    contact_dropout_s: float | None = None
    #: A shorter contact is dropped [s]; None takes the usual time
    contact_minimum_s: float | None = None
    pivot_contacts: tuple[PivotContact, ...] = ()
    purposes: tuple[Purpose, ...] = ()
    #: Whether the user says that force passes to objects in this trial (thesis 4.4.1)
    force_transfer: bool = False
    sources: tuple[Source, ...] = ()
    notices: tuple[Notice, ...] = ()
    others: tuple[Agent, ...] = ()  #: Who else performed, where several agents did
    #: By which each body's file was read, by the body's name; empty of what no file held
    conventions: Mapping[str, Conventions] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check names and clocks."""
        if not self.sensors:
            raise CaptureError(f"capture {self.name!r} has no tracking sensor; name at least one")
        agents = [each.name for each in self.agents]
        for kind, group in (
            ("sensor", self.sensors), ("object", self.objects), ("agent", self.agents)
        ):  # fmt: skip
            names = [each.name for each in group]
            for name in names:
                if kind != "agent" and not NAME.fullmatch(name):
                    raise CaptureError(
                        f"{kind} {name!r}: names begin with a lower-case letter and hold letters, "
                        "digits and underscores"
                    )
                if names.count(name) > 1:
                    raise CaptureError(f"two {kind}s are called {name!r}")
        for body in self._all:
            if body.agent and body.agent not in agents:
                raise UnknownNameError("agent", body.agent, agents, where=body.name)
            if not np.array_equal(body.stream.times, self.times):
                raise CaptureError(
                    f"{body.name!r} is on another clock than {self.sensors[0].name!r}"
                )
            # Equal clocks need the memory of one.
            object.__setattr__(body.stream, "times", self.times)
        for pair in self.pivot_contacts:
            for name in (pair.first, pair.second):
                if name not in self.bodies:
                    raise UnknownNameError("body", name, self.bodies, where="pivot contact")
        self._check_parts()

    def _check_parts(self) -> None:
        wholes = {sensor.name: sensor for sensor in self.sensors if not sensor.part_of}
        for part in (sensor for sensor in self.sensors if sensor.part_of):
            if part.part_of not in wholes:
                raise UnknownNameError("sensor", part.part_of, wholes, where=part.name)
            if self.agent_of(part) != self.agent_of(wholes[part.part_of]):
                raise CaptureError(
                    f"{part.name!r} is part of {part.part_of!r}, which another agent wears; the "
                    "parts of an end-effector are of one agent"
                )

    @property
    def agents(self) -> tuple[Agent, ...]:
        """Everyone who performed, the first one first."""
        return (self.agent, *self.others)

    def agent_of(self, body: Sensor | TagObject) -> str:
        """Name of the agent that a sensor or a SELF object belongs to.

        An object that is also a sensor belongs to whom the sensor does.
        """
        riding = [each.agent for each in self.sensors if each.name == body.name]
        return next(filter(None, (body.agent, *riding)), self.agent.name)

    @property
    def _all(self) -> tuple[Sensor | TagObject, ...]:
        return (*self.sensors, *self.objects)

    @property
    def times(self) -> Float[np.ndarray, "frames"]:
        """Seconds since the first frame: the clock of every stream."""
        return self.sensors[0].stream.times

    @cached_property
    def rate_hz(self) -> float:
        """Frames a second, from the median step."""
        return 1.0 / float(np.median(np.diff(self.times)))

    @cached_property
    def bodies(self) -> Mapping[str, Sensor | TagObject]:
        """Every sensor and object by name; an object that is also a sensor is the object."""
        return {each.name: each for each in self._all}

    @property
    def acting(self) -> tuple[Sensor, ...]:
        """The sensors that make links, segments and PARs: one for each end-effector."""
        return tuple(each for each in self.sensors if each.role is Role.ACTS and not each.part_of)

    def parts_of(self, name: str) -> tuple[Sensor, ...]:
        """The sensors that ride on one end-effector: the one that acts for it, then its parts."""
        return (self.sensor(name), *(each for each in self.sensors if each.part_of == name))

    @property
    def attending(self) -> tuple[Sensor, ...]:
        """The sensors that give visual constraints."""
        return tuple(each for each in self.sensors if each.role is Role.ATTENDS)

    def sensor(self, name: str) -> Sensor:
        """The sensor of that name; UnknownNameError where there is none."""
        return named("sensor", name, self.sensors)

    def tag_object(self, name: str) -> TagObject:
        """The tag object of that name; UnknownNameError where there is none."""
        return named("object", name, self.objects)
