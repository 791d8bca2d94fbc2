"""Observations as they are stored: their files and segments, and several replaced at once."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from capar.model.par import UNKNOWN
from kb.encode.observation import encode, run, run_removal
from kb.store import names, updates
from kb.store.sparql import stored
from kb.store.stores import Store
from kb.store.validation import check_statements

if TYPE_CHECKING:
    from capar.model.observation import Observation


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


def source_files(store: Store, name: str) -> tuple[tuple[str, str], ...]:
    """Path and SHA-256 of each file that an observation's capture was read from."""
    rows = store.ask(stored("source_files", graph=str(names.observation(name)))).texts()
    return tuple((row[0], row[1]) for row in rows)


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


def named_segments(store: Store, name: str) -> tuple[NamedSegment, ...]:
    """The segments of an observation as they are stored, by end-effector and time."""
    found: dict[tuple[str, int, int, int, float, float, str], set[str]] = {}
    for row in store.ask(stored("named_segments", graph=str(names.observation(name)))).texts():
        ee, index, first, last, start, end, called, other = row
        place = ee, int(index), int(first), int(last), float(start), float(end)
        others = found.setdefault((*place, called or UNKNOWN), set())
        if other and called:
            others.add(other)
    return tuple(sorted(NamedSegment(*place, tuple(sorted(found[place]))) for place in found))
