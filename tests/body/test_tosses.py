"""A mug is thrown from one hand to the other: it flies by gravity alone, and is seen to."""

import numpy as np
import pytest

from capar.body.performing import Performance
from capar.body.scripted_actions import action_capture, performed
from capar.body.scripts import GRAVITY_MPS2, Toss, slowed, tossed
from capar.pipelines.observation import observe

RATE_HZ = 60.0


def _flight(made: Performance) -> np.ndarray:
    """Where the mug is from the frame in which it is let go to the one in which it is caught."""
    ((start, end),) = [(start, end) for name, start, end in made.phases if name == "fly"]
    first, last = (round(at * RATE_HZ) - 1 for at in (start, end))
    return np.asarray(made.things["mug"].translation[first : last + 1])


@pytest.mark.parametrize("who", ["man", "child"])
def test_between_the_hands_only_gravity_moves_it(who: str) -> None:
    spots = _flight(performed("toss", who, rate_hz=RATE_HZ))
    assert len(spots) > 10
    bent = np.diff(spots, n=2, axis=0) * RATE_HZ**2
    np.testing.assert_allclose(bent, np.tile(GRAVITY_MPS2, (len(bent), 1)), atol=1e-6)


@pytest.mark.parametrize("who", ["man", "woman", "child"])
def test_it_is_observed_as_thrown_by_one_hand_and_caught_by_the_other(who: str) -> None:
    seen = observe(action_capture("toss", who, rate_hz=RATE_HZ), rules="extended")
    names = {
        link.ee: [part.name for part in link.segments if part.name in {"Throw", "Catch"}]
        for link in seen.links
    }
    assert names == {"right_hand": ["Throw"], "left_hand": ["Catch"]}


def test_a_swing_begins_and_ends_with_its_velocities() -> None:
    toss = Toss(start=(0.2, 0.0, -0.4), end=(0.0, 1.1, 1.4))
    by, seconds, step = (0.0, 0.3, 0.2), 0.4, 1e-5
    places = [tossed(toss, by, seconds, at / seconds) for at in (0.0, step, 0.4 - step, 0.4)]
    np.testing.assert_allclose(places[0], 0.0, atol=1e-12)
    np.testing.assert_allclose(places[-1], by, atol=1e-12)
    np.testing.assert_allclose(places[1] / step, toss.start, atol=1e-3)
    np.testing.assert_allclose((places[3] - places[2]) / step, toss.end, atol=1e-3)


def test_a_hand_that_lets_go_slows_down_evenly_and_stays() -> None:
    velocity = (0.0, 1.0, 2.0)
    np.testing.assert_allclose(slowed(velocity, 0.1, 0.1), [0.0, 0.05, 0.1])
    np.testing.assert_allclose(slowed(velocity, 0.5, 0.1), [0.0, 0.05, 0.1])
    np.testing.assert_allclose(slowed(velocity, 1e-6, 0.1), np.array(velocity) * 1e-6, rtol=1e-4)
