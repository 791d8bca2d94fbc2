"""Values that the methods of the Actionary return."""

from dataclasses import dataclass

from capar.model.locations import ConstraintLocation
from capar.model.par import FeatureSet, Style


@dataclass(frozen=True, slots=True, order=True)
class Stored:
    """An observation that the Actionary holds."""

    name: str
    """The capture's name, by which it is forgotten or replaced."""

    action: str
    """What its complex action is called."""

    agent: str
    profile: str
    version: str
    rules: str
    duration_s: float


@dataclass(frozen=True, slots=True)
class Added:
    """What became of an observation that was added."""

    name: str
    action: str
    """What its complex action is called."""

    recognised: str
    """Under which name that action was known before; empty if it was not."""

    replaced: bool
    """Whether it took the place of an observation of the same capture."""

    statements: int


@dataclass(frozen=True, slots=True)
class FoundLocation:
    """A constraint location, and how it was found."""

    location: ConstraintLocation
    kind: str
    """The kind of object that it is kept with."""

    observation: str
    agent: str
    mirrored: bool
    """Whether it was observed on the other side of the body."""

    inherited: bool
    """Whether it is kept with a more general kind than was asked for."""


@dataclass(frozen=True, slots=True)
class FoundStyle:
    """A style, and in which observation it was seen."""

    style: Style
    agent: str
    observation: str


@dataclass(frozen=True, slots=True, order=True)
class FeatureRow:
    """A line of the feature table (thesis 4.5)."""

    name: str
    features: FeatureSet
    general: tuple[str, ...]
    """What the action specialises, nearest first."""

    declared: bool
    """Whether a user named it, rather than an observation showing it."""

    seen: int
    """How many segments have these features and this name."""


@dataclass(frozen=True, slots=True, order=True)
class Ability:
    """An action that an agent is able to do, or that an object lends itself to."""

    action: str
    evidence: str
    """``declared`` or ``observed``."""
