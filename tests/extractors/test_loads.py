"""What rides in or on a moving thing is told from what merely touches it or stays behind."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import ball, box, eased, shape, still, stream

from capar.model.capture import Shape, TagObject, TagType
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.relations.support import rides
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
FRAMES = 200
MOTION = (50, 150)
TIMES = np.arange(FRAMES) / 100.0
SHARE = eased(TIMES, 0.5, 1.5)


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


@pytest.mark.parametrize("touching", [(0, 40), (160, 199)])
def test_nothing_rides_while_its_bearer_stands(touching: tuple[int, int]) -> None:
    load = geometry_of(
        TagObject("cup", TagType.MOBILE, still((0.0, 0.0, 0.051), FRAMES), box(0.06, 0.06, 0.08)),
        LIMITS,
    )
    assert not rides(load, tray((0.3, 0.0, 0.0)), touching, [MOTION], LIMITS)


@pytest.mark.parametrize("touching", [(0, MOTION[0]), (MOTION[1], FRAMES - 1)])
def test_what_lies_in_a_carton_only_before_or_after_its_motion_rides_not(
    touching: tuple[int, int],
) -> None:
    way = np.outer(SHARE, [0.3, 0.0, 0.2]) + np.array([0.0, 0.0, 0.045])
    load = thing("ball", ball(0.04), way)
    assert rides(load, carton(), (0, FRAMES - 1), [MOTION], LIMITS)
    assert not rides(load, carton(), touching, [MOTION], LIMITS)
