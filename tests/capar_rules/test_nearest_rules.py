"""Why-not begins with the rule that fewest conditions keep from holding, and says which."""

import motions
import pytest
from typer.testing import CliRunner

from capar.cli import app
from capar.pipelines.explanation import Explained, explained
from capar_rules.engine.profiles import profile
from capar_rules.explain.nearest_rules import nearest_rules
from capar_rules.lint.text_checks import known

NAMES = ("Lift", "Touch", "Drink", "Throw", "Rest", "Give", "Tilt", "Reach", "Salute", "Open")


@pytest.fixture(scope="module")
def cup() -> Explained:
    return explained(motions.drink_from_mug(motions.TALL_MAN).capture, rules=profile())


def segment(seen: Explained, name: str, at: int = 0):
    return [each for each in seen.observation.segments if each.name == name][at]


def lacking(seen: Explained, was: str, name: str, at: int = 0) -> list[tuple[str, ...]]:
    return [each.failing for each in nearest_rules(seen.explainer, segment(seen, was, at), name)]


@pytest.mark.parametrize(
    "trial",
    [motions.drink_from_mug, motions.slide_object, motions.stand_on_one_leg],
    ids=lambda trial: trial.__name__,
)
@pytest.mark.parametrize("rules", ["extended", "thesis"])
def test_of_the_name_that_a_segment_has_some_rule_lacks_nothing(trial, rules):
    seen = explained(trial(motions.TALL_MAN).capture, rules=profile(rules))
    named = [each for each in seen.observation.segments if each.known]
    assert named
    for each in named:
        assert nearest_rules(seen.explainer, each, each.name)[0].failing == (), each


def test_of_a_name_that_does_not_fit_every_rule_lacks_something_the_nearest_first(cup):
    names = {*known(cup.explainer.base.statements).primitives}
    for each in cup.observation.segments[1:4]:
        for name in sorted({*NAMES} & names - {each.name, *each.general}):
            near = nearest_rules(cup.explainer, each, name)
            counts = [len(rule.failing) for rule in near]
            assert counts == sorted(counts), name
            assert all(counts), (each.index, name)


def test_the_way_to_the_mouth_lacks_but_one_condition_of_a_lift(cup):
    """The mug was at rest before and goes up; but its way ends at the head, so it is MoveObjTo."""
    assert lacking(cup, "MoveObjTo", "Lift") == [("had it fitted MoveObj",)]


def test_what_rests_at_the_start_lacks_motion_and_looks_at_nothing(cup):
    ((only,),) = lacking(cup, "Rest", "LookAt")
    assert only.startswith("had the right hand looked at something between 0.00 s and 0.5")
    ((only,),) = lacking(cup, "Rest", "Open")
    assert only.startswith("had something been on a hinge or a rail and more open at 0.5")


@pytest.mark.parametrize("name", ["Lift", "Drink", "Roll", "Salute", "Step"])
def test_searching_every_choice_of_conditions_finds_none_that_is_nearer(cup, name, monkeypatch):
    """What fails by itself is left out at once; trying all choices must give the same numbers."""
    found = {rule.rule: len(rule.failing) for rule in _rules(cup, name)}
    monkeypatch.setattr("capar_rules.explain.nearest_rules._unmet", lambda *_: frozenset())
    assert {rule.rule: len(rule.failing) for rule in _rules(cup, name)} == found


def _rules(seen: Explained, name: str):
    return nearest_rules(seen.explainer, segment(seen, "MoveObjTo"), name)


def test_a_user_s_rule_is_told_by_its_own_words(tmp_path):
    rule = tmp_path / "long_hold.lp"
    rule.write_text(
        '%* LongHold: an object is touched for a long time. *%\nprimitive("LongHold").\n'
        'specialises("LongHold", "TouchWith").\nverb("LongHold", "hold").\n'
        'fits(Segment, "LongHold") :-\n    fits(Segment, "TouchWith"),\n'
        "    rises(Segment, Object),\n    tag(Object, mobile).\n",
        encoding="utf-8",
    )
    capture = motions.drink_from_mug(motions.TALL_MAN).capture
    seen = explained(capture, rules=profile(added=(rule,)))
    (near,) = nearest_rules(seen.explainer, segment(seen, "TouchWith"), "LongHold")
    assert near.rule == "long_hold.lp:5"
    assert near.failing == ("had it been so that the mug went up, more than aside",)


def test_the_command_begins_with_the_nearest_rule_and_ends_with_those_further_off():
    import capar.demo

    demo = str(next(iter(capar.demo.__path__))) + "/drink_from_mug"
    result = CliRunner().invoke(app, ["explain", demo, "right_hand/2", "--why-not", "Reach"])
    assert result.exit_code == 0, result.output
    lines = [each for each in result.output.splitlines() if not each.startswith("note")]
    assert lines[0].startswith("Nearest rule: reach_on.lp:3 lacks 2 conditions: it would hold had")
    assert lines[1].startswith("It would be Reach had ") or "could have been" in lines[1]
    assert [each.split(":")[0] for each in lines[2:5]] == ["Further off"] * 3
