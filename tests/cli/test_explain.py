"""``capar explain`` as a person uses it: text, JSON, pictures, why not, and what is reserved."""

import json
import re
from pathlib import Path

import motions
import pytest
from bundles import DRINKING
from shell import refused, run
from write_demo import write_tables

THESIS = ["--profile", "thesis"]


def answered(*arguments: str) -> str:
    return run("explain", DRINKING, *arguments)


def test_one_segment_has_the_table_of_its_conditions_and_a_tree_down_to_its_frames():
    text = answered("right_hand/1", *THESIS)
    assert re.search(r"  the mug moved\n +distance of the mug .* cm  more than 1.0 cm\n", text)
    assert "- it is MoveObjTo  [frames 176 to 246]  (naming.lp:" in text
    assert "- contact of the mug with the head from" in text
    assert "[frames 243 to 268]" in text


def test_json_has_conditions_with_values_limits_and_units_and_the_nearest_other_name():
    (told,) = json.loads(answered("right_hand/3", "--json"))
    assert {
        "ee", "index", "name", "start_s", "end_s", "summary", "conditions", "nearest", "notes",
        "reason", "general", "definitions", "notices",
    } == set(told)  # fmt: skip
    assert told["name"] == "Drink"
    assert told["general"] == ["MoveObj"]
    measured = {
        one["quantity"]: one for condition in told["conditions"] for one in condition["measures"]
    }
    assert measured["leaning"]["value"] > measured["leaning"]["limit"] == pytest.approx(20, abs=0.1)
    assert measured["leaning"]["unit"] == "\N{DEGREE SIGN}"
    assert measured["leaning"]["relation"] == ">="
    assert measured["distance"]["bodies"] == ["mug", "head"] or len(measured) > 2
    assert told["nearest"]["name"] in told["definitions"]
    assert told["nearest"]["failing"]


def test_json_says_once_what_an_atom_was_derived_from():
    (told,) = json.loads(answered("right_hand/1", "--json"))
    nodes, waiting = [], [told["reason"]]
    while waiting:
        nodes.append(waiting.pop())
        waiting += reversed(nodes[-1]["because"])
    derived = [each["atom"] for each in nodes if each["because"]]
    repeated = [each["atom"] for each in nodes if each["repeated"]]
    assert len(set(derived)) == len(derived)
    assert repeated
    assert set(repeated) <= set(derived)
    assert not any(each["because"] for each in nodes if each["repeated"])


def test_why_not_gives_the_nearest_rule_with_what_it_lacks():
    asked = ["right_hand/2", "--why-not", "MoveObjTo", *THESIS]
    one = answered(*asked).splitlines()
    assert one[0] == "Nearest rule: move_obj_to.lp:3 lacks"
    (row,) = json.loads(answered(*asked, "--json"))
    assert [each["sentence"] for each in row["rules"][0]["failing"]] == [one[1].strip()]
    assert (row["ee"], row["index"], row["is"]) == ("right_hand", 2, "MoveObj")


def test_json_gives_the_index_of_the_segment_that_an_atom_names_by_its_tick():
    (told,) = json.loads(answered("right_hand/1", "--json", *THESIS))
    assert told["reason"]["atom"].startswith("named(seg(right_hand,3)")
    assert told["reason"]["segments"] == ["right_hand/1"]


def test_an_end_effector_alone_means_all_of_its_segments_in_order(monkeypatch):
    capture = motions.pick_up_with_both_hands(motions.TALL_MAN).capture
    monkeypatch.setattr(
        "extractors.readers.bundle.capture_toml.read_capture", lambda place: capture
    )
    both = json.loads(answered("--json"))
    told = [each for each in both if each["ee"] == "left_hand"]
    assert {"left_hand", "right_hand"} == {each["ee"] for each in both}
    assert [each["index"] for each in told] == list(range(len(told)))
    lines = answered("left_hand").splitlines()
    headers = [each for each in lines if each.startswith("left_hand/")]
    assert len(headers) == len(told) > 2
    asked = answered("left_hand", "--why-not", told[1]["name"]).splitlines()
    named = [each for each in asked if each.startswith("left_hand/")]
    assert len(named) == sum(each["name"] != told[1]["name"] for each in told)


def test_the_quantities_of_the_conditions_are_drawn_over_time(tmp_path):
    path = tmp_path / "measured.svg"
    text = answered("right_hand/3", "--plot", str(path))
    drawn = path.read_bytes()
    assert "right_hand/3" in text
    answered("right_hand/3", "--plot", str(path))
    assert path.read_bytes() == drawn


BUNDLE = """\
name = "touching"
unit = "m"
up = "z"

[files]
motion = "motion.csv"

[agent]
name = "anna"
kind = "woman"

[[sensor]]
name = "right_hand"
end_effector = "hand"
side = "right"
body = "right_hand"
shape = { mesh = "right_hand.obj" }

[[object]]
name = "box"
tag = "mobile"
body = "box"
shape = { box = [0.22, 0.16, 0.12], position = [0.0, 0.0, 0.06] }

[[object]]
name = "post"
tag = "fixed"
position = [3.0, 3.0, 0.0]
shape = { sphere = 0.1 }
"""


@pytest.fixture
def touching(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A touch, recorded with stand-ins for the shapes of both objects."""
    for each in ("CAPAR_ACTIONARY", "CAPAR_RULES"):
        monkeypatch.delenv(each, raising=False)
    write_tables(motions.touch_from_rest(motions.WOMAN).capture, tmp_path / "touching")
    (tmp_path / "touching" / "capture.toml").write_text(BUNDLE, encoding="utf-8")
    return tmp_path / "touching"


def test_descriptions_list_what_was_assumed_by_code(touching: Path) -> None:
    found = json.loads(run("describe", touching, "--json"))
    assert [each["code"] for each in found["notices"]] == ["stand-in-shape"] * 2
    assert found["notices"][0]["message"].startswith("'box' is a stand-in")


def test_explain_tells_what_was_assumed_of_the_bodies_that_its_segment_is_about(
    touching: Path,
) -> None:
    for arguments in ((), ("right_hand/1",), ("--why-not", "Hit")):
        notes = run("explain", touching, *arguments).partition("\nKnown with reservations:\n")[2]
        assert "box" in notes
        assert "post" not in notes
    for arguments in ((), ("--why-not", "Hit")):
        rows = json.loads(run("explain", touching, *arguments, "--json"))
        codes = [[each["code"] for each in row["notices"]] for row in rows]
        assert ["stand-in-shape"] in codes
        assert not any("post" in str(row["notices"]) for row in rows)


def test_a_segment_may_be_addressed_by_its_capture_as_that_was_typed() -> None:
    short = run("explain", DRINKING, "right_hand/2")
    assert run("explain", DRINKING, f"{DRINKING}/right_hand/2") == short
    assert "no capture 'other'" in refused("explain", DRINKING, "other/right_hand/2")
