"""Whole observations: kept, listed, forgotten, replaced, and what is told of each."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from capar.model.errors import UnknownNameError
from capar.model.par import UNKNOWN
from kb.encode.observation import encode, identity, run, run_removal
from kb.errors import ExistsError
from kb.lookup.agents import aliases, joined
from kb.lookup.pars import observations, recognise
from kb.store import names, updates
from kb.store.sparql import fill
from kb.store.stores import Store, is_address
from kb.store.validation import check_statements
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import Observation


@dataclass(frozen=True, slots=True)
class Added:
    """The result of adding an observation."""

    name: str
    action: str
    """What its complex action is called."""

    recognised: str
    """Under which name that action was known before; empty if it was not."""

    replaced: bool
    """Whether it took the place of an observation of the same capture."""

    statements: int


def add(store: Store, observation: "Observation", *, name: str | None, replace: bool) -> Added:
    """Keep an observation, whole and checked."""
    graph = names.observation(observation.capture)
    there = store.ask(f"SELECT ?identity WHERE {{ {graph} {CAPAR.identity} ?identity }}").rows
    same = there and getattr(there[0][0], "value", "") == identity(observation)
    if there and not same and not replace:
        raise ExistsError(
            f"an observation {observation.capture!r} of another capture is in {store.place}; "
            "give this capture another name, forget that one, or ask to replace it"
        )
    recognised = recognise(store, observation.complex_par, besides=graph) or ""
    called = name or observation.complex_par.name or recognised or observation.capture
    statements = encode(observation, name=called)
    check_statements(observation.capture, statements.things)
    quads = joined(statements.quads, aliases(store))
    if there or is_address(store.place):
        change = updates.replacement(graph, [*quads, *run(observation)])
        store.change(f"{run_removal(graph)} ;\n{change}")
    else:
        store.insert([*quads, *run(observation)])
    return Added(observation.capture, called, recognised, bool(there), len(quads))


def forget(store: Store, name: str) -> None:
    """Take an observation back, and what no other one mentions."""
    known = [each.name for each in observations(store)]
    if name not in known:
        raise UnknownNameError("observation", name, known, where=store.place)
    graph = names.observation(name)
    store.change(f"{run_removal(graph)} ;\n{updates.removal(graph)}")


def replace_all(store: Store, replacements: Iterable[tuple["Observation", str]]) -> None:
    """Put several observations in the places of those of their captures, in one transaction.

    Args:
        store: Where they are.
        replacements: Observations, each with what its complex action is called.

    Raises:
        ShapeError: One of them breaks the model; then none is replaced.
    """
    changes = []
    for observation, called in replacements:
        statements = encode(observation, name=called)
        check_statements(observation.capture, statements.things)
        graph = names.observation(observation.capture)
        changes.append(run_removal(graph))
        changes.append(updates.replacement(graph, [*statements.quads, *run(observation)]))
    if changes:
        store.change(" ;\n".join(changes))


_FILES = f"""SELECT ?path ?digest
WHERE {{ GRAPH @graph@ {{ ?file {CAPAR.filePath} ?path ; {CAPAR.sha256} ?digest }} }}
ORDER BY ?path"""


def source_files(store: Store, name: str) -> tuple[tuple[str, str], ...]:
    """Path and SHA-256 of each file that an observation's capture was read from."""
    rows = store.ask(fill(_FILES, graph=str(names.observation(name)))).texts()
    return tuple((path, digest) for path, digest in rows)


@dataclass(frozen=True, slots=True, order=True)
class NamedSegment:
    """A segment with its frames, times and name."""

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
    for row in store.ask(fill(_SEGMENTS, graph=str(names.observation(name)))).texts():
        ee, index, first, last, start, end, called, other = row
        place = ee, int(index), int(first), int(last), float(start), float(end)
        others = found.setdefault((*place, called or UNKNOWN), set())
        if other and called:
            others.add(other)
    return tuple(sorted(NamedSegment(*place, tuple(sorted(found[place]))) for place in found))
