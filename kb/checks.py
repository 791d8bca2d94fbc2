"""Checks of a whole store: shapes, NLTs, dangling references, incomplete observations."""

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

from pyoxigraph import Literal, NamedNode, Quad, Triple

from kb.exchange import part
from kb.lookup.pars import observations
from kb.store import names
from kb.store.statements import TYPE, LiteralError, nlt_of, numbers
from kb.store.stores import Store
from kb.store.validation import SH, Things, by_thing, faults, short
from ontology import BASE, CAPAR, DATA
from ontology.files import ontology, ontology_kinds, shape_files, subclasses

REACH_M = 0.1
"""How far from an object's origin, beyond its own size, its constraints may lie [m]."""

_NLTS = {CAPAR.eeNlt: CAPAR.dominant, CAPAR.goalNlt: CAPAR.goal, CAPAR.vNlt: CAPAR.seen}
"""The properties that are NLTs, each with the property of the object that it is local to."""


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

    def graph(*graphs: str) -> Things:
        return by_thing(quad for each in graphs for quad in store.graph(names.GRAPHS[each]))

    shared = graph("agents", "objects", "actions")
    # What a user declares may say less than what observations mention.
    mentioned = store.ask(f"SELECT DISTINCT ?thing {{ ?seen {CAPAR.mentions} ?thing }}").rows
    seen = {row[0] for row in mentioned}
    common = {thing: said for thing, said in shared.items() if thing in seen}
    lines = [("", line) for line in _faults(common, shared)]
    lines += [("", line) for line in _faults(graph("corrections"), shared)]
    named = shared.keys() | ontology_kinds().keys()
    listed = [each.name for each in observations(store)]
    for name in listed:
        own = store.graph(names.observation(name))
        lines += [(name, line) for line in _faults(by_thing(own), shared)]
        lines += [(name, line) for line in _dangling(store, own, named)]
        if full:
            judged = by_shacl([quad.triple for quad in part(store, name)])
            lines += [(name, f"{thing}: {message}") for thing, message in judged]
    for (node,) in store.ask("SELECT DISTINCT ?g WHERE { GRAPH ?g { ?s ?p ?o } }").rows:
        if isinstance(node, NamedNode) and node.value.startswith(names.OBSERVATION):
            name = names.observation_name(node)
            if name not in listed:
                lines.append((name, f"{name}: has statements and is no whole observation"))
    parted = ((name, *line.partition(": ")[::2]) for name, line in lines)
    return tuple(sorted({Problem(*each) for each in parted}))


def _faults(things: Things, shared: Things) -> Iterator[str]:
    """What is wrong with statements by shapes, NLTs, units and reach, as lines."""
    yield from faults(things, elsewhere=lambda thing: shared.get(thing, {}).get(TYPE, ()))
    sizes: dict[object, str] = {
        thing: value.value
        for each in (shared, things)
        for thing, said in each.items()
        for value in said.get(CAPAR.size, ())
        if isinstance(value, Literal)
    }
    for thing, said in things.items():
        for nlt, owner in _NLTS.items():
            size = next((sizes[e] for e in said.get(owner, ()) if e in sizes), "")
            for value in said.get(nlt, ()):
                if size and isinstance(value, Literal) and not _within(value.value, size):
                    yield (
                        f"{short(thing)}: {nlt.value.removeprefix(BASE)} {value.value!r} lies "
                        f"outside the reach of an object of {size} m"
                    )


def _within(nlt: str, size: str) -> bool:
    try:
        place, lengths = nlt_of(nlt).position, numbers(size)
    except LiteralError:
        return True
    return not any(lengths) or all(  # without a shape, an object has no size
        abs(share * length if length > 0 else share) <= length + REACH_M
        for share, length in zip(place, lengths, strict=True)
    )


def _dangling(store: Store, quads: list[Quad], known: Collection[object]) -> Iterator[str]:
    """References of an observation to things of which nothing is said anywhere."""
    known = {each.subject for each in quads} | {*known}
    doubtful = {
        each.object
        for each in quads
        if isinstance(each.object, NamedNode) and each.object.value.startswith(DATA)
    } - known
    listed = " ".join(sorted(map(str, doubtful)))
    query = f"SELECT DISTINCT ?thing {{ VALUES ?thing {{ {listed} }} ?thing ?property ?value }}"
    doubtful -= {row[0] for row in store.ask(query).rows} if doubtful else set()
    for quad in quads:
        if quad.object in doubtful:
            predicate, value = short(quad.predicate), short(quad.object)
            yield f"{short(quad.subject)}: {predicate} points to {value}, of which nothing is said"


def by_shacl(triples: Iterable[Triple]) -> list[tuple[str, str]]:
    """What pySHACL finds wrong with statements: the thing and the message, sorted."""
    from pyshacl import validate
    from rdflib import Graph, Namespace

    shacl = Namespace(SH)
    stated = [*triples, *subclasses()]
    named = {each.object for each in stated} & ontology_kinds().keys()
    stated += [each for each in ontology() if each.subject in named]
    data = Graph().parse(data="".join(f"{each} .\n" for each in stated), format="nt")
    shapes = Graph()
    for file in shape_files():
        shapes.parse(data=file.read_text("utf-8"), format="turtle")
    _, report, _ = validate(data, shacl_graph=shapes, inference="none", advanced=False)
    assert isinstance(report, Graph)
    found = {
        (str(report.value(each, shacl.focusNode)), str(report.value(each, shacl.resultMessage)))
        for each in report.objects(None, shacl.result)
    }
    return sorted((thing.rsplit("/", 1)[-1], message) for thing, message in found)
