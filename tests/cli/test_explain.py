"""``capar explain`` as a person uses it: text, JSON, a picture, and why not."""

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import UnknownNameError

DEMO = str(Path(__file__).parents[2] / "capar" / "demo" / "drink_from_mug")
THESIS = ["--profile", "thesis"]


def answered(*arguments: str) -> str:
    result = CliRunner().invoke(app, ["explain", DEMO, *arguments])
    assert result.exit_code == 0, result.output
    return result.output


def test_every_segment_is_told_in_one_sentence():
    lines = answered(*THESIS).splitlines()
    assert len(lines) == 12
    assert lines[3].startswith("MoveObjTo, because the mug touched the head at 2.38 s")
    assert "the mug moved 0.60 m between 1.70 s and 2.38 s" in lines[3]


def test_one_segment_is_told_as_a_tree_down_to_its_frames():
    text = answered("right_hand/1", *THESIS)
    assert "- it is MoveObjTo  [frames 176 to 246]  (naming.lp:" in text
    assert "- contact of the mug with the head was measured from" in text
    assert "[frames 243 to 268]" in text


def test_json_has_the_whole_tree_with_every_atom():
    (told,) = json.loads(answered("right_hand/1", "--json", *THESIS))
    assert told["name"] == "MoveObjTo"
    atoms = []
    waiting = [told["reason"]]
    while waiting:
        node = waiting.pop()
        atoms.append(node["atom"])
        waiting += node["because"]
    assert 'named(seg(right_hand,3),"MoveObjTo")' in atoms
    assert "touching(mug,head,243,268)" in atoms


def test_the_picture_has_a_row_for_each_sentence(tmp_path):
    path = tmp_path / "why.svg"
    answered("right_hand/1", "--svg", str(path), *THESIS)
    root = ElementTree.parse(path).getroot()
    rows = root.findall("{http://www.w3.org/2000/svg}text")
    assert len(rows) > 15
    assert answered("right_hand/1", "--svg", str(path), *THESIS)
    assert ElementTree.parse(path).getroot().get("height") == root.get("height")


def test_why_not_gives_one_answer_or_all():
    one = answered("right_hand/1", "--why-not", "MoveObj", *THESIS).splitlines()
    every = answered("right_hand/1", "--why-not", "MoveObj", "--all", *THESIS).splitlines()
    assert (len(one), len(every)) == (1, 2)
    assert one[0] in every
    rows = json.loads(answered("right_hand/1", "--why-not", "MoveObj", "--json", *THESIS))
    assert rows[0]["sentence"] == one[0]
    assert rows[0]["changes"][0]["holds"] is True


def test_a_segment_that_there_is_not_is_refused_with_those_there_are():
    result = CliRunner().invoke(app, ["explain", DEMO, "right_hand/9", *THESIS])
    assert isinstance(result.exception, UnknownNameError)
    assert "right_hand/0" in str(result.exception)


@pytest.mark.parametrize("name", ["rules", "explain", "test"])
def test_the_commands_tell_how_they_are_used(name):
    result = CliRunner().invoke(app, [name, "--help"])
    assert result.exit_code == 0
    assert "Usage" in result.output
