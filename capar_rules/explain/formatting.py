"""The arguments of atoms as sentences have them: names, times and distances."""

from capar_rules.borders.ticks import constants
from capar_rules.explain import arrangements, quantities
from capar_rules.explain.arrangements import AFTER_DEG, AHEAD_DEG
from capar_rules.explain.told_argument import UNBOUND as UNBOUND
from capar_rules.explain.told_arrangements import ArrangementsTold
from capar_rules.explain.told_contacts import ContactsTold
from capar_rules.explain.told_derivations import DerivationsTold
from capar_rules.explain.told_motions import BEARINGS, OF_ACTS, SHIFTS, SHORTFALLS, MotionsTold
from capar_rules.explain.told_rests import RestsTold

OF_SEGMENTS = ("segment", "motion", "distance", "ended", "drift")
"""Formats of a segment, or of a side of it, that tell of the body that stands first."""

OF_BODIES = (
    "way",
    *SHIFTS,
    *(form for form in SHORTFALLS if form not in OF_ACTS),
    "spread",
    "turned",
    "lean",
    "far_over",
    "turn",
    "none",
    "little",
    "still",
    "turns_back",
    "lean_change",
    "turned_in_all",
)
"""Formats of a body, that tell of the segment beside it, or else of the one that is explained."""


class Argument(ContactsTold, ArrangementsTold, RestsTold, MotionsTold, DerivationsTold):
    """An argument, formatted as a name, a time or a distance."""

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
            "hand": lambda: self.clock.called(self._hand),
            "as_foot": self._as_foot,
            "floor": self._floor,
            "blow": lambda: f"{constants()['blow_mm_s']} mm/s",
            "met": self._met,
            "from_rest": self._from_rest,
            "away": self._away,
            "back": self._back,
            "keeper": self._keeper,
            "laid": lambda: arrangements.laid(self.clock, self.text) or UNBOUND,
            "stirred": self._stirred,
            "over": self._over,
            "share": self._share,
            "borne": self._borne,
            "borne_then": lambda: self._borne().replace(UNBOUND, ""),
            "levels": self._levels,
            "this": self._this,
            "swung_on": self._swung_on,
            "least_slide": lambda: quantities.length(constants()["slide_mm"] / 1000.0),
            "least_aside": lambda: quantities.length(constants()["aside_mm"] / 1000.0),
            "unborne": self._unborne,
            "palm": self._palm,
            "poised": self._poised,
            "struck": self._struck,
            "moved_in_hand": self._moved_in_hand,
            "unslid": self._unslid,
            "throughout": self._throughout,
            "comes": self._comes,
            "no_longer": self._no_longer,
            "unseen": self._unseen,
            "all_along": self._all_along,
            "touched": self._touched,
            "after_leaving": self._after_leaving,
            "lets_go": self._lets_go,
            "takes": self._takes,
            "between": self._apart_between,
            "on": self._on,
            "ended_at": self._ended_at,
            "placed_end": self._placed_end,
            "parted": self._parted,
            "not_laid": lambda: arrangements.not_laid(self.clock, self.text) or UNBOUND,
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

    def _listed(self) -> str:
        """The segment's end-effector and its objects."""
        things = [self.clock.called(each) for each in self.clock.listed.get(self.text, ())]
        told = [f"the {each}" for each in (self.clock.called(self._hand), *things)]
        return f"{', '.join(told[:-1])}{' and ' * (len(told) > 1)}{told[-1]}"

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
        return ", ".join(found) or "nothing"

    def measured_between(self, form: str) -> tuple[int, int] | None:
        """The frames between which what such a format tells of a body was measured."""
        span = self._span_beside(form)
        if form in ("away", "back"):
            nearest = self._nearest_posture()
            return (nearest[1], span[1]) if nearest and span else None
        if form == "turns_back":
            return self._counted_turns(self.body, span) if span else None
        return self.clock.displacement(self.body, span) if span and form == "way" else span

    def nearness(self, form: str) -> float:
        """How near the body came to what such a format says that it falls short of."""
        if form == "not_laid":
            return arrangements.nearly_laid(self.clock, self.text)
        if form in BEARINGS:
            little = arrangements.little_way(self.clock, self.text)
            if little is not None:
                return max(1000.0 * little / constants()["slide_mm"], quantities.FAR_OFF)
            found = arrangements.bearing(self.clock, self.text)
            if found is None:
                return 0.0
            if form == "not_after":
                return found.offset_deg / AFTER_DEG
            return AHEAD_DEG / max(found.ahead_deg, AHEAD_DEG)
        span = self._span_beside(form)
        return 0.0 if span is None else self._shortfall(form, self.body, span).nearness
