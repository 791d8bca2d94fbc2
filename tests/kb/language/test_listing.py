"""What a hand puts on end in or on one thing is told as lists, in which each has its own time."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import MUG, TABLE, Piece, observation
from tellings import WORDS, against_time, spans, steps_of

from capar.model.facts import Touching
from capar.model.par import FeatureSet
from kb.language import Instruction, parse
from kb.language.describe import describe
from kb.language.vocabulary import Vocabulary

PLACED = FeatureSet("100", "101", "10", "hand", "00")
NAMES = (
    *("mug", "bowl", "bottle", "plate", "spoon", "jar", "cup_2", "fork", "cup", "pan", "pot"),
    *("tray", "dish"),
)
SHELF = replace(TABLE, name="shelf", kind="shelf")


def told(*places: str, timed: bool = True, late: int = 99, waits: int = 400) -> str:
    """What is told of a hand that puts one thing after another on places, each in two seconds.

    Args:
        places: Where it puts them.
        timed: Whether times are told.
        late: How many things it puts before it pauses.
        waits: For how long it pauses then [frames at 100 Hz].
    """
    pieces: list[Piece] = []
    facts: list[Touching] = []
    for at, (name, place) in enumerate(zip(NAMES, places, strict=False)):
        first = 200 * at + (waits if at >= late else 0)
        pieces.append(Piece("Reach", first + 50, (name,)))
        pieces.append(Piece("MoveObjTo", first + 150, (name, place), features=PLACED))
        pieces.append(Piece("ResumePosture", first + 200, (name,)))
        facts += [
            Touching(name, place, first + 149, 200 * len(places) + waits),
            Touching("right_hand", name, first + 50, first + 155),
        ]
    things = tuple(replace(MUG, name=name, kind=name) for name in NAMES)
    made = observation(
        "Put",
        {"right_hand": tuple(pieces)},
        (*things, TABLE, SHELF),
        facts=tuple(facts),
        frames=200 * len(places) + waits + 1,
        rate_hz=100.0,
    )
    (link,) = made.links
    own = tuple(replace(each, possessed=each.name == "MoveObjTo") for each in link.segments)
    return describe(replace(made, links=(replace(link, segments=own),)), timed=timed)


def test_things_that_are_put_on_one_place_are_one_list() -> None:
    assert told("table", "table", "table", timed=False) == (
        "The agent put the mug, the bowl, and the bottle on the table with the right hand."
    )
    assert told("table", "table") == (
        "The agent put the mug (0.50–1.50 s) and the bowl (2.50–3.50 s) on the table with the "
        "right hand."
    )


def test_another_place_begins_another_list() -> None:
    text = told("table", "table", "shelf", timed=False)
    assert text == (
        "The agent put the mug and the bowl on the table with the right hand and put the bottle on "
        "the shelf."
    )
    goals = [step.call.objects for step in steps_of(text)]
    assert goals == [("mug", "bowl", "table"), ("bottle", "shelf")]


@pytest.mark.parametrize("timed", [True, False])
def test_a_list_is_not_too_long_and_names_a_numbered_thing_without_article(
    timed: bool,
) -> None:
    text = told(*["table"] * 13, timed=timed, late=8)
    first, second = steps_of(text)
    assert (*first.call.objects[:-1], *second.call.objects[:-1]) == NAMES
    assert len(first.call.objects) == 9
    assert " cup 2" in text
    assert "the cup 2" not in text
    assert "Then the agent put" in text
    if timed:
        assert first.circumstances.window == (0.5, 15.5)


@pytest.mark.parametrize("timed", [True, False])
def test_a_noticed_pause_parts_a_list_and_is_told(timed: bool) -> None:
    text = told(*["table"] * 8, late=4, waits=1500, timed=timed)
    assert [len(step.call.objects) - 1 for step in steps_of(text)] == [4, 4]
    later = "About 16 s later, the agent put" if timed else "Later, the agent put"
    assert later in text
    assert "later" not in told(*["table"] * 8, late=4, waits=600, timed=timed).lower()


@given(st.lists(st.sampled_from(["table", "shelf"]), min_size=1, max_size=9))
def test_each_thing_is_told_once_with_its_place_and_time(places: list[str]) -> None:
    text = told(*places)
    found = [
        (name, step.call.objects[-1]) for step in steps_of(text) for name in step.call.objects[:-1]
    ]
    assert found == list(zip(NAMES, places, strict=False))
    assert spans(text) == [(2.0 * at + 0.5, 2.0 * at + 1.5) for at in range(len(places))]
    assert against_time(text) == []


def test_numbered_things_of_several_words_are_read_where_they_are_known() -> None:
    known = Vocabulary(WORDS.words, frozenset({"coffee_can", "coffee_can_2", "tuna", "carton"}))
    told_so = "The agent put the coffee can, coffee can 2, and the tuna in the carton."
    value = parse(told_so, known)
    assert isinstance(value, Instruction)
    assert value.call.objects == ("coffee_can", "coffee_can_2", "tuna", "carton")


def test_things_alike_are_numbered_in_the_order_in_which_they_are_told() -> None:
    names = ("tuna_2", "mug", "tuna", "tuna_3")
    kinds = {"mug": "mug"}
    things = tuple(replace(MUG, name=name, kind=kinds.get(name, "can")) for name in names)
    pieces = [
        Piece("MoveObjTo", 100 * at + 100, (name, "table"), features=PLACED)
        for at, name in enumerate(names)
    ]
    made = observation(
        "Put", {"right_hand": tuple(pieces)}, (*things, TABLE), frames=401, rate_hz=100.0
    )
    text = describe(made)
    order = [
        text.index(words)
        for words in ("a can of tuna", "the mug", "a second can of tuna", "a third can of tuna")
    ]
    assert order == sorted(order)
    known = Vocabulary(WORDS.words, frozenset({*names, "table"}))
    value = parse("The agent put a can of tuna and a third can of tuna on the table.", known)
    assert isinstance(value, Instruction)
    assert value.call.objects == ("tuna", "tuna_3", "table")
