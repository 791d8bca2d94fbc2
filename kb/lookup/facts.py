"""The measured facts of an observation, read back from what is stored."""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any, cast

from pyoxigraph import Literal, NamedNode

from capar.model.facts import ALL_FACT_KINDS, Fact, MovedBy, Observed
from kb.encode.facts import FactForm, form
from kb.store import names
from kb.store.sparql import fill
from kb.store.statements import TYPE
from kb.store.stores import Store
from ontology import CAPAR

Said = Mapping[NamedNode, str]
"""What is said of a fact: by property a literal's text, or the name of a body or an agent."""

_FACTS = f"""SELECT ?fact ?property ?value ?name
WHERE {{
  GRAPH @graph@ {{ @graph@ {CAPAR.fact} ?fact . ?fact ?property ?value }}
  OPTIONAL {{ ?value {CAPAR.name} ?name }}
}}"""

_BY_CLASS: Mapping[NamedNode, type[Observed]] = {form(each).kind: each for each in ALL_FACT_KINDS}
_RANK: Mapping[type[Fact], int] = {each: index for index, each in enumerate(ALL_FACT_KINDS)}


def facts(store: Store, name: str) -> tuple[Fact, ...]:
    """What was measured in the capture of an observation, in the order of the extractors.

    What moves what is left out, as that is derived; so are kinds of facts that an older program
    measured and this one does not.
    """
    kinds: dict[object, type[Observed]] = {}
    said: dict[object, dict[NamedNode, str]] = defaultdict(dict)
    for fact, key, value, called in store.ask(_query(name)).rows:
        if key == TYPE and value in _BY_CLASS:
            kinds[fact] = _BY_CLASS[cast(NamedNode, value)]
        elif isinstance(key, NamedNode):
            told = called if isinstance(called, Literal) else value
            said[fact][key] = told.value if isinstance(told, Literal) else ""
    found = (
        each
        for node, kind in kinds.items()
        if kind is not MovedBy
        for each in _facts(kind, said[node])
    )
    return in_order(found)


def in_order(found: "Iterator[Fact] | list[Fact]") -> tuple[Fact, ...]:
    """Facts in the order of the extractors."""
    return tuple(sorted(found, key=lambda each: (_RANK[type(each)], each)))


def _query(name: str) -> str:
    return fill(_FACTS, graph=str(names.observation(name)))


def _facts(kind: type[Observed], said: Said) -> Iterator[Fact]:
    known = form(kind)
    if not kind.declaration.sampled:
        yield _fact(kind, known, said)
        return
    named = {name: said[each] for name, each in known.properties.items()}
    numbers = [int(each) for each in said[CAPAR.samples].split()]
    columns = [each.name for each in fields(cast(Any, kind)) if each.name not in named]
    columns.remove("frame")
    width = len(columns) + 1
    for at in range(0, len(numbers), width):
        row = dict(zip(("frame", *columns), numbers[at : at + width], strict=True))
        yield cast(Any, kind)(**named, **row)


def _fact(kind: type[Observed], known: FactForm, said: Said) -> Fact:
    values: dict[str, object] = {}
    for field in fields(cast(Any, kind)):
        text = said[known.properties[field.name]]
        power = known.powers.get(field.name, 0)
        values[field.name] = _number(text, power) if field.type is int else text
    return cast(Fact, cast(Any, kind)(**values))


def _number(text: str, power: int) -> int:
    return round(float(text) * 10**-power) if power else int(text)
