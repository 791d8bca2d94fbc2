"""Free flight is found in any direction and at any scale, and nothing else is taken for it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import stream

from capar.model.capture import Sensor, TagObject, TagType
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.faults.gravity import WINDOWS, Flight, _bends, flights
from extractors.thresholds import Thresholds

T = Thresholds()
DIRECTIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda each: np.hypot(*each[:2]) > 0.3)


def thing(positions: np.ndarray, rate_hz: float) -> BodyGeometry:
    return geometry_of(TagObject("ball", TagType.MOBILE, stream(positions, rate_hz=rate_hz)), T)


def hand(positions: np.ndarray, rate_hz: float) -> BodyGeometry:
    own = stream(positions, rate_hz=rate_hz)
    return geometry_of(Sensor("right_hand", "hand", "right", "right_arm", own), T)


def flown(body: BodyGeometry, *others: BodyGeometry) -> list[Flight]:
    return list(flights(body, others, T))


def tossed(rate_hz: float, pull: np.ndarray, across: np.ndarray, noise: float) -> np.ndarray:
    """Rest for 0.5 s, flight for 0.5 s, rest."""
    times = np.arange(round(1.5 * rate_hz)) / rate_hz
    fly = np.clip(times - 0.5, 0.0, 0.5)[:, None]
    random = np.random.default_rng(3)
    return 0.5 * pull * fly**2 + across * fly + random.normal(0.0, noise, (len(times), 3))


@settings(max_examples=40, deadline=None)
@given(
    direction=DIRECTIONS,
    rate_hz=st.sampled_from([30.0, 60.0, 100.0, 240.0]),
    scale=st.sampled_from([1.0, 10.0, 1000.0]),
)
def test_a_flight_has_the_acceleration_that_it_was_made_with(
    direction: tuple[float, float, float], rate_hz: float, scale: float
) -> None:
    pull = 9.81 * scale * np.array(direction) / np.linalg.norm(direction)
    across = np.cross(pull, [0.0, 0.0, 1.0])
    across *= 2.0 * scale / np.linalg.norm(across)
    (flight,) = flown(thing(tossed(rate_hz, pull, across, 0.001 * scale), rate_hz))
    assert np.linalg.norm(flight.acceleration - pull) < 0.05 * np.linalg.norm(pull)
    assert flight.curved


@pytest.mark.parametrize("width", WINDOWS)
def test_frames_that_fit_a_parabola_are_those_whose_own_window_does(width: int) -> None:
    path = tossed(100.0, np.array([0.0, 0.0, -9.81]), np.array([1.0, 0.0, 0.0]), 0.0005)
    path = np.concatenate([path, path[::-1], path])
    _, fits = _bends(path, width, 0.0005, T)
    plain = []
    for at in range(width // 2, len(path) - width // 2):
        window = path[at - width // 2 : at + width // 2 + 1]
        index = np.arange(width) - width // 2
        basis = np.linalg.qr(np.vander(index.astype(float), 4, increasing=True))[0]
        terms = np.linalg.norm(basis.T @ window, axis=1)
        misfit = np.linalg.norm(window - basis @ (basis.T @ window))
        noise_m = T.flight_noise_sigmas * 0.0005 * np.sqrt(3.0 * (width - 4))
        limit = T.flight_change_share * terms[2]
        bent = terms[2] >= T.flight_bend_sigmas * 0.0005
        plain.append(bent and terms[3] <= limit and misfit <= limit + noise_m)
    assert fits[width // 2 : len(path) - width // 2].tolist() == plain


def test_who_goes_along_holds_it() -> None:
    path = tossed(100.0, np.array([0.0, 0.0, -9.81]), np.array([1.0, 0.0, 0.0]), 0.0005)
    beside = path + np.array([0.05, 0.05, 0.0])
    assert flown(thing(path, 100.0), hand(beside, 100.0)) == []
    assert flown(thing(path, 100.0), hand(np.zeros_like(path), 100.0)) != []


def test_what_friction_brakes_does_not_fly() -> None:
    times = np.arange(150) / 100.0
    slide = np.clip(times - 0.3, 0.0, 0.6)
    places = np.outer(3.0 * slide - 2.5 * slide**2, [1.0, 0.0, 0.0])
    assert flown(thing(places, 100.0)) == []


@pytest.mark.parametrize("seconds", [0.6, 1.0, 2.0])
@pytest.mark.parametrize("rise", [0.0, 0.1, 0.3])
def test_a_smooth_way_from_rest_to_rest_is_no_curved_flight(seconds: float, rise: float) -> None:
    share = np.clip((np.arange(300) / 100.0 - 0.5) / seconds, 0.0, 1.0)
    eased = 10 * share**3 - 15 * share**4 + 6 * share**5
    places = np.outer(eased, [0.4, 0.1, -0.1]) + np.outer(
        64 * (share * (1 - share)) ** 3, [0, 0, rise]
    )
    assert not [each for each in flown(thing(places, 100.0)) if each.curved]
