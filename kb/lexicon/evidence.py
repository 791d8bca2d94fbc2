"""What the stored observations show of primitives."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from kb.store.stores import Store
from ontology import CAPAR, PREFIXES


@dataclass(frozen=True, slots=True, order=True)
class Seen:
    """Segments of one observation that have one name and one purpose."""

    primitive: str
    """The most specific name of the segments."""

    observation: str
    count: int
    purpose: str = ""
    """What the user stated that they were for; empty where it only follows from what came next."""


@dataclass(frozen=True, slots=True, order=True)
class Case:
    """A shipped test case that shows a primitive."""

    primitive: str
    name: str


QUERY = f"""
PREFIX rdfs: <{PREFIXES["rdfs"]}>
SELECT ?name ?observation ?purpose (COUNT(DISTINCT ?segment) AS ?count) WHERE {{
  ?seen a {CAPAR.Observation} ; rdfs:label ?observation ; {CAPAR.segment} ?segment .
  ?segment a {CAPAR.Segment} .
  OPTIONAL {{ ?segment {CAPAR.action}/{CAPAR.name} ?name }}
  OPTIONAL {{
    ?segment {CAPAR.purpose} ?purpose .
    ?seen {CAPAR.fact} ?stated .
    ?stated a {CAPAR.Intended} ; {CAPAR.purpose} ?purpose ; {CAPAR.actionName} ?doing .
    FILTER (?doing = "any" || ?doing = ?name)
  }}
}} GROUP BY ?name ?observation ?purpose
"""


def seen_in(store: Store) -> tuple[Seen, ...]:
    """What every stored observation shows; segments that no rule names have an empty name."""
    rows = store.ask(QUERY).plain()
    return tuple(
        sorted(
            Seen(
                str(row["name"] or ""),
                str(row["observation"]),
                int(row["count"] or 0),
                str(row["purpose"] or ""),
            )
            for row in rows
            if row["observation"] is not None
        )
    )


def summed(seen: Iterable[Seen]) -> tuple[Seen, ...]:
    """The same with one count for each primitive and observation, whatever it was done for."""
    counts = Counter[tuple[str, str]]()
    for use in seen:
        counts[use.primitive, use.observation] += use.count
    return tuple(sorted(Seen(*key, count) for key, count in counts.items()))


def often(count: int) -> str:
    """How often, in figures from three on: ``once``, ``twice``, ``32 times``."""
    return {1: "once", 2: "twice"}.get(count, f"{count} times")


def total(seen: Iterable[Seen]) -> int:
    """The number of segments."""
    return sum(each.count for each in seen)
