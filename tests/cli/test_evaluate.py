"""``capar evaluate`` with labels that anybody could write, right ones and wrong ones."""

import json
from pathlib import Path

import pytest
from bundles import DRINKING
from pympi import Eaf
from shell import refused as refusal
from shell import run

from capar.pipelines.observation import observe

HEAD = "link,start_s,end_s,label\n"
RULES = "".join(
    f'[[rule]]\nname = "{name}"\nlabel = "{name}"\n'
    for name in ("Reach", "TouchWith", "Touch", "MoveObj", "MoveObjTo", "ResumePosture", "*")
).replace('label = "*"', 'label = "other"')


@pytest.fixture(scope="module")
def segments() -> list[tuple[str, float, float, str]]:
    """What is printed of the demo, in the words of the mapping above."""
    words = ("Reach", "TouchWith", "Touch", "MoveObj", "MoveObjTo", "ResumePosture")
    return [
        (
            each.ee,
            each.start_s,
            each.end_s,
            next((word for word in words if word in (each.name, *each.general)), "other"),
        )
        for each in observe(DRINKING).segments
    ]


def options(folder: Path) -> tuple[object, ...]:
    path = folder / "mapping.toml"
    path.write_text(RULES)
    return "--mapping", path


def evaluated(*arguments: object) -> dict:
    out: dict = json.loads(run("evaluate", DRINKING, *arguments, "--json"))
    return out


def test_labels_in_csv_json_elan_and_praat_of_what_is_printed_score_100(
    tmp_path: Path, segments: list[tuple[str, float, float, str]]
) -> None:
    from pympi import TextGrid

    rows = [dict(zip(HEAD.strip().split(","), each, strict=True)) for each in segments]
    table = tmp_path / "a.csv"
    table.write_text(HEAD + "".join(",".join(map(str, each)) + "\n" for each in segments))
    listed = tmp_path / "a.json"
    listed.write_text(json.dumps(rows, indent=1))
    elan, praat = Eaf(), TextGrid(xmax=segments[-1][2])
    elan.remove_tier("default")
    elan.add_tier("right_hand")
    tier = praat.add_tier("right_hand")
    for _, start, end, label in segments:
        elan.add_annotation("right_hand", round(1000 * start), round(1000 * end), label)
        tier.add_interval(start, end, label)
    elan.to_file(str(tmp_path / "a.eaf"))
    praat.to_file(str(tmp_path / "a.TextGrid"))
    for path in (table, listed, tmp_path / "a.eaf", tmp_path / "a.TextGrid"):
        found = evaluated(path, *options(tmp_path))["all"]
        assert (found["edit"], found["f1@50"]) == (100.0, 100.0)
        assert found["accuracy"] >= 99.0
        assert found["onset_ms"]["p95"] <= 1.0


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (HEAD + "rihgt_hand,0,1,Reach\n", "labels.csv:2: no observed link 'rihgt_hand'"),
        (HEAD + "right_hand,0,1,Raech\n", "labels.csv:2: no label in the mapping 'Raech'"),
        (HEAD + "right_hand,0,2,Reach\nright_hand,1,3,Touch\n", "labels.csv:3: Touch of right"),
        (HEAD + "right_hand,0,1,Reach\nright_hand,1,900,Touch\n", "labels.csv:3: Touch of right"),
        (HEAD + "right_hand,-3,1,Reach\n", "labels.csv:2: Reach of right_hand from second -3"),
        ("hand,begin,end,label\nright_hand,0,1,Reach\n", "its columns are hand, begin, end"),
        (HEAD, "marks nothing"),
        ("", "is empty"),
        ("hand,start_frame,end_frame,action\nright_hand,0,9000,Reach\n", "labels.csv:2: frames"),
    ],
)
def test_a_bad_label_file_is_refused_with_file_and_line(
    text: str, says: str, tmp_path: Path
) -> None:
    path = tmp_path / "labels.csv"
    path.write_text(text)
    assert says in refusal("evaluate", DRINKING, path, *options(tmp_path))


def test_labels_may_be_of_a_part_of_the_time_and_of_few_actions(
    tmp_path: Path, segments: list[tuple[str, float, float, str]]
) -> None:
    path = tmp_path / "labels.csv"
    path.write_text(HEAD + ",".join(map(str, segments[0])) + "\n")
    found = evaluated(path, *options(tmp_path))
    assert found["all"]["accuracy"] == 100.0
    assert found["all"]["segments"]["true"] == 1
    assert any("is in no label file" in each for each in found["notices"])


def test_contacts_are_scored_against_labels_of_one_pair(tmp_path: Path) -> None:
    path = tmp_path / "contacts.csv"
    path.write_text("body,other,start_s,end_s\nright_hand,mug,0.9,3.2\n")
    found = evaluated(path, "--kind", "contacts")
    assert set(found["bodies"]) == {"right_hand"}
    assert 50.0 < found["all"]["f1"] <= 100.0


def test_a_printed_carry_is_scored_against_its_label(tmp_path: Path) -> None:
    path = tmp_path / "carries.csv"
    path.write_text("object,start_s,end_s\nmug,1.0,3.0\n")
    found = evaluated(path, "--kind", "carries")["all"]
    assert (found["carries"], found["counted"]) == (1, 1)
    assert found["start_ms"]["matched"] == found["end_ms"]["matched"] == 1


def test_a_hand_may_do_events_that_are_segments(tmp_path: Path) -> None:
    path = tmp_path / "events.csv"
    path.write_text("hand,event,start_s,end_s,other\nright_hand,Reach,0.5,0.6,mug\n")
    found = evaluated(path, "--kind", "events")["events"]
    assert found["Reach"]["found"] == 1


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["a.toml", "--kind", "carries"], "an evaluation file says itself what --kind would say"),
        ([DRINKING, "l.csv", "--takes", "x"], "--takes belongs to an evaluation file"),
        ([DRINKING, "l.csv", DRINKING], "3 arguments: each capture is followed by its label"),
    ],
)
def test_arguments_that_do_not_fit_are_refused(arguments: list[str], says: str) -> None:
    assert says in refusal("evaluate", *arguments)
