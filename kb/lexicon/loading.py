"""Words into a store, once each, and VerbNet's classes of a verb out of it."""

import hashlib
from collections.abc import Callable, Iterable, Sequence
from itertools import islice

from pyoxigraph import Literal, NamedNode, Quad, Triple

from kb.lexicon import terms
from kb.lexicon.links import PrimitiveWords
from kb.lexicon.rdf_links import levin_triples, link_triples
from kb.lexicon.rdf_verbnet import BROADER, Row, classes_from, verbnet_triples
from kb.lexicon.rdf_wordnet import wordnet_triples
from kb.lexicon.tables import FOLDER
from kb.lexicon.verbnet import Member, VerbClass
from kb.lexicon.wordnet import WordNet, wordnet
from kb.store.stores import EmbeddedStore, Store
from ontology import CAPAR

BATCH = 20_000
"""Statements that are sent to a server in one request."""

SHIPPED = ("wordnet-3.1-verbs.tsv.gz", "wordnet-frames.tsv", "levin.tsv", "thesis_claims.tsv")


def load_words(store: Store, primitives: Sequence[PrimitiveWords] = ()) -> bool:
    """Put WordNet's verbs, Levin's classes and the primitives' links into a store.

    Returns:
        Whether anything was loaded; what is there already stays.
    """
    shipped = hashlib.sha256(b"".join((FOLDER / each).read_bytes() for each in SHIPPED))
    loaded = [
        _load(store, "wordnet", shipped.hexdigest(), lambda: wordnet_triples(wordnet())),
        _load(store, "levin", shipped.hexdigest(), levin_triples),
    ]
    links = list(link_triples(primitives))
    stated = hashlib.sha256("\n".join(sorted(map(str, links))).encode())
    loaded.append(_load(store, "links", stated.hexdigest(), lambda: links))
    return any(loaded)


def load_verbnet(store: Store, classes: Sequence[VerbClass], words: WordNet) -> bool:
    """Put VerbNet's classes into a store, in place of those that it had.

    Returns:
        Whether anything was loaded; the same classes stay.
    """
    digest = hashlib.sha256(repr(classes).encode()).hexdigest()
    return _load(store, "verbnet", digest, lambda: verbnet_triples(classes, words))


def _load(store: Store, source: str, digest: str, triples: Callable[[], Iterable[Triple]]) -> bool:
    """Fill a source's graph, its mark last: a graph without it is not whole, and is made again."""
    graph = terms.graph(source)
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


def has_source(store: Store, source: str) -> bool:
    """Whether a source's graph is there, and whole."""
    graph = terms.graph(source)
    asked = f"ASK {{ GRAPH {graph} {{ {graph} {CAPAR.sha256} ?digest }} }}"
    return bool(store.ask(asked).boolean)


def verbnet_of(store: Store, lemma: str) -> tuple[VerbClass, ...]:
    """VerbNet's classes of a verb and those that they refine, without their subclasses.

    The classes that list the verb themselves come with all their members; each stands before
    the classes that it refines.
    """
    listed = _ask(
        store,
        f"?class {CAPAR.classMember}/{CAPAR.memberVerb} {terms.verb(lemma.lower())} .",
        "?class",
    )
    found = [str(row["class"]) for row in listed]
    return read_classes(store, found) if found else ()


def verbnet_class_of(store: Store, levin: str) -> tuple[VerbClass, ...]:
    """VerbNet's classes of a Levin class, with the subclasses beside them."""
    rows = _ask(store, f"?class {CAPAR.levinClass} {terms.levin(levin)} .", "?class")
    return read_classes(store, [str(row["class"]) for row in rows])


def every_verbnet_member(store: Store) -> tuple[VerbClass, ...]:
    """VerbNet's classes with their members alone, by name."""
    rows = _ask(
        store,
        f"?class {terms.LABEL} ?id ; {CAPAR.classMember} ?m . ?m {CAPAR.lemma} ?lemma",
        "?id ?lemma",
    )
    found: dict[str, set[str]] = {}
    for row in rows:
        found.setdefault(str(row["id"]), set()).add(str(row["lemma"]))
    return tuple(
        VerbClass(name, "", tuple(Member(each, ()) for each in sorted(lemmas)), (), (), ())
        for name, lemmas in sorted(found.items())
    )


def read_classes(store: Store, nodes: Sequence[str]) -> tuple[VerbClass, ...]:
    """The classes of these IRIs and all that they refine, sorted by name."""
    if not nodes:
        return ()
    chosen = (
        f"VALUES ?class {{ {' '.join(_with_parents(store, nodes))} }} ?class {terms.LABEL} ?id ."
    )
    heads = _ask(
        store,
        f"{chosen} OPTIONAL {{ ?class {BROADER}/{terms.LABEL} ?parent }}",
        "?id ?parent",
    )
    members = _ask(
        store,
        f"{chosen} ?class {CAPAR.classMember} ?m . ?m {CAPAR.lemma} ?lemma . "
        f"OPTIONAL {{ ?m {CAPAR.senseKey} ?key }}",
        "?id ?lemma ?key",
    )
    roles = _ask(
        store,
        f"{chosen} ?class {CAPAR.thematicRole} ?r . ?r {terms.LABEL} ?role ; {CAPAR.index} ?index ."
        f" OPTIONAL {{ ?r {CAPAR.restriction} ?restriction }}",
        "?id ?role ?index ?restriction",
    )
    frames = _ask(
        store,
        f"{chosen} ?class {CAPAR.verbFrame} ?f . ?f {CAPAR.index} ?frame ; {CAPAR.pattern} ?pattern"
        f" ; {CAPAR.example} ?example ; {CAPAR.syntax} ?syntax",
        "?id ?frame ?pattern ?example ?syntax",
    )
    predicates = _ask(
        store,
        f"{chosen} ?class {CAPAR.verbFrame} ?f . ?f {CAPAR.index} ?frame ; "
        f"{CAPAR.semanticPredicate} ?p . ?p {CAPAR.predicateName} ?name ; {CAPAR.index} ?place ; "
        f"{CAPAR.holds} ?holds ; {CAPAR.arguments} ?arguments",
        "?id ?frame ?name ?place ?holds ?arguments",
    )
    found = classes_from(heads, members, roles, frames, predicates)
    return tuple(sorted(found, key=lambda each: each.id))


def _with_parents(store: Store, nodes: Sequence[str]) -> list[str]:
    """The classes and those that they refine, as terms, sorted."""
    found, waiting = set[str](), set(nodes)
    while waiting:
        found |= waiting
        values = " ".join(f"<{each}>" for each in sorted(waiting))
        rows = _ask(store, f"VALUES ?class {{ {values} }} ?class {BROADER} ?parent", "?parent")
        waiting = {str(row["parent"]) for row in rows} - found
    return [f"<{each}>" for each in sorted(found)]


def _ask(store: Store, where: str, variables: str) -> list[Row]:
    graph = terms.graph("verbnet")
    answer = store.ask(f"SELECT {variables} WHERE {{ GRAPH {graph} {{ {where} }} }}")
    plain = list(answer.plain())
    for row, terms_of in zip(plain, answer.rows, strict=True):
        for name, term in zip(answer.variables, terms_of, strict=True):
            if isinstance(term, NamedNode):
                row[name] = term.value
    return list(plain)
