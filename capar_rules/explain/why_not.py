"""Why a segment does not have another name: the fewest changes that would give it that name."""

from collections.abc import Iterable
from dataclasses import dataclass

from capar.model.errors import RuleError, UnknownNameError
from capar.model.observation import Segment
from capar_rules.engine.solver import Atom, optima
from capar_rules.explain.clock import Clock
from capar_rules.explain.counterfactuals import measured, worlds_of
from capar_rules.explain.explanation import Explainer
from capar_rules.lint.text_checks import known

BEYOND = "Contacts, possession and motion as they were do not settle what it is called."


@dataclass(frozen=True)
class Change:
    """One atom that would have to change."""

    holds: bool
    """Whether the atom would hold; otherwise it would cease to hold."""

    atom: str
    sentence: str


@dataclass(frozen=True)
class Alternative:
    """Changes that together would give the segment another name."""

    name: str
    changes: tuple[Change, ...]
    """Empty if the segment has that name in no possible world; then ``note`` says why."""

    note: str = ""
    """What precedes the changes: that the name fits too, or that the reason lies elsewhere."""

    @property
    def sentence(self) -> str:
        """The whole, as a counterfactual."""
        only = "no more than " if self.note and self.changes else ""
        conditions = " and ".join(each.sentence for each in self.changes)
        would = f"It would be {only}{self.name} {conditions}." if self.changes else ""
        return f"{self.note} {would}".strip()


def why_not(
    explainer: Explainer, segment: Segment, name: str, *, limit: int = 1
) -> tuple[Alternative, ...]:
    """The smallest changes of what was measured that would give a segment a name.

    First it is proven that without a change the segment keeps its name.

    Args:
        explainer: The explainer of the segment's capture.
        segment: A segment of it.
        name: A name that it does not have.
        limit: Greatest number of equally small answers.

    Returns:
        One for each answer; none if no segment between these borders could be so named.

    Raises:
        UnknownNameError: No rule gives that name.
        RuleError: The segment has that name, or does not follow from these facts and rules.
    """
    base = explainer.base.statements
    primitives = known(base).primitives
    if name not in primitives:
        raise UnknownNameError("primitive", name, primitives)
    if name == segment.name:
        raise RuleError(f"segment {segment.index} of {segment.ee!r} is {name} already")
    text = worlds_around(explainer, segment)
    if not text:
        return (Alternative(name, (), BEYOND),)
    ticks = explainer.ticks(segment)
    term = _term(segment, ticks)
    goal = f':- not named({term},"{name}").'
    found = optima(f"{text}\n{goal}", [("changed", 2), ("dominant", 2)], limit=SPARE * limit)
    windows = explainer.windows
    ends = {(segment.ee, ticks[0]): ticks[1]}
    note = _note(segment, name)
    answers: dict[tuple[str, ...], Alternative] = {}
    for atoms in found:
        clock = Clock(windows.rate, windows.frames, ends, objects=_about(atoms, term))
        told = _alternative(name, note, atoms, explainer, clock)
        answers.setdefault(tuple(each.atom for each in told.changes), told)
    told_all = tuple(answers.values())[:limit]
    return told_all or ((Alternative(name, (), note),) if note else ())


SPARE = 3
"""Worlds to find for each answer, as some differ only in their objects."""


def _about(atoms: Iterable[Atom], term: str) -> dict[str, str]:
    """The object that the segment would be about, by its term."""
    found = sorted(str(each[1]) for name, each in atoms if name == "dominant")
    return {term: found[0]} if found else {}


def worlds_around(explainer: Explainer, segment: Segment) -> str:
    """The program of counterfactual worlds of a segment.

    Empty if in the world without changes the segment does not have its own name. It is the same
    for every other name, so the explainer keeps it.
    """
    if segment not in explainer.worlds:
        explainer.worlds[segment] = _worlds_around(explainer, segment)
    return explainer.worlds[segment]


def _worlds_around(explainer: Explainer, segment: Segment) -> str:
    base, ticks = explainer.base.statements, explainer.ticks(segment)
    term = _term(segment, ticks)
    called = f'named({term},"{segment.name}")' if segment.known else f"unknown({term})"
    for facts in explainer.windows_of(segment.ee, ticks):
        actual = measured(base, facts, segment, ticks)
        text = worlds_of(base, facts, actual, segment, ticks)
        if optima(f"{text}\n:- not {called}.\n:- changed(_,_).", [("changed", 2)]):
            return text
    return ""


def _term(segment: Segment, ticks: tuple[int, int]) -> str:
    return f"seg({segment.ee},{ticks[0]})"


def _note(segment: Segment, name: str) -> str:
    """That the other name fits too, if the segment's own name is more specific."""
    if name not in segment.general:
        return ""
    article = "an" if name[0] in "AEIOU" else "a"
    return f"It is {article} {name} too: {segment.name} is more specific."


def _alternative(
    name: str, note: str, atoms: Iterable[Atom], explainer: Explainer, clock: Clock
) -> Alternative:
    changes = []
    for bit, term in (each for predicate, each in atoms if predicate == "changed"):
        predicate, *arguments = map(_text, term) if isinstance(term, tuple) else [str(term)]
        mood = "had" if bit == 1 else "had not"
        told = explainer.base.sentences.tell(predicate, arguments, clock, mood=mood)
        atom = f"{predicate}({','.join(arguments)})" if arguments else predicate
        plainly = f"had it {'not ' * (bit != 1)}been so that {atom}"
        changes.append(Change(bit == 1, atom, told or plainly))
    return Alternative(name, tuple(sorted(changes, key=lambda each: each.atom)), note)


def _text(term: object) -> str:
    if isinstance(term, tuple):
        return f"{term[0]}({','.join(map(_text, term[1:]))})"
    return str(term)
