"""Motion: crossings, rest, true edges, phases, turning points, rolling."""

from itertools import pairwise

import motions
import numpy as np
import pytest
import trimesh
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from measured_bodies import box, eased, stream
from motions import PERFORMERS, Performer, shapes
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Shape, Stream, TagObject, TagType
from capar.model.facts import Rolls
from capar.pipelines.observation import observe
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.bodies.poses import Poses, median_pose, poses_of
from extractors.contact.contacts import settled_ends
from extractors.measure import _track
from extractors.motion.motion_edges import (
    GROWN,
    POWERS,
    before_seen,
    hair,
    motion_edges,
    onset,
    seat,
    way_out,
)
from extractors.motion.object_motion import (
    Floor,
    RestPose,
    first_rest,
    motion_floor,
    moving,
    rest_poses,
)
from extractors.motion.phases import (
    LEVEL,
    RISING,
    SINKING,
    Phase,
    lengthwise,
    long_axis,
    phases,
    rolling,
    turns_of_height,
)
from extractors.signals.filters import fill_gaps, gains, long_gaps, noise_at_rest, speed
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
RATES = st.sampled_from([30.0, 60.0, 100.0, 120.0, 240.0])


def crossings(of: Stream) -> list[int]:
    pose = poses_of(TagObject("hand", TagType.MOBILE, of), LIMITS)
    highest = float(np.nanmax(speed(pose.smooth.positions, of.times)))
    return [int(each) for each in _track(pose, highest, LIMITS).crossings]


def measured_motion_motions(
    of: Stream, floor_m: float | None = None
) -> tuple[tuple[int, int], ...]:
    pose = poses_of(TagObject("thing", TagType.MOBILE, of), LIMITS)
    rate_hz = 1.0 / float(np.median(np.diff(of.times)))
    floor = motion_floor(pose.noise, rate_hz, own_m=floor_m, thresholds=LIMITS)
    return moving(pose, rest_poses(pose, floor, LIMITS), floor, LIMITS)


def last_rest(of: Stream) -> RestPose:
    pose = poses_of(TagObject("thing", TagType.MOBILE, of), LIMITS)
    floor = motion_floor(pose.noise, 100.0, own_m=None, thresholds=LIMITS)
    return rest_poses(pose, floor, LIMITS)[-1]


def reach(rate_hz: float, *, shift_s: float = 0.0, scale: float = 1.0) -> Stream:
    times = np.arange(round((3.0 * scale + shift_s) * rate_hz)) / rate_hz
    share = eased(times, shift_s + 1.0 * scale, shift_s + 2.0 * scale)
    return stream(np.outer(share, [0.3, 0.2, 0.1]), rate_hz=rate_hz)


@given(RATES)
@settings(max_examples=8, deadline=None)
def test_a_reach_has_crossings_at_its_start_its_fastest_and_its_stop(rate_hz: float) -> None:
    found = np.array(crossings(reach(rate_hz))) / rate_hz
    expected = [0.0, 1.0, 1.5, 2.0, 3.0]
    assert len(found) == len(expected)
    assert np.abs(found - expected).max() < 0.11
    assert abs(found[2] - 1.5) < 1.5 / rate_hz


@given(st.integers(1, 80))
@settings(max_examples=10, deadline=None)
def test_crossings_move_with_the_motion_when_it_is_shifted_in_time(shift: int) -> None:
    plain = crossings(reach(100.0))[1:-1]
    later = crossings(reach(100.0, shift_s=shift / 100.0))[1:-1]
    assert np.abs(np.array(later) - np.array(plain) - shift).max() <= 1


@given(st.integers(0, 1000))
@settings(max_examples=10, deadline=None)
def test_crossings_do_not_depend_on_how_the_world_is_turned(seed: int) -> None:
    world = Rotation.random(random_state=seed)
    plain = reach(100.0)
    turned = stream(world.apply(plain.positions.copy()))
    assert crossings(turned) == crossings(plain)


@given(st.floats(0.0, 0.003), RATES, st.integers(0, 100))
@settings(max_examples=15, deadline=None)
def test_noise_alone_makes_no_crossing_and_no_motion(
    noise_m: float, rate_hz: float, seed: int
) -> None:
    random = np.random.default_rng(seed)
    frames = round(4.0 * rate_hz)
    turns = Rotation.from_rotvec(random.normal(0.0, np.radians(1.0), (frames, 3)))
    shaken = stream(
        random.normal(0.0, noise_m, (frames, 3)),
        rate_hz=rate_hz,
        orientations=turns.as_quat(scalar_first=True),
    )
    assert crossings(shaken) == [0, frames - 1]
    assert measured_motion_motions(shaken) == ()


@given(st.floats(0.0, 0.003), RATES, st.integers(0, 100))
@settings(max_examples=15, deadline=None)
def test_a_carried_thing_moves_once_between_its_places(
    noise_m: float, rate_hz: float, seed: int
) -> None:
    random = np.random.default_rng(seed)
    plain = reach(rate_hz)
    seen = stream(
        plain.positions + random.normal(0.0, noise_m, plain.positions.shape), rate_hz=rate_hz
    )
    found = measured_motion_motions(seen)
    assert len(found) == 1
    first, last = (each / rate_hz for each in found[0])
    assert 0.95 < first < 1.3
    assert 1.7 < last < 2.05


@pytest.mark.parametrize(("back", "count"), [(0.0, 1), (1.0, 0)])
def test_what_rests_elsewhere_has_moved_however_quickly(back: float, count: int) -> None:
    """Thirty millimetres in two hundredths of a second, for good or there and back."""
    times = np.arange(0.0, 3.0, 0.01)
    share = np.clip((times - 1.5) / 0.02, 0.0, 1.0)
    share -= back * np.clip((times - 1.52) / 0.02, 0.0, 1.0)
    assert len(measured_motion_motions(stream(np.outer(share, [0.03, 0.0, 0.0])))) == count


def test_the_end_of_a_landing_belongs_to_the_stay() -> None:
    plain = reach(100.0)
    ((first, last),) = measured_motion_motions(plain)
    away = np.linalg.norm(plain.positions - plain.positions[-1], axis=1)
    assert away[last + 1] <= LIMITS.motion_floor_m + 1e-3
    assert away[last] > LIMITS.motion_floor_m - 1e-3
    assert np.linalg.norm(plain.positions[first]) > LIMITS.motion_floor_m - 1e-3


@given(st.floats(0.05, 0.4), st.floats(0.002, 0.008))
@settings(max_examples=15, deadline=None)
def test_when_a_thing_came_to_rest_is_final_once_no_frame_of_its_place_is_missing(
    creeps_s: float, creeps_m: float
) -> None:
    times = np.arange(400) / 100.0
    way = 0.3 * eased(times, 0.5, 1.5)
    way += np.where(times > 1.5, creeps_m * (1.0 - np.exp((1.5 - times) / creeps_s)), 0.0)
    whole = stream(np.outer(way, [1.0, 0.0, 0.0]))
    (final,) = measured_motion_motions(whole)
    told = 0
    for count in range(180, 400, 3):
        part = stream(whole.positions[:count])
        rest = last_rest(part)
        if rest.interval[0] > 100 and not rest.missing:
            told += 1
            assert measured_motion_motions(part) == (final,)
    assert told > 30


def test_a_turn_on_the_spot_is_motion_and_a_displacement_below_an_own_floor_is_none() -> None:
    times = np.arange(300) / 100.0
    turn = Rotation.from_rotvec(np.outer(eased(times, 1.0, 2.0), [0.0, 0.0, 0.5]))
    spun = stream(np.zeros((300, 3)), orientations=turn.as_quat(scalar_first=True))
    assert len(measured_motion_motions(spun)) == 1
    nudged = stream(np.outer(np.sin(np.pi * eased(times, 1.0, 2.0)), [0.015, 0.0, 0.0]))
    assert len(measured_motion_motions(nudged)) == 1
    assert measured_motion_motions(nudged, floor_m=0.02) == ()


@given(st.integers(1, 8), st.integers(20, 70), st.lists(st.floats(-1, 1), min_size=4, max_size=4))
@settings(max_examples=20, deadline=None)
def test_a_short_gap_in_cubic_motion_is_filled_exactly(
    length: int, begin: int, factors: list[float]
) -> None:
    times = np.arange(100) / 100.0
    way = np.polyval(factors, times)[:, None] * np.array([1.0, -2.0, 0.5])
    holed = way.copy()
    holed[begin : begin + length] = np.nan
    filled = fill_gaps(stream(holed), gap_s=0.1)
    assert np.abs(filled.positions - way).max() < 1e-6


def test_a_long_gap_and_a_gap_at_an_end_stay_lost() -> None:
    way = np.zeros((200, 3))
    way[50:75] = np.nan
    way[:4] = np.nan
    holed = stream(way)
    assert (fill_gaps(holed, gap_s=0.1).lost == holed.lost).all()
    assert long_gaps(holed, gap_s=0.1) == [(0, 3), (50, 74)]


def test_orientations_in_a_gap_turn_evenly() -> None:
    angle = np.linspace(0.0, 1.0, 100)
    turns = Rotation.from_rotvec(np.outer(angle, [0.0, 0.0, 1.0])).as_quat(scalar_first=True)
    holed = turns.copy()
    holed[40:46] = np.nan
    filled = fill_gaps(stream(np.zeros((100, 3)), orientations=holed), gap_s=0.1)
    assert np.abs(filled.orientations - turns).max() < 1e-9


@given(st.floats(0.0002, 0.005), RATES, st.integers(0, 50))
@settings(max_examples=15, deadline=None)
def test_noise_is_measured_though_the_body_moves(sigma_m: float, rate_hz: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    plain = reach(rate_hz, scale=4.0)
    shape = plain.positions.shape
    turns = Rotation.from_rotvec(random.normal(0.0, 0.01, shape)).as_quat(scalar_first=True)
    seen = stream(
        plain.positions + random.normal(0.0, sigma_m, shape), rate_hz=rate_hz, orientations=turns
    )
    noise = noise_at_rest(seen, LIMITS)
    assert noise.position_m == pytest.approx(sigma_m, rel=0.15)
    assert noise.orientation_rad == pytest.approx(0.01, rel=0.15)


HAIR_M = 0.001
MOST_S = 1.0
REST_S = 0.5
ROUGH_S = 0.003
"""A beginning is the mean over all that may be, so it is no nearer than this at any rate [s]."""

RATES_HZ = st.sampled_from([30.0, 60.0, 100.0, 240.0])


def smooth(share: np.ndarray) -> np.ndarray:
    """From 0 to 1 with least jerk."""
    part = np.clip(share, 0.0, 1.0)
    return np.asarray(part**3 * (10.0 - 15.0 * part + 6.0 * part**2))


def clock(rate_hz: float, lasts_s: float) -> np.ndarray:
    """Times from a rest before a motion to its end; it begins at 0 [s]."""
    rest = round(REST_S * rate_hz)
    return (np.arange(rest + round(lasts_s * rate_hz) + 1) - rest) / rate_hz


def told_s(times: np.ndarray, way: np.ndarray, noise: np.ndarray | float = 0.0) -> float:
    """When a way is told to have begun [s], of which a hair can be seen and no noise low-passed."""
    rate_hz = 1.0 / float(np.median(np.diff(times)))
    seen = int(np.flatnonzero(way >= HAIR_M)[0])
    beyond = np.flatnonzero(way >= GROWN * HAIR_M)
    part = slice(int(beyond[0]) + 1 if beyond.size else len(way))
    found = onset(
        (way + noise)[part] / HAIR_M,
        way[part] / HAIR_M,
        seen,
        noise=np.full(len(way[part]), float(np.std(noise)) / HAIR_M),
        place=0.0,
        most=round(MOST_S * rate_hz),
        rest=round(0.15 * rate_hz),
        rate_hz=rate_hz,
    )
    return float(times[found])


@given(RATES_HZ, st.floats(0.4, 4.0), st.floats(0.05, 1.0), st.floats(0.0, 1.0))
@settings(max_examples=60, deadline=None)
def test_a_smooth_motion_began_when_it_did_whatever_its_speed_and_the_clock(
    rate_hz: float, lasts_s: float, way_m: float, phase: float
) -> None:
    times = clock(rate_hz, lasts_s)
    begin_s = phase / rate_hz
    found_s = told_s(times, way_m * smooth((times - begin_s) / lasts_s))
    assert abs(found_s - begin_s) <= 1.01 / rate_hz + ROUGH_S


@given(RATES_HZ, st.floats(0.3, 3.0), st.floats(0.0, 1.0))
@settings(max_examples=60, deadline=None)
def test_what_sets_off_at_once_began_within_a_frame_of_when_it_did(
    rate_hz: float, speed_mps: float, phase: float
) -> None:
    times = clock(rate_hz, 0.5)
    begin_s = 0.1 + phase / rate_hz
    found_s = told_s(times, np.maximum(times - begin_s, 0.0) * speed_mps)
    assert abs(found_s - begin_s) <= 1.01 / rate_hz


@given(RATES_HZ, st.floats(2.0, 4.0), st.floats(0.2, 0.4), st.integers(0, 1000))
@settings(max_examples=60, deadline=None)
def test_noise_moves_the_beginning_of_a_slow_motion_by_no_more_than_50_ms(
    rate_hz: float, lasts_s: float, way_m: float, seed: int
) -> None:
    """A fifth of a hair is what noise leaves of a filtered place, since a hair is five of it."""
    times = clock(rate_hz, lasts_s)
    noise = np.random.default_rng(seed).normal(0.0, HAIR_M / 5.0, len(times))
    found_s = told_s(times, way_m * smooth(times / lasts_s), noise)
    assert found_s == pytest.approx(0.0, abs=0.05 + 1.0 / rate_hz)


@given(
    arrays.arrays(
        np.float64, st.integers(1, 30), elements=st.floats(-10.0, 1e4) | st.just(float("nan"))
    ),
    st.integers(0, 100),
    st.data(),
)
@settings(max_examples=300, deadline=None)
def test_any_displacement_has_an_answer_no_earlier_than_the_most_and_within_it(
    way: np.ndarray, most: int, data: st.DataObject
) -> None:
    seen = data.draw(st.integers(0, len(way) - 1))
    noise = np.full(len(way), 0.2)
    found = onset(way, way, seen, noise=noise, place=0.1, most=most, rest=5, rate_hz=30.0)
    assert max(seen - most, 0) <= found < len(way)


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


def near(places: np.ndarray, truth: list[float], *, within_s: float) -> float:
    """The share of draws of noise in which both edges are within a time of the truth."""
    draws = [edges(poses(places, draw)) for draw in range(30)]
    return float(np.mean(np.abs(np.array(draws) - truth).max(axis=1) <= within_s))


TRUE_EDGES_RATE_HZ = 100.0
TRUE_EDGES_TIMES = np.arange(500) / TRUE_EDGES_RATE_HZ
FLOOR = Floor(LIMITS.motion_floor_m, LIMITS.motion_floor_rad)
UP = np.array([0.0, 0.0, 1.0])


def smooth_step(begin_s: float, end_s: float) -> np.ndarray:
    """From 0 to 1 between two times, with the least jerk."""
    share = np.clip((TRUE_EDGES_TIMES - begin_s) / (end_s - begin_s), 0.0, 1.0)
    return np.asarray(share**3 * (10.0 - 15.0 * share + 6.0 * share**2))


def true_edges_geometry(positions: np.ndarray) -> BodyGeometry:
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(TRUE_EDGES_TIMES), 1))
    turns[np.isnan(positions).any(axis=1)] = np.nan
    stream = Stream(TRUE_EDGES_TIMES, positions, turns)
    return geometry_of(TagObject("thing", TagType.MOBILE, stream, None), LIMITS)


@given(seed=st.integers(0, 999), pace=st.floats(0.0, 0.08))
@settings(max_examples=20)
def test_the_first_rest_is_the_first_of_all_and_a_median_is_numpys(seed: int, pace: float) -> None:
    random = np.random.default_rng(seed)
    walk = np.cumsum(random.normal(0.0, pace * 0.01, (len(TRUE_EDGES_TIMES), 3)), axis=0)
    poses = true_edges_geometry(walk).poses
    every = rest_poses(poses, FLOOR, LIMITS)
    first = first_rest(true_edges_geometry(walk).poses, FLOOR, LIMITS)
    assert (first is None) == (not every)
    if first:
        assert first.interval == every[0].interval
        assert np.array_equal(first.position, every[0].position)
    place, _ = median_pose(poses.smooth, slice(0, 1 + seed % 40))
    some = poses.smooth.positions[: 1 + seed % 40]
    near = np.linalg.norm(some - np.median(some, axis=0), axis=1)
    assert np.array_equal(place, some[near <= np.median(near)].mean(axis=0))


def true_edges_edges(positions: np.ndarray) -> tuple[float, float]:
    """When the one motion of a thing begins and ends [s]."""
    poses = true_edges_geometry(positions).poses
    rests = rest_poses(poses, FLOOR, LIMITS)
    (moved,) = moving(poses, rests, FLOOR, LIMITS)
    first, last = motion_edges(poses, moved, rests, FLOOR, LIMITS)
    return float(TRUE_EDGES_TIMES[first]), float(TRUE_EDGES_TIMES[last])


@given(st.floats(1.5, 8.0), st.floats(0.25, 0.5), st.floats(0.4, 1.5))
def test_what_was_nudged_sets_off_from_where_it_stood_last(
    nudge_mm: float, before_s: float, lasts_s: float
) -> None:
    nudge = nudge_mm / 1000.0 * smooth_step(2.0 - before_s, 2.05 - before_s)
    way = nudge + 0.3 * smooth_step(2.0, 2.0 + lasts_s)
    begin, end = true_edges_edges(way[:, None] * np.array([1.0, 0.0, 0.0]))
    assert begin == pytest.approx(2.0, abs=0.05)
    assert end == pytest.approx(2.0 + lasts_s, abs=0.05)


@given(st.floats(1.5, 8.0), st.floats(0.25, 0.5))
def test_what_is_nudged_after_it_was_put_down_has_settled_before(
    nudge_mm: float, after_s: float
) -> None:
    nudge = nudge_mm / 1000.0 * smooth_step(3.0 + after_s, 3.05 + after_s)
    way = nudge + 0.3 * smooth_step(2.0, 3.0)
    _, end = true_edges_edges(way[:, None] * np.array([1.0, 0.0, 0.0]))
    assert end == pytest.approx(3.0, abs=0.05)


@given(st.floats(0.5, 2.0), st.floats(0.1, 0.4))
def test_a_smooth_beginning_is_no_nudge(lasts_s: float, way_m: float) -> None:
    way = way_m * smooth_step(1.5, 1.5 + lasts_s)
    begin, end = true_edges_edges(way[:, None] * np.array([0.0, 1.0, 0.0]))
    assert begin == pytest.approx(1.5, abs=0.1)
    assert end == pytest.approx(1.5 + lasts_s, abs=0.1)


@given(st.integers(20, 150), st.integers(1, 30))
def test_a_loss_earlier_in_a_contact_moves_no_lift_off(lost: int, frames: int) -> None:
    places = 0.3 * smooth_step(2.0, 3.0)[:, None] * UP
    base, thing = (
        true_edges_geometry(np.zeros_like(places) - 0.1 * UP),
        true_edges_geometry(places),
    )
    contact = 0, int(np.flatnonzero(places[:, 2] > 0.015)[0])
    whole = seat(thing, base, contact, [(200, 300)], LIMITS)
    assert TRUE_EDGES_TIMES[whole[1]] == pytest.approx(2.0, abs=0.05)
    places[lost : lost + frames] = np.nan
    assert seat(true_edges_geometry(places), base, contact, [(200, 300)], LIMITS)[1] == whole[1]


@given(st.floats(0.05, 0.3), st.floats(0.0, 0.5), st.floats(0.2, 1.2), st.floats(-0.004, 0.004))
def test_what_rises_as_soon_as_it_has_come_down_is_down_in_an_instant_of_its_contact(
    depth_m: float, stays_s: float, lasts_s: float, sags_m: float
) -> None:
    down, up = 2.0 + stays_s, 2.0 - lasts_s
    height = depth_m * (1.0 - smooth_step(up, 2.0) + smooth_step(down, down + lasts_s))
    height += sags_m * np.sin(
        np.pi * np.clip((TRUE_EDGES_TIMES - up) / (down + lasts_s - up), 0.0, 1.0)
    )
    inside = np.flatnonzero(height <= height.min() + 0.012)
    contact = int(inside[0]), int(inside[-1])
    base, thing = (
        true_edges_geometry(np.tile(-0.1 * UP, (len(TRUE_EDGES_TIMES), 1))),
        true_edges_geometry(height[:, None] * UP),
    )
    first, last = seat(thing, base, contact, [(0, 499)], LIMITS)
    assert contact[0] <= first <= last <= contact[1]


@given(st.floats(0.6, 1.2), st.floats(0.6, 1.2), st.floats(0.0, 0.01))
def test_a_hand_has_arrived_when_the_distance_no_longer_shrinks(
    comes_s: float, goes_s: float, near_m: float
) -> None:
    apart = near_m + 0.25 * (1.0 - smooth_step(0.5, 0.5 + comes_s) + smooth_step(3.0, 3.0 + goes_s))
    inside = np.flatnonzero(apart <= near_m + LIMITS.touch_margin_m)
    contact = int(inside[0]), int(inside[-1])
    first, last = settled_ends(apart, contact, TRUE_EDGES_TIMES, LIMITS)
    arrives, leaves = 0.5 + comes_s, 3.0
    assert abs(TRUE_EDGES_TIMES[first] - arrives) <= abs(TRUE_EDGES_TIMES[contact[0]] - arrives)
    assert abs(TRUE_EDGES_TIMES[last] - leaves) <= abs(TRUE_EDGES_TIMES[contact[1]] - leaves)
    assert contact[0] <= first < last <= contact[1]
    assert (apart[[first, last]] <= near_m + LIMITS.edge_m + 1e-9).all()


BOX = shapes.box(0.1, 0.1, 0.1)
TABLE = shapes.table(1.0, 1.0)
PHASES_RATES = st.sampled_from([30.0, 60.0, 100.0, 240.0])
NOISES_M = st.sampled_from([0.0, 0.0005, 0.0015])
SEEDS = st.integers(0, 10)


def phases_smooth(share: np.ndarray) -> np.ndarray:
    """From 0 to 1 with least jerk, at rest before and after."""
    part = np.clip(share, 0.0, 1.0)
    return np.asarray(part**3 * (10.0 - 15.0 * part + 6.0 * part**2))


def body(
    places: np.ndarray, rate_hz: float, *, noise_m: float = 0.0, seed: int = 0
) -> BodyGeometry:
    """A box whose middle is at these places [m], measured with noise."""
    times = np.arange(len(places)) / rate_hz
    noise = np.random.default_rng(seed).normal(0.0, noise_m, places.shape) if noise_m else 0.0
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
    thing = TagObject("thing", TagType.MOBILE, Stream(times, places + noise, turns), BOX)
    return geometry_of(thing, LIMITS)


def arc(rate_hz: float, *, up_m: float, aside_m: float, lasts_s: float = 1.6) -> np.ndarray:
    """An ellipse over the table, from 0.5 s on, with a rest before and after."""
    times = np.arange(round((lasts_s + 1.0) * rate_hz)) / rate_hz
    angle = np.pi * phases_smooth((times - 0.5) / lasts_s)
    x, z = 0.5 * aside_m * (1.0 - np.cos(angle)), up_m * np.sin(angle)
    return np.stack([x, np.zeros_like(x), z], axis=1)


def found_in(thing: BodyGeometry, rate_hz: float, lasts_s: float = 1.6) -> tuple[Phase, ...]:
    whole = (round(0.5 * rate_hz), round((0.5 + lasts_s) * rate_hz))
    return phases(thing, (whole,), LIMITS)


@settings(max_examples=40)
@given(rate_hz=PHASES_RATES, noise_m=NOISES_M, seed=SEEDS)
def test_a_high_arc_rises_goes_level_and_sinks_where_it_is_at_45_degrees(
    rate_hz: float, noise_m: float, seed: int
) -> None:
    up_m, aside_m = 0.25, 0.5
    thing = body(arc(rate_hz, up_m=up_m, aside_m=aside_m), rate_hz, noise_m=noise_m, seed=seed)
    found = found_in(thing, rate_hz)
    assert [each.kind for each in found] == [RISING, LEVEL, SINKING]
    share = np.linspace(0.0, 1.0, 10001)
    angle = np.pi * phases_smooth(share)
    slope = up_m * np.cos(angle) / (0.5 * aside_m * np.maximum(np.sin(angle), 1e-9))
    steep = 0.5 + 1.6 * share[int(np.argmax(slope < 1.0))]
    flat = 0.5 + 1.6 * share[int(np.argmax(slope < -1.0))]
    placed = [each.last / rate_hz for each in found[:2]]
    assert placed == pytest.approx([steep, flat], abs=0.05)


@settings(max_examples=40)
@given(rate_hz=PHASES_RATES, noise_m=NOISES_M, seed=SEEDS, aside_m=st.floats(0.0, 0.08))
def test_what_goes_up_and_down_turns_back_in_the_middle_of_its_flat_top(
    rate_hz: float, noise_m: float, seed: int, aside_m: float
) -> None:
    thing = body(arc(rate_hz, up_m=0.25, aside_m=aside_m), rate_hz, noise_m=noise_m, seed=seed)
    (turn,) = turns_of_height(found_in(thing, rate_hz), thing.middles, (), LIMITS)
    assert turn / rate_hz == pytest.approx(1.3, abs=0.05)


@settings(max_examples=40)
@given(rate_hz=PHASES_RATES, noise_m=NOISES_M, seed=SEEDS, up_m=st.floats(0.0, 0.08))
def test_a_flat_arc_is_level_and_turns_back_nowhere(
    rate_hz: float, noise_m: float, seed: int, up_m: float
) -> None:
    thing = body(arc(rate_hz, up_m=up_m, aside_m=0.6), rate_hz, noise_m=noise_m, seed=seed)
    assert turns_of_height(found_in(thing, rate_hz), thing.middles, (), LIMITS) == ()


@settings(max_examples=40)
@given(rate_hz=PHASES_RATES, noise_m=NOISES_M, seed=SEEDS)
def test_phases_of_a_motion_follow_each_other_and_fill_it(
    rate_hz: float, noise_m: float, seed: int
) -> None:
    thing = body(arc(rate_hz, up_m=0.2, aside_m=0.4), rate_hz, noise_m=noise_m, seed=seed)
    found = found_in(thing, rate_hz)
    assert found[0].first == round(0.5 * rate_hz)
    assert found[-1].last == round(2.1 * rate_hz)
    assert all(one.last == two.first for one, two in pairwise(found))


def test_it_turns_in_the_level_part_before_the_first_pause_however_far_it_goes_later() -> None:
    times = np.arange(650) / 100.0
    up = 0.2 * (phases_smooth((times - 0.5) / 0.9) - phases_smooth((times - 5.0) / 0.9))
    aside = 0.2 * phases_smooth((times - 1.4) / 0.9) + 0.3 * phases_smooth(times - 3.0)
    thing = body(np.stack([aside, np.zeros_like(up), up], axis=1), 100.0)
    found = phases(thing, ((50, 230), (300, 400), (500, 590)), LIMITS)
    (turn,) = turns_of_height(found, thing.middles, (), LIMITS)
    assert 140 < turn < 230


def test_what_sinks_and_rises_again_turns_back_only_after_it_had_risen() -> None:
    rate_hz = 100.0
    high = arc(rate_hz, up_m=0.25, aside_m=0.0)
    low = high * np.array([1.0, 1.0, -1.0])
    thing = body(low, rate_hz)
    assert turns_of_height(found_in(thing, rate_hz), thing.middles, (), LIMITS) == ()


@settings(max_examples=40)
@given(rate_hz=PHASES_RATES, seed=SEEDS, lasts_s=st.floats(0.4, 2.0), way_m=st.floats(0.1, 0.6))
def test_a_smooth_motion_is_known_to_begin_and_end_within_50_ms_and_a_frame(
    rate_hz: float, seed: int, lasts_s: float, way_m: float
) -> None:
    creeps_s = lasts_s * (LIMITS.edge_m / (10.0 * way_m)) ** (1.0 / 3.0)
    assume(creeps_s < LIMITS.onset_s + 0.05)  # What takes longer to go a hair drifts.
    edges_are_right(rate_hz, 0.0003, seed, lasts_s, way_m)


@settings(max_examples=40)
@given(rate_hz=PHASES_RATES, seed=SEEDS, lasts_s=st.floats(0.4, 1.2), way_m=st.floats(0.2, 0.6))
def test_noise_of_a_millimetre_and_a_half_hides_no_more_than_that_of_a_quick_motion(
    rate_hz: float, seed: int, lasts_s: float, way_m: float
) -> None:
    edges_are_right(rate_hz, 0.0015, seed, lasts_s, way_m)


def edges_are_right(
    rate_hz: float, noise_m: float, seed: int, lasts_s: float, way_m: float
) -> None:
    times = np.arange(round((lasts_s + 1.0) * rate_hz)) / rate_hz
    way = way_m * phases_smooth((times - 0.5) / lasts_s)
    places = np.stack([way, np.zeros_like(way), np.zeros_like(way)], axis=1)
    poses = body(places, rate_hz, noise_m=noise_m, seed=seed).poses
    floor = Floor(LIMITS.motion_floor_m, LIMITS.motion_floor_rad)
    rests = rest_poses(poses, floor, LIMITS)
    (moved,) = moving(poses, rests, floor, LIMITS)
    edges = motion_edges(poses, moved, rests, floor, LIMITS)
    begin, end = (each / rate_hz for each in edges)
    assert begin == pytest.approx(0.5, abs=0.05 + 1.0 / rate_hz)
    assert end == pytest.approx(0.5 + lasts_s, abs=0.05 + 1.0 / rate_hz)


@pytest.mark.parametrize("power", POWERS)
@pytest.mark.parametrize("frames", [3, 8, 20])
def test_a_displacement_that_grows_by_a_power_is_known_to_begin_before_it_shows(
    power: float, frames: int
) -> None:
    grows = ((frames + np.arange(10.0 * frames)) / frames) ** power
    assert before_seen(grows, GROWN, 100) == pytest.approx(frames, abs=1)


def test_a_box_is_down_until_it_rises_and_no_longer_where_it_merely_touches_by_tolerance() -> None:
    rate_hz = 100.0
    places = arc(rate_hz, up_m=0.05, aside_m=0.3) + np.array([0.0, 0.0, 0.05])
    box = body(places, rate_hz)
    times = np.arange(len(places)) / rate_hz
    flat = np.zeros((len(times), 3))
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
    table = geometry_of(TagObject("t", TagType.FIXED, Stream(times, flat, turns), TABLE), LIMITS)
    height = places[:, 2] - 0.05
    left = int(np.argmax(height > 0.005)) - 1
    rises = 50
    motion = (rises, 210)
    first, last = seat(box, table, (0, left), [motion], LIMITS)
    assert first == 0
    assert last == pytest.approx(rises, abs=5)
    assert last < left - 15
    assert seat(box, table, (0, left), [], LIMITS) == (0, left), "at rest nothing leaves"


ROLLING_TIMES = np.arange(400) / 100.0
BALL = shapes.shape(trimesh.creation.icosphere(subdivisions=3, radius=0.05), "ball")
"""Of a radius of 5 cm."""


def way(length_m: float) -> np.ndarray:
    """How far it has come at each frame: it goes evenly from the first to the third second."""
    return length_m * np.clip((ROLLING_TIMES - 1.0) / 2.0, 0.0, 1.0)


def rolling_body(places: np.ndarray, turns: Rotation, shape: Shape | None = BALL) -> BodyGeometry:
    """A body at these places [m] in these turns."""
    stream = Stream(ROLLING_TIMES, places, geometry.continuous(geometry.quaternions(turns)))
    thing = TagObject("thing", TagType.MOBILE, stream, shape)
    return geometry_of(thing, LIMITS)


def ball(length_m: float, share: float, *, heading: float = 0.0, spin: float = 0.0) -> BodyGeometry:
    """A ball that turns by that share of what rolling would be, and about the vertical beside."""
    gone = way(length_m)
    ahead = np.array([np.cos(heading), np.sin(heading), 0.0])
    axis = np.cross([0.0, 0.0, 1.0], ahead)
    about = np.array([0.0, 0.0, 1.0])
    turns = Rotation.from_rotvec(spin * gone[:, None] / 0.05 * about) * Rotation.from_rotvec(
        share * gone[:, None] / 0.05 * axis
    )
    return rolling_body(gone[:, None] * ahead + np.array([0.0, 0.0, 0.05]), turns)


@settings(deadline=None, max_examples=25)
@given(st.floats(0.15, 1.5), st.floats(0.8, 1.2), st.floats(0.0, 6.28))
def test_a_ball_that_hardly_slips_rolls_all_the_way(
    length_m: float, share: float, heading: float
) -> None:
    ((first, last),) = rolling(ball(length_m, share, heading=heading), LIMITS)
    # The filter of 8 Hz rounds both ends by less than a tenth of a second.
    assert (first, last) == pytest.approx((100, 300), abs=10)


@settings(deadline=None, max_examples=25)
@given(st.floats(0.15, 1.5), st.one_of(st.floats(-2.0, 0.5), st.floats(1.5, 4.0)))
def test_what_turns_too_little_too_much_or_backward_slips(length_m: float, share: float) -> None:
    assert rolling(ball(length_m, share), LIMITS) == ()


def test_what_spins_like_a_top_as_it_goes_does_not_roll() -> None:
    gone = way(0.5)[:, None]
    spun = Rotation.from_rotvec(gone / 0.05 * np.array([0.0, 0.0, 1.0]))
    assert rolling(rolling_body(gone * np.array([1.0, 0.0, 0.0]), spun), LIMITS) == ()


def test_a_box_that_is_tipped_over_its_edge_does_not_roll() -> None:
    cube = shapes.shape(trimesh.creation.box(extents=(0.1, 0.1, 0.1)), "cube")
    angle = way(np.pi / 2.0)[:, None]
    turns = Rotation.from_rotvec(angle * np.array([0.0, 1.0, 0.0]))
    edge = np.array([0.05, 0.0, 0.0])
    places = edge + turns.apply(np.array([-0.05, 0.0, 0.05]))
    assert rolling(rolling_body(places, turns, cube), LIMITS) == ()


def test_without_a_shape_nothing_is_known_to_roll() -> None:
    gone = way(0.5)[:, None]
    turns = Rotation.from_rotvec(gone / 0.05 * np.array([0.0, 1.0, 0.0]))
    assert rolling(rolling_body(gone * np.array([1.0, 0.0, 0.0]), turns, None), LIMITS) == ()


@pytest.mark.parametrize("performer", PERFORMERS, ids=lambda each: each.name)
@pytest.mark.parametrize("noise_m", [0.0, 0.001])
def test_whoever_rolls_a_can_under_the_hand_rolls_it(performer: Performer, noise_m: float) -> None:
    trial = motions.roll_object(performer, noise_m=noise_m, noise_rad=5.0 * noise_m)
    seen = observe(trial.capture)
    assert [each.name for each in seen.segments] == ["Reach", "Roll"]
    assert seen.segments[1].general == ("MoveObj",)
    (rolls,) = [each for each in seen.facts if isinstance(each, Rolls)]
    assert rolls.last - rolls.first > 0.6 * (seen.segments[1].last - seen.segments[1].first)
    thesis = observe(trial.capture, rules="thesis")
    assert [each.name for each in thesis.segments] == ["Reach", "MoveObj"]


SPAN = (50, 350)


def swung(form: Shape, way: np.ndarray, turn: Rotation, *, noise_m: float = 0.0) -> BodyGeometry:
    """A body that moves to and fro along a direction of its own at 1 Hz."""
    times = np.arange(400) / 100.0
    sine = 0.05 * np.sin(2.0 * np.pi * np.clip(times - 0.5, 0.0, 3.0))
    places = turn.apply(np.outer(sine, way / np.linalg.norm(way)))
    places += np.random.default_rng(0).normal(0.0, noise_m, places.shape)
    turns = np.tile(turn.as_quat(scalar_first=True), (len(times), 1))
    thing = TagObject("thing", TagType.MOBILE, stream(places, orientations=turns), form)
    return geometry_of(thing, LIMITS)


def any_turn(seed: int) -> Rotation:
    return Rotation.random(rng=np.random.default_rng(seed))


@given(st.floats(-35.0, 35.0), st.integers(0, 1000))
@settings(max_examples=15, deadline=None)
def test_a_blade_goes_along_its_length_however_it_is_turned(off_deg: float, seed: int) -> None:
    angle = np.radians(off_deg)
    way = np.array([np.cos(angle), np.sin(angle), 0.0])
    blade = swung(box(0.3, 0.04, 0.004), way, any_turn(seed), noise_m=0.0005)
    assert lengthwise(blade, (SPAN,), LIMITS) == (SPAN,)


@given(st.floats(55.0, 125.0), st.integers(0, 1000))
@settings(max_examples=15, deadline=None)
def test_a_blade_that_goes_across_its_length_does_not(off_deg: float, seed: int) -> None:
    angle = np.radians(off_deg)
    way = np.array([np.cos(angle), np.sin(angle), 0.0])
    assert lengthwise(swung(box(0.3, 0.04, 0.004), way, any_turn(seed)), (SPAN,), LIMITS) == ()


@given(st.floats(1.0, 2.5), st.integers(0, 1000))
@settings(max_examples=15, deadline=None)
def test_what_is_not_much_longer_than_wide_has_no_length_to_go_along(
    ratio: float, seed: int
) -> None:
    sponge = swung(box(0.08 * ratio, 0.08, 0.03), np.array([1.0, 0.0, 0.0]), any_turn(seed))
    assert long_axis(sponge, LIMITS) is None
    assert lengthwise(sponge, (SPAN,), LIMITS) == ()
