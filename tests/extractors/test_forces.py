"""Forces: free motion with closed forms, and what is estimated of blows."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from extractors.forces.forces import (
    Fit,
    fit_free_motion,
    restitution,
    thesis_damping,
    velocities_about,
)
from extractors.forces.free_motion import (
    GRAVITY_MPS2,
    REST_MPS,
    FreeMotion,
    Phase,
    Resistance,
    Surface,
    free_motion,
)

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
        PLACE,
        pace,
        np.concatenate([[STRUCK_S], times[after]]),
        half=HALF,
        surfaces=[TABLE, GROUND],
        resistance=Resistance((damping, damping), e),
    )
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
        np.array([0.0, 0.0, 1.5]),
        np.array([2.0, 0.0, 1.0]),
        times,
        half=HALF,
        surfaces=[GROUND],
        resistance=Resistance((1.0, 1.0), 0.5),
    )
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
        np.array([0.0, 0.0, HALF[2] + 0.3]),
        np.array([1.0, 0.0, 0.0]),
        times,
        half=HALF,
        surfaces=[GROUND],
        resistance=Resistance((1.0, 1.0), 0.0),
    )
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


FREE_MOTION_HALF = np.array([0.05, 0.05, 0.05])
FREE_MOTION_TABLE = Surface(0.8, (0.0, -0.4), (0.6, 0.4))


def _moved(
    velocity: tuple[float, float, float],
    damping: tuple[float, float] = (2.0, 2.0),
    bounce: float = 0.5,
    *,
    place: tuple[float, float, float] = (0.3, 0.0, 0.85),
    end_s: float = 3.0,
) -> tuple[np.ndarray, FreeMotion]:
    times = np.linspace(0.0, end_s, round(500 * end_s) + 1)
    found = free_motion(
        np.array(place),
        np.array(velocity),
        times,
        half=FREE_MOTION_HALF,
        surfaces=[FREE_MOTION_TABLE, GROUND],
        resistance=Resistance(damping, bounce),
    )
    return times, found


paces = st.floats(-3.0, 3.0)


@settings(max_examples=25, deadline=None)
@given(
    x=paces, y=paces, z=st.floats(-1.0, 3.0), damping=st.floats(0.05, 8.0), bounce=st.floats(0, 1)
)
def test_energy_never_grows_and_nothing_sinks_in(
    x: float, y: float, z: float, damping: float, bounce: float
) -> None:
    _, found = _moved((x, y, z), (damping, 1.5 * damping), bounce)
    assert (
        np.diff(
            0.5 * (found.velocities**2).sum(axis=1) + GRAVITY_MPS2 * found.positions[:, 2]
        ).max()
        < 1e-5
    )
    assert found.positions[:, 2].min() > FREE_MOTION_HALF[2] - 1e-5
    over = (np.abs(found.positions[:, 1]) < 0.4) & (np.abs(found.positions[:, 0] - 0.3) < 0.3)
    inside = over & (np.abs(found.positions[:, 2] - 0.75) < 0.09)
    assert not inside.any()


def test_a_slide_is_an_exponential_of_stated_length() -> None:
    times, found = _moved((0.4, 0.2, 0.0), (2.0, 4.0))
    rests = next(at for at, phase in found.phases if phase is Phase.RESTS)
    part = times < rests
    x = 0.3 + 0.4 / 2.0 * (1.0 - np.exp(-2.0 * times[part]))
    y = 0.2 / 4.0 * (1.0 - np.exp(-4.0 * times[part]))
    np.testing.assert_allclose(found.positions[part, :2], np.stack([x, y], axis=1), atol=1e-6)
    assert np.hypot(0.4 * np.exp(-2.0 * rests), 0.2 * np.exp(-4.0 * rests)) < REST_MPS + 1e-9
    assert np.ptp(found.positions[times >= rests], axis=0).max() == 0.0


def test_each_bounce_is_lower_by_the_square_of_the_restitution() -> None:
    e, height = 0.6, 0.5
    times, found = _moved((0.0, 0.0, 0.0), bounce=e, place=(2.0, 0.0, 0.05 + height))
    lands = np.sqrt(2.0 * height / GRAVITY_MPS2)
    for number in range(1, 4):
        flight = 2.0 * e**number * lands
        begin = lands + 2.0 * lands * sum(e**k for k in range(1, number))
        part = (times > begin) & (times < begin + flight)
        top = found.positions[part, 2].max() - FREE_MOTION_HALF[2]
        np.testing.assert_allclose(top, height * e ** (2 * number), atol=2e-4)


def test_it_slides_over_the_edge_falls_bounces_and_comes_to_rest() -> None:
    _, found = _moved((2.0, 0.0, 0.0), (0.5, 0.5), 0.4, end_s=12.0)
    kinds = [phase for _, phase in found.phases]
    assert kinds[:2] == [Phase.SLIDES, Phase.FALLS]
    assert kinds[-1] is Phase.RESTS
    leaves = found.phases[1][0]
    np.testing.assert_allclose(2.0 / 0.5 * (1.0 - np.exp(-0.5 * leaves)), 0.35, atol=1e-6)
    np.testing.assert_allclose(found.positions[-1, 2], FREE_MOTION_HALF[2], atol=1e-6)


def test_what_falls_beside_a_table_passes_it() -> None:
    _, found = _moved((0.0, 0.0, 0.0), place=(0.8, 0.0, 1.5), bounce=0.0)
    np.testing.assert_allclose(found.positions[-1], [0.8, 0.0, 0.05], atol=1e-6)
