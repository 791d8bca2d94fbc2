"""Pictures are drawn in three formats, the same bytes each time."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.model.errors import FileError
from capar.model.observation import Observation
from capar.views.picture import draw
from capar.views.rows import Speeds

HEADS = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}


def speeds(seen: Observation) -> Speeds:
    times = np.arange(seen.frames) / seen.rate_hz
    speed = np.abs(np.sin(3 * times))
    speed[40:50] = np.nan
    return {each.ee: (times, speed) for each in seen.links}


@pytest.mark.parametrize("suffix", HEADS)
def test_a_picture_has_the_format_of_its_suffix_and_the_same_bytes_twice(
    suffix: str, tmp_path: Path
) -> None:
    seen = drink_from_mug()
    files = [tmp_path / f"{name}{suffix}" for name in ("one", "two")]
    for file in files:
        draw(seen, speeds(seen), path=file)
    first, second = (each.read_bytes() for each in files)
    assert first.startswith(HEADS[suffix])
    assert first == second


def test_a_picture_holds_the_names_of_its_segments_and_what_is_assumed(tmp_path: Path) -> None:
    seen = drink_from_mug()
    file = tmp_path / "drink.svg"
    draw(seen, speeds(seen), path=file)
    comments = {
        line.strip().removeprefix("<!-- ").removesuffix(" -->")
        for line in file.read_text(encoding="utf-8").splitlines()
        if line.strip().startswith("<!-- ")
    }
    assert {each.name for each in seen.segments} <= comments
    assert any(each.startswith("* table is assumed: a box") for each in comments)
    assert any(each.startswith("† stand-ins of stated size") for each in comments)


def test_frames_in_which_a_body_was_lost_are_hatched_and_the_hatch_is_explained(
    tmp_path: Path,
) -> None:
    seen = drink_from_mug()
    lost = np.zeros(seen.frames, dtype=bool)
    lost[200:221] = True
    texts = []
    for name, where in (("whole", {}), ("lost", {"mug": lost})):
        draw(seen, {}, path=tmp_path / f"{name}.svg", lost=where)
        texts.append((tmp_path / f"{name}.svg").read_text(encoding="utf-8"))
    note = "hatched: a body of that row was not tracked; a bar across it is inferred."
    assert [note in each for each in texts] == [False, True]
    assert [each.count("fill: url(#h") for each in texts] == [0, 4]


@pytest.mark.parametrize("make", [pick_up_with_both_hands, with_unknown])
def test_the_picture_is_neither_empty_nor_cut(
    make: Callable[[], Observation], tmp_path: Path
) -> None:
    seen = make()
    file = tmp_path / "out.png"
    draw(seen, {}, path=file)
    pixels = imread(file)[..., :3]
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 10
    edges = np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]])
    assert (edges == 1.0).all(), "ink on the edge of the picture"


def test_another_suffix_is_refused_with_those_that_exist(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"no picture format '\.bmp'; there are: \.png, \.svg"):
        draw(drink_from_mug(), {}, path=tmp_path / "a.bmp")


def test_a_folder_that_is_not_there_is_an_error_of_the_user(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be written"):
        draw(drink_from_mug(), {}, path=tmp_path / "nowhere" / "a.png")
