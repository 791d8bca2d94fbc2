"""Where constraints are on objects, and where a hinge or a rail guides one (thesis Fig 4.8)."""

from dataclasses import dataclass

from capar.model.nlt import Nlt


@dataclass(frozen=True, slots=True)
class ConstraintLocation:
    """Where a constraint was made, stored with the kind of object (thesis Fig 4.8)."""

    action: str
    purpose: str
    ee: str
    """The end-effector that made it."""

    side: str
    frame: int
    dominant: str
    """The object of ``ee_nlt``; empty if the end-effector alone made the contact."""

    goal: str
    """The object of ``goal_nlt``."""

    ee_nlt: Nlt | None
    goal_nlt: Nlt | None
    seen: str = ""
    """The object of ``v_nlt``; empty if nothing was looked at."""

    v_nlt: Nlt | None = None


@dataclass(frozen=True, slots=True)
class GuideLocation:
    """Where on an object its hinge or rail is: a constraint location that always holds (spec 10).

    The constraint's x axis is the line of the hinge or the rail, in the sense in which the object
    opens: along the rail, or right-handed about the hinge.
    """

    object: str
    """The door, lid or drawer."""

    base: str
    """The fixed object that bears the hinge or the rail."""

    kind: str
    """``hinge`` or ``rail``."""

    object_nlt: Nlt
    base_nlt: Nlt
    opened: float
    """How far from its closed place it was seen at most: [rad] on a hinge, [m] on a rail."""

    residual_m: float
    """Root mean square of how far its poses are off the fitted line, turning included [m]."""
