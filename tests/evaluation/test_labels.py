"""Label files of three forms are read, and bad ones are refused with their place."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from capar.evaluation.labels import Contradictions, Label, Labels, in_seconds, read_labels
from capar.model.errors import FileError

RECORDING = "bimacs_optitrack"
LEFT_OUT = Contradictions.LEAVE_OUT


def written(folder: Path, text: str, name: str = "labels.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_seconds_are_read_as_they_are(tmp_path: Path) -> None:
    text = "link,start_s,end_s,label,object\nleft,0.5,1.25,reach,mug\nleft,0,0.5,idle,\n"
    labels = read_labels(written(tmp_path, text))
    assert not labels.in_frames
    assert labels.marks == (
        Label("left", 0.0, 0.5, "idle"),
        Label("left", 0.5, 1.25, "reach", "mug"),
    )


def test_the_object_is_optional(tmp_path: Path) -> None:
    (mark,) = read_labels(written(tmp_path, "link,start_s,end_s,label\nl,0,1,a\n")).marks
    assert mark == Label("l", 0.0, 1.0, "a")


def test_frames_become_the_times_of_the_recording(tmp_path: Path) -> None:
    head = "hand,start_frame,end_frame,action_id,action,object_class_id,object\n"
    text = head + "right_hand,0,2,0,idle,None,None\nright_hand,2,4,1,approach,4,whisk_2\n"
    labels = read_labels(written(tmp_path, text))
    assert labels.in_frames
    times = np.array([0.0, 0.1, 0.5, 0.6, 2.0])
    assert in_seconds(labels, times).marks == (
        Label("right_hand", 0.0, 0.5, "idle"),
        Label("right_hand", 0.5, 2.0, "approach", "whisk_2"),
    )


def test_frames_that_the_recording_lacks_are_refused(tmp_path: Path) -> None:
    text = "hand,start_frame,end_frame,action\nright_hand,0,900,idle\n"
    labels = read_labels(written(tmp_path, text))
    with pytest.raises(FileError, match="frames from 0 to 900 are marked, but the recording has"):
        in_seconds(labels, np.arange(5.0))


def test_the_json_of_the_bimanual_actions_is_read(tmp_path: Path) -> None:
    content = {"left_hand": [0, [0, None, None], 10, [None, None, None], 12, [10, 0, "bowl_3"], 20]}
    labels = read_labels(written(tmp_path, json.dumps(content), "take.json"))
    assert labels.in_frames
    assert labels.marks == (
        Label("left_hand", 0.0, 10.0, "idle"),
        Label("left_hand", 12.0, 20.0, "stir", "bowl_3"),
    )


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("a,b\n1,2\n", "its columns are a, b"),
        ("link,start_s,end_s,label\nl,zero,1,a\n", "labels.csv:2: 'zero' is no number"),
        ("link,start_s,end_s,label\nl,0,nan,a\n", "'nan' is no number"),
        ("link,start_s,end_s,label\nl,0\n", "labels.csv:2: '' is no number"),
        ("link,start_s,end_s,label\n", "marks nothing"),
        ("link,start_s,end_s,label\nl,0,2,a\nl,1,3,b\n", "labels.csv:3: b of l from second 1"),
        ("link,start_s,end_s,label\nl,0,2,a\nl,1,3,b\n", "overlap (the other in line 2)"),
        ("# two hands\nlink,start_s,end_s,label\nl,2,1,b\n", "labels.csv:3: b of l from second 2"),
        ("link,start_s,end_s,label\n,0,1,a\n", "labels.csv:2: has no link"),
        ("link,start_s,end_s,label,sure\nl,0,1,a,maybe\n", "labels.csv:2: sure is 'maybe'"),
        ('[{"link": "l",\n "start_s": 0, "end_s": 1, "label": "a"},\n 3]', "labels.csv:3: is no"),
        ('[{"link": "l"}]', "labels.csv:1: its columns are link"),
        ("[]", "marks nothing"),
        ("{", "no label file of the KIT"),
        ('{"left": [0, [99, null, null], 3]}', "no label file of the KIT"),
        ('{"left": [0, 5]}', "no label file of the KIT"),
        ('{"left": 3}', "no label file of the KIT"),
        ('{"left": [0, [0, null], 3]}', "no label file of the KIT"),
    ],
)
def test_a_bad_file_is_refused_with_its_place(text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(FileError) as raised:
        read_labels(written(tmp_path, text))
    assert says in str(raised.value)


def lenient(folder: Path, text: str) -> Labels:
    return read_labels(written(folder, text), contradictions=LEFT_OUT)


def test_a_mark_that_ends_before_it_starts_can_be_left_out_with_a_notice(tmp_path: Path) -> None:
    labels = lenient(tmp_path, "link,start_s,end_s,label\nl,0,2,a\nl,2,1,b\nl,2,3,c\n")
    assert [each.label for each in labels.marks] == ["a", "c"]
    (notice,) = labels.notices
    assert "left out b of l from second 2 to 1: it ends before it starts" in notice


def test_what_two_marks_claim_can_belong_to_neither_with_a_notice(tmp_path: Path) -> None:
    labels = lenient(tmp_path, "link,start_s,end_s,label\nl,0,2,a\nl,1,3,b\n")
    assert labels.marks == (Label("l", 0.0, 1.0, "a"), Label("l", 2.0, 3.0, "b"))
    (notice,) = labels.notices
    assert "overlap; what both claim is not counted" in notice


def test_no_mark_inside_another_is_counted(tmp_path: Path) -> None:
    text = "link,start_s,end_s,label\nl,0,9,a\nl,2,3,b\nl,4,5,c\n"
    marks = lenient(tmp_path, text).marks
    assert [(each.start, each.end) for each in marks] == [(0.0, 2.0), (3.0, 3.0), (5.0, 5.0)]


def test_a_file_that_is_not_there_is_the_users_mistake(tmp_path: Path) -> None:
    with pytest.raises(FileError):
        read_labels(tmp_path / "nothing.csv")


def test_both_forms_of_the_published_labels_say_the_same() -> None:
    here = Path(__file__).resolve().parents[2]
    folder = Path(os.environ.get("CAPAR_DATA", here.parent / "shared" / "data")) / RECORDING
    if not folder.is_dir():
        pytest.skip(f"no recording {RECORDING}: set CAPAR_DATA to the folder that holds it")
    for take in range(10):
        table = read_labels(
            folder / "csv" / f"subject0_take{take}_labels.csv", contradictions=LEFT_OUT
        )
        original = read_labels(
            folder / "ground_truth" / "subject_0" / "task_1_k_cooking" / f"take_{take}.json",
            contradictions=LEFT_OUT,
        )
        assert table.marks == original.marks
