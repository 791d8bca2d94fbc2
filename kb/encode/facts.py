"""Facts as statements: of the class that its kind declares, or else a generic fact.

A kind whose declaration names a class of the ontology has a property for each argument. Any other
is a ``Fact`` with its predicate as its name, and its arguments as one text.
"""

from functools import cache
from typing import TYPE_CHECKING, Any, cast

from pyoxigraph import NamedNode

from capar.model.atoms import arguments
from kb.encode.scene import DERIVED
from kb.store import names
from kb.store.statements import Statements, Value
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.facts import Fact


def facts(out: Statements, stated: "tuple[Fact, ...]", capture: NamedNode) -> list[NamedNode]:
    """Every fact, derived from its capture."""
    return [_fact(out, each, capture) for each in stated]


def terms(kind: "type[Fact]") -> tuple[NamedNode, ...]:
    """The class of a kind of fact, and the property of each argument where it has its own."""
    return _terms(cast(Any, kind))


@cache
def _terms(kind: Any) -> tuple[NamedNode, ...]:
    return tuple(getattr(CAPAR, each) for each in kind.declaration.rdf)


def _fact(out: Statements, fact: "Fact", capture: NamedNode) -> NamedNode:
    values = [getattr(fact, each) for each in arguments(cast(Any, type(fact)))]
    kind, *predicates = terms(type(fact))
    if kind == CAPAR.Fact:
        properties: dict[NamedNode, Value] = {
            CAPAR.name: fact.predicate,
            CAPAR.parameters: " ".join(map(str, values)),
        }
    else:
        properties = dict(zip(predicates, values, strict=True))
    properties[DERIVED] = capture
    return out.add(names.part(out.about, "fact", fact.predicate, *values), (kind,), properties)
