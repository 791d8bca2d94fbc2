"""Scenes change as their files state, and what stands on a table goes up with it."""

from pathlib import Path

import numpy as np
import pytest

from capar.body.virtual_scenes import Thing, box, cup, table
from capar.model.errors import CaparError
from capar.regeneration.scenes import ASIDE_M, HEIGHTS_M, SIZES, Scene, drawn_scene, read_scene


def _scene() -> Scene:
    mug = Thing("mug", cup(0.035, 0.09), (0.45, -0.2, 0.8), round=True)
    crate = Thing("crate", box(0.15, 0.2, 0.15), (0.5, 0.15, 0.8))
    return Scene({each.name: each for each in (table(0.8), mug, crate)}, (0.0, 0.0), 0.0)


def test_a_scene_file_changes_what_it_names_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(
        "[stance]\nplace = [0.1, 0.0]\n[object.table]\nraise_m = -0.1\n"
        "[object.mug]\nsize = 1.2\nturn_deg = 90\n"
    )
    read = read_scene(path, _scene())
    assert read.place == (0.1, 0.0)
    assert read.thing("mug").heading == pytest.approx(np.pi / 2)
    assert read.thing("mug").place == pytest.approx((0.45, -0.2, 0.7))
    assert read.thing("crate").place == pytest.approx((0.5, 0.15, 0.7))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[object.mug]\nsise = 2", r"unknown key 'sise' in \[object.mug\].*size"),
        ("[object.mug]\nsize = 0", "size = 0.0 of 'mug'.*factor above zero"),
        ("[object.mug]\nposition = [1, 2]", "list of 3 numbers"),
        ("[stance]\nplace = [nan, 0]", "list of 2 numbers"),
        ("[stage]\nplace = [0, 0]", "unknown key 'stage' in the file"),
        ("size =", "is no TOML"),
    ],
)
def test_a_faulty_scene_file_is_refused_with_what_would_be_right(
    tmp_path: Path, text: str, message: str
) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(text)
    with pytest.raises(CaparError, match=message):
        read_scene(path, _scene())


def test_drawn_scenes_are_within_the_ranges_from_which_they_are_drawn() -> None:
    before = _scene()
    for number in range(10):
        after = drawn_scene(before, np.random.default_rng([7, number]))
        top = after.thing("table").place[2] + after.thing("table").shape.bounds[1, 2]
        assert HEIGHTS_M[0] <= top <= HEIGHTS_M[1]
        for name in ("mug", "crate"):
            one, two = before.thing(name), after.thing(name)
            assert SIZES[0] <= two.size[0] / one.size[0] <= SIZES[1]
            aside = np.abs(np.array(two.place) - one.place)[:2]
            assert aside.max() <= ASIDE_M
            assert after.support(name) == "table"
