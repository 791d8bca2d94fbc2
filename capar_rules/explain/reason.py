"""Nodes of an explanation: a sentence, its atom, and what the atom was derived from."""

from collections.abc import Iterator
from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Reason:
    """One node of an explanation."""

    sentence: str
    """Empty if no template describes this atom; then the nodes below it do."""

    atom: str
    rule: str
    """File and line of the rule; empty for a measurement and for a negated atom."""

    frames: tuple[int, int] | None
    """First and last frame of a measurement."""

    leading: bool
    """Whether the sentence belongs in the summary."""

    because: tuple["Reason", ...]

    repeated: bool = False
    """Whether some of what it was derived from stands where it is met first (``expanded_once``,
    ``without_repeats``)."""

    def with_sentences(self) -> "Reason":
        """The tree of the nodes that have a sentence, each subtree only once."""
        return _with_sentences(self, set())

    def without_repeats(self) -> "Reason":
        """The tree in which a sentence stands only where it is met first.

        Nodes below which others were left out are ``repeated``.
        """
        return _without_repeats(self, set())

    def expanded_once(self) -> "Reason":
        """The tree in which what an atom was derived from stands only where it is met first.

        A derivation shares its parts, so written out in full it may have 10,000 times as many
        nodes as it has atoms.
        """
        return _expanded_once(self, set())

    def walk(self) -> Iterator["Reason"]:
        """This node and all below it, from the top, each once."""
        passed, waiting = set[int](), [self]
        while waiting:
            each = waiting.pop()
            if id(each) not in passed:
                passed.add(id(each))
                yield each
                waiting += reversed(each.because)


def _expanded_once(reason: Reason, known: set[str]) -> Reason:
    if reason.because and reason.atom in known:
        return replace(reason, because=(), repeated=True)
    known.add(reason.atom)
    below = tuple(_expanded_once(each, known) for each in reason.because)
    return replace(reason, because=below)


def _with_sentences(reason: Reason, known: set[str]) -> Reason:
    """The tree of sentences; a repeated sentence has nothing below it."""
    below: list[Reason] = []
    if reason.sentence not in known:
        known.add(reason.sentence)
        below = [_with_sentences(each, known) for each in _nearest(reason)]
    return replace(reason, because=tuple(below))


def _without_repeats(reason: Reason, known: set[str]) -> Reason:
    known.add(reason.sentence)
    below: list[Reason] = []
    for cause in reason.because:
        if cause.sentence not in known:
            below.append(_without_repeats(cause, known))
    return replace(reason, because=tuple(below), repeated=len(below) < len(reason.because))


def _nearest(reason: Reason) -> list[Reason]:
    """The nearest nodes with a sentence, in order, each sentence once."""
    found: dict[str, Reason] = {}
    waiting, passed = list(reversed(reason.because)), set()
    while waiting:
        each = waiting.pop()
        if each.sentence:
            found.setdefault(each.sentence, each)
        elif each.atom not in passed:
            passed.add(each.atom)
            waiting += reversed(each.because)
    return list(found.values())
