"""How arguments tell contacts: how near, from when to when, from which side, how fast."""

from collections.abc import Sequence

from capar_rules.borders.times import constants, in_frames, times
from capar_rules.explain import arrangements, quantities
from capar_rules.explain.arrangements import AFTER_DEG, AHEAD_DEG
from capar_rules.explain.told_argument import UNBOUND, ToldArgument


class ContactsTold(ToldArgument):
    """What touches what, and how bodies lie and go to each other."""

    def _placed(self) -> str:
        """Where the border of an event stands, if not at its frame, which is the sixth argument."""
        frame = self.clock.frames[self.beside[0]][int(self.text)]
        told = self.clock.at(frame)
        began = self.clock.at(int(self.beside[5]))
        return "" if told == began else f", and settled there by {told}"

    def _reach(self) -> str:
        """Up to which distance the second and the third argument count as touching."""
        reach = self.clock.measured.reaches.get((self.beside[1], self.beside[2]))
        return UNBOUND if reach is None else f"{reach.told_mm} mm"

    def _keeper(self) -> str:
        """Which other end-effector has the segment's object since before this one touched it."""
        thing, span = self.clock.objects.get(self.text, ""), self.clock.span(self.text)
        contacts = self.clock.measured.held.get(thing, ())
        if span is None:
            return UNBOUND
        own = [first for ee, first, last in contacts if ee == self._hand and first <= span[0]]
        before = [
            (first, self.clock.called(ee))
            for ee, first, last in contacts
            if ee != self._hand and own and first <= max(own) and last >= span[1]
        ]
        if not before:
            return UNBOUND
        since, keeper = min(before)
        return f"was held by the {keeper} already (since {self.clock.at(since)})"

    def _bearing(self, form: str) -> str:
        """At which level angle to the line from the end-effector to its middle the thing went."""
        found = arrangements.bearing(self.clock, self.text)
        if found is None:
            return UNBOUND
        hand, thing = self.clock.called(self._hand), self.clock.about(self.text)
        line = f"to the level line from the {hand} to the middle of the {thing}"
        ahead, after = f"{AHEAD_DEG:.0f}° or less is ahead", f"{AFTER_DEG:.0f}° or more is after"
        if form.startswith("not_"):
            whither = f"neither after the {hand} nor ahead of it, but"
            if found.offset_deg >= AFTER_DEG:
                whither = f"after the {hand}, and not ahead of it,"
            if found.offset_deg <= AHEAD_DEG:
                whither = f"ahead of the {hand}, and not after it,"
            angle = f"{found.offset_deg:.0f}°"
            return f" {whither} at {angle} {line} ({after}, {ahead})"
        if form == "ahead" and found.by_press:
            line = f"to the direction in which the {hand} pressed it"
            return f" (at {found.press_deg:.0f}° {line}; {ahead})"
        asked = ahead if form == "ahead" else after
        return f" (at {found.offset_deg:.0f}° {line}; {asked})"

    def _kept(self) -> str:
        """What the segment's object touches at the start and at the end."""
        found = arrangements.kept(self.clock, self.text)
        return " and ".join(f"the {self.clock.called(other)}" for other in found) or UNBOUND

    def _over(self) -> str:
        """How far the fourth argument is above the fifth at the side that this one names."""
        frame = arrangements.frame_of(self.clock, self.beside[0], self.text)
        over = self.clock.measured.over
        if over is None or frame is None:
            return UNBOUND
        other = self.clock.called(self.beside[4])
        return quantities.over(over(self.beside[3], self.beside[4], frame), other)

    def _share(self) -> str:
        """Which share of the fourth argument is in the fifth at the side that this one names."""
        frame = arrangements.frame_of(self.clock, self.beside[0], self.text)
        over = self.clock.measured.over
        if over is None or frame is None:
            return UNBOUND
        how, body, other = self.beside[2:5]
        at = arrangements.lying(self.clock, how, body, other, frame)
        if at is None:
            return UNBOUND
        share = quantities.percent(over(body, other, at).share)
        return f" ({share} of it{f' at {self.clock.at(at)}' * (at > frame)})"

    def _borne(self) -> str:
        """From which side the fourth argument pushes the third, at the side that this one names."""
        frame = arrangements.frame_of(self.clock, self.beside[0], self.text)
        if frame is None:
            return UNBOUND
        thing, other = self.beside[2:4]
        angle = arrangements.normal_deg(self.clock, thing, other, frame)
        if angle is None:
            return UNBOUND
        most = arrangements.steepest_deg()
        met = self._met_near(thing, other, frame)
        at = f" at {self.clock.at(met[0])}" if met else ""
        return f"{at} ({angle:.0f}° off straight up; {most:.0f}° or less bears)"

    def _struck(self) -> str:
        """How fast the segment's object met this one at the end."""
        frame = arrangements.frame_of(self.clock, self.beside[0], "end")
        thing = self.clock.objects.get(self.beside[0], "")
        speeds = self.clock.measured.closing.get((thing, self.text), {})
        merge = in_frames(times().merge_ms, self.clock.rate_hz)
        near = [(abs(first - frame), first) for first in speeds] if frame is not None else []
        if not near or min(near)[0] > merge:
            return UNBOUND
        blow = f"a blow has {constants()['blow_mm_s']} mm/s or more"
        return f"at a relative speed of {speeds[min(near)[1]]} mm/s ({blow})"

    def _poised(self) -> str:
        """Where the segment's object is to this one at the start."""
        frame, thing = arrangements.frame_of(self.clock, self.beside[0], "start"), ""
        thing = self.clock.objects.get(self.beside[0], "")
        if frame is None:
            return UNBOUND
        for how, told in (("above", "above"), ("inside", "inside")):
            if arrangements.lying(self.clock, how, thing, self.text, frame) is not None:
                return told
        reach = self.clock.measured.reaches.get((thing, self.text))
        if self.clock.measured.near(thing, self.text) and reach is not None:
            return f"within {reach.told_mm} mm of"
        return "in contact with"

    def _contact(self, side: str, end: int) -> str:
        """When the contact of the two bodies beside this that there is at a side begins or ends."""
        frame = arrangements.frame_of(self.clock, self.beside[0], side)
        found = None if frame is None else self._met_near(self.beside[1], self.beside[2], frame)
        return UNBOUND if found is None else self.clock.at(found[end])

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

    def _placed_end(self) -> str:
        """Where the border of the end of a contact stands, if not where that ends."""
        ended = type(self)(self.beside[5], self.beside, self.clock)._ended_at()
        told = self.clock.at(self.clock.frames[self.beside[0]][int(self.text)])
        until = f"; the border is at {told}, until when one lay on the other"
        return "" if told == ended else until

    def _palm(self) -> str:
        """From which side the segment's object pushes the end-effector that lies on it."""
        span, thing = self.clock.span(self.text), self.clock.objects.get(self.text, "")
        angle = arrangements.normal_deg(self.clock, self._hand, thing, span[0]) if span else None
        if angle is None:
            return UNBOUND
        most = arrangements.steepest_deg()
        return f" (which pushed it {angle:.0f}° off straight up; {most:.0f}° or less bears)"

    def _unslid(self) -> str:
        """That the segment's object stayed on nothing, where it touches nothing at both borders."""
        kept = arrangements.kept(self.clock, self.text)
        return UNBOUND if kept else "did not stay on one and the same tracked object"

    def _levels(self) -> str:
        """Whether a path becomes level at the tick that this names, or ceases to be."""
        frame = self.clock.frames[self.beside[0]][int(self.text)]
        spans = self.clock.measured.level.get(self.beside[3], ())
        begins = any(first == frame for first, _ in spans)
        ends = any(last == frame for _, last in spans)
        return "became level" if begins and not ends else "ceased to be level" * ends

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
        return f"throughout{gaps}" + ", as far as tracked" * lost

    def _comes(self) -> str:
        """That the second argument comes to touch the third, or to be within their reach."""
        one, other = self.beside[1:3]
        called = self.clock.called(other)
        start, end = (self.clock.border(self.text, side) for side in ("start", "end"))
        near = self.clock.measured.near(one, other)
        first = f"was not within {self._reach()} of" if near else "did not touch"
        then = "was" if near else "did"
        if self._lost_at("start"):
            met = f"was within {self._reach()} of" if near else "touched"
            return f"{met} the {called} at the end ({end}) and was not tracked at the start"
        return f"{first} the {called} at the start ({start}) but {then} at the end ({end})"

    def _no_longer(self) -> str:
        """That the two bodies beside this touch no longer at the end, or when they are seen again.

        What is not tracked at the end is told of when it was seen last.
        """
        end = self.clock.border(self.text, "end")
        if not self._lost_at("end"):
            return f" but no longer at the end ({end})"
        span = self.clock.span(self.text) or (0, 0)
        last = max(
            (gap[0] - 1 for body in self.beside[1:3] for gap in self._gaps_within(body)),
            default=span[0],
        )
        found = self._met_near(self.beside[1], self.beside[2], span[0])
        if found is None or last <= found[1]:
            return f" and was not tracked at the end ({end})"
        return f" but no longer when last tracked ({self.clock.at(last)})"

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
        segment, other, thing, last = self.beside
        hand = self.clock.called(arrangements.hand_of(segment))
        touched, did = self._touched(other, thing)
        return f"{touched} from before the {hand} {did} until {self._when_of(int(last))}"

    def _takes(self) -> str:
        """Since when another one touches the object of a segment, that is let go of there."""
        segment, other, thing, first = self.beside
        hand, span = arrangements.hand_of(segment), self.clock.span(segment)
        left = self._met_near(hand, thing, span[0]) if span else None
        if left is None:
            return UNBOUND
        touched, did = self._touched(other, thing)
        ended = f"when the {self.clock.called(hand)} no longer {did}"
        since = self.clock.at(int(first))
        return (
            f"{touched} from {since} on, and still {did} {ended} (after {self.clock.at(left[1])})"
        )

    def _touched(self, one: str, other: str) -> tuple[str, str]:
        """How contact of two is told, and the verb that stands for it again."""
        called = self.clock.called(other)
        if self.clock.measured.near(one, other):
            reach = self.clock.measured.reaches[one, other].told_mm
            return f"was within {reach} mm of the {called}", "was"
        return f"touched the {called}", "did"

    def _unborne(self) -> str:
        """Why nothing bears the third argument at the side that this one names."""
        frame = arrangements.frame_of(self.clock, self.beside[0], self.text)
        thing, most = self.beside[2], arrangements.steepest_deg()
        if frame is None or self.clock.objects.get(self.beside[0]) != thing:
            return UNBOUND
        found = arrangements.met_at(self.clock, self.beside[0], self.text)
        if not found:
            return f"the {self.clock.called(thing)} touched {self._nothing()} at the {self.text}"
        told = []
        for other in found:
            angle = arrangements.normal_deg(self.clock, thing, other, frame)
            if angle is None or angle <= most:
                return UNBOUND
            side = "from above" if angle >= 180.0 - most else "from the side"
            called = self.clock.called(other)
            told.append(f"the {called} was met {side}, {angle:.0f}° off straight up")
        return (
            f"nothing bore the {self.clock.called(thing)} at the {self.text}: {', '.join(told)} "
            f"({most:.0f}° or less bears)"
        )

    def _hollow(self) -> str:
        """What is known of the shapes of what the segment's object touches at both borders."""
        found = arrangements.kept(self.clock, self.text)
        unknown = any(body in self.clock.measured.shapeless for body in found)
        return "whose shape is not known" if unknown else "which has a hollow"

    def _met(self) -> str:
        """What the segment's object touches at the side of the segment that stands second."""
        found = arrangements.met_at(self.clock, self.text, self.beside[1])
        return " and ".join(f"the {self.clock.called(each)}" for each in found) or UNBOUND
