"""Laws of marker fits and of the one clock."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Stream
from capar.model.errors import CaptureError
from extractors.readers.bundle.bodies import (
    Cluster,
    arrangement,
    fit_cluster,
    resampled,
    shared_clock,
)
from extractors.readers.formats.bvh import Joint, forward

SEEDS = st.integers(0, 2**32 - 1)


def walk(seed: int, frames: int = 60) -> tuple[np.ndarray, Rotation]:
    """Smooth places and turns."""
    chance = np.random.default_rng(seed)
    phase = np.linspace(0.0, 2.0, frames)[:, None]
    places = chance.uniform(-1, 1, 3) + 0.3 * np.sin(phase + chance.uniform(0, 6, 3))
    start = Rotation.random(random_state=int(chance.integers(2**31)))
    return places, Rotation.from_rotvec(phase * chance.uniform(-1, 1, 3)) * start


@settings(max_examples=25, deadline=None)
@given(seed=SEEDS)
def test_markers_on_a_rigid_body_give_its_motion_back_though_some_are_hidden(seed: int) -> None:
    places, turns = walk(seed)
    chance = np.random.default_rng(seed)
    local = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1], [0.1, 0.1, 0.05]])
    points = np.einsum("fij,mj->fmi", turns.as_matrix(), local) + places[:, None]
    hidden = chance.integers(0, 5, (len(points), 2))
    points[np.arange(1, len(points))[:, None], hidden[1:]] = np.nan
    fit = fit_cluster(Cluster(tuple("abcde"), local), points)
    assert np.allclose(fit.positions, places, atol=1e-9)
    apart = geometry.angle_between(fit.orientations, turns.as_quat(scalar_first=True))
    assert apart.max() < 1e-6
    markers = {name: points[:, index] for index, name in enumerate("abcde")}
    found = arrangement("body", markers).local
    assert np.allclose(
        np.linalg.norm(found[:, None] - found, axis=2),
        np.linalg.norm(local[:, None] - local, axis=2),
        atol=1e-9,
    )


@settings(max_examples=25, deadline=None)
@given(seed=SEEDS, rate=st.floats(40.0, 300.0))
def test_resampling_keeps_smooth_motion_and_never_crosses_a_gap(seed: int, rate: float) -> None:
    places, turns = walk(seed, 200)
    times = np.arange(200) / 100.0
    orientations = turns.as_quat(scalar_first=True)
    positions = places.copy()
    positions[80:120] = np.nan
    stream = Stream(times, positions, orientations)
    wanted = np.arange(0.0, 1.99, 1.0 / rate)
    out = resampled(stream, wanted)
    inside = (wanted > 0.79 + 1e-6) & (wanted < 1.20 - 1e-6)
    assert out.lost[inside].all()
    assert not out.lost[~inside].any()
    truth = np.stack([np.interp(wanted, times, each) for each in places.T], axis=1)
    assert np.allclose(out.positions[~inside], truth[~inside], atol=1e-4)


def test_a_thing_at_rest_is_held_before_and_after_it_is_recorded() -> None:
    times = np.array([1.0, 1.02, 1.04])
    places = np.array([[0.0, 0, 0], [0.1, 0, 0], [0.2, 0, 0]])
    stream = Stream(times, places, np.tile([1.0, 0, 0, 0], (3, 1)))
    wanted = np.arange(0.0, 2.0, 0.02)
    assert resampled(stream, wanted).lost.sum() > 90
    held = resampled(stream, wanted, extend="rest")
    assert not held.lost.any()
    assert np.allclose(held.positions[[0, -1], 0], [0.0, 0.2])


def test_streams_on_different_clocks_need_a_rate() -> None:
    turns = np.tile([1.0, 0, 0, 0], (3, 1))
    first = Stream(np.array([0.0, 0.1, 0.2]), np.zeros((3, 3)), turns)
    second = Stream(np.array([0.0, 0.11, 0.2]), np.zeros((3, 3)), turns)
    with pytest.raises(CaptureError, match="rate_hz"):
        shared_clock([first, second], rate_hz=None, span_s=(None, None), where="here")
    clock, start = shared_clock([first, second], rate_hz=100.0, span_s=(None, None), where="")
    assert (len(clock), start) == (21, 0.0)


@settings(max_examples=50, deadline=None)
@given(order=st.permutations("XYZ"), angles=st.tuples(*[st.floats(-180, 180)] * 3))
def test_rotation_channels_apply_in_the_order_they_are_named(
    order: list[str], angles: tuple[float, float, float]
) -> None:
    root = Joint("root", -1, (0.0, 0.0, 0.0), tuple(f"{axis}rotation" for axis in order))
    tip = Joint("tip", 0, (0.0, 1.0, 0.0), ())
    values = np.array([angles, angles])
    (_, turn), (place, _) = forward([root, tip], values)
    truth = Rotation.from_euler("".join(order), angles, degrees=True)
    assert np.allclose(turn.as_matrix()[0], truth.as_matrix(), atol=1e-9)
    assert np.allclose(place[0], truth.apply([0.0, 1.0, 0.0]), atol=1e-9)
