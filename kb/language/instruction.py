"""What a sentence says is to be done, or was done: actions with their circumstances, in order."""

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

from capar.model.observation import Segment
from capar.model.par import Call, Step

Window = tuple[float, float]
"""From when to when [s], infinite where it is open."""

GAP = "?"
"""The object that a question asks for."""


class Relation(StrEnum):
    """How one action stands to another in time."""

    WHILE = "while"
    WHEN = "when"
    BEFORE = "before"
    AFTER = "after"
    UNTIL = "until"
    WITHOUT = "without"
    WHERE = "where"
    SAME_AGENT = "same agent"


@dataclass(frozen=True, slots=True)
class Circumstances:
    """What a sentence says of an action beside its objects and its hand."""

    negated: bool = False
    manner: tuple[str, ...] = ()
    """In words, as they were said: ``slowly``, ``again``."""

    places: tuple[tuple[str, str], ...] = ()
    """Prepositions with what stands after them: ``("next to", "box")``."""

    others: tuple[str, ...] = ()
    """What is named and is no body that a tracker follows: ``water``."""

    count: int = 0
    """How often; zero if it is not said."""

    duration_s: float = 0.0
    """For how long [s]; zero if it is not said."""

    window: Window | None = None
    """Within which time [s] of a recording."""

    conditions: tuple["Condition", ...] = ()


@dataclass(frozen=True, slots=True)
class Instruction:
    """An action to be done: what an IPAR leaves once its time is not bound."""

    call: Call
    """Its action is empty where any is meant, and so is an object that is not named."""

    ee: str = ""
    """The end-effector, or empty where any will do."""

    agent: str = ""
    source: str = ""
    """Where the dominant object is taken from, if it is said."""

    circumstances: Circumstances = Circumstances()
    said: str = ""
    """The verb as it was said, where no primitive has it."""

    known: bool = True
    """Whether a primitive has the verb, or one that it is a kind of."""

    @classmethod
    def of(cls, step: Step | Segment) -> "Instruction":
        """What a step or a segment does."""
        name = step.action if isinstance(step, Step) else step.name
        return cls(Call(name, step.objects, step.purpose), step.ee)

    def having(self, **circumstances: Any) -> "Instruction":
        """The same in other circumstances."""
        return replace(self, circumstances=replace(self.circumstances, **circumstances))

    def under(self, *conditions: "Condition") -> "Instruction":
        """The same under further conditions."""
        return self.having(conditions=(*self.circumstances.conditions, *conditions))


@dataclass(frozen=True, slots=True)
class Condition:
    """Another action that the first is related to."""

    relation: Relation
    about: Instruction


Stream = tuple[Instruction, ...]
"""Actions one after the other."""


@dataclass(frozen=True, slots=True)
class Plan:
    """Several actions: parts one after the other, in each of which streams go side by side."""

    parts: tuple[tuple[Stream, ...], ...]

    @property
    def steps(self) -> Stream:
        """Every action, part by part and stream by stream."""
        return tuple(step for part in self.parts for stream in part for step in stream)
