"""Rules of users with every condition left open that the audit's worlds cannot decide.

A condition on measurements that the worlds do not contain, or about another segment than the one
that the rule is about, may hold or not, for each of the things that it speaks of: it becomes a
choice. Two primitives may share a segment if some choice makes both fit; ``brief(S)`` and
``not brief(S)`` keep them apart, and so does ``not fits(Segment, "Other")``. Helper predicates of
the user's files are relaxed rule by rule like the primitives that read them.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from capar_rules.engine.slicing import FITS, heads_of, signatures_below
from capar_rules.engine.syntax import Literal, Signature, Statement, split_arguments
from capar_rules.lint.candidates import ROW, named_by, primitive_in
from capar_rules.lint.segment_terms import FITTED, about_others, equations, segment_slots
from capar_rules.lint.text_checks import AUTHORED
from capar_rules.lint.trials import Trial, primitives_of
from capar_rules.lint.word_places import Slot, arguments_of

OVERLAP, COULD = ("_overlap", 2), ("_could", 1)

NAMING = """
_may(S,N) :- fits(S,N), not _written(N).
_under(S,N) :- _may(S,N), _may(S,M), more_general(M,N,_).
_under(S,N) :- _may(S,N), _may(S,M), precedes(M,N).
_top(S,N) :- _may(S,N), not _under(S,N).
_overlap(N,M) :- _asked(N), _top(S,N), _top(S,M), N != M.
_could(N) :- _asked(N), _may(_,N).
"""

_VARIABLE = re.compile(r"(?<![\w\"])_*[A-Z]\w*'*")
_ANONYMOUS = re.compile(r"\bAny\d+\b")
_TERM = re.compile(r"_*[A-Z]\w*'*|_*[a-z]\w*\([\w',]+\)")
_STRING = re.compile(r'"[^"]*"')


@dataclass(frozen=True)
class Relaxation:
    """The rules of a file and of those beside it, with what the worlds cannot decide left open."""

    trial: Trial
    doubtful: frozenset[str] = frozenset()
    """Conditions, as written, that no world fulfils though a segment may."""

    @cached_property
    def rules(self) -> Sequence[Statement]:
        """The rules of the user."""
        every = (*self.trial.own, *self.trial.beside)
        return [each for each in every if each.kind == "rule" and each.heads]

    @cached_property
    def names(self) -> frozenset[str]:
        """The primitives of the user."""
        return frozenset(primitives_of(self.rules))

    @cached_property
    def slots(self) -> frozenset[Slot]:
        """The arguments of predicates that are segments."""
        return segment_slots([*self.trial.base.rules, *self.rules]) | {FITTED}

    @cached_property
    def others(self) -> Mapping[int, frozenset[str]]:
        """For each rule, by its identity, its conditions about other segments than its own."""
        return {id(rule): about_others(rule, self.slots) for rule in self.rules}

    @cached_property
    def beyond(self) -> frozenset[Signature]:
        """The predicates that the user's rules read and that rest on what no world contains."""
        read = signatures_below(self.rules) - {FITS}
        return frozenset(each for each in read if self.trial.measured_below([each]))

    @cached_property
    def helpers(self) -> frozenset[Signature]:
        """Predicates of the user's own."""
        return heads_of(self.rules) - {*AUTHORED}

    @cached_property
    def closed_helpers(self) -> frozenset[Signature]:
        """Those that are relaxed rule by rule: decided conditions give every argument a value."""
        found = {*self.helpers}
        while unbound := {
            head.signature
            for rule in self.rules
            for head in rule.heads
            if head.signature in found
            and not _variables(head.text) <= self._bound(rule, frozenset(found))
        }:
            found -= unbound
        return frozenset(found)

    def open_conditions(self, rule: Statement) -> list[Literal]:
        """The conditions of a rule that are left open."""
        return [each for each in rule.body if self._is_open(rule, each, self.closed_helpers)]

    @cached_property
    def soft_names(self) -> frozenset[str]:
        """The primitives of the user that rest on an open condition."""
        return frozenset(each for each in self.soft if isinstance(each, str))

    @cached_property
    def soft(self) -> frozenset[Signature | str]:
        """The helper predicates and primitives of the user that rest on an open condition."""
        found: set[Signature | str] = set()
        while (
            wider := {
                each
                for rule in self.rules
                if self.open_conditions(rule) or self._read(rule) & found
                for each in self._defined(rule)
            }
            - found
        ):
            found |= wider
        return frozenset(found)

    def text(self, asked: Iterable[str]) -> str:
        """The relaxed rules, and which names of some primitives may share a segment with which."""
        lines = [self._relaxed(number, rule) for number, rule in enumerate(self.rules)]
        written = {name for rule in self.rules if rule.body for name in named_by(rule)}
        lines += [f'_written("{name}").' for name in sorted(written)]
        rows = {name for rule in self.rules for name in _rows(rule)} & written
        lines += [f'_may(S,"{name}") :- fits(S,"{name}").' for name in sorted(rows)]
        lines += [f'_asked("{name}").' for name in asked]
        return "\n".join([*filter(None, lines), NAMING])

    def rests_on_open(self, rule: Statement) -> bool:
        """Whether a rule has an open condition, or reads what rests on one."""
        return bool(self.open_conditions(rule) or self._read(rule) & self.soft)

    def words_below(self, rule: Statement) -> str:
        """The open conditions on which a rule rests, its own or those of what it reads."""
        own = [each for each in self.open_conditions(rule) if not self.helpers & _signatures(each)]
        return ", ".join(anonymous(each.text) for each in own) or self.words(self._read(rule))

    def words(self, names: Iterable[Signature | str]) -> str:
        """The open conditions on which primitives or predicates rest, as they are written."""
        below = {*names}
        while (
            wider := {
                each
                for rule in self.rules
                if self._defined(rule) & below
                for each in self._read(rule)
            }
            - below
        ):
            below |= wider
        found = {
            anonymous(literal.text.removeprefix("not "))
            for rule in self.rules
            if self._defined(rule) & below
            for literal in self.open_conditions(rule)
            if not self.helpers & _signatures(literal)
        }
        return ", ".join(sorted(found))

    def _defined(self, rule: Statement) -> set[Signature | str]:
        found: set[Signature | str] = {*named_by(rule)}
        return found | ({each.signature for each in rule.heads} - {*AUTHORED})

    def _read(self, rule: Statement) -> set[Signature | str]:
        atoms = [atom for each in rule.body for atom in each.atoms]
        found: set[Signature | str] = {
            primitive_in(each) for each in atoms if each.signature == FITS
        }
        return found | ({each.signature for each in atoms} - {FITS})

    def _is_open(self, rule: Statement, literal: Literal, helpers: frozenset[Signature]) -> bool:
        if not literal.atoms:
            return False
        if literal.text in self.others[id(rule)] or literal.kind != "atom":
            return True
        signature = literal.atoms[0].signature
        if signature == FITS or signature in helpers:
            return False
        if signature in self.helpers:
            return True
        return literal.text in self.doubtful or signature in self.beyond

    def _bound(self, rule: Statement, helpers: frozenset[Signature]) -> set[str]:
        """The variables that have values, by decided conditions or by equations over those."""
        texts = [
            each.text
            for each in rule.body
            if each.kind == "atom" and not each.sign and not self._is_open(rule, each, helpers)
        ]
        bound = {name for each in (*texts, *self._home(rule)) for name in _variables(each)}
        while (
            wider := {
                name
                for left, right in equations(rule)
                for term, other in ((left, right), (right, left))
                if _variables(other) <= bound and _TERM.fullmatch(term)
                for name in _variables(term)
            }
            - bound
        ):
            bound |= wider
        return bound

    def _home(self, rule: Statement) -> list[str]:
        """That there is the segment which a rule is about."""
        return [
            f"segment({text},_,_)"
            for head in rule.heads
            for at, text in enumerate(arguments_of(head))
            if (head.signature, at) in self.slots
        ]

    def _relaxed(self, number: int, rule: Statement) -> str:
        """A rule with open conditions chosen freely; empty for what needs no such rule."""
        head = rule.heads[0]
        if not rule.body or not (
            head.signature == FITS
            or (head.signature in self.closed_helpers and head.signature in self.soft)
        ):
            return ""
        bound = self._bound(rule, self.closed_helpers)
        open_ = {each.text for each in self.open_conditions(rule)}
        decided = [each for each in rule.body if each.text not in open_]
        positive = [
            self._renamed(each) for each in decided if each.kind == "atom" and not each.sign
        ]
        equal = [f"{left} = {right}" for left, right in equations(rule)]
        base = [
            *self._home(rule),
            *positive,
            *(each for each in equal if _variables(each) <= bound),
        ]
        body, choices = [*base], ""
        for literal in rule.body:
            if literal.text in open_ and literal.kind == "atom":
                atom = _free(literal, bound, number)
                body.append(f"not {atom}" if literal.sign == 1 else atom)
                if literal.sign != 1:
                    choices += f"{{ {atom} }} :- {'; '.join(base) or '#true'}.\n"
            elif (
                literal.text not in {*open_, *equal}
                and _is_test(literal)
                and _variables(literal.text) <= bound
            ):
                body.append(self._renamed(literal))
        text = f"{choices}{self._head(head.text)} :- {'; '.join(body) or '#true'}."
        return anonymous(text)

    def _head(self, text: str) -> str:
        return re.sub(r"^(\w+)", lambda found: _RENAMED.get(found[1], f"_soft_{found[1]}"), text)

    def _renamed(self, literal: Literal) -> str:
        """A condition on a primitive or a helper of the user asks whether it may hold."""
        if literal.kind != "atom":
            return literal.text
        atom = literal.atoms[0]
        own = atom.signature == FITS and primitive_in(atom) in self.names
        soft = atom.signature in self.closed_helpers and atom.signature in self.soft
        if not (own or soft):
            return literal.text
        return literal.text.removesuffix(atom.text) + self._head(atom.text)


_RENAMED = {"fits": "_may"}


def _signatures(literal: Literal) -> set[Signature]:
    return {each.signature for each in literal.atoms}


def anonymous(text: str) -> str:
    """A rule's text with the anonymous variables that the parser has named."""
    return _ANONYMOUS.sub("_", text)


def _rows(rule: Statement) -> Iterator[str]:
    yield from (primitive_in(head) for head in rule.heads if head.signature == ROW)


def _is_test(literal: Literal) -> bool:
    """Whether it gives no variable a value: a comparison or a negated atom."""
    return literal.kind == "comparison" or (literal.kind == "atom" and bool(literal.sign))


def _free(literal: Literal, bound: set[str], number: int) -> str:
    """A condition as a free atom about what has values; other variables are constants of the rule.

    In a negated condition an anonymous variable stands for any of them.
    """
    atom = literal.atoms[0]
    arguments = [
        each if _variables(each) <= bound else f"any_{number}_{_ANONYMOUS.sub('', each).lower()}"
        if _VARIABLE.fullmatch(each) else "any"
        for each in split_arguments(atom.text)
    ]  # fmt: skip
    inside = f"({','.join(arguments)})" if atom.signature[1] else ""
    return f"_open_{atom.signature[0].lstrip('_')}{inside}"


def _variables(text: str) -> set[str]:
    return set(_VARIABLE.findall(_STRING.sub("", text)))
