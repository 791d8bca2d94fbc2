"""A copy of a store in which the segments are what persons say they are."""

from collections.abc import Iterator, Sequence
from itertools import groupby

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.observation import SegmentAddress
from capar.model.par import UNKNOWN
from kb.corrections import BY, Span, account, corrected_captures
from kb.lookup.stored import observations
from kb.store import names
from kb.store.embedded import EmbeddedStore
from kb.store.statements import LABEL, TYPE
from kb.store.stores import Store
from ontology import CAPAR

Term = NamedNode | Literal
Properties = list[tuple[NamedNode, Term]]

_REPLACED = {
    LABEL, CAPAR.start, CAPAR.end, CAPAR.duration, CAPAR.action, CAPAR.index, CAPAR.address,
    CAPAR.next, CAPAR.general, CAPAR.specialises, CAPAR.candidate, CAPAR.failedAt, CAPAR.namedBy,
}  # fmt: skip


def corrected(store: Store) -> EmbeddedStore:
    """A copy in memory, in which every claim of a person stands in the machine's place.

    A segment that was changed keeps what was measured of the one that it overlaps most: objects,
    features, borders. What else refers to segments (steps of the whole action, places) is the
    machine's still.
    """
    copy = EmbeddedStore(None)
    quads = set(store.quads())
    listed = {each.name for each in observations(store)}
    for capture in sorted(listed & set(corrected_captures(store))):
        graph = names.observation(capture)
        own = [each for each in quads if each.graph_name == graph]
        for ee, spans in groupby(account(store, capture), key=lambda each: each.ee):
            quads = quads.difference(_of_segments(own, ee)).union(
                _rewritten(own, graph, capture, list(spans))
            )
    copy.bulk(sorted(quads, key=str))
    return copy


def _of_segments(own: Sequence[Quad], ee: str) -> Iterator[Quad]:
    nodes = set(_segments(own, ee))
    yield from (each for each in own if each.subject in nodes)
    yield from (each for each in own if each.predicate == CAPAR.segment and each.object in nodes)


def _segments(own: Sequence[Quad], ee: str) -> dict[NamedNode, Properties]:
    """The machine's segments of an end-effector, each with all that is said of it."""
    stated = {(each.subject, each.predicate, each.object) for each in own}
    found: dict[NamedNode, Properties] = {}
    for statement in own:
        node, value = statement.subject, statement.object
        asked = {(node, TYPE, CAPAR.Segment), (node, CAPAR.ee, Literal(ee))}
        if asked <= stated and isinstance(node, NamedNode) and isinstance(value, Term):
            found.setdefault(node, []).append((statement.predicate, value))
    return found


def _rewritten(
    own: Sequence[Quad], graph: NamedNode, capture: str, spans: Sequence[Span]
) -> Iterator[Quad]:
    machine = _segments(own, spans[0].ee)
    nodes = [names.part(graph, "account", each.ee, at) for at, each in enumerate(spans)]
    for at, (node, span) in enumerate(zip(nodes, spans, strict=True)):
        basis = max(sorted(machine, key=str), key=lambda each: _overlap(machine[each], span))
        kept = [each for each in machine[basis] if each[0] not in _REPLACED]
        if span.name != UNKNOWN:
            kept = [each for each in kept if each[1] != CAPAR.UnknownSegment]
        told = [*kept, *_claimed(span, at, capture)]
        told += [(CAPAR.next, each) for each in nodes[at + 1 : at + 2]]
        yield Quad(graph, CAPAR.segment, node, graph)
        yield from (Quad(node, predicate, value, graph) for predicate, value in told)
        yield from _action(span.name)


def _claimed(span: Span, at: int, capture: str) -> Properties:
    told: Properties = [
        (LABEL, Literal(f"{span.ee} {at}: {span.name}")),
        (CAPAR.start, Literal(span.start_s)),
        (CAPAR.end, Literal(span.end_s)),
        (CAPAR.duration, Literal(span.end_s - span.start_s)),
        (CAPAR.index, Literal(at)),
        (CAPAR.address, Literal(str(SegmentAddress(span.ee, at, capture)))),
    ]
    if span.name != UNKNOWN:
        told.append((CAPAR.action, names.shared("action", span.name)))
    return told + ([(BY, names.shared("person", span.by))] if span.by else [])


def _action(name: str) -> Iterator[Quad]:
    """That there is such an action; what is more general than it, the store says if it knows."""
    if name != UNKNOWN:
        node, graph = names.shared("action", name), names.GRAPHS["actions"]
        yield Quad(node, TYPE, CAPAR.Action, graph)
        yield Quad(node, LABEL, Literal(name), graph)
        yield Quad(node, CAPAR.name, Literal(name), graph)
        yield Quad(node, CAPAR.kindOf, node, graph)


def _overlap(properties: Properties, span: Span) -> float:
    times = {p: float(o.value) for p, o in properties if p in (CAPAR.start, CAPAR.end)}
    return min(times[CAPAR.end], span.end_s) - max(times[CAPAR.start], span.start_s)
