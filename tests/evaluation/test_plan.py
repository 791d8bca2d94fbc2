"""Plans pair captures with labels, and a mapping gives each segment the label of its first rule."""

from pathlib import Path

import pytest
from observations import drink_from_mug

from capar.evaluation import Kind
from capar.evaluation.plan import (
    LabelMapping,
    check_names,
    labelled,
    read_mapping,
    read_pairs,
    read_plan,
)
from capar.model.errors import CaparError, UnknownNameError
from capar.model.observation import Observation

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


def test_an_evaluation_file_names_takes_groups_and_labels_beside_itself(bundle: Path) -> None:
    text = 'kind = "carries"\nlabels = "l/{take}.csv"\n[groups]\nzero = ["*0"]\nnone = ["q"]\n'
    plan = read_plan(plan_of(bundle, text))
    assert plan.kind is Kind.CARRIES
    assert [each.name for each in plan.pairs] == ["take0", "take1", "x1"]
    assert plan.pairs[0].labels == bundle / "l/take0.csv"
    assert plan.groups == {"zero": ("take0",)}


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


def mapping(folder: Path, text: str) -> LabelMapping:
    path = folder / "mapping.toml"
    path.write_text(text, encoding="utf-8")
    return read_mapping(path)


def rule(**conditions: str) -> str:
    return "[[rule]]\n" + "".join(f'{key} = "{value}"\n' for key, value in conditions.items())


REST = rule(name="*", label="rest")


def labels(seen: Observation, given: LabelMapping) -> list[str]:
    return [each.label for each in labelled(seen.links[0], given)]


@pytest.mark.parametrize(
    ("conditions", "fits"),
    [
        ({"name": "*", "dominant": "mug"}, [0, 1, 2, 3, 4, 5]),
        ({"name": "*", "dominant": "table"}, []),
        ({"name": "*", "object": "table"}, [3, 4]),
        ({"name": "*", "position": "before first"}, [0]),
        ({"name": "*", "position": "after last"}, [5]),
        ({"name": "*", "previous": ""}, [0]),
        ({"name": "*", "next": ""}, [5]),
        ({"name": "*", "previous": "MoveObjTo"}, [2, 4]),
        ({"name": "MoveObjTo", "next": "TouchWith"}, [3]),
        ({"name": "Reach", "next": "TouchWith"}, []),
    ],
)
def test_each_condition_picks_its_segments(
    conditions: dict[str, str], fits: list[int], tmp_path: Path
) -> None:
    given = mapping(tmp_path, rule(**conditions, label="yes") + REST)
    found = labels(drink_from_mug(), given)
    assert [index for index, each in enumerate(found) if each == "yes"] == fits


def test_a_segment_that_no_rule_fits_is_named_with_the_rules_there_are(tmp_path: Path) -> None:
    with pytest.raises(UnknownNameError) as raised:
        labels(drink_from_mug(), mapping(tmp_path, rule(name="Reach", label="a")))
    assert "right_hand from 1.72 s: no fitting rule for 'MoveObjTo'" in str(raised.value)
    assert raised.value.known == ["Reach"]


@pytest.mark.parametrize(
    ("conditions", "says"),
    [
        ({"name": "Raech", "label": "a"}, "mapping.toml:2: no action 'Raech'"),
        ({"name": "Reach", "label": "a", "object": "mgu"}, "no object 'mgu'"),
        ({"name": "Reach", "label": "a", "next": "Lit"}, "no action 'Lit'"),
    ],
)
def test_a_name_that_does_not_exist_is_refused_with_those_that_do(
    conditions: dict[str, str], says: str, tmp_path: Path
) -> None:
    given = mapping(tmp_path, rule(**conditions))
    with pytest.raises(UnknownNameError) as raised:
        check_names(given, names=["Reach", "Touch"], objects=["mug"], labels=["a"])
    assert says in str(raised.value)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is empty"),
        ("# nothing yet\n", "has no rule"),
        ("rules = 3", "no key 'rules'"),
        (rule(name="Reach"), "'label' is missing"),
        (rule(name="Reach", label="a", when="now"), "no key 'when'"),
        (rule(name="Reach", label="a", position="third"), "no position 'third'"),
        ("[[rule]\n", "mapping.toml"),
    ],
)
def test_a_bad_mapping_is_refused(text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(CaparError) as raised:
        mapping(tmp_path, text)
    assert says in str(raised.value)
