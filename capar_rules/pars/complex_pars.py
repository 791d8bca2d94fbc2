"""Segments to one complex PAR: sequences in parallel, shares of time, and Allen's relations."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from capar.model.observation import ObservedLink, Segment
from capar.model.par import ComplexPar, LinkSteps, Relation, Step
from capar_rules.pars.inference import Inference

ALL = "all"
"""The end-effector of a step that is common to every link."""


def compose(inference: Inference, *, name: str, frames: int, duration_s: float) -> ComplexPar:
    """The complex PAR of everything observed (thesis 4.6.2).

    Args:
        inference: Segments, and which of them make one common last step.
        name: What the whole action is called.
        frames: Number of the capture's last frame.
        duration_s: The whole duration [s].
    """
    common = _common(inference, name, frames)
    end = common.begin if common else 1.0
    links = tuple(
        LinkSteps(link.ee, _steps(inference, link, name, frames, end)) for link in inference.links
    )
    return ComplexPar(
        name=name,
        objects=_in_order(inference.links),
        duration_s=duration_s,
        links=links,
        common=common,
        relations=tuple(_relations(links, frames)),
    )


def _common(inference: Inference, name: str, frames: int) -> Step | None:
    """The last step of all links, from when the last of them begins it."""
    segments = [
        each
        for link in inference.links
        for each in link.segments
        if (each.ee, each.index) in inference.common
    ]
    if not segments:
        return None
    begin = max(segment.first for segment in segments)
    return Step(
        action=segments[0].name,
        ee=ALL,
        objects=tuple(sorted({name for each in segments for name in each.objects})),
        share=_share(begin, frames, frames),
        purpose=segments[0].purpose,
        begin=_share(0, begin, frames),
        segments=tuple(segment.index for segment in segments),
        posture=f"{name}End",
    )


def _steps(
    inference: Inference, link: ObservedLink, name: str, frames: int, end: float
) -> tuple[Step, ...]:
    """One step a segment, but for rest; the last before a common step waits for it."""
    own = [
        segment for segment in link.segments if (segment.ee, segment.index) not in inference.common
    ]
    steps = [_step(each, name, frames) for each in _waited(own, inference)]
    if steps and steps[-1].begin + steps[-1].share != end:
        steps[-1] = _lasting(steps[-1], end - steps[-1].begin)
    return tuple(steps)


def _waited(segments: Sequence[Segment], inference: Inference) -> list[Segment]:
    """Segments without those of rest: it belongs to what it precedes, or, at the end, follows."""
    active = [
        segment for segment in segments if (segment.ee, segment.index) not in inference.no_steps
    ]
    if not active:
        return list(segments)
    edges = [segments[0].first, *(each.last for each in active[:-1]), segments[-1].last]
    return [
        replace(each, first=first, last=last)
        for each, (first, last) in zip(active, pairwise(edges), strict=True)
    ]


def _step(segment: Segment, name: str, frames: int) -> Step:
    return Step(
        action=segment.name,
        ee=segment.ee,
        objects=segment.objects,
        share=_share(segment.first, segment.last, frames),
        purpose=segment.purpose,
        begin=_share(0, segment.first, frames),
        segments=(segment.index,),
        posture=posture(segment, name),
    )


def posture(segment: Segment, name: str) -> str:
    """The posture that a segment ends in, where it ends in no contact (thesis 4.6.2)."""
    if "1" in segment.features.rel_end:
        return ""
    return f"{name}End" if segment.ends[0].kind == "last" else f"{name}{segment.index}"


def _lasting(step: Step, share: float) -> Step:
    return Step(
        step.action,
        step.ee,
        step.objects,
        share,
        step.purpose,
        step.begin,
        step.segments,
        step.posture,
    )


def _share(first: int, last: int, frames: int) -> float:
    return float(Fraction(last - first, frames))


def _in_order(links: Iterable[ObservedLink]) -> tuple[str, ...]:
    """Every object of a segment, in order of first use; of one segment, in its own order."""
    segments = [each for link in links for each in link.segments]
    ordered = sorted(segments, key=lambda each: (each.last, each.ee))
    return tuple(dict.fromkeys(name for each in ordered for name in each.objects))


def _relations(links: tuple[LinkSteps, ...], frames: int) -> Iterable[Relation]:
    """Allen's relations of steps of different links that share time or meet."""
    for place, link in enumerate(links):
        for other in links[place + 1 :]:
            yield from _between(link, other, frames)


def _between(link: LinkSteps, other: LinkSteps, frames: int) -> Iterable[Relation]:
    start = 0
    for index, step in enumerate(link.steps):
        first, last = _span(step, frames)
        while start < len(other.steps) and _span(other.steps[start], frames)[1] < first:
            start += 1
        for number in range(start, len(other.steps)):
            begin, end = _span(other.steps[number], frames)
            if begin > last:
                break
            yield Relation((link.ee, index), allen(first, last, begin, end), (other.ee, number))


def _span(step: Step, frames: int) -> tuple[int, int]:
    return round(step.begin * frames), round((step.begin + step.share) * frames)


def allen(first: float, last: float, begin: float, end: float) -> str:
    """Allen's relation of the interval [first, last] to [begin, end], in OWL-Time's words."""
    if last < begin or end < first:
        return "before" if last < begin else "after"
    if last == begin or end == first:
        return "meets" if last == begin else "metBy"
    if first == begin:
        return "equals" if last == end else ("starts" if last < end else "startedBy")
    if last == end:
        return "finishes" if first > begin else "finishedBy"
    if first < begin:
        return "contains" if last > end else "overlaps"
    return "during" if last < end else "overlappedBy"
