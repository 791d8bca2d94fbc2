"""Words in a store: loaded once, whole, and there to be asked."""

from pyoxigraph import Literal

from kb.lexicon.links import PrimitiveWords
from kb.lexicon.loading import WN, has_source, load_words, node
from kb.store.names import GRAPHS
from kb.store.stores import Store, open_store
from ontology import CAPAR, PREFIXES

WORDS = (PrimitiveWords("Hit", ("hit",)), PrimitiveWords("Own", ("nudge",), levin=("20",)))


def test_words_are_loaded_once_and_whole() -> None:
    store = open_store(None)
    assert load_words(store, WORDS)
    assert not load_words(store, WORDS)
    _sense_leads_to_its_synset(store)
    _links_say_who_claims_them(store)
    _every_kind_of_move_is_found(store)
    _other_links_replace_the_old(store)


def _sense_leads_to_its_synset(store: Store) -> None:
    (row,) = store.ask(
        f"SELECT ?ili ?gloss WHERE {{ {node('sense', 'hit%2:35:00::')} "
        f"<{PREFIXES['ontolex']}isLexicalizedSenseOf> ?s . ?s <{WN}ili> ?ili ; "
        f"<{PREFIXES['skos']}definition> ?gloss }}"
    ).plain()
    assert row["ili"] == "ili:i28723"
    assert str(row["gloss"]).startswith("deal a blow to")


def _links_say_who_claims_them(store: Store) -> None:
    rows = store.ask(
        f"SELECT ?by (COUNT(?link) AS ?count) WHERE {{ ?link a {CAPAR.LexicalLink} ; "
        f"{CAPAR.claimedBy} ?by }} GROUP BY ?by ORDER BY ?by"
    ).plain()
    assert {row["by"]: row["count"] for row in rows} == {"lexicon": 5, "rules": 1, "thesis": 12}


def _every_kind_of_move_is_found(store: Store) -> None:
    (row,) = store.ask(
        f"SELECT (COUNT(DISTINCT ?kind) AS ?count) WHERE {{ ?kind <{WN}hypernym>+ ?move . "
        f"{node('sense', 'move%2:38:01::')} <{PREFIXES['ontolex']}isLexicalizedSenseOf> ?move }}"
    ).plain()
    assert row["count"] == 1039


def _other_links_replace_the_old(store: Store) -> None:
    assert load_words(store, WORDS[:1])
    asked = f"ASK {{ ?link {CAPAR.claimedBy} {Literal('rules')} }}"
    assert not store.ask(asked).boolean


def test_a_graph_without_its_mark_is_made_anew() -> None:
    store = open_store(None)
    load_words(store, WORDS)
    graph = GRAPHS["levin"]
    store.change(f"DELETE WHERE {{ GRAPH {graph} {{ {graph} ?p ?o }} }}")
    assert not has_source(store, "levin")
    assert load_words(store, WORDS)
    assert has_source(store, "levin")
