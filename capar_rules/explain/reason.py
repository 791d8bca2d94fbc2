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

    def with_sentences(self) -> "Reason":
        """The tree of the nodes that have a sentence, each subtree only once."""
        return _with_sentences(self, set())

    def walk(self) -> Iterator["Reason"]:
        """This node and all below it, from the top."""
        yield self
        for each in self.because:
            yield from each.walk()


def _with_sentences(reason: Reason, known: set[str]) -> Reason:
    """The tree of sentences; a repeated sentence has nothing below it."""
    below: list[Reason] = []
    if reason.sentence not in known:
        known.add(reason.sentence)
        below = [_with_sentences(each, known) for each in _nearest(reason)]
    return replace(reason, because=tuple(below))


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
