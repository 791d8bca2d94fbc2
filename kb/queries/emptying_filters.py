"""Which of its filters leaves a named question without an answer: each is tried alone."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from pyoxigraph import Literal

from kb.queries.questions import Question, meant
from kb.store import sparql

if TYPE_CHECKING:
    from kb.store.answers import Answer
    from kb.store.stores import Store

MOST_VALUES = 12
"""How many values of a column are told that there would have been."""


def emptying_filters(store: "Store", asked: Question, given: Mapping[str, object]) -> Iterator[str]:
    """Sentences about the filters of a question that found nothing.

    Args:
        store: What was asked.
        asked: The question.
        given: What it was asked of, by parameter.
    """
    yield from _shapeless(store, asked, given)
    yield from _gazeless(store, asked, given)
    needed = {p.name: given[p.name] for p in asked.parameters if p.required and p.name in given}
    filters = {name: value for name, value in given.items() if name not in needed}
    if not filters or (len(given) == 1 and sparql.opens_tracks(asked.query)):
        return

    def found(chosen: Mapping[str, object]) -> "Answer":
        return store.ask(asked.bind({**needed, **chosen}))

    if needed and not found({}).rows:
        yield f"{_written(needed)} finds nothing, whatever the filters"
        return
    alone = {name: len(found({name: value}).rows) for name, value in filters.items()}
    tried = [f"{name}={value} alone finds {alone[name]}" for name, value in filters.items()]
    beside = f" (with {_written(needed)})" if needed else ""
    if len(filters) > 1 or beside:
        yield "; ".join(tried) + beside
    for name, value in filters.items():
        rest = {other: stated for other, stated in filters.items() if other != name}
        answer = found(rest)
        if answer.rows:
            there = f"without {name}={value} there are {len(answer.rows)}"
            yield there + _values(answer, name)


def _written(given: Mapping[str, object]) -> str:
    return " ".join(f"{name}={value}" for name, value in given.items())


def _values(answer: "Answer", column: str) -> str:
    """What a column of the answer holds, if it has one of that name."""
    if column not in answer.variables:
        return ""
    at = answer.variables.index(column)
    terms = (row[at] for row in answer.rows)
    held = sorted({term.value for term in terms if isinstance(term, Literal)})
    more = ", ..." if len(held) > MOST_VALUES else ""
    return f", of which {column} is {', '.join(held[:MOST_VALUES])}{more}"


def _gazeless(store: "Store", asked: Question, given: Mapping[str, object]) -> Iterator[str]:
    """Captures in which no gaze was recorded."""
    if "capar:LookingAt" not in asked.query or "capture" not in given:
        return
    name = Literal(str(given["capture"]))
    looks = f"?seen capar:capture/capar:name {name} ; capar:fact ?look . ?look a capar:LookingAt"
    if not store.ask(sparql.complete(f"ASK {{ {looks} }}")).boolean:
        yield f"{name.value} has no look at anything: its gaze was not recorded, or met nothing"


def _shapeless(store: "Store", asked: Question, given: Mapping[str, object]) -> Iterator[str]:
    """Things in which nothing can lie, as their shape is not known."""
    if "capar:Arrangement" not in asked.query and "capar:placement" not in asked.query:
        return
    for name in meant("object", str(given.get("object") or "")):
        fact = f"?x a capar:ShapelessObject ; capar:body/capar:name {Literal(name)}"
        if name and store.ask(sparql.complete(f"ASK {{ {fact} }}")).boolean:
            yield f"{name!r} has no shape here (capar:ShapelessObject), so nothing is inside it"
