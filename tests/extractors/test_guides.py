"""A hinge or a rail is recovered from poses, and what moves by chance as on one has none."""

from collections.abc import Callable

import motions
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import shapes
from motions.doors import (
    case,
    drawer_box,
    open_and_close_door,
    open_and_close_drawer,
    open_and_close_lid,
)
from motions.paths import minimum_jerk
from motions.trials import Trial
from motions.uses import USES
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Shape, Stream, TagObject, TagType
from capar.pipelines.observation import observe
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.measure import measure
from extractors.motion.object_motion import Floor
from extractors.relations.guides import fit_hinge, fit_rail, guide_of, inside_share
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
FLOOR = Floor(LIMITS.motion_floor_m, LIMITS.motion_floor_rad)
TIMES = np.arange(300) / 100.0
PANEL = shapes.box(0.4, 0.6, 0.02)
UNIT = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda each: np.linalg.norm(each) > 0.1)
SPOT = st.tuples(*[st.floats(-1.0, 1.0)] * 3)
NOISE = st.sampled_from([0.0, 0.0005, 0.0015])
SEEDS = st.integers(0, 99)


def there_and_back() -> np.ndarray:
    """A share of the range at each frame: rest, go, rest, come back, rest."""
    return minimum_jerk((TIMES - 0.5) / 0.8) - minimum_jerk((TIMES - 1.7) / 0.8)


def body(
    places: np.ndarray, turns: Rotation, shape: Shape = PANEL, noise_m: float = 0.0, seed: int = 0
) -> BodyGeometry:
    """A mobile body at these places [m] in these turns, as a noisy tracker has it."""
    random = np.random.default_rng(seed)
    shaken = turns * Rotation.from_rotvec(5.0 * noise_m * random.standard_normal((len(TIMES), 3)))
    seen = places + noise_m * random.standard_normal((len(TIMES), 3))
    stream = Stream(TIMES, seen, geometry.continuous(geometry.quaternions(shaken)))
    return geometry_of(TagObject("thing", TagType.MOBILE, stream, shape), LIMITS)


def fixed(shape: Shape, place: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> BodyGeometry:
    """Something that stands fixed."""
    poses = Stream(TIMES, np.tile(place, (len(TIMES), 1)), np.tile([1.0, 0.0, 0.0, 0.0], (300, 1)))
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
    thing = body(np.array(point) + turns.apply(np.array(arm)), turns, PANEL, noise_m, seed)
    fit = fit_hinge(thing)
    assert fit is not None
    # Each frame's turn is off by 5 rad for each metre of noise, the axis by less.
    assert abs(fit.axis @ direction) >= np.cos(1e-4 + 10.0 * noise_m / span_rad)
    beside = np.cross(fit.point - np.array(point), direction)
    assert np.linalg.norm(beside) <= 1e-4 + 20.0 * noise_m / span_rad
    assert fit.span == pytest.approx(span_rad, abs=0.003 + 30.0 * noise_m)
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
    still = Rotation.from_rotvec(np.zeros((len(TIMES), 3)))
    fit = fit_rail(body(places, still, PANEL, noise_m, seed))
    assert fit is not None
    assert abs(fit.axis @ direction) >= np.cos(1e-6 + 2.0 * noise_m / span_m)
    assert fit.span == pytest.approx(span_m, abs=0.003 + 6.0 * noise_m)
    assert fit.residual_m <= 1e-3 + 4.0 * noise_m


def still() -> Rotation:
    return Rotation.from_rotvec(np.zeros((len(TIMES), 3)))


def along(way: tuple[float, float, float]) -> np.ndarray:
    return there_and_back()[:, None] * np.array(way)


CASE = fixed(case(front=True))
INSIDE = np.array([-0.01, 0.0, 0.023])
"""Where the drawer is closed in the case [m]."""


def test_a_drawer_is_guided_and_one_that_is_taken_out_is_not() -> None:
    drawn = guide_of(
        body(INSIDE + along((-0.2, 0, 0)), still(), drawer_box()), [CASE], FLOOR, LIMITS
    )
    assert drawn is not None
    assert (drawn.fit.kind, drawn.base) == ("rail", "fixed")
    assert drawn.opening.max() == pytest.approx(0.2, abs=1e-3)
    gone = body(INSIDE + along((-0.6, 0, 0)), still(), drawer_box())
    assert guide_of(gone, [CASE], FLOOR, LIMITS) is None
    raised = INSIDE + along((-0.2, 0, 0)) + np.where(TIMES > 2.7, 0.05, 0.0)[:, None] * [0, 0, 1]
    assert guide_of(body(raised, still(), drawer_box()), [CASE], FLOOR, LIMITS) is None


def test_what_is_pushed_into_a_wide_shelf_is_on_no_rail() -> None:
    book = shapes.box(0.25, 0.05, 0.2)
    pushed = body(np.array([0.0, 0.05, 0.025]) + along((-0.3, 0, 0)), still(), book)
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
        leaf = body(
            SHUT * np.array([1.0, side, 1.0]) + along((0, -side * way_m, 0)),
            still(),
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
    found = guide_of(body(beside, still(), LEAF), [CASE], FLOOR, LIMITS)
    assert found is not None
    assert np.median(found.opening[:40]) == pytest.approx(0.15, abs=0.002)
    assert np.median(found.opening[130:160]) < 0.001


def test_what_goes_straight_before_an_opening_is_no_door_if_it_can_lie_or_has_no_shut_end() -> None:
    whole = body(SHUT + along((0, -0.25, 0)), still(), LEAF)
    between = body(SHUT + np.array([0.0, -0.05, 0.0]) + along((0, -0.05, 0)), still(), LEAF)
    ajar = body(SHUT + along((0, -0.2, 0)), still(), LEAF)
    away = body(SHUT - np.array([0.05, 0.0, 0.0]) + along((0, -0.2, 0)), still(), LEAF)
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
        leaf = body(np.array([at, *SHUT[1:]]) + along((0, -0.2, 0)), still(), LEAF)
        assert inside_share(leaf, CASE, 0) == share
        assert (guide_of(leaf, [CASE], FLOOR, LIMITS) is None) == (share >= LIMITS.inside_share)


def test_what_slides_turns_or_tips_on_a_table_is_on_no_guide() -> None:
    table, plate = fixed(shapes.table(0.8, 1.6)), shapes.box(0.3, 0.3, 0.05)
    slid = body(along((0.3, 0.0, 0.0)), still(), plate)
    spun_by = Rotation.from_rotvec(1.2 * there_and_back()[:, None] * [0.0, 0.0, 1.0])
    spun = body(np.zeros((300, 3)), spun_by, plate)
    corner = np.array([0.15, 0.15, 0.0])
    about = body(corner + spun_by.apply(-corner), spun_by, plate)
    tip = Rotation.from_rotvec(0.8 * there_and_back()[:, None] * [0.0, 1.0, 0.0])
    edge = np.array([0.15, 0.0, 0.0])
    tipped = body(edge + tip.apply(-edge), tip, plate)
    lifted = body(along((0.0, 0.0, 0.3)), still(), plate)
    for each in (slid, spun, about, tipped, lifted):
        assert guide_of(each, [table], FLOOR, LIMITS) is None


@pytest.mark.parametrize("act", [*USES, motions.drink_from_mug], ids=lambda each: each.__name__)
def test_nothing_that_hands_use_has_a_guide(act: Callable[..., Trial]) -> None:
    assert not measure(act(motions.WOMAN).capture).guides


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
