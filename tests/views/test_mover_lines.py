"""What moved a thing is told once, by those who did most of it, whatever they did with it."""

from dataclasses import replace

import pytest
from observations import drink_from_mug

from capar.model.facts import MovedBy
from capar.model.observation import Observation
from capar.views.movers import MOST_TOLD, mover_lines


def told(*moved: MovedBy) -> str:
    """The line of the mug in the segment in which it is put back."""
    seen = drink_from_mug()
    facts = (*(fact for fact in seen.facts if not isinstance(fact, MovedBy)), *moved)
    observation: Observation = replace(seen, facts=facts)
    (segment,) = [part for part in seen.segments if part.objects[:1] == ("mug",)][1:2]
    (line,) = mover_lines(observation, segment.ee, segment.index)
    return line


def span() -> tuple[int, int]:
    segment = [part for part in drink_from_mug().segments if part.objects[:1] == ("mug",)][1]
    return segment.first, segment.last


def by(mover: str, how: str = "carried", share: float = 1.0) -> MovedBy:
    first, last = span()
    return MovedBy("mug", mover, how, first, first + round(share * (last - first)))


def test_a_thing_that_one_hand_carries_throughout_is_told_in_one_plain_sentence() -> None:
    assert told(by("right_hand")) == "The mug was carried by the right hand."


def test_whoever_joins_is_told_with_the_share_of_the_time_and_who_holds_on_without() -> None:
    line = told(by("right_hand"), by("left_hand", share=0.5))
    assert line.startswith("The mug was carried by the right hand throughout and by the left hand")
    assert "for 5" in line and line.count("%") == 1


def test_what_is_held_by_one_and_pushed_by_another_is_not_said_to_be_struck() -> None:
    line = told(by("right_hand"), by("left_hand", "pushed", 0.5))
    assert "moved by the right hand throughout" in line
    assert "struck" not in line


@pytest.mark.parametrize("share", [0.6, 1.0])
def test_of_many_only_a_few_are_named(share: float) -> None:
    fingers = [f"finger{number}" for number in range(9)]
    line = told(by("right_hand"), *(by(finger, share=share) for finger in fingers))
    assert sum(line.count(name) for name in ("finger", "right hand")) == MOST_TOLD
    assert line.endswith("others.")
