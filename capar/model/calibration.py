"""What is decided once for a whole recording, before what happens in it is measured.

A calibration is made from a recording, or from its beginning; with it any part of the recording is
measured as the whole would be, as far as the horizons that it states reach.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import StrEnum
from types import MappingProxyType

from capar.model.errors import UnknownNameError, named


@dataclass(frozen=True, slots=True)
class FixedPose:
    """Where a body stands throughout."""

    position_m: tuple[float, float, float]  #: World position [m]
    #: Unit quaternion w x y z that takes the body's axes to the world's
    orientation: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class BodyCalibration:
    """What one sensor's or object's stream shows."""

    name: str
    noise_m: float  #: Standard deviation of one coordinate [m]
    noise_rad: float  #: Standard deviation of the rotation about one axis [rad]
    #: Displacement from a place of rest below which the body is still there [m]
    motion_floor_m: float
    motion_floor_rad: float  #: The same for its orientation [rad]
    #: Highest speed of its low-passed origin [m/s]: extrema of speed are compared with it
    highest_speed_mps: float
    #: The axis that points up where it first rests, in its own frame; a unit vector
    upright: tuple[float, float, float]
    still: bool  #: Whether its recorded pose is one and the same in every frame
    #: Of a FIXED object, the median of its poses, at which it is taken to stand; else None
    fixed: FixedPose | None = None


class Found(StrEnum):
    """How the distance at which two bodies touch was found (spec 10)."""

    TOLERANCE = "tolerance"  #: Both have surfaces, which touch within the tolerance
    STATED = "stated"  #: The capture states it, or the user for this run
    CO_MOTION = "co-motion"  #: From frames in which one travels and is steady in the other's frame
    #: From frames in which one rests by the other, nearer than where they rest apart
    SETTLING = "settling"
    REST = "rest"  #: From frames in which one rests on the other and nobody holds it
    NEVER = "never"  #: Nothing in the recording shows that they touch; they are taken not to


@dataclass(frozen=True, slots=True)
class PairCalibration:
    """At which distances two bodies begin and cease to touch."""

    first: str
    second: str
    #: Distance up to which they touch [m]: of surfaces, or of points where ``pivots``
    touch_m: float
    #: Between two frames of contact they touch while they are nearer than this [m]
    release_m: float
    pivots: bool = False  #: Whether the distance is that of two points of theirs, not of surfaces
    found: Found = Found.TOLERANCE
    frames: int = 0  #: From how many frames it was found; zero where it was not
    #: The point of the first body in its own frame [m], where ``pivots``
    first_point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    second_point: tuple[float, float, float] = (0.0, 0.0, 0.0)

    #: What the recording shows where it contradicts what is taken [m]; else None.
    #: Of a stated distance, the one that would be estimated. Of two surfaces, the gap at which one
    #: steadily carries the other: a mount or a fit is off by so much
    shown_m: float | None = None


@dataclass(frozen=True, slots=True)
class FootLevel:
    """On what level an agent's feet stand."""

    agent: str
    height_m: float  #: Height of the lowest point of a foot at its lowest rest [m]


@dataclass(frozen=True, slots=True)
class MovingGround:
    """A ground whose surface moves under an agent's feet, such as the belt of a treadmill."""

    agent: str
    ground: str
    #: Level velocity of its surface along the world's x and y axes [m/s]
    velocity_mps: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Horizons:
    """How far measurements look: what is farther from a frame than this has no part in it.

    Rest poses and what follows from them have no horizon; see ``extractors.calibration``.
    """

    filter_s: float  #: Half the length of the low-pass filter [s]
    gap_s: float  #: Longest loss that is interpolated [s]; as many frames on each side take part
    #: How far about an extremum of speed its prominence and its neighbours are sought [s]
    extremum_s: float
    interval_s: float  #: Longest interruption that is closed, and shortest interval that counts [s]

    @property
    def margin_s(self) -> float:
        """What a window has to hold on either side of the part that it is asked about [s].

        Speeds reach two frames beyond the filter, which the interval's horizon covers.
        """
        return 3.0 * self.gap_s + self.filter_s + 2.0 * self.extremum_s + 2.0 * self.interval_s


@dataclass(frozen=True)
class Calibration:
    """Everything that is decided once for a whole recording."""

    step_s: float  #: Median step of the clock [s]
    cutoff_hz: float  #: Where the zero-phase low-pass halves the amplitude [Hz]
    contact_tolerance_m: float  #: Distance up to which surfaces count as touching [m]
    contact_dropout_s: float  #: A shorter interruption of a contact is closed [s]
    contact_minimum_s: float  #: A shorter contact is dropped [s]
    sensors: tuple[BodyCalibration, ...]
    objects: tuple[BodyCalibration, ...]
    #: Pairs of bodies whose contact is sought, as they are sought
    pairs: tuple[PairCalibration, ...]
    foot_levels: tuple[FootLevel, ...]  #: Of each agent with feet that rest
    horizons: Horizons
    #: Every number that extraction decides by, by its name in ``extractors.thresholds``
    thresholds: Mapping[str, float]
    #: Grounds that go by under feet that walk on the spot
    moving_grounds: tuple[MovingGround, ...] = ()

    def __post_init__(self) -> None:
        """Make the thresholds read-only."""
        object.__setattr__(self, "thresholds", MappingProxyType(dict(self.thresholds)))

    def __reduce__(self) -> "tuple[type[Calibration], tuple[object, ...]]":
        """Pickle it by its fields: a read-only mapping cannot be pickled itself."""
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return Calibration, tuple({**values, "thresholds": dict(self.thresholds)}.values())

    def body(self, name: str) -> BodyCalibration:
        """That of the sensor of a name, or else of the object."""
        return named("body", name, (*self.sensors, *self.objects), where="calibration")

    def sensor(self, name: str) -> BodyCalibration:
        """That of the sensor of a name; UnknownNameError where there is none."""
        return named("sensor", name, self.sensors, where="calibration")

    def tag_object(self, name: str) -> BodyCalibration:
        """That of the object of a name; UnknownNameError where there is none."""
        return named("object", name, self.objects, where="calibration")

    def pair(self, first: str, second: str) -> PairCalibration:
        """That of two bodies; UnknownNameError where their contact is not sought."""
        found = self.sought(first, second)
        if found is None:
            known = [f"{pair.first}-{pair.second}" for pair in self.pairs]
            raise UnknownNameError("pair", f"{first}-{second}", known, where="calibration")
        return found

    def sought(self, first: str, second: str) -> PairCalibration | None:
        """That of two bodies; None where their contact is not sought."""
        pairs = (pair for pair in self.pairs if (pair.first, pair.second) == (first, second))
        return next(pairs, None)

    def foot_level(self, agent: str) -> float:
        """Height on which an agent's feet stand [m]; infinite where no foot rests."""
        known = {level.agent: level.height_m for level in self.foot_levels}
        return known.get(agent, float("inf"))

    def ground_velocity(self, agent: str, ground: str) -> tuple[float, float]:
        """Level velocity of a ground under an agent's feet [m/s]; zero of what stands."""
        known = {(belt.agent, belt.ground): belt.velocity_mps for belt in self.moving_grounds}
        return known.get((agent, ground), (0.0, 0.0))
