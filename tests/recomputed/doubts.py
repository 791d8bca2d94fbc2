"""Sentences about what flickered: what was measured, and what it was taken for."""

import itertools
from collections.abc import Sequence

from capar.model.facts import Moving, Resting, Touching
from recomputed.known import NAME, TIME, Known, near
from recomputed.motion import stayed as stood

SO = ", as so the fewest changes explain it"
FLICKER_S = 0.15

Spans = Sequence[Touching | Moving | Resting]


def _lost(spans: Spans, first: float, last: float) -> bool:
    """One stretch ends just before, the next one begins just after."""
    return any(near(each.last, first - 1) for each in spans) and any(
        near(each.first, last + 1) for each in spans
    )


def _measured(spans: Spans, first: float, last: float) -> bool:
    return any(near(each.first, first) and near(each.last, last) for each in spans)


def _corrected(known: Known, spans: Spans, first: float, last: float) -> bool:
    """It holds from the one frame to the other, but for gaps that are flickers, at least one."""
    inside = sorted((each.first, each.last) for each in spans
                    if each.first >= first - 1 and each.last <= last + 1)  # fmt: skip
    gaps = [begin - end for (_, end), (begin, _) in itertools.pairwise(inside)]
    ends = near(inside[0][0], first) and near(inside[-1][1], last)
    return ends and bool(gaps) and max(gaps) <= FLICKER_S * known.rate + 1


def lost(known: Known, one: str, other: str, first: str, last: str) -> bool:
    return _lost(known.touching(one, other), known.at(first), known.at(last))


def chattered(known: Known, one: str, other: str, first: str, last: str) -> bool:
    return _measured(known.touching(one, other), known.at(first), known.at(last))


def halted(known: Known, what: str, first: str, last: str) -> bool:
    return _lost(known.moving(what), known.at(first), known.at(last))


def stirred(known: Known, what: str, first: str, last: str) -> bool:
    return _measured(known.moving(what), known.at(first), known.at(last))


def twitched(known: Known, what: str, first: str, last: str) -> bool:
    return _lost(known.resting(what), known.at(first), known.at(last))


def paused(known: Known, what: str, first: str, last: str) -> bool:
    return _measured(known.resting(what), known.at(first), known.at(last))


def taken_contact(known: Known, one: str, other: str, first: str, last: str) -> bool:
    return _corrected(known, known.touching(one, other), known.at(first), known.at(last))


def taken_motion(known: Known, what: str, first: str, last: str) -> bool:
    return _corrected(known, known.moving(what), known.at(first), known.at(last))


def taken_rest(known: Known, what: str, first: str, last: str) -> bool:
    return _corrected(known, known.resting(what), known.at(first), known.at(last))


def taken_to_rest(known: Known, what: str, first: str, last: str) -> bool:
    """What was measured otherwise between them is shorter than a flicker each time."""
    begin, end = known.at(first), known.at(last)
    rests = [each for each in known.resting(what)
             if each.last >= begin - 1 and each.first <= end + 1]  # fmt: skip
    touched = [each for each in known.of(Touching)
               if each.body == what.replace(" ", "_") and begin + 1 < each.first
               and each.last < end - 1]  # fmt: skip
    brief = all(each.last - each.first < FLICKER_S * known.rate for each in touched)
    gaps = [later.first - each.last for each, later in itertools.pairwise(rests)]
    return brief and bool(gaps or touched) and max(gaps, default=0) <= FLICKER_S * known.rate + 1


def taken_to_touch(known: Known, one: str, other: str, at: str) -> bool:
    """It is in a gap between two contacts, shorter than a flicker."""
    spans, frame = known.touching(one, other), known.at(at)
    before = max(each.last for each in spans if each.last < frame + 1)
    after = min(each.first for each in spans if each.first > frame - 1)
    return after - before <= FLICKER_S * known.rate + 1


def taken_to_stay(known: Known, what: str, first: str, last: str) -> bool:
    """What was measured of its motion is shorter than a flicker, and it stays."""
    begin, end = known.at(first), known.at(last)
    inside = [each for each in known.moving(what) if each.first < end and each.last > begin]
    brief = all(min(each.last, end) - max(each.first, begin) <= FLICKER_S * known.rate
                for each in inside)  # fmt: skip
    return brief and bool(inside) and stood(known, what, first, last)


SPAN = rf"from {TIME} to {TIME}"
FORMS = (
    (rf"contact of the {NAME} with the {NAME} was lost {SPAN} and taken to go on{SO}", lost),
    (
        rf"contact of the {NAME} with the {NAME} was measured {SPAN} and taken for none{SO}",
        chattered,
    ),
    (rf"the {NAME} was still {SPAN} and taken to move on{SO}", halted),
    (rf"motion of the {NAME} was measured {SPAN} and taken for none{SO}", stirred),
    (rf"the {NAME} moved {SPAN} and was taken to rest on{SO}", twitched),
    (rf"rest of the {NAME} was measured {SPAN} and taken for none{SO}", paused),
    (rf"contact of the {NAME} with the {NAME} was taken to last {SPAN}", taken_contact),
    (rf"motion of the {NAME} was taken to last {SPAN}", taken_motion),
    (rf"rest of the {NAME} was taken to last {SPAN}", taken_rest),
    (
        rf"the {NAME} was taken to rest, touching no recorded or assumed object, {SPAN}",
        taken_to_rest,
    ),
    (rf"the {NAME} was taken to touch the {NAME} at {TIME}", taken_to_touch),
    (rf"the {NAME} was taken to stay where it was between {TIME} and {TIME}", taken_to_stay),
)
