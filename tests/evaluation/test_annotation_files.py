"""What people annotate in ELAN and Praat is read as labels, and damaged files are refused."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pympi import Eaf, TextGrid

from capar.evaluation.labels import Kind, Label, read_labels
from capar.model.errors import FileError

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


def test_a_tier_of_elan_is_a_link_and_its_annotations_are_labels(tmp_path: Path) -> None:
    assert read_labels(elan(tmp_path, MARKS)).marks == WANTED


@pytest.mark.parametrize("mode", ["normal", "short", "binary"])
def test_a_tier_of_praat_is_a_link_in_each_form_of_text_grid(mode: str, tmp_path: Path) -> None:
    assert read_labels(praat(tmp_path, MARKS, mode)).marks == WANTED


def test_praat_may_write_utf_16(tmp_path: Path) -> None:
    path = praat(tmp_path, [("right_hand", 0, 400, "gießen")], codec="utf-16")
    assert [each.label for each in read_labels(path).marks] == ["gießen"]


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


@pytest.mark.parametrize("write", [elan, praat])
def test_overlaps_are_told_with_the_line_in_the_file(write, tmp_path: Path) -> None:
    if write is praat:
        path = praat(tmp_path, MARKS)
        text = path.read_text().replace("xmin = 0.4", "xmin = 0.3")
        path.write_text(text)
    else:
        path = elan(tmp_path, [*MARKS, ("right_hand", 1000, 1500, "lift")])
    with pytest.raises(FileError, match="overlap") as raised:
        read_labels(path)
    line = int(str(raised.value).split(":")[1])
    shown = path.read_text().splitlines()[line - 1]
    assert "ANNOTATION_ID" in shown or "intervals [" in shown


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


def test_a_file_with_empty_tiers_marks_nothing(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="marks nothing"):
        read_labels(elan(tmp_path, [("right_hand", 0, 400, " ")]))


def test_an_annotation_without_times_is_refused_with_its_line(tmp_path: Path) -> None:
    path = elan(tmp_path, MARKS)
    path.write_text(path.read_text().replace(' TIME_VALUE="400"', ""))
    with pytest.raises(FileError, match=r"take\.eaf:\d+: annotation '\w+' .* has no time"):
        read_labels(path)


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
