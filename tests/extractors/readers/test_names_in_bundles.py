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
