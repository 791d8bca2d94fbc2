"""An observation: everything that was understood of one capture, frozen."""

from dataclasses import dataclass

from capar.model.capture import Agent, Notice, Source
from capar.model.facts import Fact
from capar.model.par import (
    UNKNOWN,
    ComplexPar,
    ConstraintLocation,
    FeatureSet,
    Ipar,
    Style,
    Upar,
)


@dataclass(frozen=True, slots=True, order=True)
class Border:
    """Why a segment begins or ends: the relation that began or ended there."""

    kind: str
    """What changes there.

    ``first``, ``last``; of a contact ``begins``, ``ends``; of a body ``starts_moving``,
    ``stops_moving``, ``turns``, ``comes_to_rest``, ``leaves_rest``, ``reverses``,
    ``begins_swinging``, ``ends_swinging``, ``tips`` or ``rights``.
    """

    body: str = ""
    other: str = ""


@dataclass(frozen=True, slots=True)
class Segment:
    """The motion of one link between two borders (thesis 4.3.2)."""

    ee: str
    index: int
    """Its number in the link, from zero."""

    first: int
    """Frame of the border where it begins."""

    last: int
    """Frame of the border where it ends; the next segment begins there."""

    start_s: float
    end_s: float
    name: str
    """The most specific name that the rules give, or ``Unknown``."""

    general: tuple[str, ...]
    """What it specialises, nearest first."""

    candidates: tuple[str, ...]
    """Names that fit equally well, or, if unknown, those that fit furthest."""

    level: str
    """The feature at which an unknown segment parted from every known set; else empty."""

    objects: tuple[str, ...]
    """Dominant object first."""

    possessed: bool
    """Whether the end-effector possesses the dominant object."""

    features: FeatureSet
    begins: tuple[Border, ...]
    ends: tuple[Border, ...]
    purpose: str
    prepositions: tuple[tuple[str, str, str], ...] = ()
    """Where its body is or goes: preposition, body, and the other body; sorted."""

    @property
    def known(self) -> bool:
        """Whether a rule named it."""
        return self.name != UNKNOWN


@dataclass(frozen=True, slots=True)
class ObservedLink:
    """One acting end-effector and its segments in order."""

    ee: str
    kind: str
    side: str
    segments: tuple[Segment, ...]


@dataclass(frozen=True, slots=True)
class ObservedObject:
    """What the scene says of a tag object."""

    name: str
    kind: str
    tag: str
    size_m: tuple[float, float, float]
    """Lengths along its own axes [m]; zero where it has no shape."""

    shape: str
    assumed: str
    position_m: tuple[float, float, float]
    """Where it was in the first frame in which it is known [m]."""

    orientation: tuple[float, float, float, float]
    """Unit quaternion w x y z there."""


@dataclass(frozen=True, slots=True)
class Observation:
    """A capture understood: its scene, facts, segments and PARs, and where they come from."""

    capture: str
    profile: str
    rules: str
    """SHA-256 of the rule base."""

    version: str
    agent: Agent
    duration_s: float
    rate_hz: float
    frames: int
    objects: tuple[ObservedObject, ...]
    links: tuple[ObservedLink, ...]
    facts: tuple[Fact, ...]
    upars: tuple[Upar, ...]
    ipars: tuple[Ipar, ...]
    """One for each segment, links in order."""

    complex_par: ComplexPar
    locations: tuple[ConstraintLocation, ...]
    styles: tuple[Style, ...]
    sources: tuple[Source, ...]
    notices: tuple[Notice, ...]

    @property
    def segments(self) -> tuple[Segment, ...]:
        """Every segment, links in order."""
        return tuple(each for link in self.links for each in link.segments)
