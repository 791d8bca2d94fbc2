"""What bodies are called in prose."""

from dataclasses import replace

import motions
import pytest

from capar.model.body_names import body_names
from capar.model.observation import Observation
from capar.pipelines.observation import observe


@pytest.fixture(scope="module")
def seen() -> Observation:
    return observe(motions.touch_cycle(motions.WOMAN).capture)


def with_fingers(seen: Observation, *fingers: tuple[str, str, str]) -> Observation:
    """The observation, with end-effectors of those names, kinds and sides."""
    (link,) = seen.links
    links = (replace(link, ee=ee, kind=kind, side=side) for ee, kind, side in fingers)
    return replace(seen, links=(link, *links))


def test_a_finger_is_called_by_its_hand(seen: Observation) -> None:
    named = body_names(with_fingers(seen, ("r_ring2", "ring2", "right"), ("t", "thumb", "left")))
    assert (named["r_ring2"], named["t"]) == ("right ring finger", "left thumb")


def test_joints_of_one_finger_are_told_apart(seen: Observation) -> None:
    joints = [(f"r_pinky{at}", f"pinky{at}", "right") for at in (1, 3)]
    named = body_names(with_fingers(seen, *joints))
    assert named["r_pinky1"] == "first joint of the right little finger"
    assert named["r_pinky3"] == "third joint of the right little finger"


def test_what_is_no_finger_or_of_no_known_side_keeps_its_name(seen: Observation) -> None:
    others = (("right_hand_2", "hand", "right"), ("ring", "ring", "none"))
    assert not {"right_hand_2", "ring"} & {*body_names(with_fingers(seen, *others))}
