"""A summary tells who did in turn what hands did to one thing, and many things as one deed."""

from dataclasses import replace

import pytest
from observations import MUG, TABLE, Piece, observation
from tellings import steps_of

from capar.model.facts import Lies
from capar.model.observation import Observation
from capar.model.par import FeatureSet
from kb.language.clause import Clause
from kb.language.describe import describe
from kb.language.planning import sentences

OWN = FeatureSet("1", "1", "1", "hand", "0")
SHELF = replace(TABLE, name="shelf", kind="shelf")


def turned(*spans: tuple[str, int, int], other: str = "mug", lifts: bool = False) -> str:
    """The summary of who turned a mug about from when to when [frames at 100 Hz].

    Args:
        spans: Hands, each with its first and last frame.
        other: What is turned last.
        lifts: Whether the thing is lifted first each time.
    """
    pieces: dict[str, list[Piece]] = {}
    for at, (ee, first, last) in enumerate(spans):
        thing = (other,) if at == len(spans) - 1 else ("mug",)
        own = pieces.setdefault(ee, [])
        own.append(Piece("Reach", first, thing))
        if lifts:
            own.append(Piece("Lift", first + 60, thing, features=OWN))
        own.append(Piece("Turn", last, thing, features=OWN))
        own.append(Piece("ResumePosture", last + 20, thing))
    things = (MUG, replace(MUG, name="cup", kind="cup"))
    links = {ee: tuple(own) for ee, own in pieces.items()}
    made = observation("Turned", links, things, frames=2001, rate_hz=100.0)
    return describe(_held(made), detail="summary")


def _held(made: Observation) -> Observation:
    """The observation, with hands that have what they move."""
    own = (
        replace(
            link,
            segments=tuple(
                replace(each, possessed=each.name in {"Turn", "Lift", "MoveObj"})
                for each in link.segments
            ),
        )
        for link in made.links
    )
    return replace(made, links=tuple(own))


IN_TURN = (("right_hand", 50, 300), ("left_hand", 350, 600), ("right_hand", 650, 1500))


def test_who_turns_a_thing_in_turn_is_told_in_order() -> None:
    text = turned(*IN_TURN)
    assert text == (
        "The agent turned the mug about with the right hand, then with the left hand and with the "
        "right hand again."
    )
    hands = [(step.call.action, step.ee) for step in steps_of(text)]
    assert hands == [("Turn", "right_hand"), ("Turn", "left_hand"), ("Turn", "right_hand")]


def test_a_hand_that_helps_meanwhile_has_no_turn_of_its_own() -> None:
    text = turned(
        ("right_hand", 50, 600),
        ("left_hand", 150, 400),
        ("right_hand", 650, 900),
        ("left_hand", 950, 1200),
        ("right_hand", 1250, 1500),
    )
    assert text == (
        "The agent turned the mug about with the right hand, then with the left hand and with the "
        "right hand again."
    )


def test_of_more_turns_than_can_be_told_it_is_said_that_hands_took_turns() -> None:
    hands = ("right_hand", "left_hand", "right_hand", "left_hand")
    spans = [(hand, 400 * at + 50, 400 * at + 350) for at, hand in enumerate(hands)]
    text = turned(*spans)
    assert text == "The agent turned the mug about with both hands in turn."
    (step,) = steps_of(text)
    assert (step.ee, step.circumstances.manner) == ("both_hands", ("in turn",))


def test_what_each_lifts_and_turns_is_lifted_and_turned() -> None:
    assert turned(*IN_TURN, lifts=True).startswith("The agent lifted and turned the mug about with")


@pytest.mark.parametrize("other", ["mug", "cup"])
def test_two_turns_are_told_for_themselves_and_so_is_another_thing(other: str) -> None:
    spans = IN_TURN[:2] if other == "mug" else IN_TURN
    assert "then with" not in turned(*spans, other=other)


def gathered(count: int, *, last: int = 1000, kind: str = "shelf") -> str:
    """The summary of so many cups that a hand moves, which all are over a shelf till a frame."""
    names = [f"{word}_cup" for word in ("red", "blue", "green", "white", "black", "gold", "tin")]
    cups = tuple(replace(MUG, name=name, kind="cup") for name in names[:count])
    pieces = []
    for at, cup in enumerate(cups):
        pieces.append(Piece("Reach", 140 * at + 20, (cup.name,)))
        pieces.append(Piece("MoveObj", 140 * at + 120, (cup.name,), features=OWN))
        pieces.append(Piece("ResumePosture", 140 * at + 140, (cup.name,)))
    over = tuple(Lies(cup.name, "above", "shelf", 140 * at + 100, last) for at, cup in
                 enumerate(cups))  # fmt: skip
    table = Lies("red_cup", "above", "table", 0, 1000)
    made = observation(
        "Gathered",
        {"right_hand": tuple(pieces)},
        (*cups, replace(SHELF, kind=kind)),
        facts=(*over, table),
        frames=1001,
        rate_hz=100.0,
    )
    return describe(_held(made), detail="summary")


@pytest.mark.parametrize(("last", "where"), [(1000, " to the shelf"), (999, "")])
def test_more_things_than_a_summary_tells_are_moved_one_after_the_other(
    last: int, where: str
) -> None:
    text = gathered(7, last=last)
    assert text == (
        "The agent moved the red cup, the blue cup, the green cup, the white cup, the black cup, "
        f"the gold cup, and the tin cup{where} with the right hand one after the other."
    )
    (step,) = steps_of(text)
    assert len(step.call.objects) == 7 + (last == 1000)


def test_few_things_are_told_one_by_one() -> None:
    assert "one after the other" not in gathered(5)


def test_of_more_things_than_can_be_told_that_are_packed_only_the_number_is() -> None:
    text = gathered(7, kind="carton")
    assert text == (
        "The agent packed all seven things into the shelf one by one with the right hand."
    )
    (step,) = steps_of(text)
    assert step.call.objects == ("", "shelf")
    assert gathered(4, kind="carton") == (
        "The agent packed the red cup, the blue cup, the green cup, and the white cup into the "
        "shelf with the right hand."
    )


def test_what_the_same_hand_does_in_between_is_told_besides() -> None:
    packing = Clause("pack two things into {1}", ("carton",), ("right_hand",), 0.0, 9.0, True)
    shifting = replace(packing, pattern="shift {1} inside {2}", start_s=4.0, end_s=5.0)
    shifting = replace(shifting, objects=("sugar", "carton"))
    _, also = sentences((packing, shifting))
    assert also.opening == "Also, "
    beside = replace(shifting, ees=("left_hand",))
    (both,) = sentences((packing, beside))
    assert both.beside == (beside,)
