"""Claims about captures, in words and in files: true ones hold, false ones say what was found."""

import json
import shutil
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import motions
import pytest
from bundles import DRINKING
from typer.testing import CliRunner

from capar.claims.claims import ClaimError, judge, read_motion_test, run_motion_test
from capar.cli import app
from capar.model.errors import CaparError, FileError, UnknownNameError
from capar.model.observation import Observation
from capar.pipelines.observation import observe


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
    "no both hands do Drink(_)",
)
FALSE_OF_BOTH = (
    "both hands do Reach(box)",
    "both hands do Lift(table)",
    "both hands do Lower(box) before both hands do Lift(box)",
    "no both hands do Lift(box)",
)


@pytest.mark.parametrize("claim", [*TRUE, *TRUE_OF_BOTH])
def test_true_claims_hold(drink, lift, claim):
    found = judge(claim, drink if claim in TRUE else lift)
    assert found.holds, found.found


@pytest.mark.parametrize("claim", [*FALSE, *FALSE_OF_BOTH])
def test_false_claims_do_not_and_say_what_was_found(drink, lift, claim):
    verdict = judge(claim, drink if claim in FALSE else lift)
    assert not verdict.holds
    assert verdict.found


@pytest.mark.parametrize(
    ("claim", "message"),
    [
        ("right hand takes the mug", "is no event"),
        ("right_hand Reach lasts 1.2.3 to 2 s", "is no event"),
        ("right_hand Reach lasts 2 to 1 s", "the shorter time first"),
        ("right_hand: reach", "is no step"),
        ("no mug touches mug", "nothing touches itself"),
        ("no right_hand and right_hand do Reach", "an end-effector twice"),
    ],
)
def test_a_claim_that_cannot_be_read_says_why(drink, claim, message):
    with pytest.raises(ClaimError, match=message):
        judge(claim, drink)


UNKNOWN = (
    ("left_hand and right_hand do Reach(mug)", "no acting end-effector 'left_hand'"),
    ("both feet do Reach", "no pair of acting end-effectors 'both feet'"),
    ("right_hand Raech(mug)", "no primitive 'Raech'.*Did you mean 'Reach'"),
    ("right_hand MoveObjTo(mugg, head)", "no object 'mugg'.*Did you mean 'mug'"),
    ("cup lets go of mug", "no body 'cup'"),
    ("right_hand moves", "no object 'right_hand'"),
    ("right_hand looks at mug", "no sensor that looks 'right_hand'"),
    ("head looks away from cup", "no object 'cup'"),
)
FORMS = (
    "{}", "no {}", "{} lasts 0 to 9 s", "{} before right_hand Reach", "right_hand Reach while {}"
)  # fmt: skip


@pytest.mark.parametrize(("event", "message"), UNKNOWN)
def test_what_bears_no_such_name_is_refused_in_every_form_of_claim(drink, event, message):
    for form in FORMS:
        with pytest.raises(UnknownNameError, match=message) as told:
            judge(form.format(event), drink)
        assert isinstance(told.value, ClaimError)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "drink").symlink_to(DRINKING)
    (tmp_path / "sip.motion.toml").write_text(
        'captures = ["dr*"]\n[[expect]]\nthat = "right_hand MoveObjTo(mug, head)"\n'
        '[[expect]]\nthat = "right_hand Hit"\n'
    )
    return tmp_path


def with_pytest(folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
    named = {each.value for each in entry_points(group="pytest11")}
    plugin = [] if "capar.claims.pytest_plugin" in named else ["-p", "capar.claims.pytest_plugin"]
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *plugin, *options, "."],
        cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip


@pytest.fixture
def bundle(tmp_path: Path) -> Path:
    """Two takes of one capture; the second breaks off."""
    place = tmp_path / "bundle"
    shutil.copytree(DRINKING, place)
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
    assert (whole.capture, whole.holds) == ("drink_from_mug_tall_man:whole", True)
    assert (short.capture, short.holds) == ("drink_from_mug_tall_man:short", False)


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
