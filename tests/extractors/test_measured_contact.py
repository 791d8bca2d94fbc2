"""Contact is exact on true meshes, at every frame, whoever is named first."""

from itertools import pairwise

import fcl
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from live_runs import DEMO
from measured_bodies import ball, box, cup, handle, shape, still, stream
from scipy.spatial.transform import Rotation
from windows import repeated

from capar.model.capture import Shape, Stream
from capar.pipelines.trials import trial_of
from extractors.bodies.bodies import bodies_of
from extractors.calibration import calibrate
from extractors.contact.contacts import EarlierAnswers, bridged
from extractors.contact.proximity import FEW, Body, body, distance, near, nearest, separation, sweep
from extractors.contact.surfaces import EXACTNESS_M, offset_surface, surface
from extractors.contact.touch_distances import touchable
from extractors.signals.intervals import intervals
from extractors.thresholds import Thresholds

EXACT_M = 0.00005


def at(of: Shape, where: Stream, *, rests: bool = False) -> Body:
    return body(surface(of), where, rests=rests)


def touches(one: Shape, two: Shape, place: tuple[float, float, float], *, within_m: float) -> bool:
    first = at(one, still((0.0, 0.0, 0.0), 2), rests=True)
    both = near(first, at(two, still(place, 2), rests=True), distance_m=within_m)
    swapped = near(
        at(two, still(place, 2)), at(one, still((0.0, 0.0, 0.0), 2)), distance_m=within_m
    )
    assert (both == swapped).all()
    return bool(both[0])


@pytest.mark.parametrize("length_m", [0.2, 2.0, 8.0])
def test_a_beam_touches_with_its_end_however_far_that_is_from_its_middle(length_m: float) -> None:
    beam, post = box(length_m, 0.1, 0.1), box(0.1, 0.1, 0.1)
    for gap_m in (0.001, 0.003):
        end = 0.5 * length_m + 0.05 + gap_m
        assert touches(beam, post, (end, 0.0, 0.0), within_m=0.002) == (gap_m <= 0.002)


@given(st.floats(0.001, 0.02), st.sampled_from([30.0, 100.0, 240.0]), st.floats(0.05, 1.5))
@settings(max_examples=25, deadline=None)
def test_a_box_that_approaches_a_box_touches_exactly_while_the_gap_is_within_the_tolerance(
    tolerance_m: float, rate_hz: float, speed: float
) -> None:
    gaps = 0.1 - speed * np.arange(round(0.2 * rate_hz / speed)) / rate_hz
    way = np.zeros((len(gaps), 3))
    way[:, 2] = 0.1 + gaps
    found = near(
        at(box(0.1, 0.1, 0.1), stream(way, rate_hz=rate_hz)),
        at(box(0.3, 0.3, 0.1), still((0, 0, 0), len(gaps), rate_hz=rate_hz), rests=True),
        distance_m=tolerance_m,
    )
    sure = np.abs(gaps - tolerance_m) > EXACT_M
    overlapping = gaps > -0.1
    assert (found == (gaps <= tolerance_m))[sure & overlapping].all()


@given(st.integers(0, 10_000), st.floats(0.002, 0.012))
@settings(max_examples=15, deadline=None)
def test_contact_of_tumbling_bodies_agrees_with_their_exact_distance(
    seed: int, tolerance_m: float
) -> None:
    random = np.random.default_rng(seed)
    frames = 120
    clock = np.linspace(0.0, 1.0, frames)[:, None]
    waves = random.normal(size=(2, 3))
    places = 0.05 * np.sin(2 * np.pi * clock * waves[0]) + random.normal(0.0, 0.002, (frames, 3))
    turns = Rotation.from_rotvec(2.0 * np.sin(np.pi * clock * waves[1])).as_quat(scalar_first=True)
    moved = at(box(0.02, 0.03, 0.05), stream(places, orientations=turns))
    for other in (cup(), handle(), Shape(cup().vertices, cup().faces[::3])):
        stands = at(other, still((0.0, 0.0, 0.0), frames), rests=True)
        found = near(moved, stands, distance_m=tolerance_m)
        assert (found == near(stands, moved, distance_m=tolerance_m)).all()
        for frame in range(0, frames, 7):
            one, two = (fcl.CollisionObject(each.surface.tree) for each in (moved, stands))
            one.setTransform(fcl.Transform(moved.turns[frame], moved.positions[frame]))
            far = fcl.distance(one, two, fcl.DistanceRequest(), fcl.DistanceResult())
            if far <= tolerance_m - EXACT_M:
                assert found[frame]
            elif far > tolerance_m + EXACT_M and found[frame]:
                assert inside(moved, stands, frame)


def test_a_mug_that_is_grasped_ten_times_is_touched_at_every_frame_at_which_it_is_near() -> None:
    capture = repeated(trial_of(DEMO), 5)
    assert len(capture.times) > FEW
    limits = Thresholds()
    bodies = bodies_of(capture, limits, calibrate(capture, limits))
    hand, mug = touchable(bodies.sensors["right_hand"]), touchable(bodies.objects["mug"])
    found = near(hand, mug, distance_m=0.005)
    some = np.arange(0, len(found), 3)
    apart = np.array([distance(hand, mug, int(frame)) for frame in some])
    sure = np.abs(apart - 0.005) > EXACT_M
    assert (found[some] == (apart <= 0.005))[sure].all()


@given(st.integers(0, 10_000), st.integers(10, 60), st.booleans())
@settings(max_examples=15, deadline=None)
def test_windows_that_overlap_are_answered_as_the_whole_is(
    seed: int, step: int, noisy_ends: bool
) -> None:
    random = np.random.default_rng(seed)
    frames, length = 300, 100
    clock = np.arange(frames)[:, None] / 100.0
    places = 0.05 * np.sin(2.0 * np.pi * clock * random.uniform(0.3, 1.0, 3))
    places[random.integers(0, frames, 5)] = np.nan
    whole = near(at(box(0.03, 0.03, 0.03), stream(places)), _handle(frames), distance_m=0.005)
    answers = EarlierAnswers()
    for begin in range(0, frames - length + 1, step):
        part = places[begin : begin + length].copy()
        if noisy_ends:
            part[-20:] += 0.5
        answers.begin(begin)
        pair = at(box(0.03, 0.03, 0.03), stream(part)), _handle(length)
        found = answers.near(("box", "handle"), *pair, distance_m=0.005)
        sure = length - 20 * noisy_ends
        assert (found[:sure] == whole[begin : begin + sure]).all()
        assert not (noisy_ends and found[sure:].any())


def _handle(frames: int) -> Body:
    return at(handle(), still((0.0, 0.0, 0.0), frames), rests=True)


def inside(one: Body, two: Body, frame: int) -> bool:
    """Whether the origin of the first, which is in its solid, is in the second's solid."""
    point = two.turns[frame].T @ (one.positions[frame] - two.positions[frame])
    return bool(two.surface.contains(point[None])[0])


def test_a_finger_through_a_handle_touches_nothing() -> None:
    finger = shape(trimesh.creation.capsule(height=0.08, radius=0.008))
    assert not touches(finger, handle(), (0.0, 0.0, 0.0), within_m=0.005)
    assert touches(finger, handle(), (0.008, 0.0, 0.0), within_m=0.005)


def test_a_ball_in_the_hollow_of_a_cup_touches_nothing_until_it_comes_to_the_wall() -> None:
    assert not touches(cup(), ball(0.02), (0.0, 0.0, 0.05), within_m=0.005)
    assert touches(cup(), ball(0.02), (0.012, 0.0, 0.05), within_m=0.005)
    assert touches(cup(), ball(0.02), (0.0, 0.0, 0.028), within_m=0.005)


def test_a_body_wholly_inside_a_solid_touches_it_whichever_is_named_first() -> None:
    assert touches(box(0.2, 0.2, 0.2), ball(0.01), (0.03, 0.02, 0.01), within_m=0.005)
    assert touches(ball(0.2), cup(), (0.0, 0.0, 0.0), within_m=0.001)


def test_a_lost_body_touches_nothing() -> None:
    way = np.zeros((50, 3))
    way[10:20] = np.nan
    found = near(
        at(box(0.1, 0.1, 0.1), stream(way)), at(ball(0.02), still((0, 0, 0), 50)), distance_m=0.005
    )
    assert found[:10].all()
    assert not found[10:20].any()
    assert found[20:].all()


@pytest.mark.parametrize("distance_m", [0.002, 0.005, 0.02])
@pytest.mark.parametrize("of", [box(0.1, 0.2, 0.05), cup(), handle(), ball(0.03)])
def test_no_part_of_an_offset_surface_is_beyond_its_distance(of: Shape, distance_m: float) -> None:
    mesh = surface(of).mesh
    corners = offset_surface(mesh, distance_m, closed=True).reshape(-1, 3)
    some = corners[:: max(1, len(corners) // 100)]
    _, far, _ = trimesh.proximity.closest_point_naive(mesh, some)
    assert far.max() <= distance_m + 1.05 * EXACTNESS_M


def test_the_nearest_points_lie_as_far_apart_as_the_distance_says() -> None:
    turned = Rotation.from_euler("xyz", [0.3, 0.2, 0.9])
    where = stream(
        np.tile([0.2, 0.1, 0.05], (2, 1)),
        orientations=np.tile(turned.as_quat(scalar_first=True), (2, 1)),
    )
    first, second = at(box(0.1, 0.1, 0.1), where), at(ball(0.03), still((0.0, 0.0, 0.0), 2))
    far, one, two = nearest(first, second, 0)
    world = turned.apply(one) + np.array([0.2, 0.1, 0.05])
    assert np.linalg.norm(world - two) == pytest.approx(far, abs=1e-6)
    assert np.linalg.norm(two) == pytest.approx(0.03, abs=5e-4)


@given(st.lists(st.booleans(), min_size=3, max_size=80), st.integers(0, 8), st.integers(1, 8))
def test_merged_and_filtered_intervals_leave_no_short_gap_and_no_short_stretch(
    holds: list[bool], dropout: int, least: int
) -> None:
    times = np.arange(len(holds)) / 100.0
    found = intervals(np.array(holds), times, dropout_s=dropout / 100.0, minimum_s=least / 100.0)
    assert all(last - first + 1 >= least for first, last in found)
    assert all(two[0] - one[1] - 1 >= max(dropout, 1) for one, two in pairwise(found))
    assert all(holds[first] and holds[last] for first, last in found)


@given(st.lists(st.sampled_from([0, 1, 2]), max_size=60))
def test_a_bridged_contact_keeps_its_first_and_its_last_frame_and_spans_only_what_is_near(
    nearness: list[int],
) -> None:
    touching, near_by = np.array(nearness) == 2, np.array(nearness) >= 1
    found = bridged(touching, near_by)
    assert (found >= touching).all()
    assert (found <= near_by).all()
    for first, last in intervals(found, np.arange(len(found) + 2.0), dropout_s=0, minimum_s=0):
        assert touching[first]
        assert touching[last]


@pytest.mark.parametrize("size_m", [0.01, 0.05, 0.15])
def test_many_poses_are_answered_as_few_are(size_m: float) -> None:
    """A thing that fits between a body and an offset surface far around it is not apart."""
    times = np.linspace(0.0, 40.0, 4 * FEW)
    distance = 0.08 * (1.0 + np.sin(times)) + 0.15 + size_m / 2.0 - 0.002
    way = np.stack([distance, 0.05 * np.sin(0.7 * times), 0.05 * np.cos(1.3 * times)], axis=1)
    turns = Rotation.from_rotvec(np.outer(0.2 * times, (0.0, 0.0, 1.0))).as_matrix()
    one, two = surface(box(0.3, 0.3, 0.3)), surface(box(size_m, size_m, size_m))
    whole = sweep(one, two, turns, way, distance_m=0.005)
    parts = [
        sweep(one, two, turns[begin : begin + FEW], way[begin : begin + FEW], distance_m=0.005)
        for begin in range(0, len(way), FEW)
    ]
    assert 0.0 < whole.mean() < 1.0
    assert (whole != np.concatenate(parts)).sum() <= 4


@given(st.integers(1, 12), st.integers(0, 12), st.booleans())
def test_a_contact_that_noise_hides_at_the_recording_s_edge_lasts_up_to_it(
    hidden: int, apart: int, turned: bool
) -> None:
    """It does if the bodies stay near by, and no longer than a short interruption lasts."""
    edge = 10
    touching = np.array([False] * 20 + [True] * 20 + [False] * (hidden + apart))
    near_by = np.array([False] * 20 + [True] * (20 + hidden) + [False] * apart)
    one, other = (touching[::-1], near_by[::-1]) if turned else (touching, near_by)
    found = bridged(one, other, edge=edge)
    extended = apart == 0 and hidden < edge
    assert (found == (other if extended else one)).all()


def test_surfaces_are_apart_by_their_distance_and_by_none_where_one_body_is_in_another() -> None:
    places = np.array([[0.2, 0.0, 0.0], [0.115, 0.0, 0.0], [0.0, 0.0, 0.0], [np.nan] * 3])
    small = at(box(0.03, 0.03, 0.03), stream(places))
    large = at(box(0.2, 0.2, 0.2), still((0.0, 0.0, 0.0), 4))
    found = separation(small, large, np.arange(4))
    assert found[:3] == pytest.approx([0.085, 0.0, 0.0], abs=1e-6)
    assert np.isnan(found[3])
    assert distance(small, large, 0) == found[0]
