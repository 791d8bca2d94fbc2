"""What rolls is told from what slides, spins and tips, by the point below its middle."""

import motions
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import PERFORMERS, Performer, shapes
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Shape, Stream, TagObject, TagType
from capar.model.facts import Rolls
from capar.pipelines.observation import observe
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.motion.phases import angular_velocity, rolling
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
TIMES = np.arange(400) / 100.0
BALL = shapes.shape(trimesh.creation.icosphere(subdivisions=3, radius=0.05), "ball")
"""Of a radius of 5 cm."""


def way(length_m: float) -> np.ndarray:
    """How far it has come at each frame: it goes evenly from the first to the third second."""
    return length_m * np.clip((TIMES - 1.0) / 2.0, 0.0, 1.0)


def body(places: np.ndarray, turns: Rotation, shape: Shape | None = BALL) -> BodyGeometry:
    """A body at these places [m] in these turns."""
    stream = Stream(TIMES, places, geometry.continuous(geometry.quaternions(turns)))
    thing = TagObject("thing", TagType.MOBILE, stream, shape)
    return geometry_of(thing, LIMITS)


def ball(length_m: float, share: float, *, heading: float = 0.0, spin: float = 0.0) -> BodyGeometry:
    """A ball that turns by that share of what rolling would be, and about the vertical beside."""
    gone = way(length_m)
    ahead = np.array([np.cos(heading), np.sin(heading), 0.0])
    axis = np.cross([0.0, 0.0, 1.0], ahead)
    about = np.array([0.0, 0.0, 1.0])
    turns = Rotation.from_rotvec(spin * gone[:, None] / 0.05 * about) * Rotation.from_rotvec(
        share * gone[:, None] / 0.05 * axis
    )
    return body(gone[:, None] * ahead + np.array([0.0, 0.0, 0.05]), turns)


@settings(deadline=None, max_examples=25)
@given(st.floats(0.15, 1.5), st.floats(0.8, 1.2), st.floats(0.0, 6.28))
def test_a_ball_that_hardly_slips_rolls_all_the_way(
    length_m: float, share: float, heading: float
) -> None:
    ((first, last),) = rolling(ball(length_m, share, heading=heading), LIMITS)
    # The filter of 8 Hz rounds both ends by less than a tenth of a second.
    assert (first, last) == pytest.approx((100, 300), abs=10)


@settings(deadline=None, max_examples=25)
@given(st.floats(0.15, 1.5), st.one_of(st.floats(-2.0, 0.5), st.floats(1.5, 4.0)))
def test_what_turns_too_little_too_much_or_backward_slips(length_m: float, share: float) -> None:
    assert rolling(ball(length_m, share), LIMITS) == ()


def test_what_spins_like_a_top_as_it_goes_does_not_roll() -> None:
    gone = way(0.5)[:, None]
    spun = Rotation.from_rotvec(gone / 0.05 * np.array([0.0, 0.0, 1.0]))
    assert rolling(body(gone * np.array([1.0, 0.0, 0.0]), spun), LIMITS) == ()


def test_a_turn_of_less_than_an_eighth_is_no_rolling() -> None:
    assert rolling(ball(0.08, 1.0), LIMITS)
    assert rolling(ball(0.032, 1.0), LIMITS) == ()


def test_a_box_that_is_tipped_over_its_edge_does_not_roll() -> None:
    cube = shapes.shape(trimesh.creation.box(extents=(0.1, 0.1, 0.1)), "cube")
    angle = way(np.pi / 2.0)[:, None]
    turns = Rotation.from_rotvec(angle * np.array([0.0, 1.0, 0.0]))
    edge = np.array([0.05, 0.0, 0.0])
    places = edge + turns.apply(np.array([-0.05, 0.0, 0.05]))
    assert rolling(body(places, turns, cube), LIMITS) == ()


def test_without_a_shape_nothing_is_known_to_roll() -> None:
    gone = way(0.5)[:, None]
    turns = Rotation.from_rotvec(gone / 0.05 * np.array([0.0, 1.0, 0.0]))
    assert rolling(body(gone * np.array([1.0, 0.0, 0.0]), turns, None), LIMITS) == ()


@given(st.tuples(*[st.floats(-3.0, 3.0)] * 3))
def test_the_angular_velocity_of_an_even_turn_is_that_turn_at_each_frame(
    rate: tuple[float, float, float],
) -> None:
    turns = Rotation.from_rotvec(TIMES[:, None] * np.array(rate))
    found = angular_velocity(geometry.quaternions(turns), TIMES)
    np.testing.assert_allclose(found, np.tile(rate, (len(TIMES), 1)), atol=1e-6)


@pytest.mark.parametrize("performer", PERFORMERS, ids=lambda each: each.name)
@pytest.mark.parametrize("noise_m", [0.0, 0.001])
def test_whoever_rolls_a_can_under_the_hand_rolls_it(performer: Performer, noise_m: float) -> None:
    trial = motions.roll_object(performer, noise_m=noise_m, noise_rad=5.0 * noise_m)
    seen = observe(trial.capture)
    assert [each.name for each in seen.segments] == ["Reach", "Roll"]
    assert seen.segments[1].general == ("MoveObj",)
    (rolls,) = [each for each in seen.facts if isinstance(each, Rolls)]
    assert rolls.last - rolls.first > 0.6 * (seen.segments[1].last - seen.segments[1].first)
    thesis = observe(trial.capture, rules="thesis")
    assert [each.name for each in thesis.segments] == ["Reach", "MoveObj"]
