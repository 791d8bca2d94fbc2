"""Heads, feet and hands of a fitted body are touched as if the capture had stated them."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from virtual_bodies.drinking import steps_of

from capar.body.body_fitting import with_body_parts
from capar.body.recording import record
from capar.body.scripted_actions import performed
from capar.body.sensor_fitting import Fit, fit_capture
from capar.body.sensors import PERFECT
from capar.model.capture import Capture, TagType
from capar.pipelines.observation import observe

WORN = ("right_hand", "left_hand", "head", "neck", "l5", "right_elbow", "left_elbow",
        "right_knee", "left_knee")  # fmt: skip


@cache
def stated() -> Capture:
    """Somebody who sips, with the shapes that a careful recording states."""
    return record(performed("sip"), name="sip", seed=3, tracker=PERFECT, sensors=WORN)


@cache
def bare() -> tuple[Capture, Fit]:
    """Somebody who sips, recorded without shapes of hands and head and without SELF objects."""
    capture = stated()
    sensors = tuple(replace(each, shape=None) for each in capture.sensors)
    objects = tuple(each for each in capture.objects if each.tag is not TagType.SELF)
    stripped = replace(capture, sensors=sensors, objects=objects)
    return stripped, fit_capture(stripped)


def test_a_sip_at_the_fitted_head_is_told_like_one_at_the_stated_head() -> None:
    capture, made = bare()
    found = with_body_parts(capture, made)
    assert steps_of(observe(found)) == steps_of(observe(stated()))


def test_parts_of_which_nothing_is_recorded_are_not_added() -> None:
    capture, made = bare()
    found = with_body_parts(capture, made)
    own = [each for each in found.objects if each.tag is TagType.SELF]
    assert [each.name for each in own] == ["head"]
    assert {each.name for each in found.sensors if each.shape is not None} == {
        "right_hand",
        "left_hand",
    }


def test_feet_that_are_followed_are_added_where_the_body_has_them() -> None:
    capture, made = bare()
    seen = replace(made, segments={**made.segments, "heel": "right_foot"})
    found = with_body_parts(capture, seen)
    (foot,) = [each for each in found.objects if each.name == "right_foot"]
    place = made.human.sites(made.motion, ["right_foot"])["right_foot"][0]
    np.testing.assert_allclose(foot.stream.positions, place)
    assert foot.shape is not None
    assert foot.shape.size[0] == pytest.approx(made.human.measures["foot_length"], rel=0.1)
    assert "left_foot" not in {each.name for each in found.objects}


def test_what_a_capture_states_stays_as_it_is() -> None:
    capture = stated()
    _, made = bare()
    found = with_body_parts(capture, made)
    assert found.sensors == capture.sensors
    assert found.objects == capture.objects
