"""Vocabularies of others that the knowledge base uses, and the prefixes that queries may write."""

from types import MappingProxyType

from ontology.closed import BASE, DATA

RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
RDFS = "http://www.w3.org/2000/01/rdf-schema#"
XSD = "http://www.w3.org/2001/XMLSchema#"
PROV = "http://www.w3.org/ns/prov#"
TIME = "http://www.w3.org/2006/time#"
OWL = "http://www.w3.org/2002/07/owl#"

PREFIXES = MappingProxyType(
    {
        "capar": BASE,
        "data": DATA,
        "rdf": RDF,
        "rdfs": RDFS,
        "xsd": XSD,
        "owl": "http://www.w3.org/2002/07/owl#",
        "skos": "http://www.w3.org/2004/02/skos/core#",
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
    "before",
    "after",
    "meets",
    "metBy",
    "overlaps",
    "overlappedBy",
    "starts",
    "startedBy",
    "during",
    "contains",
    "finishes",
    "finishedBy",
    "equals",
)
"""Allen's relations in OWL-Time's words."""

ALLEN = MappingProxyType({each: f"{TIME}interval{each[0].upper()}{each[1:]}" for each in RELATIONS})
"""Allen's relations as OWL-Time's properties."""
