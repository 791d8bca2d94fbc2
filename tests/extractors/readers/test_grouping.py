"""Sensors on a palm and fingers, or heel and toes, are read as one hand or foot by their names."""

from pathlib import Path

import motion_files as samples
import numpy as np

from capar.model.capture import Source
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.drafting.draft import draft
from extractors.readers.recording import Recording, track

PALM = """name = "trial"
unit = "m"
up = "z"

[files]
motion = "m.csv"

[[sensor]]
name = "right_palm"
end_effector = "hand"
side = "right"
body = "hand"
shape = { sphere = 0.05 }

[[object]]
name = "mug"
tag = "mobile"
position = [0.5, 0.2, 0.9]
shape = { cylinder = [0.04, 0.1] }
"""
INDEX = """
[[sensor]]
name = "right_index"
end_effector = "index"
side = "right"
body = "hand"
shape = { sphere = 0.01 }
"""
PIVOT = """
[[pivot_contact]]
first = "right_palm"
second = "mug"
distance_m = 0.1
"""


def bundle(folder: Path, text: str) -> Path:
    name, write = samples.WRITERS["csv"]
    write(folder / name)
    (folder / "capture.toml").write_text(text)
    return folder


def test_a_palm_and_a_finger_are_one_hand_that_is_called_so(tmp_path: Path) -> None:
    capture = read_capture(bundle(tmp_path, PALM + INDEX))
    (hand,) = capture.acting
    assert (hand.name, hand.end_effector, hand.side, hand.link) == (
        "right_hand", "hand", "right", "right_arm",
    )  # fmt: skip
    assert [each.name for each in capture.parts_of("right_hand")] == ["right_hand", "right_index"]
    (told,) = [each for each in capture.notices if each.code == "sensors-grouped"]
    assert told.bodies == ("right_hand",)


def test_a_distance_stated_for_the_palm_is_the_hands(tmp_path: Path) -> None:
    capture = read_capture(bundle(tmp_path, PALM + INDEX + PIVOT))
    assert [(each.first, each.second) for each in capture.pivot_contacts] == [("right_hand", "mug")]


def test_parts_are_told_apart_on_demand(tmp_path: Path) -> None:
    text = (PALM + INDEX).replace('up = "z"', 'up = "z"\nparts = "apart"')
    capture = read_capture(bundle(tmp_path, text))
    assert [each.name for each in capture.acting] == ["right_palm", "right_index"]
    assert not any(each.code == "sensors-grouped" for each in capture.notices)


def test_a_draft_takes_heels_toes_and_fingers_for_sensors_and_says_what_it_does_with_them() -> None:
    times = np.arange(20) / 50.0
    places, turns = np.zeros((20, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (20, 1))
    names = ("right_heel", "right_toe", "left_palm", "left_index", "mug")
    bodies = {name: track(name, times, places, turns) for name in names}
    text = draft([Recording(Source("walk.csv", "csv", ""), bodies=bodies)], Path(), "walk")
    assert text.count("[[sensor]]") == 4
    assert text.count('end_effector = "foot"') == 2
    assert text.count('end_effector = "hand"') == 2
    assert 'parts = "together"' in text
    alone = draft(
        [Recording(Source("a.csv", "csv", ""), bodies={"mug": bodies["mug"]})], Path(), "a"
    )
    assert "parts" not in alone
