"""The IRIs of things in the store, each derived from what it names alone."""

import hashlib
from functools import lru_cache
from urllib.parse import quote, unquote

from pyoxigraph import NamedNode

from ontology import BASE, DATA
from ontology import files as ontology_files

OBSERVATION = DATA + "observation/"

GRAPHS = {
    **{e: NamedNode(f"{DATA}graph/{e}") for e in ("ontology", "agents", "objects", "actions")},
    **{e: NamedNode(f"{DATA}graph/lexicon/{e}") for e in ("wordnet", "levin", "verbnet", "links")},
    **{e: NamedNode(f"{DATA}graph/{e}") for e in ("imported", "runs", "corrections")},
}
"""The named graphs that are no observation's, by what they hold."""

_FOLDERS = {
    "agents": "agent",
    "objects": "kind",
    "actions": "action upar condition features complex rules rule threshold",
    "runs": "run",
    "corrections": "correction person",
    "ontology": "graph",
    "wordnet": "synset sense verb",
    "levin": "levin claim remark",
    "verbnet": "verbnet",
}
_GRAPH_OF = {folder: GRAPHS[name] for name, own in _FOLDERS.items() for folder in own.split()}


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
    if subject in GRAPHS.values():
        return subject
    if iri.startswith(DATA):
        folder, _, name = iri.removeprefix(DATA).partition("/")
        if folder == "kind" and unquote(name) in ontology_files.kinds():
            return GRAPHS["ontology"]
        return _GRAPH_OF.get(folder, GRAPHS["imported"])
    if iri.startswith(BASE) or iri == BASE.removesuffix("#"):
        return GRAPHS["ontology"]
    return GRAPHS["imported"]
