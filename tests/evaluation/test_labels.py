"""Labels are read from every form of file, and bad ones are refused with their place."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pympi import Eaf, TextGrid

from capar.evaluation import Contradictions, Kind
from capar.evaluation.labels import Label, Labels, in_seconds, read_labels
from capar.model.errors import FileError

LEFT_OUT = Contradictions.LEAVE_OUT


def written(folder: Path, text: str, name: str = "labels.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


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


def test_what_two_marks_claim_can_belong_to_neither_with_a_notice(tmp_path: Path) -> None:
    labels = lenient(tmp_path, "link,start_s,end_s,label\nl,0,2,a\nl,1,3,b\n")
    assert labels.marks == (Label("l", 0.0, 1.0, "a"), Label("l", 2.0, 3.0, "b"))
    (notice,) = labels.notices
    assert "overlap; what both claim is not counted" in notice


Mark = tuple[str, int, int, str]

MARKS: list[Mark] = [
    ("right_hand", 0, 400, "idle"),
    ("right_hand", 400, 1250, "reach"),
    ("left_hand", 100, 900, "hold"),
]


def elan(folder: Path, marks: list[Mark]) -> Path:
    file = Eaf()
    file.remove_tier("default")
    for tier in dict.fromkeys(tier for tier, *_ in marks):
        file.add_tier(tier)
    for tier, start, end, text in marks:
        file.add_annotation(tier, start, end, text)
    path = folder / "take.eaf"
    file.to_file(str(path))
    return path


def praat(folder: Path, marks: list[Mark], mode: str = "normal", codec: str = "utf-8") -> Path:
    file = TextGrid(xmax=2.0)
    for tier in dict.fromkeys(tier for tier, *_ in marks):
        made = file.add_tier(tier)
        for start, end, text in [tuple(each[1:]) for each in marks if each[0] == tier]:
            made.add_interval(start / 1000, end / 1000, text)
    path = folder / "take.TextGrid"
    file.to_file(str(path), mode=mode, codec=codec)
    return path


WANTED = (
    Label("left_hand", 0.1, 0.9, "hold"),
    Label("right_hand", 0.0, 0.4, "idle"),
    Label("right_hand", 0.4, 1.25, "reach"),
)


@pytest.mark.parametrize("mode", ["normal", "short", "binary"])
def test_a_tier_of_praat_is_a_link_in_each_form_of_text_grid(mode: str, tmp_path: Path) -> None:
    assert read_labels(praat(tmp_path, MARKS, mode)).marks == WANTED


@pytest.mark.parametrize(
    ("kind", "text", "wanted"),
    [
        (Kind.CONTACTS, "mug", Label("right_hand", 0.0, 0.4, "contact", "mug")),
        (Kind.CARRIES, "mug", Label("", 0.0, 0.4, "carry", "mug")),
        (Kind.EVENTS, "pass left_hand", Label("right_hand", 0.0, 0.4, "pass", "left_hand")),
        (Kind.EVENTS, "Touch", Label("right_hand", 0.0, 0.4, "Touch")),
    ],
)
def test_a_text_names_what_is_touched_carried_or_done(
    kind: Kind, text: str, wanted: Label, tmp_path: Path
) -> None:
    for path in (
        elan(tmp_path, [("right_hand", 0, 400, text)]),
        praat(tmp_path, [("right_hand", 0, 400, text)]),
    ):
        assert read_labels(path, kind).marks == (wanted,)


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a.eaf", "<ANNOTATION_DOCUMENT>\n<TIER>", "a.eaf:2: is no XML"),
        ("a.eaf", "<other/>", "holds <other>"),
        ("a.eaf", "<ANNOTATION_DOCUMENT/>", "cannot be read to its end"),
        ("a.eaf", '<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "is refused"),
        ("a.TextGrid", "link,start_s\n", "cannot be read to its end"),
        ("a.TextGrid", "", "is empty"),
    ],
)
def test_a_damaged_file_is_refused_by_name(name: str, text: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(FileError) as raised:
        read_labels(path)
    assert says in str(raised.value)


@settings(max_examples=30, deadline=None)
@given(data=st.data())
def test_any_cut_of_a_file_is_read_or_refused_as_a_users_mistake(
    data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("cut")
    path = data.draw(st.sampled_from([elan, praat]))(folder, MARKS)
    content = path.read_bytes()
    path.write_bytes(content[: data.draw(st.integers(0, len(content)))])
    try:
        assert read_labels(path).marks
    except FileError as error:
        assert path.name in str(error)
