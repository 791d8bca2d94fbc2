"""Counterfactuals: the fewest changes, all of them on demand, and each of them enough."""

from dataclasses import replace

import motions
import pytest

from capar.model.errors import RuleError, UnknownNameError
from capar.model.facts import Moving
from capar.pipelines.explanation import Explained, explained
from capar_rules.engine.profiles import profile
from capar_rules.explain.why_not import why_not, worlds_around
from capar_rules.lint.text_checks import known
from capar_rules.pars.inference import infer
from extractors.measure import measure


@pytest.fixture(scope="module")
def drink() -> Explained:
    return explained(motions.drink_from_mug(motions.TALL_MAN).capture, rules=profile("thesis"))


@pytest.fixture(scope="module")
def cup() -> Explained:
    return explained(motions.drink_from_mug(motions.TALL_MAN).capture, rules=profile())


def segment(seen: Explained, name: str, at: int = 0):
    return [each for each in seen.observation.segments if each.name == name][at]


def sentences(seen: Explained, was: str, name: str, at: int = 0) -> list[str]:
    found = why_not(seen.explainer, segment(seen, was, at), name, limit=10)
    return [each.sentence for each in found]


def test_one_change_of_motion_turns_a_move_into_a_touch(drink):
    (only,) = sentences(drink, "MoveObj", "TouchWith")
    assert only == "It would be TouchWith if the mug did not move."


def test_all_equally_small_answers_are_given_on_demand(drink):
    found = sentences(drink, "MoveObj", "MoveObjTo")
    assert len(found) == 2
    assert any("the mug did not touch the head at 2.3" in each for each in found)
    assert any("the mug touched the table at 2.5" in each for each in found)
    one = why_not(drink.explainer, segment(drink, "MoveObj"), "MoveObjTo")
    assert one[0].sentence in found


def test_no_smaller_change_is_enough(drink):
    """Every answer is of one size, and a name that differs in two features needs two changes."""
    found = why_not(drink.explainer, segment(drink, "MoveObjTo"), "TouchWith", limit=10)
    assert {len(each.changes) for each in found} == {2}
    assert all(any("moved(mug" in change.atom for change in each.changes) for each in found)


def test_made_so_in_the_facts_the_change_gives_the_name():
    """What slides would be touched, had it not moved: without its motion the rules say so."""
    capture = motions.slide_object(motions.TALL_MAN).capture
    facts = measure(capture).facts
    seen = explained(capture, rules=profile("thesis"))
    (only,) = why_not(seen.explainer, segment(seen, "MoveObj"), "TouchWith", limit=10)
    (change,) = only.changes
    assert not change.holds
    assert change.atom.startswith("moved(box,seg(right_hand,")
    still = [each for each in facts if not isinstance(each, Moving)]
    touched = infer(still, profile=profile("thesis")).links[0].segments
    assert [each.name for each in touched] == ["Reach", "Touch"]


def test_what_could_not_have_been_has_no_answer():
    """No body of the agent's own is in the scene, so that nothing could be drunk."""
    capture = motions.slide_object(motions.TALL_MAN).capture
    seen = explained(capture, rules=profile())
    moves = [each for each in seen.observation.segments if each.features.change_loc.startswith("1")]
    assert why_not(seen.explainer, moves[0], "Drink", limit=5) == ()


def test_a_course_is_explained_away_by_another_course_in_one_sentence():
    capture = motions.pick_up_with_both_hands(motions.TALL_MAN).capture
    seen = explained(capture, rules=profile())
    (only,) = why_not(seen.explainer, segment(seen, "Lift"), "Carry", limit=20)
    (change,) = only.changes
    assert "the box went aside, more than up or down" in change.sentence


def test_what_it_is_too_is_said_before_what_would_make_it_no_more(cup):
    """To touch with is to touch: the segment is a Touch, and its own name says more."""
    (only,) = why_not(cup.explainer, segment(cup, "TouchWith"), "Touch")
    assert only.sentence.startswith("It is a Touch too: TouchWith is more specific. It would be no")
    assert only.changes


def test_of_the_body_that_an_answer_no_longer_speaks_of_nothing_is_told(cup):
    """The hand that holds the mug need not be upright, or near, for the mug to be moved."""
    (only,) = why_not(cup.explainer, segment(cup, "Reach"), "MoveObjTo")
    assert len(only.changes) == 3
    assert [each.atom.split("(")[0] for each in only.changes] == ["moved", "reads", "reads"]


def test_what_held_in_truth_is_not_presupposed_otherwise(cup):
    """The mug stood on the table before it was taken, and lay there when it was let go."""
    for was, at, name in (("MoveObjTo", 0, "Lift"), ("MoveObjTo", 1, "PutDown")):
        (only,) = why_not(cup.explainer, segment(cup, was, at), name)
        assert not {"from_rest", "comes_to_lie"} & {
            each.atom.split("(")[0] for each in only.changes
        }
        assert any(each.atom.startswith("reads(") for each in only.changes)


def test_no_answer_is_empty_and_none_shows_an_atom(cup):
    for each in cup.observation.segments:
        for name in {*each.general, "Touch", "Lift", "Throw", "Rest", "Give", "Tilt"} - {each.name}:
            for found in why_not(cup.explainer, each, name):
                assert found.changes, (each.index, name)
                assert "(" not in found.sentence
                assert "_" not in found.sentence


def test_a_name_that_there_is_not_or_that_it_has_is_refused(drink):
    reach = segment(drink, "Reach")
    with pytest.raises(UnknownNameError, match="no primitive 'Grab'"):
        why_not(drink.explainer, reach, "Grab")
    with pytest.raises(RuleError, match="is Reach already"):
        why_not(drink.explainer, reach, "Reach")


TRIALS = (
    motions.drink_from_mug,
    motions.slide_object,
    motions.pick_up_with_both_hands,
    motions.stand_on_one_leg,
)


@pytest.mark.parametrize("trial", TRIALS, ids=lambda each: each.__name__)
@pytest.mark.parametrize("rules", ["extended", "thesis"])
def test_with_nothing_otherwise_each_segment_has_its_name_and_its_rule_lacks_nothing(trial, rules):
    seen = explained(trial(motions.TALL_MAN).capture, rules=profile(rules))
    assert seen.observation.segments
    for each in seen.observation.segments:
        assert worlds_around(seen.explainer, each), (each.ee, each.index, each.name)
        if each.known:
            (near,) = seen.nearest_rules(each, each.name)
            assert near.failing == (), each


def test_of_a_name_that_does_not_fit_the_nearest_rule_lacks_something(cup):
    names = {*known(cup.explainer.base.statements).primitives}
    for each in cup.observation.segments[1:4]:
        for name in sorted({"Lift", "Touch", "Drink", "Throw", "Rest", "Tilt", "Open"} & names):
            if name not in (each.name, *each.general):
                for near in cup.nearest_rules(each, name):
                    assert near.failing, (each.index, name)
                    assert all(one.sentence for one in near.failing)


def test_a_user_s_rule_without_sentences_is_stated_by_its_own_words(tmp_path):
    path = tmp_path / "nudge.lp"
    path.write_text(
        '%* Nudge: a short push. *%\nprimitive("Nudge").\nspecialises("Nudge", "MoveObj").\n'
        'fits(Segment, "Nudge") :- fits(Segment, "MoveObj"), not grand(Segment).\n'
        "grand(Segment) :- rises(Segment, _).\n"
    )
    rules = replace(profile(), added=(path,))
    seen = explained(motions.pick_up_with_both_hands(motions.TALL_MAN).capture, rules=rules)
    (near,) = seen.nearest_rules(segment(seen, "Lift"), "Nudge")
    assert "grand does not hold" in near.needed[0]
