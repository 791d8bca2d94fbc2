"""Explanations as lines of text: the summary, what moved what, definitions, the tree of reasons."""

from collections.abc import Iterator, Sequence

from capar.model.capture import Notice
from capar.model.notices import KINDS
from capar.model.observation import Segment, SegmentAddress
from capar.pipelines.explanation import Explained
from capar.views.movers import mover_lines
from capar.views.notices import named_in, reservation_lines, reservations
from capar.views.reason_tree import note, reason_tree, spoken_texts
from capar_rules.engine.syntax import split_arguments
from capar_rules.explain.explanation import Explanation, Reason


def explanation_lines(told: Sequence[Explanation], seen: Explained, *, tree: bool) -> Iterator[str]:
    """What explanations say.

    Args:
        told: The explanations.
        seen: The observation that they are of.
        tree: Whether definitions of names and the tree of reasons follow each summary.
    """
    for explanation in told:
        yield header(explanation)
        yield explanation.summary
        yield from mover_lines(
            seen.observation, explanation.ee, explanation.index, staying=staying(explanation)
        )
        if tree:
            for name, definition in definitions(explanation, seen).items():
                yield f"{name}: {definition}"
            yield from _branch(reason_tree(explanation, seen.observation), 0)


def header(segment: Segment | Explanation) -> str:
    """Which segment it is, or is explained, and from when to when."""
    span = f"{segment.start_s:.2f} to {segment.end_s:.2f} s"
    return f"{SegmentAddress(segment.ee, segment.index)}  {span}"


def definitions(told: Explanation, seen: Explained) -> dict[str, str]:
    """What the names are of which a summary speaks, as the heads of their rule files say it."""
    return {name: seen.definitions[name] for name in told.names if name in seen.definitions}


def staying(told: Explanation) -> set[str]:
    """The objects that a segment's explanation says to stay where they are."""
    segment = split_arguments(told.reason.atom)[0]
    atoms = (node.atom for node in told.reason.walk() if node.atom.startswith("stays("))
    pairs = (split_arguments(atom) for atom in atoms)
    return {thing for thing, where in pairs if where == segment}


def notice_lines(
    segments: Sequence[Segment], seen: Explained, told: Sequence[Explanation] = ()
) -> tuple[str, ...]:
    """Reservations about the bodies of segments, and about all that explanations speak of."""
    measured = seen.explainer.measured
    unshaped = {body for reach in measured.reaches.values() for body in reach.unshaped}
    found = notices_about(segments, seen, told)
    return reservation_lines(found, called=measured.names, unshaped=unshaped)


def notices_about(
    segments: Sequence[Segment], seen: Explained, told: Sequence[Explanation] = ()
) -> tuple[Notice, ...]:
    """The notices that ``notice_lines`` puts into words."""
    about = {name for segment in segments for name in (segment.ee, *segment.objects)}
    known = {name for notice in seen.observation.notices for name in notice.bodies}
    names = seen.explainer.measured.names
    for explanation in told:
        about |= named_in(_texts(explanation, seen), known, called=names)
    return tuple(
        notice
        for notice in reservations(seen.observation.notices, about=about)
        if not KINDS[notice.code].of_pair or about >= {*notice.bodies}
    )


def _texts(told: Explanation, seen: Explained) -> list[str]:
    """What an explanation says of the bodies on which it rests."""
    movers = mover_lines(seen.observation, told.ee, told.index, staying=staying(told))
    tree = reason_tree(told, seen.observation)
    return [told.summary, *movers, *spoken_texts(tree)]


def _branch(reason: Reason, depth: int) -> Iterator[str]:
    frames = f"  [frames {reason.frames[0]} to {reason.frames[1]}]" if reason.frames else ""
    rule = f"  ({noted})" if (noted := note(reason)) else ""
    yield f"{'  ' * depth}- {reason.sentence}{frames}{rule}"
    for below in reason.because:
        yield from _branch(below, depth + 1)
