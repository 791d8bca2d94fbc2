"""Captures are paired with label files by patterns and by evaluation files."""

from pathlib import Path

import pytest

from capar.evaluation.labels import Kind
from capar.evaluation.plan import read_pairs, read_plan
from capar.model.errors import CaparError

TAKES = 'name = "c"\ntakes = ["take0", "take1", { take = "x1", object = "mug" }]\n'


@pytest.fixture
def bundle(tmp_path: Path) -> Path:
    (tmp_path / "capture.toml").write_text(TAKES)
    return tmp_path


def plan_of(bundle: Path, text: str) -> Path:
    path = bundle / "evaluation.toml"
    path.write_text(text)
    return path


def test_a_pattern_stands_for_each_take_that_fits(bundle: Path) -> None:
    pairs = read_pairs([f"{bundle}:take*", "labels/{take}.csv"])
    assert [(each.take, str(each.labels)) for each in pairs] == [
        ("take0", "labels/take0.csv"),
        ("take1", "labels/take1.csv"),
    ]


def test_other_words_of_a_take_are_filled_in_too(bundle: Path) -> None:
    (pair,) = read_pairs([f"{bundle}:x1", "{object}_{take}.csv"])
    assert str(pair.labels) == "mug_x1.csv"


def test_one_label_file_for_several_takes_is_refused(bundle: Path) -> None:
    with pytest.raises(CaparError, match="is one label file for 2 takes"):
        read_pairs([f"{bundle}:take*", "labels.csv"])


def test_a_pattern_that_no_take_fits_lists_the_takes(bundle: Path) -> None:
    with pytest.raises(CaparError, match="no take 'y\\*'; there are: take0, take1, x1"):
        read_pairs([f"{bundle}:y*", "{take}.csv"])


def test_an_evaluation_file_names_takes_groups_and_labels_beside_itself(bundle: Path) -> None:
    text = 'kind = "carries"\nlabels = "l/{take}.csv"\n[groups]\nzero = ["*0"]\nnone = ["q"]\n'
    plan = read_plan(plan_of(bundle, text))
    assert plan.kind is Kind.CARRIES
    assert [each.name for each in plan.pairs] == ["take0", "take1", "x1"]
    assert plan.pairs[0].labels == bundle / "l/take0.csv"
    assert plan.groups == {"zero": ("take0",)}


def test_takes_of_an_evaluation_file_can_be_picked(bundle: Path) -> None:
    path = plan_of(bundle, 'kind = "carries"\nlabels = "{take}.csv"\n')
    assert [each.name for each in read_plan(path, takes=["x*", "*1"]).pairs] == ["take1", "x1"]


def test_a_bundle_without_takes_is_called_by_its_folder(tmp_path: Path) -> None:
    (tmp_path / "capture.toml").write_text('name = "c"\n')
    (pair,) = read_plan(plan_of(tmp_path, 'kind = "events"\nlabels = "l.csv"\n')).pairs
    assert pair.name == tmp_path.name


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('kind = "dances"\nlabels = "l"\n', "evaluation.toml:1: no kind 'dances'"),
        ('labels = "l"\n', "'kind' is missing"),
        ('kind = "carries"\n', "names no labels"),
        ('kind = "carries"\nlabels = "${NOT_SET_X}/l"\n', "evaluation.toml:2: "),
        ('kind = "carries"\nlabels = "l"\ntakes = ["q*"]\n', "evaluation.toml:3: no take 'q*'"),
        ('kind = "carries"\nlabel = "l"\n', "evaluation.toml:2: no key 'label'"),
        ('kind = "carries"\nlabels = "l"\n[carries]\nwithin_s = -1.0\n', "evaluation.toml:4: "),
    ],
)
def test_a_bad_evaluation_file_is_refused_with_its_line(text: str, says: str, bundle: Path) -> None:
    with pytest.raises(CaparError) as raised:
        read_plan(plan_of(bundle, text))
    assert says in str(raised.value)
