"""Names that come before one another in a circle are refused, with the circle and the remedy."""

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from capar.cli import app

RISING = 'fits(Segment, "Up") :-\n    fits(Segment, "Touch"),\n    rises(Segment, _).\n'
FALLING = 'fits(Segment, "Down") :-\n    fits(Segment, "Touch"),\n    comes_down(Segment, _).\n'
CASES = {
    "two": (
        'precedes("Up", "Lift").\nprecedes("Lift", "Up").\n',
        "Up precedes Lift, Lift precedes Up",
    ),
    "three": (
        'precedes("Up", "Push").\nprecedes("Push", "Up").\nprecedes("Up", "Pull").\n',
        "Up precedes Push, Push precedes Up",
    ),
    "mixed": (
        'specialises("Up", "Touch").\nprecedes("Touch", "Up").\n',
        "Touch precedes Up, Up specialises Touch",
    ),
    "longer": (
        'specialises("Up", "Lift").\nprecedes("MoveObj", "Up").\n',
        "MoveObj precedes Up, Up specialises Lift, Lift specialises Raise, "
        "Raise specialises MoveObj",
    ),
    "itself": ('precedes("Up", "Up").\n', "Up precedes Up"),
}


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["rules", *map(str, arguments)])


def written(folder: Path, name: str, ordering: str, rule: str) -> Path:
    path = folder / f"{name.lower()}.lp"
    path.write_text(
        f'%* {name}: a touch that goes {name.lower()}. *%\nprimitive("{name}").\n'
        f'verb("{name}", "touch").\n{ordering}{rule}',
        encoding="utf-8",
    )
    return path


def text_of(result: Result) -> str:
    return " ".join(f"{result.output} {result.exception or ''}".split())


@pytest.mark.parametrize("case", sorted(CASES))
@pytest.mark.parametrize("command", ["check", "add"])
def test_a_circle_is_refused_with_its_names_and_the_remedy(
    command: str, case: str, tmp_path: Path
) -> None:
    ordering, circle = CASES[case]
    path = written(tmp_path, "Up", ordering, RISING)
    rules = tmp_path / "rules"
    rules.mkdir()
    done = run(command, path, "--rules", rules)
    told = text_of(done)
    assert done.exit_code != 0
    assert f"closes a circle ({circle}): a segment that fits them all would get no name." in told
    assert "take this line out, or another one of the circle" in told
    assert not list(rules.glob("*.lp"))


def test_a_file_that_closes_a_circle_with_an_added_one_is_refused(tmp_path: Path) -> None:
    """The second file is sound by itself: the circle goes through the first one."""
    rules = tmp_path / "rules"
    rules.mkdir()
    written(rules, "Up", 'specialises("Up", "Touch").\n', RISING)
    ordering = 'specialises("Down", "Up").\nprecedes("Touch", "Down").\n'
    path = written(tmp_path, "Down", ordering, FALLING)
    for command in ("check", "add"):
        told = text_of(run(command, path, "--rules", rules))
        assert "(Touch precedes Down, Down specialises Up, Up specialises Touch)" in told
    assert [each.name for each in rules.glob("*.lp")] == ["up.lp"]


def test_files_put_beside_each_other_by_hand_count_only_without_a_circle(tmp_path: Path) -> None:
    written(tmp_path, "Up", 'precedes("Up", "Down").\n', RISING)
    written(tmp_path, "Down", 'precedes("Down", "Up").\n', FALLING)
    told = text_of(run("list", "--rules", tmp_path))
    assert "(Up precedes Down, Down precedes Up)" in told
    assert "so nothing was done" in told


def test_an_order_without_a_circle_passes(tmp_path: Path) -> None:
    path = written(tmp_path, "Up", 'specialises("Up", "Touch").\n', RISING)
    assert "closes a circle" not in text_of(run("check", path))
