"""Statements as they are collected: a thing, what it is, and what is said of it."""

from collections.abc import Iterable, Mapping
from typing import TypeAlias

from pyoxigraph import Literal, NamedNode, Quad

from kb import names
from ontology import CAPAR
from ontology.vocabularies import RDF, RDFS

Term: TypeAlias = NamedNode | Literal
Value: TypeAlias = NamedNode | Literal | str | float | int | bool | None
Said: TypeAlias = Mapping[NamedNode, Value | Iterable[NamedNode]]

TYPE = NamedNode(RDF + "type")
LABEL = NamedNode(RDFS + "label")


class Statements:
    """What an observation says: of its own things, and of things that it shares with others."""

    def __init__(self, about: NamedNode) -> None:
        self.about = about
        self._said: dict[Quad, None] = {}
        self._mentioned: set[NamedNode] = set()

    def say(self, subject: NamedNode, kinds: Iterable[NamedNode], said: Said) -> NamedNode:
        """State what a thing of the observation's own is; empty values say nothing."""
        self._write(subject, kinds, said, self.about)
        return subject

    def share(self, subject: NamedNode, kinds: Iterable[NamedNode], said: Said) -> NamedNode:
        """State what a shared thing is, whose name follows from all that is said of it."""
        if subject not in self._mentioned:
            self._mentioned.add(subject)
            self._said[Quad(self.about, CAPAR.mentions, subject, self.about)] = None
            self._write(subject, kinds, said, names.graph_of(subject))
        return subject

    @property
    def quads(self) -> list[Quad]:
        """Everything that was said, each statement in the graph where it stands."""
        return list(self._said)

    def _write(
        self, subject: NamedNode, kinds: Iterable[NamedNode], said: Said, graph: NamedNode
    ) -> None:
        for kind in kinds:
            self._said[Quad(subject, TYPE, kind, graph)] = None
        for predicate, value in said.items():
            for each in terms(value):
                self._said[Quad(subject, predicate, each, graph)] = None


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
