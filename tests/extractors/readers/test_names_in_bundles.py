"""Names and places that a capture.toml gets wrong are told with their line, or what to write."""

from pathlib import Path

import motion_files as samples
import pytest

from capar.model.errors import FileError
from extractors.readers.bundle.capture_toml import find_place, read_capture

TRIAL = """name = "trial"
unit = "m"
up = "z"
rate_hz = 100
[files]
motion = "m.csv"
[agent]
name = "ann"
[[sensor]]
name = "right_hand"
end_effector = "hand"
body = "hand"
[[object]]
name = "mug"
tag = "mobile"
kind = "cup"
position = [0.5, 0.2, 0.9]
[[object]]
name = "table"
tag = "fixed"
position = [0.5, 0.2, 0.8]
"""


def bundle(folder: Path, text: str = TRIAL) -> Path:
    folder.mkdir(exist_ok=True)
    samples.write_csv(folder / "m.csv")
    (folder / "capture.toml").write_text(text)
    return folder


WRONG = (
    ('name = "trial"', 'name = ""', "name is empty."),
    ('name = "trial"', 'name = "  "', "name is empty."),
    ('name = "ann"', 'name = ""', "name is empty."),
    ('kind = "cup"', 'kind = ""', "kind is empty."),
    ('name = "right_hand"', 'name = "Right Hand!"', "name 'Right Hand!': names begin"),
    ('name = "right_hand"', 'name = ""', "name '': names begin"),
    ('name = "table"', 'name = "mug" #', "two objects are called 'mug'; also "),
    ("rate_hz = 100", "rate_hz = -5", "rate_hz = -5; it must be greater than 0."),
    ("rate_hz = 100", "rate_hz = 0", "rate_hz = 0; it must be greater than 0."),
)


@pytest.mark.parametrize(("right", "wrong", "told"), WRONG)
def test_what_is_wrong_with_a_name_or_rate_is_told_with_its_line(
    right: str, wrong: str, told: str, tmp_path: Path
) -> None:
    text = TRIAL.replace(right, wrong)
    line = next(n for n, each in enumerate(text.splitlines(), 1) if each == wrong)
    with pytest.raises(FileError) as caught:
        read_capture(bundle(tmp_path, text))
    assert f"capture.toml:{line}: {told}" in str(caught.value)


@pytest.mark.parametrize("place", [".", "capture.toml", "../pour", "../pour/capture.toml"])
def test_a_capture_without_a_name_is_called_after_its_folder_from_wherever(
    place: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(bundle(tmp_path / "pour", TRIAL.removeprefix('name = "trial"\n')))
    assert read_capture(place).name == "pour"


@pytest.mark.parametrize(
    ("place", "advice"),
    [
        ("nope", "nope/capture.toml"),
        ("nope/mine.toml", "nope/mine.toml"),
        ("nope/gone.csv", "nope/capture.toml"),
    ],
)
def test_where_no_capture_is_the_file_to_write_is_one_that_is_found_then(
    place: str, advice: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileError, match=f"there is no file {place}.* -o {advice}$"):
        find_place(place)
