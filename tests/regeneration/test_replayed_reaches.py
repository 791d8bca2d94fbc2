"""A reach is replayed for new goals in a frame of object and hand, or object and shoulder."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from capar.body.scripted_actions import performed
from capar.regeneration.styles import CoordinateError, frame_between, replayed

ASIDE = np.array([[0.1, 0.0, 0.0], [0.0, 0.12, 0.05], [-0.05, -0.1, 0.1], [0.08, 0.1, -0.1]])
numbers = st.floats(-1.0, 1.0)
spots = st.tuples(numbers, numbers, numbers).map(np.array)


def _reach() -> tuple[np.ndarray, np.ndarray]:
    """The palm's path to the mug, and the shoulder before it."""
    made = performed("drink", rate_hz=30.0)
    start, end = (next(p for p in made.phases if p[0] == "reach"))[1:]
    rows = (made.times >= start) & (made.times <= end)
    palm = made.human.sites(made.motion, ["right_palm"])["right_palm"][0][rows]
    return palm, np.array([0.0, -0.18, 1.45])


@given(goal=spots, base=spots, new=spots, path=st.lists(spots, min_size=2, max_size=5))
def test_a_replay_enlarges_every_distance_by_the_same_factor(
    goal: np.ndarray, base: np.ndarray, new: np.ndarray, path: list[np.ndarray]
) -> None:
    try:
        before, after = frame_between(goal, base), frame_between(new, base)
    except CoordinateError:
        return
    old = np.stack(path)
    made = replayed(old, before, after)
    factor = np.linalg.norm(after[1][:, 2]) / np.linalg.norm(before[1][:, 2])
    steps = np.linalg.norm(np.diff(old, axis=0), axis=1) * factor
    np.testing.assert_allclose(np.linalg.norm(np.diff(made, axis=0), axis=1), steps, atol=1e-9)
    length = np.linalg.norm(before[1][:, 2])
    np.testing.assert_allclose(before[1].T @ before[1], length**2 * np.eye(3), atol=1e-9)
    assert np.linalg.det(after[1].T @ before[1]) > 0.0


def test_a_reach_begins_at_the_hand_in_its_frame_and_ends_at_the_goal_in_any() -> None:
    path, shoulder = _reach()
    for goal in path[-1] + ASIDE:
        for base, begins in ((path[0], True), (shoulder, False)):
            before, after = frame_between(path[-1], base), frame_between(goal, base)
            made = replayed(path, before, after)
            np.testing.assert_allclose(made[-1], goal, atol=1e-12)
            assert (np.linalg.norm(made[0] - path[0]) < 0.02) == begins
            np.testing.assert_allclose(replayed(path, before, before), path, atol=1e-12)


def test_straight_above_each_other_takes_a_direction_aside() -> None:
    low, high = np.zeros(3), np.array([0.0, 0.0, 0.5])
    with pytest.raises(CoordinateError, match="x has no direction"):
        frame_between(low, high)
    made = frame_between(low, high, aside=np.array([0.0, 1.0, 0.0]))
    np.testing.assert_allclose(made[1][:, 0], [0.0, 0.5, 0.0], atol=1e-12)
    with pytest.raises(CoordinateError, match="0 mm apart"):
        frame_between(low, low)
