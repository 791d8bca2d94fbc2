"""What rules change in what was observed: foretold by a comparison, then made so at once."""

import shutil
import signal
from pathlib import Path

import pytest
from bundles import DRINKING
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import FileError
from capar.model.facts import MovedBy
from capar.pipelines.observation import observe, observe_again
from capar.rulebook.changes import (
    add_reclassifying,
    bearing,
    captured,
    remove_reclassifying,
    renamed,
    stored,
)
from capar_rules.authoring.user_rules import unbroken
from capar_rules.engine.profiles import profile
from capar_rules.lint.checking import admitted_profile
from kb.actionary import Actionary
from kb.errors import StoreError
from kb.lookup.observations import source_files

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


EXAMPLES = """
%* Example: a cup is taken from a table and brought to the head.
   frames(0, 400).  rate_mhz(100000).  link(hand, hand, right).
   tag(cup, mobile).  tag(table, fixed).  tag(head, self).
   zero_crossing(hand, 0).  zero_crossing(hand, 100).  zero_crossing(hand, 200).
   zero_crossing(hand, 300).
   touching(hand, cup, 100, 400).  touching(cup, table, 0, 110).  touching(cup, head, 200, 400).
   moving(cup, 105, 300).
   => hand: Reach, Lift, MoveObj
*%

%* Counter-example: a cup is held in the air and put on a table.
   frames(0, 400).  rate_mhz(100000).  link(hand, hand, right).
   tag(cup, mobile).  tag(table, fixed).
   zero_crossing(hand, 0).  zero_crossing(hand, 100).  zero_crossing(hand, 200).
   touching(hand, cup, 0, 400).  touching(cup, table, 200, 400).
   moving(cup, 0, 200).
   => hand: MoveObjTo, TouchWith
*%
"""


def shaky(folder: Path) -> Path:
    """A capture whose hand jerks away from the mug that it holds, for a moment."""
    place = folder / "shaky"
    shutil.copytree(DRINKING, place)
    head, *rows = (place / "motion.csv").read_text().splitlines()
    at = head.split(",").index("right_hand_y")
    for frame in range(210, 222):
        cells = rows[frame].split(",")
        cells[at] = f"{float(cells[at]) - 0.15:.7f}"
        rows[frame] = ",".join(cells)
    (place / "motion.csv").write_text("\n".join([head, *rows]) + "\n")
    return place


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """A folder with a capture, its observation in an Actionary, and a rule."""
    shutil.copytree(DRINKING, tmp_path / "captures" / "drink")
    with Actionary.open(tmp_path / "actionary") as store:
        store.add(observe(tmp_path / "captures" / "drink", rules="thesis"))
    (tmp_path / "lift.lp").write_text(LIFT)
    return tmp_path


def test_the_segments_change_as_the_comparison_foretold(kept):
    place = str(kept / "actionary")
    before, after = profile("thesis"), admitted_profile("thesis", added=(kept / "lift.lp",))
    foretold = renamed(stored(place, profile="thesis").seen, before=before, after=after)
    assert [(each.index, each.before, each.after) for each in foretold] == [
        (1, "MoveObjTo", "Lift")
    ]
    _, effect = add_reclassifying(with_examples(kept), **adding(kept))
    assert (effect.changes, effect.others) == (foretold, ())
    with Actionary.open(place) as store:
        (there,) = store.observations()
        steps = store.complex_par(there.action).links[0].steps
    assert [each.action for each in steps][:2] == ["Reach", "Lift"]


def test_observations_of_another_profile_are_left_alone_and_said_so(kept):
    place = str(kept / "actionary")
    (kept / "hoist.lp").write_text(LIFT.replace("Lift", "Hoist"))
    command = ["rules", "diff", str(kept / "hoist.lp"), "--actionary", place]
    told = CliRunner().invoke(app, command, catch_exceptions=False)
    assert told.stdout == "segments that change: 0\n"
    assert told.stderr == "observations made with another profile, left alone: 1\n"


def test_a_segment_without_steadying_stays_so(tmp_path):
    capture = shaky(tmp_path / "captures")
    place = str(tmp_path / "actionary")
    raw = profile("extended", steady=False)
    with Actionary.open(place) as store:
        store.add(observe(capture, rules=raw))
        (known,) = store.observations()
    found = stored(place, profile="extended").seen[known.name]
    steadied = captured([str(capture)], rules=profile("extended"))[known.name]
    assert set(found.facts) != set(steadied.facts)
    with Actionary.open(place) as store:
        again = observe_again(
            source_files(store.store, known.name), known, found.facts, profile("extended"),
            [tmp_path / "captures"],
        )  # fmt: skip
    measured = tuple(each for each in again.facts if not isinstance(each, MovedBy))
    assert (again.rules, measured) == (raw.fingerprint, found.facts)


def with_examples(kept: Path) -> Path:
    path = kept / "lift.lp"
    path.write_text(LIFT + EXAMPLES)
    return path


def adding(kept: Path, **changed: object) -> dict[str, object]:
    return {
        "folder": kept / "rules",
        "actionary": str(kept / "actionary"),
        "base": "thesis",
        "beside": (),
        "captures": [kept / "captures"],
    } | changed


def test_a_rule_and_what_it_renames_come_together_and_go_together(kept):
    place = str(kept / "actionary")
    added, effect = add_reclassifying(with_examples(kept), **adding(kept))
    assert added == kept / "rules" / "lift.lp"
    assert [each.after for each in effect.changes] == ["Lift"]
    assert bearing(place, ["Lift"]) == 1
    with Actionary.open(place, read_only=True) as store:
        assert (
            store.observations()[0].rules == admitted_profile("thesis", added=(added,)).fingerprint
        )
    gone = remove_reclassifying(
        added, actionary=place, after=profile("thesis"), captures=[kept / "captures"]
    )
    assert [each.after for each in gone.changes] == ["MoveObjTo"]
    assert list((kept / "rules").iterdir()) == []
    assert bearing(place, ["Lift"]) == 0


def test_no_rule_is_added_where_the_captures_are_not_found(kept):
    with pytest.raises(FileError, match="nothing was renamed"):
        add_reclassifying(with_examples(kept), **adding(kept, captures=[kept / "actionary"]))
    assert list((kept / "rules").iterdir()) == []
    assert bearing(str(kept / "actionary"), ["Lift"]) == 0


@pytest.mark.parametrize("error", [StoreError("the disk is full"), KeyboardInterrupt()])
def test_no_rule_is_added_or_removed_where_the_store_fails(kept, monkeypatch, error):
    def fail(*arguments: object) -> None:
        raise error

    added, _ = add_reclassifying(with_examples(kept), **adding(kept))
    remains = added.read_text()
    monkeypatch.setattr("capar.rulebook.changes.replace_all", fail)
    with pytest.raises(type(error)):
        remove_reclassifying(
            added, actionary=str(kept / "actionary"), after=profile("thesis"),
            captures=[kept / "captures"],
        )  # fmt: skip
    assert [each.read_text() for each in (kept / "rules").iterdir()] == [remains]
    with pytest.raises(type(error)):
        add_reclassifying(with_examples(kept), **adding(kept, folder=kept / "other"))
    assert list((kept / "other").iterdir()) == []


def test_who_interrupts_is_heard_when_the_step_is_done():
    done = []
    with pytest.raises(KeyboardInterrupt), unbroken():
        signal.raise_signal(signal.SIGINT)
        done.append("the step")
    assert done == ["the step"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_takes_of_a_bundle_are_found_again(tmp_path):
    bundle = tmp_path / "captures" / "both"
    shutil.copytree(DRINKING, bundle)
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
    _, effect = add_reclassifying(with_examples(tmp_path), **adding(tmp_path))
    assert [(each.capture, each.after) for each in effect.changes] == [
        ("drink_from_mug_tall_man:take1", "Lift"),
        ("drink_from_mug_tall_man:take10", "Lift"),
    ]
    with Actionary.open(place, read_only=True) as store:
        assert len({each.rules for each in store.observations()}) == 1
