"""How arguments tell rests, and what a segment is no case of."""

import math

from capar_rules.borders.ticks import constants, in_frames
from capar_rules.explain import arrangements, quantities
from capar_rules.explain.quantities import LEAST_M
from capar_rules.explain.told_argument import UNBOUND, ToldArgument


class RestsTold(ToldArgument):
    """Where bodies rested, for how long, and how near to it they came back."""

    def _as_foot(self) -> str:
        """That an end-effector counts as the foot that it is a part of."""
        called = self.clock.called(self._hand)
        return f"the {called} counts as the foot" if " of the " in called else UNBOUND

    def _floor(self) -> str:
        """From where on a body's motion counts, if it is known."""
        known, span = self.clock.measured, self._span_beside("spread")
        floor_m = known.floors.get(self.text)
        moved = None if span is None else self._moved(self.text, span)
        if span is None or not floor_m or moved is None or moved.spread_m >= floor_m:
            return " and did not count as moving"
        far, turn = quantities.length(floor_m), known.turn_floors.get(self.text)
        if known.turned is None or not turn:
            return f", less than the {far} from which on it counts as moved"
        if known.turned(self.text, *span) >= turn:
            return " and did not count as moving"
        angle = quantities.degrees(round(1000.0 * turn))
        return f", less than the {far} or {angle} from which on it counts as moved"

    def _not_at_rest(self) -> str:
        """Why the segment is no rest: it lasted too briefly, or its end-effector moved."""
        span = self.clock.span(self.text)
        lasted = (span[1] - span[0]) / self.clock.rate_hz if span else float("inf")
        if 1000.0 * lasted < constants()["rest_ms"]:
            rests = self.clock.measured.rests.get(self._hand, ())
            if span and any(first < span[1] and last > span[0] for first, last in rests):
                return f"it lasted {lasted:.2f} s, and a rest lasts {self._rest_s()} or more"
            return f"the {self.clock.called(self._hand)} did not count as at rest"
        hand = self.clock.called(self._hand)
        return f"the {hand} did not count as at rest for {self._rest_s()} or more at a time"

    def _long(self) -> str:
        """That a rest is longer than a rest has to be."""
        span, least = self._span_beside("long"), constants()["rest_ms"]
        long = span is not None and span[1] - span[0] > in_frames(least, self.clock.rate_hz)
        return f", {'longer than' if long else 'just'} the {self._rest_s()} of a rest"

    def _when(self) -> str:
        """A time, and whether it lies before or after the segment that is explained."""
        return self._when_of(int(self.text))

    def _from_rest(self) -> str:
        """What the segment's object left in it, if it touched anything."""
        hand = self.clock.called(self._hand)
        left = [f"the {self.clock.called(one)}" for one in arrangements.left(self.clock, self.text)]
        return f"left {' and '.join(left)}" if left else f"was at rest when the {hand} took it"

    def _away(self) -> str:
        """How far from where it had rested the end-effector ended, or that it had not rested."""
        span, near = self.clock.span(self.text), constants()["aside_mm"] / 1000.0
        if span is None:
            return UNBOUND
        if not self._earlier_postures():
            start = self.clock.at(span[0])
            none = f"no rest of {self._rest_s()} or more, touching nothing, before {start}"
            return f"had no posture to resume ({none})"
        found = self._nearest_posture()
        if found is None:
            start = self.clock.at(self.clock.frames[self._hand][0])
            return f"had no known posture to resume (it was not tracked at {start})"
        if found[0] < near:
            return UNBOUND
        far = quantities.length(found[0])
        return f"ended {far} from {self._posture(found[1], near, self._others(found[1]))}"

    def _others(self, frame: int) -> str:
        """That no other posture before is nearer than the one of that frame."""
        begin = self.clock.frames[self._hand][0]
        rests = [other for other in self._earlier_postures() if other not in (frame, begin)]
        if rests:
            return "; other places where it rested are further"
        since = f"; it had no rest of {self._rest_s()} or more, touching nothing, since"
        return since if frame == begin else ""

    def _back(self) -> str:
        """How near to where it had rested the end-effector came back."""
        found, near = self._nearest_posture(), constants()["aside_mm"] / 1000.0
        if found is None or found[0] >= near:
            return UNBOUND
        told = "less than 1 cm" if found[0] < LEAST_M else quantities.length(found[0])
        return f"ended {told} from {self._posture(found[1], near)}"

    def _posture(self, frame: int, near_m: float, others: str = "") -> str:
        """A place where the end-effector had been, touching nothing."""
        begin = frame == self.clock.frames[self._hand][0]
        how, first = ("was", ", as the recording began") if begin else ("rested", "")
        near = quantities.length(near_m)
        return (
            f"where it {how} at {self.clock.at(frame)}{first} (a return is within {near}{others})"
        )

    def _earlier_postures(self) -> list[int]:
        """The last frames of the rests before the segment in which it touched nothing.

        The first frame counts as one if it touches nothing then.
        """
        span, known = self.clock.span(self.text), self.clock.measured
        touching = [
            (first, last)
            for contacts in known.held.values()
            for ee, first, last in contacts
            if ee == self._hand
        ]
        begin = self.clock.frames.get(self._hand, (0,))[0]
        least = in_frames(constants()["rest_ms"], self.clock.rate_hz)
        rests = [
            (first, last)
            for first, last in known.rests.get(self._hand, ())
            if last - first >= least
        ]
        return [
            last
            for first, last in ((begin, begin), *rests)
            if span is not None
            and last <= span[0]
            and not any(start <= last and end >= first for start, end in touching)
        ]

    def _nearest_posture(self) -> tuple[float, int] | None:
        """How far it ended from the nearest of its places of rest before [m], and that frame."""
        span, rests = self.clock.span(self.text), self._earlier_postures()
        if span is None or not rests:
            return None
        ways = ((self._moved(self._hand, (first, span[1])), first) for first in rests)
        found = ((way.straight_m, first) for way, first in ways if way)
        return min((one for one in found if not math.isnan(one[0])), default=None)
