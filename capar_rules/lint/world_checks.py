"""What a file's rules do over every possible segment: whether they fire, clash or shadow."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from capar_rules.engine.profiles import Profile
from capar_rules.engine.profiles import profile as shipped
from capar_rules.engine.solver import Atom as Derived
from capar_rules.engine.syntax import (
    FITS,
    Atom,
    Literal,
    Place,
    Signature,
    Statement,
    heads_of,
    parse,
    parse_text,
    signatures_below,
    split_arguments,
    towards,
)
from capar_rules.lint.audit import (
    ASKED,
    Audit,
    Extents,
    Worlds,
    chosen_in_audit,
    evaluate,
    every_world,
    extents_of,
    given_in_audit,
    summarise,
)
from capar_rules.lint.findings import ERROR, NOTE, Finding
from capar_rules.lint.text_checks import AUTHORED, Known, known
from capar_rules.lint.word_checks import (
    FITTED,
    STRING,
    Slot,
    about_others,
    arguments_of,
    equations,
    segment_slots,
)

ROW = ("feature_row", 6)
SPECIALISES = ("specialises", 2)


def candidates(user: Sequence[Statement], extents: Extents) -> Mapping[str, Worlds]:
    """The worlds in which each primitive of a user can fit, at most.

    A rule fires only where every primitive fits that it asks for; other conditions are left out.
    """
    found: dict[str, Worlds] = {name: frozenset() for rule in user for name in named_by(rule)}
    while True:
        wider = dict(found)
        for rule in user:
            for name in named_by(rule):
                wider[name] |= worlds_of(rule, found, extents)
        if wider == found:
            return found
        found = wider


def worlds_of(rule: Statement, own: Mapping[str, Worlds], extents: Extents) -> Worlds:
    """The worlds in which a rule can fire, at most."""
    worlds = every_world()
    others = about_others(rule, [FITTED])
    for literal in rule.body:
        if literal.text in others:
            continue
        if literal.kind == "atom" and not literal.sign and literal.atoms[0].signature == FITS:
            name = primitive_in(literal.atoms[0])
            if name in own:
                worlds &= own[name]
            elif name in extents.fits:
                worlds &= extents.fits[name]
    return worlds


def named_by(rule: Statement) -> list[str]:
    """The primitives that a rule or a row of the feature table makes fit."""
    heads = [each for each in rule.heads if each.signature in (FITS, ROW)]
    return [name for each in heads if (name := primitive_in(each))]


def primitive_in(atom: Atom) -> str:
    """The primitive in an atom of fits, primitive, feature_row or specialises; empty if none."""
    written = split_arguments(atom.text)[1 if atom.signature == FITS else 0]
    return written.strip('"') if STRING.fullmatch(written) else ""


def generals(name: str, rules: Iterable[Statement]) -> set[str]:
    """The primitives that one specialises, whether directly or through others."""
    pairs = [
        tuple(each.strip('"') for each in split_arguments(head.text))
        for rule in rules
        for head in rule.heads
        if head.signature == SPECIALISES
    ]
    found: set[str] = set()
    while wider := {over for under, over in pairs if under in {name, *found}} - found:
        found |= wider
    return found


FIRED, IDLE, HELD, ROW_HELD = ("_fired", 1), ("_idle", 1), ("_held", 3), ("_row", 1)

_COMPUTES = re.compile(r"[-+*/\\|&?^~;]|\.\.")
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\b_*[A-Z]\w*')


def firing_probes(rules: Mapping[int, Statement]) -> Iterator[Statement]:
    """Whether each rule fires in some segment, and whether a rule of fits does not in some."""
    for number, rule in rules.items():
        head = rule.heads[0]
        if rule.body:
            body = "; ".join(each.text for each in rule.body)
            text = f"_fired({number}) :- {body}.\n"
            if head.signature == FITS:
                segment = split_arguments(head.text)[0]
                text += f"_fired({number},{segment}) :- {body}.\n"
                text += f"_idle({number}) :- segment(S,_,_); not _fired({number},S).\n"
            yield from parse_text(text)
        elif head.signature == ROW:
            features = ",".join(split_arguments(head.text)[2:])
            yield from parse_text(f"_row({number}) :- features(_,{features}).\n")


def holding_probes(conditions: Mapping[tuple[int, int], Atom]) -> Iterator[Statement]:
    """Whether conditions, each by its rule and index, hold anywhere, and their relations at all."""
    for (number, place), atom in conditions.items():
        name, arity = atom.signature
        text = f"_held({number},{place},so) :- {_loosened(atom.text)}.\n"
        if arity:
            text += f"_held({number},{place},any) :- {name}({','.join('_' * arity)}).\n"
        yield from parse_text(text)


def plain_conditions(rule: Statement) -> Iterator[tuple[int, Atom]]:
    """The positive conditions of a rule without arithmetic, each with its index."""
    for place, literal in enumerate(rule.body):
        if literal.kind == "atom" and literal.sign == 0:
            atom = literal.atoms[0]
            if not _COMPUTES.search(STRING.sub("", atom.text)):
                yield place, atom


def _loosened(text: str) -> str:
    """An atom's text with its variables anonymous."""
    return _TOKEN.sub(lambda found: found[0] if found[0].startswith('"') else "_", text)


def naming_probes(names: Iterable[str], watched: Iterable[str]) -> Sequence[Statement]:
    """Whether primitives fit, which others name a segment with them, and which ever name one."""
    text = ""
    for name in names:
        text += f'_fitted("{name}") :- fits(_,"{name}").\n'
        text += f'_rival("{name}",Other) :- named(S,"{name}"), named(S,Other), Other != "{name}".\n'
    text += "".join(f'_wins("{name}") :- named(_,"{name}").\n' for name in watched)
    return parse_text(text)


FITTED_NAME, RIVAL, WINS = ("_fitted", 1), ("_rival", 2), ("_wins", 1)

ASKED_OF_WORLDS: tuple[Signature, ...] = (FIRED, IDLE, ROW_HELD, FITTED_NAME, RIVAL, WINS)
"""What a check asks of each world: few atoms, as the search takes longer for each that is asked."""


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
    ) -> frozenset[Derived]:
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
    def atoms(self) -> frozenset[Derived]:
        """Which rules fire and which names fit, win and meet, where the file's primitives can."""
        trial = self.trial
        watched = {*trial.names, *(over for each in trial.generals.values() for over in each)}
        probes = [*firing_probes(self.judged), *naming_probes(sorted(watched), sorted(watched))]
        return trial.ask(probes, ASKED_OF_WORLDS, trial.worlds)

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


def numbers(atoms: Iterable[Derived], predicate: str) -> set[object]:
    """The rules, by index, of which a probe holds."""
    return {row[0] for name, row in atoms if name == predicate and len(row) == 1}


MOST_RIVALS = 5
"""How many rivals an ambiguity lists."""

PIECE = 30
"""How many worlds are searched at a time for one example."""

_ORDERS = ("<", ">")


def rivals(
    name: str, own: Sequence[Statement], base: Known, beside: Sequence[Statement] = ()
) -> tuple[str, ...]:
    """The primitives that name a segment with one of a file's, neither the more specific; sorted.

    Those that may do so, by conditions that the worlds of the audit do not contain, are among them.

    Args:
        name: The primitive of the file.
        own: The rules of the file.
        base: The shipped rule base.
        beside: The rules of the user's other files.
    """
    sharing = _sharing(Firing(Trial(own, base, beside)))
    found = {*sharing.surely.get(name, ()), *sharing.possibly.get(name, ())}
    return tuple(sorted(found, key=lambda each: (each in base.primitives, each)))


@dataclass(frozen=True)
class _Sharing:
    """Who names a segment with each primitive of a file, the primitives of the user first."""

    surely: Mapping[str, tuple[str, ...]]
    possibly: Mapping[str, tuple[str, ...]]
    """By conditions that the worlds of the audit do not contain."""

    unchecked: frozenset[str]
    """Primitives that fit no segment even with such conditions left open."""


def _sharing(firing: Firing) -> _Sharing:
    trial, relaxation = firing.trial, firing.relaxation
    sure = {(str(row[0]), str(row[1])) for each, row in firing.atoms if each == "_rival"}
    soft = relaxation.soft_names
    sure = {pair for pair in sure if not soft & {*pair}}
    if not soft:
        return _Sharing(_by_first(sure, trial), {}, frozenset())
    probes = parse_text(relaxation.text(trial.names))
    atoms = trial.ask(probes, (OVERLAP, COULD), trial.worlds)
    found = {(str(row[0]), str(row[1])) for each, row in atoms if each == OVERLAP[0]}
    could = {str(row[0]) for each, row in atoms if each == COULD[0]}
    unchecked = frozenset(trial.names) & soft - could
    return _Sharing(_by_first(sure, trial), _by_first(found - sure, trial), unchecked)


def _by_first(pairs: Iterable[tuple[str, str]], trial: Trial) -> Mapping[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    for name, other in sorted(pairs, key=lambda each: (each[1] in trial.base.primitives, each)):
        found.setdefault(name, []).append(other)
    return {name: tuple(others) for name, others in found.items()}


def clashes(firing: Firing) -> Iterator[Finding]:
    """Primitives of the file that name a segment together with another one, or may do so."""
    sharing = _sharing(firing)
    for name, place in firing.trial.names.items():
        remedy = (
            f"To put it before all of them: capar rules add {Path(place.file).name} --over all."
        )
        if others := sharing.surely.get(name):
            features = _shared_features(firing.trial, name, others[0])
            where = ", ".join(bit or "none" for bit in features)
            yield Finding(
                place, "ambiguous",
                f"{name} and {_told(others)} name the same segments, such as those with features "
                f"{where}, and neither is the more specific.",
                f"{apart(name, others[0])} {remedy}",
            )  # fmt: skip
        if others := sharing.possibly.get(name):
            words = firing.relaxation.words([name, *others])
            yield Finding(
                place, "ambiguous",
                f"{name} and {_told(others)} may name the same segments: what keeps them apart, if "
                f"anything does, are conditions that the worlds of the audit do not contain "
                f"({words}).",
                f"{apart(name, others[0])} {remedy}",
            )  # fmt: skip
        if name in sharing.unchecked:
            yield Finding(
                place, "clashes-unchecked",
                f"with which primitives {name} may share segments was not checked: no segment of "
                "the worlds of the audit fits it.",
                "Compare on captures: capar rules diff FILE --on CAPTURE.", NOTE,
            )  # fmt: skip


def _told(others: Sequence[str]) -> str:
    rest = len(others) - MOST_RIVALS
    return ", ".join(others[:MOST_RIVALS]) + (f" and {rest} more" if rest > 0 else "")


def apart(name: str, other: str) -> str:
    """How a primitive is told from another one."""
    return (
        f'If {name} is a kind of {other}, say specialises("{name}", "{other}"); if not, say '
        f'precedes("{name}", "{other}"), or add a condition that keeps them apart, such as '
        f'not fits(Segment, "{other}").'
    )


def _shared_features(trial: Trial, name: str, other: str) -> tuple[str, ...]:
    """The first feature set, in order, of the first worlds in which both name the segment."""
    (probe,) = parse_text(
        f'_shared(A,B,C,D) :- named(S,"{name}"), named(S,"{other}"), features(S,A,B,C,D).'
    )
    limbs = sorted(trial.worlds & trial.extent(other))
    for at in range(0, len(limbs), PIECE):
        found = trial.ask([probe], [("_shared", 4)], frozenset(limbs[at : at + PIECE]))
        if found:
            return min(tuple(map(str, row)) for _, row in found)
    return ()


def shadows(firing: Firing) -> Iterator[Finding]:
    """Primitives of the file that never win, and more general ones that win no more.

    Of those that rest on conditions outside the worlds nothing is said.
    """
    trial, atoms = firing.trial, firing.atoms
    fitted = {str(row[0]) for each, row in atoms if each == "_fitted"}
    wins = {str(row[0]) for each, row in atoms if each == "_wins"}
    for name, place in trial.names.items():
        if name in firing.relaxation.soft_names:
            continue
        if name in fitted - wins:
            yield Finding(
                place, "shadowed", f"{name} never names a segment: others are always more "
                "specific.", "Remove what specialises it, or add a case of its own.",
            )  # fmt: skip
        for over in sorted((trial.generals[name] & fitted) - wins - {*trial.names}):
            if name in fitted and not _wins_elsewhere(trial, over):
                yield Finding(
                    place, "shadows", f"with {name}, {over} never names a segment any more: every "
                    "segment that fits it fits something more specific.",
                    f"Add a condition to {name} that some segments of {over} lack, or add {name} "
                    f"in place of {over}.", NOTE if _compares(trial, name) else ERROR,
                )  # fmt: skip


def _wins_elsewhere(trial: Trial, name: str) -> bool:
    """Whether a primitive names a segment in a world in which none of the file's can fit."""
    rest = trial.extent(name) - trial.worlds
    if name in trial.extents.named and rest - trial.reach(trial.candidates):
        return True
    return bool(trial.ask(naming_probes([], [name]), (WINS,), rest))


def _compares(trial: Trial, name: str) -> bool:
    """Whether its rules compare numbers, of which the worlds have few."""
    return any(
        literal.kind == "comparison" and any(sign in literal.text for sign in _ORDERS)
        for rule in trial.own
        if name in named_by(rule)
        for literal in rule.body
    )


def world_findings(
    own: Sequence[Statement], base: Known, beside: Sequence[Statement] = ()
) -> Iterator[Finding]:
    """Rules that can never fire or always do, and names that clash with others or shadow them.

    Args:
        own: The rules of the file.
        base: The shipped rule base.
        beside: The rules of the user's other files.
    """
    firing = Firing(Trial(own, base, beside))
    mine = range(len(own))
    for at, words in firing.beyond.items():
        if words and at in mine:
            what = ", ".join(f"{name}/{arity}" for name, arity in words)
            yield _not_judged(firing.rules[at], f"it depends on {what}")
    for at, rule in firing.rules.items():
        if at in mine and not firing.beyond[at]:
            yield from _fired(firing, at, rule)
    yield from clashes(firing)
    yield from shadows(firing)


def _not_judged(rule: Statement, why: str) -> Finding:
    return Finding(
        rule.place, "not-judged", f"whether it can fire was not checked: {why}, "
        "which the worlds of the audit do not contain.",
        "Give the file examples that it must and must not match.", NOTE,
    )  # fmt: skip


def _fired(firing: Firing, at: int, rule: Statement) -> Iterator[Finding]:
    if firing.joined(rule):
        yield _not_judged(rule, "it joins more than one segment")
    elif at in firing.missing:
        yield _not_judged(rule, f"it depends on {anonymous(firing.missing[at])}")
    elif at in firing.unfired and firing.relaxation.rests_on_open(rule):
        yield _not_judged(rule, f"it depends on {firing.relaxation.words_below(rule)}")
    elif at in firing.unfired or _impossible_row(firing, at, rule):
        arguments = [each.strip('"') for each in split_arguments(rule.heads[0].text)]
        what = "what it asks for" if rule.body else f"the features {', '.join(arguments[2:])}"
        yield Finding(
            rule.place, "never-fires",
            f"this rule can never fire: no segment has {what}.",
            "`capar rules audit` lists the feature sets that segments can have.",
        )  # fmt: skip
    elif rule.body and is_fits(rule) and _always(firing, at, rule):
        yield Finding(
            rule.place, "always-fires", "this rule always fires: every segment fits it.",
            "Add a condition, such as features(Segment, Start, End, Change, Force).",
        )  # fmt: skip


def _impossible_row(firing: Firing, at: int, rule: Statement) -> bool:
    """Whether it is a row of the feature table that no segment has."""
    row = rule.heads[0].signature == ("feature_row", 6)
    return row and not rule.body and at not in numbers(firing.atoms, "_row")


def _always(firing: Firing, at: int, rule: Statement) -> bool:
    """Whether a rule of fits fires in every world."""
    everywhere = worlds_of(rule, firing.trial.candidates, firing.trial.extents) == every_world()
    return everywhere and at not in numbers(firing.atoms, "_idle")


def audit(profile: Profile) -> Audit:
    """Audit the rules of a profile.

    Primitives of users with conditions that the worlds cannot decide are told apart from those
    that no segment can fit.

    Raises:
        RuleError: The rules have an error.
    """
    rules = parse(profile.files)
    base = parse(shipped(profile.name).files)
    files = {each.place.file for each in base}
    added = [each for each in rules if each.place.file not in files]
    soft = Firing(Trial(added, known(base))).relaxation.soft_names if added else frozenset()
    return summarise(evaluate(rules, ASKED), undecided=soft)
