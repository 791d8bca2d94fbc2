"""What moved a thing is told once, by those who did most of it, whatever they did with it."""

import re
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


@pytest.mark.parametrize("how", ["carried", "pushed"])
def test_a_thing_that_one_hand_moves_throughout_is_told_in_one_plain_sentence(how: str) -> None:
    """Whether it was steady in the hand's frame or slipped makes no other verb."""
    assert told(by("right_hand", how)) == "The mug was moved by the right hand."


def test_a_thing_that_now_is_steady_in_a_hand_and_now_slips_is_told_in_the_same_words() -> None:
    mixed = (by("right_hand", share=0.5), by("right_hand", "pushed"))
    assert told(*mixed) == "The mug was moved by the right hand."


def test_whoever_joins_is_told_with_the_share_of_the_time_and_who_holds_on_without() -> None:
    line = told(by("right_hand"), by("left_hand", share=0.5))
    assert line.startswith(
        "The mug was moved by the right hand all the time it moved and by the left hand"
    )
    assert "for 5" in line and line.count("%") == 1


@pytest.mark.parametrize("share", [0.2, 0.5, 1.0])
def test_who_touches_what_another_one_holds_steadily_does_not_move_it(share: float) -> None:
    line = told(by("right_hand"), by("left_hand", "pushed", share))
    start = "The mug was moved by the right hand; the left hand was in contact with it "
    assert line.startswith(start)
    found = re.fullmatch(r"(?:for (\d+) % of that time|meanwhile)\.", line.removeprefix(start))
    assert found is not None
    assert abs(float(found[1] or 100.0) - 100.0 * share) < 5.0


@pytest.mark.parametrize("share", [0.6, 1.0])
def test_of_many_only_a_few_are_named(share: float) -> None:
    fingers = [f"finger{number}" for number in range(9)]
    line = told(by("right_hand"), *(by(finger, share=share) for finger in fingers))
    assert sum(line.count(name) for name in ("finger", "right hand")) == MOST_TOLD
    assert line.endswith("others.")


def test_who_touches_for_a_while_what_another_one_moves_has_no_share_of_its_motion() -> None:
    line = told(by("right_hand", "pushed"), by("left_hand", "pushed", 0.2))
    assert re.fullmatch(
        r"The mug was moved by the right hand; the left hand was in contact with it for 2\d % of "
        r"that time\.",
        line,
    )
