"""What the command that explains the words of rules prints."""

import json

import pytest
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import UnknownNameError


@pytest.fixture(autouse=True)
def alone(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("CAPAR_ACTIONARY", raising=False)
    monkeypatch.delenv("CAPAR_RULES", raising=False)


def run(*arguments: str) -> str:
    result = CliRunner().invoke(app, ["rules", "words", *arguments], catch_exceptions=False)
    assert result.exit_code == 0
    return result.stdout


def test_all_words_stand_below_their_files():
    told = run()
    files = [each for each in told.splitlines() if each and not each.startswith(" ")]
    assert files[:2] == ["inputs.lp", "thresholds.lp"]
    assert len(files) == len(set(files))
    _, _, shifts = told.partition("vocabulary/shifts.lp\n")
    assert "  rises(Segment, Body)  it goes up, more than it goes aside\n" in shifts
    assert "  within this file alone: " in shifts


def test_one_word_is_told_with_its_file_and_its_rules():
    first, second, needs, third, *rule = run("carried_off").splitlines()
    assert first.startswith("carried_off(Segment, Object)  it moves in the hand")
    assert second.startswith("  explained in vocabulary/directions.lp:")
    assert needs.startswith("  an example needs, beside frames, links and tags: moving(Object, ")
    assert third.startswith("  defined at ")
    assert rule[0] == "    carried_off(Segment, Object) :-"
    assert rule[-1].endswith(".")


@pytest.mark.parametrize(
    ("word", "facts"),
    [
        ("borne_at", [["touching", "upward"]]),
        ("contains_at", [["lies"]]),
        ("toward_performer", [["apart"]]),
        ("hangs_at", [["lies", "touching"], ["touching", "upward"]]),
        ("moving", []),
    ],
)
def test_the_facts_that_an_example_of_a_word_needs_follow_from_its_rules(word, facts):
    (row,) = json.loads(run(word, "--json"))
    assert [[each.partition("(")[0] for each in way] for way in row["needs"]] == facts


def test_a_primitive_is_no_word_but_is_shown_by_its_own_command():
    result = CliRunner().invoke(app, ["rules", "words", "HandOver"])
    assert isinstance(result.exception, UnknownNameError)
    assert "capar rules show HandOver" in str(result.exception)


def test_words_are_told_as_json():
    rows = json.loads(run("--json"))
    (one,) = json.loads(run("carried_off", "--json"))
    assert one in rows
    assert (one["name"], one["arguments"]) == ("carried_off", ["Segment", "Object"])
    assert all(row["defined"] or row["line"] for row in rows if row["file"] != "any rule file")


def test_an_unknown_word_names_the_nearest():
    result = CliRunner().invoke(app, ["rules", "words", "carried_of"])
    assert isinstance(result.exception, UnknownNameError)
    assert "carried_off" in str(result.exception)
