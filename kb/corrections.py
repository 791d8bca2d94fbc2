"""Corrections: what persons say was done, beside what the machine says."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from itertools import groupby
from typing import TYPE_CHECKING, Any

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.errors import UnknownNameError
from capar.model.par import ACTION_NAME, UNKNOWN
from kb.errors import CorrectionError
from kb.lookup.pars import observations, unknown_observation
from kb.store import names
from kb.store.sparql import stored
from kb.store.statements import LABEL, TYPE
from kb.store.stores import EmbeddedStore, Store
from ontology import CAPAR
from ontology.namespace import PROV, XSD

if TYPE_CHECKING:
    from capar.model.observation import ObservedLink, Segment, SegmentAddress

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
        """Check that it is one change."""
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
        raise unknown_observation(store, capture)
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
    kept = [claim]
    for each in spans:
        if each.ee == claim.ee:
            before = replace(each, end_s=min(each.end_s, claim.start_s))
            after = replace(each, start_s=max(each.start_s, claim.end_s))
            kept += [e for e in (before, after) if e.end_s - e.start_s > LEAST_S]
        else:
            kept.append(each)
    return tuple(sorted(kept))


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
        return [replace(one, end_s=after.end_s)]
    start_s, end_s = one.start_s, one.end_s
    if change.start_s is not None:
        start_s = before.start_s if before else -LEAST_S
    elif change.end_s is not None:
        end_s = after.end_s if after else float("inf")
    (time_s,) = {change.split_s, change.start_s, change.end_s} - {None}
    assert time_s is not None
    if not start_s + LEAST_S <= time_s <= end_s - LEAST_S:
        raise CorrectionError(f"{time_s} s does not lie between {start_s:.3f} and {end_s:.3f} s")
    if change.split_s is not None:
        return [replace(one, end_s=time_s), replace(one, start_s=time_s)]
    if change.start_s is not None:
        left = [replace(before, end_s=time_s)] if before else []
        return [*left, replace(one, start_s=time_s)]
    right = [replace(after, start_s=time_s)] if after else []
    return [replace(one, end_s=time_s), *right]


def correct(store: Store, address: "SegmentAddress", change: Correction, *, by: str) -> None:
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
    links: "Sequence[ObservedLink]", claims: Sequence[Span]
) -> "tuple[ObservedLink, ...]":
    """The links with every claim in the place of what the machine says of its time.

    A segment that a claim gives or shortens keeps the objects and features of the machine's
    segment that it overlaps most, and its purpose unless that says what was done in it. Claims
    about links that there are not change nothing.
    """
    found = []
    for link in links:
        spans = tuple(Span(e.ee, e.start_s, e.end_s, e.name) for e in link.segments)
        own = [each for each in claims if each.ee == link.ee]
        for claim in own:
            spans = overlay(spans, claim)
        changed = tuple(_segment(link.segments, at, span) for at, span in enumerate(spans))
        found.append(replace(link, segments=changed) if own else link)
    return tuple(found)


def _overlap_s(start_s: float, end_s: float, span: Span) -> float:
    return min(end_s, span.end_s) - max(start_s, span.start_s)


def _segment(machine: "Sequence[Segment]", index: int, span: Span) -> "Segment":
    basis = max(machine, key=lambda segment: _overlap_s(segment.start_s, segment.end_s, span))
    frames = max(basis.last - basis.first, 0)
    rate_hz = frames / (basis.end_s - basis.start_s) if frames else 0.0
    starts = abs(span.start_s - basis.start_s) <= LEAST_S
    ends = abs(span.end_s - basis.end_s) <= LEAST_S
    own_name = span.name == basis.name
    # Where relations are the same at both ends, the purpose says what was done.
    done = basis.features.rel_start == basis.features.rel_end
    return replace(
        basis,
        index=index,
        name=span.name,
        purpose=basis.purpose if own_name or not done else "",
        general=next((each.general for each in (basis, *machine) if each.name == span.name), ()),
        candidates=basis.candidates if own_name and span.name == UNKNOWN else (),
        level=basis.level if own_name else "",
        first=basis.first + round((span.start_s - basis.start_s) * rate_hz),
        last=basis.last if ends else basis.first + round((span.end_s - basis.start_s) * rate_hz),
        start_s=span.start_s,
        end_s=span.end_s,
        begins=basis.begins if starts else (),
        ends=basis.ends if ends else (),
    )


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
        segments = {
            each.subject for each in own if each.predicate == TYPE and each.object == CAPAR.Segment
        }
        for ee, spans in groupby(account(store, capture), key=lambda each: each.ee):
            machine: dict[Any, list[Quad]] = {
                each.subject: []
                for each in own
                if each.subject in segments
                and (each.predicate, each.object) == (CAPAR.ee, Literal(ee))
            }
            for each in own:
                if each.subject in machine:
                    machine[each.subject].append(each)
            linked = {e for e in own if e.predicate == CAPAR.segment and e.object in machine}
            quads -= linked.union(*machine.values())
            quads |= set(_rewritten(machine, graph, capture, list(spans)))
    copy.bulk(sorted(quads, key=str))
    return copy


def _rewritten(
    machine: Mapping[Any, list[Quad]], graph: NamedNode, capture: str, spans: Sequence[Span]
) -> Iterator[Quad]:
    """Statements of an end-effector's spans, each upon the segment that it overlaps most."""
    from capar.model.observation import SegmentAddress

    def overlap_s(node: Any, span: Span) -> float:
        at: dict[NamedNode, Any] = {each.predicate: each.object for each in machine[node]}
        return _overlap_s(float(at[CAPAR.start].value), float(at[CAPAR.end].value), span)

    nodes = [names.part(graph, "account", each.ee, at) for at, each in enumerate(spans)]
    for at, (node, span) in enumerate(zip(nodes, spans, strict=True)):
        known = span.name != UNKNOWN
        action = names.shared("action", span.name)
        stated: list[tuple[NamedNode, Any]] = [
            (LABEL, Literal(f"{span.ee} {at}: {span.name}")),
            (CAPAR.start, Literal(span.start_s)),
            (CAPAR.end, Literal(span.end_s)),
            (CAPAR.duration, Literal(span.end_s - span.start_s)),
            (CAPAR.index, Literal(at)),
            (CAPAR.address, Literal(str(SegmentAddress(span.ee, at, capture)))),
            *((CAPAR.next, each) for each in nodes[at + 1 : at + 2]),
            *([(CAPAR.action, action)] if known else []),
            *([(BY, names.shared("person", span.by))] if span.by else []),
        ]
        basis = max(sorted(machine, key=str), key=lambda each: overlap_s(each, span))
        stated += [
            (each.predicate, each.object)
            for each in machine[basis]
            if each.predicate not in _REPLACED
            and not (known and each.object == CAPAR.UnknownSegment)
        ]
        yield Quad(graph, CAPAR.segment, node, graph)
        yield from (Quad(node, predicate, value, graph) for predicate, value in stated)
        if known:  # what is more general than it, the store says if it knows
            label = Literal(span.name)
            own: dict[NamedNode, Any] = {
                TYPE: CAPAR.Action,
                LABEL: label,
                CAPAR.name: label,
                CAPAR.kindOf: action,
            }
            yield from (Quad(action, p, o, names.GRAPHS["actions"]) for p, o in own.items())
