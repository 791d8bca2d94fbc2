"""Levin's classes, the thesis's claims and the primitives' links as statements."""

from collections.abc import Iterable

from pyoxigraph import Literal, NamedNode, Triple

from kb.lexicon import terms
from kb.lexicon.levin import levin_classes
from kb.lexicon.links import (
    Claimant,
    PrimitiveWords,
    SenseLink,
    class_links,
    remarks,
    sense_links,
    thesis_claims,
    thesis_senses,
)
from kb.lexicon.terms import COMMENT, LABEL, TYPE, Triples
from kb.store import names
from ontology import CAPAR, DATA

BROADER = NamedNode(terms.SKOS + "broader")
NOTATION = NamedNode(terms.SKOS + "notation")
CLOSE_MATCH = NamedNode(terms.SKOS + "closeMatch")
REFERENCE = NamedNode(terms.ONTOLEX + "reference")


def levin_triples() -> Triples:
    """Levin's classes, with the thesis's claims and our remarks about them."""
    for levin in levin_classes().values():
        node = terms.levin(levin.number)
        yield Triple(node, TYPE, CAPAR.LevinClass)
        yield Triple(node, LABEL, Literal(levin.title, language="en"))
        yield Triple(node, NOTATION, Literal(levin.number))
        if levin.broader:
            yield Triple(node, BROADER, terms.levin(levin.broader))
        if levin.size:
            yield Triple(node, CAPAR.classSize, terms.number(levin.size))
        for name in levin.verbnet:
            yield Triple(node, CLOSE_MATCH, terms.verbnet(name))
    yield from _claims()
    yield from _remarks()


def _claims() -> Triples:
    for index, claim in enumerate(thesis_claims()):
        node = NamedNode(f"{DATA}claim/{index}")
        yield Triple(node, TYPE, CAPAR.CapabilityClaim)
        yield Triple(node, CAPAR.claimedBy, Literal(Claimant.THESIS.value))
        yield Triple(node, CAPAR.claimedStatus, Literal(claim.status.value))
        yield Triple(node, CAPAR.reason, Literal(claim.reason))
        yield Triple(node, CAPAR.section, Literal(claim.section))
        yield Triple(node, CAPAR.quote, Literal(claim.quote))
        if claim.said:
            yield Triple(node, CAPAR.printedClass, Literal(claim.said))
        if claim.levin:
            yield Triple(node, CAPAR.levinClass, terms.levin(claim.levin))
        for verb in claim.verbs:
            yield Triple(node, CAPAR.claimedVerb, Literal(verb))


def _remarks() -> Triples:
    for index, each in enumerate(remarks()):
        node = NamedNode(f"{DATA}remark/{index}")
        yield Triple(node, TYPE, CAPAR.LexicalRemark)
        yield Triple(node, COMMENT, Literal(each.text, language="en"))
        yield Triple(node, CAPAR.claimedVerb, Literal(each.verb))
        yield Triple(node, CAPAR.levinClass, terms.levin(each.levin))


def link_triples(primitives: Iterable[PrimitiveWords]) -> Triples:
    """How primitives link to senses and classes, by the thesis and by us."""
    for link in thesis_senses():
        yield from _sense_link(link)
    for words in primitives:
        for link in sense_links(words):
            yield from _sense_link(link)
        classes, claimant = class_links(words)
        for number in classes:
            yield from _class_link(words.name, number, claimant)


def _link_node(primitive: str, target: str, claimant: Claimant) -> NamedNode:
    return names.shared("link", claimant.value, primitive, target)


def _sense_link(link: SenseLink) -> Triples:
    node = _link_node(link.primitive, link.key, link.claimed_by)
    action = names.shared("action", link.primitive)
    yield Triple(node, TYPE, CAPAR.LexicalLink)
    yield Triple(node, CAPAR.linkedAction, action)
    yield Triple(node, CAPAR.linkedSense, terms.sense(link.key))
    yield Triple(node, CAPAR.claimedBy, Literal(link.claimed_by.value))
    yield Triple(terms.sense(link.key), REFERENCE, action)
    if link.number_1_6:
        yield Triple(node, CAPAR.oldSenseNumber, terms.number(link.number_1_6))
    if link.remark:
        yield Triple(node, COMMENT, Literal(link.remark, language="en"))


def _class_link(primitive: str, number: str, claimant: Claimant) -> Triples:
    node = _link_node(primitive, number, claimant)
    yield Triple(node, TYPE, CAPAR.LexicalLink)
    yield Triple(node, CAPAR.linkedAction, names.shared("action", primitive))
    yield Triple(node, CAPAR.levinClass, terms.levin(number))
    yield Triple(node, CAPAR.claimedBy, Literal(claimant.value))
