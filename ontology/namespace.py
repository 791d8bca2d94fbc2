"""The terms of the ontology as a closed namespace, and the vocabularies of others."""

import re
from functools import cache
from importlib.resources import files
from types import MappingProxyType

from pyoxigraph import NamedNode

from capar.model.errors import UnknownNameError

BASE = "https://w3id.org/capar/ontology#"
"""The namespace of every term of ours."""

DATA = "https://w3id.org/capar/data/"
"""The namespace of what is stored: observations, agents, kinds, actions."""

RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
RDFS = "http://www.w3.org/2000/01/rdf-schema#"
XSD = "http://www.w3.org/2001/XMLSchema#"
PROV = "http://www.w3.org/ns/prov#"
TIME = "http://www.w3.org/2006/time#"
OWL = "http://www.w3.org/2002/07/owl#"
SKOS = "http://www.w3.org/2004/02/skos/core#"

PREFIXES = MappingProxyType(
    {
        "capar": BASE,
        "data": DATA,
        "rdf": RDF,
        "rdfs": RDFS,
        "xsd": XSD,
        "owl": OWL,
        "skos": SKOS,
        "prov": PROV,
        "time": TIME,
        "sosa": "http://www.w3.org/ns/sosa/",
        "qudt": "http://qudt.org/schema/qudt/",
        "unit": "http://qudt.org/vocab/unit/",
        "ontolex": "http://www.w3.org/ns/lemon/ontolex#",
        "ili": "http://globalwordnet.org/ili/",
    }
)
"""Namespaces by prefix, known to every query and written in every export."""

RELATIONS = (
    *("before", "after", "meets", "metBy", "overlaps", "overlappedBy", "starts", "startedBy"),
    *("during", "contains", "finishes", "finishedBy", "equals"),
)
"""Allen's relations in OWL-Time's words."""

ALLEN = MappingProxyType({each: f"{TIME}interval{each[0].upper()}{each[1:]}" for each in RELATIONS})
"""Allen's relations as OWL-Time's properties."""

_TERM = re.compile(r"^capar:(\w+)", re.MULTILINE)


class _Closed(type):
    """A class whose attributes are the terms that the ontology's files state."""

    def __getattr__(cls, name: str) -> NamedNode:
        """The term of that name."""
        if name.startswith("__"):
            raise AttributeError(name)
        if name not in terms():
            raise UnknownNameError("term of the ontology", name, terms())
        term = NamedNode(BASE + name)
        setattr(cls, name, term)
        return term


class CAPAR(metaclass=_Closed):
    """Every term of the ontology's files: ``CAPAR.Segment``."""


@cache
def terms() -> tuple[str, ...]:
    """Names of every term, sorted."""
    turtle = (each for each in files("ontology").iterdir() if each.name.endswith(".ttl"))
    return tuple(
        sorted({name for each in turtle for name in _TERM.findall(each.read_text("utf-8"))})
    )
