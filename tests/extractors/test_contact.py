"""Contact: exact surfaces, feet, what passes by, blows, normals, estimated distances."""

from collections import Counter
from dataclasses import replace
from itertools import pairwise

import fcl
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import ball, box, cup, hand, handle, pick_and_place, shape, still, stream
from scipy.spatial.transform import Rotation

from capar.model.calibration import Calibration, Found
from capar.model.capture import Capture, PivotContact, Sensor, Shape, Stream, TagObject, TagType
from capar.model.errors import CaparError
from capar.model.facts import Touching
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.calibration import calibrate, set_values
from extractors.contact.contacts import blow, bridged, set_going
from extractors.contact.normals import facing_normal, places
from extractors.contact.proximity import (
    Body,
    body,
    distance,
    near,
    nearest,
    screened,
    separation,
    sweep,
)
from extractors.contact.surfaces import equal_rows, meeting_points, surface
from extractors.measure import measure
from extractors.motion.impacts import closing_speed, release_speed
from extractors.readers.bundle.shapes import open_edges
from extractors.relations.arrangement import lasting
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


def inside(one: Body, two: Body, frame: int) -> bool:
    """Whether the origin of the first, which is in its solid, is in the second's solid."""
    point = two.turns[frame].T @ (one.positions[frame] - two.positions[frame])
    return bool(two.surface.contains(point[None])[0])


FINGER = shape(trimesh.creation.capsule(height=0.08, radius=0.008))


@pytest.mark.parametrize(
    ("one", "two", "place", "touching"),
    [
        (FINGER, handle(), (0.0, 0.0, 0.0), False),
        (FINGER, handle(), (0.008, 0.0, 0.0), True),
        (cup(), ball(0.02), (0.0, 0.0, 0.05), False),
        (cup(), ball(0.02), (0.012, 0.0, 0.05), True),
        (cup(), ball(0.02), (0.0, 0.0, 0.028), True),
        (box(0.2, 0.2, 0.2), ball(0.01), (0.03, 0.02, 0.01), True),
        (ball(0.2), cup(), (0.0, 0.0, 0.0), True),
    ],
)
def test_what_is_in_a_hollow_touches_its_wall_alone_and_what_is_in_a_solid_touches_that(
    one: Shape, two: Shape, place: tuple[float, float, float], touching: bool
) -> None:
    assert touches(one, two, place, within_m=0.005) is touching


def test_a_lost_body_touches_nothing() -> None:
    way = np.zeros((50, 3))
    way[10:20] = np.nan
    found = near(
        at(box(0.1, 0.1, 0.1), stream(way)), at(ball(0.02), still((0, 0, 0), 50)), distance_m=0.005
    )
    assert found[:10].all()
    assert not found[10:20].any()
    assert found[20:].all()


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
    times = np.linspace(0.0, 40.0, 4000)
    distance = 0.08 * (1.0 + np.sin(times)) + 0.15 + size_m / 2.0 - 0.002
    way = np.stack([distance, 0.05 * np.sin(0.7 * times), 0.05 * np.cos(1.3 * times)], axis=1)
    turns = Rotation.from_rotvec(np.outer(0.2 * times, (0.0, 0.0, 1.0))).as_matrix()
    one, two = surface(box(0.3, 0.3, 0.3)), surface(box(size_m, size_m, size_m))
    whole = sweep(one, two, turns, way, distance_m=0.005)
    parts = [
        sweep(one, two, turns[begin : begin + 100], way[begin : begin + 100], distance_m=0.005)
        for begin in range(0, len(way), 100)
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


@given(seed=st.integers(0, 9999), corners=st.integers(1, 12), faces=st.integers(1, 9))
def test_edges_of_one_triangle_are_open_wherever_corners_are_repeated(
    seed: int, corners: int, faces: int
) -> None:
    random = np.random.default_rng(seed)
    vertices = random.integers(-1, 2, (corners, 3)) * random.choice([-1.0, 1.0], (corners, 1))
    triangles = random.integers(0, corners, (faces, 3))
    sides = Counter(
        frozenset(map(tuple, (vertices[[a, b]] + 0.0).tolist()))
        for each in triangles
        if len({tuple(place) for place in (vertices[each] + 0.0).tolist()}) == 3
        for a, b in zip(each, np.roll(each, -1), strict=True)
    )
    assert open_edges(vertices, triangles) == list(sides.values()).count(1)
    which, first = equal_rows(vertices)
    assert np.array_equal(vertices[first][which], vertices)
    assert len(first) == len(np.unique(vertices, axis=0))
    assert all(place == np.flatnonzero(which == which[place])[0] for place in first)


@given(seed=st.integers(0, 9999), size_m=st.floats(0.02, 3.0))
@settings(max_examples=40, deadline=None)
def test_places_of_large_triangles_in_a_box_are_all_those_that_lie_in_it(
    seed: int, size_m: float
) -> None:
    random = np.random.default_rng(seed)
    triangles = random.normal(scale=size_m, size=(4, 3, 3))
    ends = random.normal(scale=0.3 * size_m, size=(2, 3))
    box, everywhere = np.sort(ends, axis=0), np.array([[-1e3] * 3, [1e3] * 3])
    found, every = (places(triangles, where) for where in (box, everywhere))
    inside = ((every.points >= box[0]) & (every.points <= box[1])).all(axis=1)
    assert np.array_equal(found.points, every.points[inside])
    assert np.array_equal(found.areas, every.areas[inside])


def test_surfaces_are_apart_by_their_distance_and_by_none_where_one_body_is_in_another() -> None:
    places = np.array([[0.2, 0.0, 0.0], [0.115, 0.0, 0.0], [0.0, 0.0, 0.0], [np.nan] * 3])
    small = at(box(0.03, 0.03, 0.03), stream(places))
    large = at(box(0.2, 0.2, 0.2), still((0.0, 0.0, 0.0), 4))
    found = separation(small, large, np.arange(4))
    assert found[:3] == pytest.approx([0.085, 0.0, 0.0], abs=1e-6)
    assert np.isnan(found[3])
    assert distance(small, large, 0) == found[0]


RATES_HZ = st.sampled_from([30.0, 60.0, 100.0, 240.0])
WALL = box(0.02, 0.4, 0.4)


def passing_touches(
    way_m: np.ndarray, rate_hz: float, thing: np.ndarray | None = None
) -> list[Touching]:
    """The contacts of a small hand that goes such a way with a plate that stands upright."""
    hand = Sensor(
        "hand", "hand", "right", "right_arm", stream(way_m, rate_hz=rate_hz), box(0.02, 0.02, 0.02)
    )
    if thing is None:
        pose = still((0.0, 0.0, 0.0), len(way_m), rate_hz=rate_hz)
        plate = TagObject("plate", TagType.FIXED, pose, WALL)
    else:
        plate = TagObject("plate", TagType.MOBILE, stream(thing, rate_hz=rate_hz), WALL)
    facts = measure(Capture("trial", (hand,), (plate,))).facts
    return [each for each in facts if isinstance(each, Touching) and each.body == "hand"]


def clock(rate_hz: float) -> np.ndarray:
    """Two seconds about zero."""
    return np.arange(round(2.0 * rate_hz)) / rate_hz - 1.0


@given(st.floats(1.0, 2.0), st.floats(-0.003, 0.004), RATES_HZ)
@settings(max_examples=20, deadline=None)
def test_a_hand_that_goes_on_past_an_edge_as_before_touches_nothing(
    speed_mps: float, gap_m: float, rate_hz: float
) -> None:
    along = speed_mps * clock(rate_hz)
    way = np.stack([along, np.zeros_like(along), np.full_like(along, 0.21 + gap_m)], axis=1)
    assert not passing_touches(way, rate_hz)


@given(st.floats(1.0, 2.0), st.floats(0.0, 0.004), RATES_HZ)
@settings(max_examples=20, deadline=None)
def test_a_hand_that_bounces_off_has_touched(
    speed_mps: float, deep_m: float, rate_hz: float
) -> None:
    away = speed_mps * np.maximum(np.abs(clock(rate_hz)) - 0.04, 0.0) + 0.02 - deep_m
    way = np.stack([away, np.zeros_like(away), np.zeros_like(away)], axis=1)
    assert len(passing_touches(way, rate_hz)) == 1


@pytest.mark.parametrize("rate_hz", [30.0, 100.0, 240.0])
def test_a_hand_that_strokes_along_slowly_touches(rate_hz: float) -> None:
    along = 0.2 * clock(rate_hz)
    way = np.stack([along, np.zeros_like(along), np.full_like(along, 0.212)], axis=1)
    assert len(passing_touches(way, rate_hz)) == 1


@given(st.floats(1.0, 2.0), st.sampled_from([100.0, 240.0]))
@settings(max_examples=10, deadline=None)
def test_a_hand_that_sends_a_thing_off_has_touched_it(speed_mps: float, rate_hz: float) -> None:
    times = clock(rate_hz)
    way, sent = np.zeros((len(times), 3)), np.zeros((len(times), 3))
    way[:, 0] = np.where(times < 0.0, speed_mps * times, 0.2 * speed_mps * times) - 0.02
    sent[:, 0] = np.maximum(speed_mps * times, 0.0)
    assert passing_touches(way, rate_hz, sent)


RATE_HZ = 100.0
SOLE_M = 0.04
FLOOR = box(20.0, 4.0, 0.1)
NAMES = ("right_foot", "left_foot")


def measured_walk(
    places: dict[str, np.ndarray], rate_hz: float = RATE_HZ, on: TagType = TagType.FIXED
) -> Capture:
    """Feet without joints at such places [m] above a floor whose top is at zero."""
    feet = [
        Sensor(name, "foot", name.split("_")[0], f"{name}_leg", stream(place, rate_hz=rate_hz),
               box(0.26, 0.1, 2 * SOLE_M))
        for name, place in places.items()
    ]  # fmt: skip
    count = len(next(iter(places.values())))
    floor = TagObject("floor", on, still((0.0, 0.0, -0.05), count, rate_hz=rate_hz), FLOOR)
    return Capture("trial", tuple(feet), (floor,))


def contacts_of(capture: Capture, foot: str) -> list[tuple[int, int]]:
    facts = measure(capture).facts
    return [(each.first, each.last) for each in facts
            if isinstance(each, Touching) and each.body == foot]  # fmt: skip


def level(way: np.ndarray, aside: float = 0.0, height: float = SOLE_M) -> np.ndarray:
    """A foot flat on the floor, or so high, that goes such a way along x."""
    return np.stack([way, np.full_like(way, aside), np.full_like(way, height)], axis=1)


def swinging(belt_mps: float, swing_mps: float, phase: float, clearance_m: float) -> np.ndarray:
    """A foot that goes along with a belt for 0.6 s and swings forwards low for 0.4 s, in turn."""
    times = np.arange(400) / RATE_HZ
    swings = ((times + phase) % 1.0) >= 0.6
    soft = np.convolve(swings, np.full(9, 1 / 9), mode="same")
    pace = belt_mps + soft * (swing_mps - belt_mps)
    out = level(np.cumsum(pace) / RATE_HZ)
    out[:, 2] += clearance_m * soft
    return out


@given(st.floats(0.8, 4.0), st.sampled_from([30.0, 60.0, 100.0, 240.0]))
@settings(max_examples=15, deadline=None)
def test_a_foot_that_passes_low_touches_the_floor_only_once_it_is_still(
    speed_mps: float, rate_hz: float
) -> None:
    times = np.arange(round(2.0 * rate_hz)) / rate_hz
    way = speed_mps * np.minimum(times, 1.0)
    ((first, last),) = contacts_of(measured_walk({"right_foot": level(way)}, rate_hz), "right_foot")
    assert first / rate_hz == pytest.approx(1.0, abs=0.07)
    assert last == len(times) - 1


@given(st.floats(-0.4, 0.4))
@settings(max_examples=10, deadline=None)
def test_a_foot_that_shuffles_slowly_never_leaves_the_floor(speed_mps: float) -> None:
    way = speed_mps * np.arange(200) / RATE_HZ
    assert contacts_of(measured_walk({"right_foot": level(way)}), "right_foot") == [(0, 199)]


def test_a_foot_stands_while_it_rolls_over_its_ball() -> None:
    turn = np.linspace(0.0, 1.0, 60)
    angle = np.concatenate([np.zeros(60), turn, np.ones(80)])
    toe = np.array([0.13, 0.0, -SOLE_M])
    middle = np.stack([-toe[0] * np.cos(angle) - toe[2] * np.sin(angle), 0 * angle,
                       toe[0] * np.sin(angle) - toe[2] * np.cos(angle)], axis=1)  # fmt: skip
    turned = np.stack([np.cos(angle / 2), 0 * angle, np.sin(angle / 2), 0 * angle], axis=1)
    capture = measured_walk({"right_foot": middle})
    (foot,) = capture.sensors
    rolled = replace(foot, stream=replace(foot.stream, orientations=turned))
    assert contacts_of(replace(capture, sensors=(rolled,)), "right_foot") == [(0, 199)]


def test_feet_on_a_belt_stand_while_they_go_along_with_it() -> None:
    feet = {name: swinging(-1.2, 1.8, phase, 0.004)
            for name, phase in zip(NAMES, (0.0, 0.5), strict=True)}  # fmt: skip
    capture = measured_walk(feet)
    (belt,) = calibrate(capture).moving_grounds
    assert belt.ground == "floor"
    assert belt.velocity_mps == pytest.approx((-1.2, 0.0), abs=0.02)
    for first, last in contacts_of(capture, "right_foot")[:3]:
        assert (last - first) / RATE_HZ == pytest.approx(0.58, abs=0.08)
    codes = [each.code for each in measure(capture).notices]
    assert codes.count("moving-ground") == 1


@pytest.mark.parametrize("belt_mps", [0.0, -0.3])
def test_a_floor_on_which_feet_come_to_rest_does_not_move(belt_mps: float) -> None:
    feet = {name: swinging(belt_mps, 2.0, phase, 0.004)
            for name, phase in zip(NAMES, (0.0, 0.5), strict=True)}  # fmt: skip
    assert not calibrate(measured_walk(feet)).moving_grounds


LIMITS = Thresholds()


def struck(
    speed_mps: float, leaves_mps: float, rate_hz: float, seed: int
) -> tuple[BodyGeometry, BodyGeometry, int]:
    """A palm comes at a block, which leaves it at once and slides to a halt."""
    times = np.arange(round(3.0 * rate_hz)) / rate_hz
    noise = np.random.default_rng(seed)
    palm = np.zeros((len(times), 3))
    palm[:, 0] = -speed_mps * np.abs(times - 1.0) - 0.06
    since = np.maximum(times - 1.0, 0.0)
    stops = leaves_mps / 3.0
    block = np.zeros((len(times), 3))
    block[:, 0] = leaves_mps * np.minimum(since, stops) - 1.5 * np.minimum(since, stops) ** 2
    palm += noise.normal(0.0, 0.0005, palm.shape)
    block += noise.normal(0.0, 0.0005, block.shape)
    hand = Sensor(
        "palm", "hand", "right", "right_arm", stream(palm, rate_hz=rate_hz), box(0.02, 0.1, 0.1)
    )
    thing = TagObject("block", TagType.MOBILE, stream(block, rate_hz=rate_hz), box(0.1, 0.1, 0.1))
    return geometry_of(hand, LIMITS), geometry_of(thing, LIMITS), round(rate_hz)


@given(
    st.floats(1.0, 2.5), st.floats(0.6, 1.5), st.sampled_from([100.0, 240.0]), st.integers(0, 1000)
)
@settings(max_examples=20, deadline=None)
def test_a_block_that_is_struck_away_was_met_when_it_set_off(
    speed_mps: float, leaves_mps: float, rate_hz: float, seed: int
) -> None:
    palm, block, met = struck(speed_mps, leaves_mps, rate_hz, seed)
    moves = (met + round(0.01 * rate_hz), met + round(0.3 * rate_hz))
    (frame,) = set_going(block, [moves], LIMITS)
    found = blow(palm, block, frame, 0.005, LIMITS)
    assert found is not None
    assert found[0] <= met + 1
    assert found[1] >= met - 1


def swung_stick(aside_m: float, rate_hz: float, seed: int) -> Capture:
    """A stick in a hand comes at a puck at a metre a second, past it by so far, and halts."""
    palm, puck, _ = struck(1.0, 0.8, rate_hz, seed)
    times = palm.poses.filled.times
    way = np.zeros((len(times), 3))
    way[:, 0] = np.minimum(times - 1.0, 0.0) - 0.06
    way[:, 1] = aside_m
    held = way + np.array([-0.2, 0.0, 0.0])
    sensor = Sensor(
        "palm", "hand", "right", "right_arm", stream(held, rate_hz=rate_hz), box(0.02, 0.1, 0.1)
    )
    length = box(0.38, 0.02, 0.02)
    moved = way + np.array([-0.18, 0.0, 0.0])
    stick = TagObject("stick", TagType.MOBILE, stream(moved, rate_hz=rate_hz), length)
    thing = TagObject("puck", TagType.MOBILE, puck.poses.filled, box(0.1, 0.1, 0.1))
    return Capture("swung stick", (sensor,), (stick, thing))


@given(st.sampled_from([100.0, 240.0]), st.integers(0, 1000))
@settings(max_examples=6, deadline=None)
def test_a_held_stick_met_the_puck_that_it_sends_off(rate_hz: float, seed: int) -> None:
    capture = swung_stick(0.0, rate_hz, seed)
    met = [
        each
        for each in measure(capture).facts
        if isinstance(each, Touching) and (each.body, each.other) == ("stick", "puck")
    ]
    assert any(each.first - 2 <= round(rate_hz) <= each.last + 2 for each in met)


@given(st.floats(0.08, 0.3), st.integers(0, 1000))
@settings(max_examples=4, deadline=None)
def test_a_held_stick_that_passes_beside_the_puck_did_not_meet_it(
    aside_m: float, seed: int
) -> None:
    facts = measure(swung_stick(aside_m, 100.0, seed)).facts
    pairs = [{each.body, each.other} for each in facts if isinstance(each, Touching)]
    assert {"palm", "stick"} in pairs
    assert {"stick", "puck"} not in pairs


@given(st.floats(0.05, 0.4), st.floats(0.8, 2.0))
@settings(max_examples=20, deadline=None)
def test_what_is_pushed_off_softly_was_not_struck(way_m: float, seconds: float) -> None:
    times = np.arange(400) / 100.0
    share = np.clip((times - 1.0) / (seconds + way_m), 0.0, 1.0)
    way = np.zeros((400, 3))
    way[:, 0] = way_m * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    thing = TagObject("block", TagType.MOBILE, stream(way), box(0.1, 0.1, 0.1))
    body = geometry_of(thing, LIMITS)
    assert not list(set_going(body, [(100, 300)], LIMITS))
    assert release_speed(body, 50) < 0.01


@given(st.floats(0.5, 2.5), st.sampled_from([30.0, 100.0, 240.0]), st.integers(0, 1000))
@settings(max_examples=20, deadline=None)
def test_a_hand_that_halts_at_a_wall_met_it_as_fast_as_it_came(
    speed_mps: float, rate_hz: float, seed: int
) -> None:
    times = np.arange(round(2.0 * rate_hz)) / rate_hz
    way = np.zeros((len(times), 3))
    way[:, 0] = speed_mps * np.minimum(times - 1.0, 0.0) - 0.06
    way += np.random.default_rng(seed).normal(0.0, 0.0005, way.shape)
    palm = stream(way, rate_hz=rate_hz)
    hand = Sensor("palm", "hand", "right", "right_arm", palm, box(0.02, 0.1, 0.1))
    stands = stream(np.zeros(way.shape), rate_hz=rate_hz)
    wall = TagObject("wall", TagType.FIXED, stands, box(0.1, 1.0, 1.0))
    late = round(rate_hz) + 1
    found = closing_speed(geometry_of(hand, LIMITS), geometry_of(wall, LIMITS), late)
    assert abs(found - speed_mps) < 0.05 * speed_mps + 0.1


@given(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=60))
def test_what_lasts_begins_where_it_clearly_holds_and_never_flickers_in_between(
    values: list[float],
) -> None:
    share = np.array(values)
    found = lasting(share >= 0.5, share >= 0.4)
    assert found[share >= 0.5].all()
    assert not found[share < 0.4].any()
    kept = (share >= 0.4) & (share < 0.5)
    for frame in np.flatnonzero(kept):
        beside = {
            found[each] for each in (frame - 1, frame + 1) if 0 <= each < len(share) and kept[each]
        }
        assert beside <= {found[frame]}


@given(seed=st.integers(0, 2**32 - 1))
def test_a_meeting_point_lies_in_the_planes_of_both_triangles(seed: int) -> None:
    first, second = np.random.default_rng(seed).normal(size=(2, 3, 3))
    (point,) = meeting_points(first[None], second[None])
    if not np.isnan(point).any():
        for corners in (first, second):
            normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            height = (point - corners[0]) @ normal / np.linalg.norm(normal)
            assert height == pytest.approx(0.0, abs=1e-6)


DEPTH_M = 0.005


def triangles(
    of: Shape, place: tuple[float, float, float] = (0.0, 0.0, 0.0), turn: Rotation | None = None
) -> np.ndarray:
    corners = surface(of).triangles
    turned = corners if turn is None else turn.apply(corners.reshape(-1, 3)).reshape(corners.shape)
    return np.asarray(turned + np.array(place))


@given(
    st.floats(0.0, 2.0 * np.pi),
    st.floats(0.3, 1.2),
    st.floats(-0.001, 0.004),
    st.floats(0.01, 0.03),
)
@settings(max_examples=25, deadline=None)
def test_a_ball_in_a_hollow_ball_is_pressed_along_the_radius_wherever_it_lies(
    azimuth: float, polar: float, gap_m: float, radius_m: float
) -> None:
    hollow = trimesh.creation.icosphere(4, 0.1)
    wall = np.asarray(hollow.triangles)[:, ::-1]
    out = np.array(
        [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), -np.cos(polar)]
    )
    place = (0.1 - radius_m - gap_m) * out
    inner = np.asarray(trimesh.creation.icosphere(4, radius_m).triangles) + place
    found = facing_normal(inner, wall, depth_m=DEPTH_M)
    assert found is not None
    assert np.degrees(np.arccos(np.clip(-found @ out, -1.0, 1.0))) < 6.0


@given(
    st.floats(-0.002, 0.004), st.floats(-0.15, 0.15), st.floats(0.0, np.pi), st.integers(0, 10_000)
)
@settings(max_examples=25, deadline=None)
def test_a_box_on_a_tilted_board_is_pressed_along_the_boards_normal_and_back_by_exactly_as_much(
    gap_m: float, aside_m: float, spin: float, seed: int
) -> None:
    tilt = Rotation.from_rotvec(np.random.default_rng(seed).uniform(-1.0, 1.0, 3))
    board = triangles(box(0.6, 0.6, 0.02), turn=tilt)
    place = tilt.apply([aside_m, 0.02, 0.01 + 0.05 + gap_m])
    thing = triangles(
        box(0.08, 0.12, 0.10), tuple(place), tilt * Rotation.from_rotvec([0, 0, spin])
    )
    found = facing_normal(thing, board, depth_m=DEPTH_M)
    back = facing_normal(board, thing, depth_m=DEPTH_M)
    assert found == pytest.approx(tilt.apply([0.0, 0.0, 1.0]), abs=0.02)
    assert back is not None
    assert np.array_equal(back, -np.asarray(found)), "to the last digit, so that either will do"


def test_what_stands_deep_in_a_cup_lies_on_its_bottom_though_the_rim_is_higher() -> None:
    """The two hulls cut each other least along the rim's way out, which is aside."""
    deep = cup(0.04, 0.10, 0.005)
    low = float(surface(deep).triangles[..., 2].min())
    found = facing_normal(
        triangles(ball(0.012), (0.01, 0.0, low + 0.005 + 0.012)), triangles(deep), depth_m=DEPTH_M
    )
    assert found is not None
    assert np.degrees(np.arccos(found[2])) < 6.0


def test_an_open_sheet_bears_from_the_side_that_it_is_met_at() -> None:
    sheet = np.array([[[-0.3, -0.3, 0.0], [0.3, -0.3, 0.0], [0.0, 0.4, 0.0]]])
    for side in (1.0, -1.0):
        thing = triangles(box(0.06, 0.06, 0.06), (0.0, 0.0, side * 0.031))
        for order in (sheet, sheet[:, ::-1]):
            found = facing_normal(thing, order, depth_m=DEPTH_M, solid=(True, False))
            assert found == pytest.approx((0.0, 0.0, side), abs=0.02)


def test_a_peg_pressed_from_all_sides_has_no_direction() -> None:
    ring = np.asarray(trimesh.creation.annulus(0.0105, 0.03, 0.04).triangles)
    peg = np.asarray(trimesh.creation.cylinder(0.01, 0.2).triangles)
    assert facing_normal(peg, ring, depth_m=0.001) is None


def stands(of: Shape, place: tuple[float, float, float]) -> Body:
    return body(surface(of), still(place, 20), rests=True)


@given(st.floats(-0.03, 0.03), st.floats(0.002, 0.006), st.floats(0.0, 0.3))
@settings(max_examples=20, deadline=None)
def test_a_plate_between_a_ball_and_a_table_keeps_them_apart_and_a_plate_beside_it_does_not(
    aside_m: float, thick_m: float, sunk: float
) -> None:
    """Though the plate's middle may be in the table, and the ball in the plate, by noise."""
    plate = box(0.2, 0.2, thick_m)
    for place_m, between in ((aside_m, True), (aside_m + 0.3, False)):
        bodies = {
            "ball": stands(ball(0.03), (0.0, 0.0, thick_m * (1.0 - 2.0 * sunk) + 0.03)),
            "plate": stands(plate, (place_m, 0.0, (0.5 - sunk) * thick_m)),
            "table": stands(box(2.0, 2.0, 0.1), (0.0, 0.0, -0.05)),
        }
        met = [
            (one, two, (0, 19))
            for one, two in (("ball", "plate"), ("ball", "table"), ("plate", "table"))
        ]
        through = list(screened(met, bodies, bodies, reach_m=0.005))
        assert through == [(), ((0, 19),) if between else (), ()]


@given(st.floats(0.0003, 0.0025), st.floats(0.003, 0.004))
@settings(max_examples=20, deadline=None)
def test_a_table_below_a_plate_is_not_between_the_plate_and_the_ball_on_it(
    gap_m: float, thick_m: float
) -> None:
    """Noise holds the ball off the plate; the longer line that joins them meets the table."""
    bodies = {
        "ball": stands(ball(0.03), (0.0, 0.0, thick_m + gap_m + 0.03)),
        "plate": stands(box(0.2, 0.2, thick_m), (0.0, 0.0, 0.5 * thick_m)),
        "table": stands(box(2.0, 2.0, 0.1), (0.0, 0.0, -0.05)),
    }
    pairs = (("ball", "plate"), ("ball", "table"), ("plate", "table"))
    met = [(one, two, (0, 19)) for one, two in pairs]
    assert list(screened(met, bodies, bodies, reach_m=0.005)) == [(), ((0, 19),), ()]


TOUCHES_S, LEAVES_S = 1.1, 2.8
"""When the hand of ``pick_and_place`` truly touches the thing, and leaves it [s]."""

offsets = st.tuples(*[st.floats(-0.12, 0.12)] * 3)


def moved(capture: Capture, hand_m: tuple[float, ...], thing_m: tuple[float, ...]) -> Capture:
    """The capture with other origins of hand and thing, and without their shapes."""
    (sensor,), (thing, table) = capture.sensors, capture.objects

    def shifted(each: np.ndarray, offset: tuple[float, ...]) -> np.ndarray:
        return np.asarray(each + np.array(offset))

    hands = replace(sensor.stream, positions=shifted(sensor.stream.positions, hand_m))
    things = replace(thing.stream, positions=shifted(thing.stream.positions, thing_m))
    return replace(
        capture,
        sensors=(replace(sensor, stream=hands, shape=None),),
        objects=(replace(thing, stream=things, shape=None), table),
    )


def spans(capture: Capture, first: str, second: str) -> list[tuple[float, float]]:
    times = capture.times
    return [
        (float(times[each.first]), float(times[each.last]))
        for each in measure(capture).facts
        if isinstance(each, Touching) and (each.body, each.other) == (first, second)
    ]


@given(offsets, offsets, st.sampled_from([60.0, 100.0, 240.0]), st.integers(0, 3))
@settings(max_examples=15, deadline=None)
def test_contact_is_found_wherever_on_the_bodies_the_origins_sit(
    hand_m: tuple[float, ...], thing_m: tuple[float, ...], rate_hz: float, seed: int
) -> None:
    plain = pick_and_place(rate_hz=rate_hz, noise_m=0.0005, noise_rad=0.002, seed=seed)
    capture = moved(plain, hand_m, (thing_m[0], thing_m[1], abs(thing_m[2])))
    pair = calibrate(capture).pair("right_hand", "thing")
    assert pair.found is Found.CO_MOTION
    assert 0.02 <= pair.touch_m <= 0.025
    ((start_s, end_s),) = spans(capture, "right_hand", "thing")
    assert start_s == pytest.approx(TOUCHES_S, abs=0.15)
    assert end_s == pytest.approx(LEAVES_S, abs=0.15)


@given(offsets)
@settings(max_examples=10, deadline=None)
def test_what_rests_unheld_on_a_support_touches_it_until_it_is_lifted(
    hand_m: tuple[float, ...],
) -> None:
    capture = moved(pick_and_place(noise_m=0.0003), hand_m, (0.0, 0.0, 0.02))
    pair = calibrate(capture).pair("thing", "table")
    assert pair.found is Found.REST
    assert pair.touch_m == pytest.approx(0.07 + 0.005, abs=0.003)
    (_, up_s), (down_s, _) = spans(capture, "thing", "table")
    assert 1.4 <= up_s <= 1.6
    assert 2.2 <= down_s <= 2.4


def holding(times: np.ndarray, *, held_m: float) -> Capture:
    """A hand without a shape that rests for 2 s beside a bowl that never moves, and goes back."""
    way = np.clip(np.minimum(times - 1.0, 4.0 - times) / 0.6, 0.0, 1.0)[:, None]
    home, there = np.array([-0.45, 0.0, 0.0]), np.array([-held_m, 0.0, 0.0])
    bowl = TagObject("bowl", TagType.MOBILE, still((0.0, 0.0, 0.0), len(times)))
    shelf = TagObject("pot", TagType.MOBILE, still((0.0, -0.6, 0.0), len(times)))
    way = way**3 * (10.0 - 15.0 * way + 6.0 * way**2)
    return Capture("hold", (hand(home + (there - home) * way, None),), (bowl, shelf))


@given(st.floats(0.03, 0.24))
@settings(max_examples=15, deadline=None)
def test_a_thing_that_is_held_and_never_moves_is_touched_where_the_distance_settles(
    held_m: float,
) -> None:
    capture = holding(np.arange(500) / 100.0, held_m=held_m)
    known = calibrate(capture)
    assert known.pair("right_hand", "bowl").found is Found.SETTLING
    assert known.pair("right_hand", "pot").found is Found.NEVER
    ((start_s, end_s),) = spans(capture, "right_hand", "bowl")
    assert 1.2 <= start_s <= 1.6
    assert 3.4 <= end_s <= 3.8


def test_a_hand_that_only_rests_at_home_touches_nothing() -> None:
    bowl = TagObject("bowl", TagType.MOBILE, still((0.1, 0.0, 0.0), 300))
    capture = Capture("home", (hand(np.zeros((300, 3)), None),), (bowl,))
    measured = measure(capture)
    pair = measured.calibration.pair("right_hand", "bowl")
    assert pair.found is Found.NEVER
    assert {"no-shape"} <= {each.code for each in measured.notices}
    stated = set_values(measured.calibration, ["touch_m:right_hand,bowl=0.12"])
    assert stated.pair("right_hand", "bowl").pivots


@pytest.mark.parametrize(("stated_m", "contradicted"), [(0.05, True), (0.13, False), (0.3, True)])
def test_a_stated_distance_holds_and_a_notice_tells_both_numbers_where_it_is_wrong(
    stated_m: float, contradicted: bool
) -> None:
    capture = moved(pick_and_place(), (-0.03, 0.0, 0.0), (0.0, 0.0, 0.0))
    pivots = (PivotContact("right_hand", "thing", stated_m),)
    measured = measure(replace(capture, pivot_contacts=pivots))
    pair = measured.calibration.pair("right_hand", "thing")
    assert (pair.found, pair.touch_m) == (Found.STATED, stated_m)
    told = [each for each in measured.notices if each.code == "distance-contradicted"]
    assert bool(told) is contradicted
    for each in told:
        assert each["touch_m"] == stated_m
        assert each["shown_m"] == pytest.approx(0.112 + 0.02, abs=0.002)


def known() -> Calibration:
    return calibrate(moved(pick_and_place(), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))


def test_one_value_is_set_for_a_run_and_no_other() -> None:
    plain = known()
    changed = set_values(plain, ["touch_m:thing,right_hand=0.12"])
    pair = changed.pair("right_hand", "thing")
    assert (pair.touch_m, pair.found) == (0.12, Found.STATED)
    others = [each for each in changed.pairs if each is not pair]
    assert others == [
        each for each in plain.pairs if each.first != "right_hand" or each.second != "thing"
    ]
    assert replace(changed, pairs=plain.pairs) == plain
    assert set_values(plain, ["contact_dropout_s=0.2"]).contact_dropout_s == 0.2
    assert (
        set_values(plain, ["motion_floor_m:thing=0.02"]).tag_object("thing").motion_floor_m == 0.02
    )


def test_a_stated_distance_is_that_of_surfaces_where_surfaces_were_measured() -> None:
    plain = calibrate(pick_and_place())
    pair = plain.pair("right_hand", "thing")
    assert (pair.found, pair.pivots) == (Found.TOLERANCE, False)
    changed = set_values(plain, ["touch_m:thing,right_hand=0.01"]).pair("right_hand", "thing")
    assert (changed.found, changed.pivots) == (Found.STATED, False)


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ("touch_m:right_hand,thing", "no value"),
        ("touch_m:right_hand,thing=wide", "no number"),
        ("touch_m:right_hand,thing=-0.1", "above zero"),
        ("contact_dropout_s:thing=0.1", "whole capture"),
        ("tuch_m:a,b=1", "touch_m"),
        ("touch_m:right_hand,thnig=0.1", "right_hand"),
        ("motion_floor_m:x=1", "right_hand"),
    ],
)
def test_a_setting_of_another_form_or_of_something_unknown_is_refused(
    setting: str, said: str
) -> None:
    with pytest.raises(CaparError, match=said):
        set_values(known(), [setting])
