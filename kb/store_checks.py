"""Checks of what is stored: shapes, NLTs, dangling references, incomplete observations."""

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeAlias

from pyoxigraph import Literal, NamedNode, Quad, Triple

from kb.exchange import part
from kb.lookup.pars import observations
from kb.store import names, validation
from kb.store.statements import TYPE, LiteralError, nlt_of, numbers
from kb.store.stores import Store
from kb.store.validation import inconsistencies
from ontology import BASE, CAPAR, DATA
from ontology.files import ontology, ontology_kinds, shape_files, subclasses

REACH_M = 0.1
"""How far from an object's origin, beyond its own size, its constraints may lie [m]."""

_SHARED = ("agents", "objects", "actions")
"""The graphs of what observations say alike."""

_MENTIONED = f"SELECT DISTINCT ?thing {{ ?observation {CAPAR.mentions} ?thing }}"
"""What is judged of them: what a user declares may say less."""

Sizes: TypeAlias = Mapping[object, object]
"""Lengths of things, as they are stated."""

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


def check(store: Store, *, full: bool = False) -> tuple[Problem, ...]:
    """The faults of a store, observation by observation, then those of what they share.

    Args:
        store: What to look at.
        full: Whether SHACL itself (pySHACL) judges beside our fast reading of the shapes.

    Raises:
        DamagedError: A statement cannot be read.
    """
    store.check_readable()
    shared = [quad for name in _SHARED for quad in store.graph(names.GRAPHS[name])]
    kinds, sizes = _classes(shared), _sizes(shared)
    seen = {row[0] for row in store.ask(_MENTIONED).rows}
    common = [each for each in shared if each.subject in seen]
    found = [Problem("", *_split(line)) for line in _faults(common, kinds, sizes)]
    claimed = list(store.graph(names.GRAPHS["corrections"]))
    found += [Problem("", *_split(line)) for line in _faults(claimed, kinds, sizes)]
    named = {quad.subject for quad in shared} | ontology_kinds().keys()
    for stored in observations(store):
        own = store.graph(names.observation(stored.name))
        lines = [*_faults(own, kinds, sizes), *_dangling(store, own, named)]
        found += [Problem(stored.name, *_split(line)) for line in lines]
        if full:
            judged = by_shacl([quad.triple for quad in part(store, stored.name)])
            found += [Problem(stored.name, thing, message) for thing, message in judged]
    found += _unlisted(store)
    return tuple(sorted(set(found)))


def _faults(quads: list[Quad], kinds: Mapping[object, list[object]], sizes: Sizes) -> list[str]:
    """What is wrong with statements by shapes, NLTs, units and reach, as lines."""
    return [
        *validation.violations(quads, elsewhere=lambda thing: kinds.get(thing, ())),
        *validation.nlt_problems(quads),
        *inconsistencies(quads),
        *_out_of_reach(quads, sizes),
    ]


def _classes(quads: Iterable[Quad]) -> dict[object, list[object]]:
    found: dict[object, list[object]] = defaultdict(list)
    for quad in quads:
        if quad.predicate == TYPE:
            found[quad.subject].append(quad.object)
    return found


def _sizes(quads: Iterable[Quad]) -> Sizes:
    return {each.subject: each.object for each in quads if each.predicate == CAPAR.size}


def _split(line: str) -> tuple[str, str]:
    thing, _, message = line.partition(": ")
    return thing, message


def by_shacl(triples: Iterable[Triple]) -> list[tuple[str, str]]:
    """What pySHACL finds wrong with statements: the thing and the message, sorted."""
    from pyshacl import validate
    from rdflib import Graph, Namespace

    shacl = Namespace(validation.SH)
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


def _out_of_reach(quads: list[Quad], sizes: Sizes) -> list[str]:
    """NLTs that lie further from an object's origin than the object is large."""
    owners = {owner for _, owner in _NLTS}
    owned = {(e.subject, e.predicate): e.object for e in quads if e.predicate in owners}
    sizes = {**sizes, **_sizes(quads)}
    found = []
    for quad in quads:
        for nlt, owner in _NLTS:
            if quad.predicate == nlt and isinstance(quad.object, Literal):
                size = sizes.get(owned.get((quad.subject, owner)))
                if isinstance(size, Literal) and not _within(quad.object.value, size.value):
                    found.append(
                        f"{_tail(quad.subject)}: {nlt.value.removeprefix(BASE)} "
                        f"{quad.object.value!r} lies outside the reach of an object of "
                        f"{size.value} m"
                    )
    return sorted(found)


def _within(nlt: str, size: str) -> bool:
    try:
        place, lengths = nlt_of(nlt).position, numbers(size)
    except LiteralError:
        return True
    return not any(lengths) or all(  # without a shape, a thing has no size
        abs(share * length if length > 0 else share) <= length + REACH_M
        for share, length in zip(place, lengths, strict=True)
    )


def _dangling(store: Store, quads: list[Quad], known: Collection[object]) -> Iterator[str]:
    """References of an observation to things of which nothing is said anywhere."""
    own = {each.subject for each in quads}
    doubtful = [
        each
        for each in quads
        if isinstance(each.object, NamedNode)
        and each.object not in own
        and each.object not in known
        and each.object.value.startswith(DATA)
    ]
    said = _said(store, {str(each.object) for each in doubtful})
    for quad in doubtful:
        if quad.object not in said:
            yield (
                f"{_tail(quad.subject)}: {_tail(quad.predicate)} points to "
                f"{_tail(quad.object)}, of which nothing is said"
            )


def _said(store: Store, things: Collection[str]) -> set[object]:
    """Those of which the store says something."""
    listed = " ".join(sorted(things))
    query = f"SELECT DISTINCT ?thing {{ VALUES ?thing {{ {listed} }} ?thing ?property ?value }}"
    return {row[0] for row in store.ask(query).rows} if things else set()


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
