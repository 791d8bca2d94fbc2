"""``capar perform``: a virtual body's action as a capture that every other command reads."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import FileError, UnknownNameError
from capar.pipelines.observation import observe


def told(*arguments: str) -> str:
    result = CliRunner().invoke(app, ["perform", *arguments])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.output


def test_what_is_performed_is_observed_as_what_it_is(tmp_path: Path) -> None:
    place = tmp_path / "touched"
    assert "touch by a woman" in told("touch", "--agent", "woman", "--rate", "30", "-o", str(place))
    seen = observe(str(place))
    names = [each.name for each in seen.segments if each.ee == "right_hand"]
    assert [name for name in names if name != "Rest"] == ["Reach", "Touch", "ResumePosture"]


def test_the_same_words_give_the_same_bytes(tmp_path: Path) -> None:
    for name in ("one", "two"):
        told("touch", "--rate", "30", "--noisy", "-o", str(tmp_path / name))
    one, two = (sorted((tmp_path / name).iterdir()) for name in ("one", "two"))
    assert [each.name for each in one] == [each.name for each in two]
    assert [each.read_bytes() for each in one] == [each.read_bytes() for each in two]


@pytest.mark.parametrize("words", [("dirnk",), ("drink", "--agent", "giant")])
def test_an_unknown_action_or_body_is_named_with_those_that_exist(
    words: tuple[str, ...], tmp_path: Path
) -> None:
    with pytest.raises(UnknownNameError, match="there are: "):
        told(*words, "-o", str(tmp_path / "new"))
    assert list(tmp_path.iterdir()) == []


def test_a_folder_with_something_in_it_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(FileError, match="not an empty folder"):
        told("touch", "-o", str(tmp_path))
