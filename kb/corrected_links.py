"""An observation's segments as persons say they are, for sentences."""

from collections.abc import Sequence
from dataclasses import replace

from capar.model.observation import ObservedLink, Segment
from capar.model.par import UNKNOWN
from kb.corrections import LEAST_S, Span, overlay


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
        purpose=basis.purpose if own_name or not _is_the_deed(basis) else "",
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
    """What an action specialises, where another segment of that name tells."""
    return next((segment.general for segment in machine if segment.name == name), ())


def _is_the_deed(segment: Segment) -> bool:
    """Whether a purpose says what was done in a segment: relations are the same at its end."""
    return segment.features.rel_start == segment.features.rel_end


def _overlap(segment: Segment, span: Span) -> float:
    return min(segment.end_s, span.end_s) - max(segment.start_s, span.start_s)


def _near(one_s: float, other_s: float) -> bool:
    return abs(one_s - other_s) <= LEAST_S
