"""A capture: one trial as streams, scene, sensors and performers, frozen and validated once."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import TypeVar

import numpy as np
from jaxtyping import Float

from capar.model.bodies import PivotContact as PivotContact
from capar.model.bodies import Role as Role
from capar.model.bodies import Sensor as Sensor
from capar.model.bodies import Shape as Shape
from capar.model.bodies import ShapeSource as ShapeSource
from capar.model.bodies import Stream as Stream
from capar.model.bodies import TagObject as TagObject
from capar.model.bodies import TagType as TagType
from capar.model.conventions import Conventions
from capar.model.errors import CaptureError, UnknownNameError
from capar.model.names import NAME as NAME
from capar.model.notices import Notice as Notice
from capar.model.notices import notice as notice


@dataclass(frozen=True)
class Agent:
    """The performer, with such measures as are known."""

    name: str = "agent"
    kind: str = "person"
    measures: Mapping[str, float] = field(default_factory=dict)
    """Lengths [m] and ``mass`` [kg] by name: ``stature``, ``upper_arm`` ..."""

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
    recorded_at: str = ""
    """When it says that it was recorded: ISO 8601, a date or a date and time, with or without a
    time zone. Empty if it does not say."""


def recorded_at(sources: Sequence[Source]) -> str:
    """When a capture was recorded (ISO 8601): by its capture.toml, else by the earliest file.

    Empty if none of them says.
    """
    stated = [source.recorded_at for source in sources if source.format == "capture.toml"]
    return next(filter(None, stated), "") or min(
        (source.recorded_at for source in sources if source.recorded_at), default=""
    )


_Named = TypeVar("_Named", Sensor, TagObject)


@dataclass(frozen=True, eq=False)
class Capture:
    """One recorded trial: every stream on one clock, the scene, and who performed."""

    name: str
    sensors: tuple[Sensor, ...]
    objects: tuple[TagObject, ...]
    agent: Agent = field(default_factory=Agent)
    contact_tolerance_m: float | None = None
    """Distance up to which bodies count as touching [m]; None takes it from the sensors' noise."""

    contact_dropout_s: float | None = None
    """A shorter interruption of a contact is closed [s]; None takes the usual time."""

    contact_minimum_s: float | None = None
    """A shorter contact is dropped [s]; None takes the usual time."""

    pivot_contacts: tuple[PivotContact, ...] = ()
    purposes: tuple[Purpose, ...] = ()
    force_transfer: bool = False
    """Whether the user says that force passes to objects in this trial (thesis 4.4.1)."""

    sources: tuple[Source, ...] = ()
    notices: tuple[Notice, ...] = ()
    others: tuple[Agent, ...] = ()
    """Who else performed, where several agents did."""

    conventions: Mapping[str, Conventions] = field(default_factory=dict)
    """By which each body's file was read, by the body's name; empty of what no file held."""

    def __post_init__(self) -> None:
        """Check names and clocks."""
        if not self.sensors:
            raise CaptureError(f"capture {self.name!r} has no tracking sensor; name at least one")
        for kind, group in (("sensor", self.sensors), ("object", self.objects)):
            names = [each.name for each in group]
            for name in names:
                if not NAME.fullmatch(name):
                    raise CaptureError(
                        f"{kind} {name!r}: names begin with a lower-case letter and hold letters, "
                        "digits and underscores"
                    )
                if names.count(name) > 1:
                    raise CaptureError(f"two {kind}s are called {name!r}")
        for body in self._all:
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
        self._check_agents()
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

    def _check_agents(self) -> None:
        agents = [each.name for each in self.agents]
        for name in agents:
            if agents.count(name) > 1:
                raise CaptureError(f"two agents are called {name!r}")
        for body in self._all:
            if body.agent and body.agent not in agents:
                raise UnknownNameError("agent", body.agent, agents, where=body.name)

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
        """Sensors, then objects."""
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
        """The sensors that ride on one end-effector: the one that acts for it, then its parts.

        Raises:
            UnknownNameError: There is no such sensor.
        """
        parts = (each for each in self.sensors if each.part_of == name)
        return (self.sensor(name), *parts)

    @property
    def attending(self) -> tuple[Sensor, ...]:
        """The sensors that give visual constraints."""
        return tuple(each for each in self.sensors if each.role is Role.ATTENDS)

    def sensor(self, name: str) -> Sensor:
        """The sensor of that name.

        Raises:
            UnknownNameError: There is none.
        """
        return _named("sensor", name, self.sensors)

    def tag_object(self, name: str) -> TagObject:
        """The tag object of that name.

        Raises:
            UnknownNameError: There is none.
        """
        return _named("object", name, self.objects)


def _named(kind: str, name: str, group: tuple[_Named, ...]) -> _Named:
    for member in group:
        if member.name == name:
            return member
    raise UnknownNameError(kind, name, [member.name for member in group])
