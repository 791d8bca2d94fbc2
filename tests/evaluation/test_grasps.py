"""Passes, changes of hands over the table and regrasps, beside what pictures of two takes show."""

from pathlib import Path

import pytest
from motion_files import recordings_folder

from capar.evaluation.events import OVER_TABLE, PASS, REGRASP
from capar.evaluation.metrics import report
from capar.evaluation.plan import read_plan
from capar.evaluation.running import evaluate

HANDS = Path(__file__).parents[2] / "examples" / "manipnet"


@pytest.mark.parametrize(
    ("take", "kinds", "regrasps", "extra"),
    [
        ("cup1", {PASS: 2, OVER_TABLE: 0, REGRASP: 13}, 10, 1),
        ("mug1", {PASS: 0, OVER_TABLE: 3, REGRASP: 9}, 6, 0),
    ],
)
def test_hands_change_on_cup_and_mug_where_the_pictures_show_it(
    take: str, kinds: dict[str, int], regrasps: int, extra: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every pass and change over the table is found; missed are shifts by a hand's width at most.

    The mug never goes from hand to hand in the air: one hand always puts it down before.
    """
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    events = report(evaluate(read_plan(HANDS / "evaluation.toml", takes=[take])))["events"]
    assert {name: each["seen"] for name, each in events.items()} == kinds
    for name in (PASS, OVER_TABLE):
        assert events[name]["found"] == kinds[name]
        assert events[name]["extra"] == 0
    assert events[REGRASP]["found"] >= regrasps
    assert events[REGRASP]["extra"] <= extra
