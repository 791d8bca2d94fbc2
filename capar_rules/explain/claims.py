"""What a summary claims: its clauses, and what was measured of which bodies for each."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import product

from capar_rules.explain import arrangements
from capar_rules.explain.clock import Clock
from capar_rules.explain.contact_pairs import NAMES, NEAR
from capar_rules.explain.formatting import Argument
from capar_rules.explain.instants import STRETCHES
from capar_rules.explain.reason import Reason
from capar_rules.explain.sentences import Sentences
from capar_rules.explain.told_argument import UNBOUND


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
    "rests_afterwards": ((Measure.SPEED, (0,)),),
    "event": ((Measure.SPEED, (0,)),),
    "member": ((Measure.SPEED, (0,)),),
    "at_rest": ((Measure.SPEED, (END,)),),
    **dict.fromkeys(("turns_back_fast", "strokes", "stirring"), ((Measure.TO_AND_FRO, (THING,)),)),
    "goes_ahead": ((Measure.BEARING, (END, THING)),),
    "comes_to_lie": ((Measure.HEIGHT, (THING,)), _HELD),
    "from_rest": ((Measure.DISTANCE, (THING, LEFT)),),
    "free": ((Measure.DISTANCE, (THING, MET)),),
    "on": ((Measure.BORNE, (2, 3)),),
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
    "touches_no_object": (("touching", (END, ANY)),),
    "rests": (("resting", (0,)), ("touching", (0, ANY))),
    "rests_afterwards": (("resting", (0,)),),
    "accompanied": (("touching", (END, ANY)),),
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


@dataclass(frozen=True, slots=True)
class Quantity:
    """What was measured of which bodies between which frames."""

    measure: Measure
    bodies: tuple[str, ...]
    first: int
    last: int
    form: str = ""
    """The format in which its number is told; empty where none is."""

    halts: tuple[int, ...] = ()
    """Frames of what is counted, where that is no part of the quantity itself."""


@dataclass(frozen=True, slots=True)
class Stretches:
    """When facts of a kind about certain bodies hold."""

    predicate: str
    bodies: tuple[str, ...]
    """Those that the fact names, in its order; ``ANY`` for all."""


@dataclass(frozen=True, slots=True)
class Claim:
    """A clause of a summary."""

    text: str
    quantities: tuple[Quantity, ...]
    """What was measured for it."""

    frames: tuple[int, ...] = ()
    """The frames whose times it tells."""

    stretches: tuple[Stretches, ...] = ()
    """What held when, of what it says."""

    @property
    def shown(self) -> bool:
        """Whether anything of it can be drawn."""
        return bool(self.quantities or self.stretches)


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
    for measure, places in _measures(predicate, arguments):
        for bodies in _bodies(places, arguments, clock):
            halts = tuple(clock.strokes.get(clock.own, ())) if predicate in COUNTED else ()
            found.append(Quantity(measure, bodies, *own, halts=halts))
    for text_of, form in sentences.formats(predicate, arguments, mood=mood):
        argument = Argument(text_of, arguments, clock)
        span = argument.measured_between(form)
        for measure in FORMS.get(form, ()):
            measured = own if measure is Measure.SPEED else span
            if measured is not None:
                found.append(Quantity(measure, (argument.body,), *measured, form))
        if form == "turns_back" and span is not None:
            frames += span
        if form in ("when", "frame"):
            frames.append(int(text_of))
        if form == "tick":
            frames.append(clock.frames[arguments[0]][int(text_of)])
    if predicate == "support":
        frames += _since(clock, own[0])
    if predicate in ("takes", "lets_go"):
        frames += [int(arguments[3]), *_until(clock, own[0])[: predicate == "takes"]]
    stretches = [
        Stretches(kind, bodies)
        for kind, places in _rows(predicate, arguments)
        for bodies in _bodies(places, arguments, clock)
    ]
    return Claim(text, tuple(dict.fromkeys(found)), tuple(frames), tuple(dict.fromkeys(stretches)))


def _since(clock: Clock, frame: int) -> list[int]:
    """Since when the end-effector of the explained segment touches its object."""
    thing, hand = clock.objects.get(clock.own, ""), arrangements.hand_of(clock.own)
    met = clock.measured.contact(hand, thing, frame, 1)
    return [met[0]] if met else []


def _until(clock: Clock, frame: int) -> list[int]:
    """Until when the end-effector touches its object, of the contact at a frame."""
    thing, hand = clock.objects.get(clock.own, ""), arrangements.hand_of(clock.own)
    met = clock.measured.contact(hand, thing, frame, 1)
    return [met[1]] if met else []


def joined_claims(text: str, claims: Sequence[Claim]) -> Claim:
    """The claim of a clause that says as much as several."""
    quantities = dict.fromkeys(quantity for claim in claims for quantity in claim.quantities)
    stretches = dict.fromkeys(held for claim in claims for held in claim.stretches)
    frames = tuple(frame for each in claims for frame in each.frames)
    return Claim(text, tuple(quantities), frames, tuple(stretches))


def resting_on(found: Claim, reason: Reason) -> Claim:
    """The claim of a clause that tells a node, with what was measured below, if it had nothing."""
    if found.shown:
        return found
    below: dict[Stretches, None] = {}
    for node in reason.walk():
        predicate, _, rest = node.atom.removesuffix(")").partition("(")
        if not node.rule and predicate in STRETCHES:
            bodies = tuple(rest.split(",")[: STRETCHES[predicate]])
            below[Stretches(predicate, bodies)] = None
    return replace(found, stretches=tuple(below))


def _measures(predicate: str, arguments: Sequence[str]) -> tuple[tuple[Measure, Bodies], ...]:
    if predicate == "lies_at":
        return tuple((measure, (3, 4)) for measure in ARRANGED.get(arguments[2], ()))
    if predicate == "overlaps":
        return tuple((measure, (2, 3)) for measure in ARRANGED.get(arguments[1], ()))
    if predicate == "on" and UNBOUND in arguments[3]:
        return ((Measure.BORNE, (2, ANY)),)
    return PREDICATES.get(predicate, ())


def _rows(predicate: str, arguments: Sequence[str]) -> tuple[tuple[str, Bodies], ...]:
    if predicate == "overlaps" and arguments[1] in OVERLAPPING:
        return ((arguments[1], (2,)),)
    if predicate == "lies_at" and arguments[2] not in ARRANGED:
        return ()
    return ROWS.get(predicate, ())


def _bodies(places: Bodies, arguments: Sequence[str], clock: Clock) -> list[tuple[str, ...]]:
    """The bodies at some places, in each combination; none if one is not known."""
    ways = [_at(place, arguments, clock) for place in places]
    return [bodies for bodies in product(*ways) if all(bodies)]


def _at(place: int | str, arguments: Sequence[str], clock: Clock) -> tuple[str, ...]:
    if isinstance(place, int):
        body = arguments[place]
        return () if UNBOUND in body else (body,)
    segment = arguments[0]
    of_segment: Mapping[str, Callable[[], tuple[str, ...]]] = {
        THING: lambda: (clock.objects.get(segment, ""),),
        END: lambda: (arrangements.hand_of(segment),),
        KEPT: lambda: arrangements.kept(clock, segment),
        LEFT: lambda: arrangements.left(clock, segment),
        MET: lambda: arrangements.met_at(clock, segment, arguments[1]),
        ANY: lambda: (ANY,),
    }
    return of_segment[place]()
