"""What is on a hinge, a rail or a level top keeps to it for any body and in any scene."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from recorded_actions import good_trip, recorded
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.errors import FileError
from capar.pipelines.round_trips import numbered_scene
from capar.regeneration import Source
from capar.regeneration.body_frames import body_frames
from capar.regeneration.goals import (
    HINGE,
    RAIL,
    Constraint,
    constraints_of,
    object_goals,
    planes_of,
    scene_constraints,
)
from capar.regeneration.paths import object_paths
from capar.regeneration.scenes import Scene, mobile, raised, read_scene
from capar.regeneration.styles import own_style

LENGTHS = st.floats(-1.0, 1.0)


def _planned(source: Source, scene: Scene, name: str) -> RigidTransform:
    old, new = body_frames(source.human, source.scene), body_frames(source.human, scene)
    goals = object_goals(source, scene, old, new)
    return object_paths(source, scene, goals, source.human, own_style(source)).paths[name]


def _constraint(kind: str) -> Constraint:
    return Constraint(kind, "door", "frame", np.array([0.0, 0.4, 0.0]), np.array([0.0, 0.0, 1.0]))


@given(LENGTHS, LENGTHS, LENGTHS, LENGTHS)
def test_what_turns_about_the_hinge_never_strays_from_it(
    x: float, y: float, z: float, angle: float
) -> None:
    start = RigidTransform.from_components([1.0, 2.0, 0.5], Rotation.from_euler("z", 0.7))
    at = np.array([x, y, z])
    about = RigidTransform.from_translation([0.0, 0.4, 0.0])
    turn = RigidTransform.from_rotation(Rotation.from_euler("z", angle))
    seen = (start * about * turn * about.inv()).apply(at)[None]
    assert _constraint(HINGE).strays(start, at, seen)[0] < 1e-9


def test_hinges_rails_and_planes_are_measured_from_recordings() -> None:
    door, drawer = constraints_of(recorded("door")), constraints_of(recorded("drawer"))
    assert door["door"].kind == HINGE
    assert door["door"].other == "frame"
    np.testing.assert_allclose(door["door"].point[:2], [0.0, 0.42], atol=1e-3)
    np.testing.assert_allclose(np.abs(door["door"].axis), [0.0, 0.0, 1.0], atol=1e-3)
    assert drawer["drawer"].kind == RAIL
    np.testing.assert_allclose(np.abs(drawer["drawer"].axis), [1.0, 0.0, 0.0], atol=1e-3)
    assert planes_of(recorded("slide"))["mug"].other == "table"
    assert not planes_of(recorded("carry"))
    assert not planes_of(recorded("door"))


@pytest.mark.parametrize(
    ("action", "thing", "base"), [("door", "door", "frame"), ("drawer", "drawer", "chest")]
)
def test_in_another_place_and_size_it_moves_on_its_own_line(
    action: str, thing: str, base: str, tmp_path: Path
) -> None:
    source = recorded(action)
    file = tmp_path / "scene.toml"
    x, y, z = source.scene.thing(base).place
    file.write_text(
        f"[object.{base}]\nsize = 0.8\nposition = [{x + 0.05}, {y - 0.03}, {z + 0.1}]\n"
        "turn_deg = 9\n"
    )
    scene = read_scene(file, source.scene)
    path, old = _planned(source, scene, thing), source.paths[thing]
    middle = scene.thing(thing).shape.bounds.mean(axis=0)
    line = scene_constraints(source, scene)[thing]
    off = line.strays(scene.thing(thing).pose, middle, path.apply(middle))
    assert off.max() < 1e-6
    turned = (path[-1].rotation * path[0].rotation.inv()).magnitude()
    assert turned == pytest.approx((old[-1].rotation * old[0].rotation.inv()).magnitude(), abs=1e-3)
    gone, before = (
        float(np.linalg.norm(way.translation[-1] - way.translation[0])) for way in (path, old)
    )
    assert gone == pytest.approx(0.8 * before, abs=1e-3)


def test_what_hangs_on_something_goes_along_with_it_and_not_alone(tmp_path: Path) -> None:
    scene = recorded("door").scene
    assert scene.fastened == {"door": "frame"}
    assert "door" not in mobile(scene)
    higher = raised(scene, "frame", 0.2)
    assert higher.thing("door").place[2] == pytest.approx(scene.thing("door").place[2] + 0.2)
    drawn = numbered_scene(recorded("door"), 1, 7)
    factor = drawn.thing("frame").size[0] / scene.thing("frame").size[0]
    local, before = (
        each.thing("frame").pose.inv().apply(each.thing("door").place) for each in (drawn, scene)
    )
    np.testing.assert_allclose(local, factor * before, atol=1e-9)
    file = tmp_path / "scene.toml"
    file.write_text("[object.door]\nraise_m = 0.1\n")
    with pytest.raises(FileError, match=r"(?s)hangs on 'frame'.*\[object.frame\]"):
        read_scene(file, scene)


def test_a_door_is_opened_by_another_body_as_it_was_on_its_hinge() -> None:
    source = recorded("door")
    trip = good_trip(source, "woman")
    assert trip.quality
    way = trip.quality.gate("constraint way")
    assert way.limit == 2.0
    assert 0.0 < way.value < 2.0
