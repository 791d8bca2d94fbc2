"""The text of a rule base as the solver reads it, without rules that cannot change the answer.

Most rules are about what one capture does not have: doors, seats, a second agent. To read and
ground them all takes 45 ms, which counts where a process asks the same rules again and again, as
live observation does for every window. A rule that needs an atom which neither the facts nor
another rule can give has no instance, so leaving it out leaves the answer as it is. So does leaving
out words that nothing shown depends on: many are there for the rules of users, and they are a
quarter of all atoms.
"""

from collections.abc import Iterable
from functools import cached_property
from pathlib import Path

from capar_rules.engine.slicing import asked_for, firing
from capar_rules.engine.syntax import Signature, Statement, parse


class RuleBase:
    """Rule files that are asked again and again."""

    def __init__(self, files: Iterable[Path]) -> None:
        self.files = tuple(files)
        self.programs: dict[frozenset[Signature], str] = {}
        """What remains of the rules for facts of these predicates."""
        self.asked = 0
        """How often they were asked [1]."""

    @cached_property
    def statements(self) -> tuple[Statement, ...]:
        """The rules and directives, without comments: reading them takes 0.2 s."""
        found = parse(self.files)
        return tuple(statement for statement in found if statement.kind != "comment")

    def program(self, measured: frozenset[Signature]) -> str:
        """Every directive, and the rules on which the answer depends.

        Args:
            measured: The only predicates that have facts.
        """
        if measured not in self.programs:
            fired = {id(rule) for rule in firing(self.statements, measured)}
            kept = (part for part in self.statements if part.kind != "rule" or id(part) in fired)
            self.programs[measured] = "\n".join(part.text for part in asked_for(tuple(kept)))
        return self.programs[measured]
