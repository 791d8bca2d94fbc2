"""How arguments tell contacts: how near, from when to when, from which side, how fast."""

from collections.abc import Sequence

from capar_rules.borders.ticks import constants, in_frames, times
from capar_rules.explain import arrangements, quantities
from capar_rules.explain.told_argument import UNBOUND, ToldArgument


class ContactsTold(ToldArgument):
    """What touches what, and how bodies lie and go to each other."""

    def _placed(self) -> str:
        """Where the border of an event stands, if not at its frame, which is the sixth argument."""
        frame = self.clock.frames[self.beside[0]][int(self.text)]
        told = self.clock.at(frame)
        began = self.clock.at(int(self.beside[5]))
        return "" if told == began else f", and settled there by {told}"

    def _keeper(self) -> str:
        """Which other end-effector has the segment's object since before this one touched it."""
        found = arrangements.keeper(self.clock, self.text)
        if found is None:
            return UNBOUND
        since, keeper, met = found
        hand, other = self.clock.called(self._hand), self.clock.called(keeper)
        if since == met:
            return (
                f"was in contact with the {other} from {self.clock.at(met)} on, as with the {hand}"
            )
        had = f"had been in contact with the {other} since {self.clock.at(since)}"
        it = self.clock.it(self.clock.objects.get(self.text, ""), object_=True)
        return f"{had}, before the {hand} touched {it} at {self.clock.at(met)}"

    def _struck(self) -> str:
        """How fast the segment's object met this one at the end."""
        frame = arrangements.frame_of(self.clock, self.beside[0], "end")
        thing = self.clock.objects.get(self.beside[0], "")
        speeds = self.clock.measured.closing.get((thing, self.text), {})
        merge = in_frames(times().merge_ms, self.clock.rate_hz)
        near = [(abs(first - frame), first) for first in speeds] if frame is not None else []
        if not near or min(near)[0] > merge:
            return UNBOUND
        how = "the greatest of their middles just before they met, in any direction"
        blow = f"{how}; a blow has {constants()['blow_mm_s']} mm/s or more"
        return f"at a relative speed of {speeds[min(near)[1]]} mm/s ({blow})"

    def _contact(self, side: str, end: int) -> str:
        """When the contact of the two bodies beside this that there is at a side begins or ends."""
        frame = arrangements.frame_of(self.clock, self.beside[0], side)
        found = None if frame is None else self._met_near(self.beside[1], self.beside[2], frame)
        return UNBOUND if found is None else self.clock.at(found[end])

    def _apart_between(self) -> str:
        """From when to when the two bodies beside this did not touch that did at both borders."""
        until, since = self._contact("start", 1), self._contact("end", 0)
        borders = [self.clock.border(self.beside[0], side) for side in ("start", "end")]
        return "in between" if [until, since] == borders else f"from {until} to {since}"

    def _on(self) -> str:
        """Until when the contact that there is at the start lasts, if longer than a border."""
        frame = arrangements.frame_of(self.clock, self.beside[0], "start")
        found = None if frame is None else self._met_near(self.beside[1], self.beside[2], frame)
        late = found and found[1] - (frame or 0) >= in_frames(times().merge_ms, self.clock.rate_hz)
        return f" and until {self.clock.at(found[1])}," if found and late else ""

    def _ended_at(self) -> str:
        """When the contact ends that began at this frame, of the fourth argument and the fifth."""
        first = int(self.text)
        pair = (self.beside[3], self.beside[4])
        contacts = self.clock.measured.contacts
        found = [*contacts.get(pair, ()), *contacts.get(pair[::-1], ())]
        last = next((end for begin, end in found if begin == first), None)
        tick = self.clock.frames[self.beside[0]][int(self.beside[1])]
        return self.clock.at(tick if last is None else last)

    def _parted(self) -> str:
        """When the contact that began at the fourth argument ends, if before the segment."""
        one, other, first = *self.beside[1:3], int(self.beside[3])
        contacts, span = self.clock.measured.contacts, self.clock.span(self.clock.own)
        found = [*contacts.get((one, other), ()), *contacts.get((other, one), ())]
        last = next((end for begin, end in found if begin == first), None)
        tick = self.clock.frames[self.beside[0]][int(self.text)]
        return self.clock.at(last if last is not None and span and last < span[0] else tick)

    def _placed_end(self) -> str:
        """Where the border of the end of a contact stands, if not where that ends."""
        ended = type(self)(self.beside[5], self.beside, self.clock)._ended_at()
        told = self.clock.at(self.clock.frames[self.beside[0]][int(self.text)])
        until = f"; the border for it is placed at {told}"
        return "" if told == ended else until

    def _throughout(self) -> str:
        """Throughout the segment; as far as the two bodies beside this were tracked."""
        one, other = self.beside[1:3]
        lost = any(self._gaps_within(body) for body in (one, other))
        span = self.clock.span(self.text) or (0, 0)
        known = self.clock.measured.flickers
        apart = {*known.get((one, other), ()), *known.get((other, one), ())}
        spans = [
            f"{self.clock.at(first)} to {self.clock.at(last)}"
            for first, last in sorted(apart)
            if first <= span[1] and last >= span[0]
        ]
        gaps = f" but for {' and '.join(spans)}" if spans else ""
        return f"throughout{gaps}{self._beyond(span)}" + ", as far as tracked" * lost

    def _beyond(self, span: tuple[int, int]) -> str:
        """How far apart the two bodies beside this are at moments, if beyond their contact."""
        one, other = self.beside[1:3]
        known, reach = self.clock.measured, self.clock.measured.reaches.get((one, other))
        far = known.apart(one, other, *span) if known.apart and reach else None
        if far is None or reach is None or 1000.0 * far[1] <= reach.told_mm:
            return ""
        return f" (at moments up to {quantities.spread(far[1])} apart{self.clock.closed_gaps})"

    def _after_leaving(self) -> str:
        """When the two bodies beside this parted before, if at the start or in the segment."""
        one, other = self.beside[1:3]
        span, known = self.clock.span(self.text), self.clock.measured.contacts
        now = self._met_near(one, other, span[1]) if span else None
        if span is None or now is None:
            return ""
        early = span[0] - in_frames(times().merge_ms, self.clock.rate_hz)
        found = [*known.get((one, other), ()), *known.get((other, one), ())]
        left = [last for _, last in found if early <= last < now[0]]
        return f", after parting from it at {self.clock.at(max(left))}" if left else ""

    def _comes(self) -> str:
        """That the second argument comes to touch the third, or to count so."""
        one, other = self.beside[1:3]
        called = self.clock.called(other)
        start, end = (self.clock.border(self.text, side) for side in ("start", "end"))
        near = self.clock.measured.near(one, other)
        if self._lost_at("start"):
            met = "counted as in contact with" if near else "touched"
            return f"{met} the {called} {self._since_seen()}"
        touch = "count as in contact with" if near else "touch"
        return f"did not {touch} the {called} at the start ({start}) but did at the end ({end})"

    def _no_longer(self) -> str:
        """That the two bodies beside this touch no longer at the end, or when they are seen again.

        What is not tracked at the end is told of when it was seen last.
        """
        end = self.clock.border(self.text, "end")
        if not self._lost_at("end"):
            if self.beside[1] == self._hand and not self._touches(
                self._hand, (self.clock.span(self.text) or (0, 0))[1]
            ):
                near = self.clock.measured.near(self._hand, self.beside[2])
                return (
                    f" and {'with ' * near}nothing recorded or assumed any more at the end ({end})"
                )
            return f" but no longer at the end ({end})"
        span = self.clock.span(self.text) or (0, 0)
        last = max(
            (gap[0] - 1 for body in self.beside[1:3] for gap in self._gaps_within(body)),
            default=span[0],
        )
        found = self._met_near(self.beside[1], self.beside[2], span[0])
        if found is None or last <= found[1]:
            return f" and was not tracked at the end ({end}), which counts as no contact"
        when = f"when last tracked ({self.clock.at(last)})"
        if self.beside[1] == self._hand and not self._touches(self._hand, last):
            near = self.clock.measured.near(self._hand, self.beside[2])
            return f" and {'with ' * near}nothing recorded or assumed any more {when}"
        return f" but no longer {when}"

    def _since_seen(self) -> str:
        """From when on two bodies touch of which one was not tracked at the start."""
        span = self.clock.span(self.text) or (0, 0)
        found = self._met_near(self.beside[1], self.beside[2], span[1])
        since = max(found[0], span[0]) if found else span[1]
        end = f"at the end ({self.clock.at(span[1])})"
        at = end if since == span[1] else f"from {self.clock.at(since)} on"
        return f"{at}, and was not tracked at the start, which counts as no contact"

    def _touches(self, body: str, frame: int) -> bool:
        """Whether a body touches anything at a frame and after it."""
        return any(
            first <= frame < last
            for pair, spans in self.clock.measured.contacts.items()
            if body in pair
            for first, last in spans
        )

    def _all_along(self) -> str:
        """Throughout, if the end-effector touched nothing in between either."""
        span = self.clock.span(self.text) or (0, 0)
        between = any(
            first < span[1] and last > span[0]
            for pair, spans in self.clock.measured.contacts.items()
            if self._hand in pair
            for first, last in spans
        )
        return "at the start or at the end" if between else "throughout"

    def _unseen(self) -> str:
        """That the end-effector was not tracked at a border of the segment."""
        lost = [side for side in ("start", "end") if self._lost_at(side, (self._hand,))]
        return f" (at the {' and the '.join(lost)} it was not tracked)" * bool(lost)

    def _gaps_within(self, body: str) -> list[tuple[int, int]]:
        span = self.clock.span(self.text) or self.clock.span(self.clock.own) or (0, 0)
        gaps = self.clock.measured.lost.get(body, ())
        return [(first, last) for first, last in gaps if first < span[1] and last > span[0]]

    def _lost_at(self, side: str, bodies: Sequence[str] = ()) -> bool:
        """Whether one of two bodies was not tracked at a border, up to one frame inside it."""
        frame = arrangements.frame_of(self.clock, self.text, side)
        if frame is None:
            return False
        inner = frame + (1 if side == "start" else -1)
        return any(
            first <= frame <= last and first <= inner <= last
            for body in bodies or self.beside[1:3]
            for first, last in self._gaps_within(body)
        )

    def _lets_go(self) -> str:
        """Until when another one touches the object of a segment, from before it was reached."""
        segment, _, thing, last = self.beside
        hand = self.clock.called(arrangements.hand_of(segment))
        until, span = self.clock.at(int(last)), self.clock.span(segment)
        own = self._met_near(arrangements.hand_of(segment), thing, span[1]) if span else None
        if own is None:
            return UNBOUND
        kept = f" while the {hand} stayed in contact" * (own[1] > int(last))
        it, called = self.clock.it(thing, object_=True), self.clock.called(thing)
        met = f"when the {hand} came into contact with {it} ({self.clock.at(own[0])})"
        return f"was in contact with the {called} {met}, and parted from {it} (after {until}){kept}"

    def _takes(self) -> str:
        """Since when another one touches the object of a segment, that is let go of there."""
        segment, _, thing, first = self.beside
        hand, span = arrangements.hand_of(segment), self.clock.span(segment)
        left = self._met_near(hand, thing, span[0]) if span else None
        if left is None:
            return UNBOUND
        since, until = self.clock.at(int(first)), self.clock.at(left[1])
        it, called = self.clock.it(thing, object_=True), self.clock.called(hand)
        own = f"while the {called} was in contact with {it} (from {self.clock.at(left[0])})"
        kept = f"and stayed so when the {called} parted from {it} (after {until})"
        return f"came into contact with the {self.clock.called(thing)} at {since}, {own}, {kept}"
