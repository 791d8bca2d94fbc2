"""Where a hand is from the trunk does not depend on where the body is, or faces, or bends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Stream, TagObject, TagType
from extractors.bodies.bodies import BodyGeometry, from_trunk, geometry_of
from extractors.thresholds import Thresholds

TIMES = np.arange(20) / 100.0
MOUNTS = st.tuples(st.floats(-180.0, 180.0), st.floats(-80.0, 80.0), st.floats(-80.0, 80.0))
ANGLES = st.floats(-170.0, 170.0)
PLACES = st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.floats(0.0, 1.5))


def body(place: np.ndarray, turn: Rotation) -> BodyGeometry:
    """A body without a shape that stays at a place [m]."""
    places = np.tile(np.asarray(place, float), (len(TIMES), 1))
    turns = np.tile(geometry.quaternions(turn), (len(TIMES), 1))
    stream = Stream(TIMES, places, geometry.continuous(turns))
    return geometry_of(TagObject("body", TagType.MOBILE, stream, None), Thresholds())


def seen(hand: np.ndarray, at: np.ndarray, turn: Rotation, mount: Rotation) -> np.ndarray:
    """Where a hand is from a trunk that is at a place, and turned from how it stands [m]."""
    trunk = body(at, turn * mount)
    return from_trunk(body(hand, Rotation.identity()), trunk, mount.inv().apply([0.0, 0.0, 1.0]))[0]


@given(MOUNTS, PLACES, ANGLES, PLACES)
def test_who_walks_and_turns_keeps_a_hand_where_it_is(
    mount: tuple[float, float, float],
    offset: tuple[float, float, float],
    heading: float,
    goal: tuple[float, float, float],
) -> None:
    own = Rotation.from_euler("xyz", mount, degrees=True)
    facing = Rotation.from_euler("z", heading, degrees=True)
    before = seen(np.array(offset), np.zeros(3), Rotation.identity(), own)
    after = seen(np.array(goal) + facing.apply(offset), np.array(goal), facing, own)
    assert after == pytest.approx(before, abs=1e-6)
    assert np.linalg.norm(before) == pytest.approx(np.linalg.norm(offset), abs=1e-6)
    assert before[2] == pytest.approx(offset[2], abs=1e-6)


@given(MOUNTS, PLACES, st.floats(-80.0, 80.0), st.floats(-180.0, 180.0))
def test_who_bends_over_has_not_moved_a_hand(
    mount: tuple[float, float, float],
    offset: tuple[float, float, float],
    lean: float,
    towards: float,
) -> None:
    own = Rotation.from_euler("xyz", mount, degrees=True)
    axis = np.array([np.cos(np.radians(towards)), np.sin(np.radians(towards)), 0.0])
    bent = Rotation.from_rotvec(np.radians(lean) * axis)
    upright = seen(np.array(offset), np.zeros(3), Rotation.identity(), own)
    assert seen(np.array(offset), np.zeros(3), bent, own) == pytest.approx(upright, abs=1e-6)


def test_where_the_trunk_is_lost_nothing_is_told() -> None:
    ways = np.zeros((len(TIMES), 3))
    ways[5] = np.nan
    hand = body(np.ones(3), Rotation.identity())
    orientations = np.tile([1.0, 0.0, 0.0, 0.0], (len(TIMES), 1))
    orientations[5] = np.nan
    stream = Stream(TIMES, ways, orientations)
    trunk = geometry_of(TagObject("body", TagType.MOBILE, stream, None), Thresholds())
    lost = np.isnan(from_trunk(hand, trunk, np.array([0.0, 0.0, 1.0]))).any(axis=1)
    assert (lost == trunk.poses.smooth.lost).all()
