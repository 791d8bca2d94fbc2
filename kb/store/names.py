"""The IRIs of things in the store, each derived from what it names alone."""

import hashlib
from functools import lru_cache
from urllib.parse import quote, unquote

from pyoxigraph import NamedNode

from ontology import BASE, DATA
from ontology import files as ontology_files

OBSERVATION = DATA + "observation/"

GRAPHS = {
    "ontology": NamedNode(DATA + "graph/ontology"),
    "agents": NamedNode(DATA + "graph/agents"),
    "objects": NamedNode(DATA + "graph/objects"),
    "actions": NamedNode(DATA + "graph/actions"),
    "wordnet": NamedNode(DATA + "graph/lexicon/wordnet"),
    "levin": NamedNode(DATA + "graph/lexicon/levin"),
    "verbnet": NamedNode(DATA + "graph/lexicon/verbnet"),
    "links": NamedNode(DATA + "graph/lexicon/links"),
    "imported": NamedNode(DATA + "graph/imported"),
    "runs": NamedNode(DATA + "graph/runs"),
    "corrections": NamedNode(DATA + "graph/corrections"),
}
"""The named graphs that are no observation's, by what they hold."""

_GRAPHS_BY_IRI = frozenset(each.value for each in GRAPHS.values())

_OF_FOLDER = {
    "agent": "agents",
    "kind": "objects",
    "action": "actions",
    "upar": "actions",
    "condition": "actions",
    "features": "actions",
    "row": "actions",
    "complex": "actions",
    "rules": "actions",
    "rule": "actions",
    "threshold": "actions",
    "run": "runs",
    "correction": "corrections",
    "person": "corrections",
    "graph": "ontology",
    "synset": "wordnet",
    "sense": "wordnet",
    "verb": "wordnet",
    "levin": "levin",
    "verbnet": "verbnet",
    "claim": "levin",
    "remark": "levin",
}


@lru_cache(maxsize=4096)
def _quoted(word: str) -> str:
    """A word of an IRI: never empty, and with no dot at its end, which not every reader takes."""
    if word in {"", "-"}:
        return "%2D" if word else "-"
    quoted = quote(word, safe="")
    return quoted[:-1] + "%2E" if quoted.endswith(".") else quoted


def observation(name: str) -> NamedNode:
    """The observation of a capture of that name; its graph has the same IRI."""
    return NamedNode(OBSERVATION + _quoted(name))


def observation_name(node: NamedNode) -> str:
    """The name of the capture that an observation is of."""
    return unquote(node.value.removeprefix(OBSERVATION))


def part(of: NamedNode, *words: str | int) -> NamedNode:
    """Something that belongs to an observation or another whole, by what distinguishes it."""
    fragment = ".".join(_quoted(str(each)) for each in words)
    return NamedNode(f"{of.value}{'.' if '#' in of.value else '#'}{fragment}")


def shared(folder: str, *words: str | int) -> NamedNode:
    """Something that several observations may speak of, by what distinguishes it."""
    return NamedNode(DATA + folder + "/" + ".".join(_quoted(str(each)) for each in words))


def last_word(node: NamedNode) -> str:
    """What a shared thing of one word is called."""
    return unquote(node.value.rsplit("/", 1)[1])


def hashed(content: object) -> str:
    """A short name that follows from the content's printed form."""
    return hashlib.sha256(repr(content).encode()).hexdigest()[:24]


def graph_of(subject: NamedNode) -> NamedNode:
    """The graph in which statements about a thing stand."""
    iri = subject.value
    if iri.startswith(OBSERVATION):
        return NamedNode(iri.partition("#")[0])
    if iri in _GRAPHS_BY_IRI:
        return subject
    if iri.startswith(DATA):
        folder, _, name = iri.removeprefix(DATA).partition("/")
        if folder == "kind" and unquote(name) in ontology_files.kinds():
            return GRAPHS["ontology"]
        return GRAPHS[_OF_FOLDER.get(folder, "imported")]
    if iri.startswith(BASE) or iri == BASE.removesuffix("#"):
        return GRAPHS["ontology"]
    return GRAPHS["imported"]
