"""The ontology's files: terms, kinds of objects, alignments and shapes."""

import hashlib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable

from pyoxigraph import NamedNode, RdfFormat, Triple, parse

from ontology.namespace import BASE, DATA, RDF, RDFS

WHOLE = NamedNode(BASE.removesuffix("#"))
"""The ontology itself."""

DEFINED_BY = NamedNode(RDFS + "isDefinedBy")
KIND = DATA + "kind/"
"""Where the kinds of objects are named."""


def _turtle(folder: Traversable) -> list[Traversable]:
    return sorted(
        (each for each in folder.iterdir() if each.name.endswith(".ttl")), key=lambda at: at.name
    )


def term_files() -> list[Traversable]:
    """The Turtle files of terms, kinds and alignments, by name."""
    return _turtle(files("ontology"))


def shape_files() -> list[Traversable]:
    """The Turtle files of SHACL shapes, by name."""
    return _turtle(files("ontology") / "shapes")


def read(file: Traversable) -> list[Triple]:
    """The statements of a Turtle file."""
    quads = parse(file.read_bytes(), format=RdfFormat.TURTLE)
    return [each.triple for each in quads]


@cache
def ontology() -> tuple[Triple, ...]:
    """Every statement of the ontology, its kinds with the closure of their hierarchy."""
    stated = {each for file in term_files() for each in read(file)}
    pairs = [
        (str(each.subject), str(each.object))
        for each in stated
        if each.predicate.value == BASE + "broaderKind"
    ]
    kinds = {
        each.subject
        for each in stated
        if each.predicate.value == RDF + "type" and each.object == NamedNode(BASE + "ObjectKind")
    }
    named = {each.subject for each in stated if str(each.subject).startswith(f"<{BASE}")}
    stated |= {Triple(each, DEFINED_BY, WHOLE) for each in named}
    is_a = NamedNode(BASE + "isA")
    above = closure(pairs)
    for kind in kinds:
        for general in {str(kind), *above.get(str(kind), ())}:
            stated.add(Triple(kind, is_a, NamedNode(general.strip("<>"))))
    return tuple(sorted(stated, key=str))


def closure(pairs: list[tuple[str, str]]) -> dict[str, set[str]]:
    """What is above each name, directly or not; a name in a circle is above itself."""
    direct: dict[str, set[str]] = {}
    for lower, upper in pairs:
        direct.setdefault(lower, set()).add(upper)
    above: dict[str, set[str]] = {}
    for name, uppers in direct.items():
        reached: set[str] = set()
        waiting = list(uppers)
        while waiting:
            each = waiting.pop()
            if each not in reached:
                reached.add(each)
                waiting += direct.get(each, ())
        above[name] = reached
    return above


@cache
def ontology_kinds() -> Mapping[NamedNode, tuple[NamedNode, ...]]:
    """The classes of each thing that the ontology itself states."""
    found: dict[NamedNode, tuple[NamedNode, ...]] = {}
    for quad in ontology():
        if quad.predicate.value == RDF + "type" and isinstance(quad.object, NamedNode):
            assert isinstance(quad.subject, NamedNode)
            found[quad.subject] = (*found.get(quad.subject, ()), quad.object)
    return found


@cache
def subclasses() -> tuple[Triple, ...]:
    """The statements that a class of ours is below another one of ours."""
    return tuple(
        each
        for each in ontology()
        if each.predicate.value == RDFS + "subClassOf" and BASE in str(each.object)
    )


@cache
def classes_below(kind: NamedNode) -> frozenset[NamedNode]:
    """The classes of ours below a class, directly or not."""
    pairs = [(str(each.object), str(each.subject)) for each in subclasses()]
    found = closure(pairs).get(str(kind), set())
    return frozenset(NamedNode(each.strip("<>")) for each in found)


@cache
def kinds() -> frozenset[str]:
    """Names of the kinds of objects that the ontology itself knows."""
    return frozenset(
        each.subject.value.removeprefix(KIND)
        for each in ontology()
        if isinstance(each.subject, NamedNode) and each.subject.value.startswith(KIND)
    )


@cache
def digest() -> str:
    """SHA-256 of the ontology's statements: distinguishes its versions."""
    text = "\n".join(map(str, ontology()))
    return hashlib.sha256(text.encode()).hexdigest()
