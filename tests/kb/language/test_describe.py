"""Descriptions read as a person would write them: golden texts, each read by us."""

import re
from collections.abc import Callable
from dataclasses import replace

import pytest
from motions import (
    TALL_MAN,
    WOMAN,
    Trial,
    drink_from_mug,
    hit,
    move_obj,
    move_obj_to,
    pick_up_with_both_hands,
    resume_posture,
    slide_object,
    touch,
    touch_cycle,
    touch_from_rest,
    touch_with,
)
from observations import MUG, TABLE, Piece, observation, with_unknown
from observations import drink_from_mug as observed_drinking
from observations import pick_up_with_both_hands as observed_picking_up

from capar.model.facts import Touching
from capar.model.observation import Border
from capar.model.par import FeatureSet
from capar.pipelines.observation import observe
from kb.language.describe import describe
from kb.lexicon.links import PrimitiveWords

ACTIONS = {
    drink_from_mug: (
        "reached for the mug with the right hand, lifted it to the mouth, drank, put it back on "
        "the table, held it there, and let go.",
        "lifted the mug to the mouth with the right hand, drank, and put it back on the table.",
    ),
    touch_from_rest: (
        "reached for the box with the right hand and touched it.",
        "touched the box with the right hand.",
    ),
    touch_cycle: (
        "reached for the box with the right hand, touched it, and took the hand away.",
        "touched the box with the right hand.",
    ),
    slide_object: (
        "reached for the box with the right hand and moved it on the table.",
        "pushed the box along the table with the right hand.",
    ),
    pick_up_with_both_hands: (
        "reached for the box with both hands, held it on the table, moved it about, held it there, "
        "and let go.",
        "lifted the box with both hands and put it back on the table.",
    ),
    hit: (
        "hit the drum with the right hand and took the hand away.",
        "hit the drum with the right hand.",
    ),
    move_obj: (
        "moved the stamp along the table with the right hand.",
        "pulled the stamp along the table with the right hand.",
    ),
    move_obj_to: (
        "brought the stamp to the table with the right hand and held it there.",
        "lowered the stamp with the right hand.",
    ),
    resume_posture: (
        "took the right hand away.",
        "touched the table with the right hand.",
    ),
    touch: ("touched the table with the right hand.",) * 2,
    touch_with: (
        "brought the stamp to the box with the right hand and held it there.",
        "lowered the stamp with the right hand and held it there.",
    ),
}
"""What the thesis's rules and ours let one say of each test action."""


@pytest.mark.parametrize("profile", [0, 1], ids=["thesis", "extended"])
@pytest.mark.parametrize("action", ACTIONS, ids=lambda each: each.__name__)
def test_an_action_is_told_as_it_was(action: Callable[..., Trial], profile: int) -> None:
    trial = action(TALL_MAN)
    told = describe(observe(trial.capture, rules=("thesis", "extended")[profile]))
    assert told == f"The tall man {ACTIONS[action][profile]}"


def test_the_same_is_told_of_another_performer() -> None:
    told = describe(observe(drink_from_mug(WOMAN).capture))
    assert told == f"The woman {ACTIONS[drink_from_mug][1]}"


def test_the_published_drinking_reads_as_one_sentence() -> None:
    assert describe(observed_drinking()) == (
        "The agent reached for the mug with the right hand, moved it to the mouth, drank, put it "
        "back on the table, held it there, and let go."
    )


def test_a_summary_tells_what_changed() -> None:
    assert describe(observed_drinking(), detail="summary") == (
        "The agent moved the mug to the mouth with the right hand, drank, and put it back on the "
        "table."
    )


def test_times_stand_behind_the_steps() -> None:
    assert describe(observed_drinking(), detail="summary", timed=True) == (
        "The agent moved the mug to the mouth with the right hand (1.72–2.38 s), drank "
        "(2.38–2.56 s), and put it back on the table (2.56–3.02 s)."
    )


def test_letting_go_is_a_moment() -> None:
    assert re.search(r"let go \(\d\.\d\d s\)\.$", describe(observed_drinking(), timed=True))


BOWL, BOTTLE = replace(MUG, name="bowl", kind="bowl"), replace(MUG, name="bottle", kind="bottle")
WORKS = FeatureSet("101", "101", "10", "hand", "00")


@pytest.mark.parametrize(("righted", "often"), [(False, ""), (True, " twice")])
def test_what_is_held_tipped_is_poured_from_all_the_time(righted: bool, often: str) -> None:
    pair = ("bottle", "bowl")
    pieces = (
        Piece("Reach", 50, ("bottle",)),
        Piece("MoveObjTo", 150, pair),
        Piece("Pour", 250, pair, features=WORKS),
        Piece("TouchWith", 400, pair),
        Piece("Pour", 450, pair, features=WORKS),
    )
    made = observation("Pouring", {"right_hand": pieces}, (BOWL, BOTTLE), frames=451, rate_hz=100.0)
    (link,) = made.links
    upright = (Border("rights", "bottle", "bottle"),)
    segments = tuple(
        replace(each, possessed=each.index > 0, ends=upright if righted else each.ends)
        for each in link.segments
    )
    told = describe(replace(made, links=(replace(link, segments=segments),)))
    assert told == (
        "The agent brought the bottle to the bowl with the right hand and poured "
        f"from it into the bowl{often}."
    )


def test_a_hand_that_stays_at_what_the_other_works_in_steadies_it() -> None:
    links = {
        "right_hand": (
            Piece("Reach", 50, ("mug",)),
            Piece("MoveObjTo", 150, ("mug", "bowl")),
            Piece("Stir", 400, ("mug", "bowl"), features=WORKS),
        ),
        "left_hand": (Piece("Reach", 60, ("bowl",)), Piece("Touch", 400, ("bowl",))),
    }
    made = observation("Stirring", links, (MUG, BOWL), frames=401, rate_hz=100.0)
    right, left = made.links
    segments = tuple(replace(each, possessed=each.index > 0) for each in right.segments)
    seen = replace(made, links=(replace(right, segments=segments), left))
    assert describe(seen).endswith("while the left hand steadied the bowl.")
    assert "steadied the bowl (0.60–4.00 s)" in describe(seen, timed=True), "as long as it stays"


def test_a_thing_is_called_by_the_words_of_its_kind() -> None:
    table = replace(MUG, name="largetable", kind="large_table")
    pieces = {"right_hand": (Piece("Reach", 50, ("largetable",)),)}
    seen = observation("Table", pieces, (table,), frames=51, rate_hz=100.0)
    assert describe(seen) == "The agent reached for the large table with the right hand."


def test_two_hands_that_do_the_same_are_told_once() -> None:
    assert describe(observed_picking_up()) == (
        "The agent reached for the box with both hands, held it on the table, picked it up, and "
        "let go."
    )


def test_what_no_rule_names_is_said_to_be_so() -> None:
    assert describe(with_unknown()) == (
        "The agent handled the mug and the table with the right hand in a way that no rule names."
    )


def _two_hands() -> str:
    links = {
        "right_hand": (
            Piece("Reach", 50, ("mug",)),
            Piece("MoveObjTo", 150, ("mug", "bowl")),
            Piece("ResumePosture", 200, ("mug",)),
        ),
        "left_hand": (Piece("Reach", 60, ("bowl",)), Piece("Touch", 200, ("bowl",))),
    }
    bowl = replace(MUG, name="bowl", kind="bowl")
    return describe(observation("Two", links, (MUG, bowl), frames=201, rate_hz=100.0))


def test_two_hands_that_do_different_things_are_told_side_by_side() -> None:
    assert _two_hands() == (
        "The agent brought the mug to the bowl with the right hand while the left hand touched the "
        "bowl."
    )


def test_a_purpose_is_told_where_nothing_fulfils_it() -> None:
    pieces = (Piece("Reach", 50, ("mug",)), Piece("MoveObj", 120, ("mug", "table"), "Clean"))
    facts = (Touching("mug", "table", 0, 120), Touching("right_hand", "mug", 50, 120))
    seen = observation(
        "Cleaning", {"right_hand": pieces}, (MUG, TABLE), facts=facts, frames=121, rate_hz=100.0
    )
    assert describe(seen) == ("The agent moved the mug on the table with the right hand to clean.")


def test_nothing_touched_is_told_as_nothing() -> None:
    seen = observation(
        "Idle", {"right_hand": (Piece("Unknown", 50, ()),)}, (MUG,), frames=51, rate_hz=100.0
    )
    assert describe(seen) == "The agent touched nothing."


def test_a_users_primitive_is_told_by_its_own_verb_or_by_what_it_specialises() -> None:
    features = FeatureSet("1", "1", "1", "hand", "0")
    pieces = (
        Piece("Reach", 50, ("mug",)),
        Piece("Nudge", 120, ("mug",), features=features, general=("MoveObj",)),
    )
    seen = observation("Nudging", {"right_hand": pieces}, (MUG,), frames=121, rate_hz=100.0)
    told = "The agent {} the mug with the right hand."
    words = [PrimitiveWords("Nudge", ("nudge",))]
    assert describe(seen, words=words) == told.format("nudged")
    assert describe(seen) == told.format("moved")


def test_several_things_touched_at_once_are_them() -> None:
    reached = FeatureSet("000", "110", "00", "hand", "00")
    touched = FeatureSet("110", "110", "00", "hand", "00")
    pieces = (
        Piece("Reach", 50, ("mug", "bowl"), features=reached),
        Piece("Touch", 90, ("bowl", "mug"), features=touched),
        Piece("Touch", 120, ("bowl", "mug"), features=touched),
    )
    bowl = replace(MUG, name="bowl", kind="bowl")
    seen = observation("Both", {"right_hand": pieces}, (MUG, bowl), frames=121, rate_hz=100.0)
    assert describe(seen) == (
        "The agent reached for the bowl and the mug with the right hand and touched them."
    )


def test_a_hand_that_moves_and_touches_nothing_is_told() -> None:
    free = {ee: (Piece("PostureChange", 50, ()),) for ee in ("right_hand", "left_hand")}
    seen = observation("Wave", free, (MUG,), frames=51, rate_hz=100.0)
    assert describe(seen) == "The agent moved both hands without touching anything."
