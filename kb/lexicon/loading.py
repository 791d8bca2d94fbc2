"""Words into a store, once each, and VerbNet's classes out of it."""

import hashlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice
from typing import TypeAlias
from urllib.parse import quote

from pyoxigraph import Literal, NamedNode, Quad, Triple

from kb.lexicon.links import (
    Claimant,
    PrimitiveWords,
    class_links,
    levin_classes,
    remarks,
    sense_links,
    thesis_claims,
    thesis_senses,
)
from kb.lexicon.verbnet import Frame, Member, Phrase, Predicate, Role, VerbClass
from kb.lexicon.wordnet import FOLDER, WordNet, frame_sentence, wordnet
from kb.store import names
from kb.store.statements import LABEL, TYPE, PropertyValues, StatementIndex, terms
from kb.store.stores import EmbeddedStore, Store
from ontology import CAPAR, DATA, PREFIXES
from ontology.namespace import RDFS, SKOS

ONTOLEX = PREFIXES["ontolex"]
WN = "https://globalwordnet.github.io/schemas/wn#"
COMMENT = NamedNode(RDFS + "comment")
BROADER = NamedNode(SKOS + "broader")
NOTATION = NamedNode(SKOS + "notation")
CLOSE_MATCH = NamedNode(SKOS + "closeMatch")
DEFINITION = NamedNode(SKOS + "definition")

BATCH = 20_000
"""Statements that are sent to a server in one request."""

SHIPPED = ("wordnet-3.1-verbs.tsv.gz", "wordnet-frames.tsv", "levin.tsv", "thesis_claims.tsv")

Triples: TypeAlias = Iterator[Triple]


def node(folder: str, word: str) -> NamedNode:
    """A synset, sense, verb, or class of Levin's or VerbNet's, by offset, key, lemma or name."""
    if folder == "synset":
        word = f"{word}-v"
    return NamedNode(f"{DATA}{folder}/{quote(word.replace(' ', '_'), safe='')}")


def _english(text: str) -> Literal:
    return Literal(text, language="en")


def _stated(node: NamedNode, kind: NamedNode | None, properties: PropertyValues) -> Triples:
    """The class and the properties of a thing."""
    if kind is not None:
        yield Triple(node, TYPE, kind)
    for predicate, value in properties.items():
        yield from (Triple(node, predicate, each) for each in terms(value))


# Into a store


def load_words(store: Store, primitives: Sequence[PrimitiveWords] = ()) -> bool:
    """Put WordNet's verbs, Levin's classes and the primitives' links into a store.

    Returns:
        Whether anything was loaded; what is there already stays.
    """
    shipped = hashlib.sha256(b"".join((FOLDER / each).read_bytes() for each in SHIPPED))
    links = list(link_triples(primitives))
    stated = hashlib.sha256("\n".join(sorted(map(str, links))).encode())
    loaded = [
        _load(store, "wordnet", shipped.hexdigest(), lambda: wordnet_triples(wordnet())),
        _load(store, "levin", shipped.hexdigest(), levin_triples),
        _load(store, "links", stated.hexdigest(), lambda: links),
    ]
    return any(loaded)


def load_verbnet(store: Store, classes: Sequence[VerbClass], words: WordNet) -> bool:
    """Put VerbNet's classes into a store, in place of those that it had.

    Returns:
        Whether anything was loaded; the same classes stay.
    """
    digest = hashlib.sha256(repr(classes).encode()).hexdigest()
    return _load(
        store,
        "verbnet",
        digest,
        lambda: (t for top in classes for each in top.family for t in _verbnet_class(each, words)),
    )


def _load(store: Store, source: str, digest: str, triples: Callable[[], Iterable[Triple]]) -> bool:
    """Fill a source's graph, its mark last: a graph without it is not whole, and is made again."""
    graph = names.GRAPHS[source]
    mark = Triple(graph, CAPAR.sha256, Literal(digest))
    if store.ask(f"ASK {{ GRAPH {graph} {{ {mark} }} }}").boolean:
        return False
    store.change(f"DROP SILENT GRAPH {graph}")
    quads = (Quad(each.subject, each.predicate, each.object, graph) for each in triples())
    if isinstance(store, EmbeddedStore):
        store.bulk(quads)
    else:
        while batch := list(islice(quads, BATCH)):
            store.insert(batch)
    store.insert([Quad(mark.subject, mark.predicate, mark.object, graph)])
    return True


def wordnet_triples(words: WordNet) -> Triples:
    """Every verb of a WordNet: words, senses and synsets of OntoLex, with their ILI."""
    for lemma in words.lemmas:
        label = {LABEL: _english(lemma.replace("_", " "))}
        yield from _stated(node("verb", lemma), NamedNode(ONTOLEX + "Word"), label)
    sentences = {str(each): Literal(frame_sentence(str(each))) for each in range(1, 36)}
    for value in words:
        synset = node("synset", value.offset)
        frames = sorted({each.partition(":")[0] for each in value.frames})
        properties: PropertyValues = {
            DEFINITION: _english(value.gloss),
            CAPAR.synsetOffset: value.offset,
            CAPAR.lexicographerFile: value.lexfile,
            CLOSE_MATCH: NamedNode(f"https://en-word.net/id/oewn-{value.offset}-v"),
            NamedNode(WN + "ili"): NamedNode(PREFIXES["ili"] + value.ili) if value.ili else None,
            NamedNode(WN + "hypernym"): [node("synset", above) for above in value.hypernyms],
            CAPAR.genericSentence: [sentences[frame] for frame in frames],
        }
        yield from _stated(synset, NamedNode(ONTOLEX + "LexicalConcept"), properties)
        for sense in value.senses:
            own = node("sense", sense.key)
            yield Triple(node("verb", sense.lemma.lower()), NamedNode(ONTOLEX + "sense"), own)
            of_sense: PropertyValues = {
                NamedNode(ONTOLEX + "isLexicalizedSenseOf"): synset,
                CAPAR.senseKey: sense.key,
                CAPAR.senseNumber: sense.number,
            }
            yield from _stated(own, NamedNode(ONTOLEX + "LexicalSense"), of_sense)


def levin_triples() -> Triples:
    """Levin's classes, with the thesis's claims and our remarks about them."""
    for levin in levin_classes().values():
        of_class: PropertyValues = {
            LABEL: _english(levin.title),
            NOTATION: levin.number,
            BROADER: node("levin", levin.broader) if levin.broader else None,
            CAPAR.classSize: levin.size or None,
            CLOSE_MATCH: [node("verbnet", name) for name in levin.verbnet],
        }
        yield from _stated(node("levin", levin.number), CAPAR.LevinClass, of_class)
    for index, claim in enumerate(thesis_claims()):
        of_claim: PropertyValues = {
            CAPAR.claimedBy: Claimant.THESIS.value,
            CAPAR.claimedStatus: claim.status.value,
            CAPAR.reason: Literal(claim.reason),
            CAPAR.section: Literal(claim.section),
            CAPAR.quote: Literal(claim.quote),
            CAPAR.printedClass: claim.said,
            CAPAR.levinClass: node("levin", claim.levin) if claim.levin else None,
            CAPAR.claimedVerb: [Literal(verb) for verb in claim.verbs],
        }
        yield from _stated(node("claim", str(index)), CAPAR.CapabilityClaim, of_claim)
    for index, remark in enumerate(remarks()):
        of_remark: PropertyValues = {
            COMMENT: _english(remark.text),
            CAPAR.claimedVerb: Literal(remark.verb),
            CAPAR.levinClass: node("levin", remark.levin),
        }
        yield from _stated(node("remark", str(index)), CAPAR.LexicalRemark, of_remark)


def link_triples(primitives: Iterable[PrimitiveWords]) -> Triples:
    """How primitives link to senses and classes, by the thesis and by us."""
    words = list(primitives)
    for link in (*thesis_senses(), *(link for each in words for link in sense_links(each))):
        action, sense = names.shared("action", link.primitive), node("sense", link.key)
        yield Triple(sense, NamedNode(ONTOLEX + "reference"), action)
        of_sense: PropertyValues = {
            CAPAR.linkedAction: action,
            CAPAR.linkedSense: sense,
            CAPAR.claimedBy: link.claimed_by.value,
            CAPAR.oldSenseNumber: link.number_1_6 or None,
            COMMENT: _english(link.remark) if link.remark else None,
        }
        own = names.shared("link", link.claimed_by.value, link.primitive, link.key)
        yield from _stated(own, CAPAR.LexicalLink, of_sense)
    for each in words:
        numbers, claimant = class_links(each)
        for number in numbers:
            of_class: PropertyValues = {
                CAPAR.linkedAction: names.shared("action", each.name),
                CAPAR.levinClass: node("levin", number),
                CAPAR.claimedBy: claimant.value,
            }
            own = names.shared("link", claimant.value, each.name, number)
            yield from _stated(own, CAPAR.LexicalLink, of_class)


def _verbnet_class(value: VerbClass, words: WordNet) -> Triples:
    """A class with what it states itself; senses where that WordNet has them."""
    whole = node("verbnet", value.id)

    def parts(of: NamedNode, word: str, values: Sequence[object]) -> list[NamedNode]:
        return [names.part(of, word, at) for at in range(len(values))]

    members = parts(whole, "member", value.members)
    roles = parts(whole, "role", value.roles)
    frames = parts(whole, "frame", value.frames)
    properties: PropertyValues = {
        LABEL: value.id,
        NOTATION: value.number,
        BROADER: node("verbnet", value.parent) if value.parent else None,
        CAPAR.levinClass: node("levin", value.levin) if value.levin in levin_classes() else None,
        CAPAR.classMember: members,
        CAPAR.thematicRole: roles,
        CAPAR.verbFrame: frames,
    }
    yield from _stated(whole, CAPAR.VerbNetClass, properties)
    for own, member in zip(members, value.members, strict=True):
        of_member: PropertyValues = {
            CAPAR.lemma: member.lemma.replace("_", " "),
            CAPAR.memberVerb: node("verb", member.lemma),
            CAPAR.senseKey: [Literal(key) for key in member.keys],
            CAPAR.memberSense: [node("sense", key) for key in member.keys if key in words],
        }
        yield from _stated(own, CAPAR.ClassMember, of_member)
    for index, (own, role) in enumerate(zip(roles, value.roles, strict=True)):
        of_role: PropertyValues = {
            LABEL: role.name,
            CAPAR.index: index,
            CAPAR.restriction: [Literal(each) for each in role.restrictions],
        }
        yield from _stated(own, CAPAR.ThematicRole, of_role)
    for index, (own, frame) in enumerate(zip(frames, value.frames, strict=True)):
        meanings = parts(own, "predicate", frame.semantics)
        syntax = "; ".join(f"{each.kind} {each.value}".strip() for each in frame.syntax)
        of_frame: PropertyValues = {
            CAPAR.index: index,
            CAPAR.pattern: Literal(frame.pattern),
            CAPAR.example: Literal(frame.example),
            CAPAR.syntax: Literal(syntax),
            CAPAR.semanticPredicate: meanings,
        }
        yield from _stated(own, CAPAR.VerbFrame, of_frame)
        for number, (meaning, one) in enumerate(zip(meanings, frame.semantics, strict=True)):
            of_predicate: PropertyValues = {
                CAPAR.index: number,
                CAPAR.predicateName: Literal(one.name),
                CAPAR.holds: one.holds,
                CAPAR.arguments: Literal("|".join(one.arguments)),
            }
            yield from _stated(meaning, CAPAR.SemanticPredicate, of_predicate)


# Out of a store


def has_source(store: Store, source: str) -> bool:
    """Whether a source's graph is there, and whole."""
    graph = names.GRAPHS[source]
    asked = f"ASK {{ GRAPH {graph} {{ {graph} {CAPAR.sha256} ?digest }} }}"
    return bool(store.ask(asked).boolean)


def verbnet_of(store: Store, lemma: str) -> tuple[VerbClass, ...]:
    """VerbNet's classes of a verb and those that they refine, without their subclasses.

    The classes that list the verb themselves come with all their members; each stands before
    the classes that it refines.
    """
    path = f"{CAPAR.classMember}/{CAPAR.memberVerb}"
    return _read_classes(store, f"?class {path} {node('verb', lemma.lower())}")


def verbnet_class_of(store: Store, levin: str) -> tuple[VerbClass, ...]:
    """VerbNet's classes of a Levin class, with the subclasses beside them."""
    return _read_classes(store, f"?class {CAPAR.levinClass} {node('levin', levin)}")


def every_verbnet_member(store: Store) -> tuple[VerbClass, ...]:
    """VerbNet's classes with their members alone, by name."""
    asked = f"?class {LABEL} ?id ; {CAPAR.classMember}/{CAPAR.lemma} ?lemma"
    rows = store.ask(
        f"SELECT ?id ?lemma {{ GRAPH {names.GRAPHS['verbnet']} {{ {asked} }} }}"
    ).texts()
    found: dict[str, set[str]] = {}
    for name, lemma in rows:
        found.setdefault(name, set()).add(lemma)
    return tuple(
        VerbClass(name, "", tuple(Member(each, ()) for each in sorted(lemmas)), (), (), ())
        for name, lemmas in sorted(found.items())
    )


def _read_classes(store: Store, pattern: str) -> tuple[VerbClass, ...]:
    """The classes that a pattern finds and all that they refine, sorted by name."""
    graph = names.GRAPHS["verbnet"]
    rows = store.ask(
        f"SELECT DISTINCT ?up {{ GRAPH {graph} {{ {pattern} . ?class {BROADER}* ?up }} }}"
    )
    nodes = [row[0] for row in rows.rows if isinstance(row[0], NamedNode)]
    if not nodes:
        return ()
    parts = "|".join(map(str, (CAPAR.classMember, CAPAR.thematicRole, CAPAR.verbFrame)))
    predicates = f"{CAPAR.verbFrame}/{CAPAR.semanticPredicate}"

    def of(name: str) -> str:
        return f"VALUES {name} {{ {' '.join(map(str, nodes))} }}"

    # The classes stand in each branch, so that the store begins with them.
    stated = store.ask(
        f"CONSTRUCT {{ ?s ?p ?o }} {{ GRAPH {graph} {{ {{ {of('?s')} ?s ?p ?o }} "
        f"UNION {{ {of('?class')} ?class {parts} ?s . ?s ?p ?o }} "
        f"UNION {{ {of('?class')} ?class {predicates} ?s . ?s ?p ?o }} }} }}"
    )
    index = StatementIndex(stated.triples or ())
    return tuple(sorted((_class_of(index, each) for each in nodes), key=lambda each: each.id))


def _class_of(of: StatementIndex, whole: NamedNode) -> VerbClass:
    parent = of.one(whole, BROADER)
    members = sorted(
        Member(of.text(each, CAPAR.lemma).replace(" ", "_"), of.texts(each, CAPAR.senseKey))
        for each in of.all(whole, CAPAR.classMember)
    )
    roles = [
        Role(of.text(each, LABEL), of.texts(each, CAPAR.restriction))
        for each in of.ordered(whole, CAPAR.thematicRole, by=CAPAR.index)
    ]
    frames = []
    for each in of.ordered(whole, CAPAR.verbFrame, by=CAPAR.index):
        phrases = (one.partition(" ") for one in of.text(each, CAPAR.syntax).split("; ") if one)
        semantics = [
            Predicate(
                of.text(one, CAPAR.predicateName),
                tuple(of.text(one, CAPAR.arguments).split("|")),
                holds=of.value(one, CAPAR.holds) is True,
            )
            for one in of.ordered(each, CAPAR.semanticPredicate, by=CAPAR.index)
        ]
        frames.append(
            Frame(
                of.text(each, CAPAR.pattern),
                of.text(each, CAPAR.example),
                tuple(Phrase(kind, value) for kind, _, value in phrases),
                tuple(semantics),
            )
        )
    above = of.text(parent, LABEL) if parent else ""
    return VerbClass(of.text(whole, LABEL), above, tuple(members), tuple(roles), tuple(frames), ())
