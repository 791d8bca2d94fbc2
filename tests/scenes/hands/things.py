"""Things of a scene, and the steps that a scene's hands do."""

from dataclasses import dataclass, field

import numpy as np

from capar.model.capture import TagType
from scenes.hands.paths import Body
from scenes.hands.shapes import Form

SITES = {
    "+x": (1.0, 0.0, 0.0),
    "-x": (-1.0, 0.0, 0.0),
    "+y": (0.0, 1.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
    "+z": (0.0, 0.0, 1.0),
    "-z": (0.0, 0.0, -1.0),
}
"""Sides of a thing, as directions out of it in its own frame."""


@dataclass(eq=False)
class Thing:
    """Something in the scene that is no acting hand."""

    body: Body
    form: Form
    tag: TagType
    free: list[tuple[float, float]] = field(default_factory=list)
    """When it moves without being held: it was struck or thrown [s]."""

    part_of: str = ""
    """The thing whose part it is, where the capture says so."""

    closed_deg: float | None = None
    closed_m: float | None = None

    @property
    def name(self) -> str:
        """Its name in the capture."""
        return self.body.name

    def site(self, side: str, up: float, time: float) -> tuple[np.ndarray, np.ndarray]:
        """A point on one of its sides at a time, and the direction out of it.

        Args:
            side: One of ``SITES``.
            up: Height of the point as a share of the thing's height (of the side's middle).
            time: When [s].
        """
        corners = self.form.vertices
        low, high = corners.min(axis=0), corners.max(axis=0)
        out = np.asarray(SITES[side])
        point = (low + high) / 2.0
        point[2] = low[2] + up * (high[2] - low[2])
        axis = int(np.argmax(np.abs(out)))
        point[axis] = high[axis] if out[axis] > 0 else low[axis]
        matrix = self.body.at(time)
        return matrix[:3, :3] @ point + matrix[:3, 3], matrix[:3, :3] @ out


Action = tuple[str, tuple[str, ...]]
"""A step's name and its objects, the dominant one first."""


@dataclass(frozen=True, slots=True)
class Step:
    """One step of an end-effector, from its start up to its end [s]."""

    name: str
    objects: tuple[str, ...]
    start_s: float
    end_s: float

    @property
    def action(self) -> Action:
        """The step without its times."""
        return self.name, self.objects


@dataclass(frozen=True, slots=True)
class Unit:
    """What one end-effector does in one scene: the unit that is counted."""

    ee: str
    steps: tuple[Step, ...]
    alternative: tuple[Step, ...] = ()
    """Another sequence that the texts allow as well, or empty."""

    @property
    def actions(self) -> tuple[Action, ...]:
        """Names and objects in order."""
        return tuple(each.action for each in self.steps)


@dataclass(frozen=True, slots=True)
class Expectation:
    """The units of a scene."""

    scene: str
    units: tuple[Unit, ...]
