"""Ten takes of two hands at a kitchen table agree with the labels that people gave."""

import os
from pathlib import Path

import pytest

from capar.evaluation.metrics import report
from capar.evaluation.plan import read_plan
from capar.evaluation.running import evaluate

ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("CAPAR_DATA", ROOT.parent / "shared" / "data"))
LABELS = DATA / "bimacs_optitrack" / "csv"
EXAMPLE = ROOT / "examples" / "bimacs_optitrack"

pytestmark = pytest.mark.skipif(not LABELS.exists(), reason=f"no recording at {LABELS}")


def test_each_hand_agrees_with_its_labels(monkeypatch: pytest.MonkeyPatch) -> None:
    """Takes 0 to 4 were developed on, takes 5 to 9 kept apart."""
    monkeypatch.setenv("CAPAR_DATA", str(DATA))
    found = report(evaluate(read_plan(EXAMPLE / "evaluation.toml")))
    assert [len(group["captures"]) for group in found["groups"].values()] == [5, 5]
    for group in found["groups"].values():
        assert set(group["links"]) == {"left_hand", "right_hand"}
        for scores in group["links"].values():
            assert scores["macro_f1"] >= 80.0
            assert scores["f1@10"] >= 90.0
