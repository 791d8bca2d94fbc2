"""A person's word from the command line, the whole way: claimed, asked, told, scored, kept."""

import csv
import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from capar.cli import app
from capar.model.errors import CaparError, UnknownNameError

DEMO = Path(__file__).parents[2] / "capar" / "demo" / "drink_from_mug"
CAPTURE = "drink_from_mug_tall_man"


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(each) for each in arguments])


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An Actionary with the demo and a name, a border, a split and a join by Ada."""
    folder = tmp_path_factory.mktemp("corrected") / "actionary"
    assert run("observe", DEMO, "--actionary", folder, "--new").exit_code == 0
    for segment, *change in (
        (3, "--name", "Sip"),
        (1, "--start", "0.7"),
        (6, "--split", "3.5"),
        (4, "--join"),
    ):
        done = run(
            *("correct", f"{CAPTURE}/right_hand/{segment}", *change),
            *("--by", "Ada", "--actionary", folder),
        )
        assert done.exit_code == 0, done.output
    return folder


NAMES = ["Rest", "Reach", "MoveObjTo", "Sip", "MoveObjTo", "ResumePosture", "ResumePosture"]


def account(place: Path) -> list[dict[str, object]]:
    return json.loads(run("correct", CAPTURE, "--json", "--actionary", place).stdout)


def test_the_account_has_every_claim_and_who_makes_it(place: Path) -> None:
    told = account(place)
    assert [each["name"] for each in told] == NAMES
    assert [each["by"] for each in told] == ["Ada", "Ada", "", "Ada", "Ada", "Ada", "Ada"]
    assert (told[0]["end_s"], told[1]["start_s"]) == (0.7, 0.7)
    assert (told[5]["end_s"], told[6]["start_s"]) == (3.5, 3.5)


def test_questions_and_reports_say_so_on_request_alone(place: Path) -> None:
    for asked, sips in ((("--corrected",), 1), ((), 0)):
        done = run("query", "segments", "--json", *asked, "--actionary", place)
        found = [row["action"] for row in json.loads(done.stdout)]
        assert found.count("Sip") == sips
        assert (found == NAMES) == bool(asked)
        report = json.loads(
            run("report", "linguistics", "--format", "json", *asked, "--actionary", place).stdout
        )
        # joined with the move before it, the hold is no touching with any more
        (touching,) = (row for row in report["classes"] if row["number"] == "20")
        assert touching["segments"] == 1 - sips


def test_the_account_scores_the_rules_as_labels_without_a_mapping(
    place: Path, tmp_path: Path
) -> None:
    labels = tmp_path / "labels.csv"
    assert run("correct", CAPTURE, "--labels", labels, "--actionary", place).exit_code == 0
    rows = list(csv.DictReader(labels.open(encoding="utf-8")))
    assert [row["label"] for row in rows] == NAMES
    result = json.loads(run("evaluate", DEMO, labels, "--json").stdout)
    # labels and segments agree but where Ada said otherwise: in the sip, the hold, and 0.14 s
    differs = 0.242 + 0.213 + (0.7 - 0.561)
    assert result["all"]["accuracy"] == pytest.approx(100 * (1 - differs / 3.88), abs=1.0)
    assert "no rule gives the label 'Sip'" in result["notices"]


def test_labels_of_which_no_rule_gives_any_need_a_mapping(tmp_path: Path) -> None:
    path = tmp_path / "labels.csv"
    path.write_text("link,start_s,end_s,label\nright_hand,0.5,1.0,approach\n", encoding="utf-8")
    done = run("evaluate", DEMO, path)
    assert isinstance(done.exception, CaparError)
    assert "(approach); other labels of actions need --mapping FILE" in str(done.exception)


def test_claims_stay_when_the_capture_is_observed_again_and_this_is_said(place: Path) -> None:
    before = account(place)
    done = run("observe", DEMO, "--actionary", place)
    assert done.exit_code == 0
    assert f"Ada corrected some of these segments (`capar correct {CAPTURE}`)" in done.stderr
    assert account(place) == before


def test_an_observation_is_exported_with_the_claims_about_it(place: Path, tmp_path: Path) -> None:
    for ending in ("ttl", "nq", "jsonld"):
        file, copy = tmp_path / f"one.{ending}", tmp_path / ending
        run("export", "--observation", CAPTURE, file, "--actionary", place)
        done = run("import", file, "--actionary", copy, "--new")
        assert done.exit_code == 0, done.output
        assert account(copy) == account(place)


def test_a_name_of_no_rule_is_kept_and_noted_and_a_wrong_capture_answered(place: Path) -> None:
    one = ("correct", f"{CAPTURE}/right_hand/3", "--by", "Ada", "--actionary", place)
    done = run(*one, "--name", "Drnk")
    assert "note: no rule gives the name 'Drnk'; did you mean 'Drink'?" in done.stderr
    assert run(*one, "--name", "Sip").exit_code == 0
    wrong = run("correct", "drink_from_mug", "--actionary", place)
    assert isinstance(wrong.exception, UnknownNameError)
    assert f"there are: {CAPTURE}" in str(wrong.exception)
