"""Why not another name: the rule that comes nearest, and what it lacks."""

from dataclasses import replace

import motions
import pytest
from combinations import EVERY

from capar.model.errors import RuleError, UnknownNameError
from capar.pipelines.explanation import Explained, explained
from capar_rules.engine.profiles import profile
from capar_rules.lint.text_checks import known


@pytest.fixture(scope="module")
def cup() -> Explained:
    return explained(motions.drink_from_mug(motions.TALL_MAN).capture, rules=profile())


def segment(seen: Explained, name: str, at: int = 0):
    return [each for each in seen.observation.segments if each.name == name][at]


def test_a_name_that_there_is_not_or_that_it_has_is_refused(cup):
    reach = segment(cup, "Reach")
    with pytest.raises(UnknownNameError, match="no primitive 'Grab'"):
        cup.why_not(reach, "Grab")
    with pytest.raises(RuleError, match="is Reach already"):
        cup.why_not(reach, "Reach")


TRIALS = [motions.drink_from_mug, motions.slide_object, motions.stand_on_one_leg]

if EVERY:
    TRIALS += [motions.pick_up_with_both_hands]


@pytest.mark.parametrize("trial", TRIALS, ids=lambda each: each.__name__)
@pytest.mark.parametrize("rules", ["extended", "thesis"])
def test_the_rule_for_the_name_that_a_segment_has_lacks_nothing(trial, rules):
    seen = explained(trial(motions.TALL_MAN).capture, rules=profile(rules))
    assert seen.observation.segments
    for each in seen.observation.segments:
        if each.known:
            (near,) = seen.explainer.nearest_rules(each, each.name)
            assert near.failing == (), each


def test_of_a_name_that_does_not_fit_the_nearest_rule_lacks_something(cup):
    names = {*known(cup.explainer.base.statements).primitives}
    for each in cup.observation.segments[1:4]:
        for name in sorted({"Lift", "Drink", "Throw", "Open"} & names):
            if name not in (each.name, *each.general):
                for near in cup.why_not(each, name):
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
    (near,) = seen.why_not(segment(seen, "Lift"), "Nudge")
    assert "grand does not hold" in near.needed[0]
