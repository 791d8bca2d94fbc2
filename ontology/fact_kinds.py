"""The ontology's terms of the kinds of facts, written from the classes that declare them.

A kind's docstring is its definition, its span says which general class it belongs to. Run
``make docs`` after a kind of fact was added or its docstring changed.
"""

import inspect
import re
from pathlib import Path
from typing import Any

from capar.model.facts import ALL_FACT_KINDS, Span, Touching

TURTLE = "fact_kinds.ttl"

HEAD = """\
# The kinds of measured facts, each a class of its own; written by `make docs` from capar/model.

@prefix capar: <https://w3id.org/capar/ontology#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
"""
CLASS = """
capar:{name}
    a owl:Class ;
    rdfs:label "{label}"@en ;
    skos:definition "{definition}"@en ;
    rdfs:subClassOf capar:{general} .
"""
_GENERAL = {Span.ALWAYS: "SceneFact", Span.INSTANT: "InstantFact", Span.INTERVAL: "IntervalFact"}


def turtle() -> str:
    """The classes of the kinds of facts, as Turtle."""
    return HEAD + "".join(map(_class, ALL_FACT_KINDS))


def _name(kind: Any) -> str:
    return str(kind.declaration.rdf[0])


def _class(kind: Any) -> str:
    name = _name(kind)
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower()
    text = (inspect.getdoc(kind) or "").replace("``", "").replace('"', '\\"')
    definition = " ".join(text.split())
    return CLASS.format(name=name, label=words, definition=definition, general=_general(kind))


def _general(kind: Any) -> str:
    """The general class that facts belong to by when they hold."""
    declared = kind.declaration
    if declared.sampled:
        return "SampledFact"
    if declared.span is Touching:
        return "ContactFact"
    return _GENERAL.get(declared.span, "Fact")


def main() -> None:
    """Write the file beside the ontology's others."""
    (Path(__file__).parent / TURTLE).write_text(turtle(), encoding="utf-8")


if __name__ == "__main__":
    main()
