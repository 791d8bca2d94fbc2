"""The commands about words, as a person uses them."""

import json
import re
from pathlib import Path

import pytest
from bundles import DRINKING
from shell import capar, run

from capar.model.errors import CaparError, UnknownNameError

EXAMPLE = Path(__file__).parents[1] / "kb" / "lexicon" / "example-18.1.xml"


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No Actionary and no rules of somebody's own stand around."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("CAPAR_ACTIONARY", raising=False)
    monkeypatch.delenv("CAPAR_RULES", raising=False)


def test_describe_tells_the_demo() -> None:
    told = run("describe", DRINKING)
    assert "lifted it to the head" in told
    assert told.count("\n") == 1
    timed = json.loads(run("describe", DRINKING, "--timed", "--detail", "summary", "--json"))
    assert " s)" in timed["description"]


def test_parse_prints_an_instruction_or_a_query() -> None:
    value = json.loads(run("parse", "put the mug on the table with the left hand", "--json"))
    assert value["call"]["action"] == "MoveObjTo"
    assert value["call"]["objects"] == ["mug", "table"]
    assert value["ee"] == "left_hand"
    assert "SELECT DISTINCT ?performer" in run("parse", "who moved the mug?")


def test_verb_tells_what_it_knows() -> None:
    told = run("verb", "carry")
    assert "represented by Carry" in told
    assert "Levin 11.4 Carry Verbs" in told
    assert "Comes down to MoveObjTo." in told
    value = json.loads(run("verb", "shove", "--json"))
    assert value["standing"]["represented_by"] == []
    assert value["standing"]["general_only"]
    assert "Lift" in run("verb", "move", "--kinds")


def test_verbs_fit_a_segment() -> None:
    fits = json.loads(run("verb", "--for", f"{DRINKING}/right_hand/2", "--json"))
    assert fits[0]["verb"] == "move"
    assert fits[0]["reasons"]


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (("verb",), CaparError),
        (("verb", "zzz"), UnknownNameError),
        (("verb", "--for", "nowhere"), CaparError),
        (("verb", "--for", f"{DRINKING}/right_hand/99"), UnknownNameError),
        (("verb", "--for", f"{DRINKING}/third_hand/0"), UnknownNameError),
        (("parse", "mvoe the mug"), CaparError),
        (("lexicon", "import", "propbank", "."), UnknownNameError),
        (("report", "linguistics", "--actionary", "missing"), CaparError),
    ],
)
def test_a_mistake_is_an_error_of_ours(arguments: tuple[str, ...], error: type[CaparError]) -> None:
    assert isinstance(capar(*arguments).exception, error)


def test_verbnet_is_imported_once_and_then_answers(tmp_path: Path) -> None:
    folder = tmp_path / "verbnet"
    folder.mkdir()
    (folder / EXAMPLE.name).write_bytes(EXAMPLE.read_bytes())
    where = ("--actionary", str(tmp_path / "book"))
    first = run("lexicon", "import", "verbnet", str(folder), *where)
    assert "1 files with 2 classes and 3 members; 3 of 4 WordNet keys (75.0 %)" in first
    assert "had them already" in run("lexicon", "import", "verbnet", str(folder), *where)
    assert "VerbNet prod-18.1" in run("verb", "hit", *where)


def test_the_report_is_written_in_each_format(tmp_path: Path) -> None:
    target = tmp_path / "report.html"
    run("report", "linguistics", "--format", "html", "--out", str(target))
    assert target.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    assert run("report", "linguistics").startswith("Verbs that the system addresses")
    assert json.loads(run("report", "linguistics", "--json"))["classes"]


def test_answers_are_told_to_the_millisecond_and_machines_get_every_digit() -> None:
    run("observe", DRINKING, "--actionary", "book")
    asked = ("parse", "who moved the mug to the table?", "--actionary", "book")
    (answer,) = json.loads(run(*asked, "--json"))["answers"]
    exact = [each for each in answer.values() if isinstance(each, float)]
    assert any(each != round(each, 3) for each in exact)
    told = run(*asked).splitlines()[-1]
    assert f"duration: {round(answer['duration'], 3)}" in told
    assert not re.search(r"\.\d{4}", told)
