"""A user's rules in the worlds of the audit: asked is only of those in which they can fire."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from capar_rules.engine.search import Atom
from capar_rules.engine.slicing import heads_of, signatures_below, towards
from capar_rules.engine.syntax import Place, Signature, Statement, split_arguments
from capar_rules.lint.audit import evaluate, given_in_audit
from capar_rules.lint.candidates import candidates, generals
from capar_rules.lint.extents import Extents, Worlds, every_world, extents_of
from capar_rules.lint.text_checks import Known, known

BATCH = 50
"""Worlds for each call of the solver, when little is asked of each.

Of 20 to 400 the fastest. With fewer the rules are grounded more often; with more the search begins
anew in all of them at every conflict: what takes 6 s so took 33 to over 100 s with 400.
"""


@dataclass(frozen=True)
class Trial:
    """The rules of one file of a user, beside those of others, on top of a shipped rule base."""

    own: Sequence[Statement]
    base: Known
    """The shipped rule base."""

    beside: Sequence[Statement] = ()
    """The rules of the user's other files."""

    @cached_property
    def joined(self) -> Known:
        """The vocabulary of everything but the file's own."""
        return known([*self.base.rules, *self.beside]) if self.beside else self.base

    @cached_property
    def extents(self) -> Extents:
        """Where shipped primitives can fit."""
        return extents_of(self.base.rules)

    @cached_property
    def candidates(self) -> Mapping[str, Worlds]:
        """Where each primitive of the user can fit, at most."""
        return candidates([*self.own, *self.beside], self.extents)

    @cached_property
    def names(self) -> Mapping[str, Place]:
        """The primitives of the file, and where each is declared."""
        return primitives_of(self.own)

    @cached_property
    def worlds(self) -> Worlds:
        """Where some primitive of the file can fit."""
        return self.reach(self.names)

    @cached_property
    def generals(self) -> Mapping[str, set[str]]:
        """For each primitive of the file, those that it specialises."""
        rules = [*self.own, *self.joined.rules]
        return {name: generals(name, rules) for name in self.names}

    def reach(self, names: Iterable[str]) -> Worlds:
        """Where some of these primitives of the user can fit."""
        return frozenset().union(*(self.candidates.get(name, frozenset()) for name in names))

    def extent(self, name: str) -> Worlds:
        """Where a primitive, of the user or shipped, can name the segment, at most."""
        if name in self.candidates:
            return self.candidates[name]
        return self.extents.named.get(name, every_world())

    def ask(
        self, probes: Iterable[Statement], asked: Iterable[Signature], worlds: Worlds | None = None
    ) -> frozenset[Atom]:
        """Which of these atoms the probes derive in some world; of all worlds if none are named.

        Raises:
            RuleError: The rules have an error.
        """
        added = tuple(probes)
        if not added:
            return frozenset()
        limbs = every_world() if worlds is None else worlds
        rules = [*self.joined.rules, *self.own, *added]
        return evaluate(rules, tuple(asked), limbs=limbs, batch=BATCH)

    def beyond(self, rule: Statement) -> tuple[Signature, ...]:
        """The measurements that a rule depends on and no world contains."""
        return self.measured_below(atom.signature for each in rule.body for atom in each.atoms)

    def measured_below(self, signatures: Iterable[Signature]) -> tuple[Signature, ...]:
        """The measurements below predicates that no world contains."""
        read = self.below(signatures)
        defined = self.joined.heads | heads_of(self.own)
        return tuple(sorted((read & self.base.measured) - given_in_audit() - defined))

    def below(self, signatures: Iterable[Signature]) -> frozenset[Signature]:
        """Predicates and what they depend on, down to what the worlds define."""
        below, given = frozenset(signatures), given_in_audit()
        rules = [*self.joined.rules, *self.own]
        slice_ = towards(rules, below - given, given=given)
        return below | signatures_below(each for each in slice_ if each.kind == "rule")


def primitives_of(rules: Iterable[Statement]) -> dict[str, Place]:
    """The names of the primitives that rules declare, and where."""
    return {
        split_arguments(head.text)[0].strip('"'): head.place
        for each in rules
        for head in each.heads
        if head.signature == ("primitive", 1)
    }
