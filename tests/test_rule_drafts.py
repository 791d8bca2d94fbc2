"""First drafts of rules, from a segment or from a feature set."""

import shutil

import pytest
from bundles import DRINKING

from capar.model.errors import CaparError
from capar.rulebook.drafts import rule_from_features, rule_from_segment
from capar_rules.authoring.user_primitives import try_rule
from capar_rules.engine.profiles import profile


def test_a_drafted_rule_names_the_segment_that_it_was_drafted_from(tmp_path):
    text = rule_from_segment(
        "Sip", f"{DRINKING}/right_hand/2", rules=profile("thesis"), general="MoveObj"
    )
    path = tmp_path / "sip.lp"
    path.write_text(text)
    assert 'feature_row("Sip", hand, "101", "101", "10", "00").' in text
    assert try_rule(path, base="thesis") == ()


def test_a_draft_can_be_added_where_the_only_other_segment_is_next_to_its_own(tmp_path):
    """The recording ends with the mug in the air; before that, the hand only reached for it."""
    lifted = shutil.copytree(DRINKING, tmp_path / "lifted") / "capture.toml"
    lifted.write_text("to_s = 2.15\n" + lifted.read_text())
    path = tmp_path / "ferry.lp"
    path.write_text(
        rule_from_segment("Ferry", f"{lifted.parent}/right_hand/1", rules=profile("thesis"))
    )
    assert "=> right_hand: Reach, Ferry" in path.read_text()
    assert try_rule(path, base="thesis") == ()


def test_a_feature_set_in_letters_is_read_or_refused():
    assert 'feature_row("Odd", any, "1", "1", "1", "0").' in rule_from_features(
        "Odd", "1,1,1,0", rules=profile("thesis")
    )
    with pytest.raises(CaparError, match="write START,END,CHANGE,FORCE"):
        rule_from_features("Odd", "1,1", rules=profile("thesis"))
    with pytest.raises(CaparError, match="over 1 objects"):
        rule_from_features("Odd", "11,1,1,0", rules=profile("thesis"))
