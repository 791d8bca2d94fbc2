"""Why a segment has not the names of its neighbours, as a sentence."""

from collections.abc import Sequence
from dataclasses import dataclass

HALF = 0.5
"""How near a condition that has no number is taken to come to being otherwise [1]."""


@dataclass(frozen=True)
class Contrast:
    """Neighbouring names of which the same condition decided."""

    names: tuple[str, ...]
    clauses: tuple[str, ...]
    """What kept the segment from them."""

    rule: str
    """File and line of a rule of the first name that would have needed it otherwise."""

    by_features: bool
    """Whether it is the features that differ, and no condition of the name's own."""

    failing: int = 1
    """How many conditions keep the segment from the first name."""

    though: tuple[str, ...] = ()
    """What would have been seen of the names, and was so."""

    below: bool = False
    """Whether the first name specialises the segment's own."""

    numbered: bool = False
    """Whether what is told has a number."""

    direct: bool = False
    """Whether the features differ in a row of the first name's own."""

    nearness: float = HALF
    """By how much what decided missed being otherwise: a share of what was asked for."""

    general: str = ""
    """The first name, where the others are kinds of it."""

    @property
    def weak(self) -> bool:
        """Whether it is too far off to be told where a more general name can be told instead."""
        far = self.failing > 1 and not self.numbered and not self.below
        return (self.by_features or far) and not self.though

    def told_as(self, other: "Contrast") -> bool:
        """Whether the same is told of the names of both."""
        return (self.clause, self.though) == (other.clause, other.though)

    @property
    def clause(self) -> str:
        """The clauses as one."""
        return _joined(self.clauses)

    @property
    def sentence(self) -> str:
        """Why the segment has none of the names."""
        return f"{self.called}, because {self.clause}"

    @property
    def called(self) -> str:
        """The names, and what was so though the segment has none of them."""
        though = f", though {_joined(self.though)}" if self.though else ""
        return f"{alternatives(self.names, self.general)}{though}"


def alternatives(names: Sequence[str], general: str = "") -> str:
    """Names of which a segment has none; those that are kinds of the first one are told so."""
    if general and len(names) > 1 and names[0] == general:
        kinds = "its kind" if len(names) == 2 else "its kinds"
        return f"{general} or {kinds} {_joined(names[1:])}"
    *before, last = names
    return f"{', '.join(before)}{' or ' * bool(before)}{last}"


def _joined(clauses: Sequence[str]) -> str:
    if len(clauses) < 2:
        return "".join(clauses)
    return f"{', '.join(clauses[:-1])} and {clauses[-1]}"
