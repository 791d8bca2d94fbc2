"""Long, thin bodies go along their length or across it; other bodies have no such length."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import box, cup, shape, stream
from scipy.spatial.transform import Rotation

from capar.model.capture import Shape, TagObject, TagType
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.motion.phases import lengthwise, long_axis
from extractors.relations.places import pocket_m
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
SPAN = (50, 350)


def swung(form: Shape, way: np.ndarray, turn: Rotation, *, noise_m: float = 0.0) -> BodyGeometry:
    """A body that moves to and fro along a direction of its own at 1 Hz."""
    times = np.arange(400) / 100.0
    sine = 0.05 * np.sin(2.0 * np.pi * np.clip(times - 0.5, 0.0, 3.0))
    places = turn.apply(np.outer(sine, way / np.linalg.norm(way)))
    places += np.random.default_rng(0).normal(0.0, noise_m, places.shape)
    turns = np.tile(turn.as_quat(scalar_first=True), (len(times), 1))
    thing = TagObject("thing", TagType.MOBILE, stream(places, orientations=turns), form)
    return geometry_of(thing, LIMITS)


def any_turn(seed: int) -> Rotation:
    return Rotation.random(rng=np.random.default_rng(seed))


@given(st.floats(-35.0, 35.0), st.integers(0, 1000))
@settings(max_examples=15, deadline=None)
def test_a_blade_goes_along_its_length_however_it_is_turned(off_deg: float, seed: int) -> None:
    angle = np.radians(off_deg)
    way = np.array([np.cos(angle), np.sin(angle), 0.0])
    blade = swung(box(0.3, 0.04, 0.004), way, any_turn(seed), noise_m=0.0005)
    assert lengthwise(blade, (SPAN,), LIMITS) == (SPAN,)


@given(st.floats(55.0, 125.0), st.integers(0, 1000))
@settings(max_examples=15, deadline=None)
def test_a_blade_that_goes_across_its_length_does_not(off_deg: float, seed: int) -> None:
    angle = np.radians(off_deg)
    way = np.array([np.cos(angle), np.sin(angle), 0.0])
    assert lengthwise(swung(box(0.3, 0.04, 0.004), way, any_turn(seed)), (SPAN,), LIMITS) == ()


@given(st.floats(1.0, 2.5), st.integers(0, 1000))
@settings(max_examples=15, deadline=None)
def test_what_is_not_much_longer_than_wide_has_no_length_to_go_along(
    ratio: float, seed: int
) -> None:
    sponge = swung(box(0.08 * ratio, 0.08, 0.03), np.array([1.0, 0.0, 0.0]), any_turn(seed))
    assert long_axis(sponge, LIMITS) is None
    assert lengthwise(sponge, (SPAN,), LIMITS) == ()


def test_the_axis_is_the_bodys_own_whichever_way_its_mesh_is_turned() -> None:
    turn = any_turn(3)
    tilted = trimesh.creation.box((0.4, 0.03, 0.02))
    tilted.apply_transform(np.block([[turn.as_matrix(), np.zeros((3, 1))], [np.eye(4)[3:]]]))
    axis = long_axis(swung(shape(tilted), np.array([1.0, 0.0, 0.0]), any_turn(4)), LIMITS)
    assert axis is not None
    assert abs(axis @ turn.apply([1.0, 0.0, 0.0])) > 0.999


@given(st.floats(0.05, 0.4), st.floats(0.05, 0.4), st.floats(0.02, 0.3), st.integers(0, 1000))
@settings(max_examples=15, deadline=None)
def test_nothing_fits_in_a_box(x: float, y: float, z: float, seed: int) -> None:
    turn = np.eye(4)
    turn[:3, :3] = any_turn(seed).as_matrix()
    form = trimesh.creation.box((x, y, z))
    form.apply_transform(turn)
    assert pocket_m(shape(form)) <= LIMITS.pocket_share * max(x, y, z)


@pytest.mark.parametrize(("radius_m", "height_m"), [(0.04, 0.1), (0.12, 0.08), (0.11, 0.12)])
def test_something_fits_in_a_cup_a_bowl_and_a_pot(radius_m: float, height_m: float) -> None:
    form = cup(radius_m, height_m)
    assert pocket_m(form) > 2.0 * LIMITS.pocket_share * max(2.0 * radius_m, height_m) / 1.2


def test_how_much_fits_in_does_not_depend_on_how_finely_a_mesh_is_divided() -> None:
    coarse = trimesh.creation.box((0.3, 0.2, 0.1))
    fine = coarse.subdivide().subdivide().subdivide()
    assert abs(pocket_m(shape(coarse)) - pocket_m(shape(fine))) <= 0.3 / 40
