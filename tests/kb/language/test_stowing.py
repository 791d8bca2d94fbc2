"""What is left in an open box is told to be put in it, whatever it touches on its way there."""

from dataclasses import replace

import numpy as np
import pytest
from observations import MUG, TABLE, Piece, observation
from tellings import steps_of

from capar.model.par import FeatureSet
from capar.model.sampled_track import sampled_track
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


def told(*pieces: Piece, end: tuple[float, float, float], kind: str = "carton") -> str:
    """What is told of a mug that is carried from the origin to a place, where it stays after 4 s.

    Args:
        pieces: What the right hand does.
        end: Where the mug is put [m].
        kind: The kind of the box around the middle (1, 0).
    """
    box = replace(CARTON, kind=kind)
    things = (MUG, BOWL, box, TABLE)
    made = observation("Stowed", {"right_hand": pieces}, things, frames=501, rate_hz=100.0)
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


def test_a_blow_on_the_way_is_told_before_it() -> None:
    struck = replace(MET, name="Hit")
    lowered = Piece("Lower", 400, ("mug", "carton"), features=PLACED)
    text = told(REACHED, LIFTED, struck, lowered, GONE, end=(1.0, 0.1, 0.05))
    assert text == "lifted the mug with the right hand, hit it, and put it in the carton."
