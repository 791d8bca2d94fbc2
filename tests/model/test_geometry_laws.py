"""Rigid motion obeys its laws."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.errors import CaptureError

seeds = st.integers(0, 2**32 - 1)


def turns(seed: int, count: int) -> np.ndarray:
    """Random unit quaternions w x y z."""
    return geometry.quaternions(Rotation.random(count, random_state=seed % 2**31))


@given(seeds)
def test_quaternions_and_rotations_are_two_names_of_one_thing(seed: int) -> None:
    given = turns(seed, 5)
    back = geometry.quaternions(geometry.rotations(given))
    assert np.allclose(np.abs(np.einsum("ij,ij->i", given, back)), 1.0)


def test_quaternions_are_scalar_first() -> None:
    assert geometry.rotations(np.array([[1.0, 0.0, 0.0, 0.0]])).magnitude()[0] == 0.0
    quarter = geometry.rotations(np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]))
    assert np.allclose(quarter.apply([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0])


@given(seeds)
def test_a_pose_and_its_inverse_take_a_point_there_and_back(seed: int) -> None:
    random = np.random.default_rng(seed)
    pose = geometry.transforms(random.normal(size=(4, 3)), turns(seed, 4))
    point = random.normal(size=3)
    assert np.allclose(pose.inv().apply(pose.apply(point)), point)


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


@given(seeds)
def test_fit_rigid_finds_the_transform_that_moved_the_markers(seed: int) -> None:
    random = np.random.default_rng(seed)
    local = random.normal(size=(5, 3))
    pose = geometry.transforms(random.normal(size=3), turns(seed, 1)[0])
    found, rest = geometry.fit_rigid(local, pose.apply(local))
    assert rest < 1e-9
    assert np.allclose(found.as_matrix(), pose.as_matrix(), atol=1e-6)


@given(seeds)
def test_no_transform_fits_noisy_markers_better_than_the_fitted_one(seed: int) -> None:
    random = np.random.default_rng(seed)
    local = random.normal(size=(6, 3))
    pose = geometry.transforms(random.normal(size=3), turns(seed, 1)[0])
    world = pose.apply(local) + random.normal(scale=0.01, size=local.shape)
    _, rest = geometry.fit_rigid(local, world)
    true = np.sqrt(((pose.apply(local) - world) ** 2).sum(axis=1).mean())
    assert rest <= true + 1e-9


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
