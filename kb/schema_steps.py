"""The updates that bring a store of an older schema to the present one, one step a version."""

from collections.abc import Callable, Mapping

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


def from_3(store: Store) -> tuple[str, ...]:
    """The updates to version 4: steps, calls, locations and styles are of their action."""
    del store
    return (_OF_ACTIONS,)


STEPS: Mapping[int, Callable[[Store], tuple[str, ...]]] = {1: from_1, 2: from_2, 3: from_3}
"""The updates that bring a store of each older version to the next one."""


def migration(store: Store, found: int) -> tuple[str, ...]:
    """The updates that bring a store of an older version to this one, to be done as one.

    Each step reads only what those before it leave alone, so all are made from the store as it is.
    """
    return tuple(each for at in range(found, schema.SCHEMA) for each in STEPS[at](store))
