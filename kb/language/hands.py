"""What two hands did as one telling: together where they do the same, else in order of time."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from difflib import SequenceMatcher

from capar.model.observation import ObservedLink
from kb.language.clause import Clause, in_time
from kb.language.lexicalisation import ABOUT, REACH, THIS_WAY, TURN
from kb.language.thresholds import MOSTLY, REST_S, SETTLING_S
from kb.lexicon.tables import table

MOSTLY_MOVED = 0.5
"""Who moves a thing for a larger share of another hand's deed did that too [1]."""


def spoken_links(links: Sequence[ObservedLink]) -> tuple[ObservedLink, ...]:
    """The links that a telling names: a finger's is left out where its hand's is there."""
    there = {(each.kind, each.side) for each in links}
    return tuple(each for each in links if _whole(each) not in there)


def fingers_of(hand: ObservedLink, links: Sequence[ObservedLink]) -> tuple[ObservedLink, ...]:
    """The fingers of a hand, which a telling names by the hand."""
    return tuple(each for each in links if _whole(each) == (hand.kind, hand.side))


def by_fingers(
    own: tuple[Clause, ...], fingers: Sequence[tuple[Clause, ...]]
) -> tuple[Clause, ...]:
    """What a hand did; of a thing in which the palm had no part, what the finger did that had it.

    Args:
        own: What the hand did, as far as its own contacts and motion tell.
        fingers: What each of its fingers did, as done by the hand.
    """
    moved = {step.objects[:1] for step in own if step.changes}
    things = {step.objects[:1] for part in fingers for step in part if _moves_it(step)}
    for thing in sorted(things - moved):
        longest = max(fingers, key=lambda part: _moving_s(part, thing))
        theirs = (step for step in longest if step.objects[:1] == thing)
        own = (*(step for step in own if step.objects[:1] != thing), *theirs)
    return tuple(sorted(own, key=in_time))


def _moves_it(step: Clause) -> bool:
    return step.changes and step.possessed


def _moving_s(part: Sequence[Clause], thing: tuple[str, ...]) -> float:
    """For how long something that has a thing moves it [s]."""
    return sum(
        step.end_s - step.start_s for step in part if _moves_it(step) and step.objects[:1] == thing
    )


def _whole(link: ObservedLink) -> tuple[str | None, str]:
    """The kind and side of the link of which it is a part; no kind for what is no finger."""
    wholes = {row["part"]: row["whole"] for row in table("body_parts")}
    return wholes.get(link.kind.rstrip("0123456789")), link.side


def told_in_order(
    links: Sequence[ObservedLink], told: Sequence[tuple[Clause, ...]]
) -> tuple[Clause, ...]:
    """Every clause by its time; what the two hands of a pair do together is one clause."""
    rest = [list(each) for each in told]
    merged: list[Clause] = []
    for first, second in _pairs(links):
        one = _one_word(told[first], told[second])
        common, left, right = _together(one, _one_word(told[second], one))
        both, left, right = _reached_together(common, left, right)
        merged += common + both
        rest[first], rest[second] = left, right
    every = [*merged, *(each for clauses in rest for each in clauses)]
    return tuple(sorted(every, key=in_time))


def in_sequence(steps: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses, each ended as the same hands do the next to the same thing.

    That is where hands that do the same begin and end it not quite at once. Turning a thing about
    the vertical goes on beside what else is done to it.
    """
    out: list[Clause] = []
    for step in sorted(steps, key=in_time):
        at = next((at for at in range(len(out))[::-1] if out[at].ees == step.ees), None)
        last = None if at is None else out[at]
        same = last is not None and bool(last.objects) and last.objects[:1] == step.objects[:1]
        if last is not None and at is not None and same:
            over_s = last.end_s - step.start_s
            after = last.start_s < step.start_s and last.end_s < step.end_s
            if after and step.pattern not in ABOUT and 0.0 < over_s < REST_S:
                out[at] = replace(last, end_s=step.start_s)
        out.append(step)
    return tuple(out)


def mostly_together(links: Sequence[ObservedLink], steps: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses; what two hands do alike for most of the time of either is one, while both do.

    What one turned about alone for a noticed time before is told before that.
    """
    pairs = {frozenset({links[first].ee, links[second].ee}) for first, second in _pairs(links)}
    out: list[Clause] = []
    for step in steps:
        partner = next((each for each in out if _mostly_with(each, step, pairs)), None)
        if partner is None:
            out.append(step)
        else:
            both = replace(
                _both(partner, step),
                start_s=max(partner.start_s, step.start_s),
                end_s=min(partner.end_s, step.end_s),
            )
            out[out.index(partner)] = both
            first = min(partner, step, key=in_time)
            if both.pattern in {TURN, THIS_WAY} and both.start_s - first.start_s > SETTLING_S:
                out.append(replace(first, end_s=both.start_s))
    return tuple(sorted(out, key=in_time))


def _mostly_with(one: Clause, other: Clause, pairs: Collection[frozenset[str]]) -> bool:
    """Whether two hands of one agent change the same thing alike for most of the time of either."""
    hands = len(one.ees) == len(other.ees) == 1 and frozenset((*one.ees, *other.ees)) in pairs
    alike = one.signature == other.signature and one.changes
    longer_s = max(one.end_s - one.start_s, other.end_s - other.start_s)
    return hands and alike and one.overlap_s(other) > MOSTLY * longer_s


def as_the_other_hand(
    links: Sequence[ObservedLink], told: Sequence[tuple[Clause, ...]]
) -> list[tuple[Clause, ...]]:
    """What each hand did, that of one without measured contact in words of the other hand's.

    Both move one thing then, and what it does is told by the hand that was seen to have it.
    """
    out = [list(part) for part in told]
    for first, second in _pairs(links):
        for own, other in ((first, second), (second, first)):
            out[own] = _in_words_of(out[own], told[other], links[own].ee)
    return [tuple(part) for part in out]


def _in_words_of(own: Sequence[Clause], other: Sequence[Clause], ee: str) -> list[Clause]:
    out: list[Clause] = []
    for clause in own:
        theirs = [
            replace(each, ees=(ee,))
            for each in other
            if clause.unseen
            and each.changes
            and not each.unseen
            and each.objects[:1] == clause.objects[:1]
            and each.overlap_s(clause) > 0.5 * (each.end_s - each.start_s)
        ]
        out += theirs or [clause]
    return out


def with_the_other_hand(
    links: Sequence[ObservedLink],
    own: Sequence[tuple[Clause, ...]],
    told: Sequence[tuple[Clause, ...]],
) -> list[tuple[Clause, ...]]:
    """What each hand did, that of one of which its arm or trunk tells in the other hand's words.

    Contacts of an arm come and go while hands have a thing: where the two hands move one thing for
    most of a deed of the hand that moves it longer, both did that.

    Args:
        links: The links that are told.
        own: What each did by itself.
        told: What each did as part of one body.
    """
    out = list(told)
    for pair in _pairs(links):
        longer, shorter = sorted(pair, key=lambda place: -_changing_s(told[place]))
        if told[shorter] == own[shorter]:
            continue
        deeds = [
            replace(deed, ees=(links[shorter].ee,))
            for deed in told[longer]
            if deed.changes and _moved_share(deed, told[shorter]) > MOSTLY_MOVED
        ]
        rest = [
            step
            for step in told[shorter]
            if not any(_about_one(step, deed) and deed.overlap_s(step) > 0.0 for deed in deeds)
        ]
        out[shorter] = tuple(sorted((*rest, *deeds), key=in_time))
    return out


def _changing_s(steps: Sequence[Clause]) -> float:
    return sum(step.end_s - step.start_s for step in steps if step.changes)


def _about_one(step: Clause, other: Clause) -> bool:
    return step.changes and other.changes and step.objects[:1] == other.objects[:1]


def _moved_share(deed: Clause, steps: Sequence[Clause]) -> float:
    """In what share of a deed's time steps move the same thing."""
    moved_s = sum(max(deed.overlap_s(step), 0.0) for step in steps if _about_one(deed, step))
    return moved_s / max(deed.end_s - deed.start_s, SETTLING_S)


def _pairs(links: Sequence[ObservedLink]) -> list[tuple[int, int]]:
    """Places of links that are the two sides of one body part."""
    return [
        (first, second)
        for first in range(len(links))
        for second in range(first + 1, len(links))
        if links[first].kind == links[second].kind and links[first].side != links[second].side
    ]


def _together(
    first: Sequence[Clause], second: Sequence[Clause]
) -> tuple[list[Clause], list[Clause], list[Clause]]:
    """What both do at once as single clauses, and what is left of each."""
    matcher = SequenceMatcher(
        None,
        [each.signature for each in first],
        [each.signature for each in second],
        autojunk=False,
    )
    common: list[Clause] = []
    used_first, used_second = set[int](), set[int]()
    for block in matcher.get_matching_blocks():
        for step in range(block.size):
            a, b = first[block.a + step], second[block.b + step]
            if _at_once(a, b):
                common.append(_both(a, b))
                used_first.add(block.a + step)
                used_second.add(block.b + step)
    left = [each for index, each in enumerate(first) if index not in used_first]
    right = [each for index, each in enumerate(second) if index not in used_second]
    return common, left, right


def _reached_together(
    common: Sequence[Clause], left: list[Clause], right: list[Clause]
) -> tuple[list[Clause], list[Clause], list[Clause]]:
    """Reaching for what both hands do next together, though one comes later, as one clause.

    Returns:
        Such clauses, and what is left of each hand's.
    """
    both: list[Clause] = []
    for clause in (step for step in common if not step.frees):
        pair = [_reach_before(clause, rest) for rest in (left, right)]
        first, second = pair
        if first is not None and second is not None and first.overlap_s(second) > 0.0:
            both.append(_both(first, second))
            left, right = (
                [step for step in rest if step is not own]
                for rest, own in zip((left, right), pair, strict=True)
            )
    return both, left, right


def _reach_before(clause: Clause, rest: Sequence[Clause]) -> Clause | None:
    """A hand's last own clause before one of both, if it reaches for the same thing."""
    before = [step for step in rest if step.start_s < clause.start_s]
    reaches = bool(before) and before[-1].pattern == REACH
    return before[-1] if reaches and before[-1].objects[:1] == clause.objects[:1] else None


def _one_word(first: Sequence[Clause], second: Sequence[Clause]) -> tuple[Clause, ...]:
    """The first's clauses in the second's words, where both move one thing at once.

    It goes one way, whatever either hand does to it; the more general word is true of both.
    """
    out = []
    for clause in first:
        found = next((each for each in second if _moves_with(clause, each)), None)
        out.append(replace(clause, pattern=found.pattern, name=found.name) if found else clause)
    return tuple(out)


def _moves_with(clause: Clause, other: Clause) -> bool:
    same = clause.objects == other.objects and clause.changes and other.changes
    return same and other.name in clause.general and _at_once(clause, other)


def _at_once(first: Clause, second: Clause) -> bool:
    """Whether both begin and end together, but for a time that people do not notice."""
    begin = abs(first.start_s - second.start_s) < REST_S
    end = abs(first.end_s - second.end_s) < REST_S
    momentary = first.start_s == first.end_s and second.start_s == second.end_s
    return begin and end and (momentary or first.overlap_s(second) > 0.0)


def _both(first: Clause, second: Clause) -> Clause:
    """One clause of two; what is done in a moment is done when both have done it."""
    end_s = max(first.end_s, second.end_s)
    momentary = first.start_s == first.end_s and second.start_s == second.end_s
    return replace(
        first,
        ees=tuple(sorted((*first.ees, *second.ees))),
        start_s=end_s if momentary else min(first.start_s, second.start_s),
        end_s=end_s,
    )
