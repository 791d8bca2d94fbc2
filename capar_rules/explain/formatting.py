"""The arguments of atoms as sentences have them: names, times and distances."""

import math
from collections.abc import Callable, Mapping, Sequence

from capar_rules.borders.times import constants, in_frames, times
from capar_rules.explain import arrangements, quantities
from capar_rules.explain.arrangements import AFTER_DEG, AHEAD_DEG
from capar_rules.explain.clock import Clock
from capar_rules.explain.quantities import LEAST_M, Shortfall, Way

DRIFT_M = 0.005
"""Of a body that stays, shorter distances are left out of sentences [m]."""

OF_SEGMENTS = ("segment", "motion", "distance", "ended", "drift")
"""Formats of a segment, or of a side of it, that tell of the body that stands first."""

SHIFTS = {"course": quantities.course, "place": quantities.place, "slope": quantities.slope}
"""Formats of a displacement."""

SHORT_WAYS: Mapping[str, Callable[[int, int, int], Shortfall]] = {
    "not_up": quantities.not_up,
    "not_down": quantities.not_down,
    "not_aside": quantities.not_aside,
    "not_near": quantities.not_near,
    "not_slid": quantities.not_slid,
}
"""Formats of how a displacement falls short of what a condition asks for."""

BEARINGS = ("ahead", "after", "not_ahead", "not_after")
"""Formats of a segment that tell at which angle its thing goes to the end-effector."""

OF_ACTS = ("not_ahead", "not_after", "not_laid")
"""Formats of a segment that tell what it falls short of."""

SHORTFALLS = (*SHORT_WAYS, "not_turned", "not_leant", *OF_ACTS)
"""... and of how an angle does."""

OF_BODIES = (
    "way",
    *SHIFTS,
    *(form for form in SHORTFALLS if form not in OF_ACTS),
    "spread",
    "lean",
    "far_over",
    "turn",
    "none",
    "little",
    "still",
    "turns_back",
    "turned_in_all",
)
"""Formats of a body, that tell of the segment beside it, or else of the one that is explained."""

UNBOUND = "\0"
"""Stands for what is not known; no sentence may contain it."""


class Argument:
    """An argument, formatted as a name, a time or a distance."""

    def __init__(self, text: str, beside: Sequence[str], clock: Clock) -> None:
        self.text, self.beside, self.clock = text, beside, clock

    def __format__(self, form: str) -> str:
        if form == "frame":
            return self.clock.at(int(self.text))
        if form == "milli":
            return f"{int(self.text) / 1000.0:.2f}"
        if form == "tick":
            return self.clock.at(self.clock.frames[self.beside[0]][int(self.text)])
        if form in ("pairs", "things"):
            return self._features(form)
        if form in OF_BODIES:
            return self._of_body(form)
        told = self._of_segment(form)
        return self.clock.called(self.text) if told is None else told

    def _of_segment(self, form: str) -> str | None:
        """The text for the segment that this argument, or else the first one, names."""
        if form in ("start", "end"):
            return self.clock.border(self.text, form)
        if form == "border":
            return self.clock.border(self.beside[0], self.text)
        if form == "object":
            return self.clock.about(self.text)
        of_itself = {
            "listed": self._listed,
            "placed": self._placed,
            "reach": self._reach,
            "hand": lambda: self.clock.called(self._hand),
            "as_foot": self._as_foot,
            "floor": self._floor,
            "not_shaken": self._not_shaken,
            "blow": lambda: f"{constants()['blow_mm_s']} mm/s",
            "met": self._met,
            "from_rest": self._from_rest,
            "away": self._away,
            "back": self._back,
            "keeper": self._keeper,
            "laid": lambda: arrangements.laid(self.clock, self.text) or UNBOUND,
            "kept": self._kept,
            "over": self._over,
            "share": self._share,
            "borne": self._borne,
            "unborne": self._unborne,
            "palm": self._palm,
            "poised": self._poised,
            "struck": self._struck,
            "until": lambda: self._contact("start", 1),
            "since": lambda: self._contact("end", 0),
            "on": self._on,
            "ended_at": self._ended_at,
            "placed_end": self._placed_end,
            "not_laid": lambda: arrangements.not_laid(self.clock, self.text) or UNBOUND,
            "least_height": lambda: quantities.length(constants()["height_mm"] / 1000.0),
            "hollow": self._hollow,
            "not_at_rest": self._not_at_rest,
            "rest_s": self._rest_s,
            "long": self._long,
            "when": self._when,
        }
        if form in BEARINGS:
            return self._bearing(form)
        if form in of_itself:
            return of_itself[form]()
        return self._of_span(form) if form in OF_SEGMENTS else None

    @property
    def _hand(self) -> str:
        return self.text.removeprefix("seg(").split(",")[0]

    def _listed(self) -> str:
        """The segment's end-effector and its objects."""
        things = [self.clock.called(each) for each in self.clock.listed.get(self.text, ())]
        told = [f"the {each}" for each in (self.clock.called(self._hand), *things)]
        return f"{', '.join(told[:-1])}{' and ' * (len(told) > 1)}{told[-1]}"

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

    def _as_foot(self) -> str:
        """That an end-effector counts as the foot that it is a part of."""
        called = self.clock.called(self._hand)
        return f"the {called} counts as the foot" if " of the " in called else UNBOUND

    def _floor(self) -> str:
        """From where on a body's motion counts, if it is known."""
        floor_m = self.clock.measured.floors.get(self.text)
        return f" (more than {quantities.length(floor_m)} from where it rests)" if floor_m else ""

    def _not_shaken(self) -> str:
        """How often the segment's object turned back, and how often what is shaken does."""
        span = self.clock.span(self.text)
        if span is None:
            return UNBOUND
        count = self.clock.strokes.get(self.text, 0)
        lasted = (span[1] - span[0]) / self.clock.rate_hz
        stroke = quantities.length(constants()["stroke_mm"] / 1000.0)
        return (
            f"turned back {quantities.often(count)} at halts of the hand {stroke} or more "
            f"apart, in {lasted:.2f} s, and what is shaken does so {constants()['fast_strokes']} "
            "times in 10 s or more"
        )

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
        return f"at {speeds[min(near)[1]]} mm/s ({blow})"

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

    def _met_near(self, one: str, other: str, frame: int) -> tuple[int, int] | None:
        merge = in_frames(times().merge_ms, self.clock.rate_hz)
        return self.clock.measured.contact(one, other, frame, merge)

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
        ended = Argument(self.beside[5], self.beside, self.clock)._ended_at()
        told = self.clock.at(self.clock.frames[self.beside[0]][int(self.text)])
        return "" if told == ended else f"; the border is at {told}"

    def _palm(self) -> str:
        """From which side the segment's object pushes the end-effector that lies on it."""
        span, thing = self.clock.span(self.text), self.clock.objects.get(self.text, "")
        angle = arrangements.normal_deg(self.clock, self._hand, thing, span[0]) if span else None
        if angle is None:
            return UNBOUND
        most = arrangements.steepest_deg()
        return f" (which pushed it {angle:.0f}° off straight up; {most:.0f}° or less bears)"

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

    def _nothing(self) -> str:
        """That none of what is tracked was touched."""
        if self.clock.measured.tracked:
            return "none of the tracked objects"
        return "no tracked object (the recording has none)"

    def _not_at_rest(self) -> str:
        """Why the segment is no rest: it lasted too briefly, or its end-effector moved."""
        span = self.clock.span(self.text)
        lasted = (span[1] - span[0]) / self.clock.rate_hz if span else float("inf")
        if 1000.0 * lasted < constants()["rest_ms"]:
            return f"it lasted {lasted:.2f} s, and a rest lasts {self._rest_s()} or more"
        hand = self.clock.called(self._hand)
        return f"the {hand} did not keep still for as long as a rest lasts ({self._rest_s()})"

    def _met(self) -> str:
        """What the segment's object touches at the side of the segment that stands second."""
        found = arrangements.met_at(self.clock, self.text, self.beside[1])
        return " and ".join(f"the {self.clock.called(each)}" for each in found) or UNBOUND

    def _long(self) -> str:
        """That a rest is longer than a rest has to be."""
        span, least = self._span_beside("long"), constants()["rest_ms"]
        long = span is not None and span[1] - span[0] > in_frames(least, self.clock.rate_hz)
        return f", longer than the {self._rest_s()} of a rest" * long

    def _when(self) -> str:
        """A time, and whether it lies before or after the segment that is explained."""
        frame = int(self.text)
        span, at = self.clock.span(self.clock.own), self.clock.at(frame)
        if span is not None and frame < span[0]:
            return f"before this, at {at}"
        return f"after this, at {at}" if span is not None and frame > span[1] else f"at {at}"

    def _from_rest(self) -> str:
        """What the segment's object left in it, if it touched anything."""
        left = [f"the {self.clock.called(one)}" for one in arrangements.left(self.clock, self.text)]
        return f"left {' and '.join(left)}" if left else "started from rest"

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
        if found is None or found[0] < near:
            return UNBOUND
        far = quantities.length(found[0])
        return f"ended {far} from {self._posture(found[1], near)}"

    def _back(self) -> str:
        """How near to where it had rested the end-effector came back."""
        found, near = self._nearest_posture(), constants()["aside_mm"] / 1000.0
        if found is None or found[0] >= near:
            return UNBOUND
        told = "less than 1 cm" if found[0] < LEAST_M else quantities.length(found[0])
        return f"ended {told} from {self._posture(found[1], near)}"

    def _posture(self, frame: int, near_m: float) -> str:
        """A place where the end-effector had been, touching nothing."""
        how = "was" if frame == self.clock.frames[self._hand][0] else "rested"
        return (
            f"where it {how} at {self.clock.at(frame)} (of its earlier places of rest the nearest; "
            f"within {quantities.length(near_m)} it is back there)"
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

    def _rest_s(self) -> str:
        return f"{constants()['rest_ms'] / 1000.0:.2f} s"

    def _features(self, form: str) -> str:
        """The bodies for which a string of features has a one."""
        segment = self.beside[0]
        count = len(self.text) if form == "things" else (len(self.text) + 1) // 2
        listed = list(self.clock.listed.get(segment, ()))
        known = listed[:1] if len(listed) != count else listed
        names = [self.clock.called(each) for each in known]
        names += ["something else"] * (count - len(names))
        told = names
        if form == "pairs":
            hand = self.clock.called(segment.removeprefix("seg(").split(",")[0])
            told = [f"{hand} with {each}" for each in names]
            told += [f"{names[0]} with {each}" for each in names[1:]]
        found = [each for each, bit in zip(told, self.text, strict=False) if bit == "1"]
        return ", ".join(found) or "none"

    def _of_span(self, form: str) -> str:
        span = self.clock.span(self.text)
        if span is None:
            return "its start and its end" * (form in ("segment", "motion"))
        if form in ("motion", "distance", "ended"):
            span = self.clock.displacement(self.beside[0], span)
        if form in ("segment", "motion"):
            return f"{self.clock.at(span[0])} and {self.clock.at(span[1])}"
        moved = self._moved(self.beside[0], span)
        return "" if moved is None else _told(form, moved)

    def _moved(self, body: str, span: tuple[int, int]) -> Way | None:
        ways = self.clock.measured.ways
        return None if ways is None else ways(body, *span)

    def _of_body(self, form: str) -> str:
        """What was measured of the body that this argument, or the segment in it, names."""
        if form == "none":
            return self._nothing()
        body, span = self.body, self._span_beside(form)
        if span is None:
            return ""
        if form in SHORTFALLS:
            return self._shortfall(form, body, span).text or UNBOUND
        if form in (*SHIFTS, "lean", "turn"):
            return self._between(form, body, span)
        turning = {
            "far_over": self._far_over,
            "turns_back": self._turns_back,
            "turned_in_all": self._turned_in_all,
        }
        return turning[form](body, span) if form in turning else self._motion(form, body, span)

    def _motion(self, form: str, body: str, span: tuple[int, int]) -> str:
        """How far a body moved, or within what it stayed."""
        moving = self.clock.displacement(body, span)
        moved = self._moved(body, moving if form == "way" else span)
        if moved is None:
            return UNBOUND if form == "spread" else ""
        if form != "way":
            return _brief(form, moved)
        late = span[1] - moving[1] > in_frames(times().merge_ms, self.clock.rate_hz)
        return quantities.way(moved, f" until {self.clock.at(moving[1])}" * late)

    def _span_beside(self, form: str) -> tuple[int, int] | None:
        """The span of the segment, or, of a rest, of the two ticks, beside this argument."""
        if form in ("still", "long"):
            first, last = (int(each) for each in self.beside[1:3])
            frames = self.clock.frames[self.beside[0]]
            return frames[first], frames[last]
        terms = [*self.beside, self.clock.own]
        return next((found for each in terms if (found := self.clock.span(each))), None)

    @property
    def body(self) -> str:
        """The body that this argument names; of a segment, its end-effector."""
        return self._hand if self.text.startswith("seg(") else self.text

    def measured_between(self, form: str) -> tuple[int, int] | None:
        """The frames between which what such a format tells of a body was measured."""
        span = self._span_beside(form)
        if form in ("away", "back"):
            nearest = self._nearest_posture()
            return (nearest[1], span[1]) if nearest and span else None
        return self.clock.displacement(self.body, span) if span and form == "way" else span

    def nearness(self, form: str) -> float:
        """How near the body came to what such a format says that it falls short of."""
        if form == "not_laid":
            return arrangements.nearly_laid(self.clock, self.text)
        if form in BEARINGS:
            found = arrangements.bearing(self.clock, self.text)
            if found is None:
                return 0.0
            if form == "not_after":
                return found.offset_deg / AFTER_DEG
            return AHEAD_DEG / max(found.ahead_deg, AHEAD_DEG)
        span = self._span_beside(form)
        return 0.0 if span is None else self._shortfall(form, self.body, span).nearness

    def _shortfall(self, form: str, body: str, span: tuple[int, int]) -> Shortfall:
        known = self.clock.measured
        if form in ("not_turned", "not_leant"):
            first, last = (known.postures.get((body, frame)) for frame in span)
            if first is None or last is None:
                return quantities.NOTHING
            if form == "not_turned":
                return quantities.not_turned(last[1] - first[1])
            most = round(1000.0 * known.leans(body, *span)) if known.leans else 0
            return quantities.not_leant(first[0], last[0], most, self._posture_of(body))
        start, end = (known.places.get((body, frame)) for frame in span)
        if start is None or end is None:
            return quantities.NOTHING
        x, y, z = (after - before for before, after in zip(start, end, strict=True))
        return SHORT_WAYS[form](x, y, z)

    def _between(self, form: str, body: str, span: tuple[int, int]) -> str:
        """How place or posture at the end differ from those at the start."""
        known = self.clock.measured
        if form in SHIFTS:
            start, end = (known.places.get((body, frame)) for frame in span)
            if start is None or end is None:
                return "elsewhere"
            shift = [after - before for before, after in zip(start, end, strict=True)]
            told = SHIFTS[form](*shift)
            return told + self._extremes(body, span, shift[2]) * (form == "course")
        first, last = (known.postures.get((body, frame)) for frame in span)
        if first is None or last is None:
            return "by an unknown angle"
        least = f" ({quantities.degrees(constants()['turn_mrad'])} or more count)"
        if form == "turn":
            return f"{quantities.degrees(last[1] - first[1])} about the vertical{least}"
        change = f", a change of {quantities.change(first[0], last[0])}"
        return f"{_leant(first[0], last[0])} from {self._posture_of(body)}{change}{least}"

    def _extremes(self, body: str, span: tuple[int, int], end_mm: int) -> str:
        """How high or low a body was in between, where that is much beyond its start and end."""
        if self.clock.measured.heights is None:
            return ""
        low, high = (1000.0 * each for each in self.clock.measured.heights(body, *span))
        found = []
        if high - max(end_mm, 0) >= constants()["height_mm"]:
            found.append(f"up to {quantities.spread(high / 1000.0)} higher")
        if min(end_mm, 0) - low >= constants()["height_mm"]:
            found.append(f"down to {quantities.spread(-low / 1000.0)} lower")
        return f" ({' and '.join(found)} in between)" if found else ""

    def _far_over(self, body: str, span: tuple[int, int]) -> str:
        """How far a body leant, and from where on that is far over."""
        known = self.clock.measured
        first, last = (known.postures.get((body, frame)) for frame in span)
        if first is None or last is None or known.leans is None:
            return "far over"
        most = quantities.upward(math.degrees(known.leans(body, *span)))
        least = quantities.degrees(round(1000.0 * known.far_over_rad))
        told = f"{_leant(first[0], last[0])} from {self._posture_of(body)}"
        return f"{told} ({most:.0f}° at most; far over is {least} or more)"

    def _posture_of(self, body: str) -> str:
        """The posture from which a body's lean is measured."""
        return self.clock.measured.upright(body)

    def _turns_back(self, body: str, span: tuple[int, int]) -> str:
        """How often it turned back within the span, and in the motion of which that is a part."""
        turns = self.clock.measured.turns
        if turns is None:
            return ""
        within = turns(body, *span)
        whole = [
            (turns(body, *motion), motion)
            for motion in self.clock.measured.swings.get(body, ())
            if motion[0] < span[1]
            and motion[1] > span[0]
            and not span[0] <= motion[0] <= motion[1] <= span[1]
        ]
        parts = "".join(
            f", of {motion.count} between {self.clock.at(first)} and {self.clock.at(last)}"
            for motion, (first, last) in whole[:1]
            if motion.count > within.count
        )
        return f" (it {within}{parts})"

    def _turned_in_all(self, body: str, span: tuple[int, int]) -> str:
        """By what angle it turned, and how far a wrist takes what turns so far."""
        start, end = (self.clock.measured.travelled.get((body, frame)) for frame in span)
        if start is None or end is None:
            return UNBOUND
        angle = end[1] - start[1]
        way = quantities.length(angle * constants()["wrist_mm"] / 1e6)
        return (
            f"turned by {quantities.degrees(angle)} in all (half a turn, "
            f"{quantities.degrees(constants()['half_turn_mrad'])}, is asked for) on a path of "
            f"{quantities.length((end[0] - start[0]) / 1000.0)} (turned so far about the wrist it "
            f"would go up to {way})"
        )


def _leant(first_mrad: int, last_mrad: int) -> str:
    first, last = quantities.degrees(first_mrad), quantities.degrees(last_mrad)
    return f"{first} at the start and {last} at the end"


def _brief(form: str, moved: Way) -> str:
    if form == "little":
        within = f" (within {quantities.spread(moved.spread_m)} of its median place)"
        return within if moved.spread_m >= DRIFT_M else ""
    return quantities.spread(moved.spread_m)


def _told(form: str, moved: Way) -> str:
    if form == "drift":
        little = f", but for {1e3 * moved.straight_m:.0f} mm, too little to count as motion,"
        return little if moved.straight_m >= DRIFT_M else ""
    if moved.winding:
        if form == "distance":
            return f" along {moved.path_m:.2f} m of path"
        return f", and ended {moved.straight_m:.2f} m from where it began"
    far = form == "distance" and moved.straight_m >= LEAST_M
    return f" {moved.straight_m:.2f} m" if far else ""
