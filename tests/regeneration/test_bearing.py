"""What stands on a held thing, or in it, goes along; whether it would slide or fall is told."""

from dataclasses import replace

import numpy as np
import pytest
from combinations import one_of
from recorded_actions import RATE_HZ, good_trip, recorded
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.virtual_scenes import Thing, box, cup
from capar.regeneration.collisions import Surroundings
from capar.regeneration.holds import FRICTION, Load, steadiness, with_loads
from capar.regeneration.scenes import raised, resized, stack


@pytest.mark.parametrize("agent", one_of(["man", "child"]))
def test_another_body_carries_the_tray_and_the_mug_stays_on_it(agent: str) -> None:
    source = recorded("carry_tray")
    scene = resized(raised(source.scene, "table", -0.1), "tray", 1.15)
    trip = good_trip(source, agent, scene)
    assert trip.motion
    assert trip.quality
    things = trip.motion.plan.things
    seat = things["tray"].inv() * things["mug"]
    assert np.ptp(seat.translation, axis=0).max() < 1e-9
    assert things["mug"].translation[-1][0] < things["mug"].translation[0][0] - 0.1
    assert trip.quality.gate("borne: not to slide").value < np.degrees(np.arctan(FRICTION))
    assert trip.quality.gate("borne: not to fall").value > 20.0


def test_what_stands_on_the_table_is_raised_with_all_that_it_bears() -> None:
    scene = recorded("carry_tray").scene
    assert stack(scene, "table") == ["stand", "tray", "mug"]
    higher = raised(scene, "table", 0.1)
    for name in ("stand", "tray", "mug"):
        rise = higher.thing(name).pose.translation - scene.thing(name).pose.translation
        np.testing.assert_allclose(rise, [0.0, 0.0, 0.1], atol=1e-9)
    thicker = resized(scene, "tray", 2.0)
    assert thicker.support("mug") == "tray"


def test_what_is_on_what_is_borne_goes_along_too() -> None:
    ride = np.linspace([0.0, 0.0, 0.0], [0.2, 0.0, 0.1], 5)
    paths = {
        "tray": RigidTransform.from_translation(ride),
        "plate": RigidTransform.from_translation([[0.0, 0.05, 0.03]] * 5),
        "mug": RigidTransform.from_translation([[0.0, 0.05, 0.05]] * 5),
    }
    loads = (Load("plate", "tray", 1, 3), Load("mug", "plate", 1, 3))
    out = with_loads(paths, loads)
    np.testing.assert_allclose(out["mug"].translation[0], [0.0, 0.05, 0.05])
    np.testing.assert_allclose(
        out["mug"].translation[3] - out["mug"].translation[1], ride[3] - ride[1]
    )
    np.testing.assert_allclose(out["mug"].translation[4], out["mug"].translation[3])


def test_a_leaning_or_speeding_tray_is_measured_against_friction_and_support() -> None:
    mug = Thing("mug", cup(0.035, 0.09), (0.0, 0.0, 0.0))
    seat = RigidTransform.from_translation([0.0, 0.0, 0.03])
    level = steadiness(mug, seat, RigidTransform.from_translation(np.zeros((20, 3))), RATE_HZ)
    assert level.tilt_rad == pytest.approx(0.0, abs=1e-9)
    assert level.inside_m == pytest.approx(0.035, abs=1e-3)
    lean = RigidTransform.from_rotation(
        Rotation.from_rotvec(np.tile([0.0, np.radians(20.0), 0.0], (20, 1)))
    )
    leant = steadiness(mug, seat, lean, RATE_HZ)
    assert leant.tilt_rad == pytest.approx(np.radians(20.0), abs=1e-6)
    height_m = 0.0405  # of the middle of the cup's hull, half of its height above the tray, about
    assert 0.035 - leant.inside_m == pytest.approx(height_m * np.tan(np.radians(20.0)), abs=3e-3)
    times = np.arange(30) / RATE_HZ
    ahead = np.stack([0.5 * 4.0 * times**2, 0.0 * times, 0.0 * times], axis=1)
    sped = steadiness(mug, seat, RigidTransform.from_translation(ahead), RATE_HZ)
    assert sped.tilt_rad > np.arctan(4.0 / 9.81) - 1e-3


def test_a_thing_in_an_open_box_is_measured_against_its_walls() -> None:
    vessel, brick = cup(0.1, 0.1), box(0.05, 0.05, 0.05)
    things = {n: Thing(n, s, (0.0, 0.0, 0.0)) for n, s in (("vessel", vessel), ("brick", brick))}
    source = recorded("carry_tray")
    around = Surroundings(source.human, replace(source.scene, things=things))

    def apart_m(x: float) -> float:
        seat = RigidTransform.from_translation([x, 0.0, 0.005])
        around.pose(source.human.posture(), {"vessel": RigidTransform.identity(), "brick": seat})
        (pair,) = around.things_near()
        return pair.distance_m

    assert apart_m(0.0) == pytest.approx(0.001, abs=1e-3)
    assert apart_m(0.08) < -0.005
    assert apart_m(0.16) == pytest.approx(0.035, abs=1e-3)
