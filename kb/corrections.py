"""Corrections: what persons say was done, beside what the machine says."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from itertools import groupby

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.errors import UnknownNameError
from capar.model.observation import ObservedLink, Segment, SegmentAddress
from capar.model.par import ACTION_NAME, UNKNOWN
from kb.errors import CorrectionError
from kb.lookup.pars import observations
from kb.store import names
from kb.store.sparql import stored
from kb.store.statements import LABEL, TYPE
from kb.store.stores import EmbeddedStore, Store
from ontology import CAPAR
from ontology.namespace import PROV, XSD

GRAPH = names.GRAPHS["corrections"]
BY = NamedNode(PROV + "wasAttributedTo")
MADE = NamedNode(PROV + "generatedAtTime")
LEAST_S = 1e-6
"""What is left of a segment counts from this duration on [s]."""


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """What one end-effector did from a time to another, and who says so."""

    ee: str
    start_s: float
    """Seconds since the first frame."""

    end_s: float
    name: str
    objects: str = ""
    """Names of objects, the dominant one first, divided by spaces."""

    by: str = ""
    """The person who says so; empty for the machine."""

    def between(self, start_s: float, end_s: float) -> "Span":
        """The same from another start or to another end."""
        return replace(self, start_s=start_s, end_s=end_s)


@dataclass(frozen=True, slots=True)
class Correction:
    """What is to be changed of a segment; exactly one of these."""

    name: str = ""
    start_s: float | None = None
    end_s: float | None = None
    split_s: float | None = None
    join: bool = False
    """Whether it is one with the next segment."""

    def __post_init__(self) -> None:
        """Check that it is one change.

        Raises:
            CorrectionError: It is none or several, or the name is no name of an action.
        """
        times = (self.start_s, self.end_s, self.split_s)
        if bool(self.name) + self.join + sum(each is not None for each in times) != 1:
            raise CorrectionError("say one change: a name, a start, an end, a split or a join")
        if self.name and self.name != UNKNOWN and not ACTION_NAME.fullmatch(self.name):
            raise CorrectionError(f"{self.name!r} is no name of an action; write one like PutDown")


def account(store: Store, capture: str) -> tuple[Span, ...]:
    """What was done in a capture: the machine's segments with the persons' claims in their place.

    Raises:
        UnknownNameError: Nothing of that capture is stored.
    """
    spans = _spans(
        store.ask(stored("machine_segments", graph=str(names.observation(capture)))).rows
    )
    if not spans:
        known = [each.name for each in observations(store)]
        raise UnknownNameError("observation", capture, known, where=store.place)
    for claim in claims(store, capture):
        spans = overlay(spans, claim)
    return spans


def claims(store: Store, capture: str) -> tuple[Span, ...]:
    """What persons say of a capture, in the order in which they said it."""
    return _spans(store.ask(stored("claims", capture=str(Literal(capture)))).rows)


def corrected_captures(store: Store) -> tuple[str, ...]:
    """The captures of which persons say something."""
    rows = store.ask(stored("corrected_captures")).rows
    return tuple(sorted(each.value for (each,) in rows if isinstance(each, Literal)))


def claim_statements(store: Store, capture: str) -> list[Quad]:
    """What is stored of the claims about a capture, and of the persons who make them."""
    found = store.ask(stored("claim_statements", capture=str(Literal(capture)))).triples or ()
    return [Quad(each.subject, each.predicate, each.object, GRAPH) for each in found]


def overlay(spans: Iterable[Span], claim: Span) -> tuple[Span, ...]:
    """Spans with a claim in the place of whatever the same end-effector did in its time."""
    kept = [piece for each in spans for piece in _outside(each, claim)]
    return tuple(sorted([*kept, claim]))


def _outside(span: Span, claim: Span) -> list[Span]:
    if span.ee != claim.ee:
        return [span]
    parts = (
        span.between(span.start_s, min(span.end_s, claim.start_s)),
        span.between(max(span.start_s, claim.end_s), span.end_s),
    )
    return [each for each in parts if each.end_s - each.start_s > LEAST_S]


def claimed(spans: Sequence[Span], at: int, change: Correction) -> list[Span]:
    """What is claimed by a change of one of the spans of an end-effector, which are in order.

    Raises:
        CorrectionError: There is nothing to join with, or a time lies outside of what it changes.
    """
    one = spans[at]
    before = spans[at - 1] if at else None
    after = spans[at + 1] if at + 1 < len(spans) else None
    if change.name:
        return [replace(one, name=change.name)]
    if change.join:
        if after is None:
            raise CorrectionError("it is the last segment of its end-effector; join the one before")
        return [one.between(one.start_s, after.end_s)]
    if change.split_s is not None:
        _inside(change.split_s, one.start_s, one.end_s)
        return [one.between(one.start_s, change.split_s), one.between(change.split_s, one.end_s)]
    if change.start_s is not None:
        _inside(change.start_s, before.start_s if before else -LEAST_S, one.end_s)
        left = [before.between(before.start_s, change.start_s)] if before else []
        return [*left, one.between(change.start_s, one.end_s)]
    assert change.end_s is not None
    _inside(change.end_s, one.start_s, after.end_s if after else float("inf"))
    right = [after.between(change.end_s, after.end_s)] if after else []
    return [one.between(one.start_s, change.end_s), *right]


def _inside(time_s: float, start_s: float, end_s: float) -> None:
    if not start_s + LEAST_S <= time_s <= end_s - LEAST_S:
        raise CorrectionError(f"{time_s} s does not lie between {start_s:.3f} and {end_s:.3f} s")


def correct(store: Store, address: SegmentAddress, change: Correction, *, by: str) -> None:
    """Keep a person's claim about a segment beside what the machine says.

    Args:
        store: An Actionary's.
        address: The segment, counted as ``account`` has it, with its capture.
        change: What is otherwise.
        by: The person who says so.

    Raises:
        UnknownNameError: There is no such capture or segment.
        CorrectionError: Nobody says so, or the change does not fit the segment.
    """
    if not by.strip():
        raise CorrectionError("say who claims it: --by PERSON")
    spans = [each for each in account(store, address.capture) if each.ee == address.ee]
    if address.index >= len(spans):
        known = [str(replace(address, index=at)) for at in range(len(spans))]
        raise UnknownNameError("segment", str(address), known, where=store.place)
    made = datetime.now(UTC).isoformat(timespec="seconds")
    number = len(claims(store, address.capture))
    quads: list[Quad] = []
    for at, span in enumerate(claimed(spans, address.index, change), start=number):
        quads += _stated(replace(span, by=by.strip()), address.capture, at, made)
    store.insert(quads)


def _stated(span: Span, capture: str, number: int, made: str) -> list[Quad]:
    node = names.shared("correction", capture, number)
    person = names.shared("person", span.by)
    stated: list[tuple[NamedNode, NamedNode, NamedNode | Literal]] = [
        (node, TYPE, CAPAR.Correction),
        (node, LABEL, Literal(f"{span.by} on {capture}: {span.name}")),
        (node, CAPAR.ofCapture, Literal(capture)),
        (node, CAPAR.ee, Literal(span.ee)),
        (node, CAPAR.index, Literal(number)),
        (node, CAPAR.start, Literal(float(span.start_s))),
        (node, CAPAR.end, Literal(float(span.end_s))),
        (node, CAPAR.actionName, Literal(span.name)),
        (node, BY, person),
        (node, MADE, Literal(made, datatype=NamedNode(XSD + "dateTime"))),
        (person, TYPE, NamedNode(PROV + "Person")),
        (person, LABEL, Literal(span.by)),
        *([(node, CAPAR.objects, Literal(span.objects))] if span.objects else []),
    ]
    return [Quad(s, p, o, GRAPH) for s, p, o in stated]


def _spans(rows: Iterable[Sequence[object]]) -> tuple[Span, ...]:
    found = []
    for row in rows:
        ee, start, end, name, objects, _, *by = [
            each.value if isinstance(each, Literal) else "" for each in row
        ]
        found.append(
            Span(ee, float(start), float(end), name or UNKNOWN, objects, by[0] if by else "")
        )
    return tuple(found)


def corrected_links(
    links: Sequence[ObservedLink], claims: Sequence[Span]
) -> tuple[ObservedLink, ...]:
    """The links with every claim in the place of what the machine says of its time.

    A segment that a claim gives or shortens keeps the objects and features of the machine's
    segment that it overlaps most, and its purpose unless that says what was done in it. Claims
    about links that there are not change nothing.
    """
    return tuple(
        _corrected(link, own) if (own := [e for e in claims if e.ee == link.ee]) else link
        for link in links
    )


def _corrected(link: ObservedLink, claims: Sequence[Span]) -> ObservedLink:
    spans = tuple(Span(e.ee, e.start_s, e.end_s, e.name) for e in link.segments)
    for claim in claims:
        spans = overlay(spans, claim)
    segments = tuple(_segment(link.segments, at, span) for at, span in enumerate(spans))
    return replace(link, segments=segments)


def _segment(machine: Sequence[Segment], index: int, span: Span) -> Segment:
    basis = max(machine, key=lambda segment: _overlap(segment, span))
    lasts = basis.end_s - basis.start_s
    frame_s = lasts / (basis.last - basis.first) if basis.last > basis.first else 0.0

    def frame(time_s: float) -> int:
        return basis.first + (round((time_s - basis.start_s) / frame_s) if frame_s else 0)

    starts, ends = _near(span.start_s, basis.start_s), _near(span.end_s, basis.end_s)
    own_name = span.name == basis.name
    return replace(
        basis,
        index=index,
        name=span.name,
        purpose=basis.purpose if own_name or not _says_what_was_done(basis) else "",
        general=basis.general if own_name else _general(machine, span.name),
        candidates=basis.candidates if own_name and span.name == UNKNOWN else (),
        level=basis.level if own_name else "",
        first=basis.first if starts else frame(span.start_s),
        last=basis.last if ends else frame(span.end_s),
        start_s=span.start_s,
        end_s=span.end_s,
        begins=basis.begins if starts else (),
        ends=basis.ends if ends else (),
    )


def _general(machine: Sequence[Segment], name: str) -> tuple[str, ...]:
    """What an action specialises, by another segment of that name."""
    return next((segment.general for segment in machine if segment.name == name), ())


def _says_what_was_done(segment: Segment) -> bool:
    """Whether a purpose says what was done in a segment: relations are the same at its end."""
    return segment.features.rel_start == segment.features.rel_end


def _overlap(segment: Segment, span: Span) -> float:
    return min(segment.end_s, span.end_s) - max(segment.start_s, span.start_s)


def _near(one_s: float, other_s: float) -> bool:
    return abs(one_s - other_s) <= LEAST_S


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
        basis = max(
            sorted(machine, key=str), key=lambda each: _overlap_corrected_view(machine[each], span)
        )
        kept = [each for each in machine[basis] if each[0] not in _REPLACED]
        if span.name != UNKNOWN:
            kept = [each for each in kept if each[1] != CAPAR.UnknownSegment]
        stated = [*kept, *_claimed(span, at, capture)]
        stated += [(CAPAR.next, each) for each in nodes[at + 1 : at + 2]]
        yield Quad(graph, CAPAR.segment, node, graph)
        yield from (Quad(node, predicate, value, graph) for predicate, value in stated)
        yield from _action(span.name)


def _claimed(span: Span, at: int, capture: str) -> Properties:
    stated: Properties = [
        (LABEL, Literal(f"{span.ee} {at}: {span.name}")),
        (CAPAR.start, Literal(span.start_s)),
        (CAPAR.end, Literal(span.end_s)),
        (CAPAR.duration, Literal(span.end_s - span.start_s)),
        (CAPAR.index, Literal(at)),
        (CAPAR.address, Literal(str(SegmentAddress(span.ee, at, capture)))),
    ]
    if span.name != UNKNOWN:
        stated.append((CAPAR.action, names.shared("action", span.name)))
    return stated + ([(BY, names.shared("person", span.by))] if span.by else [])


def _action(name: str) -> Iterator[Quad]:
    """That there is such an action; what is more general than it, the store says if it knows."""
    if name != UNKNOWN:
        node, graph = names.shared("action", name), names.GRAPHS["actions"]
        yield Quad(node, TYPE, CAPAR.Action, graph)
        yield Quad(node, LABEL, Literal(name), graph)
        yield Quad(node, CAPAR.name, Literal(name), graph)
        yield Quad(node, CAPAR.kindOf, node, graph)


def _overlap_corrected_view(properties: Properties, span: Span) -> float:
    times = {p: float(o.value) for p, o in properties if p in (CAPAR.start, CAPAR.end)}
    return min(times[CAPAR.end], span.end_s) - max(times[CAPAR.start], span.start_s)
