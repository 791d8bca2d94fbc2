"""Names that come before one another in a circle are refused, with the circle and the remedy."""

from pathlib import Path

import pytest

from capar_rules.lint.checking import check, faults
from capar_rules.lint.findings import Finding

CASES = {
    'precedes("Up", "Lift").\nprecedes("Lift", "Up").\n': "Up precedes Lift, Lift precedes Up",
    'precedes("Up", "Push").\nprecedes("Push", "Up").\nprecedes("Up", "Pull").\n':
        "Up precedes Push, Push precedes Up",
    'specialises("Up", "Touch").\nprecedes("Touch", "Up").\n':
        "Touch precedes Up, Up specialises Touch",
    'specialises("Up", "Lift").\nprecedes("MoveObj", "Up").\n':
        "MoveObj precedes Up, Up specialises Lift, Lift specialises Raise, "
        "Raise specialises MoveObj",
    'precedes("Up", "Up").\n': "Up precedes Up",
    'specialises("Up", "Touch").\n': "",
}  # fmt: skip
"""Orderings that a file states, and the circle that they close."""


def written(folder: Path, name: str, ordering: str) -> Path:
    path = folder / f"{name.lower()}.lp"
    path.write_text(
        f'%* {name}: a touch. *%\nprimitive("{name}").\n{ordering}'
        f'fits(Segment, "{name}") :- fits(Segment, "Touch"), rises(Segment, _).\n'
    )
    return path


def circles(found: tuple[Finding, ...]) -> list[str]:
    return [each.message for each in found if each.code == "circular"]


@pytest.mark.parametrize("ordering", CASES)
def test_a_circle_is_refused_with_its_names(ordering: str, tmp_path: Path) -> None:
    found = circles(faults([written(tmp_path, "Up", ordering)], profile="extended"))
    circle = CASES[ordering]
    assert bool(found) == bool(circle)
    assert any(f"closes a circle ({circle}): a segment" in each for each in found) == bool(circle)


def test_a_file_that_closes_a_circle_with_another_one_is_refused(tmp_path: Path) -> None:
    """The second file is sound by itself: the circle goes through the first one."""
    up = written(tmp_path, "Up", 'specialises("Up", "Touch").\n')
    down = written(tmp_path, "Down", 'specialises("Down", "Up").\nprecedes("Touch", "Down").\n')
    told = " ".join(circles(check(down, beside=[up])))
    assert "(Touch precedes Down, Down specialises Up, Up specialises Touch)" in told
