"""How arguments tell arrangements: what bears or holds what, and which way a thing goes."""

from capar_rules.borders.ticks import constants
from capar_rules.explain import arrangements, quantities
from capar_rules.explain.arrangements import AFTER_DEG, AHEAD_DEG
from capar_rules.explain.told_argument import UNBOUND, ToldArgument

LEAST_ASIDE_M = 0.001
"""A shorter way aside is told as less than that [m]."""


class ArrangementsTold(ToldArgument):
    """How bodies lie to each other, and direction they go."""

    def _bearing(self, form: str) -> str:
        """At which level angle to the line from the end-effector to its middle the thing went."""
        little = arrangements.little_way(self.clock, self.text)
        if little is not None:
            least = quantities.length(constants()["slide_mm"] / 1000.0)
            aside = f"only {quantities.length(little)}"
            aside = aside if little >= LEAST_ASIDE_M else "less than 1 mm"
            told = f", on the whole, {aside} to the side"
            return f"{told}, less than the {least} from which on a direction counts"
        found = arrangements.bearing(self.clock, self.text)
        if found is None:
            return UNBOUND
        hand, thing = self.clock.called(self._hand), self.clock.about(self.text)
        line = f"to the level line from the {hand} to the middle of the {thing} at the start"
        ahead, after = f"{AHEAD_DEG:.0f}° or less is ahead", f"{AFTER_DEG:.0f}° or more is after"
        if form.startswith("not_"):
            direction = f", on the whole, neither after the {hand} nor ahead of it, but"
            if found.offset_deg >= AFTER_DEG:
                direction = f", on the whole, after the {hand}, and not ahead of it,"
            if found.offset_deg <= AHEAD_DEG:
                direction = f", on the whole, ahead of the {hand}, and not after it,"
            angle = f"{found.offset_deg:.0f}°"
            return f"{direction} at {angle} {line} ({after}, {ahead})"
        if form == "ahead" and found.by_press:
            line = f"to the direction in which the {hand} pressed it"
            return f" (at {found.press_deg:.0f}° {line}; {ahead})"
        asked = ahead if form == "ahead" else after
        return f" (at {found.offset_deg:.0f}° {line}; {asked})"

    def _stirred(self) -> str:
        """What the segment's object touches at the start and at the end, and can be moved."""
        movable = self.clock.measured.movable
        found = [one for one in arrangements.kept(self.clock, self.text) if one in movable]
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
        at = f", at {self.clock.at(met[0])}" if met else ""
        return (
            f" ({angle:.0f}° off straight up as their contact began{at}, which counts while it "
            f"lasts; {most:.0f}° or less bears)"
        )

    def _palm(self) -> str:
        """From which side the segment's object pushes the end-effector that lies on it."""
        span, thing = self.clock.span(self.text), self.clock.objects.get(self.text, "")
        angle = arrangements.normal_deg(self.clock, self._hand, thing, span[0]) if span else None
        if angle is None:
            return UNBOUND
        most = arrangements.steepest_deg()
        return f" ({angle:.0f}° off straight up; {most:.0f}° or less bears)"

    def _unborne(self) -> str:
        """Why nothing bears the third argument at the side that this one names."""
        frame = arrangements.frame_of(self.clock, self.beside[0], self.text)
        thing, most = self.beside[2], arrangements.steepest_deg()
        if frame is None or self.clock.objects.get(self.beside[0]) != thing:
            return UNBOUND
        found = arrangements.met_at(self.clock, self.beside[0], self.text)
        if not found:
            return f"the {self.clock.called(thing)} touched {self._nothing()} at the {self.text}"
        told, hand = [], arrangements.hand_of(self.beside[0])
        for other in found:
            angle = arrangements.normal_deg(self.clock, thing, other, frame)
            if angle is None or angle <= most:
                return UNBOUND
            called = self.clock.called(other)
            told.append(f"the {called} met it {angle:.0f}° off straight up")
        return (
            f"apart from the {self.clock.called(hand)}, nothing was found to bear the "
            f"{self.clock.called(thing)} from below at the {self.text}: "
            f"{' and '.join(told)} (what bears meets it within {most:.0f}° of straight up)"
        )

    def _hollow(self) -> str:
        """What is known of the shapes of what the segment's object touches at both borders."""
        found = arrangements.kept(self.clock, self.text)
        unknown = any(body in self.clock.measured.shapeless for body in found)
        return "of unknown shape" if unknown else "with a hollow"

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
            return f"within {reach.told_mm:g} mm of"
        return "in contact with"

    def _met(self) -> str:
        """What the segment's object touches at the side of the segment that stands second."""
        found = arrangements.met_at(self.clock, self.text, self.beside[1])
        return " and ".join(f"the {self.clock.called(each)}" for each in found) or UNBOUND

    def _touched(self) -> str:
        """That the segment's object touches, or counts as touching, something at that side."""
        thing = self.clock.objects.get(self.text, "")
        found = arrangements.met_at(self.clock, self.text, self.beside[1])
        near = any(self.clock.measured.near(thing, other) for other in found)
        return "counted as in contact with" if near else "touched"

    def _moved_in_hand(self) -> str:
        """That what a segment moves had moved before in the same hold, so that it began nowhere."""
        span, hand = self.clock.span(self.text), self._hand
        thing = self.clock.objects.get(self.text, "")
        held = self._met_near(hand, thing, span[0]) if span else None
        moves = self.clock.measured.moving.get(thing, ())
        if span and held and any(first < span[0] and last > held[0] for first, last in moves):
            since, contact = (
                self.clock.at(held[0]),
                f"the contact with the {self.clock.called(hand)}",
            )
            if held[0] >= span[0]:
                return f" and had moved before {contact} began, at {since}"
            return f" and had moved before in {contact} that began at {since}"
        return ", so that it was lifted off none"

    def _unslid(self) -> str:
        """That the segment's object stayed on nothing, where it touches nothing at both borders."""
        kept = arrangements.kept(self.clock, self.text)
        return UNBOUND if kept else "was not slid on anything"
