"""Zero crossings, motion of objects, gaps and noise obey their laws."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import eased, still, stream
from scipy.spatial.transform import Rotation

from capar.model.capture import Stream, TagObject, TagType
from extractors.bodies.poses import poses_of
from extractors.measure import _track
from extractors.motion.object_motion import RestPose, motion_floor, moving, rest_poses
from extractors.signals.filters import fill_gaps, long_gaps, noise_at_rest, speed
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
RATES = st.sampled_from([30.0, 60.0, 100.0, 120.0, 240.0])


def crossings(of: Stream) -> list[int]:
    pose = poses_of(TagObject("hand", TagType.MOBILE, of), LIMITS)
    highest = float(np.nanmax(speed(pose.smooth.positions, of.times)))
    return [int(each) for each in _track(pose, highest, LIMITS).crossings]


def motions(of: Stream, floor_m: float | None = None) -> tuple[tuple[int, int], ...]:
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


@given(st.floats(0.8, 2.0))
@settings(max_examples=10, deadline=None)
def test_the_fastest_frame_scales_with_the_motion(scale: float) -> None:
    found = crossings(reach(100.0, scale=scale))
    assert len(found) == 5
    assert abs(found[2] - 150.0 * scale) <= 2


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
    assert motions(shaken) == ()


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
    found = motions(seen)
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
    assert len(motions(stream(np.outer(share, [0.03, 0.0, 0.0])))) == count


def test_the_end_of_a_landing_belongs_to_the_stay() -> None:
    plain = reach(100.0)
    ((first, last),) = motions(plain)
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
    (final,) = motions(whole)
    told = 0
    for count in range(180, 400, 3):
        part = stream(whole.positions[:count])
        rest = last_rest(part)
        if rest.interval[0] > 100 and not rest.missing:
            told += 1
            assert motions(part) == (final,)
    assert told > 30


def test_a_turn_on_the_spot_is_motion_and_a_displacement_below_an_own_floor_is_none() -> None:
    times = np.arange(300) / 100.0
    turn = Rotation.from_rotvec(np.outer(eased(times, 1.0, 2.0), [0.0, 0.0, 0.5]))
    spun = stream(np.zeros((300, 3)), orientations=turn.as_quat(scalar_first=True))
    assert len(motions(spun)) == 1
    nudged = stream(np.outer(np.sin(np.pi * eased(times, 1.0, 2.0)), [0.015, 0.0, 0.0]))
    assert len(motions(nudged)) == 1
    assert motions(nudged, floor_m=0.02) == ()


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


def test_a_still_stream_has_no_noise() -> None:
    noise = noise_at_rest(still((1.0, 2.0, 3.0), 100), LIMITS)
    assert noise.position_m == pytest.approx(0.0, abs=1e-12)
