"""What a scene performs: the steps of each end-effector, with their true times."""

from dataclasses import dataclass

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
