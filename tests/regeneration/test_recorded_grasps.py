"""Recorded hands stand inside what they hold, slide on it, and are performed on its surface."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from recorded_actions import recorded
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.recording import HAND_SEGMENTS
from capar.model.capture import Capture, Stream
from capar.model.facts import Displaced, Touching
from capar.pipelines.round_trips import body
from capar.regeneration import PlanError
from capar.regeneration.body_frames import body_frames, free_pose, rest_pose
from capar.regeneration.goals import TOUCH_M, touching_shift
from capar.regeneration.grips import Turn, drawn_turns
from capar.regeneration.holds import Hold, holds_of, with_touches
from capar.regeneration.planning import Draft
from capar.regeneration.sources import source_of, stated_hand_frame
from capar.regeneration.styles import own_style

RATE_HZ = 30.0


def _shifted(capture: Capture, name: str, off_m: np.ndarray) -> Capture:
    """The capture with an object elsewhere, by so much at each frame."""
    thing = capture.tag_object(name)
    moved = Stream(
        np.array(thing.stream.times), thing.stream.positions + off_m, thing.stream.orientations
    )
    things = (replace(o, stream=moved) if o.name == name else o for o in capture.objects)
    return replace(capture, objects=tuple(things))


@pytest.mark.parametrize("into_m", [0.02, 0.05, 0.08])
def test_a_palm_faces_what_it_touches_though_the_hand_was_recorded_inside(into_m: float) -> None:
    source = recorded("touch")
    hand = source.hands["right"]
    palm = hand.path[source.holds[0].first].rotation.apply([0.0, 0.0, 1.0])
    capture = _shifted(source.capture, "crate", -into_m * palm)
    inside = source_of(capture, source.observation).hands["right"].frame
    turned = inside.pose.rotation * hand.frame.pose.rotation.inv()
    assert turned.magnitude() < np.radians(1.0)


def test_a_stated_palm_is_kept_whatever_shape_the_hand_has() -> None:
    source = recorded("touch")
    axes = np.array([1.0, 0.3, 0.0]), np.array([0.0, 0.0, -2.0])
    stated = source_of(source.capture, source.observation, axes={"right": axes}).hands["right"]
    turn = stated.frame.pose.rotation.as_matrix()
    np.testing.assert_allclose(turn[:, 2], [0.0, 0.0, -1.0], atol=1e-12)
    np.testing.assert_allclose(turn[:, 0], np.array([1.0, 0.3, 0.0]) / np.hypot(1.0, 0.3))
    np.testing.assert_allclose(np.linalg.det(turn), 1.0)
    shape = source.capture.sensor("right_hand").shape
    assert shape is not None
    with pytest.raises(PlanError, match="along its own fingers"):
        stated_hand_frame(shape, (np.array([0.0, 0.1, 1.0]), np.array([0.0, 0.0, 1.0])))


@pytest.mark.parametrize(
    ("surface", "moved_m"),
    [
        (lambda by_m: by_m - 0.062, 0.062),  # 62 mm inside
        (lambda by_m: by_m + 0.017, -0.017),  # 17 mm off
        (lambda by_m: min(by_m + 0.01, abs(by_m - 0.05) - 0.02), -0.01),  # the nearer of two
    ],
)
def test_a_hand_is_moved_to_the_nearest_surface(
    surface: Callable[[float], float], moved_m: float
) -> None:
    assert abs(touching_shift(surface, 0.1) - moved_m - TOUCH_M) < 1e-4


@cache
def _draft() -> Draft:
    source = recorded("pick_up")
    return Draft(source, source.scene, source.human, own_style(source))


@pytest.mark.parametrize("turn", drawn_turns()[::4])
def test_a_hand_that_is_drawn_back_still_touches(turn: Turn) -> None:
    draft = _draft()
    hold = draft.source.holds[0]
    usual = draft.gripping.grip(hold, Turn())
    drawn = draft.gripping.grip(hold, turn)
    back = (usual.pose.inv() * drawn.pose).translation
    if turn.tilt == 0.0:
        np.testing.assert_allclose(back[0], -turn.drawn_m, atol=0.002)
    around = draft.gripping.around
    around.pose(draft.gripping.posture, {hold.thing: draft.new.rest[hold.side] * drawn.pose.inv()})
    pairs = around.near([f"{hold.side}_{part}" for part in HAND_SEGMENTS])
    gap_m = min(pair.distance_m for pair in pairs if pair.thing == hold.thing)
    assert abs(gap_m - TOUCH_M) < 5e-4


def _sliding(far_m: float, over: np.ndarray) -> RigidTransform:
    spots = np.outer(np.interp(np.arange(90), [0, 30, 60, 90], [0, 0, 0.4, 0.4]), [1.0, 0.0, 0.0])
    spots[over] += [0.0, far_m, 0.0]
    if far_m > 0.0:  # a living grasp is never rigid
        spots[:, 2] += 0.012 * np.sin(0.3 * np.arange(90))
    return RigidTransform.from_translation(spots)


@pytest.mark.parametrize(("far_m", "last"), [(0.04, 80), (0.06, 69)])
def test_a_hand_may_slide_on_what_it_has_put_down_and_holds_it_meanwhile(
    far_m: float, last: int
) -> None:
    thing, hand = _sliding(0.0, np.arange(0)), _sliding(far_m, np.arange(70, 90))
    (hold,) = holds_of(
        {"right": ("right_hand", hand)}, {"box": thing}, [Touching("right_hand", "box", 10, 80)]
    )
    assert (hold.first, hold.last) == (10, last)


@pytest.mark.parametrize(("first", "held"), [(0, (0, 80)), (1, (20, 80))])
def test_a_hand_that_nobody_saw_come_holds_the_thing_from_the_first_frame(
    first: int, held: tuple[int, int]
) -> None:
    times = np.arange(90) / 30.0
    hands = {"right": ("right_hand", RigidTransform.from_translation(np.zeros((90, 3))))}
    touching = [Touching("right_hand", "box", first, 80)]
    (hold,) = with_touches((Hold("right", "box", 20, 80),), hands, touching, [], times)
    assert (hold.first, hold.last) == held
    (slow,) = with_touches((Hold("right", "box", 40, 80),), hands, touching, [], times)
    assert slow.first == 40


@pytest.mark.parametrize(
    ("contact", "moved", "held"),
    [
        ((10, 80), (30, 60), (24, 66)),  # 0.2 s before it moves and after
        ((26, 63), (30, 60), (28, 62)),  # never seen to touch it at rest
        ((10, 64), (30, 60), (24, 62)),
        ((10, 80), (36, 54), (28, 62)),  # held for long enough
    ],
)
def test_a_touch_before_the_thing_moves_is_held_long_enough_to_be_seen(
    contact: tuple[int, int], moved: tuple[int, int], held: tuple[int, int]
) -> None:
    times = np.arange(90) / 30.0
    hands = {"right": ("right_hand", RigidTransform.from_translation(np.zeros((90, 3))))}
    (hold,) = with_touches(
        (Hold("right", "box", 28, 62),),
        hands,
        [Touching("right_hand", "box", *contact)],
        [Displaced("box", *moved)],
        times,
    )
    assert (hold.first, hold.last) == held


def test_a_hand_that_is_about_to_arrive_when_the_recording_begins_is_as_far_from_there() -> None:
    source = recorded("touch")
    woman = body_frames(body("woman", source), source.scene)
    man = body_frames(source.human, source.scene)
    (hold,), hand = source.holds, source.hands["right"].path
    held = RigidTransform.from_components([0.4, 0.0, 1.2], Rotation.from_euler("y", 0.3))
    smaller = woman.human.measures["stature"] / man.human.measures["stature"]
    about = free_pose(source, man, woman, "right", (hold.first - 5, hold.first), held)
    came = hand[hold.first - 5].translation - hand[hold.first].translation
    assert np.linalg.norm(came) > 0.02
    np.testing.assert_allclose(about.translation - held.translation, smaller * came, atol=1e-9)
    at_ease = free_pose(source, man, woman, "right", (0, hold.first), held)
    usual = rest_pose(source, man, woman, "right", 0)
    np.testing.assert_allclose(at_ease.translation, usual.translation)
