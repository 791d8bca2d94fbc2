"""The measured facts of an observation, and several observations replaced at once."""

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from pyoxigraph import Literal, NamedNode

from capar.model.facts import ALL_FACT_KINDS, Fact, MovedBy
from capar.model.par import UNKNOWN
from kb.encode import encode
from kb.encode.facts import terms
from kb.store import names
from kb.store import updates as writing
from kb.store.shacl_validation import validate_statements
from kb.store.sparql import fill
from kb.store.stores import Store
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import Observation

_FACTS = f"""SELECT ?fact ?property ?value
WHERE {{ GRAPH @graph@ {{ @graph@ {CAPAR.fact} ?fact . ?fact ?property ?value }} }}"""

_TYPE = NamedNode("http://www.w3.org/1999/02/22-rdf-syntax-ns#type")


def facts(store: Store, name: str) -> tuple[Fact, ...]:
    """What was measured in the capture of an observation, in the order of the extractors.

    What moves what is left out, as that is derived; so are kinds of facts that an older program
    measured and this one does not.
    """
    said: dict[str, dict[str, str]] = defaultdict(dict)
    kinds: dict[str, str] = {}
    for fact, key, value in store.ask(fill(_FACTS, graph=str(names.observation(name)))).rows:
        if key == _TYPE:
            kinds[str(fact)] = str(value)
        else:
            said[str(fact)][str(key)] = value.value if isinstance(value, Literal) else str(value)
    stated = [_fact(kinds[node], said[node]) for node in said]
    found = [each for each in stated if each is not None and not isinstance(each, MovedBy)]
    rank: dict[type[Fact], int] = {kind: index for index, kind in enumerate(ALL_FACT_KINDS)}
    return tuple(sorted(found, key=lambda each: (rank[type(each)], each)))


_FILES = f"""SELECT ?path ?digest
WHERE {{ GRAPH @graph@ {{ ?file {CAPAR.filePath} ?path ; {CAPAR.sha256} ?digest }} }}
ORDER BY ?path"""


def source_files(store: Store, name: str) -> tuple[tuple[str, str], ...]:
    """Path and SHA-256 of each file that an observation's capture was read from."""
    rows = store.ask(fill(_FILES, graph=str(names.observation(name)))).rows
    return tuple(
        (path.value, digest.value)
        for path, digest in rows
        if isinstance(path, Literal) and isinstance(digest, Literal)
    )


@dataclass(frozen=True, slots=True, order=True)
class NamedSegment:
    """A segment, between which frames it is, and what it is called."""

    ee: str
    index: int
    first: int
    last: int
    start_s: float
    end_s: float
    name: str


_SEGMENTS = f"""SELECT ?ee ?index ?first ?last ?start ?end ?name
WHERE {{
  GRAPH @graph@ {{
    @graph@ {CAPAR.segment} ?segment .
    ?segment {CAPAR.ee} ?ee ; {CAPAR.index} ?index ;
      {CAPAR.firstFrame} ?first ; {CAPAR.lastFrame} ?last ;
      {CAPAR.start} ?start ; {CAPAR.end} ?end .
  }}
  OPTIONAL {{
    GRAPH @graph@ {{ ?segment {CAPAR.action} ?action }}
    ?action {CAPAR.name} ?name
  }}
}}
ORDER BY ?ee ?index"""


def named_segments(store: Store, name: str) -> tuple[NamedSegment, ...]:
    """The segments of an observation as they are stored, by end-effector and time."""
    found = set()
    for row in store.ask(fill(_SEGMENTS, graph=str(names.observation(name)))).rows:
        ee, index, first, last, start, end, called = (
            each.value if isinstance(each, Literal) else "" for each in row
        )
        place = ee, int(index), int(first), int(last), float(start), float(end)
        found.add(NamedSegment(*place, called or UNKNOWN))
    return tuple(sorted(found))


_BY_CLASS = {str(terms(kind)[0]): kind for kind in ALL_FACT_KINDS if terms(kind)[0] != CAPAR.Fact}
_BY_PREDICATE = {each.predicate: each for each in ALL_FACT_KINDS}


def _fact(kind: str, said: dict[str, str]) -> Fact | None:
    cls = _BY_CLASS.get(kind) or _BY_PREDICATE.get(said.get(str(CAPAR.name), ""))
    if cls is None:
        return None
    if kind in _BY_CLASS:
        values = [said[str(each)] for each in terms(cls)[1:]]
    else:
        values = said[str(CAPAR.parameters)].split(" ")
    return cls(
        *(
            int(value) if each.type is int else value
            for each, value in zip(fields(cls), values, strict=True)
        )
    )


def replace_all(store: Store, observations: Iterable[tuple["Observation", str]]) -> None:
    """Put several observations in the places of those of their captures, in one transaction.

    Args:
        store: Where they are.
        observations: Each with what its complex action is called.

    Raises:
        ShapeError: One of them breaks the model; then none is replaced.
    """
    updates = []
    for observation, called in observations:
        statements = encode(observation, name=called)
        validate_statements(observation.capture, statements)
        graph = names.observation(observation.capture)
        updates.append(writing.replacement(graph, statements.quads))
    if updates:
        store.change(" ;\n".join(updates))
