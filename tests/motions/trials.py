"""A trial: a capture sampled from closed forms, and what is true of it."""

import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypedDict

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model import geometry
from capar.model.capture import Capture, Purpose, Role, Sensor, Shape, Stream, TagObject, TagType
from motions.paths import Path, Vector
from motions.performers import Performer

GRID_S = 1e-4
"""Step of time in which instants of contact are sought [s]."""


@dataclass(frozen=True, eq=False)
class Meeting:
    """Two bodies that touch where a point of the one lies on the surface of the other."""

    body: str
    other: str
    path: Path
    """Of the body that comes and goes, or of the one that carries the point."""

    point: Vector
    """Of that body's frame, nearest to the other when they meet [m]."""

    normal: Vector
    """Outward from the other's surface, in the world."""

    depth_m: float = 0.0
    """How far the point lies inside the other while they touch [m]."""

    arrives_s: float | None = None
    """When the body has come to rest in contact [s]; None: it touches from the first frame on."""

    leaves_s: float | None = None
    """When it begins to leave [s]; None: it touches up to the last frame."""


@dataclass(frozen=True, slots=True, order=True)
class TrueContact:
    """Two bodies are within the tolerance from one time to another [s]."""

    body: str
    other: str
    begin_s: float
    end_s: float


@dataclass(frozen=True, eq=False)
class Truth:
    """What is so in a trial, by its construction."""

    duration_s: float
    meetings: tuple[Meeting, ...]
    steps: Mapping[str, Mapping[str, tuple[str, ...]]]
    """Names of the steps of each acting sensor, by rule profile."""

    borders_s: Mapping[str, tuple[float, ...]]
    """Where one step of a sensor gives way to the next: stops and starts of its hand [s]."""

    def contacts(self, *, tolerance_m: float = 0.005) -> tuple[TrueContact, ...]:
        """Every contact, sorted."""
        return tuple(
            sorted(
                TrueContact(
                    each.body,
                    each.other,
                    _begin(each, tolerance_m),
                    _end(each, tolerance_m, self.duration_s),
                )
                for each in self.meetings
            )
        )

    def shares(self, sensor: str) -> tuple[float, ...]:
        """Share of the whole duration of each step of the ``thesis`` profile [1]."""
        edges = (0.0, *self.borders_s[sensor], self.duration_s)
        return tuple(float(each) / self.duration_s for each in np.diff(edges))


@dataclass(frozen=True, eq=False)
class Trial:
    """A capture and its truth."""

    capture: Capture
    truth: Truth


@dataclass(frozen=True, eq=False)
class Body:
    """One body of a scene; a sensor if it ends a link, an object if it has a tag, or both."""

    name: str
    path: Path
    shape: Shape
    tag: TagType | None = None
    link: str = ""
    role: Role = Role.ACTS
    eye: Vector = (0.0, 0.0, 0.0)
    noisy: bool = True
    """Whether a tracker follows it; else its pose is known, as that of a table."""

    mass_kg: float | None = None
    kind: str = ""
    """What it is, where its name does not say so."""


class Options(TypedDict, total=False):
    """The fields of ``Sampling``, as keywords of every trial."""

    rate_hz: float
    noise_m: float
    noise_rad: float
    seed: int


@dataclass(frozen=True, slots=True)
class Sampling:
    """How a trial is recorded: the tracker's rate and noise."""

    rate_hz: float = 103.3
    noise_m: float = 0.0
    """Deviation of each coordinate [m]."""

    noise_rad: float = 0.0
    """Deviation of the rotation about each axis [rad]."""

    seed: int = 0


@dataclass(frozen=True, eq=False)
class Script:
    """A trial before it is recorded."""

    name: str
    performer: Performer
    truth: Truth
    bodies: tuple[Body, ...]
    force_transfer: bool = False
    purposes: tuple[Purpose, ...] = ()


def record(script: Script, sampling: Sampling) -> Trial:
    """The capture that a tracker of that rate and noise makes of the scene."""
    frames = int(np.floor(script.truth.duration_s * sampling.rate_hz + 1e-9)) + 1
    times = np.arange(frames) / sampling.rate_hz
    streams = {each.name: _stream(each, times, sampling) for each in script.bodies}
    capture = Capture(
        name=f"{script.name}_{script.performer.name}",
        sensors=tuple(_sensor(each, streams[each.name]) for each in script.bodies if each.link),
        objects=tuple(_tagged(each, streams[each.name]) for each in script.bodies if each.tag),
        agent=script.performer.agent,
        purposes=script.purposes,
        force_transfer=script.force_transfer,
    )
    return Trial(capture, script.truth)


def _sensor(body: Body, stream: Stream) -> Sensor:
    side, _, kind = body.name.rpartition("_")
    return Sensor(
        body.name,
        end_effector=kind,
        side=side or "none",
        link=body.link,
        stream=stream,
        shape=body.shape,
        role=body.role,
        eye=body.eye,
    )


def _tagged(body: Body, stream: Stream) -> TagObject:
    assert body.tag is not None
    kind = body.kind or body.name
    return TagObject(body.name, body.tag, stream, body.shape, kind=kind, mass_kg=body.mass_kg)


def _stream(body: Body, times: Float[np.ndarray, "frames"], sampling: Sampling) -> Stream:
    poses = body.path.at(times)
    position, rotation = poses.translation, poses.rotation
    if body.noisy:
        # Each body has a noise of its own, whatever other bodies there are.
        random = np.random.default_rng([sampling.seed, zlib.crc32(body.name.encode())])
        position = position + sampling.noise_m * random.standard_normal((len(times), 3))
        turn = sampling.noise_rad * random.standard_normal((len(times), 3))
        rotation = rotation * Rotation.from_rotvec(turn)
    return Stream(times, position, geometry.quaternions(rotation))


def _height(meeting: Meeting, times: Float[np.ndarray, "frames"], at: float) -> np.ndarray:
    """How far the point is from where it is in contact, along the normal [m]."""
    points = np.asarray(meeting.path.at(times).apply(np.asarray(meeting.point)))
    there: RigidTransform = meeting.path.at(np.array([at]))
    return np.asarray(
        (points - there.apply(np.asarray(meeting.point))) @ np.asarray(meeting.normal)
    )


def _begin(meeting: Meeting, tolerance_m: float) -> float:
    if meeting.arrives_s is None:
        return 0.0
    times = np.arange(max(0.0, meeting.arrives_s - 0.5), meeting.arrives_s, GRID_S)
    apart = _height(meeting, times, meeting.arrives_s) > meeting.depth_m + tolerance_m
    return float(times[np.flatnonzero(apart)[-1]]) if apart.any() else float(times[0])


def _end(meeting: Meeting, tolerance_m: float, duration_s: float) -> float:
    if meeting.leaves_s is None:
        return duration_s
    times = np.arange(meeting.leaves_s, min(duration_s, meeting.leaves_s + 0.5), GRID_S)
    apart = _height(meeting, times, meeting.leaves_s) > meeting.depth_m + tolerance_m
    return float(times[np.flatnonzero(apart)[0]]) if apart.any() else float(times[-1])
