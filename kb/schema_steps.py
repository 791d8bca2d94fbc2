"""The updates that bring a store of an older schema to the present one, one step a version."""

from collections.abc import Callable, Mapping

from pyoxigraph import NamedNode

from kb.schema_2 import from_2
from kb.store import schema
from kb.store.stores import Store
from ontology import CAPAR

_ADDRESSES = f"""INSERT {{ GRAPH ?graph {{ ?segment {CAPAR.address} ?address }} }}
WHERE {{
  GRAPH ?graph {{
    ?graph {CAPAR.capture}/{CAPAR.name} ?capture ; {CAPAR.segment} ?segment .
    ?segment {CAPAR.ee} ?ee ; {CAPAR.index} ?index .
  }}
  BIND(CONCAT(?capture, "/", ?ee, "/", STR(?index)) AS ?address)
}}"""


def from_1(store: Store) -> tuple[str, ...]:
    """The updates to version 2: each segment gets its address."""
    del store
    return (_ADDRESSES,)


_OF_ACTIONS = f"""DELETE {{ GRAPH ?graph {{ ?node {CAPAR.action} ?action }} }}
INSERT {{ GRAPH ?graph {{ ?node {CAPAR.ofAction} ?action }} }}
WHERE {{
  VALUES ?kind {{
    {CAPAR.Step} {CAPAR.ComplexStep} {CAPAR.Call} {CAPAR.ConstraintLocation} {CAPAR.AgentStyle}
  }}
  GRAPH ?graph {{ ?node a ?kind ; {CAPAR.action} ?action }}
}}"""

_TIMELESS = f"""INSERT {{
  GRAPH ?graph {{ ?contact {CAPAR.heldFor} 0.0e0 ; {CAPAR.movedFor} 0.0e0 }}
}}
WHERE {{
  GRAPH ?graph {{
    ?graph {CAPAR.link} ?link .
    ?contact a {CAPAR.Touching} ; {CAPAR.body} ?link .
  }}
}}"""


def _during(property_: NamedNode, what: str) -> str:
    """The update that says how long of each contact is shared with what else has a time."""
    return f"""DELETE {{ GRAPH ?graph {{ ?contact {property_} ?none }} }}
INSERT {{ GRAPH ?graph {{ ?contact {property_} ?seconds }} }}
WHERE {{
  {{
    SELECT ?graph ?contact (SUM(?part) AS ?seconds)
    WHERE {{
      GRAPH ?graph {{
        ?contact {property_} ?none ; {CAPAR.body} ?link ; {CAPAR.other} ?thing ;
          {CAPAR.start} ?begins ; {CAPAR.end} ?ends .
        {what} ; {CAPAR.start} ?from ; {CAPAR.end} ?until .
      }}
      FILTER(?from < ?ends && ?begins < ?until)
      BIND(IF(?until < ?ends, ?until, ?ends) - IF(?from > ?begins, ?from, ?begins) AS ?part)
    }}
    GROUP BY ?graph ?contact
  }}
  GRAPH ?graph {{ ?contact {property_} ?none }}
}}"""


_HELD = f"?x {CAPAR.ofLink} ?link ; {CAPAR.dominant} ?thing ; {CAPAR.possesses} true"
_MOVED = f"?x a {CAPAR.Moving} ; {CAPAR.body} ?thing"


def from_3(store: Store) -> tuple[str, ...]:
    """The updates to version 4: what is of an action says so, and contacts tell of holding."""
    del store
    held, moved = _during(CAPAR.heldFor, _HELD), _during(CAPAR.movedFor, _MOVED)
    return (_OF_ACTIONS, _TIMELESS, held, moved)


STEPS: Mapping[int, Callable[[Store], tuple[str, ...]]] = {1: from_1, 2: from_2, 3: from_3}
"""The updates that bring a store of each older version to the next one."""


def migration(store: Store, found: int) -> tuple[str, ...]:
    """The updates that bring a store of an older version to this one, to be done as one.

    Each step reads only what those before it leave alone, so all are made from the store as it is.
    """
    return tuple(each for at in range(found, schema.SCHEMA) for each in STEPS[at](store))
