"""Statements as they are collected: a thing, what it is, and what is said of it."""

from collections.abc import Iterable, Mapping
from typing import TypeAlias

from pyoxigraph import Literal, NamedNode, Quad

from kb.store import names
from ontology import CAPAR
from ontology.vocabularies import RDF, RDFS

Term: TypeAlias = NamedNode | Literal
Value: TypeAlias = NamedNode | Literal | str | float | int | bool | None
Said: TypeAlias = Mapping[NamedNode, Value | Iterable[NamedNode]]

TYPE = NamedNode(RDF + "type")
LABEL = NamedNode(RDFS + "label")


Things: TypeAlias = dict[NamedNode, dict[NamedNode, dict[Term, None]]]
"""What is said of things: of each, by property, its values in order and each once."""


class Statements:
    """What an observation says: of its own things, and of things that it shares with others."""

    def __init__(self, about: NamedNode) -> None:
        self.about = about
        self.things: Things = {}
        """Everything that was said, by thing."""

        self._shared: set[NamedNode] = set()

    def say(self, subject: NamedNode, kinds: Iterable[NamedNode], said: Said) -> NamedNode:
        """State what a thing of the observation's own is; empty values say nothing."""
        thing = self.things.setdefault(subject, {})
        for kind in kinds:
            thing.setdefault(TYPE, {})[kind] = None
        for predicate, value in said.items():
            if found := terms(value):
                thing.setdefault(predicate, {}).update(dict.fromkeys(found))
        return subject

    def share(self, subject: NamedNode, kinds: Iterable[NamedNode], said: Said) -> NamedNode:
        """State what a shared thing is, whose name follows from all that is said of it."""
        if subject not in self._shared:
            self._shared.add(subject)
            self.things.setdefault(self.about, {}).setdefault(CAPAR.mentions, {})[subject] = None
            self.say(subject, kinds, said)
        return subject

    @property
    def quads(self) -> list[Quad]:
        """Everything that was said, each statement in the graph where it stands."""
        return [
            Quad(thing, predicate, value, graph)
            for thing, said in self.things.items()
            for graph in (names.graph_of(thing) if thing in self._shared else self.about,)
            for predicate, values in said.items()
            for value in values
        ]


def terms(value: Value | Iterable[NamedNode]) -> list[Term]:
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
    for each in quads:
        graphs.setdefault(str(each.graph_name), []).append(f"{each.triple} .")
    blocks = [f"GRAPH {name} {{\n{chr(10).join(lines)}\n}}" for name, lines in graphs.items()]
    return "INSERT DATA {\n" + "\n".join(blocks) + "\n}"
