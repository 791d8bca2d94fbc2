"""Restitution and damping come back out of noisy paths that were made with known ones."""

import numpy as np
import pytest

from extractors.forces.forces import (
    Fit,
    fit_free_motion,
    restitution,
    thesis_damping,
    velocities_about,
)
from extractors.forces.free_motion import Resistance, Surface, free_motion

RATE_HZ = 103.3
HALF = np.array([0.08, 0.10, 0.08])
TABLE = Surface(0.75, (0.2, -0.6), (1.0, 0.6))
GROUND = Surface(0.0)
PLACE = np.array([0.4, 0.0, 0.83])
STRUCK_S = 0.5
HAND_MPS, MASSES = np.array([1.5, 0.3, 0.0]), 3.0
"""Of the hand before the blow, and how many times the hand's mass is the box's."""


def _blow(e: float, damping: float, noise_m: float, seed: int) -> tuple[np.ndarray, ...]:
    """Times, the box's and the hand's recorded places, and the velocity that the box gets."""
    rng = np.random.default_rng(seed)
    times = np.arange(round(2.2 * RATE_HZ)) / RATE_HZ
    share = MASSES / (1.0 + MASSES)
    pace = (1.0 + e) * share * HAND_MPS
    follow = HAND_MPS - pace / MASSES
    after = times >= STRUCK_S
    box = np.tile(PLACE, (len(times), 1))
    moved = free_motion(
        PLACE, pace, np.concatenate([[STRUCK_S], times[after]]), half=HALF,
        surfaces=[TABLE, GROUND], resistance=Resistance((damping, damping), e),
    )  # fmt: skip
    box[after] = moved.positions[1:]
    past = np.minimum(times - STRUCK_S, 0.0)[:, None]
    late = np.maximum(times - STRUCK_S, 0.0)[:, None]
    swing = 0.5 * np.array([2.0, 0.5, -0.5])
    hand = PLACE + past * HAND_MPS - past**2 * swing + late * follow - late**2 * 1.5 * follow
    noise = rng.normal(scale=noise_m, size=(2, len(times), 3))
    return times, box + noise[0], hand + noise[1], pace


def _estimated(e: float, damping: float, noise_m: float, seed: int) -> tuple[Fit, float]:
    times, box, hand, _ = _blow(e, damping, noise_m, seed)
    first = int(np.searchsorted(times, STRUCK_S)) + 1  # a frame late, as contacts are seen
    rested = np.median(box[: first - 5], axis=0)
    found = fit_free_motion(
        times[first:], box[first:], rested=rested, half=HALF, surfaces=[TABLE, GROUND]
    )
    assert found is not None
    value = restitution(*velocities_about(times, hand, found.start_s), found.velocity)
    assert value is not None
    return found, value


def test_without_noise_every_number_comes_back() -> None:
    found, e = _estimated(0.5, 2.0, 0.0, 0)
    np.testing.assert_allclose(e, 0.5, atol=0.002)
    assert found.damping is not None
    np.testing.assert_allclose(found.damping, 2.0, atol=0.02)
    np.testing.assert_allclose(found.velocity, _blow(0.5, 2.0, 0.0, 0)[3], atol=0.005)
    assert abs(found.start_s - STRUCK_S) < 0.001


@pytest.mark.parametrize("e", [0.3, 0.5, 0.7])
def test_restitution_and_damping_come_back_from_noisy_captures(e: float) -> None:
    found = [_estimated(e, 2.0, 0.0015, seed) for seed in range(8)]
    es = np.array([value for _, value in found])
    dampings = np.array([fit.damping for fit, _ in found])
    assert (np.abs(es - e) < 0.05).all(), es
    np.testing.assert_allclose(dampings[:, 0], 2.0, atol=0.15)
    assert max(fit.residual_m for fit, _ in found) < 0.02  # falls and bounces included


def test_how_it_bounces_comes_back_where_it_falls_off_the_table() -> None:
    found, _ = _estimated(0.6, 0.8, 0.0015, 3)
    assert found.bounce is not None
    np.testing.assert_allclose(found.bounce, 0.6, atol=0.02)
    assert found.damping is not None
    np.testing.assert_allclose(found.damping[0], 0.8, atol=0.15)


def test_a_thing_that_was_let_go_in_the_air_has_no_damping() -> None:
    times = np.arange(60) / RATE_HZ
    flight = free_motion(
        np.array([0.0, 0.0, 1.5]), np.array([2.0, 0.0, 1.0]), times, half=HALF,
        surfaces=[GROUND], resistance=Resistance((1.0, 1.0), 0.5),
    )  # fmt: skip
    found = fit_free_motion(times, flight.positions, rested=None, half=HALF, surfaces=[GROUND])
    assert found is not None
    assert found.damping is None
    assert found.bounce is None
    np.testing.assert_allclose(found.velocity, [2.0, 0.0, 1.0], atol=1e-4)


@pytest.mark.parametrize(("slides_s", "told"), [(0.07, False), (0.3, True)])
def test_a_slide_of_less_than_a_tenth_of_a_second_says_nothing_of_damping(
    slides_s: float, told: bool
) -> None:
    falls_s = np.sqrt(2.0 * 0.3 / 9.81)
    times = np.arange(0.0, falls_s + slides_s, 1.0 / RATE_HZ)
    path = free_motion(
        np.array([0.0, 0.0, HALF[2] + 0.3]), np.array([1.0, 0.0, 0.0]), times, half=HALF,
        surfaces=[GROUND], resistance=Resistance((1.0, 1.0), 0.0),
    )  # fmt: skip
    found = fit_free_motion(times, path.positions, rested=None, half=HALF, surfaces=[GROUND])
    assert found is not None
    assert (found.damping is not None) == told


def test_the_thesis_slope_vanishes_where_the_damping_is_constant() -> None:
    times = np.linspace(0.0, 1.0, 200)
    constant = np.outer(np.exp(-3.0 * times), [1.0, 0.5, 0.0])
    slope = thesis_damping(times, constant)
    assert slope is not None
    np.testing.assert_allclose(slope, 0.0, atol=0.05)
    growing = np.outer(np.exp(-times - times**2), [1.0, 0.5, 0.0])  # a/v = -1 - 2 t
    slope = thesis_damping(times, growing)
    assert slope is not None
    np.testing.assert_allclose(slope, -2.0, atol=0.05)
