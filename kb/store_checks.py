"""Checks of what is stored: shapes, NLTs, dangling references, incomplete observations."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from typing import Any

from pyoxigraph import Literal, NamedNode, Quad, Triple

from kb.exchange import part
from kb.lookup.stored import observations
from kb.store import names, shacl_validation
from kb.store.consistency import inconsistencies
from kb.store.literals import LiteralError, nlt_of, numbers
from kb.store.sparql import fill
from kb.store.stores import Store
from ontology import BASE, CAPAR, DATA
from ontology.files import ontology, ontology_kinds, shape_files, subclasses

REACH_M = 0.1
"""How far from an object's origin, beyond its own size, its constraints may lie [m]."""

_DANGLING = f"""SELECT DISTINCT ?thing ?property ?nowhere
WHERE {{
  GRAPH @graph@ {{ ?thing ?property ?nowhere }}
  FILTER(isIRI(?nowhere) && STRSTARTS(STR(?nowhere), "{DATA}"))
  FILTER NOT EXISTS {{ ?nowhere ?any ?value }}
}}"""

_NLTS = (
    (CAPAR.eeNlt, CAPAR.dominant),
    (CAPAR.goalNlt, CAPAR.goal),
    (CAPAR.vNlt, CAPAR.seen),
)


@dataclass(frozen=True, slots=True, order=True)
class Problem:
    """A fault in what is stored."""

    observation: str
    """Empty where the fault is of no observation."""

    thing: str
    message: str


def check(store: Store, *, full: bool = True) -> tuple[Problem, ...]:
    """The faults of a store, observation by observation.

    Args:
        store: What to look at.
        full: Whether SHACL itself judges (pySHACL), rather than our fast reading of the shapes.

    Raises:
        DamagedError: A statement cannot be read.
    """
    store.check_readable()
    found: list[Problem] = []
    for each in observations(store):
        quads = part(store, each.name)
        triples = [quad.triple for quad in quads]
        judged = by_shacl(triples) if full else _by_rules(triples)
        found += [Problem(each.name, thing, message) for thing, message in judged]
        found += [
            Problem(each.name, *_split(line)) for line in shacl_validation.nlt_problems(triples)
        ]
        found += [Problem(each.name, *_split(line)) for line in inconsistencies(triples)]
        found += [Problem(each.name, *_split(line)) for line in _out_of_reach(quads)]
        found += [Problem(each.name, *_split(line)) for line in _dangling(store, each.name)]
    found += _unlisted(store)
    return tuple(sorted(set(found)))


def _split(line: str) -> tuple[str, str]:
    thing, _, message = line.partition(": ")
    return thing, message


def _by_rules(triples: list[Triple]) -> list[tuple[str, str]]:
    return [_split(line) for line in shacl_validation.violations(triples)]


def by_shacl(triples: Iterable[Triple]) -> list[tuple[str, str]]:
    """What pySHACL finds wrong with statements: the thing and the message, sorted."""
    from pyshacl import validate
    from rdflib import Graph, Namespace

    shacl = Namespace(shacl_validation.SH)
    data = Graph()
    stated = [*triples, *subclasses()]
    stated += _of_ontology(stated)
    data.parse(data="".join(f"{each} .\n" for each in stated), format="nt")
    _, report, _ = validate(data, shacl_graph=_shapes(), inference="none", advanced=False)
    assert isinstance(report, Graph)
    found = {
        (str(report.value(each, shacl.focusNode)), str(report.value(each, shacl.resultMessage)))
        for each in report.objects(None, shacl.result)
    }
    return sorted((thing.rsplit("/", 1)[-1], message) for thing, message in found)


def _of_ontology(triples: Iterable[Triple]) -> list[Triple]:
    """What the ontology says of its things to which statements refer."""
    named = {each.object for each in triples if isinstance(each.object, NamedNode)}
    return [each for each in ontology() if each.subject in named & ontology_kinds().keys()]


@cache
def _shapes() -> Any:
    """Every shape, as rdflib's graph."""
    from rdflib import Graph

    graph = Graph()
    for file in shape_files():
        graph.parse(data=file.read_text("utf-8"), format="turtle")
    return graph


def _out_of_reach(quads: list[Quad]) -> list[str]:
    """NLTs that lie further from an object's origin than the object is large."""
    said: dict[tuple[object, NamedNode], object] = {
        (each.subject, each.predicate): each.object for each in quads
    }
    found = []
    for (thing, predicate), value in said.items():
        for nlt, owner in _NLTS:
            if predicate == nlt and isinstance(value, Literal):
                size = said.get((said.get((thing, owner)), CAPAR.size))
                if isinstance(size, Literal) and not _within(value.value, size.value):
                    found.append(
                        f"{_tail(thing)}: {predicate.value.removeprefix(BASE)} {value.value!r} "
                        f"lies outside the reach of an object of {size.value} m"
                    )
    return sorted(found)


def _within(nlt: str, size: str) -> bool:
    try:
        place, lengths = nlt_of(nlt).position, numbers(size)
    except LiteralError:
        return True
    return all(
        abs(share * length if length > 0 else share) <= length + REACH_M
        for share, length in zip(place, lengths, strict=True)
    )


def _dangling(store: Store, name: str) -> list[str]:
    """Things that an observation refers to and that have no statements."""
    graph = names.observation(name)
    rows = store.ask(fill(_DANGLING, graph=str(graph))).rows
    return [
        f"{_tail(thing)}: {_tail(predicate)} points to {_tail(nowhere)}, of which nothing is said"
        for thing, predicate, nowhere in rows
    ]


def _tail(term: object) -> str:
    return str(term).strip("<>").rsplit("/", 1)[-1]


def _unlisted(store: Store) -> list[Problem]:
    """Graphs of observations that are too incomplete to be listed."""
    rows = store.ask("SELECT DISTINCT ?g WHERE { GRAPH ?g { ?s ?p ?o } }").rows
    listed = {each.name for each in observations(store)}
    found = []
    for (graph,) in rows:
        if isinstance(graph, NamedNode) and graph.value.startswith(names.OBSERVATION):
            name = names.observation_name(graph)
            if name not in listed:
                found.append(Problem(name, name, "has statements and is no whole observation"))
    return found
