"""Styles are as far apart as ways are, wherever they lead; and the nearest performer is found."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.scripted_actions import action_capture
from capar.pipelines.round_trips import body, observed_source
from capar.regeneration import PlanError, Source
from capar.regeneration.hand_paths import Care
from capar.regeneration.motions import perform_plan
from capar.regeneration.planning import led, reachable
from capar.regeneration.style_distances import (
    WayStyle,
    between_distance,
    nearest_between,
    nearest_performer,
    style_distance,
    style_metric,
    way_style,
    within_distance,
)
from capar.regeneration.style_kinds import Kind
from capar.regeneration.styles import Style


def _way(aside_m: float, up_m: float, skew: float) -> np.ndarray:
    """A reach with a bump to the left and upwards, covered sooner or later."""
    s = np.linspace(0.0, 1.0, 60) ** (1.0 + skew)
    bump = np.sin(np.pi * s)
    return np.stack([0.4 * s, aside_m * bump, 0.2 * s + up_m * bump], axis=1)


bumps, skews = st.floats(-0.15, 0.15), st.floats(-0.3, 0.6)


@settings(max_examples=30, deadline=None)
@given(a=bumps, b=bumps, c=skews, d=bumps, turn=st.floats(-3.0, 3.0), x=st.floats(-2.0, 2.0))
def test_a_style_is_the_same_wherever_the_way_leads(
    a: float, b: float, c: float, d: float, turn: float, x: float
) -> None:
    one, other = way_style(_way(a, b, c)), way_style(_way(d, b, c))
    away = np.array([x, -x, 0.3])
    elsewhere = Rotation.from_euler("z", turn).apply(_way(a, b, c)) + away
    assert style_distance(one, way_style(elsewhere)) < 1e-6
    assert style_distance(one, other) == style_distance(other, one)
    far = style_distance(one, way_style(_way(a + 0.05, b, c)))
    assert style_distance(one, one) == 0.0
    assert 0.4 < far < 1.0  # a bump of one unit, which is less on the way's average


def test_the_nearest_performer_is_the_one_whose_trials_are_like_it() -> None:
    trials = {
        "wide": [way_style(_way(0.10 + 0.01 * n, 0.0, 0.0)) for n in range(3)],
        "high": [way_style(_way(0.0, 0.10 + 0.01 * n, 0.0)) for n in range(3)],
        "late": [way_style(_way(0.0, 0.0, 0.5 + 0.05 * n)) for n in range(3)],
    }
    assert nearest_performer(way_style(_way(0.07, 0.01, 0.1)), trials) == "wide"
    assert nearest_performer(way_style(_way(0.0, 0.09, 0.1)), trials) == "high"
    assert nearest_performer(way_style(_way(0.01, 0.0, 0.4)), trials) == "late"
    assert within_distance(trials) < nearest_between(trials) <= between_distance(trials)


def test_what_performing_changes_counts_less() -> None:
    trials = {
        name: [way_style(_way(aside + off, up, 0.0)) for off in (-0.01, 0.01)]
        for name, (aside, up) in {"low": (0.0, 0.0), "high": (0.06, 0.12)}.items()
    }
    borrowed, lifted = way_style(_way(0.0, 0.0, 0.0)), way_style(_way(0.0, 0.1, 0.0))
    assert nearest_performer(lifted, trials) == "high"
    others = [  # of performers who are neither: performing lifts, and leaves the rest as it is
        (way_style(_way(aside, 0.0, 0.0)), way_style(_way(aside, up, 0.0)))
        for aside in (-0.03, 0.1)
        for up in (0.0, 0.05, 0.15)
    ]
    metric = style_metric(trials, others)
    assert metric.nearest_performer(lifted, trials) == "low"
    assert metric.nearest_performer(borrowed, trials) == "low"
    assert metric.distance(lifted, lifted) == 0.0
    plain = style_metric(trials, [])
    assert plain.distance(lifted, borrowed) > 3.0 * metric.distance(lifted, borrowed)


def test_what_does_not_move_has_no_style() -> None:
    with pytest.raises(PlanError, match="no style of its own"):
        way_style(0.01 * _way(0.0, 0.0, 0.0))


@cache
def _source() -> Source:
    return observed_source(action_capture("touch", rate_hz=20.0))


def _borrowed(aside_m: float, up_m: float) -> np.ndarray:
    """The recorded reach with a bump."""
    source = _source()
    reach = source.holds[0].first
    spots = source.hands["right"].path.translation[: reach + 1]
    bump = np.sin(np.pi * np.linspace(0.0, 1.0, reach + 1))
    return np.asarray(spots + np.outer(bump, [0.0, aside_m, up_m]))


def _performed(way: np.ndarray) -> WayStyle:
    """The style of a woman's motion that borrows a way."""
    source = _source()
    path = source.hands["right"].path
    spots = path.translation.copy()
    spots[: len(way)] = way
    hands = {side: hand.path for side, hand in source.hands.items()}
    hands["right"] = RigidTransform.from_components(spots, path.rotation)
    style = Style(Kind.PATH, hands, source.paths)
    motion = perform_plan(
        led(reachable(source, source.scene, body("woman", source), style), Care())
    )
    palm = motion.plan.human.sites(motion.postures, ["right_palm"])["right_palm"][0]
    return way_style(palm[: len(way)])


@pytest.mark.long
def test_whose_style_was_borrowed_shows_in_another_bodys_motion() -> None:
    trials = {
        name: [way_style(_borrowed(aside + spread, up + abs(spread))) for spread in (-0.01, 0.01)]
        for name, (aside, up) in {
            "near": (0.0, 0.0),
            "wide": (-0.1, 0.0),
            "high": (0.0, 0.1),
        }.items()
    }
    assert nearest_performer(_performed(_borrowed(-0.09, 0.01)), trials) == "wide"
    assert nearest_performer(_performed(_borrowed(0.01, 0.09)), trials) == "high"
