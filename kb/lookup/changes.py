"""The files and segments of an observation, and several observations replaced at once."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pyoxigraph import Literal

from capar.model.par import UNKNOWN
from kb.encode import encode
from kb.encode.run import run, run_removal
from kb.store import names
from kb.store import updates as writing
from kb.store.shacl_validation import validate_statements
from kb.store.sparql import fill
from kb.store.stores import Store
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import Observation

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
    others: tuple[str, ...] = ()
    """Names that fit it equally well; none of an unknown segment."""


_SEGMENTS = f"""SELECT ?ee ?index ?first ?last ?start ?end ?name ?other
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
  OPTIONAL {{
    GRAPH @graph@ {{ ?segment {CAPAR.candidate} ?candidate }}
    ?candidate {CAPAR.name} ?other
  }}
}}
ORDER BY ?ee ?index"""


def named_segments(store: Store, name: str) -> tuple[NamedSegment, ...]:
    """The segments of an observation as they are stored, by end-effector and time."""
    found: dict[tuple[str, int, int, int, float, float, str], set[str]] = {}
    for row in store.ask(fill(_SEGMENTS, graph=str(names.observation(name)))).rows:
        ee, index, first, last, start, end, called, other = (
            each.value if isinstance(each, Literal) else "" for each in row
        )
        place = ee, int(index), int(first), int(last), float(start), float(end)
        others = found.setdefault((*place, called or UNKNOWN), set())
        if other and called:
            others.add(other)
    return tuple(sorted(NamedSegment(*place, tuple(sorted(found[place]))) for place in found))


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
        updates.append(run_removal(graph))
        updates.append(writing.replacement(graph, [*statements.quads, *run(observation)]))
    if updates:
        store.change(" ;\n".join(updates))
