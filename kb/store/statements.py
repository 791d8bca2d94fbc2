"""Statements as they are collected, and the compact literals in them."""

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, TypeAlias

from pyoxigraph import Literal, NamedNode, Quad, Triple

from capar.model.errors import CaparError
from capar.model.par import Nlt, PathPoint
from kb.store import names
from kb.store.answer_values import Plain, plain
from ontology import CAPAR
from ontology.namespace import RDF, RDFS

if TYPE_CHECKING:
    from capar.model.locations import SampledTrack

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


def same(value: object, fields: str) -> dict[NamedNode, Value]:
    """Properties that are named like the fields of a value; several words are one text."""
    found = {getattr(CAPAR, name): getattr(value, name) for name in fields.split()}
    return {k: " ".join(v) if isinstance(v, tuple) else v for k, v in found.items()}


def insertion(quads: Iterable[Quad]) -> str:
    """Statements as a SPARQL update that adds them."""
    graphs: dict[str, list[str]] = {}
    for quad in quads:
        graphs.setdefault(str(quad.graph_name), []).append(f"{quad.triple} .")
    blocks = [f"GRAPH {name} {{\n{chr(10).join(lines)}\n}}" for name, lines in graphs.items()]
    return "INSERT DATA {\n" + "\n".join(blocks) + "\n}"


class LiteralError(CaparError):
    """A compact literal that is not what its datatype promises."""


def _compact(values: Iterable[float], datatype: NamedNode) -> Literal:
    """Numbers as a literal that keeps each of them exactly."""
    floats = [float(each) for each in values]
    if not all(map(math.isfinite, floats)):
        kind = datatype.value.partition("#")[2]
        raise LiteralError(f"{kind} {floats} has a number that is not finite")
    return Literal(" ".join(map(repr, floats)), datatype=datatype)


def vector(values: Iterable[float]) -> Literal:
    """Numbers as a literal.

    Raises:
        LiteralError: A number that is not finite; so of an NLT and of a path.
    """
    return _compact(values, CAPAR.vector)


def nlt(value: Nlt | None) -> Literal | None:
    """A normalised local transform as a literal; nothing of none."""
    return _compact((*value.position, *value.orientation), CAPAR.nlt) if value else None


def path(points: Iterable[PathPoint]) -> Literal | None:
    """Significant points as a literal, time and place of each; nothing of none."""
    numbers = [each for point in points for each in (point.time, *point.position)]
    return _compact(numbers, CAPAR.path) if numbers else None


def track(value: "SampledTrack") -> Literal:
    """Sampled places as a literal: the seconds between two samples, and their text."""
    return Literal(f"{value.step_s!r} {value.samples}", datatype=CAPAR.sampledTrack)


def track_of(text: str) -> "SampledTrack":
    """The sampled places that a literal states, of a body without a name.

    Raises:
        LiteralError: It is no step of time and places.
    """
    from capar.model.locations import SampledTrack  # few questions need arrays

    step, _, samples = text.partition(" ")
    try:
        return SampledTrack("", float(step), samples)
    except (ValueError, CaparError):
        raise LiteralError(f"{text[:40]!r} is no step in seconds and places in Base64") from None


def numbers(text: str) -> tuple[float, ...]:
    """The numbers of a compact literal.

    Raises:
        LiteralError: Something that is not a finite number.
    """
    try:
        values = tuple(float(each) for each in text.split())
    except ValueError:
        values = (math.nan,)
    if not all(map(math.isfinite, values)):
        raise LiteralError(f"{text!r} is no row of finite numbers divided by spaces")
    return values


def nlt_of(text: str) -> Nlt:
    """The normalised local transform that a literal states.

    Raises:
        LiteralError: It has not seven finite numbers.
    """
    values = numbers(text)
    if len(values) != 7:
        raise LiteralError(f"{text!r} has {len(values)} numbers; an NLT has 7: x y z, then w x y z")
    return Nlt((values[0], values[1], values[2]), (values[3], values[4], values[5], values[6]))


class StatementIndex:
    """Statements by subject and property."""

    def __init__(self, statements: Iterable[Quad | Triple]) -> None:
        self._said: dict[object, dict[NamedNode, list[NamedNode | Literal]]] = {}
        for statement in statements:
            if isinstance(statement.object, NamedNode | Literal):
                said = self._said.setdefault(statement.subject, {})
                said.setdefault(statement.predicate, []).append(statement.object)

    def things(self, kind: NamedNode) -> list[NamedNode]:
        """Everything of a class, by IRI."""
        found = [
            node
            for node, said in self._said.items()
            if isinstance(node, NamedNode) and kind in said.get(TYPE, ())
        ]
        return sorted(found, key=lambda node: node.value)

    def all(self, node: NamedNode, predicate: NamedNode) -> list[NamedNode]:
        """Things that are said of a thing, by IRI."""
        values = self._said.get(node, {}).get(predicate, [])
        return sorted((v for v in values if isinstance(v, NamedNode)), key=lambda v: v.value)

    def one(self, node: NamedNode, predicate: NamedNode) -> NamedNode | None:
        """The thing that is said of a thing, if one is."""
        return next(iter(self.all(node, predicate)), None)

    def value(self, node: NamedNode, predicate: NamedNode) -> Plain:
        """The value that is said of a thing, if one is."""
        values = self._said.get(node, {}).get(predicate, [])
        return plain(values[0]) if values and isinstance(values[0], Literal) else None

    def text(self, node: NamedNode, predicate: NamedNode) -> str:
        """The text that is said of a thing; empty if none is."""
        value = self.value(node, predicate)
        return "" if value is None else str(value)

    def texts(self, node: NamedNode, predicate: NamedNode) -> tuple[str, ...]:
        """Every text that is said of a thing, sorted."""
        values = self._said.get(node, {}).get(predicate, [])
        return tuple(sorted(each.value for each in values if isinstance(each, Literal)))

    def words(self, node: NamedNode, predicate: NamedNode) -> tuple[str, ...]:
        """The words of the text that is said of a thing."""
        return tuple(self.text(node, predicate).split())

    def number(self, node: NamedNode, predicate: NamedNode) -> float:
        """The number that is said of a thing; zero if none is."""
        value = self.value(node, predicate)
        return float(value) if value is not None else 0.0

    def count(self, node: NamedNode, predicate: NamedNode) -> int:
        """The whole number that is said of a thing; zero if none is."""
        return int(self.number(node, predicate))

    def ordered(self, node: NamedNode, predicate: NamedNode, *, by: NamedNode) -> list[NamedNode]:
        """Things that are said of a thing, in the order of their numbers."""
        return sorted(self.all(node, predicate), key=lambda each: self.count(each, by))
