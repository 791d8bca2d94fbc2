"""What is left in an open box is told to be put in it, whatever it touches on its way there."""

from dataclasses import replace

import numpy as np
import pytest
from observations import MUG, TABLE, Piece, observation
from tellings import steps_of

from capar.model.facts import Fact, Lies, Touching
from capar.model.locations import sampled_track
from capar.model.par import FeatureSet
from kb.language.describe import describe

OWN = FeatureSet("1", "1", "1", "hand", "0")
PLACED = FeatureSet("100", "101", "10", "hand", "00")
BOWL = replace(MUG, name="bowl", kind="bowl")
CARTON = replace(
    TABLE,
    name="carton",
    kind="carton",
    size_m=(0.4, 0.4, 0.2),
    position_m=(1.0, 0.0, 0.0),
    orientation=(1.0, 0.0, 0.0, 0.0),
)
REACHED = Piece("Reach", 100, ("mug",))
LIFTED = Piece("Lift", 200, ("mug",), features=OWN)
MET = Piece("MoveObjTo", 260, ("mug", "bowl"), features=PLACED)
GONE = Piece("ResumePosture", 500, ("mug",))


def told(
    *pieces: Piece,
    end: tuple[float, float, float],
    kind: str = "carton",
    facts: tuple[Fact, ...] = (),
) -> str:
    """What is told of a mug that is carried from the origin to a place, where it stays after 4 s.

    Args:
        pieces: What the right hand does.
        end: Where the mug is put [m].
        kind: The kind of the box around the middle (1, 0).
        facts: What else was measured.
    """
    box = replace(CARTON, kind=kind)
    things = (MUG, BOWL, box, TABLE)
    made = observation(
        "Stowed", {"right_hand": pieces}, things, facts=facts, frames=501, rate_hz=100.0
    )
    (link,) = made.links
    own = tuple(
        replace(each, possessed=each.name not in {"Reach", "ResumePosture"})
        for each in link.segments
    )
    times = np.arange(501) / 100.0
    places = np.column_stack([np.interp(times, (1.0, 4.0), (0.0, each)) for each in end])
    track = sampled_track("mug", 0.01, places)
    seen = replace(made, links=(replace(link, segments=own),), tracks=(track,))
    text = describe(seen)
    assert steps_of(text)
    return text.removeprefix("The agent ").partition(" and let go")[0]


@pytest.mark.parametrize(
    ("end", "kind", "inside"),
    [
        ((1.0, 0.1, 0.05), "carton", True),
        ((1.0, 0.1, 0.25), "carton", False),
        ((1.0, 0.3, 0.05), "carton", False),
        ((1.0, 0.1, 0.05), "box", True),
    ],
)
def test_what_ends_below_the_rim_of_an_open_box_is_put_in_it(
    end: tuple[float, float, float], kind: str, inside: bool
) -> None:
    lowered = Piece("Lower", 400, ("mug", "carton"), features=PLACED)
    text = told(REACHED, LIFTED, MET, lowered, GONE, end=end, kind=kind)
    assert (text == "put the mug in the carton with the right hand.") is inside
    assert ("to the bowl" in text) is not inside


@pytest.mark.parametrize("name", ["Hit", "Wipe"])
def test_what_it_brushes_past_on_its_way_into_the_box_is_not_told(name: str) -> None:
    met = replace(MET, name=name)
    lowered = Piece("Lower", 400, ("mug", "carton"), features=PLACED)
    text = told(REACHED, LIFTED, met, lowered, GONE, end=(1.0, 0.1, 0.05))
    assert text == "put the mug in the carton with the right hand."


def test_what_is_struck_before_it_is_carried_to_the_table_is_told() -> None:
    lowered = Piece("Lower", 400, ("mug", "table"), features=PLACED)
    text = told(REACHED, LIFTED, replace(MET, name="Hit"), lowered, GONE, end=(0.2, 0.1, 0.25))
    assert text.startswith("lifted the mug with the right hand, hit it")


@pytest.mark.parametrize(
    ("how", "first", "last", "inside"),
    [
        ("inside", 410, 500, True),
        ("dips", 410, 500, True),
        ("inside", 300, 405, False),
        ("inside", 0, 500, False),
        ("above", 410, 500, False),
    ],
)
def test_where_it_was_measured_what_is_in_the_box_that_tells(
    how: str, first: int, last: int, inside: bool
) -> None:
    """What is in it only in passing was not put there, and what was there before was not either."""
    lowered = Piece("Lower", 400, ("mug", "carton"), features=PLACED)
    lies = (Lies("mug", how, "carton", first, last), Lies("bowl", "inside", "carton", 0, 500))
    text = told(REACHED, LIFTED, lowered, GONE, end=(1.0, 0.1, 0.05), facts=lies)
    assert (text == "put the mug in the carton with the right hand.") is inside


def test_what_lies_on_a_heap_in_the_box_is_in_it() -> None:
    lowered = Piece("Lower", 400, ("mug", "bowl"), features=PLACED)
    lies = (Lies("mug", "above", "carton", 390, 500), Lies("bowl", "dips", "carton", 0, 500))
    meets = Touching("mug", "bowl", 395, 500)
    text = told(REACHED, LIFTED, lowered, GONE, end=(1.0, 0.1, 0.5), facts=(*lies, meets))
    assert text == "put the mug in the carton with the right hand."
