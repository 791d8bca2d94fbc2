"""Where a thing is held, carried and put is told by how it goes; coming and leaving is not."""

from dataclasses import replace

import numpy as np
import pytest
from observations import MUG, TABLE, Piece, observation
from tellings import steps_of

from capar.model.facts import Fact, Lies, Posture, Touching
from capar.model.locations import sampled_track
from capar.model.observation import ObservedObject
from capar.model.par import FeatureSet
from kb.language.describe import describe

OWN = FeatureSet("1", "1", "1", "hand", "0")
PLACED = FeatureSet("100", "101", "10", "hand", "00")
FLOOR = replace(TABLE, name="floor", kind="floor")
TRAY = replace(MUG, name="tray", kind="tray")
Way = tuple[tuple[float, float, float], ...]

TAKEN: Way = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
"""Where a mug is as each second begins, while a hand comes and lifts it [m]."""


def told(
    *pieces: Piece,
    way: Way,
    facts: tuple[Fact, ...] = (),
    things: tuple[ObservedObject, ...] = (MUG, TABLE, FLOOR, TRAY),
    head_m: float | None = None,
) -> str:
    """What is told of a mug that goes from place to place each second, at 100 Hz.

    Args:
        pieces: What the right hand does.
        way: Where the mug is as each second begins [m].
        facts: What else was measured.
        things: The objects.
        head_m: How high the head is [m], where it is tracked.
    """
    frames = 100 * (len(way) - 1) + 1
    made = observation(
        "Placed", {"right_hand": pieces}, things, facts=facts, frames=frames, rate_hz=100.0
    )
    (link,) = made.links
    own = tuple(
        replace(each, possessed=each.name not in {"Reach", "ResumePosture"})
        for each in link.segments
    )
    seconds = np.arange(frames) / 100.0
    places = np.column_stack(
        [np.interp(seconds, np.arange(len(way)), axis) for axis in np.array(way).T]
    )
    tracks = [sampled_track("mug", 0.01, places)]
    if head_m is not None:
        tracks.append(sampled_track("head", 0.01, np.tile((0.0, 0.0, head_m), (frames, 1))))
    seen = replace(made, links=(replace(link, segments=own),), tracks=tuple(tracks))
    text = describe(seen)
    plain = text.replace("up and down", "")
    assert len(steps_of(text)) == 1 + plain.count(",") + plain.count(" and ") - plain.count(
        ", and "
    )
    return text.removeprefix("The agent ")


REACHED, LIFTED = Piece("Reach", 100, ("mug",)), Piece("Lift", 200, ("mug",), features=OWN)
CARRIED = Piece("Carry", 400, ("mug",), features=OWN)


@pytest.mark.parametrize(
    ("far_m", "head_m", "words"),
    [
        (0.1, None, "held it up"),
        (0.1, 0.5, "held it there"),
        (0.1, 1.5, "held it up"),
        (0.6, 0.5, "carried it"),
    ],
)
def test_only_what_gets_somewhere_is_carried(
    far_m: float, head_m: float | None, words: str
) -> None:
    way = (*TAKEN, (0.5 * far_m, 0.0, 1.0), (far_m, 0.0, 1.0))
    overhead = " overhead" if head_m == 0.5 else ""
    assert told(REACHED, LIFTED, CARRIED, way=way, head_m=head_m) == (
        f"lifted the mug{overhead} with the right hand and {words}."
    )


def test_what_is_carried_away_and_back_is_carried() -> None:
    way = (*TAKEN, (0.8, 0.0, 1.0), (0.1, 0.0, 1.0))
    assert told(REACHED, LIFTED, CARRIED, way=way).endswith("and carried it.")


@pytest.mark.parametrize(("lean", "how"), [(100, ""), (700, " at a tilt"), (3000, " upside down")])
def test_how_a_thing_leans_while_it_is_carried_is_told(lean: int, how: str) -> None:
    way = (*TAKEN, (0.5, 0.0, 1.0), (1.0, 0.0, 1.0))
    leans = tuple(Posture("mug", frame, lean, 0) for frame in (200, 300, 400))
    done = told(Piece("Carry", 400, ("mug",), features=OWN), way=way, facts=leans)
    assert done == f"carried the mug{how} with the right hand."


@pytest.mark.parametrize(
    ("far_m", "words"),
    [
        (0.05, "put it back in its place"),
        (0.15, "put it down almost where it had been"),
        (0.3, "put it down"),
        (0.9, "put it down elsewhere"),
    ],
)
def test_what_is_put_on_the_ground_is_put_back_or_elsewhere(far_m: float, words: str) -> None:
    way = (*TAKEN, (far_m, 0.0, 1.0), (far_m, 0.0, 0.0))
    lowered = Piece("Lower", 400, ("mug", "floor"), features=PLACED)
    floor = (Touching("mug", "floor", 0, 100), Touching("mug", "floor", 395, 400))
    hand = Touching("right_hand", "mug", 100, 400)
    done = told(REACHED, LIFTED, lowered, way=way, facts=(*floor, hand))
    assert done == f"lifted the mug with the right hand and {words}."


@pytest.mark.parametrize(("end_m", "words"), [(0.0, "put it down"), (0.5, "lowered")])
def test_what_is_as_high_when_it_is_let_go_is_put_down(end_m: float, words: str) -> None:
    """What the hand lowers, and then has while it goes up again, is not put down."""
    way = (*TAKEN, (0.0, 0.0, 0.0), (0.0, 0.0, end_m), (0.0, 0.0, end_m))
    pieces = (REACHED, LIFTED, Piece("Lower", 300, ("mug",), features=OWN))
    rest = (Piece("Touch", 400, ("mug",)), Piece("ResumePosture", 500, ("mug",)))
    hand = Touching("right_hand", "mug", 100, 400)
    assert words in told(*pieces, *rest, way=way, facts=(hand,))


def test_what_leaves_its_support_at_the_edge_is_slid_off() -> None:
    way = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.5, 0.0, 0.0))
    slid = Piece("Slide", 200, ("mug", "table"), features=PLACED)
    table = Touching("mug", "table", 0, 198)
    aside = Lies("mug", "beside", "table", 190, 200)
    assert told(REACHED, slid, way=way, facts=(table, aside)) == (
        "slid the mug off the table with the right hand."
    )
    assert told(REACHED, slid, way=way, facts=(table,)) == (
        "slid the mug along the table with the right hand."
    )


@pytest.mark.parametrize(
    ("ends", "text"),
    [
        ((200, 280, 400), "brought the mug to the tray with the right hand."),
        ((200, 390, 490), "lifted the mug with the right hand, carried it, and brought it to the "
         "tray."),
    ],
)  # fmt: skip
def test_short_lifting_and_carrying_goes_with_bringing_a_thing_somewhere(
    ends: tuple[int, int, int], text: str
) -> None:
    way = (*TAKEN, (0.8, 0.0, 1.0), (1.6, 0.0, 1.0), (1.6, 0.0, 0.0))
    lifted, carried, brought = ends
    pieces = (
        Piece("Lift", lifted, ("mug",), features=OWN),
        Piece("Carry", carried, ("mug",), features=OWN),
        Piece("MoveObjTo", brought, ("mug", "tray"), features=PLACED),
    )
    begun = 110 if brought == 400 else 100
    assert told(Piece("Reach", begun, ("mug",)), *pieces, way=way) == text


@pytest.mark.parametrize(
    ("contact", "words"),
    [
        (Touching("mug", "table", 0, 105), "took the mug from the table with the right hand"),
        (Touching("mug", "table", 0, 20), "brought the mug to the tray with the right hand"),
    ],
)
def test_what_is_worked_with_is_taken_from_where_it_stood_until_then(
    contact: Touching, words: str
) -> None:
    way = (*TAKEN, (0.8, 0.0, 1.0), (1.6, 0.0, 1.0))
    brought = Piece("MoveObjTo", 250, ("mug", "tray"), features=PLACED)
    works = FeatureSet("101", "101", "10", "hand", "00")
    stirred = Piece("Stir", 390, ("mug", "tray"), features=works)
    done = told(REACHED, brought, stirred, way=way, facts=(contact,))
    assert done == f"{words} and stirred in the tray."


@pytest.mark.parametrize(("moves_m", "words"), [(0.0, " and put it down"), (0.5, " and let go")])
def test_what_is_up_in_the_hand_and_let_go_where_it_stays_is_put_down(
    moves_m: float, words: str
) -> None:
    way = (*TAKEN, (0.0, 0.0, 1.0), (moves_m, 0.0, 1.0))
    gone = Piece("ResumePosture", 400, ("mug",))
    hand = Touching("right_hand", "mug", 100, 300)
    done = told(REACHED, LIFTED, Piece("Touch", 290, ("mug",)), gone, way=way, facts=(hand,))
    assert done.endswith(f"{words}.")


def test_that_a_hand_stays_at_what_it_put_somewhere_is_not_told() -> None:
    way = (*TAKEN, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    put = Piece("PutDown", 300, ("mug", "tray"), features=PLACED)
    held = Piece("TouchWith", 480, ("mug", "tray"))
    gone = Piece("ResumePosture", 500, ("mug",))
    done = told(REACHED, LIFTED, put, held, gone, way=way)
    assert done == "lifted the mug with the right hand and put it down."


def test_a_hand_that_only_comes_and_leaves_is_told_to() -> None:
    way = ((0.0, 0.0, 0.0),) * 3
    gone = Piece("ResumePosture", 200, ("mug",))
    assert told(REACHED, gone, way=way) == (
        "reached for the mug with the right hand and took the hand away."
    )


@pytest.mark.parametrize(
    ("ahead_m", "words"), [(0.3, "pulled"), (-0.3, "pushed"), (0.05, "slid"), (-0.05, "slid")]
)
def test_what_is_slid_by_a_hand_before_it_is_pulled_and_behind_it_pushed(
    ahead_m: float, words: str
) -> None:
    seconds = np.arange(301) / 100.0
    way = np.column_stack([np.interp(seconds, (1.0, 3.0), (0.0, 1.0)), *np.zeros((2, 301))])
    pieces = (REACHED, Piece("Slide", 300, ("mug",), features=OWN))
    made = observation("Slid", {"right_hand": pieces}, (MUG,), frames=301, rate_hz=100.0)
    (link,) = made.links
    own = tuple(replace(each, possessed=each.name == "Slide") for each in link.segments)
    tracks = (
        sampled_track("mug", 0.01, way),
        sampled_track("right_hand", 0.01, way + np.array((ahead_m, 0.1, 0.0))),
    )
    text = describe(replace(made, links=(replace(link, segments=own),), tracks=tracks))
    assert text == f"The agent {words} the mug with the right hand."
    (step,) = steps_of(text)
    assert step.call.action == {"pulled": "Pull", "pushed": "Push", "slid": "Slide"}[words]


@pytest.mark.parametrize(("slid_m", "told_apart"), [(0.1, False), (0.6, True)])
def test_what_stirs_a_little_as_it_is_put_down_is_only_put_down(
    slid_m: float, told_apart: bool
) -> None:
    way = (*TAKEN, (0.8, 0.0, 1.0), (0.8, 0.0, 0.0), (0.8 + slid_m, 0.0, 0.0))
    pieces = (
        REACHED,
        LIFTED,
        Piece("Carry", 300, ("mug",), features=OWN),
        Piece("Lower", 400, ("mug", "floor"), features=PLACED),
        Piece(
            "Slide", 500, ("mug", "floor"), features=FeatureSet("101", "101", "10", "hand", "00")
        ),
    )
    floor = (Touching("mug", "floor", 0, 100), Touching("mug", "floor", 395, 500))
    text = told(*pieces, way=way, facts=(*floor, Touching("right_hand", "mug", 100, 500)))
    assert "carried it, " in text
    assert "put it down" in text
    assert "elsewhere" not in text
    assert ("slid" in text) is told_apart


def test_what_comes_down_while_it_is_turned_is_put_down() -> None:
    """It stands for the rest of the grip, in which it is turned again."""
    way = (*TAKEN, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    pieces = (
        REACHED,
        LIFTED,
        Piece("Turn", 400, ("mug",), features=OWN),
        Piece("Touch", 450, ("mug",)),
        Piece("Turn", 550, ("mug",), features=OWN),
        Piece("ResumePosture", 600, ("mug",)),
    )
    text = told(*pieces, way=way, facts=(Touching("right_hand", "mug", 100, 550),))
    assert text == (
        "lifted the mug with the right hand, turned it, put it down, and turned it again."
    )


@pytest.mark.parametrize(
    ("low_m", "words"), [(0.5, "moved it up and down"), (1.05, "and raised the mug")]
)
def test_what_sinks_as_it_rises_is_moved_up_and_down(low_m: float, words: str) -> None:
    way = (*TAKEN, (0.0, 0.0, 1.1), (0.0, 0.0, low_m), (0.0, 0.0, 1.4))
    turned = Piece("Turn", 220, ("mug",), features=OWN)
    text = told(REACHED, LIFTED, turned, Piece("Raise", 500, ("mug",), features=OWN), way=way)
    assert words in text


@pytest.mark.parametrize(
    ("size_m", "words"),
    [
        (0.6, "carried it, turning it by about a quarter, and put it down."),
        (0.1, "carried it, and put it down."),
    ],
)
def test_a_large_thing_that_faces_aside_in_the_end_is_turned_on_the_way(
    size_m: float, words: str
) -> None:
    way = (*TAKEN, (0.8, 0.0, 1.0), (1.6, 0.0, 1.0), (1.6, 0.0, 0.0))
    pieces = (
        REACHED,
        LIFTED,
        CARRIED,
        Piece("Lower", 500, ("mug", "floor"), features=PLACED),
    )
    spins = (0, 0, 0, 500, 1000, 1500)
    facts = (
        *(Posture("mug", 100 * at, 0, spin) for at, spin in enumerate(spins)),
        Posture("mug", 450, 0, 1450),
        Touching("mug", "floor", 0, 100),
        Touching("mug", "floor", 495, 500),
    )
    large = replace(MUG, size_m=(size_m, size_m, size_m))
    text = told(*pieces, way=way, facts=facts, things=(large, TABLE, FLOOR))
    assert text.endswith(words)


@pytest.mark.parametrize(("lean", "how"), [(150, ""), (350, " at a tilt")])
def test_what_leans_while_it_is_slid_is_told_so(lean: int, how: str) -> None:
    way = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.5, 0.0, 0.0))
    slid = Piece("Slide", 200, ("mug", "table"), features=PLACED)
    leans = tuple(Posture("mug", frame, lean, 0) for frame in (100, 150, 200))
    done = told(REACHED, slid, way=way, facts=(Touching("mug", "table", 0, 200), *leans))
    assert done == f"slid the mug along the table{how} with the right hand."
