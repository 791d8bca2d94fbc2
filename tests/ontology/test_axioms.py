"""The axioms contradict no observation, and contradict one that says what cannot be."""

import pytest
from observations import with_unknown
from pyoxigraph import Literal, NamedNode, Triple

from kb.encode.observation import encode
from kb.store.statements import TYPE
from ontology import BASE, CAPAR, terms
from ontology.files import DEFINED_BY, WHOLE, ontology

OWL = "http://www.w3.org/2002/07/owl#"
ERROR = "http://www.daml.org/2002/03/agents/agent-ont#error"
AXIOMS = ("domain", "range", "subClassOf", "subPropertyOf", "inverseOf", "disjointWith", "type")
SEGMENT = NamedNode("https://w3id.org/capar/data/observation/Strange#segment.right_hand.0")

ZERO = Literal(0.0)
"""A double, which this reasoner takes for none: it asks for more than the least positive one."""


def axioms() -> list[Triple]:
    """What the ontology says of its own classes and properties."""
    return [
        each
        for each in ontology()
        if str(each.subject).startswith(f"<{BASE}")
        and each.predicate.value.rsplit("#")[-1] in AXIOMS
    ]


def contradictions(*added: Triple) -> list[str]:
    """What a reasoner for OWL RL finds wrong in the axioms and an observation."""
    from owlrl import DeductiveClosure, OWLRL_Semantics
    from rdflib import Graph, URIRef

    own = (each.triple for each in encode(with_unknown()).quads if each.object != ZERO)
    stated = [*axioms(), *own, *added]
    graph = Graph().parse(data="".join(f"{each} .\n" for each in stated), format="nt")
    DeductiveClosure(OWLRL_Semantics).expand(graph)
    return sorted(str(each) for each in graph.objects(None, URIRef(ERROR)))


def test_an_observation_is_consistent_with_the_axioms() -> None:
    assert contradictions() == []


@pytest.mark.parametrize(
    "added",
    [
        Triple(SEGMENT, CAPAR.ofLink, NamedNode("https://w3id.org/capar/data/action/Lift")),
        Triple(NamedNode("https://w3id.org/capar/data/action/Lift"), CAPAR.look, SEGMENT),
    ],
    ids=["wrong range", "wrong domain"],
)
def test_a_thing_of_two_disjoint_classes_is_a_contradiction(added: Triple) -> None:
    action = Triple(NamedNode("https://w3id.org/capar/data/action/Lift"), TYPE, CAPAR.Action)
    assert contradictions(action, added) != []


def test_every_term_says_by_what_it_is_defined() -> None:
    defined = {each.subject for each in ontology() if each.predicate == DEFINED_BY}
    assert defined == {NamedNode(BASE + each) for each in terms()}


def test_the_ontology_has_a_version_and_a_licence() -> None:
    said = {each.predicate.value for each in ontology() if each.subject == WHOLE}
    assert {f"{OWL}versionIRI", "http://purl.org/dc/terms/license"} <= said
