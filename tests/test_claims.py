"""Claims about captures, in words: true ones hold, false ones say what was found."""

import json
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import motions
import pytest
from typer.testing import CliRunner

from capar.claims import ClaimError, judge
from capar.cli import app
from capar.model.errors import FileError
from capar.model.observation import Observation
from capar.motion_tests import read_motion_test
from capar.observe import observe

DEMO = Path(__file__).parents[1] / "capar" / "demo"


@pytest.fixture(scope="module")
def drink() -> Observation:
    return observe(motions.drink_from_mug(motions.TALL_MAN).capture, rules="thesis")


TRUE = (
    "right_hand MoveObjTo(mug, head)",
    "right_hand MoveObjTo(mug, _)",
    "right_hand MoveObjTo(mug, head) before right_hand MoveObjTo(mug, table)",
    "right_hand MoveObjTo(mug, table) after right_hand MoveObjTo(mug, head)",
    "head looks at mug while right_hand Reach(mug)",
    "head looks away from mug after right_hand Reach(mug)",
    "right_hand Reach begins before right_hand touches mug",
    "mug lets go of head before right_hand lets go of mug",
    "no right_hand Hit",
    "mug moves while mug touches head",
    "right_hand MoveObj lasts 0.1 to 0.3 s",
    "right_hand: Reach, MoveObjTo, MoveObj, MoveObjTo, TouchWith, ResumePosture",
    "right_hand: Reach(mug), ..., MoveObjTo(mug, table), ...",
    "right_hand Touch(mug, table)",
)
FALSE = (
    "right_hand MoveObjTo(mug, table) before mug touches head",
    "right_hand MoveObj lasts 0.3 to 2 s",
    "no mug touches head",
    "right_hand: Reach, ResumePosture",
    "right_hand Hit",
    "head looks at mug after right_hand ResumePosture",
)


@pytest.mark.parametrize("claim", TRUE)
def test_true_claims_hold(drink, claim):
    assert judge(claim, drink).holds, judge(claim, drink).found


@pytest.mark.parametrize("claim", FALSE)
def test_false_claims_do_not_and_say_what_was_found(drink, claim):
    verdict = judge(claim, drink)
    assert not verdict.holds
    assert verdict.found


@pytest.fixture(scope="module")
def lift() -> Observation:
    return observe(motions.pick_up_with_both_hands(motions.TALL_MAN).capture)


TRUE_OF_BOTH = (
    "both hands do Lift(box)",
    "both hands do MoveObj(box)",
    "left_hand and right_hand do Lift(box)",
    "right_hand and left_hand do Lower(box, table)",
    "both hands do Lift(box) before both hands do Lower(box, _)",
    "both hands do Touch(box) while left_hand touches box",
    "both hands do Lift lasts 0.3 to 1 s",
    "no both hands do Reach(box)",
    "no both feet do Lift(box)",
)
FALSE_OF_BOTH = (
    "both hands do Reach(box)",
    "both hands do Lift(table)",
    "both hands do Lower(box) before both hands do Lift(box)",
    "no both hands do Lift(box)",
)


@pytest.mark.parametrize("claim", TRUE_OF_BOTH)
def test_what_both_hands_do_can_be_claimed(lift, claim):
    assert judge(claim, lift).holds, judge(claim, lift).found


@pytest.mark.parametrize("claim", FALSE_OF_BOTH)
def test_what_both_hands_do_not_do_is_no_true_claim(lift, claim):
    assert not judge(claim, lift).holds


@pytest.mark.parametrize("claim", ["both hands do MoveObj(mug)", "both hands do Reach(mug)"])
def test_one_hand_alone_is_not_both(drink, claim):
    assert not judge(claim, drink).holds


@pytest.mark.parametrize(
    ("claim", "message"),
    [
        ("right hand takes the mug", "is no event"),
        ("left_hand Reach", "no end-effector 'left_hand' acts"),
        ("left_hand and right_hand do Lift(mug)", "no end-effector 'left_hand' acts"),
        ("mug touches cup", "no body 'cup'"),
        ("right_hand: reach", "is no step"),
    ],
)
def test_a_claim_that_cannot_be_read_says_why(drink, claim, message):
    with pytest.raises(ClaimError, match=message):
        judge(claim, drink)


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


def test_pytest_collects_files_of_claims(folder):
    named = {each.value for each in entry_points(group="pytest11")}
    plugin = [] if "capar.pytest_plugin" in named else ["-p", "capar.pytest_plugin"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *plugin, "."],
        cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 1, done.stdout + done.stderr
    assert "1 failed, 1 passed" in done.stdout
    assert "found: never" in done.stdout
    assert "Traceback" not in done.stdout


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
