"""What words are called in the store, and the vocabularies that they are written in."""

from collections.abc import Iterator
from typing import TypeAlias
from urllib.parse import quote

from pyoxigraph import Literal, NamedNode, Triple

from ontology import DATA, PREFIXES
from ontology.namespace import RDF, RDFS, XSD

ONTOLEX = PREFIXES["ontolex"]
SKOS = PREFIXES["skos"]
WN = "https://globalwordnet.github.io/schemas/wn#"

TYPE = NamedNode(RDF + "type")
LABEL = NamedNode(RDFS + "label")
COMMENT = NamedNode(RDFS + "comment")
DEFINITION = NamedNode(SKOS + "definition")
EXAMPLE = NamedNode(SKOS + "example")
INTEGER = NamedNode(XSD + "integer")

Triples: TypeAlias = Iterator[Triple]


def graph(source: str) -> NamedNode:
    """The named graph of a source of words: ``wordnet``, ``levin``, ``verbnet`` or ``links``."""
    return NamedNode(f"{DATA}graph/lexicon/{source}")


def synset(offset: str) -> NamedNode:
    """A synset of WordNet 3.1's verbs."""
    return NamedNode(f"{DATA}synset/{offset}-v")


def sense(key: str) -> NamedNode:
    """A sense by its key."""
    return NamedNode(f"{DATA}sense/{quote(key, safe='')}")


def verb(lemma: str) -> NamedNode:
    """A verb as a word."""
    return NamedNode(f"{DATA}verb/{quote(lemma.replace(' ', '_'), safe='')}")


def levin(number: str) -> NamedNode:
    """A class of Levin's."""
    return NamedNode(f"{DATA}levin/{number}")


def verbnet(name: str) -> NamedNode:
    """A class of VerbNet."""
    return NamedNode(f"{DATA}verbnet/{quote(name, safe='')}")


def number(value: int) -> Literal:
    """A whole number."""
    return Literal(str(value), datatype=INTEGER)
