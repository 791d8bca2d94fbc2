"""Ten takes of two hands at a kitchen table agree with the labels that people gave."""

import os
from pathlib import Path

import pytest

from capar.evaluation.mapping import read_mapping
from capar.evaluation.scoring import evaluate, report

ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("CAPAR_DATA", ROOT.parent / "shared" / "data"))
LABELS = DATA / "bimacs_optitrack" / "csv"
EXAMPLE = ROOT / "examples" / "bimacs_optitrack"

pytestmark = pytest.mark.skipif(not LABELS.exists(), reason=f"no recording at {LABELS}")


@pytest.mark.parametrize("takes", [range(5), range(5, 10)], ids=["developed on", "kept apart"])
def test_each_hand_agrees_with_its_labels(takes: range, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(DATA))
    cases = [
        (f"{EXAMPLE}:take{take}", LABELS / f"subject0_take{take}_labels.csv") for take in takes
    ]
    found = report(evaluate(cases, read_mapping(EXAMPLE / "mapping.toml"), frames_of="motion"))
    assert set(found["links"]) == {"left_hand", "right_hand"}
    for scores in found["links"].values():
        assert scores["macro_f1"] >= 80.0
        assert scores["f1@10"] >= 90.0
