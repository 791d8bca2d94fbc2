"""Files of claims: run by the command and by pytest, each capture and each claim for itself."""

import json
import shutil
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest
from typer.testing import CliRunner

from capar.claims.claims import read_motion_test, run_motion_test
from capar.cli import app
from capar.model.errors import CaparError, FileError

DEMO = Path(__file__).parents[1] / "capar" / "demo"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "drink").symlink_to(DEMO / "drink_from_mug")
    (tmp_path / "sip.motion.toml").write_text(
        'captures = ["dr*"]\n[[expect]]\nthat = "right_hand MoveObjTo(mug, head)"\n'
        '[[expect]]\nthat = "right_hand Hit"\n'
    )
    return tmp_path


def test_the_command_exits_with_one_if_a_claim_fails(folder):
    result = CliRunner().invoke(app, ["test", str(folder), "--json"])
    assert result.exit_code == 1
    (suite,) = json.loads(result.output)
    assert (suite["tests"], suite["failures"]) == (2, 1)
    assert [each["passed"] for each in suite["cases"]] == [True, False]


def with_pytest(folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
    named = {each.value for each in entry_points(group="pytest11")}
    plugin = [] if "capar.claims.pytest_plugin" in named else ["-p", "capar.claims.pytest_plugin"]
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *plugin, *options, "."],
        cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip


def test_pytest_collects_files_of_claims(folder):
    done = with_pytest(folder, "-q")
    assert done.returncode == 1, done.stdout + done.stderr
    assert "1 failed, 1 passed" in done.stdout
    assert "found: never" in done.stdout
    assert "Traceback" not in done.stdout


@pytest.fixture
def bundle(tmp_path: Path) -> Path:
    """Two takes of one capture; the second breaks off."""
    place = tmp_path / "bundle"
    shutil.copytree(DEMO / "drink_from_mug", place)
    lines = (place / "motion.csv").read_text().splitlines(keepends=True)
    (place / "whole.csv").write_text("".join(lines))
    (place / "short.csv").write_text("".join(lines[: len(lines) // 2]))
    text = (place / "capture.toml").read_text().replace('"motion.csv"', '"{take}.csv"')
    (place / "capture.toml").write_text(f'takes = ["whole", "short"]\n{text}')
    return place


def written(folder: Path, captures: str, *claims: str) -> Path:
    path = folder / "said.motion.toml"
    expected = "".join(f"[[expect]]\nthat = {json.dumps(each)}\n" for each in claims)
    path.write_text(f"captures = {captures}\n{expected}")
    return path


def captures_of(path: Path) -> list[str]:
    return [str(Path(each).name) for each in read_motion_test(path).captures]


def test_captures_are_named_from_the_root_or_from_the_folder(folder, tmp_path_factory):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    for pattern in (folder / "drink", folder / "dr*", folder / "dr*" / "capture.toml"):
        assert len(captures_of(written(elsewhere, json.dumps([str(pattern)]), "x"))) == 1
    assert captures_of(written(folder, '["drink", "dr*"]', "x")) == ["drink"]
    assert captures_of(written(folder, '"*"', "x")) == ["drink"]


def test_takes_are_captures_one_by_one_or_all(bundle):
    def named(pattern: str) -> list[str]:
        return captures_of(written(bundle.parent, json.dumps([pattern]), "x"))

    assert named("bundle:short") == ["bundle:short"]
    assert named(f"{bundle}:whole") == ["bundle:whole"]
    assert named("bun*:*") == ["bundle:whole", "bundle:short"]
    with pytest.raises(FileError, match="Its takes are: whole, short"):
        named("bundle:long")


def test_each_take_is_judged_for_itself(bundle):
    path = written(bundle.parent, '["bundle:*"]', "right_hand ResumePosture")
    whole, short = run_motion_test(read_motion_test(path))
    assert (whole.capture, whole.holds) == ("drink_from_mug_tall_man_whole", True)
    assert (short.capture, short.holds) == ("drink_from_mug_tall_man_short", False)


def test_a_bundle_of_takes_says_that_one_is_to_be_named(bundle):
    path = written(bundle.parent, '["bundle"]', "right_hand Reach")
    (verdict,) = run_motion_test(read_motion_test(path))
    assert not verdict.holds
    assert "has several takes" in verdict.mistake


BAD = ("right_hand Lfit(mug)", "no right_hand Drink(mugg, head)", "right_hand: lift")


def test_a_claim_that_cannot_be_judged_hides_no_other(folder):
    path = written(folder, '["drink"]', BAD[0], "right_hand Hit", *BAD[1:], "right_hand Reach")
    result = CliRunner().invoke(app, ["test", str(path), "--json"])
    assert isinstance(result.exception, CaparError)
    assert "3 claims could not be judged" in str(result.exception)
    (suite,) = json.loads(result.stdout)
    assert [each["passed"] for each in suite["cases"]] == [False, False, False, False, True]
    assert [bool(each["error"]) for each in suite["cases"]] == [True, False, True, True, False]
    assert "Did you mean 'Lift'" in suite["cases"][0]["error"]
    assert "Did you mean 'mug'" in suite["cases"][2]["error"]
    told = CliRunner().invoke(app, ["test", str(path)]).stdout
    assert (told.count("ERROR"), told.count("FAILS"), told.count("holds")) == (3, 1, 1)


def test_a_file_that_cannot_be_used_hides_no_other(folder):
    (folder / "a.motion.toml").write_text("captures = 3")
    result = CliRunner().invoke(app, ["test", str(folder)])
    assert isinstance(result.exception, FileError)
    assert "holds  drink_from_mug_tall_man: right_hand MoveObjTo(mug, head)" in result.stdout


def test_pytest_names_takes_and_tells_mistakes_without_a_traceback(bundle):
    written(bundle.parent, '["bundle:*"]', "right_hand Reach", BAD[0])
    (bundle.parent / "a.motion.toml").write_text("captures = 3")
    done = with_pytest(bundle.parent, "-v", "--continue-on-collection-errors")
    assert "bundle:short: right_hand Reach PASSED" in done.stdout
    assert "2 failed, 2 passed, 1 error" in done.stdout
    assert "no primitive 'Lfit'" in done.stdout
    assert "captures is no list of patterns" in done.stdout
    assert "Traceback" not in done.stdout
    assert "motion_tests.py" not in done.stdout


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("captures = 3", "captures is no list"),
        ('captures = ["nowhere_*"]\n[[expect]]\nthat = "x"', "no capture matches"),
        ('captures = ["*"]', "expects nothing"),
        ('captures = ["*"]\n[[expect]]\nthis = "x"', "has no that"),
        ('capture = ["*"]', "unknown key 'capture'"),
        ("captures = [", "is no TOML"),
    ],
)
def test_a_file_that_cannot_be_used_says_why(tmp_path, text, message):
    path = tmp_path / "x.motion.toml"
    path.write_text(text)
    with pytest.raises(FileError, match=message):
        list(read_motion_test(path).captures)


def test_the_shipped_example_holds():
    path = Path(__file__).parents[1] / "examples" / "drink.motion.toml"
    verdicts = list(run_motion_test(read_motion_test(path)))
    assert [each.claim for each in verdicts if not each.holds] == []
    assert len(verdicts) == 5
