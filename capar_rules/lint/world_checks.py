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
    reached,
    signatures_below,
    split_arguments,
    stated,
    towards,
)
from capar_rules.lint.audit import (
    ASKED,
    EMPTY,
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
from capar_rules.lint.word_checks import FITTED, STRING, about_others, arguments_of, segment_slots

ROW = ("feature_row", 6)
BATCH = 50
"""Worlds for each call of the solver: with 400 a search of 6 s takes over 30 s."""

FEW_OF = 20
"""One world in so many is asked first whether a rule fires, as most fire in some of them."""

MOST_RIVALS = 5
"""How many rivals an ambiguity lists."""

_ANONYMOUS = re.compile(r"\bAny\d+\b")
_VARIABLE = re.compile(r"(?<![\w\"])_*[A-Z]\w*'*")
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\b_*[A-Z]\w*')


def named_by(rule: Statement) -> list[str]:
    """The primitives that a rule or a row of the feature table makes fit."""
    heads = [each for each in rule.heads if each.signature in (FITS, ROW)]
    return [name for each in heads if (name := primitive_in(each))]


def primitive_in(atom: Atom) -> str:
    """The primitive in an atom of fits, primitive or feature_row; empty if none."""
    written = split_arguments(atom.text)[1 if atom.signature == FITS else 0]
    return written.strip('"') if STRING.fullmatch(written) else ""


def worlds_of(rule: Statement, own: Mapping[str, Worlds], extents: Extents) -> Worlds:
    """The worlds in which a rule can fire, at most: where all primitives fit that it asks for."""
    worlds = every_world()
    others = about_others(rule, [FITTED])
    for literal in rule.body:
        if literal.kind == "atom" and not literal.sign and literal.atoms[0].signature == FITS:
            name = primitive_in(literal.atoms[0])
            if literal.text not in others:
                worlds &= own.get(name, extents.fits.get(name, worlds))
    return worlds


@dataclass(frozen=True)
class Trial:
    """The rules of one file of a user, beside those of others, on top of a shipped rule base.

    A condition is left open if the worlds of the audit cannot decide it: it is about another
    segment, an aggregate, or rests on measurements that no world contains.
    """

    own: Sequence[Statement]
    base: Known
    """The shipped rule base."""

    beside: Sequence[Statement] = ()
    """The rules of the user's other files."""

    @cached_property
    def rules(self) -> Mapping[int, Statement]:
        """The rules of the file by their index, then those beside it."""
        every = enumerate((*self.own, *self.beside))
        return {at: rule for at, rule in every if rule.kind == "rule" and rule.heads}

    @cached_property
    def others(self) -> Sequence[Statement]:
        """All rules but the file's own."""
        return (*self.base.rules, *self.beside)

    @cached_property
    def extents(self) -> Extents:
        """Where shipped primitives can fit."""
        return extents_of(self.base.rules)

    @cached_property
    def candidates(self) -> Mapping[str, Worlds]:
        """Where each primitive of the user can fit, at most."""
        rules = (*self.own, *self.beside)
        wider: dict[str, Worlds] = {name: frozenset() for rule in rules for name in named_by(rule)}
        found: dict[str, Worlds] = {}
        while wider != found:
            found = dict(wider)
            for rule in rules:
                for name in named_by(rule):
                    wider[name] |= worlds_of(rule, found, self.extents)
        return found

    @cached_property
    def names(self) -> Mapping[str, Place]:
        """The primitives of the file, and where each is declared."""
        heads = (head for each in self.own for head in each.heads)
        return {
            split_arguments(head.text)[0].strip('"'): head.place
            for head in heads
            if head.signature == ("primitive", 1)
        }

    @cached_property
    def worlds(self) -> Worlds:
        """Where some primitive of the file can fit."""
        return frozenset().union(*(self.candidates.get(name, ()) for name in self.names))

    @cached_property
    def generals(self) -> Mapping[str, set[str]]:
        """For each primitive of the file, those that it specialises, directly or not."""
        pairs = stated((*self.own, *self.others), ("specialises", 2))
        return {name: reached(name, pairs) for name in self.names}

    def ask(
        self, probes: str, asked: Iterable[Signature], worlds: Worlds | None = None
    ) -> frozenset[Derived]:
        """Which of these atoms the probes derive in some world; of all worlds if none are named.

        Raises:
            RuleError: The rules have an error.
        """
        if not probes:
            return frozenset()
        rules = [*self.others, *self.own, *parse_text(probes)]
        return evaluate(rules, tuple(asked), limbs=worlds, batch=BATCH)

    def unmeasured(self, signatures: Iterable[Signature]) -> tuple[Signature, ...]:
        """The measurements below predicates that no world contains."""
        defined = heads_of((*self.others, *self.own))
        return tuple(
            sorted((self._below(signatures) & self.base.measured) - given_in_audit() - defined)
        )

    def _below(self, signatures: Iterable[Signature]) -> frozenset[Signature]:
        """Predicates and what they depend on, down to what the worlds define."""
        below, given = frozenset(signatures), given_in_audit()
        slice_ = towards([*self.others, *self.own], below - given, given=given)
        return below | signatures_below(each for each in slice_ if each.kind == "rule")

    @cached_property
    def beyond(self) -> Mapping[int, tuple[Signature, ...]]:
        """For each rule, the measurements that it depends on and no world contains."""
        return {at: self.unmeasured(signatures_below([each])) for at, each in self.rules.items()}

    @cached_property
    def joined(self) -> Mapping[int, frozenset[str]]:
        """For each rule, its conditions about other segments than its own: a world has one."""
        slots = segment_slots([*self.base.rules, *self.rules.values()]) | {FITTED}
        return {at: about_others(rule, slots) for at, rule in self.rules.items()}

    @cached_property
    def stated(self) -> "LeftOpen":
        """What is left open by the text of the rules."""
        return LeftOpen(self, frozenset())

    @cached_property
    def open(self) -> "LeftOpen":
        """What is left open, with conditions that hold in no world though they may elsewhere."""
        doubtful = frozenset(self.missing.values())
        return LeftOpen(self, doubtful) if doubtful else self.stated

    @cached_property
    def atoms(self) -> frozenset[Derived]:
        """Which rules fire and which names fit, win and meet, where the file's primitives can."""
        judged = {
            at: rule
            for at, rule in self.rules.items()
            if not self.beyond[at] and not self.joined[at]
        }
        text = firing_probes(judged)
        for name in sorted({*self.names}.union(*self.generals.values())):
            text += (
                f'_fitted("{name}") :- fits(_,"{name}").\n_wins("{name}") :- named(_,"{name}").\n'
                f'_rival("{name}",N) :- named(S,"{name}"), named(S,N), N != "{name}".\n'
            )
        asked = [("_fired", 1), ("_idle", 1), ("_row", 1)]
        return self.ask(
            text, [*asked, ("_fitted", 1), ("_rival", 2), ("_wins", 1)], self.worlds
        ) | {("_judged", (at,)) for at in judged}

    def of(self, predicate: str) -> set[object]:
        """The first arguments of the atoms of a probe."""
        return {row[0] for name, row in self.atoms if name == predicate}

    @cached_property
    def unfired(self) -> Mapping[int, Statement]:
        """The judged rules that fire in no world."""
        fired = self.of("_fired")
        unfired = {at: self.rules[at] for at in sorted(map(int, map(str, self.of("_judged"))))}
        unfired = {at: each for at, each in unfired.items() if each.body and at not in fired}
        rest = sorted(every_world() - self.worlds)
        for worlds in (frozenset(rest[::FEW_OF]), frozenset(rest) - {*rest[::FEW_OF]}):
            elsewhere = {
                at: rule
                for at, rule in unfired.items()
                if at not in fired
                and (rule.heads[0].signature != FITS or at >= len(self.own))
                and not self.stated.rests_on_open(at)
            }
            found = self.ask(firing_probes(elsewhere), (("_fired", 1),), worlds)
            fired |= {row[0] for _, row in found}
        return {at: rule for at, rule in unfired.items() if at not in fired}

    @cached_property
    def missing(self) -> Mapping[int, str]:
        """For rules that never fire, a condition of which the worlds have few cases or none."""
        found: dict[int, str] = {}
        for at, rule in self.unfired.items():
            for each in () if self.stated.rests_on_open(at) else rule.body:
                signature = each.atoms[0].signature if each.atoms else FITS
                if each.kind == "atom" and not each.sign and signature != FITS:
                    chosen = self._below([signature]) & chosen_in_audit()
                    if chosen or signature in EMPTY or signature not in given_in_audit():
                        found.setdefault(at, each.text)
        return found

    @cached_property
    def rivals(self) -> tuple[Mapping[str, list[str]], Mapping[str, list[str]]]:
        """Who surely names a segment with each primitive of the file, and who possibly does.

        The primitives of the user come first.
        """
        soft = self.open.soft
        sure = {row for each, row in self.atoms if each == "_rival" and not soft & {*row}}
        probes = self.open.text() if any(isinstance(each, str) for each in soft) else ""
        possible = {row for _, row in self.ask(probes, (("_overlap", 2),), self.worlds)}
        return self._by_first(sure), self._by_first(possible - sure)

    def _by_first(self, pairs: Iterable[tuple[object, ...]]) -> Mapping[str, list[str]]:
        found: dict[str, list[str]] = {}
        named = sorted(tuple(map(str, pair)) for pair in pairs)
        for name, other in sorted(named, key=lambda pair: pair[1] in self.base.primitives):
            found.setdefault(name, []).append(other)
        return found


def firing_probes(rules: Mapping[int, Statement]) -> str:
    """Whether each rule fires in some segment, and whether a rule of fits does not in some."""
    text = ""
    for number, rule in rules.items():
        head = rule.heads[0]
        if rule.body:
            body = "; ".join(each.text for each in rule.body)
            text += f"_fired({number}) :- {body}.\n"
            if head.signature == FITS:
                segment = split_arguments(head.text)[0]
                text += f"_fired({number},{segment}) :- {body}.\n"
                text += f"_idle({number}) :- segment(S,_,_); not _fired({number},S).\n"
        elif head.signature == ROW:
            features = ",".join(split_arguments(head.text)[2:])
            text += f"_row({number}) :- features(_,{features}).\n"
    return text


NAMING = """
_under(S,N) :- _may(S,N), _may(S,M), more_general(M,N,_).
_under(S,N) :- _may(S,N), _may(S,M), precedes(M,N).
_top(S,N) :- _may(S,N), not _under(S,N).
_overlap(N,M) :- _asked(N), _top(S,N), _top(S,M), N != M.
_may(S,N) :- fits(S,N), not _written(N).
"""


class LeftOpen:
    """The conditions of a user's rules that the worlds cannot decide, and what rests on them."""

    def __init__(self, trial: Trial, doubtful: frozenset[str]) -> None:
        """Find them."""
        self.trial = trial
        rules = trial.rules
        read = signatures_below(rules.values()) - {FITS}
        beyond = {each for each in read if trial.unmeasured([each])}
        self.soft: set[Signature | str] = set()
        """Predicates and primitives of the user that rest on an open condition."""

        self.conditions: Mapping[int, Sequence[Literal]] = {}
        wider: set[Signature | str] = {*beyond}
        while wider - self.soft or len(self.conditions) < len(rules):
            self.soft |= wider
            self.conditions = {
                at: [
                    each
                    for each in rule.body
                    if each.atoms
                    and (
                        each.kind != "atom"
                        or each.text in trial.joined[at] | doubtful
                        or each.atoms[0].signature in self.soft
                    )
                ]
                for at, rule in rules.items()
            }
            resting = [rule for at, rule in rules.items() if self.rests_on_open(at)]
            wider = {*(heads_of(resting) - {*AUTHORED})}
            wider |= {name for rule in resting for name in named_by(rule)}

    def rests_on_open(self, at: int) -> bool:
        """Whether a rule has an open condition, or asks for a primitive that rests on one."""
        atoms = (atom for each in self.trial.rules[at].body for atom in each.atoms)
        names = {primitive_in(each) for each in atoms if each.signature == FITS}
        return bool(self.conditions[at] or names & self.soft)

    def words(self, names: Iterable[str]) -> str:
        """The open conditions in the rules for some primitives, as they are written."""
        wanted = {*names}
        found = {
            _ANONYMOUS.sub("_", each.text.removeprefix("not "))
            for at, rule in self.trial.rules.items()
            if wanted & {*named_by(rule)}
            for each in self.conditions[at]
        }
        return ", ".join(sorted(found))

    def text(self) -> str:
        """Rules by which primitives may fit, open conditions being chosen freely."""
        rules = self.trial.rules
        own = {name for rule in rules.values() for name in named_by(rule)}
        bodies = {name for rule in rules.values() if rule.body for name in named_by(rule)}
        rows = {name for each in rules.values() if not each.body for name in named_by(each)}
        lines = [self._relaxed(at) for at, rule in rules.items() if rule.body and named_by(rule)]
        lines += [f'_written("{name}").' for name in sorted(bodies & own)]
        lines += [f'_may(S,"{name}") :- fits(S,"{name}").' for name in sorted(rows & bodies)]
        lines += [f'_asked("{name}").' for name in self.trial.names]
        return "\n".join([*lines, NAMING])

    def _relaxed(self, at: int) -> str:
        """A rule of fits, with free atoms of what has a value in place of open conditions."""
        rule, opened = self.trial.rules[at], {each.text for each in self.conditions[at]}
        segment = arguments_of(rule.heads[0])[0]
        decided = [each for each in rule.body if each.text not in opened]
        binding = [each for each in decided if each.kind == "atom" and not each.sign]
        base = [f"segment({segment},_,_)", *map(self._renamed, binding)]
        bound = {name for each in base for name in _variables(each)}
        base += [
            each.text if each.kind == "comparison" else self._renamed(each)
            for each in decided
            if each not in binding and _variables(each.text) <= bound
        ]
        body, choices = [*base], ""
        for each in self.conditions[at]:
            if each.kind == "atom":
                atom = _free(each, bound, at)
                body.append(f"not {atom}" if each.sign == 1 else atom)
                if each.sign != 1:
                    choices += f"{{ {atom} }} :- {'; '.join(base)}.\n"
        head = rule.heads[0].text.replace("fits(", "_may(", 1)
        return _ANONYMOUS.sub("_", f"{choices}{head} :- {'; '.join(body)}.")

    def _renamed(self, literal: Literal) -> str:
        """A condition on a primitive of the user asks whether it may hold."""
        atoms = literal.atoms
        own = atoms and atoms[0].signature == FITS and primitive_in(atoms[0])
        return re.sub(r"\bfits\(", "_may(", literal.text) if own in self.soft else literal.text


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
    return set(_VARIABLE.findall(STRING.sub("", text)))


def rivals(
    name: str, own: Sequence[Statement], base: Known, beside: Sequence[Statement] = ()
) -> tuple[str, ...]:
    """The primitives that name a segment with one of a file's, neither the more specific; sorted.

    Those that may do so, by conditions that the worlds of the audit do not contain, are among them.
    """
    found = {other for each in Trial(own, base, beside).rivals for other in each.get(name, ())}
    return tuple(sorted(found, key=lambda each: (each in base.primitives, each)))


def world_findings(
    own: Sequence[Statement], base: Known, beside: Sequence[Statement] = ()
) -> Iterator[Finding]:
    """Rules that can never fire or always do, and names that clash with others or shadow them."""
    trial = Trial(own, base, beside)
    for at in trial.rules:
        if at < len(own):
            yield from _firing(trial, at)
    yield from _clashes(trial)
    yield from _shadows(trial)


def _firing(trial: Trial, at: int) -> Iterator[Finding]:
    """Whether a rule never fires, always does, or cannot be judged."""
    rule = trial.rules[at]
    why = ""
    if trial.beyond[at]:
        what = ", ".join(f"{name}/{arity}" for name, arity in trial.beyond[at])
        why = f"it depends on {what}"
    elif trial.joined[at]:
        why = "it joins more than one segment"
    elif at in trial.missing:
        why = f"it depends on {_ANONYMOUS.sub('_', trial.missing[at])}"
    elif at in trial.unfired and trial.open.rests_on_open(at):
        words = ", ".join(_ANONYMOUS.sub("_", each.text) for each in trial.open.conditions[at])
        why = f"it depends on {words or 'primitives that depend on measurements'}"
    if why:
        yield Finding(
            rule.place, "not-judged", f"whether it can fire was not checked: {why}, "
            "which the worlds of the audit do not contain.",
            "Give the file examples that it must and must not match.", NOTE,
        )  # fmt: skip
        return
    row = rule.heads[0].signature == ROW and not rule.body
    if at in trial.unfired or (row and at not in trial.of("_row")):
        arguments = [each.strip('"') for each in split_arguments(rule.heads[0].text)]
        asked = "what it asks for" if rule.body else f"the features {', '.join(arguments[2:])}"
        yield Finding(
            rule.place, "never-fires",
            f"this rule can never fire: no segment has {asked}.",
            "`capar rules audit` lists the feature sets that segments can have.",
        )  # fmt: skip
    elif (
        rule.body
        and rule.heads[0].signature == FITS
        and at not in trial.of("_idle")
        and worlds_of(rule, trial.candidates, trial.extents) == every_world()
    ):
        yield Finding(
            rule.place, "always-fires", "this rule always fires: every segment fits it.",
            "Add a condition, such as features(Segment, Start, End, Change, Force).",
        )  # fmt: skip


def _clashes(trial: Trial) -> Iterator[Finding]:
    """Primitives of the file that name a segment together with another one, or may do so."""
    for name, place in trial.names.items():
        for found, sure in zip(trial.rivals, (True, False), strict=True):
            if others := found.get(name):
                rest = len(others) - MOST_RIVALS
                more = f" and {rest} more" if rest > 0 else ""
                words = trial.open.words([name, *others])
                why = "neither is the more specific" if sure else (
                    "only conditions that the worlds of the audit do not contain could keep them "
                    f"apart ({words})"
                )  # fmt: skip
                yield Finding(
                    place, "ambiguous",
                    f"{name} and {', '.join(others[:MOST_RIVALS])}{more} "
                    f"{'' if sure else 'may '}name the same segments, and {why}.",
                    f'If {name} is a kind of {others[0]}, say specialises("{name}", "{others[0]}")'
                    f'; if not, say precedes("{name}", "{others[0]}"), or add a condition that '
                    f'keeps them apart, such as not fits(Segment, "{others[0]}"). To put it before '
                    f"all of them: capar rules add {Path(place.file).name} --over all.",
                )  # fmt: skip


def _shadows(trial: Trial) -> Iterator[Finding]:
    """Primitives of the file that never win, and more general ones that win no more.

    Of those that rest on conditions outside the worlds nothing is said.
    """
    fitted, wins = trial.of("_fitted"), trial.of("_wins")
    for name, place in trial.names.items():
        if name in trial.open.soft or name not in fitted:
            continue
        if name not in wins:
            yield Finding(
                place, "shadowed", f"{name} never names a segment: others are always more "
                "specific.", "Remove what specialises it, or add a case of its own.",
            )  # fmt: skip
        compares = any(
            each.kind == "comparison" and re.search("[<>]", each.text)
            for rule in trial.own
            if name in named_by(rule)
            for each in rule.body
        )  # of numbers the worlds have few
        for over in sorted((trial.generals[name] & {*map(str, fitted - wins)}) - {*trial.names}):
            if not _wins_elsewhere(trial, over):
                yield Finding(
                    place, "shadows", f"with {name}, {over} never names a segment any more: every "
                    "segment that fits it fits something more specific.",
                    f"Add a condition to {name} that some segments of {over} lack, or add {name} "
                    f"in place of {over}.", NOTE if compares else ERROR,
                )  # fmt: skip


def _wins_elsewhere(trial: Trial, name: str) -> bool:
    """Whether a primitive names a segment in a world in which none of the file's can fit."""
    named = trial.candidates.get(name, trial.extents.named.get(name, every_world()))
    rest = named - trial.worlds
    if name in trial.extents.named and rest.difference(*trial.candidates.values()):
        return True
    return bool(trial.ask(f'_wins("{name}") :- named(_,"{name}").', (("_wins", 1),), rest))


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
    soft = Trial(added, known(base)).open.soft if added else set()
    return summarise(evaluate(rules, ASKED), undecided=soft)
