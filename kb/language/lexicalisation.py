"""What primitives are said as: patterns of a verb with places for objects."""

from collections.abc import Collection, Iterable, Mapping, Sequence

from kb.lexicon.english import joined, past, words_of
from kb.lexicon.links import PrimitiveWords
from kb.lexicon.tables import table

Cases = Collection[str]
"""What holds of a segment: held, there, tool, on, back, self, alone, turns, tilts, rises, steadies.

``in``: it is inside the second object at the end; ``movable``: that one can be moved, too; ``off``:
it leaves the other at its edge;
``running``: the hand goes over a thing that stays; ``wrung``: it is turned this way and that.
"""

USUAL_PREPOSITION = "with"
"""Before the second object of a primitive whose rule file names none."""

JOINT = "|"
"""Between the verbs of a pattern that says several things of one object: ``raise|tilt {1}``."""

QUIET = frozenset({"reach for {1}", "let go of {1}", "take {ee} away"})
"""Patterns that describe the hand alone: what moves meanwhile is not moved by what they say."""

GIVEN = "hand {1} over"
"""The pattern of a thing that another hand takes."""

TO_A_SIDE = {side: f"hand {{1}} over to the {side} hand" for side in ("left", "right", "other")}
"""The same, where that is the other hand of the agent, by the side of it."""

HANDED_OVER = frozenset(TO_A_SIDE.values())
"""Patterns of a thing that the other hand takes."""

MOMENTARY = frozenset({"let go of {1}", GIVEN, *TO_A_SIDE.values(), "hand {1} to someone"})
"""Patterns of what is done in a moment: the rest of the segment is the hand's way back."""

TIPPED = frozenset({"pour from {1}", "pour from {1} into {2}"})
"""Patterns of what goes on in a vessel that is held still, until the vessel is upright again."""

HELPS = frozenset({"steady {1}"})
"""Patterns of what moves nothing and yet is a part of what was done."""

ONE_BY_ONE = "one after the other"
"""How several things are moved."""

BY_TURNS = "in turn"
"""How hands do something one after the other several times."""

BIT_BY_BIT = "bit by bit"
"""How something else is done that pauses interrupt."""

SUSTAINED = frozenset({"Stir", "Wipe", "Cut", "Shake", "Pour"})
"""Names of what goes on to and fro, or until a vessel is upright: a pause in it is a pause.

What else has pauses is done bit by bit.
"""

MOVING = frozenset({"MoveObj", "MoveObjTo"})
"""Names, and kinds of names, of a thing that is moved."""

SLID = frozenset({"Slide", "Push", "Pull"})
"""Names of what moves a thing on what it stands on."""

SHIFTED = SLID | {"MoveObj"}
"""Names of what moves a thing a little as it is put somewhere."""

PICKED_UP = "Lift"
"""The name of what takes a thing off what it lay on."""

TRANSPORT = frozenset({"Lift", "Raise", "Carry", "MoveObj", "MoveObjTo"})
"""Names of what brings a thing to where it is put."""

STAYING = frozenset({"Touch", "TouchWith"})
"""Names, and kinds of names, of a hand that only stays at a thing."""

FREE = "move {ee}"
"""The pattern of what a hand does that is of no object."""


RAISE, LOWER = "raise {1}", "lower {1}"
"""Patterns of a thing that goes up or down, wherever to."""

UP_AND_DOWN = "move {1} up and down"
"""The pattern of a thing that rises, sinks and rises again."""

DOWN = "put {1} down"
"""The pattern of a thing that stands somewhere then."""

GROUNDS = frozenset({"floor", "ground"})
"""Kinds of what people walk on: that a thing is put on it says nothing of where."""

GOALS = ("put {1} on {2}", "bring {1} to {2}")
"""How patterns begin of a thing that gets to another one."""

CONTAINERS = frozenset({"carton", "container", "crate", "basket", "bin", "drawer"})
"""Kinds of what is open above: what is left within its shadow and below its rim is in it."""

PACKS = frozenset({"bag", "bottle", "box", "can", "carton", "jar", "tin", "tube"})
"""Kinds of things that are named by what is in them, where there are several."""

OPEN = CONTAINERS | {
    *(
        "bag",
        "basin",
        "bottle",
        "bowl",
        "box",
        "bucket",
        "cup",
        "dish",
        "glass",
        "jar",
        "jug",
        "mug",
    ),
    *("pan", "pot", "shelf", "sink", "tin", "tray", "vase"),
}
"""Kinds of what may hold something inside; what dips into anything else is not in it."""

PUT_IN = "put {1} in {2}"
"""The pattern of a thing that is left in a container."""

SETTLING = frozenset({"PutDown", "Lower", "Slide", "Push", "Pull", "Turn", "Tilt"})
"""Names of what is done with a thing until it stays where it is put."""

RUNNING = "keep a hand on {1}"
"""The pattern of a hand that runs over a thing."""

TURN, TILT = "turn {1}", "tilt {1}"
"""Patterns of a thing that is turned, and that is leant."""

BY_A_QUARTER = "turn {1} by about a quarter"
"""The pattern of a thing that is made to face aside."""

THIS_WAY = "turn {1} about"
"""The pattern of a thing that is turned about in the hand."""

UPSIDE_DOWN, AROUND = "turn {1} upside down", "turn {1} around"
"""Patterns of a thing that is turned over, or made to face another way."""

UPRIGHT, BACK_UPRIGHT = "turn {1} upright", "turn {1} back upright"
"""Patterns of a thing that is set on its base; the second where the hand had turned it over."""

HELD_OVER = "hold {1} upside down"
"""The pattern of a thing that stays turned over in the hands."""

TURNED = frozenset({TURN, BY_A_QUARTER, UPSIDE_DOWN, AROUND, UPRIGHT, BACK_UPRIGHT})
"""Patterns of how a thing is turned, which goes on beside what else is done to it."""

ABOUT = frozenset({TURN, BY_A_QUARTER, AROUND})
"""Patterns of a thing that is turned about the vertical."""

LET_GO = "let go of {1}"
"""The pattern of a hand that leaves what it has."""

REACH = "reach for {1}"
"""The pattern of a hand that goes to a thing."""

STIR = "stir in {2} with {1}"
"""The pattern of an instrument that goes without saying where it was just spoken of."""

WALK, STEP, TWO_STEPS = "walk", "take a step", "take two steps"
"""What the whole body does, with no word of the feet."""

WALK_UP, STEP_UP = "walk up to {1}", "step up to {1}"
"""The same, to the thing that a hand takes next."""

WALK_PARTLY, WALK_HALFWAY = "walk partway around {1}", "walk halfway around {1}"
"""The same, about that thing."""

WALKING = frozenset({WALK, WALK_UP, WALK_PARTLY, WALK_HALFWAY})
"""Patterns of three steps or more."""

STEP_AWAY, WALK_AWAY, STEP_BACK = "step away", "walk away", "step back"
"""The same, from the thing that a hand has left; the last by one who still faces it."""

CROUCH, BEND = "crouch down", "bend down"
"""Patterns of a body that goes down with bent knees, and by the trunk alone."""

STAND_UP, STRAIGHTEN, BEGIN_UP = "stand up", "straighten up", "begin to straighten up"
"""Patterns of a body that comes up from crouching, and from bending down; and of one that is on its
way up as the recording ends."""

LEAVES = frozenset({STEP_AWAY, WALK_AWAY, STEP_BACK})
"""Patterns of who leaves when all is done."""

BODILY = LEAVES | {
    *(WALK, STEP, TWO_STEPS, WALK_UP, STEP_UP, WALK_PARTLY, WALK_HALFWAY),
    *(CROUCH, BEND, STAND_UP, STRAIGHTEN, BEGIN_UP),
}
"""Patterns that name no end-effector."""

ON_FOOT = frozenset({"Step", "Stand", "Walk", "StandOnOneLeg", "RestFoot"})
"""Names of what feet do on the ground."""

SOMEONE = "someone"
"""In a pattern, another agent: said so where it is not known who."""


class Phrasebook:
    """Patterns by primitive: shipped ones, and verbs of the rule files for all others."""

    def __init__(self, words: Iterable[PrimitiveWords] = ()) -> None:
        self._words: Mapping[str, PrimitiveWords] = {each.name: each for each in words}

    def pattern(self, name: str, general: Sequence[str], cases: Cases, count: int) -> str:
        """How a narrative says a primitive over so many objects: ``put {1} on {2}``."""
        shipped = _first(name, cases)
        if shipped:
            return shipped
        words = self._words.get(name)
        if words is not None and words.verbs:
            return self._own(words, cases, count)
        for above in (*(words.general if words else ()), *general):
            found = _first(above, cases)
            if found:
                return found
        return built(words_of(name), count, "at" if "self" in cases else USUAL_PREPOSITION)

    def _own(self, words: PrimitiveWords, cases: Cases, count: int) -> str:
        stated = words.prepositions[0] if words.prepositions else ""
        usual = "on" if "on" in cases else USUAL_PREPOSITION
        return built(words.verbs[0], count, stated or usual)


def _first(name: str, cases: Cases) -> str:
    for row in table("phrases"):
        if row["primitive"] == name and set(row["cases"].split()) <= set(cases):
            return row["pattern"]
    return ""


def built(verb: str, count: int, preposition: str) -> str:
    """A pattern of a verb over so many objects, the second after a preposition."""
    more = [f"and {{{number}}}" for number in range(3, count + 1)]
    parts = ["{1}"] * (count > 0) + [f"{preposition} {{2}}"] * (count > 1) + more
    return " ".join([verb, *parts])


def in_progress(pattern: str) -> str:
    """The pattern with its verb as what goes on meanwhile: ``turning {1} upside down``."""
    verb, _, rest = pattern.partition(" ")
    return f"{verb.removesuffix('e')}ing {rest}".strip()


def moves_only(pattern: str) -> bool:
    """Whether it says no more than that the object is moved."""
    return pattern in {"move {1}", "move {1} about", "turn {1}"}


def in_past(pattern: str) -> str:
    """The pattern with its verbs in the past: ``reached for {1}``, ``raised and tilted {1}``."""
    verb, _, rest = pattern.partition(" ")
    return f"{joined([past(each) for each in verb.split(JOINT)])} {rest}".strip()
