"""Which rules of a user fire in the audit's worlds, and why others were not judged."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from capar_rules.engine.search import Atom
from capar_rules.engine.slicing import FITS
from capar_rules.engine.syntax import Signature, Statement
from capar_rules.lint.audit import chosen_in_audit
from capar_rules.lint.candidates import primitive_in
from capar_rules.lint.extents import every_world
from capar_rules.lint.probes import (
    ASKED,
    FIRED,
    HELD,
    firing_probes,
    holding_probes,
    naming_probes,
    plain_conditions,
)
from capar_rules.lint.relaxation import Relaxation
from capar_rules.lint.trials import Trial

FEW_OF = 20
"""One world in so many is asked first whether rules fire: most do in some of them, and the search
through all worlds takes longer for each rule that is asked."""

Rules = Mapping[int, Statement]
"""Rules by their index in the file."""


@dataclass(frozen=True)
class Firing:
    """The rules of a file, with those beside it, tried in the worlds of the audit."""

    trial: Trial

    @cached_property
    def every(self) -> Sequence[Statement]:
        """The rules of the file, then those beside it."""
        return (*self.trial.own, *self.trial.beside)

    @cached_property
    def rules(self) -> Rules:
        """Those that derive something."""
        return {
            at: rule
            for at, rule in enumerate(self.every)
            if rule.kind == "rule" and rule.heads and (rule.body or at < len(self.trial.own))
        }

    @cached_property
    def beyond(self) -> Mapping[int, tuple[Signature, ...]]:
        """For each rule, the measurements that it depends on and no world contains."""
        return {at: self.trial.beyond(rule) for at, rule in self.rules.items()}

    @cached_property
    def judged(self) -> Rules:
        """The rules that the worlds can decide: about what they contain, and one segment."""
        return {
            at: rule
            for at, rule in self.rules.items()
            if not self.beyond[at] and not self.joined(rule)
        }

    def joined(self, rule: Statement) -> bool:
        """Whether a rule is about more than one segment; each world has one."""
        return bool(self.stated.others[id(rule)])

    @cached_property
    def stated(self) -> Relaxation:
        """The rules with those conditions left open that are beyond the worlds by their text."""
        return Relaxation(self.trial)

    @cached_property
    def atoms(self) -> frozenset[Atom]:
        """Which rules fire and which names fit, win and meet, where the file's primitives can."""
        trial = self.trial
        watched = {*trial.names, *(over for each in trial.generals.values() for over in each)}
        probes = [*firing_probes(self.judged), *naming_probes(sorted(watched), sorted(watched))]
        return trial.ask(probes, ASKED, trial.worlds)

    @cached_property
    def unfired(self) -> Rules:
        """The judged rules that fire in no world; one that no primitive needs may fire in any."""
        fired = numbers(self.atoms, "_fired")
        unfired = {at: rule for at, rule in self.judged.items() if rule.body and at not in fired}
        rest = sorted(every_world() - self.trial.worlds)
        few = frozenset(rest[::FEW_OF])
        for worlds in (few, frozenset(rest) - few):
            elsewhere = {
                at: rule
                for at, rule in unfired.items()
                if at not in fired
                and (not is_fits(rule) or at >= len(self.trial.own))
                and not self.stated.rests_on_open(rule)
            }
            fired |= numbers(self.trial.ask(firing_probes(elsewhere), (FIRED,), worlds), "_fired")
        return {at: rule for at, rule in unfired.items() if at not in fired}

    @cached_property
    def missing(self) -> Mapping[int, str]:
        """For rules that never fire, a condition that no world fulfils though a real segment may.

        No world has such a relation, or it depends on one chosen over few arguments only. Rules
        that rest on an open condition by their text are left out.
        """
        trial = self.trial
        rules = {
            at: each for at, each in self.unfired.items() if not self.stated.rests_on_open(each)
        }
        conditions = {
            (at, place): atom for at in rules for place, atom in plain_conditions(rules[at])
        }
        held: set[tuple[object, ...]] = {
            (*key, "so")
            for key, atom in conditions.items()
            if atom.signature == FITS and trial.extents.fits.get(primitive_in(atom))
        }
        for worlds in (trial.worlds, every_world() - trial.worlds):
            unheld = {key: atom for key, atom in conditions.items() if (*key, "so") not in held}
            held |= {row for _, row in trial.ask(holding_probes(unheld), (HELD,), worlds)}
        found: dict[int, str] = {}
        for key, atom in conditions.items():
            chosen = trial.below([atom.signature]) & chosen_in_audit()
            if (*key, "so") not in held and (chosen or (*key, "any") not in held):
                found.setdefault(key[0], atom.text)
        return found

    @cached_property
    def relaxation(self) -> Relaxation:
        """The rules with what the worlds cannot decide left open."""
        doubtful = frozenset(self.missing.values())
        return Relaxation(self.trial, doubtful) if doubtful else self.stated


def is_fits(rule: Statement) -> bool:
    """Whether it says which segments fit a primitive."""
    return rule.heads[0].signature == FITS


def numbers(atoms: Iterable[Atom], predicate: str) -> set[object]:
    """The rules, by index, of which a probe holds."""
    return {row[0] for name, row in atoms if name == predicate and len(row) == 1}
