"""Rule cases: files under ``tests/rules``, one for a rule concept, a primitive or a preposition.

A case begins with ``%% title``, then a comment that tells the story, then its facts, then its
expectations, ``=> atom``, or ``=> not atom`` for one that must not follow. ``% profile: thesis``
chooses those rules; without it they are the extended ones.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from capar.model.facts import Fact, read_fact
from capar_rules.borders.deflicker import steady
from capar_rules.borders.numbering import number_borders
from capar_rules.engine.profiles import Profile, profile
from capar_rules.engine.solver import solve, text_of

HERE = Path(__file__).parent / "rules"


@dataclass(frozen=True, slots=True)
class Case:
    """A story in facts, and what rules must and must not make of it."""

    concept: str
    """The folder and the name of its file: the rule file that it is about."""

    title: str
    story: str
    facts: str
    expected: tuple[str, ...]
    """Atoms, those that must not follow after ``not``."""

    @property
    def profile(self) -> Profile:
        """The rules to reason with."""
        return profile("thesis" if "% profile: thesis" in self.story else "extended")

    def measured(self) -> tuple[Fact, ...]:
        """Its facts as values."""
        atoms = solve([], self.facts).atoms
        return tuple(read_fact(text_of((name, *arguments))) for name, arguments in atoms)

    def numbered(self) -> tuple[Fact, ...]:
        """Its facts as the rules take them, with the numbers of their borders."""
        facts = steady(self.measured()) if self.profile.steady else self.measured()
        return (*facts, *number_borders(facts, crossings_only=self.profile.crossings_only))

    def __str__(self) -> str:
        """What a report calls it."""
        return f"{self.concept}: {self.title}"


def read_cases(path: Path) -> Iterator[Case]:
    """The cases of a file, in their order.

    Raises:
        ValueError: Text before the first case.
    """
    before, *texts = f"\n{path.read_text()}".split("\n%% ")
    if before.strip():
        raise ValueError(f"{path}: a case begins with '%% title', found {before.strip()!r}")
    concept = f"{path.parent.name}/{path.stem}"
    for text in texts:
        title, *lines = text.splitlines()
        told = [line for line in lines if line.startswith("%")]
        expected = (line.removeprefix("=> ") for line in lines if line.startswith("=> "))
        facts = [line for line in lines if not line.startswith(("%", "=> "))]
        yield Case(concept, title, "\n".join(told), "\n".join(facts), tuple(expected))


@cache
def all_cases() -> tuple[Case, ...]:
    """Every case, by file."""
    return tuple(case for path in sorted(HERE.rglob("*.cases")) for case in read_cases(path))
