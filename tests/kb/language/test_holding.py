"""A hand has what it moves, also where no contact was measured; a thing changes hands once."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from observations import MUG, Piece, observation
from tellings import steps_of

from capar.model.facts import Fact, MovedBy, Moving, Touching
from capar.model.locations import sampled_track
from capar.model.observation import Observation
from capar.model.par import FeatureSet
from kb.language.describe import describe
from kb.language.holding import Holding

OWN = FeatureSet("1", "1", "1", "hand", "0")
HAS = {"Lift", "Lower", "Turn", "Touch", "Carry"}
CHAIR = replace(MUG, name="chair", kind="chair")


def seen(links: Mapping[str, tuple[Piece, ...]], *facts: Fact) -> Observation:
    """What hands did to a chair within four seconds, at 100 Hz."""
    made = observation("Chair", links, (CHAIR,), facts=facts, frames=401, rate_hz=100.0)
    own = tuple(
        replace(
            link,
            segments=tuple(replace(each, possessed=each.name in HAS) for each in link.segments),
        )
        for link in made.links
    )
    return replace(made, links=own)


def piece(name: str, end: int) -> Piece:
    """A segment about the chair."""
    return Piece(name, end, ("chair",), features=OWN if name in HAS - {"Touch"} else None)


LOST = tuple(
    piece(name, end)
    for name, end in (
        ("Reach", 50), ("Lift", 150), ("ResumePosture", 180), ("Reach", 250), ("Lower", 330),
        ("ResumePosture", 400),
    )
)  # fmt: skip
CONTACTS = (Touching("right_hand", "chair", 50, 150), Touching("right_hand", "chair", 250, 345))


def test_a_contact_that_drops_out_while_the_hand_carries_the_thing_is_not_told() -> None:
    carried = MovedBy("chair", "right_hand", "carried", 60, 325)
    told = describe(seen({"right_hand": LOST}, *CONTACTS, Moving("chair", 60, 325), carried))
    assert told == "The agent lifted, moved, and lowered the chair with the right hand."


def test_what_a_hand_lets_go_and_takes_again_is_told() -> None:
    still = (Moving("chair", 60, 140), MovedBy("chair", "right_hand", "carried", 60, 140))
    told = describe(seen({"right_hand": LOST}, *CONTACTS, *still))
    assert told == (
        "The agent lifted the chair with the right hand and let go. Then the agent lowered the "
        "chair."
    )


def test_letting_go_is_when_contact_ends() -> None:
    made = seen({"right_hand": LOST}, *CONTACTS)
    left = made.links[0].segments[-1]
    assert left.start_s < 3.45
    assert Holding(made).released_s(left) == pytest.approx(3.45)


def test_a_blow_with_which_a_hand_begins_to_move_a_thing_is_no_blow() -> None:
    pieces = (piece("Hit", 100), piece("Reach", 300), piece("ResumePosture", 400))
    touches = (Touching("right_hand", "chair", 100, 110), Touching("right_hand", "chair", 290, 300))
    moves = (Moving("chair", 130, 280), MovedBy("chair", "right_hand", "carried", 140, 280))
    told = describe(seen({"right_hand": pieces}, *touches, *moves))
    assert told == "The agent moved the chair with the right hand."
    assert describe(seen({"right_hand": pieces}, *touches)).startswith("The agent hit the chair")


def test_a_thing_that_changes_hands_is_handed_over_once_while_both_have_it() -> None:
    right = (piece("Reach", 50), piece("Lift", 150), piece("Give", 300), piece("Touch", 310))
    left = (piece("Receive", 180), piece("Turn", 400))
    touches = (Touching("right_hand", "chair", 50, 220), Touching("left_hand", "chair", 180, 400))
    told = describe(seen({"right_hand": right[:3], "left_hand": left}, *touches), timed=True)
    assert told == (
        "The agent lifted the chair with the right hand (0.50–1.50 s) and handed it over to the "
        "left hand (1.80–2.20 s), which turned it (1.80–4.00 s)."
    )
    hands = [(step.call.action, step.ee) for step in steps_of(told)]
    assert hands == [("Lift", "right_hand"), ("Give", "right_hand"), ("Turn", "left_hand")]


def test_what_goes_back_and_forth_between_hands_is_one_sentence_and_is_read_back() -> None:
    right = (piece("Turn", 80), piece("Give", 200), piece("Receive", 250), piece("Lower", 400))
    left = (piece("Receive", 70), piece("Lift", 260), piece("Give", 400))
    touches = (
        Touching("right_hand", "chair", 0, 80),
        Touching("left_hand", "chair", 70, 260),
        Touching("right_hand", "chair", 250, 400),
    )
    told = describe(seen({"right_hand": right, "left_hand": left}, *touches))
    assert told == (
        "The agent turned the chair with the right hand and handed it over to the left hand, which "
        "lifted it and handed it over to the right hand, which lowered it."
    )
    hands = [step.ee for step in steps_of(told)]
    assert hands == ["right_hand"] * 2 + ["left_hand"] * 2 + ["right_hand"]


def test_what_another_hand_helped_with_is_told_beside_that() -> None:
    right = (piece("Reach", 50), piece("Lift", 150), piece("Turn", 250), piece("Lower", 400))
    left = (piece("Reach", 60), piece("Turn", 140), piece("ResumePosture", 400))
    touches = (Touching("right_hand", "chair", 50, 400), Touching("left_hand", "chair", 60, 140))
    told = describe(seen({"right_hand": right, "left_hand": left}, *touches), timed=True)
    assert told.startswith(
        "The agent lifted the chair with the right hand (0.50–1.50 s) while the left hand turned "
        "it (0.60–1.40 s). Then the agent turned the chair"
    )


@pytest.mark.parametrize(("grasped_s", "held"), [(0.8, False), (1.5, True)])
def test_taking_hold_of_a_thing_before_it_is_moved_goes_without_saying(
    grasped_s: float, held: bool
) -> None:
    end = 50 + round(100 * grasped_s)
    pieces = (piece("Reach", 50), piece("Touch", end), piece("Lift", 400))
    told = describe(seen({"right_hand": pieces}, Touching("right_hand", "chair", 50, 400)))
    assert ("held" in told) is held
    assert "lifted" in told


def test_a_hand_that_goes_along_beside_a_thing_does_what_the_other_is_seen_to_do() -> None:
    left = (piece("Reach", 50), piece("Lift", 150), piece("Carry", 250), piece("Lower", 340))
    right = (piece("Reach", 50), piece("Lift", 150), piece("ResumePosture", 400))
    touches = (Touching("right_hand", "chair", 50, 150), Touching("left_hand", "chair", 50, 350))
    moves = (Moving("chair", 60, 340), MovedBy("chair", "right_hand", "carried", 60, 340))
    gone = piece("ResumePosture", 400)
    told = describe(seen({"right_hand": right, "left_hand": (*left, gone)}, *touches, *moves))
    assert told == "The agent lifted, carried, and lowered the chair with both hands."


@pytest.mark.parametrize(
    ("high_m", "words"),
    [(0.3, "lifted the chair with the right hand and put it down"), (0.0, "moved the chair")],
)
def test_what_is_off_the_floor_while_contact_is_lost_is_lifted_and_put_down(
    high_m: float, words: str
) -> None:
    pieces = (piece("Reach", 300), piece("Touch", 340), piece("ResumePosture", 400))
    touches = (Touching("right_hand", "chair", 60, 70), Touching("right_hand", "chair", 300, 340))
    floor = (Touching("chair", "floor", 0, 120), Touching("chair", "floor", 240, 400))
    moves = (Moving("chair", 100, 280), MovedBy("chair", "right_hand", "carried", 100, 280))
    made = seen({"right_hand": pieces}, *touches, *floor, *moves)
    heights = np.interp(np.arange(401), (100, 180, 280), (0.0, high_m, 0.0))
    way = sampled_track("chair", 0.01, np.column_stack((np.zeros((401, 2)), heights)))
    told = describe(replace(made, tracks=(way,)))
    assert told.startswith(f"The agent {words}")
