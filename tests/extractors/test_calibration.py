"""A calibration decides for the whole, and with it any part is measured as the whole is."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import motions
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import ball, hand, pick_and_place, still
from motion_files import recordings_folder
from windows import WINDOWED, compared, repeated

from capar.model.calibration import Calibration
from capar.model.capture import Capture, TagObject, TagType
from capar.model.errors import CaptureError, UnknownNameError
from capar.model.facts import Pause, ZeroCrossing
from capar.model.json_form import to_json, value_from_json
from extractors.calibration import calibrate, thresholds_of
from extractors.measure import Measurements, measure
from extractors.readers.bundle.capture_toml import read_capture
from extractors.thresholds import Thresholds

SHORTEST = 2000
"""Fewest frames of a window [1]: two margins and two seconds at least."""


@cache
def whole(name: str) -> tuple[Capture, Measurements]:
    makers = {
        "drinking": lambda: motions.drink_from_mug(motions.WOMAN),
        "sliding": lambda: motions.slide_object(motions.TALL_MAN),
        "rolling": lambda: motions.roll_object(motions.WOMAN),
        "striking": lambda: motions.hit(motions.TALL_MAN),
    }
    capture = repeated(makers[name]().capture, 7)
    return capture, measure(capture)


def parts(data: st.DataObject, frames: int) -> tuple[int, int]:
    length = data.draw(st.integers(SHORTEST, min(frames, 3000)), label="length")
    first = data.draw(st.integers(0, frames - length), label="first")
    return first, first + length - 1


@pytest.mark.parametrize("name", ["drinking", "sliding", "rolling", "striking"])
@given(st.data())
@settings(max_examples=6, deadline=None)
def test_a_window_shows_what_the_whole_shows_in_its_inner_part(
    name: str, data: st.DataObject
) -> None:
    capture, measured = whole(name)
    found, expected = compared(capture, measured, *parts(data, len(capture.times)))
    assert found == expected


def test_the_windows_of_this_test_hold_facts_of_nearly_every_kind() -> None:
    kinds = set()
    for name in ("drinking", "sliding", "rolling", "striking"):
        capture, measured = whole(name)
        _, expected = compared(capture, measured, 0, len(capture.times) - 1)
        kinds |= {type(each).__name__ for each in expected}
    assert {each.__name__ for each in WINDOWED} - kinds <= {"Between", "Flies", "Passage"}


@pytest.mark.parametrize("place", ["manipnet:cube_med2", "hand_embodiment_pillow"])
def test_a_window_of_a_recording_shows_what_the_whole_shows(
    place: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    capture = read_capture(str(Path(__file__).parents[2] / "examples" / place))
    measured = measure(capture)
    frames = len(capture.times)
    found, expected = compared(capture, measured, frames // 5, 4 * frames // 5)
    assert {type(each) for each in expected} >= {ZeroCrossing, Pause}
    assert found == expected


def test_measuring_with_its_own_calibration_changes_nothing() -> None:
    capture = pick_and_place(noise_m=0.0005, noise_rad=0.002)
    plain = measure(capture)
    again = measure(capture, calibrate(capture))
    assert again.facts == plain.facts
    assert again.notices == plain.notices
    assert again.calibration == plain.calibration == calibrate(capture)


def test_a_calibration_comes_back_from_json() -> None:
    known = calibrate(pick_and_place(noise_m=0.0005))
    assert value_from_json(to_json(known), Calibration) == known


def test_a_calibration_holds_the_thresholds_it_was_made_with() -> None:
    limits = replace(Thresholds(), rest_speed_mps=0.05, swing_turns=6)
    known = calibrate(pick_and_place(), limits)
    assert thresholds_of(known) == limits


@given(st.floats(0.0003, 0.003))
@settings(max_examples=5, deadline=None)
def test_it_states_the_noise_of_each_stream(noise_m: float) -> None:
    known = calibrate(pick_and_place(noise_m=noise_m))
    assert known.tag_object("thing").noise_m == pytest.approx(noise_m, rel=0.25)


def test_a_fixed_object_stands_where_it_was_calibrated_in_every_part() -> None:
    noise = np.random.default_rng(0).normal(0.0, 0.002, (400, 3))
    shaken = still((0.0, 0.0, 0.7), 400)
    shaken = replace(shaken, positions=shaken.positions + noise)
    table = TagObject("table", TagType.FIXED, shaken, ball(0.3))
    capture = Capture("x", (hand(np.zeros((400, 3)), ball(0.05)),), (table,))
    known = calibrate(capture)
    fixed = known.tag_object("table").fixed
    assert fixed is not None
    assert fixed.position_m == pytest.approx((0.0, 0.0, 0.7), abs=0.0005)
    part = replace(table, stream=replace(shaken, positions=shaken.positions + 0.001))
    measured = measure(replace(capture, objects=(part,)), known)
    settled = measured.bodies.objects["table"].poses.settled
    assert (settled.positions == np.array(fixed.position_m)).all()


def test_a_calibration_of_another_rate_is_refused() -> None:
    known = calibrate(pick_and_place(rate_hz=50.0))
    with pytest.raises(CaptureError, match="100 frames a second"):
        measure(pick_and_place(rate_hz=100.0), known)


def test_a_calibration_that_lacks_a_body_is_refused() -> None:
    capture = pick_and_place()
    known = calibrate(replace(capture, objects=capture.objects[:1]))
    with pytest.raises(UnknownNameError, match="table"):
        measure(capture, known)


def test_measurements_keep_poses_and_nothing_computed_of_them() -> None:
    measured = measure(pick_and_place())
    for body in (*measured.bodies.sensors.values(), *measured.bodies.objects.values()):
        assert set(vars(body)) == {"name", "shape", "poses"}
