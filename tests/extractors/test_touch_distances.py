"""Where a capture states no distance, the recording tells at which distance bodies touch."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import hand, pick_and_place, still

from capar.model.calibration import Calibration, Found
from capar.model.capture import Capture, PivotContact, TagObject, TagType
from capar.model.errors import CaparError, UnknownNameError
from capar.model.facts import Touching
from extractors.calibration import calibrate, set_values
from extractors.measure import measure

TOUCHES_S, LEAVES_S = 1.1, 2.8
"""When the hand of ``pick_and_place`` truly touches the thing, and leaves it [s]."""

offsets = st.tuples(*[st.floats(-0.12, 0.12)] * 3)


def moved(capture: Capture, hand_m: tuple[float, ...], thing_m: tuple[float, ...]) -> Capture:
    """The capture with other origins of hand and thing, and without their shapes."""
    (sensor,), (thing, table) = capture.sensors, capture.objects

    def shifted(each: np.ndarray, offset: tuple[float, ...]) -> np.ndarray:
        return np.asarray(each + np.array(offset))

    hands = replace(sensor.stream, positions=shifted(sensor.stream.positions, hand_m))
    things = replace(thing.stream, positions=shifted(thing.stream.positions, thing_m))
    return replace(
        capture,
        sensors=(replace(sensor, stream=hands, shape=None),),
        objects=(replace(thing, stream=things, shape=None), table),
    )


def spans(capture: Capture, first: str, second: str) -> list[tuple[float, float]]:
    times = capture.times
    return [
        (float(times[each.first]), float(times[each.last]))
        for each in measure(capture).facts
        if isinstance(each, Touching) and (each.body, each.other) == (first, second)
    ]


@given(offsets, offsets, st.sampled_from([60.0, 100.0, 240.0]), st.integers(0, 3))
@settings(max_examples=15, deadline=None)
def test_contact_is_found_wherever_on_the_bodies_the_origins_sit(
    hand_m: tuple[float, ...], thing_m: tuple[float, ...], rate_hz: float, seed: int
) -> None:
    plain = pick_and_place(rate_hz=rate_hz, noise_m=0.0005, noise_rad=0.002, seed=seed)
    capture = moved(plain, hand_m, (thing_m[0], thing_m[1], abs(thing_m[2])))
    pair = calibrate(capture).pair("right_hand", "thing")
    assert pair.found is Found.CO_MOTION
    assert 0.02 <= pair.touch_m <= 0.025
    ((start_s, end_s),) = spans(capture, "right_hand", "thing")
    assert start_s == pytest.approx(TOUCHES_S, abs=0.15)
    assert end_s == pytest.approx(LEAVES_S, abs=0.15)


@given(offsets)
@settings(max_examples=10, deadline=None)
def test_what_rests_unheld_on_a_support_touches_it_until_it_is_lifted(
    hand_m: tuple[float, ...],
) -> None:
    capture = moved(pick_and_place(noise_m=0.0003), hand_m, (0.0, 0.0, 0.02))
    pair = calibrate(capture).pair("thing", "table")
    assert pair.found is Found.REST
    assert pair.touch_m == pytest.approx(0.07 + 0.005, abs=0.003)
    (_, up_s), (down_s, _) = spans(capture, "thing", "table")
    assert 1.4 <= up_s <= 1.6
    assert 2.2 <= down_s <= 2.4


def holding(times: np.ndarray, *, held_m: float) -> Capture:
    """A hand without a shape that rests for 2 s beside a bowl that never moves, and goes back."""
    way = np.clip(np.minimum(times - 1.0, 4.0 - times) / 0.6, 0.0, 1.0)[:, None]
    home, there = np.array([-0.45, 0.0, 0.0]), np.array([-held_m, 0.0, 0.0])
    bowl = TagObject("bowl", TagType.MOBILE, still((0.0, 0.0, 0.0), len(times)))
    shelf = TagObject("pot", TagType.MOBILE, still((0.0, -0.6, 0.0), len(times)))
    way = way**3 * (10.0 - 15.0 * way + 6.0 * way**2)
    return Capture("hold", (hand(home + (there - home) * way, None),), (bowl, shelf))


@given(st.floats(0.03, 0.24))
@settings(max_examples=15, deadline=None)
def test_a_thing_that_is_held_and_never_moves_is_touched_where_the_distance_settles(
    held_m: float,
) -> None:
    capture = holding(np.arange(500) / 100.0, held_m=held_m)
    known = calibrate(capture)
    assert known.pair("right_hand", "bowl").found is Found.SETTLING
    assert known.pair("right_hand", "pot").found is Found.NEVER
    ((start_s, end_s),) = spans(capture, "right_hand", "bowl")
    assert 1.2 <= start_s <= 1.6
    assert 3.4 <= end_s <= 3.8


def test_a_hand_that_only_rests_at_home_touches_nothing() -> None:
    bowl = TagObject("bowl", TagType.MOBILE, still((0.1, 0.0, 0.0), 300))
    capture = Capture("home", (hand(np.zeros((300, 3)), None),), (bowl,))
    measured = measure(capture)
    pair = measured.calibration.pair("right_hand", "bowl")
    assert pair.found is Found.NEVER
    assert {"no-shape"} <= {each.code for each in measured.notices}
    stated = set_values(measured.calibration, ["touch_m:right_hand,bowl=0.12"])
    assert stated.pair("right_hand", "bowl").pivots


@pytest.mark.parametrize(("stated_m", "contradicted"), [(0.05, True), (0.13, False), (0.3, True)])
def test_a_stated_distance_holds_and_a_notice_tells_both_numbers_where_it_is_wrong(
    stated_m: float, contradicted: bool
) -> None:
    capture = moved(pick_and_place(), (-0.03, 0.0, 0.0), (0.0, 0.0, 0.0))
    pivots = (PivotContact("right_hand", "thing", stated_m),)
    measured = measure(replace(capture, pivot_contacts=pivots))
    pair = measured.calibration.pair("right_hand", "thing")
    assert (pair.found, pair.touch_m) == (Found.STATED, stated_m)
    told = [each for each in measured.notices if each.code == "distance-contradicted"]
    assert bool(told) is contradicted
    for each in told:
        assert each["touch_m"] == stated_m
        assert each["shown_m"] == pytest.approx(0.112 + 0.02, abs=0.002)


def test_a_hand_whose_mount_is_off_by_centimetres_is_told_with_the_gap() -> None:
    capture = pick_and_place()
    (sensor,) = capture.sensors
    off = replace(sensor.stream, positions=sensor.stream.positions - np.array([0.03, 0.0, 0.0]))
    measured = measure(replace(capture, sensors=(replace(sensor, stream=off),)))
    (told,) = [each for each in measured.notices if each.code == "mount-gap"]
    assert told.bodies == ("right_hand", "thing")
    assert told["shown_m"] == pytest.approx(0.032, abs=0.001)
    assert not [each for each in measure(capture).notices if each.code == "mount-gap"]


def known() -> Calibration:
    return calibrate(moved(pick_and_place(), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))


def test_one_value_is_set_for_a_run_and_no_other() -> None:
    plain = known()
    changed = set_values(plain, ["touch_m:thing,right_hand=0.12"])
    pair = changed.pair("right_hand", "thing")
    assert (pair.touch_m, pair.found) == (0.12, Found.STATED)
    others = [each for each in changed.pairs if each is not pair]
    assert others == [
        each for each in plain.pairs if each.first != "right_hand" or each.second != "thing"
    ]
    assert replace(changed, pairs=plain.pairs) == plain
    assert set_values(plain, ["contact_dropout_s=0.2"]).contact_dropout_s == 0.2
    assert (
        set_values(plain, ["motion_floor_m:thing=0.02"]).tag_object("thing").motion_floor_m == 0.02
    )


def test_a_stated_distance_is_that_of_surfaces_where_surfaces_were_measured() -> None:
    plain = calibrate(pick_and_place())
    pair = plain.pair("right_hand", "thing")
    assert (pair.found, pair.pivots) == (Found.TOLERANCE, False)
    changed = set_values(plain, ["touch_m:thing,right_hand=0.01"]).pair("right_hand", "thing")
    assert (changed.found, changed.pivots) == (Found.STATED, False)


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ("touch_m:right_hand,thing", "no value"),
        ("touch_m:right_hand,thing=wide", "no number"),
        ("touch_m:right_hand,thing=-0.1", "above zero"),
        ("contact_dropout_s:thing=0.1", "whole capture"),
    ],
)
def test_a_setting_of_another_form_is_refused(setting: str, said: str) -> None:
    with pytest.raises(CaparError, match=said):
        set_values(known(), [setting])


@pytest.mark.parametrize(
    "setting", ["tuch_m:a,b=1", "touch_m:right_hand,thnig=0.1", "motion_floor_m:x=1"]
)
def test_a_setting_of_something_unknown_names_what_is_known(setting: str) -> None:
    with pytest.raises(UnknownNameError, match=r"touch_m|right_hand"):
        set_values(known(), [setting])
