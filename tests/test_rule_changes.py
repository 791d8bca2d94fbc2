"""What rules change in what was observed: foretold by a comparison, then made so at once."""

import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import CaparError, FileError
from capar.observe import observe
from capar.rule_changes import (
    captured_facts,
    reclassified,
    renamed,
    rule_from_features,
    rule_from_segment,
    stored_facts,
)
from capar_rules.authoring import try_rule
from capar_rules.profiles import profile
from kb.actionary import Actionary

DEMO = Path(__file__).parents[1] / "capar" / "demo" / "drink_from_mug"

LIFT = """%* Lift: a possessed object is taken off what it stood on. *%
primitive("Lift").
specialises("Lift", "MoveObjTo").
fits(Segment, "Lift") :-
    fits(Segment, "MoveObjTo"),
    stood(Segment).
stood(seg(Hand, From)) :-
    segment(seg(Hand, From), From, _),
    dominant(seg(Hand, From), Object),
    reads(Hand, From, Object, Support, _),
    tag(Support, fixed).
"""


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """A folder with a capture, its observation in an Actionary, and a rule."""
    shutil.copytree(DEMO, tmp_path / "captures" / "drink")
    with Actionary.open(tmp_path / "actionary") as store:
        store.add(observe(tmp_path / "captures" / "drink", rules="thesis"))
    (tmp_path / "lift.lp").write_text(LIFT)
    return tmp_path


def test_stored_facts_are_those_that_were_measured(kept):
    seen = stored_facts(str(kept / "actionary"))
    (name,) = seen
    assert seen == captured_facts([str(kept / "captures" / "drink")])
    assert seen[name] == observe(DEMO, rules="thesis").facts


def test_the_segments_change_as_the_comparison_foretold(kept):
    place = str(kept / "actionary")
    before, after = profile("thesis"), profile("thesis", added=(kept / "lift.lp",))
    foretold = renamed(stored_facts(place), before=before, after=after)
    assert [(each.index, each.before, each.after) for each in foretold] == [
        (1, "MoveObjTo", "Lift")
    ]
    changed = reclassified(place, before=before, after=after, captures=[kept / "captures"])
    assert changed == foretold
    with Actionary.open(place) as store:
        (stored,) = store.observations()
        assert stored.rules == after.fingerprint
        steps = store.complex_par(stored.action).links[0].steps
    assert [each.action for each in steps][:2] == ["Reach", "Lift"]
    assert renamed(stored_facts(place), before=after, after=after) == ()


def test_nothing_is_renamed_when_the_files_have_changed(kept):
    place = str(kept / "actionary")
    motion = kept / "captures" / "drink" / "motion.csv"
    motion.write_text(motion.read_text() + "\n")
    with pytest.raises(FileError, match="nothing was renamed"):
        reclassified(
            place,
            before=profile("thesis"),
            after=profile("thesis", added=(kept / "lift.lp",)),
            captures=[kept / "captures"],
        )
    with Actionary.open(place, read_only=True) as store:
        assert store.observations()[0].rules == profile("thesis").fingerprint


def test_takes_of_a_bundle_are_found_again(tmp_path):
    bundle = tmp_path / "captures" / "both"
    shutil.copytree(DEMO, bundle)
    for take in ("take1", "take10"):
        shutil.copy(bundle / "motion.csv", bundle / f"{take}.csv")
    (bundle / "take1.csv").open("a").write("\n")
    table = (bundle / "capture.toml").read_text().replace("motion.csv", "{take}.csv")
    (bundle / "mine.toml").write_text(f'takes = ["take1", "take10"]\n{table}')
    (bundle / "capture.toml").unlink()
    (tmp_path / "lift.lp").write_text(LIFT)
    place = str(tmp_path / "actionary")
    with Actionary.open(place) as store:
        for take in ("take1", "take10"):
            store.add(observe(f"{bundle}/mine.toml:{take}", rules="thesis"))
    before, after = profile("thesis"), profile("thesis", added=(tmp_path / "lift.lp",))
    changed = reclassified(place, before=before, after=after, captures=[tmp_path / "captures"])
    assert [(each.capture, each.after) for each in changed] == [
        ("drink_from_mug_tall_man_take1", "Lift"),
        ("drink_from_mug_tall_man_take10", "Lift"),
    ]
    with Actionary.open(place, read_only=True) as store:
        assert {each.rules for each in store.observations()} == {after.fingerprint}


def test_the_commands_say_the_same(kept):
    options = ["--profile", "thesis", "--actionary", str(kept / "actionary")]
    rules = ["--rules", str(kept / "rules")]
    (kept / "rules").mkdir()
    lift = str(kept / "lift.lp")
    told = CliRunner().invoke(app, ["rules", "diff", lift, *options, *rules])
    assert "MoveObjTo -> Lift\n1 segment changes" in told.output
    refused = CliRunner().invoke(app, ["rules", "add", lift, *options, *rules])
    assert isinstance(refused.exception, CaparError)
    assert "lacks an Example" in str(refused.exception)


def test_a_drafted_rule_names_the_segment_that_it_was_drafted_from(tmp_path):
    text = rule_from_segment(
        "Sip", f"{DEMO}:right_hand/2", rules=profile("thesis"), general="MoveObj"
    )
    path = tmp_path / "sip.lp"
    path.write_text(text)
    assert 'feature_row("Sip", hand, "101", "101", "10", "00").' in text
    failures = try_rule(path, base="thesis")
    assert failures == (f"{path}: it lacks a Counter-example in which Sip does not occur",)


def test_a_feature_set_in_letters_is_read_or_refused():
    assert 'feature_row("Odd", any, "1", "1", "1", "0").' in rule_from_features("Odd", "1,1,1,0")
    with pytest.raises(CaparError, match="write START,END,CHANGE,FORCE"):
        rule_from_features("Odd", "1,1")
    with pytest.raises(CaparError, match="over 1 objects"):
        rule_from_features("Odd", "11,1,1,0")
