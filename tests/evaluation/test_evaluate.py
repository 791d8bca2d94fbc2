"""Observations are compared with labels, link by link and pooled."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from observations import drink_from_mug, pick_up_with_both_hands
from typer.testing import CliRunner

from capar.cli import app
from capar.evaluation.labels import Label, Labels
from capar.evaluation.metrics import report
from capar.evaluation.plan import LabelMapping, Rule
from capar.evaluation.scoring import Case, compare
from capar.model.errors import CaparError, UnknownNameError
from capar.model.observation import Observation

HERE = Path(__file__).resolve().parents[2]
NAMES = ("Reach", "MoveObjTo", "MoveObj", "TouchWith", "ResumePosture")
SAME = LabelMapping(Path("m.toml"), tuple(Rule(each, each) for each in NAMES), {})
"""Each name is its own label."""


def case(seen: Observation, *, late_s: float = 0.0, links: tuple[str, ...] = ()) -> Case:
    """An observation whose labels are its own segments, later by some time."""
    times = np.arange(seen.frames) / seen.rate_hz
    marks = tuple(
        Label(each.ee, each.start_s + late_s, each.end_s + late_s, each.name)
        for each in seen.segments
        if not links or each.ee in links
    )
    return Case(seen, Labels(Path("labels.csv"), tuple(sorted(marks)), False), times)


def test_labels_equal_to_the_segments_score_100() -> None:
    result = report(compare([case(drink_from_mug()), case(pick_up_with_both_hands())], SAME))
    assert set(result["links"]) == {"left_hand", "right_hand"}
    for each in (*result["links"].values(), result["all"]):
        keys = ("accuracy", "macro_f1", "f1@10", "f1@25", "f1@50", "edit")
        assert [each[key] for key in keys] == [100.0] * 6
        assert each["onset_ms"]["median"] == each["offset_ms"]["p95"] == 0.0


def test_late_labels_are_an_early_bias_of_that_size() -> None:
    result = report(compare([case(drink_from_mug(), late_s=0.05)], SAME))["all"]
    assert result["onset_ms"] == {"matched": 6, "median": 50.0, "p95": 50.0, "bias": -50.0}
    assert result["edit"] == 100.0
    assert result["accuracy"] < 100.0


def test_captures_are_pooled_by_link() -> None:
    one = compare([case(drink_from_mug())], SAME)
    two = compare([case(drink_from_mug()), case(pick_up_with_both_hands())], SAME)
    assert two.links["right_hand"].true == one.links["right_hand"].true + 4
    assert two.links["left_hand"].true == 4
    assert two.whole.true == 14
    assert two.cases == ("DrinkFromMug", "PickUpWithBothHands")


def test_a_link_without_labels_is_reported_and_not_counted() -> None:
    found = compare([case(pick_up_with_both_hands(), links=("left_hand",))], SAME)
    assert set(found.links) == {"left_hand"}
    assert found.unlabelled == ("right_hand",)


def test_labels_of_a_link_that_was_not_observed_are_refused() -> None:
    good = case(drink_from_mug())
    foot = Labels(Path("labels.csv"), (Label("foot", 0.0, 1.0, "Reach"),), False)
    with pytest.raises(UnknownNameError) as raised:
        compare([Case(good.observation, foot, good.times)], SAME)
    assert raised.value.known == ["right_hand"]
    assert "labels.csv" in str(raised.value)


def test_links_may_be_called_otherwise_in_the_label_file() -> None:
    good = case(drink_from_mug())
    marks = tuple(Label("R", each.start, each.end, each.label) for each in good.labels.marks)
    renamed = Case(good.observation, Labels(Path("l.csv"), marks, False), good.times)
    found = compare([renamed], LabelMapping(SAME.path, SAME.rules, {"right_hand": "R"}))
    assert report(found)["links"]["R"]["accuracy"] == 100.0


def test_the_report_is_json_without_numbers_that_json_lacks() -> None:
    empty = Case(
        drink_from_mug(),
        Labels(Path("l.csv"), (Label("right_hand", 0.0, 1e-9, "Reach"),), False),
        np.array([5.0, 6.0] * 201),
    )
    json.dumps(report(compare([empty], SAME)), allow_nan=False)


def test_an_odd_number_of_arguments_says_how_to_pair_them() -> None:
    result = CliRunner().invoke(app, ["evaluate", "one", "--mapping", "m.toml"])
    assert isinstance(result.exception, CaparError)
    assert "each capture is followed by its label file" in str(result.exception)


def test_a_real_take_is_observed_and_scored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = Path(os.environ.get("CAPAR_DATA", HERE.parent / "shared" / "data"))
    labels = data / "bimacs_optitrack" / "csv" / "subject0_take0_labels.csv"
    place = HERE / "examples" / "bimacs_optitrack"
    if not labels.is_file() or not place.is_dir():
        pytest.skip("no recording bimacs_optitrack: set CAPAR_DATA to the folder that holds it")
    monkeypatch.setenv("CAPAR_DATA", str(data))
    mapping = tmp_path / "mapping.toml"
    mapping.write_text(
        'others = ["hold", "lift", "place", "pour", "retreat", "stir"]\n'
        '[[rule]]\nname = "Reach"\nlabel = "approach"\n[[rule]]\nname = "*"\nlabel = "idle"\n'
    )
    arguments = ["evaluate", f"{place}:take0", str(labels), "--mapping", str(mapping), "--json"]
    result = CliRunner().invoke(app, arguments, catch_exceptions=False)
    found = json.loads(result.stdout)
    assert set(found["links"]) == {"left_hand", "right_hand"}
    for each in found["links"].values():
        assert each["segments"]["true"] in {7, 10}
        assert each["frames"] == found["links"]["left_hand"]["frames"] > 600
        assert each["onset_ms"]["matched"] >= 1
