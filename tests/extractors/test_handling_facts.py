"""What is measured of handled bodies is what their closed forms say."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import shapes
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Shape, Stream, TagObject, TagType
from capar.model.facts import SweptAzimuth
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.contact.normals import contact_normal
from extractors.motion.impacts import closing_speed, falls
from extractors.motion.motion_edges import motion_edges
from extractors.motion.object_motion import Floor, moving, rest_poses, resting
from extractors.motion.phases import (
    leaning,
    level_turns,
    most_turns,
    spin_steps,
    swings,
    turning_points,
)
from extractors.relations.arrangement import (
    Pair,
    above,
    below,
    beside,
    between,
    dips,
    inside,
    sides,
)
from extractors.relations.places import distances, without_small_sweeps
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
RATE_HZ = 100.0
TIMES = np.arange(400) / RATE_HZ
BOX = shapes.box(0.1, 0.1, 0.1)
TABLE = shapes.table(1.0, 1.0)


def body(
    places: np.ndarray, *, turns: Rotation | None = None, shape: Shape | None = BOX
) -> BodyGeometry:
    """A body at these places [m]; one place stands for all frames."""
    positions = np.broadcast_to(np.asarray(places, float), (len(TIMES), 3)).copy()
    identity = np.tile([1.0, 0.0, 0.0, 0.0], (len(TIMES), 1))
    orientations = identity if turns is None else geometry.quaternions(turns)
    stream = Stream(TIMES, positions, geometry.continuous(orientations))
    thing = TagObject("thing", TagType.MOBILE, stream, shape)
    return geometry_of(thing, LIMITS)


def along_x(start: float, end: float) -> np.ndarray:
    """From one place to another, evenly between the first and the third second."""
    share = np.clip((TIMES - 1.0) / 2.0, 0.0, 1.0)[:, None]
    return np.array([start, 0.0, 0.0]) + share * np.array([end - start, 0.0, 0.0])


@given(turns=st.integers(1, 6), size=st.floats(0.1, 2.0))
def test_a_wave_turns_at_its_extrema(turns: int, size: float) -> None:
    phase = np.linspace(0.0, np.pi * (turns + 1), 1000) - np.pi / 2.0
    found = turning_points(size * np.sin(phase), 0.9 * size)
    expected = [(index + 1) * 999 / (turns + 1) for index in range(turns)]
    assert found == pytest.approx(expected, abs=1.0)


def test_what_is_drawn_back_on_the_level_turns_once_and_what_goes_up_and_down_never() -> None:
    there = np.concatenate([np.linspace(0.0, -0.14, 71), np.linspace(-0.14, 0.04, 61)[1:]])
    for way, turns in (
        ((1.0, 0.5, 0.0), (70,)),
        ((0.1, 0.0, 1.0), ()),
        ((0.3, 0.0, 0.0), ()),
    ):
        places = np.outer(there, way) + 1.0
        assert level_turns(places, [(0, len(there) - 1)], LIMITS) == turns


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("lost", [False, True])
def test_a_body_turns_back_most_along_the_axis_on_which_it_goes_to_and_fro(
    axis: int, lost: bool
) -> None:
    """Four periods in two seconds turn eight times, also where it is lost between two turns."""
    wave = np.zeros((len(TIMES), 3))
    wave[:, (axis + 1) % 3] = 0.2 * TIMES
    wave[:, axis] = 0.03 * np.sin(2.0 * np.pi * 2.0 * TIMES)
    stream = body(wave).poses.smooth
    if lost:
        gap = np.isin(np.arange(len(TIMES)), (110, 111))[:, None]
        turned = np.where(gap, np.nan, stream.orientations)
        stream = Stream(stream.times, np.where(gap, np.nan, stream.positions), turned)
    span = (0, round(2.0 / (TIMES[1] - TIMES[0])))
    found, turns = most_turns(stream, span, LIMITS)
    assert found == axis
    assert len(turns) == pytest.approx(8, abs=1)
    assert most_turns(stream, (5, 5), LIMITS)[1].size == 0


@given(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=50))
def test_turning_points_are_far_from_each_other(values: list[float]) -> None:
    found = turning_points(np.array(values), 0.5)
    heights = np.array(values)[found]
    assert (np.abs(np.diff(heights)) >= 0.5).all()


def test_what_moves_to_and_fro_swings() -> None:
    wave = np.zeros((len(TIMES), 3))
    during = (TIMES > 1.0) & (TIMES < 3.0)
    wave[during, 1] = 0.03 * np.sin(2.0 * np.pi * 2.0 * (TIMES[during] - 1.0))
    whole = ((0, len(TIMES) - 1),)
    ((first, last),) = swings(body(wave).poses, whole, LIMITS)
    assert (first, last) == pytest.approx((112, 287), abs=5)
    slow = np.zeros((len(TIMES), 3))
    slow[:, 1] = 0.03 * np.sin(2.0 * np.pi * 0.5 * TIMES)
    assert swings(body(slow).poses, whole, LIMITS) == ()


@pytest.mark.parametrize(("speed_mps", "swinging"), [(0.0, True), (0.1, True), (0.5, False)])
def test_what_bobs_as_it_is_carried_along_does_not_swing(speed_mps: float, swinging: bool) -> None:
    """A stroke of 6 cm each quarter of a second is 0.24 m/s to and fro."""
    wave = np.zeros((len(TIMES), 3))
    wave[:, 0] = speed_mps * TIMES
    wave[:, 2] = 0.03 * np.sin(2.0 * np.pi * 2.0 * TIMES)
    assert bool(swings(body(wave).poses, ((0, len(TIMES) - 1),), LIMITS)) is swinging


def test_motion_to_and_fro_begins_and_ends_with_the_motion_that_is_soon_before_and_after() -> None:
    wave = np.zeros((len(TIMES), 3))
    during = (TIMES > 1.0) & (TIMES < 3.0)
    wave[during, 1] = 0.03 * np.sin(2.0 * np.pi * 2.0 * (TIMES[during] - 1.0))
    assert swings(body(wave).poses, ((100, 300),), LIMITS) == ((100, 300),)
    wave[:, 0] = 0.5 * np.clip((TIMES - 0.9) / 0.2, 0.0, 1.0)
    ((first, last),) = swings(body(wave).poses, ((80, 300),), LIMITS)
    assert first == pytest.approx(112, abs=5), "what was carried further than a stroke is no swing"
    assert last == 300


def test_what_is_lost_for_a_while_swings_before_and_after() -> None:
    wave = np.zeros((len(TIMES), 3))
    wave[:, 2] = 0.06 * np.sin(2.0 * np.pi * 2.0 * TIMES)
    whole = ((0, len(TIMES) - 1),)
    wave[190:230] = np.nan
    spans = swings(body(wave).poses, whole, LIMITS)
    assert [each[1] < 190 or each[0] >= 230 for each in spans] == [True, True]


def leant(angle: np.ndarray, *, speed_mps: float = 0.0) -> tuple[int, int]:
    """When a body leans that is tipped by these angles as it travels."""
    way = np.outer(TIMES * speed_mps, [1.0, 0.0, 0.0])
    where = body(way, turns=Rotation.from_euler("y", angle[:, None])).poses
    ((first, last),) = leaning(where, np.array([0.0, 0.0, 1.0]), LIMITS, length_m=0.2)
    return first, last


OVER_AND_BACK = np.interp(TIMES, [0.2, 1.2, 2.2], [0.0, np.radians(60.0), 0.0])


@given(tilt_rad=st.floats(0.9, 1.5), begin_s=st.floats(0.2, 0.8), end_s=st.floats(2.0, 2.8))
@settings(deadline=None, max_examples=20)
def test_a_leaning_played_backwards_begins_where_it_ended(
    tilt_rad: float, begin_s: float, end_s: float
) -> None:
    knots = [begin_s, begin_s + 0.8, end_s, end_s + 0.8]
    angle = np.interp(TIMES, knots, [0.0, tilt_rad, tilt_rad, 0.0])
    (first, last), (begin, end) = leant(angle), leant(angle[::-1])
    assert (len(TIMES) - 1 - end, len(TIMES) - 1 - begin) == (first, last)


def test_an_object_leans_from_when_it_begins_to_lean_over_until_it_is_upright() -> None:
    assert leant(OVER_AND_BACK) == pytest.approx((20, 220), abs=6)


def test_what_leans_over_as_slowly_as_things_at_rest_turn_leans_beyond_thirty_degrees() -> None:
    slowly = 0.9 * LIMITS.rest_speed_radps * np.clip(TIMES - 0.2, 0.0, 3.5)
    beyond = 20 + 100 * LIMITS.lean_rad / (0.9 * LIMITS.rest_speed_radps)
    assert leant(slowly) == pytest.approx((beyond, len(TIMES) - 1), abs=2)


def test_what_leans_over_as_it_is_carried_leans_beyond_thirty_degrees() -> None:
    assert leant(OVER_AND_BACK, speed_mps=1.0) == pytest.approx((20 + 50, 220 - 50), abs=2)


def test_turning_about_the_vertical_adds_up_beyond_a_whole_turn() -> None:
    angle = 3.0 * np.pi * TIMES / TIMES[-1]
    turned = geometry.quaternions(Rotation.from_euler("z", angle[:, None]))
    assert np.append(0.0, np.cumsum(spin_steps(turned))) == pytest.approx(angle, abs=1e-6)


def test_what_is_dropped_falls_and_what_is_carried_does_not() -> None:
    drop = np.zeros((len(TIMES), 3))
    after = np.clip(TIMES - 1.0, 0.0, 0.6)
    drop[:, 2] = 2.0 - 0.5 * 9.81 * after**2
    spans = falls(body(drop), LIMITS)
    assert [each for each in spans if each[0] < 110 and each[1] > 140]
    assert falls(body(along_x(0.0, 1.0)), LIMITS) == ()


def test_the_closing_speed_is_that_of_the_approach() -> None:
    thing, wall = body(along_x(0.0, 1.0)), body(np.array([2.0, 0.0, 0.0]))
    assert closing_speed(thing, wall, 200) == pytest.approx(0.5, abs=0.01)
    assert closing_speed(thing, wall, 0) == 0.0


def test_two_that_go_along_together_close_no_faster_for_it() -> None:
    drift = np.outer(TIMES, [0.0, 3.0, 0.0])
    thing, other = body(along_x(0.0, 1.0) + drift), body(np.array([2.0, 0.0, 0.0]) + drift)
    assert closing_speed(thing, other, 200) == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize(
    ("place", "normal"),
    [((0.0, 0.0, 0.0), (0, 0, 1)), ((0.549, 0.0, -0.08), (1, 0, 0)), ((0, 0, -0.14), (0, 0, -1))],
)
def test_a_contact_presses_along_the_side_where_bodies_meet(
    place: tuple[float, float, float], normal: tuple[int, int, int]
) -> None:
    table = body(np.zeros(3), shape=TABLE)
    found = contact_normal(body(np.array(place)), table, 100, Thresholds())
    assert found is not None
    assert found == pytest.approx(normal)


def test_bodies_lie_inside_above_below_and_beside() -> None:
    small, large = shapes.box(0.1, 0.1, 0.1), shapes.box(0.4, 0.4, 0.4)
    other = body(np.zeros(3), shape=large)
    places = {
        inside: (0.0, 0.0, 0.1),
        above: (0.0, 0.0, 0.5),
        below: (0.0, 0.0, -0.2),
        beside: (0.3, 0.0, 0.1),
    }
    for arrangement, place in places.items():
        thing = body(np.array(place), shape=small)
        held = [each for each in places if each(Pair(thing, other, LIMITS)).all()]
        assert held == [arrangement]


def test_what_sticks_out_by_half_is_inside_and_what_stands_on_top_is_not() -> None:
    other = body(np.zeros(3), shape=shapes.box(0.4, 0.4, 0.4))
    assert inside(Pair(body(np.array([0.0, 0.0, 0.34])), other, LIMITS)).all()
    assert not inside(Pair(body(np.array([0.0, 0.0, 0.4])), other, LIMITS)).any()


@pytest.mark.parametrize(("under_m", "held"), [(0.001, False), (0.05, True)])
def test_a_point_is_inside_where_it_is_deeper_than_bodies_that_touch_cut_each_other(
    under_m: float, *, held: bool
) -> None:
    table = body(np.zeros(3), shape=shapes.box(0.4, 0.4, 0.4))
    top = table.boxes[1][0, 2]
    whisk = body(np.array([0.0, 0.0, top - under_m]), shape=None)
    assert bool(inside(Pair(whisk, table, LIMITS)).all()) is held
    assert bool(inside(Pair(whisk, table, LIMITS)).any()) is held


def test_between_is_on_the_way_from_one_to_the_other() -> None:
    one, other = body(np.array([-1.0, 0.0, 0.0])), body(np.array([1.0, 0.0, 0.0]))
    held = between(body(along_x(-2.0, 2.0)), one, other)
    assert np.flatnonzero(held)[[0, -1]] == pytest.approx((153, 247), abs=4)
    assert not between(body(along_x(-2.0, 2.0) + np.array([0.0, 0.5, 0.0])), one, other).any()


def test_who_goes_through_leaves_at_the_opposite_side() -> None:
    thing, tunnel = body(along_x(-1.0, 1.0)), body(np.zeros(3), shape=shapes.box(0.4, 0.4, 0.4))
    assert sides(thing, tunnel, np.array([150, 250])) == "opposite"
    assert sides(thing, tunnel, np.array([150, 190])) == "other"


def test_a_hand_rests_where_it_does_not_move() -> None:
    spans = resting(body(along_x(0.0, 1.0)).poses, LIMITS)
    assert [each[0] for each in spans] == pytest.approx([0, 300], abs=10)
    assert [each[1] for each in spans] == pytest.approx([100, 399], abs=10)


def test_a_motion_begins_before_it_is_beyond_its_floor() -> None:
    share = np.clip((TIMES - 1.0) / 2.0, 0.0, 1.0)[:, None]
    places = (share**3 * (10.0 - 15.0 * share + 6.0 * share**2)) * np.array([0.5, 0.0, 0.0])
    where = body(places).poses
    floor = Floor(LIMITS.motion_floor_m, LIMITS.motion_floor_rad)
    rests = rest_poses(where, floor, LIMITS)
    ((first, last),) = moving(where, rests, floor, LIMITS)
    begin, end = motion_edges(where, (first, last), rests, floor, LIMITS)
    assert begin < first - 10
    assert last + 10 < end
    assert begin == pytest.approx(100, abs=3)


def test_a_rod_that_stands_in_a_bowl_dips_into_it_and_one_beside_or_above_it_does_not() -> None:
    bowl, rod = body(np.zeros(3), shape=shapes.bowl(0.1, 0.08)), shapes.box(0.01, 0.01, 0.3)
    places = {(0.0, 0.0, 0.01): True, (0.15, 0.0, 0.01): False, (0.0, 0.0, 0.09): False}
    for place, within in places.items():
        there = body(np.array(place), shape=rod)
        assert dips(Pair(there, bowl, LIMITS)).all() == within
        assert not inside(Pair(there, bowl, LIMITS)).any()


def test_what_turns_above_a_thing_goes_about_nothing() -> None:
    thing = body(np.zeros(3), shape=shapes.box(0.2, 0.2, 0.2))
    round_ = np.stack([np.cos(TIMES), np.sin(TIMES), 0.0 * TIMES], axis=1)
    whole = tuple(range(0, len(TIMES), 100))
    for radius, expected in ((0.5, 3000), (0.05, 0)):
        going = distances(body(radius * round_ + np.array([0.0, 0.0, 0.3])), thing, whole)
        wound = [each.milliradians for each in going if isinstance(each, SweptAzimuth)]
        assert wound[-1] - wound[0] == pytest.approx(expected, abs=15)


@pytest.mark.parametrize(
    ("sweep_rad", "told"), [(-1.5, False), (1.5, False), (1.65, True), (-4, True)]
)
def test_an_angle_is_told_of_a_whole_recording_where_it_spans_a_quarter_of_a_turn(
    sweep_rad: float, told: bool
) -> None:
    thing, way = (
        body(np.zeros(3), shape=shapes.box(0.1, 0.1, 0.1)),
        np.linspace(2.0, 2.0 + sweep_rad, len(TIMES)),
    )
    goes = body(np.stack([0.5 * np.cos(way), 0.5 * np.sin(way), 0.0 * way], axis=1))
    frames = (*range(0, len(TIMES), 20), len(TIMES) - 1)
    part, whole = (list(distances(goes, thing, frames, whole=each)) for each in (False, True))
    angles = [fact for fact in part if isinstance(fact, SweptAzimuth)]
    assert len(angles) == len(frames)
    assert whole == [fact for fact in part if told or not isinstance(fact, SweptAzimuth)]
    assert without_small_sweeps(angles) == (angles if told else [])


def test_low_passed_poses_that_were_forgotten_are_the_same_again() -> None:
    places = np.random.default_rng(3).normal(0.0, 0.01, (len(TIMES), 3)) + TIMES[:, None]
    places[100:130] = np.nan
    poses = body(places).poses
    before = poses.smooth.positions, poses.smooth.orientations
    assert np.nanmax(np.abs(before[0] - poses.filled.positions)) > 0.005
    poses.forget()
    after = poses.smooth.positions, poses.smooth.orientations
    assert after[0] is not before[0]
    for one, other in zip(before, after, strict=True):
        np.testing.assert_array_equal(one, other)


def test_the_middle_of_a_fixed_thing_is_kept_once_and_told_for_every_frame() -> None:
    table = body(np.array([1.0, 2.0, 3.0]))
    assert table.poses.rests
    middle = np.array([1.0, 2.0, 3.0]) + BOX.bounds.mean(axis=0)
    np.testing.assert_allclose(table.middles, np.tile(middle, (len(TIMES), 1)))
    assert table.middles.strides[0] == 0


@pytest.mark.parametrize(("height_m", "level"), [(0.5, True), (-0.5, True), (0.53125, False)])
def test_what_just_reaches_the_height_of_a_thing_is_beside_it(height_m: float, level: bool) -> None:
    block = shapes.box(0.5, 0.5, 0.5)
    thing = body(np.zeros(3), shape=block)
    there = body(np.array([0.5625, 0.0, height_m]), shape=block)
    assert beside(Pair(there, thing, LIMITS)).all() == level
    assert beside(Pair(there, thing, LIMITS)).any() == level


@pytest.mark.parametrize(("aside_m", "over"), [(0.75, True), (0.765625, False)])
def test_what_is_at_45_degrees_from_the_shadow_of_a_thing_is_still_above_it(
    aside_m: float, over: bool
) -> None:
    block = shapes.box(0.5, 0.5, 0.5)
    there, thing = (body(np.array([x, 0.0, z]), shape=block) for x, z in ((aside_m, 0.75), (0, 0)))
    pair = Pair(there, thing, LIMITS)
    assert above(pair).all() == over
    assert above(pair).any() == over


def test_a_place_of_rest_lasts_from_the_first_frame_and_to_the_last() -> None:
    floor = Floor(LIMITS.motion_floor_m, LIMITS.motion_floor_rad)
    first, last = rest_poses(body(along_x(0.0, 1.0)).poses, floor, LIMITS)
    assert first.interval[0] == 0
    assert last.interval[1] == len(TIMES) - 1


@given(st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=20)
def test_the_outermost_points_of_a_body_hold_those_along_its_axes_and_diagonals(seed: int) -> None:
    points = np.random.default_rng(seed).normal(size=(300, 3))
    cloud = Shape(points, np.arange(300).reshape(-1, 3))
    corners = body(np.zeros(3), shape=cloud).corners + cloud.bounds.mean(axis=0)
    signs = np.array(list(product((-1.0, 0.0, 1.0), repeat=3)))
    for along in signs[np.isin(np.abs(signs).sum(axis=1), (1.0, 3.0))]:
        assert (corners @ along).max() == pytest.approx((points @ along).max())
