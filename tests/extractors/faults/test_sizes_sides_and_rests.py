"""People of no size, exchanged sides, and things that nothing bears are noticed."""

from dataclasses import replace

import numpy as np
import pytest
from faulty import changed, found, mirrored, scaled, turned
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import ball, box, pick_and_place, stream
from scipy.spatial.transform import Rotation

from capar.model.capture import (
    UNITS,
    UP,
    Capture,
    Conventions,
    Role,
    Sensor,
    TagObject,
    TagType,
    upward,
)

AHEAD = Rotation.from_euler("z", 30.0, degrees=True)
PLACES = {
    "head": (0.0, 0.0, 1.6), "right_hand": (0.3, -0.3, 1.0), "left_hand": (0.3, 0.3, 0.9),
    "right_foot": (0.0, -0.1, 0.1), "left_foot": (0.1, 0.1, 0.1),
}  # fmt: skip


def person(*names: str, stature: float = 1.0, facing: Rotation = AHEAD) -> Capture:
    """Sensors of a person who sways a little."""
    sway = 0.02 * np.sin(np.arange(200) / 30.0)[:, None] * [1.0, 1.0, 0.0]
    turns = np.tile(facing.as_quat(scalar_first=True), (200, 1))
    sensors = []
    for name in names:
        places = facing.apply(stature * (np.array(PLACES[name]) + sway))
        side, _, kind = name.rpartition("_")
        role = Role.ATTENDS if kind == "head" else Role.ACTS
        own = stream(places, rate_hz=100.0, orientations=turns)
        sensors.append(Sensor(name, kind, side or "none", f"{side}_{kind}", own, role=role))
    return Capture("person", tuple(sensors), ())


@settings(max_examples=30, deadline=None)
@given(
    stature=st.floats(0.5, 1.2),
    right=st.sampled_from(["m", "cm", "mm"]),
    declared=st.sampled_from(["m", "cm", "mm"]),
    names=st.sampled_from([tuple(PLACES), ("head", "right_hand"), ("head", "left_foot")]),
)
def test_a_person_of_no_size_is_noticed_with_the_unit_of_the_file(
    stature: float, right: str, declared: str, names: tuple[str, ...]
) -> None:
    sound = person(*names, stature=stature)
    how = Conventions(unit_m=UNITS[declared])
    read = changed(sound, scaled(UNITS[declared] / UNITS[right]), how)
    units = [each["unit"] for each in found(read) if each.code == "unit-contradicted"]
    assert units == ([] if right == declared else [right])


def test_a_hand_alone_that_is_always_faster_than_any_hand_is_noticed() -> None:
    times = np.arange(300) / 100.0
    places = np.outer(0.2 * np.sin(2.0 * np.pi * times), [1.0, 0.5, 0.2])
    hand = Sensor("right_hand", "hand", "right", "right_arm", stream(places, rate_hz=100.0))
    sound = Capture("hand", (hand,), ())
    assert found(sound) == []
    (each,) = found(changed(sound, scaled(1000.0)))
    assert (each.code, each["unit"]) == ("unit-contradicted", "mm")


@pytest.mark.parametrize(("factor", "unit"), [(1.0, None), (1000.0, "mm"), (100.0, "cm")])
def test_a_mesh_in_another_unit_is_noticed(factor: float, unit: str | None) -> None:
    still = stream(np.tile([0.0, 0.0, 1.0], (200, 1)), rate_hz=100.0)
    mug = TagObject("mug", TagType.MOBILE, still, box(*(factor * np.array([0.08, 0.08, 0.1]))))
    sensor = replace(person("right_hand").sensors[0], shape=ball(0.04))
    notices = found(Capture("mesh", (sensor,), (mug,)))
    assert [each["unit"] for each in notices] == ([unit] if unit else [])


@pytest.mark.parametrize("yaw_deg", [0.0, 90.0, 200.0])
def test_a_mirrored_person_is_noticed_and_a_sound_one_is_not(yaw_deg: float) -> None:
    sound = person(*PLACES, facing=Rotation.from_euler("z", yaw_deg, degrees=True))
    assert found(sound) == []
    exchanged = {"right": "left", "left": "right", "none": "none"}
    sensors = tuple(replace(each, side=exchanged[each.side]) for each in sound.sensors)
    assert [each.code for each in found(replace(sound, sensors=sensors))] == ["sides-exchanged"]
    assert [each.code for each in found(changed(sound, mirrored))] == ["sides-exchanged"]


@pytest.mark.parametrize("right", sorted(UP))
@pytest.mark.parametrize("noise_m", [0.0, 0.001])
def test_things_under_or_beside_their_table_show_the_axis(right: str, noise_m: float) -> None:
    sound = pick_and_place(noise_m=noise_m)
    read = changed(sound, turned(upward(right).inv()))
    axes = [each["up"] for each in found(read) if each.code == "up-contradicted"]
    assert axes == ([right] if right in ("y", "-y", "-z") else [])


def test_things_against_one_wall_at_one_height_show_no_axis() -> None:
    """Read with x upward, the box is moved along the table's face at one height, as on a floor."""
    for right in ("x", "-x"):
        assert found(changed(pick_and_place(), turned(upward(right).inv()))) == []
