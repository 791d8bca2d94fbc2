"""What is turned over, set upright or made to face another way is told to be."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import MUG, Piece, observation
from tellings import spans, steps_of

from capar.model.facts import Posture, Touching, Travelled
from capar.model.locations import sampled_track
from capar.model.par import FeatureSet
from kb.language.describe import describe
from kb.language.thresholds import AROUND_RAD, OVER_RAD, UPRIGHT_RAD

OWN = FeatureSet("1", "1", "1", "hand", "0")


def told(name: str, *postures: tuple[float, float], turned: float = 0.0) -> str:
    """What is told of a mug that a hand moves, by how it leans and is turned [rad] each second."""
    frames = 100 * (len(postures) - 1)
    pieces = (Piece(name, frames, ("mug",), features=OWN),)
    facts = [
        Posture("mug", 100 * at, round(1000 * lean), round(1000 * spin))
        for at, (lean, spin) in enumerate(postures)
    ]
    ways = [Travelled("mug", 0, 0, 0), Travelled("mug", frames, 300, round(1000 * turned))]
    made = observation(
        "Turned",
        {"right_hand": pieces},
        (MUG,),
        facts=(*facts, *ways),
        frames=frames + 1,
        rate_hz=100.0,
    )
    (link,) = made.links
    own = tuple(replace(each, possessed=True) for each in link.segments)
    text = describe(replace(made, links=(replace(link, segments=own),)), timed=True)
    return text.removeprefix("The agent ")


def test_what_ends_over_is_turned_upside_down() -> None:
    assert told("MoveObj", (0.0, 0.0), (1.5, 0.0), (3.0, 0.0), (3.1, 0.0)) == (
        "turned the mug upside down with the right hand (0.00–2.00 s)."
    )


def test_what_stands_again_is_turned_upright() -> None:
    assert told("MoveObj", (0.0, 0.0), (3.0, 0.0), (3.0, 0.0), (0.1, 0.0)) == (
        "turned the mug upside down with the right hand (0.00–1.00 s), held it there "
        "(1.00–2.00 s), and turned it back upright (2.00–3.00 s)."
    )


def test_what_lay_is_turned_upright() -> None:
    assert told("MoveObj", (1.5, 0.0), (0.9, 0.0), (0.1, 0.0)).startswith("turned the mug upright")


def test_what_faces_another_way_is_turned_around_and_what_is_moved_aside_is_turned() -> None:
    assert "turned the mug around" in told("MoveObj", (0.0, 0.0), (0.0, 1.5), (0.0, 3.0))
    assert told("MoveObj", (0.0, 0.0), (0.0, 0.9)).startswith("turned the mug with")
    assert told("MoveObj", (0.0, 0.0), (0.0, 1.5)).startswith("turned the mug by about a quarter")
    assert told("MoveObj", (0.0, 0.0), (0.0, 0.2)).startswith("moved the mug with")


def test_what_turns_while_it_is_slid_is_told_beside_that() -> None:
    text = told("Slide", (0.0, 0.0), (0.0, 0.1), (0.0, 1.4), (0.0, 1.5), (0.0, 1.5))
    assert text == (
        "slid the mug with the right hand (0.00–4.00 s), turning it by about a quarter."
    )
    assert [step.call.action for step in steps_of(f"The agent {text}")] == ["Slide", "Turn"]
    assert "turning" not in told("Slide", (0.0, 0.0), (0.0, 0.3), (0.0, 0.5), (0.0, 0.5))


def test_what_goes_up_and_turns_much_beside_turning_about_is_turned_about() -> None:
    """Each segment ends as it turned so far along its way [rad]."""
    for up_rad, words in ((4.0, "turned the mug about with"), (1.0, "raised it")):
        frames = (0, 200, 300)
        pieces = (
            Piece("Turn", 200, ("mug",), features=OWN),
            Piece("Raise", 300, ("mug",), features=OWN),
        )
        turns = (0.0, 5.0, 5.0 + up_rad)
        facts = (
            *(Posture("mug", frame, 0, 0) for frame in frames),
            *(
                Travelled("mug", frame, 300, round(1000 * turn))
                for frame, turn in zip(frames, turns, strict=True)
            ),
        )
        made = observation(
            "Turned", {"right_hand": pieces}, (MUG,), facts=facts, frames=301, rate_hz=100.0
        )
        (link,) = made.links
        own = tuple(replace(each, possessed=True) for each in link.segments)
        text = describe(replace(made, links=(replace(link, segments=own),)))
        assert words in text
        assert ("raised" in text) is (up_rad < 2.0)


def test_what_is_lifted_and_turned_over_is_both() -> None:
    text = told("Lift", (0.0, 0.0), (3.0, 0.0))
    assert text.startswith("lifted the mug with the right hand (0.00–1.00 s), turning it upside")


def test_what_is_turned_over_while_it_is_lifted_is_told_beside_it() -> None:
    text = told("Lift", (0.0, 0.0), (0.0, 0.0), (3.0, 0.0), (3.0, 0.0))
    assert text == (
        "lifted the mug with the right hand (0.00–3.00 s), turning it upside down (1.00–2.00 s)."
    )
    assert [step.call.action for step in steps_of(f"The agent {text}")] == ["Lift", "Turn"]


def test_what_turns_much_and_ends_as_it_was_is_turned_about() -> None:
    assert told("Turn", (0.0, 0.0), (0.5, 0.4), turned=4.0).startswith("turned the mug about")
    assert told("Turn", (0.0, 0.0), (0.0, 1.0), turned=1.1).startswith("turned the mug with")


@given(st.lists(st.tuples(st.floats(0.0, 3.1), st.floats(-3.0, 3.0)), min_size=2, max_size=8))
def test_words_of_turning_agree_with_the_postures(postures: list[tuple[float, float]]) -> None:
    text = told("Lift", *postures)
    leans = [round(lean, 3) for lean, _ in postures]
    over = [lean > OVER_RAD for lean in leans]
    assert over[0] or ("upside down" in text) == any(over)
    if "upright" in text:
        assert max(leans) > UPRIGHT_RAD > min(leans)
    if "around" in text:
        assert not any(over)
        assert abs(postures[-1][1] - postures[0][1]) > AROUND_RAD - 0.001


def slid(
    *, begins_s: float, lasts_s: float, seen_s: tuple[float, ...], held: bool, size_m: float = 0.1
) -> str:
    """What is told of a thing that hands slide for four seconds, and turn by a quarter.

    Args:
        begins_s: When it begins to turn [s].
        lasts_s: For how long it turns, at an even rate [s].
        seen_s: When its posture was measured [s].
        held: Whether both hands have it, whose ways were kept, and turn with it.
    """
    ees = ("left_hand", "right_hand") if held else ("right_hand",)
    pieces = (Piece("Slide" if held else "Turn", 400, ("mug",), features=OWN),)
    turn = (begins_s, begins_s + lasts_s), (0.0, 1.5)
    facts = [
        Posture("mug", round(100 * time_s), 0, round(1000 * np.interp(time_s, *turn)))
        for time_s in seen_s
    ]
    large = replace(MUG, size_m=(size_m, size_m, size_m))
    links = dict.fromkeys(ees, pieces)
    made = observation("Slid", links, (large,), facts=tuple(facts), frames=401, rate_hz=100.0)
    own = tuple(
        replace(link, segments=tuple(replace(each, possessed=True) for each in link.segments))
        for link in made.links
    )
    angles = np.interp(np.arange(401) / 100.0, *turn)
    around = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(401)))
    sides = {"left_hand": -0.3, "right_hand": 0.3}
    tracks = [sampled_track(ee, 0.01, sides[ee] * around) for ee in ees if held]
    return describe(replace(made, links=own, tracks=tuple(tracks)), timed=True)


@given(st.floats(0.3, 2.0), st.floats(0.5, 1.5))
def test_a_turn_is_told_from_when_the_line_between_the_hands_turns_until_it_has(
    begins_s: float, lasts_s: float
) -> None:
    text = slid(begins_s=begins_s, lasts_s=lasts_s, seen_s=(0.0, 3.9), held=True)
    assert "with both hands (0.00–4.00 s), turning it by about a quarter (" in text
    start_s, end_s = spans(text)[1]
    assert abs(start_s - begins_s - 0.05 * lasts_s) < 0.03
    assert abs(end_s - begins_s - 0.95 * lasts_s) < 0.03


@given(st.floats(0.3, 2.0), st.floats(0.5, 1.5))
def test_a_turn_whose_posture_was_measured_often_is_told_by_that(
    begins_s: float, lasts_s: float
) -> None:
    often = tuple(np.arange(0.0, 4.01, 0.2))
    text = slid(begins_s=begins_s, lasts_s=lasts_s, seen_s=often, held=False)
    ((start_s, end_s),) = spans(text)
    assert abs(start_s - begins_s) < 0.3
    assert abs(end_s - begins_s - lasts_s) < 0.3


@pytest.mark.parametrize(
    ("size_m", "words"),
    [
        (0.1, "turned the mug by about a quarter with the right hand (0.00–4.00 s)."),
        (0.6, "moved the mug with the right hand (0.00–4.00 s), turning it by about a quarter."),
    ],
)
def test_when_a_large_thing_turned_is_not_told_where_that_is_not_known(
    size_m: float, words: str
) -> None:
    text = slid(begins_s=0.5, lasts_s=1.0, seen_s=(0.0, 4.0), held=False, size_m=size_m)
    assert text == f"The agent {words}"


def test_a_turn_lasts_until_the_thing_stays_as_it_is_at_the_end() -> None:
    """It turns beyond that, and back."""
    beyond = told("MoveObj", *((0.0, spin) for spin in (0.0, 0.0, 1.5, 3.0, 3.6, 3.0, 3.0)))
    straight = told("MoveObj", *((0.0, spin) for spin in (0.0, 0.0, 1.5, 3.0, 3.0, 3.0, 3.0)))
    ends = [float(text.split("–")[1].split(" ")[0]) for text in (straight, beyond)]
    assert ends[1] > ends[0] + 1.0


def test_what_is_taken_up_turned_about_and_set_down_in_one_segment_is_told_as_three() -> None:
    made = observation(
        "Turned",
        {
            "right_hand": (
                Piece("Turn", 400, ("mug",), features=OWN),
                Piece("ResumePosture", 500, ("mug",)),
            )
        },
        (MUG,),
        facts=(Touching("right_hand", "mug", 0, 410),),
        frames=501,
        rate_hz=100.0,
    )
    (link,) = made.links
    own = tuple(replace(each, possessed=each.name == "Turn") for each in link.segments)
    heights = np.interp(np.arange(501), (100, 200, 300, 400), (0.0, 0.3, 0.3, 0.0))
    way = sampled_track("mug", 0.01, np.column_stack((np.zeros((501, 2)), heights)))
    text = describe(replace(made, links=(replace(link, segments=own),), tracks=(way,)), timed=True)
    said = re.findall(r"(\w+) (?:the mug|it)", text)
    assert said == ["lifted", "turned", "put"]
    times = [(float(a), float(b)) for a, b in re.findall(r"\((\S+)–(\S+) s\)", text)]
    assert [before[1] for before in times[:-1]] == [after[0] for after in times[1:]]
    assert 1.0 <= times[0][0] < times[0][1] < 1.5
    assert 3.5 < times[-1][0] < times[-1][1] <= 4.0
