"""When facts hold, also those that repeat only the first frame of another's interval."""

from collections.abc import Iterable

from capar.model.fact_kinds import Fact, Observed, Span
from capar.model.facts import ALL_FACT_KINDS

Interval = tuple[int, int]
"""First and last frame."""

_NAMED = frozenset(
    kind.declaration.span for kind in ALL_FACT_KINDS if not isinstance(kind.declaration.span, Span)
)
"""The kinds of intervals that other facts name by their first frames."""


class FactIntervals:
    """The intervals of the facts of one capture."""

    def __init__(self, facts: Iterable[Fact]) -> None:
        """Index the intervals that other facts name."""
        self._named: dict[tuple[object, ...], Interval] = {
            fact.name(type(fact)): _closed(fact.ends())
            for fact in facts
            if isinstance(fact, Observed) and type(fact) in _NAMED
        }

    def of(self, fact: Fact) -> Interval | None:
        """When a fact holds; None: always, or throughout an interval that no fact states."""
        if not isinstance(fact, Observed) or fact.declaration.span is Span.ALWAYS:
            return None
        if isinstance(fact.declaration.span, Span):
            return _closed(fact.ends())
        return self._named.get(fact.name(fact.declaration.span))


def _closed(frames: tuple[int, ...]) -> Interval:
    return frames[0], frames[-1]
