"""What stands on a held thing, or in it, goes along; whether it would slide or fall is told."""

from functools import cache

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import perform
from capar.body.recording import record
from capar.body.scenes import Thing, box, cup, table
from capar.body.scenes import scene as things_scene
from capar.body.scripted_actions import action_capture
from capar.body.scripts import SIDES, STAND, Hand, Move, Phase
from capar.body.sensors import PERFECT
from capar.model.capture import Capture, Shape
from capar.pipelines.round_trips import body, observed_source, round_trip
from capar.regeneration import Source
from capar.regeneration.collisions import inner_gap
from capar.regeneration.holds import FRICTION, Load, steadiness, with_loads
from capar.regeneration.scenes import raised, resized, stack

RATE_HZ = 30.0


@cache
def _capture() -> Capture:
    return action_capture("carry_tray", rate_hz=RATE_HZ)


@cache
def _source() -> Source:
    return observed_source(_capture())


def test_a_mug_on_a_tray_that_both_hands_carry_rides_on_it() -> None:
    source = _source()
    (ride,) = source.loads
    assert (ride.thing, ride.bearer) == ("mug", "tray")
    assert ride.first == min(hold.first for hold in source.holds)


@pytest.mark.parametrize("agent", ["man", "child"])
def test_another_body_carries_the_tray_and_the_mug_stays_on_it(agent: str) -> None:
    source = _source()
    scene = resized(raised(source.scene, "table", -0.1), "tray", 1.15)
    trip = round_trip(source, agent, body(agent, source), 1, scene)
    assert trip.passed, (trip.refused, trip.names, trip.quality and trip.quality.failed)
    assert trip.motion is not None
    assert trip.quality is not None
    things = trip.motion.plan.things
    seat = things["tray"].inv() * things["mug"]
    assert np.ptp(seat.translation, axis=0).max() < 1e-9
    assert things["mug"].translation[-1][0] < things["mug"].translation[0][0] - 0.1
    assert trip.quality.gate("borne: not to slide").value < np.degrees(np.arctan(FRICTION))
    assert trip.quality.gate("borne: not to fall").value > 20.0


def _open_box(x_m: float, y_m: float, z_m: float, wall_m: float = 0.008) -> Shape:
    """Open above, standing on its frame's origin."""
    half = 0.5 * wall_m
    parts = (
        ((x_m, y_m, wall_m), (0.0, 0.0, half)),
        ((wall_m, y_m, z_m), (0.5 * x_m - half, 0.0, 0.5 * z_m)),
        ((wall_m, y_m, z_m), (half - 0.5 * x_m, 0.0, 0.5 * z_m)),
        ((x_m, wall_m, z_m), (0.0, 0.5 * y_m - half, 0.5 * z_m)),
        ((x_m, wall_m, z_m), (0.0, half - 0.5 * y_m, 0.5 * z_m)),
    )
    made = []
    for extents, middle in parts:
        made.append(trimesh.creation.box(extents=extents))
        made[-1].apply_translation(middle)
    mesh = trimesh.util.concatenate(made)
    return Shape(np.array(mesh.vertices), np.array(mesh.faces), description="open box")


def _full_box() -> Capture:
    """A man lifts an open box with a mug and a block in it, draws it nearer and lays it down."""
    human = Human.of(ready_made("man"))
    tall = human.measures["stature"]
    top, x = 0.52 * tall, 0.26 * tall
    where = things_scene(
        table(top, near_m=0.13 * tall),
        Thing("open_box", _open_box(0.18, 0.22, 0.15), (x, 0.02 * tall, top)),
        Thing("mug", cup(0.035, 0.09), (x, 0.07, top + 0.0085), round=True),
        Thing("block", box(0.05, 0.05, 0.05), (x, -0.02, top + 0.0085)),
    )
    moves = {"lift": (0.0, 0.0, 0.15), "carry": (-0.1, 0.0, 0.0), "lower": (0.0, 0.0, -0.15)}
    both = {side: Hand("holds", "open_box") for side in SIDES}
    reach = {side: Hand("reaches", "open_box") for side in SIDES}
    script = (
        STAND,
        Phase("reach", 1.1, reach, look="open_box"),
        Phase("grasp", 0.3, both, look="open_box"),
        *(
            Phase(
                name, 1.0, both, dict.fromkeys(("open_box", "mug", "block"), Move(by)), "open_box"
            )
            for name, by in moves.items()
        ),
        Phase("release", 0.3, both, look="open_box"),
        Phase("return", 1.0, look="ahead"),
        STAND,
    )
    made = perform(human, where, script, rate_hz=RATE_HZ)
    return record(made, name="full_box", seed=3, tracker=PERFECT)


def test_what_is_in_an_open_box_goes_along_and_cuts_no_wall() -> None:
    source = observed_source(_full_box())
    assert {(ride.thing, ride.bearer) for ride in source.loads} == {
        ("mug", "open_box"),
        ("block", "open_box"),
    }
    trip = round_trip(source, "child", body("child", source), 0, source.scene)
    assert trip.passed, (trip.refused, trip.names, trip.quality and trip.quality.failed)
    assert trip.motion is not None
    things = trip.motion.plan.things
    gone = things["block"].translation[-1] - things["block"].translation[0]
    np.testing.assert_allclose(
        gone, things["open_box"].translation[-1] - things["open_box"].translation[0], atol=1e-9
    )


def test_what_stands_on_the_table_is_raised_with_all_that_it_bears() -> None:
    scene = _source().scene
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


def _tray(count: int) -> RigidTransform:
    return RigidTransform.from_translation(np.zeros((count, 3)))


def test_a_leaning_or_speeding_tray_is_measured_against_friction_and_support() -> None:
    mug = Thing("mug", cup(0.035, 0.09), (0.0, 0.0, 0.0))
    seat = RigidTransform.from_translation([0.0, 0.0, 0.03])
    level = steadiness(mug, seat, _tray(20), RATE_HZ)
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
    inside = inner_gap(vessel, brick, RigidTransform.from_translation([0.0, 0.0, 0.005]))
    assert inside == pytest.approx(0.001, abs=1e-3)
    through = inner_gap(vessel, brick, RigidTransform.from_translation([0.08, 0.0, 0.005]))
    assert through is not None
    assert through < -0.005
    assert inner_gap(brick, brick, RigidTransform.identity()) is None
