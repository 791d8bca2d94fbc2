"""A foot stands where it is nearly still against the ground, be that a floor or a belt."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import box, still, stream

from capar.model.capture import Capture, Sensor, TagObject, TagType
from capar.model.facts import Touching
from extractors.calibration import calibrate
from extractors.measure import measure
from extractors.thresholds import Thresholds

RATE_HZ = 100.0
SOLE_M = 0.04
FLOOR = box(20.0, 4.0, 0.1)
NAMES = ("right_foot", "left_foot")


def measured_walk(
    places: dict[str, np.ndarray], rate_hz: float = RATE_HZ, on: TagType = TagType.FIXED
) -> Capture:
    """Feet without joints at such places [m] above a floor whose top is at zero."""
    feet = [
        Sensor(name, "foot", name.split("_")[0], f"{name}_leg", stream(place, rate_hz=rate_hz),
               box(0.26, 0.1, 2 * SOLE_M))
        for name, place in places.items()
    ]  # fmt: skip
    count = len(next(iter(places.values())))
    floor = TagObject("floor", on, still((0.0, 0.0, -0.05), count, rate_hz=rate_hz), FLOOR)
    return Capture("trial", tuple(feet), (floor,))


def contacts_of(capture: Capture, foot: str) -> list[tuple[int, int]]:
    facts = measure(capture).facts
    return [(each.first, each.last) for each in facts
            if isinstance(each, Touching) and each.body == foot]  # fmt: skip


def level(way: np.ndarray, aside: float = 0.0, height: float = SOLE_M) -> np.ndarray:
    """A foot flat on the floor, or so high, that goes such a way along x."""
    return np.stack([way, np.full_like(way, aside), np.full_like(way, height)], axis=1)


def swinging(belt_mps: float, swing_mps: float, phase: float, clearance_m: float) -> np.ndarray:
    """A foot that goes along with a belt for 0.6 s and swings forwards low for 0.4 s, in turn."""
    times = np.arange(400) / RATE_HZ
    swings = ((times + phase) % 1.0) >= 0.6
    soft = np.convolve(swings, np.full(9, 1 / 9), mode="same")
    pace = belt_mps + soft * (swing_mps - belt_mps)
    out = level(np.cumsum(pace) / RATE_HZ)
    out[:, 2] += clearance_m * soft
    return out


@given(st.floats(0.8, 4.0), st.sampled_from([30.0, 60.0, 100.0, 240.0]))
@settings(max_examples=15, deadline=None)
def test_a_foot_that_passes_low_touches_the_floor_only_once_it_is_still(
    speed_mps: float, rate_hz: float
) -> None:
    times = np.arange(round(2.0 * rate_hz)) / rate_hz
    way = speed_mps * np.minimum(times, 1.0)
    ((first, last),) = contacts_of(measured_walk({"right_foot": level(way)}, rate_hz), "right_foot")
    assert first / rate_hz == pytest.approx(1.0, abs=0.07)
    assert last == len(times) - 1


@given(st.floats(-0.4, 0.4))
@settings(max_examples=10, deadline=None)
def test_a_foot_that_shuffles_slowly_never_leaves_the_floor(speed_mps: float) -> None:
    way = speed_mps * np.arange(200) / RATE_HZ
    assert contacts_of(measured_walk({"right_foot": level(way)}), "right_foot") == [(0, 199)]


def test_a_foot_stands_while_it_rolls_over_its_ball() -> None:
    turn = np.linspace(0.0, 1.0, 60)
    angle = np.concatenate([np.zeros(60), turn, np.ones(80)])
    toe = np.array([0.13, 0.0, -SOLE_M])
    middle = np.stack([-toe[0] * np.cos(angle) - toe[2] * np.sin(angle), 0 * angle,
                       toe[0] * np.sin(angle) - toe[2] * np.cos(angle)], axis=1)  # fmt: skip
    turned = np.stack([np.cos(angle / 2), 0 * angle, np.sin(angle / 2), 0 * angle], axis=1)
    capture = measured_walk({"right_foot": middle})
    (foot,) = capture.sensors
    rolled = replace(foot, stream=replace(foot.stream, orientations=turned))
    assert contacts_of(replace(capture, sensors=(rolled,)), "right_foot") == [(0, 199)]


def test_feet_on_a_belt_stand_while_they_go_along_with_it() -> None:
    feet = {name: swinging(-1.2, 1.8, phase, 0.004)
            for name, phase in zip(NAMES, (0.0, 0.5), strict=True)}  # fmt: skip
    capture = measured_walk(feet)
    (belt,) = calibrate(capture).moving_grounds
    assert belt.ground == "floor"
    assert belt.velocity_mps == pytest.approx((-1.2, 0.0), abs=0.02)
    for first, last in contacts_of(capture, "right_foot")[:3]:
        assert (last - first) / RATE_HZ == pytest.approx(0.58, abs=0.08)
    codes = [each.code for each in measure(capture).notices]
    assert codes.count("moving-ground") == 1


@pytest.mark.parametrize("belt_mps", [0.0, -0.3])
def test_a_floor_on_which_feet_come_to_rest_does_not_move(belt_mps: float) -> None:
    feet = {name: swinging(belt_mps, 2.0, phase, 0.004)
            for name, phase in zip(NAMES, (0.0, 0.5), strict=True)}  # fmt: skip
    assert not calibrate(measured_walk(feet)).moving_grounds


def test_one_foot_alone_tells_of_no_belt() -> None:
    capture = measured_walk({"right_foot": swinging(-1.2, 1.8, 0.0, 0.004)})
    assert not calibrate(capture).moving_grounds


def test_how_fast_a_foot_glides_is_a_number_that_can_be_set() -> None:
    way = 0.8 * np.arange(200) / RATE_HZ
    capture = measured_walk({"right_foot": level(way)})
    assert not contacts_of(capture, "right_foot")
    patient = calibrate(capture, Thresholds(foot_glides_mps=1.0))
    touching = [each for each in measure(capture, patient).facts if isinstance(each, Touching)]
    assert touching == [Touching("right_foot", "floor", 0, 199)]
