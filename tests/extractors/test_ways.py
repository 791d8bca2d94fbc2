"""What moves as one with a thing tells of its way as well; what does not tells nothing."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from capar.model.capture import Stream, TagObject, TagType
from extractors.bodies.poses import Poses, poses_of
from extractors.motion.motion_edges import hair, motion_edges, way_out
from extractors.motion.object_motion import RestPose, motion_floor, moving, rest_poses
from extractors.signals.filters import gains
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
RATE_HZ = 30.0
TIMES = np.arange(150) / RATE_HZ
NOISE_M, NOISE_RAD = 0.0015, np.radians(0.3)
BEGIN_S, END_S = 2.0, 3.0
FRAMES = np.arange(45, 72)
SEEN = 18
"""Of those frames the one at which a stroke of 0.2 m has gone a hair."""

HELD_M = np.array([0.0, 0.05, 0.1])
"""Where the sensor of a hand is beside that of the thing that it holds [m]."""

STILL = np.tile([1.0, 0.0, 0.0, 0.0], (len(TIMES), 1))


def step(begin_s: float, end_s: float) -> np.ndarray:
    """From 0 to 1 between two times, with the least jerk."""
    share = np.clip((TIMES - begin_s) / (end_s - begin_s), 0.0, 1.0)
    return np.asarray(share**3 * (10.0 - 15.0 * share + 6.0 * share**2))


def poses(places: np.ndarray, seed: int, turns: np.ndarray = STILL, noise: float = 1.0) -> Poses:
    """Poses as a tracker with noise records them."""
    random = np.random.default_rng(seed)
    noisy = places + noise * NOISE_M * random.standard_normal(places.shape)
    by = Rotation.from_rotvec(noise * NOISE_RAD * random.standard_normal((len(TIMES), 3)))
    turned = by * Rotation.from_quat(turns, scalar_first=True)
    stream = Stream(TIMES, noisy, turned.as_quat(scalar_first=True))
    return poses_of(TagObject(f"thing {seed}", TagType.MOBILE, stream, None), LIMITS)


def told(thing: Poses, *partners: Poses) -> tuple[np.ndarray, np.ndarray]:
    """The way of a thing out of its place, in hairs, and its deviation."""
    stay = RestPose((0, 59), thing.smooth.positions[:60].mean(axis=0), STILL[0], 60)
    left = gains(RATE_HZ, LIMITS)[0]
    way, _, noise = way_out(thing, partners, FRAMES, SEEN, stay, hair(thing, LIMITS), left)
    return way, noise


def edges(thing: Poses, *partners: Poses) -> np.ndarray:
    """When a thing first begins to move, and when it last stops [s]."""
    floor = motion_floor(thing.noise, RATE_HZ, own_m=None, thresholds=LIMITS)
    rests = rest_poses(thing, floor, LIMITS)
    moved = moving(thing, rests, floor, LIMITS)
    first, _ = motion_edges(thing, moved[0], rests, floor, LIMITS, partners)
    _, last = motion_edges(thing, moved[-1], rests, floor, LIMITS, partners)
    return np.array([TIMES[first], TIMES[last]])


def line(way: np.ndarray) -> np.ndarray:
    """A way along x."""
    return way[:, None] * np.array([1.0, 0.0, 0.0])


def test_a_hand_that_holds_a_thing_takes_away_almost_half_of_the_variance() -> None:
    """Not quite half: a tenth of a metre from its sensor the hand's turning is noise as well."""
    thing = poses(line(0.2 * step(BEGIN_S, END_S)), 1)
    hand = poses(line(0.2 * step(BEGIN_S, END_S)) + HELD_M, 2)
    alone, beside = told(thing)[1], told(thing, hand)[1]
    its_m = np.hypot(hand.noise.position_m, np.linalg.norm(HELD_M) * hand.noise.orientation_rad)
    gain = np.sqrt(1.0 + (thing.noise.position_m / its_m) ** 2)
    assert np.median(alone / beside) == pytest.approx(gain, rel=0.03)
    assert gain > 1.2


def test_the_way_of_what_a_hand_turns_about_itself_follows_from_the_hand_s_turning() -> None:
    """The thing goes round the hand, at a lever of 20 cm; the hand's place stays."""
    angle = 0.8 * step(BEGIN_S, END_S)
    turns = Rotation.from_rotvec(angle[:, None] * [0.0, 0.0, 1.0])
    places = turns.apply([0.2, 0.0, 0.0])
    turned = turns.as_quat(scalar_first=True)
    thing, hand = poses(places, 1, turned), poses(np.zeros_like(places), 2, turned)
    alone, beside = told(thing), told(thing, hand)
    assert np.median(beside[1]) < 0.9 * np.median(alone[1])
    assert np.abs(beside[0] - alone[0]).max() < 4.0 * np.median(alone[1])


@given(st.floats(0.3, 0.8))
@settings(deadline=None, max_examples=20)
def test_a_hand_that_still_comes_near_tells_of_the_way_only_once_it_is_there(
    before_s: float,
) -> None:
    """It comes along the way that the thing goes afterwards, and holds it for a while."""
    go = 0.2 * step(BEGIN_S, END_S)
    come = 0.3 * step(BEGIN_S - before_s - 0.6, BEGIN_S - before_s) - 0.3
    thing, hand = poses(line(go), 1), poses(line(go + come), 2)
    alone, beside = told(thing), told(thing, hand)
    away = come[FRAMES] < -0.05
    assert beside[1][away] == pytest.approx(alone[1][away], rel=0.01)
    assert np.abs(beside[0] - alone[0]).max() < 4.0 * np.median(alone[1])


def test_what_stays_where_it_was_moves_no_edge() -> None:
    thing = poses(line(0.2 * step(BEGIN_S, END_S)), 1)
    support = poses(np.zeros((len(TIMES), 3)), 2)
    assert edges(thing, support) == pytest.approx(edges(thing), abs=1.01 / RATE_HZ)


def test_edges_are_nearer_to_the_truth_with_the_hand_that_carries() -> None:
    truth = np.array([BEGIN_S, END_S])
    errors = []
    for draw in range(40):
        go = line(0.2 * step(BEGIN_S, END_S))
        thing, hand = poses(go, 2 * draw), poses(go + HELD_M, 2 * draw + 1)
        errors.append((edges(thing) - truth, edges(thing, hand) - truth))
    alone, beside = np.sqrt(np.mean(np.square(errors), axis=(0, 2)))
    assert beside < 0.9 * alone
    assert beside < 0.025


@pytest.mark.parametrize("stroke_s", [0.25, 0.3, 0.4])
@pytest.mark.parametrize("half_m", [0.03, 0.045])
def test_motion_to_and_fro_begins_and_ends_with_its_first_and_last_stroke(
    half_m: float, stroke_s: float
) -> None:
    """A blade goes half a stroke ahead, back and forth across its place, and back to it."""
    half = stroke_s / 2.0
    way, at = half_m * step(BEGIN_S, BEGIN_S + 1.5 * half), BEGIN_S + 1.5 * half
    for sign in (-2.0, 2.0, -2.0):
        way, at = way + sign * half_m * step(at, at + 2.5 * half), at + 2.5 * half
    way, at = way + half_m * step(at, at + 1.5 * half), at + 1.5 * half
    assert near(line(way), [BEGIN_S, at], within_s=0.075) >= 0.9


def test_a_slow_motion_is_no_rest_in_noise() -> None:
    """It takes half a second to go faster than noise lets a body at rest seem to go."""
    assert near(line(0.3 * step(0.5, 4.5)), [0.5, 4.5], within_s=0.2) >= 0.9


def near(places: np.ndarray, truth: list[float], *, within_s: float) -> float:
    """The share of draws of noise in which both edges are within a time of the truth."""
    draws = [edges(poses(places, draw)) for draw in range(30)]
    return float(np.mean(np.abs(np.array(draws) - truth).max(axis=1) <= within_s))
