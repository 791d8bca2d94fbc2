"""Relations: arrangement, support, loads, rooms, guides, grips, and places from the trunk."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise, product

import motions
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import ball, box, cup, eased, hand, shape, stream
from motions import PERFORMERS, TALL_MAN, Performer, shapes, standing
from motions.doors import (
    case,
    drawer_box,
    open_and_close_door,
    open_and_close_drawer,
    open_and_close_lid,
)
from motions.paths import minimum_jerk
from motions.trials import Trial
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Capture, Shape, Stream, TagObject, TagType
from capar.model.facts import Bears, Leans, LookingAt, Posture, Shapeless, Solid, SweptAzimuth
from capar.pipelines.observation import observe
from extractors.bodies.bodies import BodyGeometry, from_trunk, geometry_of
from extractors.contact.normals import contact_normal
from extractors.contact.touch_distances import Journey, in_either_frame
from extractors.measure import measure
from extractors.motion.impacts import falls
from extractors.motion.object_motion import Floor
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
    shifts,
    sides,
)
from extractors.relations.guides import fit_hinge, fit_rail, guide_of, inside_share
from extractors.relations.places import distances, enclosure, has_room, rooms
from extractors.relations.support import rides, share_of_first
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds
from kb.actionary import Actionary

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
    for way, turns in (((1.0, 0.5, 0.0), (70,)), ((0.1, 0.0, 1.0), ()), ((0.3, 0.0, 0.0), ())):
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
    where = body(way, turns=Rotation.from_euler("y", angle[:, None]))
    ((first, last),) = leaning(where, np.array([0.0, 0.0, 1.0]), LIMITS)
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


@given(seed=st.integers(0, 9999), bowl=st.booleans(), point=st.booleans())
@settings(max_examples=30, deadline=None)
def test_shares_that_few_points_make_are_never_taken_for_more_and_depths_are_exact(
    seed: int, bowl: bool, point: bool
) -> None:
    random = np.random.default_rng(seed)
    there = body(
        random.normal(scale=0.06, size=(len(TIMES), 3)),
        shape=None if point else shapes.box(0.02, 0.05, 0.3),
        turns=Rotation.random(len(TIMES), random_state=seed),
    )
    shape = shapes.bowl(0.1, 0.08) if bowl else shapes.box(0.2, 0.2, 0.2)
    pair = Pair(there, body(np.zeros(3), shape=shape), LIMITS)
    within, deep = pair.shares(np.arange(len(TIMES)))
    fast_within, fast_deep = pair.hull_shares
    low = within < LIMITS.inside_stays_share
    assert np.array_equal(fast_within[~low], within[~low])
    assert (fast_within[low] <= within[low]).all()
    assert np.array_equal(fast_deep, deep)


@given(seed=st.integers(0, 9999), lost=st.booleans())
@settings(max_examples=20, deadline=None)
def test_all_runs_of_a_journey_at_once_are_steady_where_each_frame_by_itself_is(
    seed: int, lost: bool
) -> None:
    random = np.random.default_rng(seed)
    gates = np.repeat(random.random(8) < 0.5, -(-len(TIMES) // 8))[: len(TIMES), None]
    way = np.cumsum(gates * random.normal(0.002, 0.004, (len(TIMES), 3)), axis=0)
    turns = Rotation.from_rotvec(np.cumsum(random.normal(0, 0.01, way.shape), axis=0))
    carrier_way = way + turns.apply([0.1, 0.0, 0.0]) + random.normal(0.0, 0.003, way.shape)
    if lost:
        carrier_way[random.integers(0, len(TIMES), 3)] = np.nan
    thing, carrier = body(way).poses.filled, body(carrier_way, turns=turns).poses.filled
    journey = Journey(thing, LIMITS)
    half = round(0.5 * LIMITS.co_motion_window_s / (TIMES[1] - TIMES[0]))

    def spreads(points: np.ndarray) -> np.ndarray:
        windows = (points[max(0, at - half) : at + half + 1] for at in range(len(TIMES)))
        return np.array([np.linalg.norm(np.ptp(window, axis=0)) for window in windows])

    far = spreads(thing.positions)
    stray = np.minimum(*map(spreads, in_either_frame(carrier, thing, slice(None))))
    most = np.maximum(LIMITS.co_motion_stray_m, LIMITS.co_motion_share * far)
    travels = far >= LIMITS.co_motion_way_m
    assert np.array_equal(journey.travels, travels)
    assert np.array_equal(journey.steady_in(carrier), travels & (stray <= most))


def test_between_is_on_the_way_from_one_to_the_other() -> None:
    one, other = body(np.array([-1.0, 0.0, 0.0])), body(np.array([1.0, 0.0, 0.0]))
    held = between(body(along_x(-2.0, 2.0)), one, other)
    assert np.flatnonzero(held)[[0, -1]] == pytest.approx((153, 247), abs=4)
    assert not between(body(along_x(-2.0, 2.0) + np.array([0.0, 0.5, 0.0])), one, other).any()


def test_who_goes_through_leaves_at_the_opposite_side() -> None:
    thing, tunnel = body(along_x(-1.0, 1.0)), body(np.zeros(3), shape=shapes.box(0.4, 0.4, 0.4))
    assert sides(thing, tunnel, np.array([150, 250])) == "opposite"
    assert sides(thing, tunnel, np.array([150, 190])) == "other"


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


@given(st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=20)
def test_the_outermost_points_of_a_body_hold_those_along_its_axes_and_diagonals(seed: int) -> None:
    points = np.random.default_rng(seed).normal(size=(300, 3))
    cloud = Shape(points, np.arange(300).reshape(-1, 3))
    corners = body(np.zeros(3), shape=cloud).corners + cloud.bounds.mean(axis=0)
    signs = np.array(list(product((-1.0, 0.0, 1.0), repeat=3)))
    for along in signs[np.isin(np.abs(signs).sum(axis=1), (1.0, 3.0))]:
        assert (corners @ along).max() == pytest.approx((points @ along).max())


Point = tuple[float, float]
places = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))


def share(one: Point, two: Point, middle: Point | None, down: tuple[bool, bool]) -> float:
    """Of the first of two feet at these places on the floor, at one instant."""
    first, second = (np.array([[*each, 0.0]]) for each in (one, two))
    above = None if middle is None else np.array([[*middle, 0.95]])
    on = [np.array([each]) for each in down]
    return float(share_of_first(first, second, *on, above, LIMITS)[0])


@given(st.floats(0.15, 0.8), st.floats(0.0, 1.0), st.floats(-0.25, 0.25), st.floats(0.0, 6.28))
def test_two_feet_hold_the_body_by_the_law_of_the_lever(
    apart: float, along: float, aside: float, heading: float
) -> None:
    way = np.array([np.cos(heading), np.sin(heading)])
    across = np.array([-way[1], way[0]])
    middle = along * apart * way + aside * across
    found = share((0.0, 0.0), tuple(apart * way), tuple(middle), (True, True))
    # Moments about the second foot: the weight's arm over that of the first foot's load.
    assert found == pytest.approx(1.0 - along, abs=1e-9)


def test_a_foot_alone_on_the_floor_bears_all_unless_the_body_is_elsewhere() -> None:
    assert share((0.0, 0.0), (0.3, 0.0), (0.1, 0.0), (True, False)) == 1.0
    assert share((0.0, 0.0), (0.3, 0.0), (0.1, 0.0), (False, True)) == 0.0
    assert share((0.0, 0.0), (0.3, 0.0), None, (True, False)) == 1.0
    assert np.isnan(share((0.0, 0.0), (0.3, 0.0), (-0.4, 0.0), (True, False)))


def test_what_cannot_be_known_is_not_said() -> None:
    both = (True, True)
    assert np.isnan(share((0.0, 0.0), (0.3, 0.0), None, both))
    assert np.isnan(share((0.0, 0.0), (0.05, 0.0), (0.02, 0.0), both)), "feet together"
    assert np.isnan(share((0.0, 0.0), (0.3, 0.0), (0.15, 0.5), both)), "seated behind the feet"
    assert np.isnan(share((0.0, 0.0), (0.3, 0.0), (0.15, 0.0), (False, False))), "in the air"


@pytest.mark.parametrize("performer", PERFORMERS, ids=lambda each: each.name)
@pytest.mark.parametrize("noise_m", [0.0, 0.001])
def test_whoever_stands_on_one_leg_does_so_by_name(performer: Performer, noise_m: float) -> None:
    trial = motions.stand_on_one_leg(performer, noise_m=noise_m, noise_rad=5.0 * noise_m)
    seen = observe(trial.capture)
    for link in seen.links:
        names = tuple(each.name for each in link.segments)
        assert names == trial.truth.steps["extended"][link.ee]
    left = seen.links[0].segments[1]
    assert left.general == ("Stand", "Touch")
    assert standing.SHIFTS_S < left.start_s < standing.SHIFTED_S
    assert left.end_s > standing.BACK_S


def test_the_weight_is_whole_while_the_other_foot_is_off_the_floor() -> None:
    facts = bears(motions.stand_on_one_leg(TALL_MAN, rate_hz=100.0).capture)
    ((first, last),) = [each[1:] for each in facts["left_foot"] if each[0] == "whole"]
    assert first < 100.0 * standing.LIFTS_S
    assert last > 100.0 * standing.DOWN_S
    assert [each[0] for each in facts["left_foot"]] == ["part", "whole", "part"]
    assert [each[0] for each in facts["right_foot"]] == ["part", "none", "none", "part"]


def test_one_foot_alone_says_nothing_and_a_pelvis_looks_at_nothing() -> None:
    capture = motions.stand_on_one_leg(TALL_MAN).capture
    one = replace(capture, sensors=tuple(e for e in capture.sensors if e.name != "right_foot"))
    assert bears(one) == {}
    assert not [each for each in measure(capture).facts if isinstance(each, LookingAt)]


def test_shifts_of_weight_are_borders_that_the_actionary_knows() -> None:
    seen = observe(motions.stand_on_one_leg(TALL_MAN).capture)
    kinds = {border.kind for segment in seen.segments for border in segment.begins}
    assert "shifts_weight" in kinds
    with Actionary.in_memory() as known:
        known.add(seen)
        found = known.query("SELECT ?border { ?border capar:borderKind capar:ShiftsWeight }")
    assert found.rows


def bears(capture: Capture) -> dict[str, list[tuple[str, int, int]]]:
    """What was measured of each foot, in time."""
    out: dict[str, list[tuple[str, int, int]]] = {}
    found = [each for each in measure(capture).facts if isinstance(each, Bears)]
    for each in sorted(found, key=lambda fact: (fact.foot, fact.first)):
        out.setdefault(each.foot, []).append((each.share, each.first, each.last))
    return out


FRAMES = 200
MOTION = (50, 150)
LOADS_TIMES = np.arange(FRAMES) / 100.0
SHARE = eased(LOADS_TIMES, 0.5, 1.5)


def thing(name: str, of: Shape, way: np.ndarray) -> BodyGeometry:
    return geometry_of(TagObject(name, TagType.MOBILE, stream(way), of), LIMITS)


def tray(way_m: tuple[float, float, float]) -> BodyGeometry:
    return thing("tray", box(0.4, 0.3, 0.02), np.outer(SHARE, way_m))


@given(
    st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0.05, 0.4)),
    st.floats(-0.12, 0.12),
    st.floats(0.0, 0.2),
)
@settings(max_examples=20, deadline=None)
def test_a_cup_on_a_tray_rides_wherever_the_tray_goes_though_it_slides_a_little(
    way_m: tuple[float, float, float], aside_m: float, slid: float
) -> None:
    cup = (
        np.outer(SHARE, way_m)
        + np.array([0.0, aside_m, 0.051])
        + np.outer(SHARE, [slid * way_m[2], 0, 0])
    )
    load = thing("cup", box(0.06, 0.06, 0.08), cup)
    assert rides(load, tray(way_m), (0, FRAMES - 1), [MOTION], LIMITS)
    assert not rides(tray(way_m), load, (0, FRAMES - 1), [MOTION], LIMITS)


@given(st.floats(0.1, 0.5))
@settings(max_examples=10, deadline=None)
def test_a_thing_under_which_the_tray_is_drawn_away_stays_and_rides_not(way_m: float) -> None:
    load = thing("cup", box(0.06, 0.06, 0.08), np.tile([0.0, 0.0, 0.051], (FRAMES, 1)))
    assert not rides(load, tray((way_m, 0.0, 0.0)), (0, 80), [MOTION], LIMITS)


@given(st.floats(0.1, 0.5))
@settings(max_examples=10, deadline=None)
def test_a_thing_that_is_pushed_at_its_side_rides_not(way_m: float) -> None:
    way = np.outer(SHARE, [way_m, 0.0, 0.0])
    pushed = thing("box", box(0.1, 0.1, 0.1), way + np.array([0.25, 0.0, 0.03]))
    assert not rides(pushed, tray((way_m, 0.0, 0.0)), (0, FRAMES - 1), [MOTION], LIMITS)


def carton() -> BodyGeometry:
    parts = [trimesh.creation.box((0.4, 0.4, 0.01))]
    for axis, sign in ((0, 1), (0, -1), (1, 1), (1, -1)):
        wall = trimesh.creation.box((0.01, 0.4, 0.2) if axis == 0 else (0.4, 0.01, 0.2))
        wall.apply_translation([0.2 * sign * (axis == 0), 0.2 * sign * (axis == 1), 0.1])
        parts.append(wall)
    mesh = trimesh.util.concatenate(parts)
    return thing("carton", shape(mesh), np.outer(SHARE, [0.3, 0.0, 0.2]))


@given(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1))
@settings(max_examples=10, deadline=None)
def test_a_ball_in_a_carton_rides_though_it_rolls_from_wall_to_wall(x: float, y: float) -> None:
    way = np.outer(SHARE, [0.3 + x, y, 0.2]) + np.array([0.0, 0.0, 0.045])
    load = thing("ball", ball(0.04), way)
    assert rides(load, carton(), (0, FRAMES - 1), [MOTION], LIMITS)


def test_a_block_that_a_rake_draws_along_rides_not_though_it_is_within_the_outline() -> None:
    shaft = trimesh.creation.box((0.4, 0.02, 0.02))
    teeth = trimesh.creation.box((0.02, 0.16, 0.1))
    teeth.apply_translation([0.19, 0.0, -0.05])
    way = np.outer(SHARE, [-0.3, 0.0, 0.0])
    rake = thing("rake", shape(trimesh.util.concatenate([shaft, teeth])), way)
    block = thing("block", box(0.06, 0.06, 0.05), way + np.array([0.149, 0.0, -0.06]))
    assert not rides(block, rake, (0, FRAMES - 1), [MOTION], LIMITS)


@pytest.mark.parametrize("touching", [(0, MOTION[0]), (MOTION[1], FRAMES - 1)])
def test_what_lies_in_a_carton_only_before_or_after_its_motion_rides_not(
    touching: tuple[int, int],
) -> None:
    way = np.outer(SHARE, [0.3, 0.0, 0.2]) + np.array([0.0, 0.0, 0.045])
    load = thing("ball", ball(0.04), way)
    assert rides(load, carton(), (0, FRAMES - 1), [MOTION], LIMITS)
    assert not rides(load, carton(), touching, [MOTION], LIMITS)


def banana() -> Shape:
    """A tube that is bent by a third of a circle."""
    angles = np.linspace(0.0, 2.0 * np.pi / 3.0, 12)
    spine = 0.1 * np.column_stack((np.cos(angles), np.sin(angles), np.zeros(12)))
    links = [
        trimesh.creation.cylinder(0.018, segment=[one, other], sections=12)
        for one, other in pairwise(spine)
    ]
    return shape(trimesh.util.concatenate(links))


@pytest.mark.parametrize(
    ("form", "room"), [(cup(0.04, 0.1), True), (cup(0.12, 0.08), True), (box(0.1, 0.2, 0.3), False)]
)
def test_a_vessel_has_room_and_a_box_has_none(form: Shape, room: bool) -> None:
    assert has_room(form, LIMITS) is room


def test_nothing_is_in_a_thing_that_is_only_bent() -> None:
    assert not has_room(banana(), LIMITS)


def test_all_is_seen_from_inside_a_closed_thing_and_nothing_from_outside() -> None:
    form = box(0.2, 0.2, 0.2)
    assert enclosure(form, np.zeros(3)) == 1.0
    assert enclosure(form, np.array([5.0, 0.0, 0.0])) < 0.01


@pytest.mark.parametrize(
    ("form", "kind", "told"),
    [
        (banana(), "banana", [Solid("thing")]),
        (banana(), "bottle", []),
        (cup(0.04, 0.1), "thing", []),
        (None, "bottle", [Shapeless("thing")]),
    ],
)
@pytest.mark.parametrize(
    "tipped", [[Leans("thing", 3, 5)], [Posture("thing", 0, 0, 0), Posture("thing", 5, 900, 0)]]
)
def test_what_is_tipped_is_asked_about(
    form: Shape | None, kind: str, told: list[Solid], tipped: list[Leans]
) -> None:
    body = TagObject("thing", TagType.MOBILE, stream(np.zeros((9, 3))), form)
    things = {"thing": geometry_of(body, LIMITS)}
    assert list(rooms(things, {"thing": kind}, (), tipped, LIMITS)) == told
    assert list(rooms(things, {"thing": kind}, (), [], LIMITS)) == []


FLOOR = Floor(LIMITS.motion_floor_m, LIMITS.motion_floor_rad)
GUIDES_TIMES = np.arange(300) / 100.0
PANEL = shapes.box(0.4, 0.6, 0.02)
UNIT = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda each: np.linalg.norm(each) > 0.1)
SPOT = st.tuples(*[st.floats(-1.0, 1.0)] * 3)
NOISE = st.sampled_from([0.0, 0.0005, 0.0015])
SEEDS = st.integers(0, 99)


def there_and_back() -> np.ndarray:
    """A share of the range at each frame: rest, go, rest, come back, rest."""
    return minimum_jerk((GUIDES_TIMES - 0.5) / 0.8) - minimum_jerk((GUIDES_TIMES - 1.7) / 0.8)


def guides_body(
    places: np.ndarray, turns: Rotation, shape: Shape = PANEL, noise_m: float = 0.0, seed: int = 0
) -> BodyGeometry:
    """A mobile body at these places [m] in these turns, as a noisy tracker has it."""
    random = np.random.default_rng(seed)
    shaken = turns * Rotation.from_rotvec(
        5.0 * noise_m * random.standard_normal((len(GUIDES_TIMES), 3))
    )
    seen = places + noise_m * random.standard_normal((len(GUIDES_TIMES), 3))
    stream = Stream(GUIDES_TIMES, seen, geometry.continuous(geometry.quaternions(shaken)))
    return geometry_of(TagObject("thing", TagType.MOBILE, stream, shape), LIMITS)


def fixed(shape: Shape, place: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> BodyGeometry:
    """Something that stands fixed."""
    poses = Stream(
        GUIDES_TIMES,
        np.tile(place, (len(GUIDES_TIMES), 1)),
        np.tile([1.0, 0.0, 0.0, 0.0], (300, 1)),
    )
    return geometry_of(TagObject("fixed", TagType.FIXED, poses, shape), LIMITS)


@settings(deadline=None, max_examples=15)
@given(UNIT, SPOT, SPOT, st.floats(0.3, 2.8), NOISE, SEEDS)
def test_a_hinge_is_recovered(
    axis: tuple[float, float, float],
    point: tuple[float, float, float],
    arm: tuple[float, float, float],
    span_rad: float,
    noise_m: float,
    seed: int,
) -> None:
    direction = np.array(axis) / np.linalg.norm(axis)
    turns = Rotation.from_rotvec(span_rad * there_and_back()[:, None] * direction)
    thing = guides_body(np.array(point) + turns.apply(np.array(arm)), turns, PANEL, noise_m, seed)
    fit = fit_hinge(thing)
    assert fit is not None
    # Each frame's turn is off by 5 rad for each metre of noise, the axis by less.
    assert abs(fit.axis @ direction) >= np.cos(1e-4 + 10.0 * noise_m / span_rad)
    beside = np.cross(fit.point - np.array(point), direction)
    assert np.linalg.norm(beside) <= 1e-4 + 20.0 * noise_m / span_rad
    assert np.ptp(fit.course) == pytest.approx(span_rad, abs=0.003 + 30.0 * noise_m)
    assert fit.residual_m <= 1e-3 + 4.0 * noise_m


@settings(deadline=None, max_examples=15)
@given(UNIT, SPOT, st.floats(0.05, 0.8), NOISE, SEEDS)
def test_a_rail_is_recovered(
    axis: tuple[float, float, float],
    point: tuple[float, float, float],
    span_m: float,
    noise_m: float,
    seed: int,
) -> None:
    direction = np.array(axis) / np.linalg.norm(axis)
    places = np.array(point) + span_m * there_and_back()[:, None] * direction
    guides_still = Rotation.from_rotvec(np.zeros((len(GUIDES_TIMES), 3)))
    fit = fit_rail(guides_body(places, guides_still, PANEL, noise_m, seed))
    assert fit is not None
    assert abs(fit.axis @ direction) >= np.cos(1e-6 + 2.0 * noise_m / span_m)
    assert np.ptp(fit.course) == pytest.approx(span_m, abs=0.003 + 6.0 * noise_m)
    assert fit.residual_m <= 1e-3 + 4.0 * noise_m


def guides_still() -> Rotation:
    return Rotation.from_rotvec(np.zeros((len(GUIDES_TIMES), 3)))


def along(way: tuple[float, float, float]) -> np.ndarray:
    return there_and_back()[:, None] * np.array(way)


CASE = fixed(case(front=True))
INSIDE = np.array([-0.01, 0.0, 0.023])
"""Where the drawer is closed in the case [m]."""


def test_a_drawer_is_guided_and_one_that_is_taken_out_is_not() -> None:
    drawn = guide_of(
        guides_body(INSIDE + along((-0.2, 0, 0)), guides_still(), drawer_box()),
        [CASE],
        FLOOR,
        LIMITS,
    )
    assert drawn is not None
    assert (drawn.fit.kind, drawn.base) == ("rail", "fixed")
    assert drawn.opening.max() == pytest.approx(0.2, abs=1e-3)
    gone = guides_body(INSIDE + along((-0.6, 0, 0)), guides_still(), drawer_box())
    assert guide_of(gone, [CASE], FLOOR, LIMITS) is None
    raised = (
        INSIDE + along((-0.2, 0, 0)) + np.where(GUIDES_TIMES > 2.7, 0.05, 0.0)[:, None] * [0, 0, 1]
    )
    assert (
        guide_of(guides_body(raised, guides_still(), drawer_box()), [CASE], FLOOR, LIMITS) is None
    )


def test_what_is_pushed_into_a_wide_shelf_is_on_no_rail() -> None:
    book = shapes.box(0.25, 0.05, 0.2)
    pushed = guides_body(np.array([0.0, 0.05, 0.025]) + along((-0.3, 0, 0)), guides_still(), book)
    assert guide_of(pushed, [CASE], FLOOR, LIMITS) is None


LEAF = shapes.box(0.012, 0.25, 0.3)
SHUT = np.array([-0.208, 0.125, 0.0])
"""Where a leaf covers the left half of the case's front [m]."""


@settings(deadline=None, max_examples=10)
@given(st.floats(0.05, 0.22), NOISE, SEEDS)
def test_a_sliding_door_is_shut_where_it_meets_the_edge_of_its_opening(
    way_m: float, noise_m: float, seed: int
) -> None:
    for side in (1.0, -1.0):
        leaf = guides_body(
            SHUT * np.array([1.0, side, 1.0]) + along((0, -side * way_m, 0)),
            guides_still(),
            LEAF,
            noise_m,
            seed,
        )
        found = guide_of(leaf, [CASE], FLOOR, LIMITS)
        assert found is not None
        assert (found.fit.kind, found.base) == ("rail", "fixed")
        assert np.median(found.opening[:40]) < 0.004
        assert np.median(found.opening[130:160]) == pytest.approx(way_m, abs=0.004)


def test_a_leaf_that_is_drawn_off_its_opening_is_shut_before_it() -> None:
    beside = SHUT + np.array([0.0, 0.15, 0.0]) + along((0, -0.15, 0))
    found = guide_of(guides_body(beside, guides_still(), LEAF), [CASE], FLOOR, LIMITS)
    assert found is not None
    assert np.median(found.opening[:40]) == pytest.approx(0.15, abs=0.002)
    assert np.median(found.opening[130:160]) < 0.001


def test_what_goes_straight_before_an_opening_is_no_door_if_it_can_lie_or_has_no_shut_end() -> None:
    whole = guides_body(SHUT + along((0, -0.25, 0)), guides_still(), LEAF)
    between = guides_body(
        SHUT + np.array([0.0, -0.05, 0.0]) + along((0, -0.05, 0)), guides_still(), LEAF
    )
    ajar = guides_body(SHUT + along((0, -0.2, 0)), guides_still(), LEAF)
    away = guides_body(
        SHUT - np.array([0.05, 0.0, 0.0]) + along((0, -0.2, 0)), guides_still(), LEAF
    )
    table = fixed(shapes.table(0.8, 1.6), (0.0, 0.0, -0.003))
    block = fixed(shapes.box(0.4, 0.5, 0.3))
    for each in (whole, between, away):
        assert guide_of(each, [CASE], FLOOR, LIMITS) is None
    assert guide_of(ajar, [CASE], FLOOR, LIMITS) is not None
    assert guide_of(ajar, [CASE, table], FLOOR, LIMITS) is None
    assert guide_of(ajar, [block], FLOOR, LIMITS) is None


def test_a_leaf_of_which_half_lies_in_its_base_is_inside_it_and_no_door() -> None:
    front = CASE.boxes[0][0, 0]
    places = {share: front + (0.5 - share) * -LEAF.size[0] for share in (0.25, 0.5)}
    for share, at in places.items():
        leaf = guides_body(np.array([at, *SHUT[1:]]) + along((0, -0.2, 0)), guides_still(), LEAF)
        assert inside_share(leaf, CASE, 0) == share
        assert (guide_of(leaf, [CASE], FLOOR, LIMITS) is None) == (share >= LIMITS.inside_share)


def test_what_slides_turns_or_tips_on_a_table_is_on_no_guide() -> None:
    table, plate = fixed(shapes.table(0.8, 1.6)), shapes.box(0.3, 0.3, 0.05)
    slid = guides_body(along((0.3, 0.0, 0.0)), guides_still(), plate)
    spun_by = Rotation.from_rotvec(1.2 * there_and_back()[:, None] * [0.0, 0.0, 1.0])
    spun = guides_body(np.zeros((300, 3)), spun_by, plate)
    corner = np.array([0.15, 0.15, 0.0])
    about = guides_body(corner + spun_by.apply(-corner), spun_by, plate)
    tip = Rotation.from_rotvec(0.8 * there_and_back()[:, None] * [0.0, 1.0, 0.0])
    edge = np.array([0.15, 0.0, 0.0])
    tipped = guides_body(edge + tip.apply(-edge), tip, plate)
    lifted = guides_body(along((0.0, 0.0, 0.3)), guides_still(), plate)
    for each in (slid, spun, about, tipped, lifted):
        assert guide_of(each, [table], FLOOR, LIMITS) is None


@pytest.mark.parametrize("noise_m", [0.0, 0.001])
@pytest.mark.parametrize("act", [open_and_close_drawer, open_and_close_door, open_and_close_lid])
def test_the_axis_is_kept_with_range_and_residual(
    act: Callable[..., Trial], noise_m: float
) -> None:
    trial = act(motions.WOMAN, noise_m=noise_m, noise_rad=5.0 * noise_m)
    (guide,) = observe(trial.capture).guides
    wanted = {"drawer": ("rail", 0.22), "door": ("hinge", 1.2), "lid": ("hinge", 1.4)}
    assert (guide.kind, guide.base) == (wanted[guide.object][0], "case")
    assert guide.opened == pytest.approx(wanted[guide.object][1], abs=0.002 + 10.0 * noise_m)
    assert guide.residual_m <= 0.0005 + 3.0 * noise_m
    line = Rotation.from_quat(guide.base_nlt.orientation, scalar_first=True).apply([1.0, 0.0, 0.0])
    opens = {"drawer": (-1.0, 0.0, 0.0), "door": (0.0, 0.0, -1.0), "lid": (0.0, 1.0, 0.0)}
    np.testing.assert_allclose(line, opens[guide.object], atol=0.001 + 10.0 * noise_m)
    assert observe(trial.capture, rules="thesis").guides == ()


GRIPS_TIMES = np.arange(0.0, 4.0, 0.01)
WIDTH_M = LIMITS.hand_width_m


def found(
    way_m: float, *, carry: np.ndarray | None = None, turn: np.ndarray | None = None
) -> list[Interval]:
    """Shifts of a hand that goes so far on an object, and stirs before and after."""
    place = np.outer(eased(GRIPS_TIMES, 1.5, 2.0), [way_m, 0.0, 0.0])
    place[:, 1] += 0.1
    place += np.outer(eased(GRIPS_TIMES, 0.3, 0.6) + eased(GRIPS_TIMES, 3.0, 3.3), [0.0, 0.01, 0.0])
    carry = np.zeros((len(GRIPS_TIMES), 3)) if carry is None else carry
    turns = Rotation.from_rotvec(
        np.outer(0.0 * GRIPS_TIMES if turn is None else turn, [0.0, 0.0, 1.0])
    )
    thing = TagObject(
        "thing",
        TagType.MOBILE,
        stream(carry, orientations=turns.as_quat(scalar_first=True)),
        box(0.2, 0.1, 0.1),
    )
    palm = hand(carry + turns.apply(place), ball(0.04))
    figures = [geometry_of(each, LIMITS) for each in (palm, thing)]
    return list(shifts(*figures, (0, len(GRIPS_TIMES) - 1), LIMITS))


@given(st.floats(WIDTH_M + 0.01, 0.3))
@settings(max_examples=10, deadline=None)
def test_farther_than_a_hands_width_is_one_shift_at_its_time(way_m: float) -> None:
    ((first, last),) = found(way_m)
    assert 0.5 < GRIPS_TIMES[first] < 1.6
    assert 1.9 < GRIPS_TIMES[last] < 3.2


@given(st.floats(0.0, WIDTH_M - 0.02))
@settings(max_examples=10, deadline=None)
def test_nearer_than_a_hands_width_is_none(way_m: float) -> None:
    assert found(way_m) == []


@given(st.floats(-0.5, 0.5), st.floats(0.0, 3.0))
@settings(max_examples=10, deadline=None)
def test_it_does_not_depend_on_where_the_object_is_carried(way_m: float, angle: float) -> None:
    share = eased(GRIPS_TIMES, 0.5, 3.5)
    carry = np.outer(share, [0.0, way_m, 0.3])
    assert len(found(0.15, carry=carry, turn=angle * share)) == 1
    assert found(0.0, carry=carry, turn=angle * share) == []


TRUNK_TIMES = np.arange(20) / 100.0
MOUNTS = st.tuples(st.floats(-180.0, 180.0), st.floats(-80.0, 80.0), st.floats(-80.0, 80.0))
ANGLES = st.floats(-170.0, 170.0)
PLACES = st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.floats(0.0, 1.5))


def trunk_body(place: np.ndarray, turn: Rotation) -> BodyGeometry:
    """A body without a shape that stays at a place [m]."""
    places = np.tile(np.asarray(place, float), (len(TRUNK_TIMES), 1))
    turns = np.tile(geometry.quaternions(turn), (len(TRUNK_TIMES), 1))
    stream = Stream(TRUNK_TIMES, places, geometry.continuous(turns))
    return geometry_of(TagObject("trunk_body", TagType.MOBILE, stream, None), Thresholds())


def seen(hand: np.ndarray, at: np.ndarray, turn: Rotation, mount: Rotation) -> np.ndarray:
    """Where a hand is from a trunk that is at a place, and turned from how it stands [m]."""
    trunk = trunk_body(at, turn * mount)
    return from_trunk(
        trunk_body(hand, Rotation.identity()), trunk, mount.inv().apply([0.0, 0.0, 1.0])
    )[0]


@given(MOUNTS, PLACES, ANGLES, PLACES)
def test_who_walks_and_turns_keeps_a_hand_where_it_is(
    mount: tuple[float, float, float],
    offset: tuple[float, float, float],
    heading: float,
    goal: tuple[float, float, float],
) -> None:
    own = Rotation.from_euler("xyz", mount, degrees=True)
    facing = Rotation.from_euler("z", heading, degrees=True)
    before = seen(np.array(offset), np.zeros(3), Rotation.identity(), own)
    after = seen(np.array(goal) + facing.apply(offset), np.array(goal), facing, own)
    assert after == pytest.approx(before, abs=1e-6)
    assert np.linalg.norm(before) == pytest.approx(np.linalg.norm(offset), abs=1e-6)
    assert before[2] == pytest.approx(offset[2], abs=1e-6)


@given(MOUNTS, PLACES, st.floats(-80.0, 80.0), st.floats(-180.0, 180.0))
def test_who_bends_over_has_not_moved_a_hand(
    mount: tuple[float, float, float],
    offset: tuple[float, float, float],
    lean: float,
    towards: float,
) -> None:
    own = Rotation.from_euler("xyz", mount, degrees=True)
    axis = np.array([np.cos(np.radians(towards)), np.sin(np.radians(towards)), 0.0])
    bent = Rotation.from_rotvec(np.radians(lean) * axis)
    upright = seen(np.array(offset), np.zeros(3), Rotation.identity(), own)
    assert seen(np.array(offset), np.zeros(3), bent, own) == pytest.approx(upright, abs=1e-6)


def test_where_the_trunk_is_lost_nothing_is_told() -> None:
    ways = np.zeros((len(TRUNK_TIMES), 3))
    ways[5] = np.nan
    hand = trunk_body(np.ones(3), Rotation.identity())
    orientations = np.tile([1.0, 0.0, 0.0, 0.0], (len(TRUNK_TIMES), 1))
    orientations[5] = np.nan
    stream = Stream(TRUNK_TIMES, ways, orientations)
    trunk = geometry_of(TagObject("trunk_body", TagType.MOBILE, stream, None), Thresholds())
    lost = np.isnan(from_trunk(hand, trunk, np.array([0.0, 0.0, 1.0]))).any(axis=1)
    assert (lost == trunk.poses.smooth.lost).all()
