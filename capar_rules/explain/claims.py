"""What a summary claims: its clauses, and what was measured of which bodies for each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

from capar_rules.explain.clock import Clock
from capar_rules.explain.contact_pairs import NAMES, NEAR
from capar_rules.explain.formatting import Argument
from capar_rules.explain.sentences import Sentences


class Measure(StrEnum):
    """A quantity that is known of bodies at every frame."""

    DISTANCE = "distance"
    """How far two bodies are apart, as their contact is told."""

    WAY = "way"
    """How far a body is from where it was at the first frame."""

    SPREAD = "spread"
    """How far it is from its median place between the two frames."""

    HEIGHT = "height"
    """How much higher its middle is than at the first frame."""

    ASIDE = "aside"
    """How far to the side it is from there."""

    LEAN = "lean"
    """The angle of its upright axis from the vertical."""

    TURN = "turn"
    """By how much it has turned about the vertical since the first frame."""

    TURN_IN_ALL = "turn_in_all"
    """By how much it has turned about any axis since the first frame."""

    PATH = "path"
    """The length of its path since the first frame."""

    CLOSING = "closing"
    """How fast two bodies come together."""

    SPEED = "speed"
    """How fast a body's origin goes."""

    TO_AND_FRO = "to_and_fro"
    """Where it is along the line on which it goes to and fro."""


FORMS: Mapping[str, tuple[Measure, ...]] = {
    "way": (Measure.WAY,),
    "little": (Measure.SPREAD,),
    "place": (Measure.WAY,),
    "not_near": (Measure.WAY,),
    "not_slid": (Measure.WAY,),
    "away": (Measure.WAY,),
    "back": (Measure.WAY,),
    "spread": (Measure.SPREAD,),
    "still": (Measure.SPREAD,),
    "course": (Measure.HEIGHT, Measure.ASIDE),
    "slope": (Measure.HEIGHT, Measure.ASIDE),
    "not_up": (Measure.HEIGHT, Measure.ASIDE),
    "not_down": (Measure.HEIGHT, Measure.ASIDE),
    "not_aside": (Measure.HEIGHT, Measure.ASIDE),
    "lean": (Measure.LEAN,),
    "far_over": (Measure.LEAN,),
    "not_leant": (Measure.LEAN,),
    "turn": (Measure.TURN,),
    "not_turned": (Measure.TURN,),
    "turns_back": (Measure.TO_AND_FRO,),
    "turned_in_all": (Measure.TURN_IN_ALL, Measure.PATH),
}
"""By the format in which a clause tells a number of a body: what that number was measured of."""

THING, END = "thing", "end"
"""Of the segment that stands first: what it is about, and its end-effector."""

_APART = (Measure.DISTANCE, (1, 2))

PREDICATES: Mapping[str, tuple[Measure, tuple[int | str, ...]]] = {
    **dict.fromkeys((*NAMES.values(), *NEAR, *NEAR.values()), _APART),
    "contact_at": _APART,
    "touched_before": _APART,
    "near_before": _APART,
    "takes": _APART,
    "lets_go": _APART,
    "no_contact": (Measure.DISTANCE, (2, 3)),
    "uncounted": (Measure.DISTANCE, (2, 3)),
    "newly_met": (Measure.DISTANCE, (THING, 1)),
    "met_gently": (Measure.CLOSING, (END, 1)),
    "met_hard": (Measure.CLOSING, (END, 1)),
    "rests": (Measure.SPEED, (0,)),
    "rests_afterwards": (Measure.SPEED, (0,)),
    "at_rest": (Measure.SPEED, (END,)),
    "turns_back_fast": (Measure.TO_AND_FRO, (THING,)),
    "strokes": (Measure.TO_AND_FRO, (THING,)),
    "stirs": (Measure.TO_AND_FRO, (THING,)),
    "cuts": (Measure.TO_AND_FRO, (THING,)),
    "wipes": (Measure.TO_AND_FRO, (THING,)),
    "shakes": (Measure.TO_AND_FRO, (THING,)),
}
"""By the predicate of an atom whose clause need not have a number: what was measured, and of which
of its arguments."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """What was measured of which bodies between which frames."""

    measure: Measure
    bodies: tuple[str, ...]
    first: int
    last: int
    form: str = ""
    """The format in which its number is told; empty where none is."""


@dataclass(frozen=True, slots=True)
class Claim:
    """A clause of a summary."""

    text: str
    quantities: tuple[Quantity, ...]
    """What was measured for it."""

    frames: tuple[int, ...] = ()
    """The frames whose times it tells."""


def claim(
    sentences: Sentences, clock: Clock, told: tuple[str, Sequence[str], str], text: str
) -> Claim:
    """The claim of a clause.

    Args:
        sentences: The templates.
        clock: Times and distances of the segment.
        told: Predicate and arguments of the atom that it tells, and the mood of its template.
        text: The clause.
    """
    predicate, arguments, mood = told
    found: list[Quantity] = []
    frames: list[int] = []
    own = clock.span(clock.own) or (0, 0)
    if predicate in PREDICATES:
        measure, places = PREDICATES[predicate]
        bodies = tuple(_body(place, arguments, clock) for place in places)
        found.append(Quantity(measure, bodies, *own))
    for text_of, form in sentences.formats(predicate, arguments, mood=mood):
        argument = Argument(text_of, arguments, clock)
        span = argument.measured_between(form)
        found += [
            Quantity(measure, (argument.body,), *span, form)
            for measure in FORMS.get(form, ())
            if span is not None
        ]
        if form in ("when", "frame"):
            frames.append(int(text_of))
        if form == "tick":
            frames.append(clock.frames[arguments[0]][int(text_of)])
    return Claim(text, tuple(dict.fromkeys(found)), tuple(frames))


def _body(place: int | str, arguments: Sequence[str], clock: Clock) -> str:
    if place == THING:
        return clock.objects.get(arguments[0], "")
    if isinstance(place, str):
        return arguments[0].removeprefix("seg(").split(",")[0]
    return arguments[place]
