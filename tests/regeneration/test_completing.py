"""What a recording does not say is stated, told, and checked; what gives way is still a hold."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from capar.body.scripted_actions import action_capture
from capar.model.capture import Capture, Sensor, Stream
from capar.model.errors import CaparError, FileError
from capar.pipelines.observation import observe
from capar.pipelines.round_trips import observed_source
from capar.regeneration import PlanError
from capar.regeneration.captures import Completion, completed, read_completion

RATE_HZ = 30.0


@cache
def _carried() -> Capture:
    return action_capture("carry", rate_hz=RATE_HZ)


def _with_hand(capture: Capture, sensor: Sensor, off_m: np.ndarray) -> Capture:
    """The capture with a hand elsewhere, by so much at each frame."""
    stream = sensor.stream
    moved = Stream(np.array(stream.times), stream.positions + off_m, stream.orientations)
    sensors = (replace(s, stream=moved) if s.name == sensor.name else s for s in capture.sensors)
    return replace(capture, sensors=tuple(sensors))


def _wandering(by_m: float) -> Capture:
    """The carrying hand slides to and fro on the mug."""
    capture = _carried()
    mug = capture.tag_object("mug").stream.positions
    away = np.linalg.norm(mug - mug[0], axis=1)
    held = np.flatnonzero((away > 0.01) & (np.linalg.norm(mug - mug[-1], axis=1) > 0.01))
    off = np.zeros((len(mug), 3))
    turns = np.sin(np.linspace(0.0, 2.0 * np.pi, len(held)))
    off[held] = np.outer(by_m * turns, [0.0, 0.0, 1.0])
    return _with_hand(capture, capture.sensor("right_hand"), off)


@pytest.mark.long
def test_a_grasp_that_gives_way_a_little_is_a_hold() -> None:
    source = observed_source(_wandering(0.012))
    (hold,) = source.holds
    mug = source.paths["mug"].translation
    assert np.linalg.norm(mug[hold.first] - mug[0]) < 0.02
    assert np.linalg.norm(mug[hold.last] - mug[-1]) < 0.02


@pytest.mark.long
def test_a_grasp_that_gives_way_too_far_is_refused() -> None:
    with pytest.raises(PlanError, match=r"without a steady grip.* with --assume FILE"):
        observed_source(_wandering(0.045))


@pytest.mark.long
def test_whoever_walks_is_refused_with_the_part_in_which_they_stand() -> None:
    capture = _carried()
    walked = np.zeros((len(capture.times), 3))
    walked[:, 0] = -np.clip(capture.times - capture.times[-1] + 1.0, 0.0, 1.0)
    head = next(sensor for sensor in capture.sensors if sensor.end_effector == "head")
    with pytest.raises(PlanError, match=r"walks: .* 1\.\d\d m aside.*stays within 0\.5 m from 0"):
        observed_source(_with_hand(capture, head, walked))


def test_only_a_part_of_a_recording_is_kept() -> None:
    part = completed(_carried(), Completion(from_s=1.0, to_s=3.0))
    assert part.times[0] == 0.0
    np.testing.assert_allclose(part.times[-1], 2.0, atol=1.5 / RATE_HZ)
    whole = _carried().sensor("right_hand").stream
    first = int(np.searchsorted(whole.times, 1.0))
    np.testing.assert_array_equal(
        part.sensor("right_hand").stream.positions[0], whole.positions[first]
    )
    with pytest.raises(CaparError, match="nothing of 'carry' is between 50 and 60 s"):
        completed(_carried(), Completion(from_s=50.0, to_s=60.0))


@pytest.mark.long
def test_a_head_and_a_hand_without_sensors_are_assumed_and_told() -> None:
    picked = action_capture("pick_up", rate_hz=RATE_HZ)
    lacking = replace(
        picked,
        sensors=(picked.sensor("right_hand"),),
        objects=tuple(thing for thing in picked.objects if thing.name != "head"),
    )
    stated = Completion(place=(0.0, 0.0), mirrored={"left_hand": "crate"})
    made = completed(lacking, stated)
    crate = picked.tag_object("crate").stream.positions
    right, left = (made.sensor(f"{side}_hand").stream.positions for side in ("right", "left"))
    np.testing.assert_allclose(left[:, [0, 2]], right[:, [0, 2]], atol=0.01)
    np.testing.assert_allclose(left[:, 1] + right[:, 1], 2.0 * crate[:, 1], atol=0.01)
    source = observed_source(lacking, stated)
    assert source.scene.place == (0.0, 0.0)
    assert {hold.side for hold in source.holds} == {"right", "left"}
    assert sum("assumed: " in note for note in source.notes) == 2
    names = {link.ee: [s.name for s in link.segments] for link in observe(made).links}
    assert names["left_hand"] == names["right_hand"]


def test_what_is_recorded_is_not_assumed() -> None:
    with pytest.raises(CaparError, match="'left_hand' cannot be mirrored"):
        completed(_carried(), Completion(mirrored={"left_hand": "mug"}))
    with pytest.raises(CaparError, match=r"'table' is recorded; .* is for nothing in this capture"):
        completed(_carried(), Completion(sizes={"table": (0.3, 0.3)}))


def test_an_assumed_support_has_another_size() -> None:
    capture = _carried()
    table = replace(capture.tag_object("table"), assumed="the recording has none")
    things = tuple(table if thing.name == "table" else thing for thing in capture.objects)
    made = completed(replace(capture, objects=things), Completion(sizes={"table": (0.3, 0.2)}))
    shape = made.tag_object("table").shape
    assert shape is not None
    assert table.shape is not None
    np.testing.assert_allclose(shape.size, [0.3, 0.2, table.shape.size[2]])
    np.testing.assert_allclose(shape.bounds.mean(axis=0), table.shape.bounds.mean(axis=0))


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("from = 1", "unknown key 'from' in the file"),
        ("[performer]\nheight = 2", r"unknown key 'height' in \[performer\]"),
        ("[performer]\nplace = 3", "Numbers are needed"),
        ("performer = 3", "performer is no table"),
        ("from_s = 'soon'", "Numbers are needed"),
        ("from_s = ", "is no TOML"),
        ("[hand.middle]", r"unknown key 'middle' in \[hand\]"),
        ("[hand.right]\nthumb = [1, 0, 0]", r"unknown key 'thumb' in \[hand.right\]"),
        ("[hand.right]\npalm = [0, 0, 1]", r"\[hand\] lacks 'fingers'"),
        ("[hand.left]\npalm = [0, 0, 1]\nfingers = [0, 0, 0]", r"is no direction"),
    ],
)
def test_a_file_of_assumptions_says_what_is_wrong_with_it(
    tmp_path: Path, text: str, fault: str
) -> None:
    path = tmp_path / "assumed.toml"
    path.write_text(text)
    with pytest.raises(FileError, match=fault):
        read_completion(path)


def test_every_key_of_a_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "assumed.toml"
    path.write_text(
        "from_s = 1.0\nto_s = 2.5\n[performer]\nkind = 'woman'\nstature_m = 1.7\n"
        "place = [0.1, 0.2]\nheading_deg = 90\nfloor_m = -0.5\n"
        "[mirrored]\nleft_hand = 'box'\n[assumed_size]\ntable = [0.3, 0.2]\n"
    )
    found = read_completion(path)
    assert found == Completion(
        1.0, 2.5, "woman", 1.7, (0.1, 0.2), 90.0, -0.5, {"left_hand": "box"}, {"table": (0.3, 0.2)}
    )
    assert len(found.notes) == 6
    assert found.stance is not None
    np.testing.assert_allclose(found.stance[1], 0.5 * np.pi)
