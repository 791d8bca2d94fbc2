"""Motions and contacts begin and end where they truly do: after nudges, losses and approaches."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from capar.model.capture import Stream, TagObject, TagType
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.contact.blows import settled_ends
from extractors.motion.motion_edges import motion_edges, seat
from extractors.motion.object_motion import Floor, moving, rest_poses
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
RATE_HZ = 100.0
TIMES = np.arange(500) / RATE_HZ
FLOOR = Floor(LIMITS.motion_floor_m, LIMITS.motion_floor_rad)
UP = np.array([0.0, 0.0, 1.0])


def smooth_step(begin_s: float, end_s: float) -> np.ndarray:
    """From 0 to 1 between two times, with the least jerk."""
    share = np.clip((TIMES - begin_s) / (end_s - begin_s), 0.0, 1.0)
    return np.asarray(share**3 * (10.0 - 15.0 * share + 6.0 * share**2))


def geometry(positions: np.ndarray) -> BodyGeometry:
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(TIMES), 1))
    turns[np.isnan(positions).any(axis=1)] = np.nan
    stream = Stream(TIMES, positions, turns)
    return geometry_of(TagObject("thing", TagType.MOBILE, stream, None), LIMITS)


def edges(positions: np.ndarray) -> tuple[float, float]:
    """When the one motion of a thing begins and ends [s]."""
    poses = geometry(positions).poses
    rests = rest_poses(poses, FLOOR, LIMITS)
    (moved,) = moving(poses, rests, FLOOR, LIMITS)
    first, last = motion_edges(poses, moved, rests, FLOOR, LIMITS)
    return float(TIMES[first]), float(TIMES[last])


@given(st.floats(1.5, 8.0), st.floats(0.25, 0.5), st.floats(0.4, 1.5))
def test_what_was_nudged_sets_off_from_where_it_stood_last(
    nudge_mm: float, before_s: float, lasts_s: float
) -> None:
    nudge = nudge_mm / 1000.0 * smooth_step(2.0 - before_s, 2.05 - before_s)
    way = nudge + 0.3 * smooth_step(2.0, 2.0 + lasts_s)
    begin, end = edges(way[:, None] * np.array([1.0, 0.0, 0.0]))
    assert begin == pytest.approx(2.0, abs=0.05)
    assert end == pytest.approx(2.0 + lasts_s, abs=0.05)


@given(st.floats(1.5, 8.0), st.floats(0.25, 0.5))
def test_what_is_nudged_after_it_was_put_down_has_settled_before(
    nudge_mm: float, after_s: float
) -> None:
    nudge = nudge_mm / 1000.0 * smooth_step(3.0 + after_s, 3.05 + after_s)
    way = nudge + 0.3 * smooth_step(2.0, 3.0)
    _, end = edges(way[:, None] * np.array([1.0, 0.0, 0.0]))
    assert end == pytest.approx(3.0, abs=0.05)


@given(st.floats(0.5, 2.0), st.floats(0.1, 0.4))
def test_a_smooth_beginning_is_no_nudge(lasts_s: float, way_m: float) -> None:
    way = way_m * smooth_step(1.5, 1.5 + lasts_s)
    begin, end = edges(way[:, None] * np.array([0.0, 1.0, 0.0]))
    assert begin == pytest.approx(1.5, abs=0.1)
    assert end == pytest.approx(1.5 + lasts_s, abs=0.1)


@given(st.integers(20, 150), st.integers(1, 30))
def test_a_loss_earlier_in_a_contact_moves_no_lift_off(lost: int, frames: int) -> None:
    places = 0.3 * smooth_step(2.0, 3.0)[:, None] * UP
    base, thing = geometry(np.zeros_like(places) - 0.1 * UP), geometry(places)
    contact = 0, int(np.flatnonzero(places[:, 2] > 0.015)[0])
    whole = seat(thing, base, contact, [(200, 300)], LIMITS)
    assert TIMES[whole[1]] == pytest.approx(2.0, abs=0.05)
    places[lost : lost + frames] = np.nan
    assert seat(geometry(places), base, contact, [(200, 300)], LIMITS)[1] == whole[1]


@given(st.floats(0.05, 0.3), st.floats(0.0, 0.5), st.floats(0.2, 1.2), st.floats(-0.004, 0.004))
def test_what_rises_as_soon_as_it_has_come_down_is_down_in_an_instant_of_its_contact(
    depth_m: float, stays_s: float, lasts_s: float, sags_m: float
) -> None:
    down, up = 2.0 + stays_s, 2.0 - lasts_s
    height = depth_m * (1.0 - smooth_step(up, 2.0) + smooth_step(down, down + lasts_s))
    height += sags_m * np.sin(np.pi * np.clip((TIMES - up) / (down + lasts_s - up), 0.0, 1.0))
    inside = np.flatnonzero(height <= height.min() + 0.012)
    contact = int(inside[0]), int(inside[-1])
    base, thing = geometry(np.tile(-0.1 * UP, (len(TIMES), 1))), geometry(height[:, None] * UP)
    first, last = seat(thing, base, contact, [(0, 499)], LIMITS)
    assert contact[0] <= first <= last <= contact[1]


@given(st.floats(0.6, 1.2), st.floats(0.6, 1.2), st.floats(0.0, 0.01))
def test_a_hand_has_arrived_when_the_distance_no_longer_shrinks(
    comes_s: float, goes_s: float, near_m: float
) -> None:
    apart = near_m + 0.25 * (1.0 - smooth_step(0.5, 0.5 + comes_s) + smooth_step(3.0, 3.0 + goes_s))
    inside = np.flatnonzero(apart <= near_m + LIMITS.touch_margin_m)
    contact = int(inside[0]), int(inside[-1])
    first, last = settled_ends(apart, contact, TIMES, LIMITS)
    arrives, leaves = 0.5 + comes_s, 3.0
    assert abs(TIMES[first] - arrives) <= abs(TIMES[contact[0]] - arrives)
    assert abs(TIMES[last] - leaves) <= abs(TIMES[contact[1]] - leaves)
    assert contact[0] <= first < last <= contact[1]
    assert (apart[[first, last]] <= near_m + LIMITS.edge_m + 1e-9).all()


def test_two_that_never_settle_touch_as_long_as_they_are_near() -> None:
    apart = 0.3 * np.abs(TIMES - 2.5)
    contact = 245, 255
    assert settled_ends(apart, contact, TIMES, LIMITS) == contact


def test_where_a_hand_was_lost_nothing_arrives_later() -> None:
    apart = np.where(TIMES < 1.0, np.nan, 0.01)
    assert settled_ends(apart, (100, 499), TIMES, LIMITS) == (100, 499)
