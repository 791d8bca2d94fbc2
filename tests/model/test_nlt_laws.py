"""Normalised local transforms obey their laws."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from capar.model.locations import Nlt, local_point, normalised, relative_orientation, restored

NUMBERS = st.floats(-5.0, 5.0, allow_subnormal=False)
PLACES = st.tuples(NUMBERS, NUMBERS, NUMBERS)
TURNS = st.tuples(NUMBERS, NUMBERS, NUMBERS, NUMBERS).filter(
    lambda turn: float(np.linalg.norm(turn)) > 0.1
)


def unit(turn: tuple[float, float, float, float]) -> np.ndarray:
    return np.array(turn) / np.linalg.norm(turn)


@given(PLACES, TURNS, st.integers(0, 2))
def test_mirroring_twice_changes_nothing(
    place: tuple[float, float, float], turn: tuple[float, float, float, float], axis: int
) -> None:
    nlt = Nlt(place, tuple(map(float, unit(turn))))  # type: ignore[arg-type]
    assert nlt.mirrored(axis).mirrored(axis) == nlt


@given(PLACES, TURNS, st.tuples(*[st.floats(0.01, 3.0)] * 3))
def test_a_location_is_restored_from_its_nlt(
    place: tuple[float, float, float],
    turn: tuple[float, float, float, float],
    size_m: tuple[float, float, float],
) -> None:
    nlt = normalised(np.array(place), unit(turn), np.array(size_m))
    point, orientation = restored(nlt, np.array(size_m))
    assert point == pytest.approx(place)
    assert abs(orientation @ unit(turn)) == pytest.approx(1.0)


def test_an_axis_without_extent_keeps_its_metres() -> None:
    nlt = normalised(np.array([0.1, 0.2, 0.3]), np.array([1.0, 0, 0, 0]), np.array([0.2, 0.0, 0.6]))
    assert nlt.position == pytest.approx((0.5, 0.2, 0.5))


SIZES = st.tuples(*[st.floats(0.01, 3.0)] * 3)


@given(PLACES, TURNS, st.integers(0, 2), SIZES)
def test_mirroring_reflects_the_place_and_the_axes(
    place: tuple[float, float, float],
    turn: tuple[float, float, float, float],
    axis: int,
    size_m: tuple[float, float, float],
) -> None:
    nlt = normalised(np.array(place), unit(turn), np.array(size_m))
    reflection = np.eye(3)
    reflection[axis, axis] = -1.0
    point, orientation = restored(nlt.mirrored(axis), np.array(size_m))
    assert point == pytest.approx(reflection @ np.array(place))
    turned = Rotation.from_quat(unit(turn), scalar_first=True).as_matrix()
    found = Rotation.from_quat(orientation, scalar_first=True).as_matrix()
    assert found == pytest.approx(reflection @ turned @ reflection)


@given(PLACES, TURNS, SIZES)
def test_the_nlt_of_an_object_twice_as_large_restores_twice_as_far(
    place: tuple[float, float, float],
    turn: tuple[float, float, float, float],
    size_m: tuple[float, float, float],
) -> None:
    nlt = normalised(np.array(place), unit(turn), np.array(size_m))
    point, _ = restored(nlt, 2.0 * np.array(size_m))
    assert point == pytest.approx(2.0 * np.array(place))


@given(PLACES, TURNS, PLACES, TURNS)
def test_an_nlt_does_not_depend_on_where_in_the_world_both_bodies_are(
    place: tuple[float, float, float],
    turn: tuple[float, float, float, float],
    shift: tuple[float, float, float],
    about: tuple[float, float, float, float],
) -> None:
    world = Rotation.from_quat(unit(about), scalar_first=True)
    base, other = unit(turn), unit((turn[1], turn[0], turn[3], turn[2]))
    moved = [
        (world * Rotation.from_quat(each, scalar_first=True)).as_quat(scalar_first=True)
        for each in (base, other)
    ]
    point = np.array([0.1, -0.2, 0.3])
    near = local_point(np.array(place), base, point)
    far = local_point(world.apply(place) + shift, moved[0], world.apply(point) + shift)
    assert far == pytest.approx(near, abs=1e-9)
    one, two = relative_orientation(base, other), relative_orientation(*moved)
    assert abs(float(one @ two)) == pytest.approx(1.0)
