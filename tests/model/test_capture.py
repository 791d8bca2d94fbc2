"""Captures, geometry and places on objects: what is refused, and laws."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model import geometry
from capar.model.capture import (
    Capture,
    PivotContact,
    Role,
    Sensor,
    Shape,
    Stream,
    TagObject,
    TagType,
)
from capar.model.errors import CaptureError, UnknownNameError
from capar.model.locations import local_point, normalised, relative_orientation, restored

TURN = np.array([[1.0, 0.0, 0.0, 0.0]])


def stream(frames: int = 5, *, step_s: float = 0.01, **changes: Any) -> Stream:
    parts = {
        "times": np.arange(frames) * step_s,
        "positions": np.zeros((frames, 3)),
        "orientations": np.repeat(TURN, frames, axis=0),
    }
    return Stream(**{**parts, **changes})


def sensor(name: str = "right_hand", **changes: Any) -> Sensor:
    parts = {"end_effector": "hand", "side": "right", "link": "right_arm", "stream": stream()}
    return Sensor(name, **{**parts, **changes})


def mug(name: str = "mug", **changes: Any) -> TagObject:
    return TagObject(name, TagType.MOBILE, **{"stream": stream(), **changes})


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"times": np.array([0.0, 0.01, 0.01, 0.02, 0.03])}, "time goes from 0.01 s to 0.01 s at"),
        ({"times": np.array([0.0, 0.02, 0.01, 0.03, 0.04])}, "must increase"),
        ({"times": np.array([0.0, np.nan, 0.02, 0.03, 0.04])}, "time stamp 1 is no number"),
        ({"positions": np.zeros((4, 3))}, "5 times, but positions"),
        ({"orientations": np.zeros((5, 4))}, "norm 0"),
        ({"orientations": np.full((5, 4), 1.0)}, "norm 2"),
        ({"positions": np.full((5, 3), np.inf)}, "infinite"),
    ],
)
def test_a_stream_that_no_body_made_is_refused(changes: dict[str, Any], says: str) -> None:
    with pytest.raises(CaptureError, match=says):
        stream(**changes)


def test_a_frame_without_position_or_orientation_is_lost_whole() -> None:
    positions, turns = np.zeros((5, 3)), np.repeat(TURN, 5, axis=0)
    positions[1, 2] = np.nan
    turns[3, 0] = np.nan
    out = stream(positions=positions, orientations=turns)
    assert out.lost.tolist() == [False, True, False, True, False]
    assert np.isnan(out.orientations[1]).all()
    assert np.isnan(out.positions[3]).all()


def test_what_a_stream_holds_cannot_be_changed_and_is_its_own() -> None:
    positions = np.zeros((5, 3))
    out = stream(positions=positions)
    positions[0] = 7.0
    assert (out.positions == 0.0).all()
    with pytest.raises(ValueError, match="read-only"):
        out.positions[0] = 1.0


@pytest.mark.parametrize("name", ["Right", "1hand", "right hand", "", "händ", "right-hand", "a.b"])
def test_a_name_that_the_rules_could_not_hold_is_refused(name: str) -> None:
    with pytest.raises(CaptureError, match="names begin with a lower-case letter"):
        Capture("trial", (sensor(name),), ())
    with pytest.raises(CaptureError, match="names begin"):
        Capture("trial", (sensor(),), (mug(name),))


def test_every_stream_is_on_one_clock() -> None:
    with pytest.raises(CaptureError, match="'mug' is on another clock than 'right_hand'"):
        Capture("trial", (sensor(),), (mug(stream=stream(step_s=0.02)),))


def test_a_pivot_contact_names_bodies_that_exist() -> None:
    with pytest.raises(UnknownNameError) as raised:
        Capture(
            "trial", (sensor(),), (mug(),), pivot_contacts=(PivotContact("rihgt_hand", "mug", 0.1),)
        )
    assert raised.value.known == ["mug", "right_hand"]
    assert "Did you mean 'right_hand'?" in str(raised.value)


def test_an_unknown_sensor_is_answered_with_those_that_exist() -> None:
    capture = Capture("trial", (sensor(), sensor("head", role=Role.ATTENDS)), (mug(),))
    assert capture.sensor("head").role is Role.ATTENDS
    assert [each.name for each in capture.acting] == ["right_hand"]
    assert [each.name for each in capture.attending] == ["head"]
    with pytest.raises(UnknownNameError, match="there are: head, right_hand"):
        capture.sensor("left_hand")
    with pytest.raises(UnknownNameError, match="there are: mug"):
        capture.tag_object("cup")


def test_the_rate_is_that_of_the_median_step() -> None:
    times = np.array([0.0, 0.01, 0.02, 0.5, 0.51])
    capture = Capture("trial", (sensor(stream=stream(times=times)),), ())
    assert capture.rate_hz == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        (np.zeros((0, 3)), np.zeros((0, 3), dtype=int)),
        (np.zeros((3, 3)), np.zeros((0, 3), dtype=int)),
        (np.zeros((3, 3)), np.array([[0, 1, 3]])),
        (np.full((3, 3), np.nan), np.array([[0, 1, 2]])),
    ],
)
def test_a_shape_that_is_none_is_refused(vertices: np.ndarray, faces: np.ndarray) -> None:
    with pytest.raises(CaptureError, match="shape"):
        Shape(vertices, faces)


seeds = st.integers(0, 2**32 - 1)


def turns(seed: int, count: int) -> np.ndarray:
    """Random unit quaternions w x y z."""
    return geometry.quaternions(Rotation.random(count, random_state=seed % 2**31))


@given(seeds, st.lists(st.booleans(), min_size=6, max_size=6))
def test_signs_do_not_matter_once_made_continuous(seed: int, flips: list[bool]) -> None:
    base = turns(seed, 1)[0]
    path = geometry.continuous(
        geometry.quaternions(
            Rotation.from_rotvec(np.linspace(0, 0.5, 6)[:, None] * [0.0, 0.0, 1.0])
            * geometry.rotations(base)
        )
    )
    flipped = path * np.where(flips, -1.0, 1.0)[:, None]
    fixed = geometry.continuous(flipped)
    assert np.allclose(fixed, path) or np.allclose(fixed, -path)
    assert (np.einsum("ij,ij->i", fixed[1:], fixed[:-1]) >= 0).all()


@given(seeds, st.sets(st.integers(0, 7), max_size=6))
def test_lost_frames_stay_lost_and_do_not_break_continuity(seed: int, lost: set[int]) -> None:
    given = turns(seed, 8)
    given[sorted(lost)] = np.nan
    out = geometry.continuous(given)
    assert (np.isnan(out).any(axis=1) == np.isnan(given).any(axis=1)).all()
    known = out[~np.isnan(out).any(axis=1)]
    assert (np.einsum("ij,ij->i", known[1:], known[:-1]) >= 0).all()


@given(seeds, st.floats(0.991, 1.009))
def test_unit_mends_a_norm_within_its_tolerance(seed: int, scale: float) -> None:
    assert np.allclose(np.linalg.norm(geometry.unit(turns(seed, 3) * scale), axis=1), 1.0)


@given(seeds, st.sampled_from([0.0, 0.5, 0.98, 1.02, 57.3]))
def test_unit_refuses_what_is_no_unit_quaternion(seed: int, scale: float) -> None:
    with pytest.raises(CaptureError, match="frame 0"):
        geometry.unit(turns(seed, 3) * scale)


@given(seeds, st.floats(0.001, np.pi - 0.001))
def test_the_angle_between_is_the_angle_turned(seed: int, angle: float) -> None:
    axis = np.random.default_rng(seed).normal(size=3)
    turn = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))
    first = turns(seed, 1)
    second = geometry.quaternions(turn * geometry.rotations(first))
    assert np.allclose(geometry.angle_between(first, second), angle, atol=1e-6)
    assert np.allclose(geometry.angle_between(first, -second), angle, atol=1e-6)


@given(seed=seeds, count=st.integers(1, 300), axes=st.integers(1, 7), lost=st.integers(0, 3))
def test_lengths_and_known_rows_are_numpys_to_the_last_bit(
    seed: int, count: int, axes: int, lost: int
) -> None:
    random = np.random.default_rng(seed)
    vectors = random.normal(size=(count, axes)) * 10.0 ** random.integers(-3, 3, (count, 1))
    vectors[random.integers(0, count, lost), random.integers(0, axes, lost)] = np.nan
    for layout in (vectors, np.asfortranarray(vectors), vectors[::-1]):
        expected = np.linalg.norm(layout, axis=1)
        assert np.array_equal(geometry.lengths(layout), expected, equal_nan=True)
        assert np.array_equal(geometry.is_known(layout), ~np.isnan(layout).any(axis=1))
        assert np.array_equal(geometry.every(layout > 0.0), (layout > 0.0).all(axis=1))


@given(seed=seeds, count=st.integers(1, 40), still=st.booleans())
def test_poses_are_composed_with_an_offset_as_scipy_does_to_the_last_bit(
    seed: int, count: int, *, still: bool
) -> None:
    random = np.random.default_rng(seed)
    places, there = random.normal(size=(count, 3)), turns(seed, count)
    offset = geometry.transforms(random.normal(size=3), turns(seed + 1, 1)[0])
    offset = RigidTransform.identity() if still else offset
    poses = geometry.transforms(places, there) * offset
    found = geometry.composed(places, there, offset)
    assert np.array_equal(found[0], poses.translation)
    assert np.array_equal(found[1], geometry.quaternions(poses.rotation))


@given(seed=seeds, count=st.integers(1, 300))
def test_the_mean_orientation_is_scipys(seed: int, count: int) -> None:
    spread = Rotation.from_rotvec(0.3 * np.random.default_rng(seed).normal(size=(count, 3)))
    near = spread * geometry.rotations(turns(seed, 1)[0])
    mean = geometry.mean_orientation(geometry.quaternions(near))
    assert np.allclose(mean, geometry.quaternions(near.mean()), rtol=0.0, atol=1e-12)


@given(seeds)
def test_fit_rigid_finds_the_transform_that_moved_the_markers(seed: int) -> None:
    random = np.random.default_rng(seed)
    local = random.normal(size=(5, 3))
    pose = geometry.transforms(random.normal(size=3), turns(seed, 1)[0])
    found, rest = geometry.fit_rigid(local, pose.apply(local))
    assert rest < 1e-9
    assert np.allclose(found.as_matrix(), pose.as_matrix(), atol=1e-6)


@given(st.lists(st.booleans(), max_size=40))
def test_gaps_are_the_runs_and_nothing_else(missing: list[bool]) -> None:
    array = np.array(missing, dtype=bool)
    rebuilt = np.zeros_like(array)
    runs = geometry.runs(array)
    for first, last in runs:
        assert first <= last
        rebuilt[first : last + 1] = True
    assert (rebuilt == array).all()
    assert all(one[1] + 1 < other[0] for one, other in pairwise(runs))


@given(seeds)
def test_slerp_meets_its_ends_and_halves_the_angle(seed: int) -> None:
    ends = geometry.continuous(turns(seed, 2))
    out = geometry.slerp(np.array([0.0, 1.0]), ends, np.array([-1.0, 0.0, 0.5, 1.0, 3.0]))
    assert np.allclose(geometry.angle_between(out[[0, 1, 3, 4]], ends[[0, 0, 1, 1]]), 0, atol=1e-6)
    whole = geometry.angle_between(ends[0], ends[1])
    assert np.allclose(geometry.angle_between(out[2], ends[0]), whole / 2, atol=1e-6)


NUMBERS = st.floats(-5.0, 5.0, allow_subnormal=False)
PLACES = st.tuples(NUMBERS, NUMBERS, NUMBERS)
TURNS = st.tuples(NUMBERS, NUMBERS, NUMBERS, NUMBERS).filter(
    lambda turn: float(np.linalg.norm(turn)) > 0.1
)


def unit(turn: tuple[float, float, float, float]) -> np.ndarray:
    return np.array(turn) / np.linalg.norm(turn)


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
