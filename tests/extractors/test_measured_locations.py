"""Constraint locations and styles obey their laws."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import eased, pick_and_place

from capar.model.capture import Capture
from capar.model.locations import ConstraintLocation
from capar.model.observation import Segment
from capar.model.par import FeatureSet
from extractors.measure import measure
from extractors.segments import STEPS, constraint_location, path_style, velocity_style
from extractors.thresholds import Thresholds

LIMITS = Thresholds()


def ending(frame: int) -> Segment:
    """A segment of the right hand that ends at a frame, of which nothing else matters here."""
    return Segment(
        ee="right_hand",
        index=0,
        first=0,
        last=frame,
        start_s=0.0,
        end_s=1.0,
        name="Touch",
        general=(),
        candidates=(),
        level="",
        objects=("thing",),
        possessed=False,
        features=FeatureSet("0", "1", "0", "hand", "0"),
        begins=(),
        ends=(),
        purpose="",
    )


def where(capture: Capture, *, dominant: str, goal: str, frame: int) -> ConstraintLocation:
    measured = measure(capture)
    return constraint_location(
        capture,
        measured.bodies,
        measured.attention,
        ending(frame),
        dominant=dominant,
        goal=goal,
    )


def test_a_grip_at_the_side_of_a_box_is_half_a_size_from_its_middle() -> None:
    found = where(pick_and_place(), dominant="", goal="thing", frame=200)
    assert found.ee_nlt is None
    assert found.goal_nlt is not None
    assert found.goal_nlt.position[0] == pytest.approx(-0.5, abs=0.01)
    assert found.goal_nlt.orientation == pytest.approx((1.0, 0.0, 0.0, 0.0), abs=1e-6)


def test_a_thing_put_down_is_located_on_itself_and_on_its_goal() -> None:
    found = where(pick_and_place(), dominant="thing", goal="table", frame=240)
    assert found.ee_nlt is not None
    assert found.goal_nlt is not None
    assert found.ee_nlt.position[2] == pytest.approx(-0.5, abs=0.01)
    assert found.goal_nlt.position[2] == pytest.approx(0.5, abs=0.03)


@given(st.floats(0.2, 3.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
@settings(max_examples=20)
def test_a_velocity_style_never_falls_and_does_not_depend_on_how_long_the_way_is(
    scale: float, y: float, z: float
) -> None:
    times = np.arange(101) / 100.0
    share = eased(times, 0.0, 1.0)
    way = np.outer(share, [scale, scale * y, scale * z])
    style = velocity_style(way, times, 0, 100, thresholds=LIMITS)
    assert len(style) == STEPS
    assert style[0] == 0.0
    assert style[-1] == 1.0
    assert all(np.diff(style) >= 0.0)
    assert style == pytest.approx(list(np.interp(np.linspace(0, 1, STEPS), times, share)), abs=1e-6)


def test_the_style_of_what_does_not_move_is_even() -> None:
    style = velocity_style(np.zeros((50, 3)), np.arange(50) / 100.0, 0, 49, thresholds=LIMITS)
    assert style == pytest.approx(list(np.linspace(0.0, 1.0, STEPS)))


def test_a_path_style_holds_the_places_strictly_inside_a_segment() -> None:
    times = np.arange(101) / 100.0
    way = np.outer(times, [1.0, 2.0, 3.0])
    points = path_style(way, times, np.array([0, 20, 45, 80, 100]), 20, 80)
    assert len(points) == 1
    assert points[0].time == pytest.approx(25 / 60)
    assert points[0].position == pytest.approx((0.45, 0.9, 1.35))
