"""What is done again and again is told once: as one deed, with its pauses, or with how often."""

from collections import Counter
from dataclasses import replace
from itertools import groupby
from typing import Literal

from hypothesis import given
from hypothesis import strategies as st
from observations import MUG, RATE_HZ, Piece, observation
from tellings import steps_of

from capar.model.facts import Moving
from capar.model.par import FeatureSet
from kb.language import Instruction, parse
from kb.language.describe import describe
from kb.lexicon.english import past

MANY = ("Lift", "Raise", "Lower", "Tilt", "Shake", "Turn")


def _handled(
    *names: str, detail: Literal["steps", "summary"] = "steps", timed: bool = False
) -> str:
    """What is told of a mug that is handled so once the hand has reached for it."""
    own = FeatureSet("1", "1", "1", "hand", "0")
    features = dict.fromkeys((*MANY, "MoveObj"), own)
    pieces = [Piece("Reach", 50, ("mug",))]
    for index, name in enumerate(names, 2):
        pieces.append(Piece(name, 50 * index, ("mug",), features=features.get(name)))
    facts = (Moving("mug", 60, 50 * len(names) + 50),)
    seen = observation(
        "Handling",
        {"right_hand": tuple(pieces)},
        (MUG,),
        facts=facts,
        frames=50 * len(names) + 51,
        rate_hz=100.0,
    )
    right_hand = seen.links[0]
    own_grip = tuple(replace(each, possessed=each.index > 0) for each in right_hand.segments)
    seen = replace(seen, links=(replace(right_hand, segments=own_grip),))
    return describe(seen, detail=detail, timed=timed)


def test_verbs_of_one_thing_share_it() -> None:
    assert _handled("Lift", "Raise", "Lower") == (
        "The agent lifted, raised, and lowered the mug with the right hand."
    )
    assert _handled("Lift", "Raise") == (
        "The agent lifted the mug with the right hand and raised it."
    )


def test_what_is_done_again_is_said_to_be() -> None:
    assert _handled("Raise", "Lower", "Raise") == (
        "The agent raised the mug with the right hand, lowered it, and raised it again."
    )


def test_a_deed_that_was_only_paused_is_one_with_its_pauses() -> None:
    assert _handled("Shake", "Touch", "Shake") == (
        "The agent shook the mug with the right hand, with a pause."
    )
    paused = _handled("Shake", "Touch", "Shake", "Touch", "Shake")
    assert paused == "The agent shook the mug with the right hand, with two pauses."


def test_a_deed_that_was_paused_has_a_time_for_each_part() -> None:
    paused = _handled("Shake", "Touch", "Shake", timed=True)
    assert paused == ("The agent shook the mug with the right hand (0.50–1.00 s and 1.50–2.00 s).")
    read = parse(paused)
    assert isinstance(read, Instruction)
    assert read.circumstances.window == (0.5, 2.0)


def test_a_motion_that_goes_on_is_one_deed_however_many_segments_it_has() -> None:
    assert _handled("Shake", "Shake", "Shake") == "The agent shook the mug with the right hand."
    assert _handled("Shake", "Shake", detail="summary") == (
        "The agent shook the mug with the right hand."
    )


def test_a_block_that_recurs_is_counted() -> None:
    twice = "The agent tilted and lowered the mug with the right hand twice."
    assert _handled("Tilt", "Lower", "Tilt", "Lower") == twice
    assert _handled("Tilt", "Tilt", "Lower", "Tilt", "Tilt", "Lower") == twice


def test_a_summary_of_much_handling_says_each_verb_once() -> None:
    told = _handled("Raise", "Lower", "Raise", "Tilt", "Raise", "Lower", detail="summary")
    assert told == "The agent raised, lowered, and tilted the mug with the right hand."


def test_what_is_over_before_it_is_seen_goes_with_what_follows() -> None:
    own = FeatureSet("1", "1", "1", "hand", "0")
    parts = (("Lift", 100), ("Tilt", 110), ("Carry", 200))
    pieces = (
        Piece("Reach", 50, ("mug",)),
        *(Piece(name, end, ("mug",), features=own) for name, end in parts),
    )
    seen = observation("Brief", {"right_hand": pieces}, (MUG,), frames=201, rate_hz=100.0)
    (link,) = seen.links
    held = tuple(replace(each, possessed=each.index > 0) for each in link.segments)
    assert describe(replace(seen, links=(replace(link, segments=held),))) == (
        "The agent lifted the mug with the right hand and carried it."
    )


def test_what_is_not_to_and_fro_is_done_bit_by_bit_where_it_pauses() -> None:
    assert _handled("Turn", "Touch", "Turn") == (
        "The agent turned the mug bit by bit with the right hand."
    )


def test_a_summary_leaves_pauses_out() -> None:
    summary = _handled("Shake", "Touch", "Shake", detail="summary")
    assert summary == "The agent shook the mug with the right hand."


@given(st.lists(st.sampled_from(MANY), min_size=1, max_size=12))
def test_no_verb_is_left_untold(names: list[str]) -> None:
    told = _handled(*names) + _handled(*names, detail="summary")
    for name in names:
        assert past(name.lower()) in told


@given(st.lists(st.sampled_from(MANY), min_size=1, max_size=12))
def test_a_summary_tells_each_deed_once_in_order_of_time(names: list[str]) -> None:
    told = [step.call.action for step in steps_of(_handled(*names, detail="summary"))]
    assert told == list(dict.fromkeys(names))


@given(st.lists(st.sampled_from(MANY), min_size=1, max_size=12))
def test_what_is_counted_is_how_often_it_was_done_anew(names: list[str]) -> None:
    anew = Counter(name for name, _ in groupby(names))
    told = Counter[str]()
    for step in steps_of(_handled(*names)):
        told[step.call.action] += max(step.circumstances.count, 1)
    assert told == anew


def test_what_is_repeated_is_told_once_with_how_often() -> None:
    cycle = ("Reach", "Touch", "ResumePosture")
    pieces = tuple(
        Piece(cycle[index % 3], (index + 1) * 40, ("mug",)) for index in range(3 * len(cycle))
    )
    seen = observation("Thrice", {"right_hand": pieces}, (MUG,), frames=361, rate_hz=RATE_HZ)
    assert describe(seen) == ("The agent touched the mug with the right hand, three times in all.")


def test_what_is_done_often_and_changes_nothing_is_counted_in_a_summary() -> None:
    cycle = ("Reach", "Touch", "ResumePosture")
    pieces = tuple(Piece(cycle[index % 3], (index + 1) * 40, ("mug",)) for index in range(9))
    seen = observation("Thrice", {"right_hand": pieces}, (MUG,), frames=361, rate_hz=RATE_HZ)
    told = describe(seen, detail="summary")
    assert told == "The agent touched the mug with the right hand three times."
