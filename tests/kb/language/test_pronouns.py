"""A pronoun stands for what was moved only where no other thing could be meant."""

from collections.abc import Mapping
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import MUG, TABLE, Piece, observation
from tellings import steps_of

from capar.model.par import FeatureSet
from kb.language.describe import describe

BOWL, BOTTLE = replace(MUG, name="bowl", kind="bowl"), replace(MUG, name="bottle", kind="bottle")
FEATURES: Mapping[str, FeatureSet] = {
    "MoveObjTo": FeatureSet("100", "101", "10", "hand", "00"),
    "Pour": FeatureSet("101", "101", "10", "hand", "00"),
    "Raise": FeatureSet("1", "1", "1", "hand", "0"),
    "Slide": FeatureSet("101", "101", "10", "hand", "00"),
}
DONE = ("MoveObjTo bowl", "MoveObjTo table", "Pour bowl", "Raise", "Slide table")


def told(*done: str) -> str:
    """What is told of a bottle that is handled so once the hand has reached for it."""
    pieces = [Piece("Reach", 50, ("bottle",))]
    for at, (name, *place) in enumerate((each.split() for each in done), 2):
        pieces.append(Piece(name, 50 * at, ("bottle", *place), features=FEATURES[name]))
    frames = pieces[-1].last + 1
    things = (BOWL, BOTTLE, TABLE)
    made = observation("Poured", {"right_hand": tuple(pieces)}, things, frames=frames, rate_hz=50.0)
    (link,) = made.links
    held = tuple(replace(each, possessed=each.index > 0) for each in link.segments)
    return describe(replace(made, links=(replace(link, segments=held),)))


@pytest.mark.parametrize(
    ("done", "text"),
    [
        (("MoveObjTo bowl", "Raise"), "brought the bottle to the bowl with the right hand and "
         "raised the bottle."),
        (("MoveObjTo bowl", "Pour bowl"), "brought the bottle to the bowl with the right hand and "
         "poured from it into the bowl."),
        (("Pour bowl", "MoveObjTo table"), "poured from the bottle into the bowl with the right "
         "hand and brought the bottle to the table."),
        (("Slide table", "Raise"), "slid the bottle along the table with the right hand and raised "
         "it."),
    ],
)  # fmt: skip
def test_what_it_might_be_besides_is_ruled_out(done: tuple[str, ...], text: str) -> None:
    assert told(*done) == f"The agent {text}"


@given(st.lists(st.sampled_from(DONE), min_size=1, max_size=6))
def test_every_step_is_read_back_as_of_the_same_thing(done: list[str]) -> None:
    assert {step.call.objects[0] for step in steps_of(told(*done))} == {"bottle"}
