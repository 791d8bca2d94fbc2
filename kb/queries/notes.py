"""What ought to be known beside an answer: columns without values, actions not counted."""

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from pyoxigraph import Literal

from kb.queries.questions import Question, meant
from kb.store import sparql, statements

if TYPE_CHECKING:
    from kb.store.answers import Answer
    from kb.store.stores import Store

_NOTE = re.compile(
    r"""^\#\ Unless\ \?(?P<column>\w+)(?:\ =\ "(?P<value>[^"]+)")?:\ (?P<text>.+)$""",
    re.MULTILINE | re.VERBOSE,
)
_OF_SEGMENTS = frozenset(
    f"capar:{name}" for name in ("segment", "Segment", "address", "ofLink", "start", "namedBy")
)
"""Words of a query that leave segments alone."""

LOSS = "long-gap"
"""The notice of a body that was lost for a while."""

MOST_TOLD = 5
"""How many captures a note names."""

_ALWAYS = re.compile(r"^# Note: (?P<text>.+)$", re.MULTILINE)
_QUOTED = re.compile(r"""^(?:"([^"]*)"|'([^']*)')$""")


def notes(
    store: "Store", asked: Question, given: Mapping[str, object], answer: "Answer"
) -> Iterator[str]:
    """Sentences to be told beside the answer of a named question.

    A question's file says what is told unless a column has a value, or one certain value, in any
    row: ``# Unless ?recorded: no capture says when it was recorded``. What always is told stands
    after ``# Note:``.

    Args:
        store: What was asked.
        asked: The question.
        given: What it was asked of, by parameter.
        answer: Its rows.
    """
    named = [
        word
        for name in ("action", "other")
        if name in given
        for word in meant(name, str(given[name]))
    ]
    yield from uncounted(store, named)
    if not {"action", "kind"} & set(answer.variables):
        yield from _counted(store, named)
    if _mixes(store, asked, given, answer):
        yield "fingers, toes and other bodies count as well as hands: effector=hand for hands alone"
    if {"capture", "time"} <= given.keys() and "body" not in given:
        yield from _lost_then(store, str(given["capture"]), float(str(given["time"])))
    yield from (note["text"] for note in _ALWAYS.finditer(asked.query))
    for note in _NOTE.finditer(asked.query):
        held = _held(answer, note["column"])
        if answer.rows and (note["value"] not in held if note["value"] else not held):
            yield note["text"]


def notes_of_sparql(store: "Store", query: str, answer: "Answer") -> Iterator[str]:
    """Sentences to be told beside the answer of a query of one's own.

    Args:
        store: What was asked.
        query: The query.
        answer: Its rows.
    """
    pieces = [piece for piece in sparql.tokens(query) if piece.kind != "space"]
    words = {piece.text for piece in pieces}
    texts = (_QUOTED.match(piece.text) for piece in pieces if piece.kind == "string")
    named = [text[1] or text[2] or "" for text in texts if text]
    if "capar:fact" in words:
        yield from _lost(store, named)
    if "capar:kindOf" in words:
        yield from uncounted(store, named)
        yield from _counted(store, named)
    if "capar:action" in words and not words & _OF_SEGMENTS:
        yield (
            "capar:action is of joint actions, abilities and feature rows as well: "
            "?observation capar:segment ?s leaves segments alone"
        )
    for column in answer.variables:
        at = answer.variables.index(column)
        without = sum(row[at] is None for row in answer.rows)
        if without:
            rows = "any row" if without == len(answer.rows) else f"{without} of the rows"
            yield f"?{column} has no value in {rows} ({len(answer.rows)} in all)"


def _lost_then(store: "Store", capture: str, time_s: float) -> Iterator[str]:
    """Bodies that a capture had lost at a time."""
    query = f"""
SELECT DISTINCT ?name ?track {{
  ?seen capar:capture/capar:name {Literal(capture)} ; capar:link|capar:object ?of .
  ?of capar:name|capar:ee ?name ; capar:track ?track
}} ORDER BY ?name"""
    for name, track in store.ask(sparql.complete(query)).rows:
        if isinstance(name, Literal) and isinstance(track, Literal):
            lost_s = statements.track_of(track.value).lost_around(time_s)
            if lost_s is not None:
                yield (
                    f"{name.value!r} is lost from {lost_s[0]:.2f} to {lost_s[1]:.2f} s: what is "
                    "told of it then is assumed to have gone on, and the rest of it is unknown"
                )


def _lost(store: "Store", named: Iterable[str]) -> Iterator[str]:
    """Bodies that a query names and that were lost: facts about them end and begin anew."""
    for name in dict.fromkeys(named):
        query = f"""
SELECT DISTINCT ?capture {{
  ?seen a capar:Observation ; rdfs:label ?capture ; capar:notice ?notice .
  ?notice capar:noticeCode {Literal(LOSS)} ; capar:message ?message .
  FILTER(STRSTARTS(?message, {Literal(f"{name!r} was lost ")}))
}} ORDER BY ?capture"""
        rows = store.ask(sparql.complete(query)).rows
        where = [term.value for (term,) in rows if isinstance(term, Literal)]
        if where:
            more = f" and {len(where) - MOST_TOLD} others" if len(where) > MOST_TOLD else ""
            yield (
                f"{name!r} was lost for a while in {', '.join(where[:MOST_TOLD])}{more}: "
                "facts about it end, and begin anew, where it was lost (capar query notices)"
            )


def uncounted(store: "Store", named: Iterable[str]) -> Iterator[str]:
    """Actions whose names begin like one that was asked for, but which are no kinds of it.

    Args:
        store: What was asked.
        named: The actions that were asked for.
    """
    asked = [name for name in dict.fromkeys(named) if name]
    for name in asked:
        query = f"""
SELECT DISTINCT ?other {{
  ?known a capar:Action ; capar:name {Literal(name)} .
  ?beside a capar:Action ; capar:name ?other . FILTER(STRSTARTS(?other, {Literal(name)}))
  FILTER NOT EXISTS {{ ?beside capar:kindOf ?known }}
  FILTER EXISTS {{ ?kind capar:kindOf ?beside . ?segment capar:action ?kind }}
}} ORDER BY ?other"""
        rows = store.ask(sparql.complete(query)).rows
        others = [term.value for (term,) in rows if isinstance(term, Literal)]
        left_out = [other for other in others if other not in asked]
        if left_out:
            are = "is no kind" if len(left_out) == 1 else "are no kinds"
            yield (
                f"{' and '.join(left_out)} {are} of {name} and not counted; "
                f"ask for both ({name},{','.join(left_out)}) if you mean them too"
            )


def _mixes(store: "Store", asked: Question, given: Mapping[str, object], answer: "Answer") -> bool:
    """Whether an answer counts what other end-effectors than hands did, and does not show it."""
    takes = {parameter.name for parameter in asked.parameters}
    told = {"effector", "ee", "address"} & given.keys() or {"ee", "address", "first"} & set(
        answer.variables
    )
    if "effector" not in takes or told:
        return False
    others = "?link capar:effectorType ?kind FILTER(?kind != 'hand') ?segment capar:ofLink ?link"
    return bool(store.ask(sparql.complete(f"ASK {{ {others} }}")).boolean)


def _counted(store: "Store", named: Iterable[str]) -> Iterator[str]:
    """The kinds of actions that were asked for, where the answer does not show them."""
    for name in named:
        query = f"""
SELECT DISTINCT ?other {{
  ?kind capar:kindOf/capar:name {Literal(name)} ; capar:name ?other .
  FILTER(?other != {Literal(name)}) FILTER EXISTS {{ ?segment capar:action ?kind }}
}} ORDER BY ?other"""
        rows = store.ask(sparql.complete(query)).rows
        others = [term.value for (term,) in rows if isinstance(term, Literal)]
        if others:
            yield f"{name} counts its kinds as well: {', '.join(others)}"


def _held(answer: "Answer", column: str) -> set[str]:
    at = answer.variables.index(column)
    terms = (row[at] for row in answer.rows)
    return {term.value for term in terms if isinstance(term, Literal)}
