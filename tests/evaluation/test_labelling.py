"""Labels that are written read back as the observation says, by the libraries of others."""

import csv
import json
import os
import re
import subprocess
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest
from bundles import DRINKING
from observations import drink_from_mug, pick_up_with_both_hands
from pympi import Eaf, TextGrid
from robot_data import robot_data
from shell import refused, run

from capar.evaluation.labelling import FORMS, label, write_labels
from capar.evaluation.lerobot import write_subtasks
from capar.model.errors import CaparError
from capar.model.json_form import to_json
from capar.pipelines.observation import observe

SEEN = [drink_from_mug(), pick_up_with_both_hands()]


@pytest.fixture(scope="module")
def demo() -> Any:
    return observe(DRINKING)


def segments_in_json(seen: Any) -> list[dict[str, Any]]:
    """Segments as the observation's own JSON states them."""
    links = json.loads(to_json(seen))["links"]
    return [{**each, "side": link["side"]} for link in links for each in link["segments"]]


@pytest.mark.parametrize("form", ["parquet", "csv", "json"])
def test_tables_read_back_equal_to_the_observation_s_json(
    form: str, demo: Any, tmp_path: Path
) -> None:
    (path,) = write_labels(label([demo, *SEEN]), form, tmp_path / "labels")
    if form == "parquet":
        rows = pq.read_table(path).to_pylist()
    elif form == "json":
        rows = json.loads(path.read_text())
    else:
        rows = list(csv.DictReader(path.open(newline="")))
        for row in rows:
            row |= {"objects": row["objects"].split(";") if row["objects"] else []}
            row |= {"general": row["general"].split(";") if row["general"] else []}
            row |= {key: int(row[key]) for key in ("first", "last")}
            row |= {key: float(row[key]) for key in ("start_s", "end_s")}
    for seen in (demo, *SEEN):
        own = [row for row in rows if row["capture"] == seen.capture]
        keys = ("name", "objects", "general", "first", "last", "start_s", "end_s", "side")
        found = [{k: row[k] for k in keys} for row in own if row["row"] == "segment"]
        assert found == [{k: each[k] for k in keys} for each in segments_in_json(seen)]
        atoms = json.loads(to_json(seen))["facts"]
        contacts = [row for row in own if row["row"] == "contact"]
        assert [
            f"touching({row['effector']},{row['objects'][0]},{row['first']},{row['last']})"
            for row in contacts
        ] == [each for each in atoms if each.startswith("touching(")]
        assert len([row for row in own if row["row"] == "motion"]) == len(
            [each for each in atoms if each.startswith("moved_by(")]
        )


def test_a_segment_says_its_kinds_goal_sentence_and_rule(demo: Any) -> None:
    rows = list(label([demo]))
    (held,) = [row for row in rows if row["row"] == "possession"]
    assert (held["effector"], held["objects"]) == ("right_hand", ["mug"])
    (to_mouth,) = [row for row in rows if row["goal"] == "head" and row["name"] == "MoveObjTo"]
    assert to_mouth["kinds"] == ["mug", "head"]
    assert (
        to_mouth["sentence"]
        == "The tall man lifted the mug to the head with the right hand to drink."
    )
    assert to_mouth["rule"] == "primitives/move_obj_to.lp"
    assert held["start_s"] == pytest.approx(to_mouth["start_s"], abs=1e-6)


def test_motions_are_the_same_in_a_data_frame(demo: Any) -> None:
    rows = [row for row in label([demo]) if row["row"] == "motion"]
    frame = demo.to_frame("motions")
    assert list(frame["how"]) == [row["name"] for row in rows] == ["carried"]
    assert list(frame["mover"]) == [row["effector"] for row in rows]
    assert list(frame["start_s"]) == [row["start_s"] for row in rows]
    with pytest.raises(CaparError, match="motions"):
        demo.to_frame("motion")


@pytest.mark.parametrize("seen", SEEN, ids=lambda each: each.capture)
def test_each_frame_has_one_row_of_each_end_effector(seen: Any) -> None:
    rows = list(label([seen], per_frame=True))
    for link in seen.links:
        own = [row for row in rows if row["effector"] == link.ee]
        assert [row["frame"] for row in own] == list(
            range(link.segments[0].first, link.segments[-1].last + 1)
        )
        for row in own:
            segment = link.segments[row["segment"]]
            assert segment.first <= row["frame"] <= segment.last
            assert row["name"] == segment.name
            touched = {
                fact.other
                for fact in seen.facts
                if fact.predicate == "touching" and fact.body == link.ee
                if fact.first <= row["frame"] <= fact.last
            }
            assert touched <= {*row["touches"]}


def test_elan_and_praat_read_back_as_the_segments(demo: Any, tmp_path: Path) -> None:
    (path,) = write_labels(label([demo]), "elan", tmp_path / "elan")
    found = Eaf(str(path)).get_annotation_data_for_tier("right_hand")
    wanted = segments_in_json(demo)
    assert [text for *_, text in sorted(found)] == [
        " ".join([each["name"], *each["objects"]]) for each in wanted
    ]
    assert [(a, b) for a, b, _ in sorted(found)] == [
        (round(1000 * each["start_s"]), round(1000 * each["end_s"])) for each in wanted
    ]
    read = Eaf(str(path))
    facts = [re.fullmatch(r"(\w+)\((.*)\)", each) for each in json.loads(to_json(demo))["facts"]]
    kinds = {"touching": ("contact", 0, 1), "moved_by": ("motion", 1, 0)}
    expected: dict[str, list[tuple[int, int]]] = {}
    for atom in filter(None, facts):
        if atom[1] in kinds:
            what, one, other = kinds[atom[1]]
            terms = atom[2].split(",")
            span = tuple(round(1000 * int(frame) / demo.rate_hz) for frame in terms[-2:])
            expected.setdefault(f"{terms[one]} {what} {terms[other]}", []).append(span)
    tiers = {each for each in read.get_tier_names() if " contact " in each or " motion " in each}
    assert {
        tier: sorted((a, b) for a, b, _ in read.get_annotation_data_for_tier(tier))
        for tier in tiers
    } == {tier: sorted(spans) for tier, spans in expected.items()}
    assert "right_hand possession" in read.get_tier_names()
    (path,) = write_labels(label([demo]), "praat", tmp_path / "praat")
    read = [each for each in TextGrid(str(path)).get_tier("right_hand").get_intervals() if each[2]]
    assert [text for *_, text in read] == [text for *_, text in sorted(found)]
    for (start, end, _), each in zip(read, wanted, strict=True):
        assert (start, end) == pytest.approx((each["start_s"], each["end_s"]))


@pytest.mark.parametrize("form", sorted(FORMS))
def test_the_same_observation_gives_the_same_bytes(form: str, demo: Any, tmp_path: Path) -> None:
    first, second = (
        write_labels(label([demo]), form, tmp_path / name)[0].read_bytes() for name in "ab"
    )
    assert first == second


def test_two_captures_of_one_name_are_refused(demo: Any) -> None:
    with pytest.raises(CaparError, match="two captures are called 'drink_from_mug_tall_man'"):
        list(label([demo, SEEN[1], DRINKING]))


def test_a_vocabulary_gives_other_labels_and_unknown_names_are_refused(
    demo: Any, tmp_path: Path
) -> None:
    path = tmp_path / "words.toml"
    rules = {"Reach": "approach", "MoveObj": "move", "MoveObjTo": "move", "*": "other"}
    path.write_text("".join(f'[[rule]]\nname = "{a}"\nlabel = "{b}"\n' for a, b in rules.items()))
    rows = [row for row in label([demo], vocabulary=path) if row["row"] == "segment"]
    assert [row["label"] for row in rows] == [
        "other", "approach", "move", "move", "move", "other", "other"
    ]  # fmt: skip
    path.write_text('[[rule]]\nname = "Raech"\nlabel = "approach"\n')
    with pytest.raises(CaparError, match=r"words\.toml:2.*Raech"):
        list(label([demo], vocabulary=path))


@pytest.mark.parametrize("existing", [False, True])
def test_subtasks_are_written_into_a_copy_of_a_data_set(
    existing: bool, demo: Any, tmp_path: Path
) -> None:
    source = robot_data(tmp_path / "robot", existing=existing)
    rows = [row | {"capture": "robot:episode_3"} for row in label([demo])]
    counts = write_subtasks(rows, source, tmp_path / "labelled")
    before = pq.read_table(source / "data" / "chunk-000" / "file-000.parquet")
    file = pq.ParquetFile(tmp_path / "labelled" / "data" / "chunk-000" / "file-000.parquet")
    after = file.read()
    assert file.num_row_groups == 2
    for name in before.column_names:
        if name != "language_persistent":
            assert after[name].equals(before[name])
    by_frame = after["language_persistent"].to_pylist()
    assert len(by_frame[0]) == (2 if existing else 0)
    assert all(each == by_frame[20] for each in by_frame[20:])
    stamps = set(after["timestamp"].to_pylist()[20:])
    subtasks = [each for each in by_frame[20] if each["style"] == "subtask"]
    wanted = segments_in_json(demo)
    assert counts == {3: len(subtasks)} == {3: len(wanted)}
    for each, segment in zip(subtasks, wanted, strict=True):
        assert 0.0 <= each["timestamp"] - segment["start_s"] < 1.0 / 30.0 + 1e-4
        assert each["timestamp"] in stamps
        assert (each["role"], each["camera"], each["tool_calls"]) == ("assistant", None, None)
    assert subtasks[2]["content"] == "move obj to mug head"
    assert [*subtasks[0]] == ["role", "content", "style", "timestamp", "camera", "tool_calls"]
    assert [each["content"] for each in by_frame[20] if each["style"] == "plan"] == (
        ["drink"] if existing else []
    )
    info = json.loads((tmp_path / "labelled" / "meta" / "info.json").read_text())
    feature = {"dtype": "language", "shape": [1], "names": None}
    assert info["features"]["language_persistent"] == info["features"]["language_events"] == feature
    assert (tmp_path / "labelled" / "videos" / "a.mp4").read_bytes() == b"film"


def test_a_capture_of_no_episode_and_two_hands_are_refused(demo: Any, tmp_path: Path) -> None:
    source = robot_data(tmp_path / "robot")
    rows = list(label([demo]))
    for capture, wrong in (("drink", "of which episode"), ("drink7", "no episode '7'")):
        with pytest.raises(CaparError, match=wrong):
            write_subtasks([row | {"capture": capture} for row in rows], source, tmp_path / "to")
    both = [row | {"capture": "lift3"} for row in label([pick_up_with_both_hands()])]
    with pytest.raises(CaparError, match=r"left_hand and right_hand act.*--effector"):
        write_subtasks(both, source, tmp_path / "to")
    assert not (tmp_path / "to").exists()
    assert list(write_subtasks(both, source, tmp_path / "to", effector="left_hand")) == [3]


def test_the_command_writes_labels_and_refuses_what_does_not_fit(tmp_path: Path) -> None:
    done = run("label", DRINKING, "-o", tmp_path / "a.parquet")  # the name says the format
    assert "13 rows of 1 capture" in done
    assert pq.read_table(tmp_path / "a.parquet").num_rows == 13
    out = tmp_path / "x"
    for arguments, wrong in (
        ([DRINKING, "-o", out, "--format", "elan", "--per-frame"], "elan has no rows by frame"),
        ([DRINKING, "-o", out, "--format", "lerobot"], "read from none: say --dataset FOLDER"),
        ([DRINKING, "-o", out, "--dataset", out], "--format lerobot takes --dataset"),
        ([DRINKING, "-o", tmp_path / "x.eaf"], "say in which format: --format csv|"),
        ([tmp_path / "none", "-o", out], "no capture here"),
    ):
        assert wrong in refused("label", *arguments)


def test_no_two_subtasks_begin_with_one_frame_nor_after_the_last(demo: Any, tmp_path: Path) -> None:
    """LeRobot refuses an episode in which two subtasks are active at once."""
    source = robot_data(tmp_path / "robot")
    rows = [row | {"capture": "episode_0"} for row in label([demo]) if row["row"] == "segment"]
    near = [rows[0] | {"start_s": 0.0}, rows[1] | {"start_s": 0.101}, rows[2] | {"start_s": 0.11}]
    late = rows[3] | {"start_s": 20 / 30}  # its last frame is at 19 / 30
    assert write_subtasks([*near, late], source, tmp_path / "labelled") == {0: 2}
    table = pq.read_table(tmp_path / "labelled" / "data" / "chunk-000" / "file-000.parquet")
    found = table["language_persistent"].to_pylist()[0]
    assert [each["timestamp"] for each in found] == pytest.approx([0.0, 4 / 30])
    assert found[1]["content"].startswith("move obj to")


@pytest.mark.skipif(
    "CAPAR_LEROBOT" not in os.environ,
    reason="CAPAR_LEROBOT names the Python of an environment with the package lerobot 0.6 or newer",
)
@pytest.mark.parametrize("frames", [170, 60])
def test_lerobot_reads_the_subtask_of_each_frame(frames: int, demo: Any, tmp_path: Path) -> None:
    def lerobot(*arguments: object) -> str:
        script = Path(__file__).parents[1] / "lerobot_data.py"
        command = [os.environ["CAPAR_LEROBOT"], script, *arguments]
        environment = os.environ | {"HF_HUB_OFFLINE": "1"}
        done = subprocess.run(
            list(map(str, command)), env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    lerobot("write", tmp_path / "data", 20, frames)
    rows = [row | {"capture": "robot:episode_1"} for row in label([demo])]
    write_subtasks(rows, tmp_path / "data", tmp_path / "labelled")
    read = json.loads(lerobot("read", tmp_path / "labelled"))
    assert [(each["episode"], each["state"][0]) for each in read] == [
        *((0, n) for n in range(20)), *((1, n) for n in range(frames))
    ]  # fmt: skip
    assert not any(each["subtask"] or each["rows"] or each["events"] for each in read[:20])
    for frame in read[20:]:
        begun = [e for e in segments_in_json(demo) if e["start_s"] <= frame["time_s"] + 1e-4]
        words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", begun[-1]["name"]).lower()
        assert frame["subtask"] == " ".join([words, *begun[-1]["objects"]])
        assert 0.0 <= frame["since_s"] - begun[-1]["start_s"] + 1e-4 < 1 / 30 + 2e-4
