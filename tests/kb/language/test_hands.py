"""What both hands do together is told of both, also where of one of them only a finger touches."""

from dataclasses import replace
from typing import Literal

import pytest
from observations import MUG, Piece, observation

from capar.model.par import FeatureSet
from kb.language.describe import describe

OWN = FeatureSet("1", "1", "1", "hand", "0")
CHAIR = replace(MUG, name="chair", kind="chair")


def done(reached: int, *, carried: bool = True) -> tuple[Piece, ...]:
    """A chair that is reached for until a frame, and lifted until another; or only reached for."""
    lifted = (Piece("Lift", 250, ("chair",), features=OWN),) if carried else ()
    return (
        Piece("Reach", reached, ("chair",)),
        *((Piece("Touch", 150, ("chair",)),) if reached < 150 else ()),
        *lifted,
        Piece("ResumePosture", 400, ("chair",)),
    )


def told(detail: Literal["steps", "summary"] = "steps", **links: tuple[Piece, ...]) -> str:
    """What is told of a chair that links handle within four seconds."""
    made = observation("Chair", links, (CHAIR,), frames=401, rate_hz=100.0)
    own = tuple(
        replace(
            link,
            segments=tuple(
                replace(each, possessed=each.name in {"Lift", "Touch"}) for each in link.segments
            ),
        )
        for link in made.links
    )
    return describe(replace(made, links=own), detail=detail)


REST = (Piece("Rest", 400, ()),)
BOTH = "The agent lifted the chair with both hands and let go."


def test_what_a_finger_moves_is_moved_by_its_hand() -> None:
    links = {"left_hand": done(150), "right_hand": REST, "right_index2": done(150)}
    assert told(**links) == BOTH


def test_of_several_fingers_that_which_has_the_thing_for_longest_tells_what_the_hand_did() -> None:
    brief = (Piece("Reach", 200, ("chair",)), *done(150)[-2:])
    links = {"left_hand": done(150), "right_hand": REST}
    assert told(**links, right_index1=brief, right_index2=done(150)) == BOTH
    assert told(**links, right_index1=done(150), right_index2=brief) == BOTH


def test_a_finger_does_not_stand_for_the_hand_that_moves_the_thing_itself() -> None:
    links = {"right_hand": done(150), "right_index2": (Piece("Push", 400, ("chair",)),)}
    assert told(**links) == BOTH.replace("both hands", "the right hand")


def test_hands_that_reach_one_after_the_other_for_what_both_lift_reach_together() -> None:
    assert told(left_hand=done(105), right_hand=done(150)) == BOTH


def test_hands_of_which_one_only_reaches_are_told_apart() -> None:
    text = told(left_hand=done(150), right_hand=done(60, carried=False))
    assert "both hands" not in text


@pytest.mark.parametrize(("taken", "hands"), [(150, "both hands"), (300, "the left hand")])
def test_a_summary_tells_of_both_hands_what_they_do_together_for_most_of_the_time(
    taken: int, hands: str
) -> None:
    left = (Piece("Lift", 400, ("chair",), features=OWN),)
    right = (Piece("Reach", taken, ("chair",)), *left)
    text = told(detail="summary", left_hand=left, right_hand=right)
    assert text.startswith(f"The agent lifted the chair with {hands}")
