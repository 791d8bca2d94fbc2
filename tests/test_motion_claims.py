"""Claims about captures, in words: true ones hold, false ones say what was found."""

from pathlib import Path

import motions
import pytest

from capar.claims.claims import ClaimError, judge, names_of
from capar.model.errors import UnknownNameError
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from capar_rules.engine.profiles import Profile

DEMO = Path(__file__).parents[1] / "capar" / "demo"


@pytest.fixture(scope="module")
def drink() -> Observation:
    return observe(motions.drink_from_mug(motions.TALL_MAN).capture, rules="thesis")


TRUE = (
    "right_hand MoveObjTo(mug, head)",
    "right_hand MoveObjTo(mug, _)",
    "right_hand MoveObjTo(mug, head) before right_hand MoveObjTo(mug, table)",
    "right_hand MoveObjTo(mug, table) after right_hand MoveObjTo(mug, head)",
    "head looks at mug while right_hand Reach(mug)",
    "head looks away from mug after right_hand Reach(mug)",
    "right_hand Reach begins before right_hand touches mug",
    "mug lets go of head before right_hand lets go of mug",
    "no right_hand Hit",
    "mug moves while mug touches head",
    "right_hand MoveObj lasts 0.1 to 0.3 s",
    "right_hand: Reach, MoveObjTo, MoveObj, MoveObjTo, TouchWith, ResumePosture",
    "right_hand: Reach(mug), ..., MoveObjTo(mug, table), ...",
    "right_hand Touch(mug, table)",
)
FALSE = (
    "right_hand MoveObjTo(mug, table) before mug touches head",
    "right_hand MoveObj lasts 0.3 to 2 s",
    "no mug touches head",
    "right_hand: Reach, ResumePosture",
    "right_hand Hit",
    "head looks at mug after right_hand ResumePosture",
)


@pytest.mark.parametrize("claim", TRUE)
def test_true_claims_hold(drink, claim):
    assert judge(claim, drink).holds, judge(claim, drink).found


@pytest.mark.parametrize("claim", FALSE)
def test_false_claims_do_not_and_say_what_was_found(drink, claim):
    verdict = judge(claim, drink)
    assert not verdict.holds
    assert verdict.found


@pytest.fixture(scope="module")
def lift() -> Observation:
    return observe(motions.pick_up_with_both_hands(motions.TALL_MAN).capture)


TRUE_OF_BOTH = (
    "both hands do Lift(box)",
    "both hands do MoveObj(box)",
    "left_hand and right_hand do Lift(box)",
    "right_hand and left_hand do Lower(box, table)",
    "both hands do Lift(box) before both hands do Lower(box, _)",
    "both hands do Touch(box) while left_hand touches box",
    "both hands do Lift lasts 0.3 to 1 s",
    "no both hands do Reach(box)",
    "no both hands do Drink(_)",
)
FALSE_OF_BOTH = (
    "both hands do Reach(box)",
    "both hands do Lift(table)",
    "both hands do Lower(box) before both hands do Lift(box)",
    "no both hands do Lift(box)",
)


@pytest.mark.parametrize("claim", TRUE_OF_BOTH)
def test_what_both_hands_do_can_be_claimed(lift, claim):
    assert judge(claim, lift).holds, judge(claim, lift).found


@pytest.mark.parametrize("claim", FALSE_OF_BOTH)
def test_what_both_hands_do_not_do_is_no_true_claim(lift, claim):
    assert not judge(claim, lift).holds


@pytest.mark.parametrize("claim", ["both hands do MoveObj(mug)", "both hands do Reach(mug)"])
def test_one_hand_alone_is_not_both(drink, claim):
    assert not judge(claim, drink).holds


@pytest.mark.parametrize(
    ("claim", "message"),
    [
        ("right hand takes the mug", "is no event"),
        ("right_hand Reach lasts 1.2.3 to 2 s", "is no event"),
        ("right_hand Reach lasts 2 to 1 s", "the shorter time first"),
        ("right_hand: reach", "is no step"),
        ("no mug touches mug", "nothing touches itself"),
        ("no right_hand and right_hand do Reach", "an end-effector twice"),
    ],
)
def test_a_claim_that_cannot_be_read_says_why(drink, claim, message):
    with pytest.raises(ClaimError, match=message):
        judge(claim, drink)


UNKNOWN = (
    ("left_hand Reach", "no acting end-effector 'left_hand'"),
    ("left_hand and right_hand do Reach(mug)", "no acting end-effector 'left_hand'"),
    ("both feet do Reach", "no pair of acting end-effectors 'both feet'"),
    ("right_hand Raech(mug)", "no primitive 'Raech'.*Did you mean 'Reach'"),
    ("both hands do Raech", "no primitive 'Raech'"),
    ("right_hand Lift(mug)", "no primitive 'Lift'"),
    ("right_hand MoveObjTo(mugg, head)", "no object 'mugg'.*Did you mean 'mug'"),
    ("right_hand MoveObjTo(_, haed)", "no object 'haed'"),
    ("mug touches cup", "no body 'cup'"),
    ("cup lets go of mug", "no body 'cup'"),
    ("cup moves", "no object 'cup'"),
    ("right_hand moves", "no object 'right_hand'"),
    ("head looks at cup", "no object 'cup'"),
    ("haed looks at mug", "no sensor that looks 'haed'"),
    ("right_hand looks at mug", "no sensor that looks 'right_hand'"),
    ("head looks away from cup", "no object 'cup'"),
)
FORMS = (
    "{}", "no {}", "{} lasts 0 to 9 s", "{} before right_hand Reach", "right_hand Reach while {}"
)  # fmt: skip


@pytest.mark.parametrize(("event", "message"), UNKNOWN)
def test_what_bears_no_such_name_is_refused_in_every_form_of_claim(drink, event, message):
    for form in FORMS:
        with pytest.raises(UnknownNameError, match=message) as told:
            judge(form.format(event), drink)
        assert isinstance(told.value, ClaimError)


@pytest.mark.parametrize(
    "claim",
    ["left_hand: Reach", "right_hand: Reach, Raech", "right_hand: Hit, Reach(cup)",
     "right_hand: ..., Reach(cup), ..."],
)  # fmt: skip
def test_a_sequence_of_unknown_names_is_refused_wherever_they_stand(drink, claim):
    with pytest.raises(UnknownNameError):
        judge(claim, drink)


def test_a_name_of_the_profile_that_fits_nothing_here_can_be_denied(drink):
    assert judge("no right_hand Hit(mug)", drink).holds
    assert judge("no right_hand Unknown", drink).holds


def test_the_names_of_a_user_s_rules_can_be_claimed(drink, tmp_path):
    rule = tmp_path / "squeeze.lp"
    rule.write_text('%* Squeeze: it is pressed. *%\nprimitive("Squeeze").\n')
    names = names_of(drink, rules=Profile("thesis", crossings_only=True, added=(rule,)))
    assert judge("no right_hand Squeeze(mug)", drink, names=names).holds
    with pytest.raises(ClaimError, match="no primitive 'Squeeze'"):
        judge("no right_hand Squeeze(mug)", drink)


def test_what_lasts_until_the_capture_ends_was_not_seen_to_end():
    touching = observe(motions.touch_from_rest(motions.WOMAN).capture, rules="thesis")
    assert judge("right_hand touches box", touching).holds
    assert not judge("right_hand lets go of box", touching).holds
    assert judge("no right_hand lets go of box", touching).holds
