"""What persons say was done, beside what the machine says.

It is kept in seconds, so that it outlasts another observation of the capture with other segments.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.errors import UnknownNameError
from capar.model.observation import SegmentAddress
from capar.model.par import ACTION_NAME, UNKNOWN
from kb.errors import CorrectionError
from kb.lookup.stored import observations
from kb.store import names
from kb.store.sparql import fill
from kb.store.statements import LABEL, TYPE
from kb.store.stores import Store
from ontology import CAPAR
from ontology.vocabularies import PROV, XSD

GRAPH = names.GRAPHS["corrections"]
BY = NamedNode(PROV + "wasAttributedTo")
MADE = NamedNode(PROV + "generatedAtTime")
LEAST_S = 1e-6
"""What is left of a segment counts from this duration on [s]."""

_SEGMENTS = f"""SELECT ?ee ?start ?end ?name ?objects ?index
WHERE {{ GRAPH @graph@ {{
  ?segment a {CAPAR.Segment} ; {CAPAR.ee} ?ee ; {CAPAR.start} ?start ; {CAPAR.end} ?end ;
    {CAPAR.index} ?index .
  OPTIONAL {{ ?segment {CAPAR.action} ?action }}
  OPTIONAL {{ ?segment {CAPAR.objects} ?objects }} }}
  OPTIONAL {{ ?action {CAPAR.name} ?name }} }}
ORDER BY ?ee ?start"""

_CLAIMS = f"""SELECT ?ee ?start ?end ?name ?objects ?index ?by
WHERE {{ GRAPH {GRAPH} {{
  ?claim a {CAPAR.Correction} ; {CAPAR.ofCapture} @capture@ ; {CAPAR.ee} ?ee ;
    {CAPAR.start} ?start ; {CAPAR.end} ?end ; {CAPAR.actionName} ?name ; {CAPAR.index} ?index ;
    {BY}/{LABEL} ?by .
  OPTIONAL {{ ?claim {CAPAR.objects} ?objects }} }} }}
ORDER BY ?index"""

_CORRECTED = (
    f"SELECT DISTINCT ?capture WHERE {{ GRAPH {GRAPH} {{ ?claim {CAPAR.ofCapture} ?capture }} }}"
)

_STATED = f"""CONSTRUCT {{ ?thing ?property ?value }}
WHERE {{ GRAPH {GRAPH} {{
  ?claim {CAPAR.ofCapture} @capture@ .
  {{ ?claim ?property ?value . BIND(?claim AS ?thing) }}
  UNION {{ ?claim {BY} ?thing . ?thing ?property ?value }} }} }}"""


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
    spans = _spans(store.ask(fill(_SEGMENTS, graph=str(names.observation(capture)))).rows)
    if not spans:
        known = [each.name for each in observations(store)]
        raise UnknownNameError("observation", capture, known, where=store.place)
    for claim in claims(store, capture):
        spans = overlay(spans, claim)
    return spans


def claims(store: Store, capture: str) -> tuple[Span, ...]:
    """What persons say of a capture, in the order in which they said it."""
    return _spans(store.ask(fill(_CLAIMS, capture=str(Literal(capture)))).rows)


def corrected_captures(store: Store) -> tuple[str, ...]:
    """The captures of which persons say something."""
    rows = store.ask(_CORRECTED).rows
    return tuple(sorted(each.value for (each,) in rows if isinstance(each, Literal)))


def claim_statements(store: Store, capture: str) -> list[Quad]:
    """What is stored of the claims about a capture, and of the persons who make them."""
    found = store.ask(fill(_STATED, capture=str(Literal(capture)))).triples or ()
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
    told: list[tuple[NamedNode, NamedNode, NamedNode | Literal]] = [
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
    return [Quad(s, p, o, GRAPH) for s, p, o in told]


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
