"""Statements as they are collected: a thing, its classes and its properties."""

from collections.abc import Iterable, Mapping
from typing import TypeAlias

from pyoxigraph import Literal, NamedNode, Quad

from kb.store import names
from ontology import CAPAR
from ontology.vocabularies import RDF, RDFS

Term: TypeAlias = NamedNode | Literal
Value: TypeAlias = NamedNode | Literal | str | float | int | bool | None
PropertyValues: TypeAlias = Mapping[NamedNode, Value | Iterable[NamedNode] | Iterable[Literal]]

TYPE = NamedNode(RDF + "type")
LABEL = NamedNode(RDFS + "label")


Things: TypeAlias = dict[NamedNode, dict[NamedNode, dict[Term, None]]]
"""The properties of things: of each, by property, its values in order and each once."""


class Statements:
    """What an observation states: of its own things, and of things that it shares with others."""

    def __init__(self, about: NamedNode) -> None:
        self.about = about
        self.things: Things = {}
        """Everything that was added, by thing."""

        self._shared: set[NamedNode] = set()

    def add(
        self, subject: NamedNode, kinds: Iterable[NamedNode], properties: PropertyValues
    ) -> NamedNode:
        """Add classes and properties of a thing of the observation; empty values add nothing."""
        thing = self.things.setdefault(subject, {})
        for kind in kinds:
            thing.setdefault(TYPE, {})[kind] = None
        for predicate, value in properties.items():
            if found := terms(value):
                thing.setdefault(predicate, {}).update(dict.fromkeys(found))
        return subject

    def share(
        self, subject: NamedNode, kinds: Iterable[NamedNode], properties: PropertyValues
    ) -> NamedNode:
        """State what a shared thing is, whose name follows from all that is said of it."""
        if subject not in self._shared:
            self._shared.add(subject)
            self.things.setdefault(self.about, {}).setdefault(CAPAR.mentions, {})[subject] = None
            self.add(subject, kinds, properties)
        return subject

    @property
    def quads(self) -> list[Quad]:
        """Everything that was added, each statement in the graph where it stands."""
        return [
            Quad(thing, predicate, value, graph)
            for thing, properties in self.things.items()
            for graph in (names.graph_of(thing) if thing in self._shared else self.about,)
            for predicate, values in properties.items()
            for value in values
        ]


def terms(value: Value | Iterable[NamedNode] | Iterable[Literal]) -> list[Term]:
    """A value as terms; nothing and an empty text are none."""
    if value is None or value == "":
        return []
    if isinstance(value, NamedNode | Literal):
        return [value]
    if isinstance(value, str | bool | int | float):
        return [Literal(value)]
    return list(value)


def insertion(quads: Iterable[Quad]) -> str:
    """Statements as a SPARQL update that adds them."""
    graphs: dict[str, list[str]] = {}
    for quad in quads:
        graphs.setdefault(str(quad.graph_name), []).append(f"{quad.triple} .")
    blocks = [f"GRAPH {name} {{\n{chr(10).join(lines)}\n}}" for name, lines in graphs.items()]
    return "INSERT DATA {\n" + "\n".join(blocks) + "\n}"
