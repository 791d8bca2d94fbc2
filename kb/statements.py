"""Statements as they are collected: a thing, what it is, and what is said of it."""

from collections.abc import Iterable, Mapping
from typing import TypeAlias

from pyoxigraph import Literal, NamedNode, Quad, Triple

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
        self._own: dict[Triple, None] = {}
        self._shared: dict[Triple, None] = {}
        self._mentioned: set[NamedNode] = set()

    def say(self, subject: NamedNode, kinds: Iterable[NamedNode], said: Said) -> NamedNode:
        """State what a thing of the observation's own is; empty values say nothing."""
        _write(self._own, subject, kinds, said)
        return subject

    def share(self, subject: NamedNode, kinds: Iterable[NamedNode], said: Said) -> NamedNode:
        """State what a shared thing is, whose name follows from all that is said of it."""
        if subject not in self._mentioned:
            self._mentioned.add(subject)
            self._own[Triple(self.about, CAPAR.mentions, subject)] = None
            _write(self._shared, subject, kinds, said)
        return subject

    @property
    def triples(self) -> tuple[Triple, ...]:
        """Everything that was said, in the order in which it was said."""
        return (*self._own, *self._shared)

    @property
    def quads(self) -> list[Quad]:
        """Everything that was said, each statement in the graph where it stands."""
        out = [Quad(t.subject, t.predicate, t.object, self.about) for t in self._own]
        for t in self._shared:
            assert isinstance(t.subject, NamedNode)
            out.append(Quad(t.subject, t.predicate, t.object, names.graph_of(t.subject)))
        return out


def _write(
    into: dict[Triple, None], subject: NamedNode, kinds: Iterable[NamedNode], said: Said
) -> None:
    for kind in kinds:
        into[Triple(subject, TYPE, kind)] = None
    for predicate, value in said.items():
        for each in terms(value):
            into[Triple(subject, predicate, each)] = None


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
