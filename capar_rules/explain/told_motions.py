"""How arguments tell motions: how far, along what path, how high, how much turned and leant."""

import math
from collections.abc import Callable, Mapping

from capar_rules.borders.ticks import constants, in_frames, times
from capar_rules.explain import arrangements, quantities
from capar_rules.explain.quantities import LEAST_M, Shortfall, Way
from capar_rules.explain.told_argument import UNBOUND, ToldArgument

DRIFT_M = 0.005
"""Of a body that stays, shorter distances are left out of sentences [m]."""

LITTLE_M = 0.002
"""Of what stays within less [m] a summary does not say within what."""

COURSES: Mapping[str, Callable[[int, int, int], str]] = {
    "course": quantities.course,
    "steep_course": quantities.steep_course,
    "level_course": quantities.level_course,
}
"""Formats of a displacement by its rise and its way aside."""

SHIFTS: Mapping[str, Callable[[int, int, int], str]] = {
    **COURSES,
    "place": quantities.place,
    "slope": quantities.slope,
}
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


class MotionsTold(ToldArgument):
    """How bodies moved between the borders of a segment."""

    def _of_body(self, form: str) -> str:
        """What was measured of the body that this argument, or the segment in it, names."""
        if form == "none":
            return self._nothing()
        body, span = self.body, self._span_beside(form)
        if span is None:
            return ""
        if form in SHORTFALLS:
            return self._shortfall(form, body, span).text or UNBOUND
        if form in (*SHIFTS, "lean", "lean_change", "turn"):
            return self._between(form, body, span)
        turning = {
            "turned": self._turned,
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
            if form == "still":
                return self._still(body, moved)
            floor_m = self.clock.measured.floors.get(body)
            return _brief(form, moved, floor_m) + self._counts_later(form, body, moved, span)
        late = span[1] - moving[1] > in_frames(times().merge_ms, self.clock.rate_hz)
        floor_m = self.clock.measured.floors.get(body, 0.0)
        told = quantities.way(moved, f" until {self.clock.at(moving[1])}" * late, floor_m)
        return told + self._untouched(body, moving) + self._in_course_of(body, moved, span)

    def _untouched(self, body: str, moving: tuple[int, int]) -> str:
        """That it moved while the end-effector did not touch it, which did before or does after."""
        hand = arrangements.hand_of(self.clock.own)
        touches = self.clock.measured.contacts.get((hand, body), ())
        meanwhile = any(first < moving[1] and last > moving[0] for first, last in touches)
        called = self.clock.called(hand)
        if not touches or meanwhile:
            return ""
        begun = any(first <= moving[0] for first, _ in touches)
        return f" ({'without' if begun else 'before any'} contact with the {called})"

    def _counts_later(self, form: str, body: str, moved: Way, span: tuple[int, int]) -> str:
        """From when on the motion counts of what has begun to move before the segment ends."""
        floor_m = self.clock.measured.floors.get(body)
        if form != "little" or not floor_m or moved.spread_m < floor_m:
            return ""
        later = [first for first, _ in self.clock.measured.moving.get(body, ()) if first >= span[1]]
        return f" (it counted as moving only from {self.clock.at(min(later))} on)" if later else ""

    def _still(self, body: str, moved: Way) -> str:
        """Within what a body rested, and that it did so at more than one place if it is far."""
        floor_m = self.clock.measured.floors.get(body)
        span = self._span_beside("still") or (0, 0)
        turned = self._turned(body, span)
        told = f"{quantities.spread(moved.spread_m)} of one place{turned} meanwhile"
        turns = self.clock.measured.turned
        turn_floor = self.clock.measured.turn_floors.get(body, math.inf)
        turned_far = bool(turned) and turns is not None and turns(body, *span) > turn_floor
        if floor_m is None:
            return told
        angle = f" and {quantities.degrees(round(1000.0 * turn_floor))}" * bool(turned)
        if moved.spread_m <= floor_m and not turned_far:
            return f"{told}, and a rest is within {quantities.length(floor_m)}{angle}"
        place = f"within {quantities.length(floor_m)}{angle} of one place"
        slow = "from its first to its last slow moment"
        return f"{told}; rests {place}, {slow}, and then of another, count as one"

    def _in_course_of(self, body: str, moved: Way, span: tuple[int, int]) -> str:
        """Of which motion a way is part that by itself would be too short to count."""
        floor_m = self.clock.measured.floors.get(body, 0.0)
        known = self.clock.measured
        moves = known.displaced.get(body) or known.moving.get(body, ())
        longer = [
            (first, last)
            for first, last in moves
            if first < span[1] and last > span[0] and (first < span[0] or last > span[1])
        ]
        if moved.path_m >= floor_m or not longer:
            return ""
        first, last = longer[0][0], longer[-1][1]
        return f", as part of a motion from {self.clock.at(first)} to {self.clock.at(last)}"

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
            floor_m = known.floors.get(body, 0.0)
            x, y, z = shift
            told = quantities.place(x, y, z, floor_m) if form == "place" else SHIFTS[form](x, y, z)
            return told + self._extremes(body, span, shift[2]) * (form in COURSES)
        first, last = (known.postures.get((body, frame)) for frame in span)
        if first is None or last is None:
            return "by an unknown angle"
        least = f" ({quantities.degrees(constants()['turn_mrad'])} or more count)"
        if form == "turn":
            return f"{quantities.degrees(last[1] - first[1])} about the vertical{least}"
        changed = quantities.change(first[0], last[0])
        if form == "lean_change":
            return f"by {changed}{least}"
        change = f", a change of {changed}"
        return f"{_leant(first[0], last[0])} from {self._posture_of(body)}{change}{least}"

    def _extremes(self, body: str, span: tuple[int, int], end_mm: int) -> str:
        """How high or low a body was in between, where that is much beyond its start and end."""
        if self.clock.measured.heights is None:
            return ""
        low, high = (1000.0 * each for each in self.clock.measured.heights(body, *span))
        found = []
        if high - max(end_mm, 0) >= constants()["height_mm"]:
            found.append(f"up to {quantities.extreme(high / 1000.0)} higher")
        if min(end_mm, 0) - low >= constants()["height_mm"]:
            found.append(f"down to {quantities.extreme(-low / 1000.0)} lower")
        return f" ({' and '.join(found)} in between)" if found else ""

    def _turned(self, body: str, span: tuple[int, int]) -> str:
        """Within what angle of its mean orientation a body has stayed."""
        turned = self.clock.measured.turned
        if turned is None or body not in self.clock.measured.turn_floors:
            return ""
        return f" and {quantities.angle_bound(turned(body, *span))} of its mean orientation"

    def _far_over(self, body: str, span: tuple[int, int]) -> str:
        """How far a body leant, and from where on that is far over."""
        known = self.clock.measured
        first, last = (known.postures.get((body, frame)) for frame in span)
        if first is None or last is None or known.leans is None:
            return "far over"
        most = quantities.angle_bound(known.leans(body, *span))
        least = quantities.degrees(round(1000.0 * known.far_over_rad))
        told = f"{_leant(first[0], last[0])} from {self._posture_of(body)}"
        return f"{told} ({most} at most; far over is {least} or more)"

    def _posture_of(self, body: str) -> str:
        """The posture from which a body's lean is measured."""
        return self.clock.measured.upright(body)

    def _turns_back(self, body: str, span: tuple[int, int]) -> str:
        """Along which line it was moved to and fro, and from when to when if not in the segment."""
        turns = self.clock.measured.turns
        if turns is None:
            return ""
        swing, counted = self._swing(body, span), self._counted_turns(body, span)
        when = f" from {self.clock.at(swing[0])} to {self.clock.at(swing[1])}"
        return f" {turns(body, *counted).sense}{when * (swing != span)}"

    def _counted_turns(self, body: str, span: tuple[int, int]) -> tuple[int, int]:
        """Between which frames turns are counted: of the segment, or else of all of that motion."""
        swing, turns = self._swing(body, span), self.clock.measured.turns
        return span if turns is not None and turns(body, *span).count else swing

    def _swing(self, body: str, span: tuple[int, int]) -> tuple[int, int]:
        """The motion to and fro of which a segment is a part, or else the segment itself."""
        slack = in_frames(times().merge_ms, self.clock.rate_hz)
        found = [
            (min(last, span[1]) - max(first, span[0]), first, last)
            for first, last in self.clock.measured.swings.get(body, ())
            if first < span[1] and last > span[0]
        ]
        if not found:
            return span
        _, first, last = max(found)
        return (first, last) if first < span[0] - slack or last > span[1] + slack else span

    def _turned_in_all(self, body: str, span: tuple[int, int]) -> str:
        """By what angle it turned, and how far a wrist takes what turns so far."""
        start, end = (self.clock.measured.travelled.get((body, frame)) for frame in span)
        if start is None or end is None:
            return UNBOUND
        angle = end[1] - start[1]
        wrist = constants()["wrist_mm"] / 1000.0
        far = quantities.length(angle * wrist / 1000.0)
        return (
            f"turned by {quantities.degrees(angle)} in all "
            f"({quantities.degrees(constants()['half_turn_mrad'])} or more count) on a path of "
            f"{quantities.length((end[0] - start[0]) / 1000.0)} (up to {far}, "
            f"{quantities.length(wrist)} times that angle, count as turning in the hand)"
        )

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


def _leant(first_mrad: int, last_mrad: int) -> str:
    first, last = quantities.degrees(first_mrad), quantities.degrees(last_mrad)
    return f"{first} at the start and {last} at the end"


def _brief(form: str, moved: Way, floor_m: float | None) -> str:
    if form == "little":
        within = f" (within {quantities.spread(moved.spread_m)} of one place in the segment"
        counts = f"; it counts as moved from {quantities.length(floor_m)} on" if floor_m else ""
        counts *= floor_m is not None and moved.spread_m < floor_m
        return f"{within}{counts})" if moved.spread_m >= LITTLE_M else ""
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
