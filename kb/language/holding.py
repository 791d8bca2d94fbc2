"""What a hand has although no contact was measured, and when things change hands.

Geometry misses contacts by a little; what moves a thing is told by the rules of movers, and by
them a text tells what a hand did to a thing. Wording only: segments stay as they are.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from capar.model.facts import MovedBy, MovesWith, Moving, OfAgent, Touching
from capar.model.observation import Observation, ObservedLink, Segment
from kb.language.clause import Clause
from kb.language.lexicalisation import GIVEN, TO_A_SIDE
from kb.language.thresholds import BESIDE_MM, REST_S, RISEN_M, SCRAP_S, STILL_M, UNSEEN_S
from kb.lexicon.tables import table

BY_HAND = ("carried", "pushed")
"""How an end-effector moves what it has."""


GENERAL = {"MoveObj": (), "PutDown": ("MoveObj",), "Lift": ("Raise", "MoveObj")}
"""What the names specialise that tell of motion without measured contact."""


class Handled(NamedTuple):
    """A segment, and what is told of it."""

    segment: Segment
    clause: Clause


class Span(NamedTuple):
    """From when to when [s]."""

    start_s: float
    end_s: float


class Holding:
    """What moved each thing, and contacts of hands with it."""

    def __init__(self, observation: Observation) -> None:
        self._step_s = observation.duration_s / max(observation.frames - 1, 1)
        self._moves = [
            each for each in observation.facts if isinstance(each, MovedBy) and each.how in BY_HAND
        ]
        self._touches = [each for each in observation.facts if isinstance(each, Touching)]
        self._motions = [each for each in observation.facts if isinstance(each, Moving)]
        acting = {link.ee for link in observation.links}
        self._supports = [each for each in self._touches if each.body not in acting]
        self._beside = [
            each
            for each in observation.facts
            if isinstance(each, MovesWith) and each.gap <= BESIDE_MM
        ]
        owners = [fact for fact in observation.facts if isinstance(fact, OfAgent)]
        self._owners = {each.body: each.agent for each in owners}
        self._links = observation.links
        self._tracks = {each.body: each for each in observation.tracks}
        self._gives = [each for each in observation.segments if each.name == "Give"]

    def released_s(self, segment: Segment) -> float:
        """When the hand, with its fingers, ceases to touch what it leaves in a segment [s]."""
        hand = self._hand(segment.ee)
        ends = [
            each.last
            for each in self._touches
            if each.body in hand
            and each.other in segment.objects[:1]
            and each.first <= segment.first
            and segment.first <= each.last <= segment.last
        ]
        return max(ends) * self._step_s if ends else segment.start_s

    def passed(self, giving: Segment) -> tuple[Span, str] | None:
        """From when the other hand has it to when this one has not, and the side of that hand.

        None if none takes it.
        """
        end_s = self.released_s(giving)
        sides = {link.ee: link.side for link in self._links}
        begins = [
            (each.first * self._step_s, sides[each.body])
            for each in self._touches
            if each.other in giving.objects[:1]
            and self._other_hand(giving.ee, each.body)
            and each.first * self._step_s <= max(end_s, giving.start_s)
            and each.last * self._step_s > end_s
        ]
        if not begins:
            return None
        begin_s, side = max(begins)
        return Span(min(begin_s, end_s), end_s), side

    def received(self, receiving: Segment) -> bool:
        """Whether the other hand of the agent gives it, which tells the same."""
        spans = [
            self.passed(each)
            for each in self._gives
            if each.objects[:1] == receiving.objects[:1] and self._other_hand(receiving.ee, each.ee)
        ]
        return any(span and abs(span[0].start_s - receiving.end_s) < REST_S for span in spans)

    def _other_hand(self, one: str, other: str) -> bool:
        """Whether both are hands of one agent."""
        kinds = {link.ee: (link.kind, link.side) for link in self._links}
        if one not in kinds or other not in kinds or one == other:
            return False
        same = self._owners.get(one) == self._owners.get(other)
        return same and kinds[one][0] == kinds[other][0] and kinds[one][1] != kinds[other][1]

    def _hand(self, ee: str) -> frozenset[str]:
        """An end-effector with its fingers."""
        wholes = {row["part"]: row["whole"] for row in table("body_parts")}
        own = next((link for link in self._links if link.ee == ee), None)
        if own is None:
            return frozenset({ee})
        return frozenset(
            {ee}
            | {
                link.ee
                for link in self._links
                if (wholes.get(link.kind.rstrip("0123456789")), link.side) == (own.kind, own.side)
            }
        )

    def kept(self, link: ObservedLink, told: Sequence[Handled]) -> list[Handled]:
        """What is told of a link, with what it moved where no contact was measured.

        Between two contacts, the hand then kept hold of the thing; before the first, it had it
        since it moved it.
        """
        out: list[Handled] = []
        at = 0
        while at < len(told):
            size = 1
            if _has_nothing(told[at]):
                while at + size < len(told) and _about_the_same(told[at], told[at + size]):
                    size += 1
            part = told[at : at + size]
            before = told[at - 1] if at else None
            after = told[at + size] if at + size < len(told) else None
            out += self._with_moves(part, before, after)
            at += size
        return out

    def _with_moves(
        self, part: Sequence[Handled], before: Handled | None, after: Handled | None
    ) -> Iterable[Handled]:
        first, last = part[0].segment, part[-1].segment
        thing = first.objects[:1]
        if not _has_nothing(part[0]):
            return part
        had = before is not None and before.segment.possessed and _of(before) == thing
        again = after is not None and after.segment.possessed and _of(after) == thing
        moves = self._own_moves(first.ee, thing, first.start_s, last.end_s, known=had or again)
        least_s = UNSEEN_S if had and again else SCRAP_S
        if sum(each.end_s - each.start_s for each in moves) < least_s:
            return part
        start_s, end_s = moves[0].start_s, moves[-1].end_s
        touched_s = self._first_touch_s(first.ee, thing, first.start_s, start_s)
        if touched_s < start_s and self._nobody_else(first.ee, thing, touched_s, start_s):
            start_s = touched_s
        start_s, end_s = self._in_motion(thing, Span(start_s, end_s))
        pattern, name = self._moved_as(thing, start_s, end_s)
        move = replace(
            part[0].clause,
            pattern=pattern,
            objects=thing,
            start_s=start_s,
            end_s=end_s,
            changes=True,
            name=name,
            general=GENERAL[name],
            goes_on=True,
            possessed=True,
            unseen=True,
            rights=False,
        )
        high = self._high(thing, start_s, end_s) if name == "MoveObj" else None
        out = [Handled(first, move)]
        if high is not None:
            up, down = (
                replace(move, pattern=said, name=called, general=GENERAL[called])
                for said, called in (("lift {1}", "Lift"), ("put {1} down", "PutDown"))
            )
            out = [
                Handled(first, replace(up, end_s=high.start_s)),
                Handled(first, replace(down, start_s=high.end_s)),
            ]
        if not had:
            came_s = self._first_touch_s(first.ee, thing, first.start_s, start_s)
            came = replace(
                part[0].clause, pattern="reach for {1}", changes=False, end_s=came_s, objects=thing
            )
            out.insert(0, Handled(first, came))
        leaves = [each for each in part if each.clause.frees and each.segment.end_s > end_s]
        if leaves and not again:
            left_s = max(moves[-1].end_s, self.released_s(leaves[-1].segment))
            gone = replace(leaves[-1].clause, pattern="let go of {1}", start_s=left_s, end_s=left_s)
            out.append(Handled(leaves[-1].segment, gone))
        return out

    def _nobody_else(self, ee: str, thing: Sequence[str], start_s: float, end_s: float) -> bool:
        """Whether no other end-effector moves it meanwhile."""
        hand = self._hand(ee)
        return not any(
            each.object in thing
            and each.mover not in hand
            and each.first * self._step_s < end_s
            and start_s < each.last * self._step_s
            for each in self._moves
        )

    def _in_motion(self, thing: Sequence[str], span: Span) -> Span:
        """The part of a time in which the thing moves."""
        parts = [
            (
                max(each.first * self._step_s, span.start_s),
                min(each.last * self._step_s, span.end_s),
            )
            for each in self._motions
            if each.object in thing
        ]
        parts = [each for each in parts if each[1] > each[0]]
        return Span(min(parts)[0], max(last for _, last in parts)) if parts else span

    def _moved_as(self, thing: Sequence[str], start_s: float, end_s: float) -> tuple[str, str]:
        """How to say that it is moved, by what bears it at the start and the end."""
        borne = self._borne(thing, start_s), self._borne(thing, end_s)
        if borne == (False, True):
            return "put {1} down", "PutDown"
        return ("lift {1}", "Lift") if borne == (True, False) else ("move {1}", "MoveObj")

    def _high(self, thing: Sequence[str], start_s: float, end_s: float) -> Span | None:
        """From when to when a thing is highest that is lifted and put down again within a time [s].

        None where it is not off what bears it for a noticed time, or rises by less than is noticed.
        """
        track = self._tracks.get("".join(thing[:1]))
        borne = sorted(
            Span(each.first * self._step_s, each.last * self._step_s)
            for each in self._supports
            if each.body in thing or each.other in thing
        )
        free = [
            Span(before.end_s, after.start_s)
            for before, after in pairwise(borne)
            if start_s <= before.end_s and after.start_s <= end_s
        ]
        off = max(free, key=lambda span: span.end_s - span.start_s, default=Span(0.0, 0.0))
        if track is None or track.step_s == 0.0 or off.end_s - off.start_s < REST_S:
            return None
        first, last = (round(time_s / track.step_s) for time_s in off)
        heights = track.positions[:, 2]
        top_m = float(np.nanmax(heights[first : last + 1], initial=-np.inf))
        if not top_m > heights[first] + RISEN_M:
            return None
        there = first + np.flatnonzero(heights[first : last + 1] > top_m - STILL_M)
        return Span(float(there[0]) * track.step_s, float(there[-1]) * track.step_s)

    def _borne(self, thing: Sequence[str], time_s: float) -> bool:
        frame = time_s / self._step_s if self._step_s else 0.0
        return any(
            each.first <= frame <= each.last
            for each in self._supports
            if each.body in thing or each.other in thing
        )

    def _own_moves(
        self, ee: str, thing: Sequence[str], start_s: float, end_s: float, *, known: bool
    ) -> list[Span]:
        """When the hand, with its fingers, moves a thing; empty if it never carries it for long.

        A hand that is known to have it before or afterwards moves it as well while it is beside it
        and both move as one, whichever hand the rules of movers name.
        """
        hand = self._hand(ee)
        own = [
            (each.how, each.first, each.last)
            for each in self._moves
            if each.object in thing and each.mover in hand
        ]
        if known:
            own += [
                ("carried", each.first, each.last)
                for each in self._beside
                if each.object in thing and each.body in hand
            ]
        cut = [
            (how, max(first * self._step_s, start_s), min(last * self._step_s, end_s))
            for how, first, last in own
        ]
        spans = sorted(Span(begin, end) for _, begin, end in cut if end > begin)
        carried_s = sum(end - begin for how, begin, end in cut if how == "carried" and end > begin)
        return spans if carried_s >= UNSEEN_S else []

    def _first_touch_s(self, ee: str, thing: Sequence[str], start_s: float, end_s: float) -> float:
        """When the hand came to the thing, by a contact or by moving it."""
        hand = self._hand(ee)
        begins = [
            each.first * self._step_s
            for each in self._touches
            if each.body in hand and each.other in thing
        ]
        return min([end_s, *(each for each in begins if start_s <= each <= end_s)])


def _of(handled: Handled) -> tuple[str, ...]:
    return handled.segment.objects[:1]


def _has_nothing(handled: Handled) -> bool:
    """Whether the hand, as far as contacts tell, has not got the thing, and gives it to nobody."""
    given = handled.clause.pattern in {GIVEN, *TO_A_SIDE.values()}
    return not (handled.segment.possessed or given)


def _about_the_same(one: Handled, other: Handled) -> bool:
    """Whether a hand that has nothing still is about the same thing."""
    return _has_nothing(other) and _of(one) == _of(other)
