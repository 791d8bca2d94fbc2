"""When a hand had a thing that moved, and no contact of any end-effector with it was found."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

from capar.model.facts import MovedBy, MovesWith, Moving, Touching
from capar.model.notices import Notice, notice
from capar.model.observation import Observation, ObservedLink
from kb.lexicon.wordnet import table

NOTICED_S = 0.2
"""A thing that moves without contact for less than this [s] is not noted: an onlooker takes so long
to react."""

HAND = "hand"
"""The kind of links that have things."""

Frames = tuple[int, int]


def contact_gaps(observation: Observation) -> tuple[Notice, ...]:
    """Each time between two contacts in which a movable thing moves, with the hand that has it.

    Not where no hand is found to move it, or to move as one with it.

    Args:
        observation: What was understood of a capture.

    Returns:
        Notices ``contact-gap`` of the thing and the hand, from when to when [s].
    """
    things = [thing.name for thing in observation.objects if thing.tag == "mobile"]
    return tuple(found for thing in things for found in _gaps(observation, thing))


def _gaps(observation: Observation, thing: str) -> Iterator[Notice]:
    step_s = observation.duration_s / max(observation.frames - 1, 1)
    acting = {link.ee for link in observation.links}
    touches = [
        (fact.first, fact.last)
        for fact in observation.facts
        if isinstance(fact, Touching) and fact.other == thing and fact.body in acting
    ]
    moves = [
        (fact.first, fact.last)
        for fact in observation.facts
        if isinstance(fact, Moving) and fact.object == thing
    ]
    for gap in _between(touches):
        hand = _holder(observation, thing, gap)
        if hand is not None and sum(_shared(gap, move) for move in moves) * step_s > NOTICED_S:
            start_s, end_s = (frame * step_s for frame in gap)
            called = f"{hand.side} {hand.kind}".strip()
            yield notice("contact-gap", thing, hand.ee, start_s=start_s, end_s=end_s, called=called)


def _between(touches: Sequence[Frames]) -> Iterator[Frames]:
    """The last frame of contact before each time without any, and the first one after it."""
    joined: list[Frames] = []
    for first, last in sorted(touches):
        if joined and first <= joined[-1][1] + 1:
            joined[-1] = joined[-1][0], max(joined[-1][1], last)
        else:
            joined.append((first, last))
    for before, after in pairwise(joined):
        yield before[1], after[0]


def _holder(observation: Observation, thing: str, gap: Frames) -> ObservedLink | None:
    """The hand that, with its fingers, moves a thing longest meanwhile; None where none does."""
    wholes = {row["part"]: row["whole"] for row in table("body_parts")}
    sides = {
        link.ee: link.side
        for link in observation.links
        if HAND in {link.kind, wholes.get(link.kind.rstrip("0123456789"))}
    }
    frames: dict[str, int] = {}
    for fact in observation.facts:
        if isinstance(fact, MovedBy) and fact.object == thing:
            mover = fact.mover
        elif isinstance(fact, MovesWith) and fact.object == thing:
            mover = fact.body
        else:
            continue
        if mover in sides:
            shared = _shared(gap, (fact.first, fact.last))
            frames[sides[mover]] = frames.get(sides[mover], 0) + shared
    side = max(frames, key=lambda side: frames[side], default="")
    hands = [link for link in observation.links if (link.kind, link.side) == (HAND, side)]
    return hands[0] if hands and frames.get(side) else None


def _shared(one: Frames, other: Frames) -> int:
    return max(0, min(one[1], other[1]) - max(one[0], other[0]))
