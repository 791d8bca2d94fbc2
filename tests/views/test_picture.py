"""Pictures are drawn in three formats, the same bytes each time."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.model.observation import Observation
from capar.views.picture import Painter, Speeds, draw, rows

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


def test_a_kind_of_action_has_the_same_colour_in_every_picture() -> None:
    """Whatever else there is, and in whatever order it is met."""
    seen = drink_from_mug()
    (link,) = seen.links
    looks = []
    for segments in (link.segments, link.segments[::-1], link.segments[2:]):
        part = replace(seen, links=(replace(link, segments=segments),))
        painter = Painter(rows(part, {}), part.duration_s, 9.0)
        looks.append({text.split(" (")[0]: look["facecolor"] for text, look in painter.legend})
    shared = set.intersection(*map(set, looks))
    assert len(shared) >= 3
    assert all(looks[0][kind] == each[kind] for each in looks for kind in shared)
    assert len(set(looks[0].values())) == len(looks[0])
