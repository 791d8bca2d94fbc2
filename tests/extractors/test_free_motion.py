"""Laws of things that nothing holds: what they may do, whatever their numbers are."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from extractors.forces.free_motion import (
    GRAVITY_MPS2,
    REST_MPS,
    FreeMotion,
    Phase,
    Resistance,
    Surface,
    energy,
    free_motion,
)

HALF = np.array([0.05, 0.05, 0.05])
TABLE = Surface(0.8, (0.0, -0.4), (0.6, 0.4))
GROUND = Surface(0.0)


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
        np.array(place), np.array(velocity), times, half=HALF, surfaces=[TABLE, GROUND],
        resistance=Resistance(damping, bounce),
    )  # fmt: skip
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
    assert np.diff(energy(found)).max() < 1e-5
    assert found.positions[:, 2].min() > HALF[2] - 1e-5
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
        top = found.positions[part, 2].max() - HALF[2]
        np.testing.assert_allclose(top, height * e ** (2 * number), atol=2e-4)


def test_it_slides_over_the_edge_falls_bounces_and_comes_to_rest() -> None:
    _, found = _moved((2.0, 0.0, 0.0), (0.5, 0.5), 0.4, end_s=12.0)
    kinds = [phase for _, phase in found.phases]
    assert kinds[:2] == [Phase.SLIDES, Phase.FALLS]
    assert kinds[-1] is Phase.RESTS
    leaves = found.phases[1][0]
    np.testing.assert_allclose(2.0 / 0.5 * (1.0 - np.exp(-0.5 * leaves)), 0.35, atol=1e-6)
    np.testing.assert_allclose(found.positions[-1, 2], HALF[2], atol=1e-6)


def test_what_falls_beside_a_table_passes_it() -> None:
    _, found = _moved((0.0, 0.0, 0.0), place=(0.8, 0.0, 1.5), bounce=0.0)
    np.testing.assert_allclose(found.positions[-1], [0.8, 0.0, 0.05], atol=1e-6)
