"""``capar explain`` as a person uses it: text, JSON, a picture, and why not."""

import json
import re
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import motions
import pytest
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import FileError, UnknownNameError
from capar.views.lettering import width_in

DEMO = str(Path(__file__).parents[2] / "capar" / "demo" / "drink_from_mug")
THESIS = ["--profile", "thesis"]


@cache
def read(*arguments: str) -> str:
    """What the command answers of the demo, asked once; for what neither writes nor is patched."""
    return answered(*arguments)


def answered(*arguments: str) -> str:
    result = CliRunner().invoke(app, ["explain", DEMO, *arguments])
    assert result.exit_code == 0, result.output
    return result.output


def test_every_segment_has_a_header_a_summary_and_what_moved_its_object():
    lines = read(*THESIS).splitlines()
    assert len(lines) == 12
    assert lines[3].startswith("MoveObjTo because the right hand touched the mug at 1.70 s and ")
    assert "; the mug moved; " in lines[3]
    assert "Nearest other name: " in lines[3]


def test_one_segment_has_the_table_of_its_conditions_and_a_tree_down_to_its_frames():
    text = read("right_hand/1", *THESIS)
    assert re.search(r"  the mug moved\n +distance of the mug .* cm  more than 1.0 cm\n", text)
    assert "- it is MoveObjTo  [frames 176 to 246]  (naming.lp:" in text
    assert "- contact of the mug with the head from" in text
    assert "[frames 243 to 268]" in text


def test_json_has_conditions_with_values_limits_and_units_and_the_nearest_other_name():
    (told,) = json.loads(read("right_hand/3", "--json"))
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


def test_json_has_the_whole_tree_with_every_atom():
    (told,) = json.loads(read("right_hand/1", "--json", *THESIS))
    assert told["name"] == "MoveObjTo"
    atoms = []
    waiting = [told["reason"]]
    while waiting:
        node = waiting.pop()
        atoms.append(node["atom"])
        waiting += node["because"]
    assert 'named(seg(right_hand,3),"MoveObjTo")' in atoms
    assert "touching(mug,head,243,268)" in atoms


def test_json_says_once_what_an_atom_was_derived_from():
    (told,) = json.loads(read("right_hand/1", "--json"))
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


def test_the_picture_has_a_row_for_each_sentence(tmp_path):
    path = tmp_path / "why.svg"
    answered("right_hand/1", "--svg", str(path), *THESIS)
    root = ElementTree.parse(path).getroot()
    rows = root.findall("{http://www.w3.org/2000/svg}text")
    assert len(rows) > 15
    assert answered("right_hand/1", "--svg", str(path), *THESIS)
    assert ElementTree.parse(path).getroot().get("height") == root.get("height")


def test_no_line_of_the_picture_is_wider_than_it(tmp_path):
    path = tmp_path / "why.svg"
    answered("--svg", str(path))
    root = ElementTree.parse(path).getroot()
    lines = list(root.iter("{http://www.w3.org/2000/svg}tspan"))
    width = float(root.get("width"))
    assert len(lines) > 100
    for each in lines:
        assert float(each.get("x")) + width_in(each.text, points=12) * 72 < width


def test_why_not_gives_the_nearest_rule_with_what_it_lacks():
    asked = ["right_hand/2", "--why-not", "MoveObjTo", *THESIS]
    one = answered(*asked).splitlines()
    assert one[0] == "Nearest rule: move_obj_to.lp:3 lacks"
    (row,) = json.loads(answered(*asked, "--json"))
    assert [each["sentence"] for each in row["rules"][0]["failing"]] == [one[1].strip()]
    assert (row["ee"], row["index"], row["is"]) == ("right_hand", 2, "MoveObj")


def test_why_not_without_a_segment_asks_of_each_that_has_another_name():
    lines = answered("--why-not", "MoveObjTo", *THESIS).splitlines()
    headers = [each for each in lines if each.startswith("right_hand/")]
    assert [each.split()[0][-1] for each in headers] == ["0", "2", "4", "5"]
    assert headers[0].endswith("Reach")
    assert lines.count("Nearest rule: move_obj_to.lp:3 lacks") >= 2


def test_json_gives_the_index_of_the_segment_that_an_atom_names_by_its_tick():
    (told,) = json.loads(read("right_hand/1", "--json", *THESIS))
    assert told["reason"]["atom"].startswith("named(seg(right_hand,3)")
    assert told["reason"]["segments"] == ["right_hand/1"]


def test_a_segment_that_there_is_not_is_refused_with_those_there_are():
    result = CliRunner().invoke(app, ["explain", DEMO, "right_hand/9", *THESIS])
    assert isinstance(result.exception, UnknownNameError)
    assert "right_hand/0" in str(result.exception)


@pytest.mark.parametrize("name", ["rules", "explain", "test"])
def test_the_commands_tell_how_they_are_used(name):
    result = CliRunner().invoke(app, [name, "--help"])
    assert result.exit_code == 0
    assert "Usage" in result.output


def test_an_end_effector_alone_means_all_of_its_segments_in_order(monkeypatch):
    capture = motions.pick_up_with_both_hands(motions.TALL_MAN).capture
    monkeypatch.setattr(
        "extractors.readers.bundle.capture_toml.read_capture", lambda place: capture
    )
    both = [each["ee"] for each in json.loads(answered("--json"))]
    told = json.loads(answered("left_hand", "--json"))
    assert {"left_hand", "right_hand"} == set(both)
    assert [each["ee"] for each in told] == ["left_hand"] * both.count("left_hand")
    assert [each["index"] for each in told] == list(range(len(told)))
    lines = answered("left_hand").splitlines()
    headers = [each for each in lines if each.startswith("left_hand/")]
    assert len(headers) == len(told) > 2
    asked = answered("left_hand", "--why-not", told[1]["name"]).splitlines()
    named = [each for each in asked if each.startswith("left_hand/")]
    assert len(named) == sum(each["name"] != told[1]["name"] for each in told)


def test_a_picture_of_another_format_is_refused_before_anything_is_computed(monkeypatch, tmp_path):
    monkeypatch.setattr("extractors.readers.bundle.capture_toml.read_capture", pytest.fail)
    path = tmp_path / "a.png"
    result = CliRunner().invoke(app, ["explain", DEMO, "--svg", str(path)])
    assert isinstance(result.exception, FileError)
    assert str(result.exception) == f"{path}: no picture format '.png'; there are: .svg."
    assert not path.exists()


def test_the_quantities_of_the_conditions_are_drawn_over_time(tmp_path):
    path = tmp_path / "measured.svg"
    text = answered("right_hand/3", "--plot", str(path))
    drawn = path.read_bytes()
    assert "right_hand/3" in text
    answered("right_hand/3", "--plot", str(path))
    assert path.read_bytes() == drawn


def test_only_one_segment_is_drawn_over_time_at_once(tmp_path):
    path = tmp_path / "measured.svg"
    result = CliRunner().invoke(app, ["explain", DEMO, "right_hand", "--plot", str(path)])
    assert result.exit_code == 2
    assert "draws one segment" in result.output
    assert not path.exists()
