"""What is measured for each clause of a summary, by the predicate and the format that it tells."""

from collections.abc import Mapping
from enum import StrEnum

from capar_rules.explain.contact_pairs import NAMES, NEAR


class Measure(StrEnum):
    """A quantity that is known of bodies at every frame."""

    DISTANCE = "distance"
    """How far two bodies are apart, as their contact is told."""

    WAY = "way"
    """How far a body is from where it was at the first frame."""

    SPREAD = "spread"
    """How far it is from the middle of where it was between the two frames."""

    HEIGHT = "height"
    """How much higher its middle is than at the first frame."""

    ASIDE = "aside"
    """How far to the side it is from there."""

    LEAN = "lean"
    """The angle of its upright axis from the vertical."""

    TURN = "turn"
    """By how much it has turned about the vertical since the first frame."""

    TURNED = "turned"
    """By what angle it is turned from its mean orientation between the two frames."""

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

    BEARING = "bearing"
    """At which level angle a body has gone since the first frame to the line to it from another."""

    ABOVE = "above"
    """How much higher a body's middle is than another's top, and how far aside of it."""

    INSIDE = "inside"
    """Which share of a body is inside another one."""

    BORNE = "borne"
    """How far from straight up another body pushes it where they touch."""

    OPENING = "opening"
    """How far it is open on its hinge or rail."""


FORMS: Mapping[str, tuple[Measure, ...]] = {
    "way": (Measure.WAY,),
    "little": (Measure.SPREAD,),
    "place": (Measure.WAY,),
    "not_near": (Measure.WAY,),
    "not_slid": (Measure.WAY,),
    "away": (Measure.WAY, Measure.SPEED),
    "back": (Measure.WAY, Measure.SPEED),
    "spread": (Measure.SPREAD,),
    "still": (Measure.SPREAD, Measure.TURNED),
    **dict.fromkeys(("course", "steep_course", "level_course"), (Measure.HEIGHT, Measure.ASIDE)),
    "slope": (Measure.HEIGHT, Measure.ASIDE),
    "not_up": (Measure.HEIGHT, Measure.ASIDE),
    "not_down": (Measure.HEIGHT, Measure.ASIDE),
    "not_aside": (Measure.HEIGHT, Measure.ASIDE),
    "lean": (Measure.LEAN,),
    "lean_change": (Measure.LEAN,),
    "far_over": (Measure.LEAN,),
    "not_leant": (Measure.LEAN,),
    "turned": (Measure.TURNED,),
    "turn": (Measure.TURN,),
    "not_turned": (Measure.TURN,),
    "turns_back": (Measure.TO_AND_FRO,),
    "turned_in_all": (Measure.TURN_IN_ALL, Measure.PATH),
}
"""By the format in which a clause tells a number of a body: what that number was measured of."""

THING, END, KEPT, LEFT, MET = "thing", "end", "kept", "left", "met"
"""Of the segment that stands first: what it is about, its end-effector; what that thing touches at
both borders, at the start alone, and at the side that stands second."""

Bodies = tuple[int | str, ...]
"""Which bodies of an atom: places of its arguments, or what they are of the segment."""

_APART = (Measure.DISTANCE, (1, 2))
_HELD = (Measure.DISTANCE, (END, THING))

PREDICATES: Mapping[str, tuple[tuple[Measure, Bodies], ...]] = {
    **dict.fromkeys((*NAMES.values(), *NEAR, *NEAR.values()), (_APART,)),
    **dict.fromkeys(("contact_at", "touched_before", "near_before"), (_APART,)),
    **dict.fromkeys(("takes", "lets_go"), (_APART, _HELD)),
    **dict.fromkeys(("no_contact", "uncounted"), ((Measure.DISTANCE, (2, 3)),)),
    "pours": ((Measure.LEAN, (THING,)), (Measure.ABOVE, (THING, 1))),
    "newly_met": ((Measure.DISTANCE, (THING, 1)),),
    "support": ((Measure.DISTANCE, (THING, 1)), _HELD),
    "strikes_with": ((Measure.CLOSING, (THING, 1)),),
    "met_gently": ((Measure.CLOSING, (END, 1)),),
    "met_hard": ((Measure.CLOSING, (END, 1)),),
    **dict.fromkeys(("rests", "rests_afterwards"), ((Measure.SPEED, (0,)),)),
    "event": ((Measure.SPEED, (0,)),),
    "member": ((Measure.SPEED, (0,)),),
    "at_rest": ((Measure.SPEED, (END,)),),
    **dict.fromkeys(("turns_back_fast", "strokes"), ((Measure.TO_AND_FRO, (THING,)),)),
    "goes_ahead": ((Measure.BEARING, (END, THING)),),
    "comes_to_lie": ((Measure.HEIGHT, (THING,)), _HELD),
    "from_rest": ((Measure.DISTANCE, (THING, LEFT)), _HELD),
    "free": ((Measure.DISTANCE, (THING, MET)),),
    "on": ((Measure.BORNE, (2, 3)), (Measure.DISTANCE, (2, 3))),
    "against": ((Measure.BORNE, (2, 3)), (Measure.DISTANCE, (2, 3))),
    "under_palm": ((Measure.BORNE, (END, THING)),),
    **dict.fromkeys(("opens", "closes", "swept"), ((Measure.OPENING, (1,)),)),
}
"""By the predicate of an atom: what was measured for its clause, also where that has no number, and
of which bodies."""

ARRANGED: Mapping[str, tuple[Measure, ...]] = {
    "above": (Measure.ABOVE,),
    "inside": (Measure.INSIDE,),
    "dips": (Measure.INSIDE,),
}
"""What is measured of how a body lies to another one, by how it does."""

ANY = "*"
"""Stands for each body there is."""

ROWS: Mapping[str, tuple[tuple[str, Bodies], ...]] = {
    **dict.fromkeys(("ceases_to_touch", "ceases_to_be_near"), (("touching", (1, ANY)),)),
    "touches_no_object": (("touching", (END, ANY)),),
    "met_unseen": (("lost", (END,)),),
    "rests": (("resting", (0,)), ("touching", (0, ANY))),
    "rests_afterwards": (("resting", (0,)),),
    "accompanied": (("touching", (END, ANY)),),
    "free": (("touching", (THING, ANY)),),
    "comes_to_lie": (("touching", (THING, ANY)), ("moving", (THING,))),
    "moved_before": (("moving", (1,)), ("touching", (END, 1))),
    "from_rest": (("touching", (THING, ANY)), ("moving", (THING,))),
    "on": (("touching", (2, ANY)),),
    "sliding": (("touching", (THING, ANY)),),
    "hands_over": (("touching", (ANY, THING)),),
    "from_another": (("touching", (ANY, THING)),),
    "to_another": (("touching", (ANY, THING)),),
    "gazed": (("looking_at", (ANY, 1)),),
    "bears_in": (("bears", (END,)),),
    "kind": (("link", (END,)),),
    "throws": (("flies", (THING,)),),
    "catches": (("flies", (THING,)),),
    "stirring": (("touching", (THING, KEPT)), ("thing", (KEPT,))),
    "rolls_on": (("rolls", (THING,)), ("touching", (THING, 1))),
}
"""By the predicate of an atom: which facts, of which bodies, are shown as bars."""

COUNTED = ("turns_back_fast", "strokes")
"""Predicates of atoms that count at which halts of the hand a thing turned back."""

OVERLAPPING = ("rolls", "lengthwise")
"""Courses of a body that are shown as bars."""
