"""When something moves without contact, and which hand is taken to have it."""

from dataclasses import replace

import pytest
from observations import MUG, Piece, observation

from capar.model.facts import MovedBy, Moving, Touching
from capar.views.lost_contact import contact_gaps

MOVES = Moving("mug", 100, 200)


def gaps(mover: str = "right_hand", *touches: tuple[int, int]) -> list[tuple[str, float, float]]:
    """The hand, and from when to when no contact is found [s]."""
    hands = {ee: (Piece("Reach", 300, ("mug",)),) for ee in ("left_hand", "right_hand")}
    contacts = (Touching("right_hand", "mug", first, last) for first, last in touches)
    facts = (MOVES, MovedBy("mug", mover, "carried", 110, 190), *contacts)
    made = observation("Lost", hands, (MUG,), facts=facts, frames=301, rate_hz=100.0)
    kinds = tuple(replace(link, kind="hand", side=link.ee.partition("_")[0]) for link in made.links)
    return [
        (each.bodies[1], float(each.start_s or 0.0), float(each.end_s or 0.0))
        for each in contact_gaps(replace(made, links=kinds))
    ]


def test_the_whole_time_between_contacts_is_said() -> None:
    assert gaps("right_hand", (80, 90), (210, 220)) == [
        ("right_hand", pytest.approx(0.9), pytest.approx(2.1))
    ]
    assert [hand for hand, *_ in gaps("left_hand", (80, 90), (210, 220))] == ["left_hand"]


def test_nothing_is_said_of_contacts_that_go_on_or_miss_a_moment() -> None:
    assert gaps("right_hand", (80, 150), (140, 220)) == []
    assert gaps("right_hand", (80, 150), (160, 220)) == []


def test_nothing_is_said_where_no_hand_moves_it() -> None:
    assert gaps("nobody", (80, 90), (210, 220)) == []
    assert gaps("right_hand", (20, 30), (80, 95)) == []
