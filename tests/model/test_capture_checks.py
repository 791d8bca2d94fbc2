"""A capture proves itself once, and says what is wrong with it."""

from typing import Any

import numpy as np
import pytest

from capar.model.capture import (
    Capture,
    PivotContact,
    Role,
    Sensor,
    Shape,
    Stream,
    TagObject,
    TagType,
)
from capar.model.errors import CaptureError, UnknownNameError

TURN = np.array([[1.0, 0.0, 0.0, 0.0]])


def stream(frames: int = 5, *, step_s: float = 0.01, **changes: Any) -> Stream:
    parts = {
        "times": np.arange(frames) * step_s,
        "positions": np.zeros((frames, 3)),
        "orientations": np.repeat(TURN, frames, axis=0),
    }
    return Stream(**{**parts, **changes})


def sensor(name: str = "right_hand", **changes: Any) -> Sensor:
    parts = {"end_effector": "hand", "side": "right", "link": "right_arm", "stream": stream()}
    return Sensor(name, **{**parts, **changes})


def mug(name: str = "mug", **changes: Any) -> TagObject:
    return TagObject(name, TagType.MOBILE, **{"stream": stream(), **changes})


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"times": np.array([0.0, 0.01, 0.01, 0.02, 0.03])}, "time goes from 0.01 s to 0.01 s at"),
        ({"times": np.array([0.0, 0.02, 0.01, 0.03, 0.04])}, "must increase"),
        ({"times": np.array([0.0, np.nan, 0.02, 0.03, 0.04])}, "time stamp 1 is no number"),
        ({"positions": np.zeros((4, 3))}, "5 times, but positions"),
        ({"orientations": np.zeros((5, 4))}, "norm 0"),
        ({"orientations": np.full((5, 4), 1.0)}, "norm 2"),
        ({"positions": np.full((5, 3), np.inf)}, "infinite"),
    ],
)
def test_a_stream_that_no_body_made_is_refused(changes: dict[str, Any], says: str) -> None:
    with pytest.raises(CaptureError, match=says):
        stream(**changes)


def test_one_frame_is_no_motion() -> None:
    with pytest.raises(CaptureError, match="at least two"):
        stream(frames=1)


def test_a_frame_without_position_or_orientation_is_lost_whole() -> None:
    positions, turns = np.zeros((5, 3)), np.repeat(TURN, 5, axis=0)
    positions[1, 2] = np.nan
    turns[3, 0] = np.nan
    out = stream(positions=positions, orientations=turns)
    assert out.lost.tolist() == [False, True, False, True, False]
    assert np.isnan(out.orientations[1]).all()
    assert np.isnan(out.positions[3]).all()


def test_what_a_stream_holds_cannot_be_changed_and_is_its_own() -> None:
    positions = np.zeros((5, 3))
    out = stream(positions=positions)
    positions[0] = 7.0
    assert (out.positions == 0.0).all()
    with pytest.raises(ValueError, match="read-only"):
        out.positions[0] = 1.0


@pytest.mark.parametrize("name", ["Right", "1hand", "right hand", "", "händ", "right-hand", "a.b"])
def test_a_name_that_the_rules_could_not_hold_is_refused(name: str) -> None:
    with pytest.raises(CaptureError, match="names begin with a lower-case letter"):
        Capture("trial", (sensor(name),), ())
    with pytest.raises(CaptureError, match="names begin"):
        Capture("trial", (sensor(),), (mug(name),))


def test_two_of_one_name_are_refused() -> None:
    with pytest.raises(CaptureError, match="two objects are called 'mug'"):
        Capture("trial", (sensor(),), (mug(), mug()))


def test_a_capture_without_sensors_is_refused() -> None:
    with pytest.raises(CaptureError, match="no tracking sensor"):
        Capture("trial", (), (mug(),))


def test_every_stream_is_on_one_clock() -> None:
    with pytest.raises(CaptureError, match="'mug' is on another clock than 'right_hand'"):
        Capture("trial", (sensor(),), (mug(stream=stream(step_s=0.02)),))


def test_a_pivot_contact_names_bodies_that_exist() -> None:
    with pytest.raises(UnknownNameError) as raised:
        Capture(
            "trial", (sensor(),), (mug(),), pivot_contacts=(PivotContact("rihgt_hand", "mug", 0.1),)
        )
    assert raised.value.known == ["mug", "right_hand"]
    assert "Did you mean 'right_hand'?" in str(raised.value)


def test_an_unknown_sensor_is_answered_with_those_that_exist() -> None:
    capture = Capture("trial", (sensor(), sensor("head", role=Role.ATTENDS)), (mug(),))
    assert capture.sensor("head").role is Role.ATTENDS
    assert [each.name for each in capture.acting] == ["right_hand"]
    assert [each.name for each in capture.attending] == ["head"]
    with pytest.raises(UnknownNameError, match="there are: head, right_hand"):
        capture.sensor("left_hand")
    with pytest.raises(UnknownNameError, match="there are: mug"):
        capture.tag_object("cup")


def test_the_rate_is_that_of_the_median_step() -> None:
    times = np.array([0.0, 0.01, 0.02, 0.5, 0.51])
    capture = Capture("trial", (sensor(stream=stream(times=times)),), ())
    assert capture.rate_hz == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        (np.zeros((0, 3)), np.zeros((0, 3), dtype=int)),
        (np.zeros((3, 3)), np.zeros((0, 3), dtype=int)),
        (np.zeros((3, 3)), np.array([[0, 1, 3]])),
        (np.full((3, 3), np.nan), np.array([[0, 1, 2]])),
    ],
)
def test_a_shape_that_is_none_is_refused(vertices: np.ndarray, faces: np.ndarray) -> None:
    with pytest.raises(CaptureError, match="shape"):
        Shape(vertices, faces)


def test_a_shape_has_the_size_of_its_box() -> None:
    corners = np.array([[0.0, 0.0, 0.0], [0.2, 0.0, 0.1], [0.0, 0.3, 0.0]])
    assert Shape(corners, np.array([[0, 1, 2]])).size == pytest.approx([0.2, 0.3, 0.1])


def test_the_streams_of_a_capture_keep_one_clock_in_memory() -> None:
    bodies = Capture("trial", (sensor(),), (mug(),))
    assert all(each.stream.times is bodies.times for each in (*bodies.sensors, *bodies.objects))
