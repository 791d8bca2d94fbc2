"""Bodies that reach far keep their centre of mass above their feet."""

import mink
import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from capar.body.anthropometry import ready_made
from capar.body.gaze import share_costs
from capar.body.human import Human
from capar.body.inverse_kinematics import (
    MARGIN_M,
    BalanceLimit,
    BalanceTask,
    Solver,
    Support,
    sole,
    standing_support,
    support,
)
from capar.body.performing import perform
from capar.body.scenes import Thing, cup, scene, table
from capar.body.scripts import slide

SLACK_M = 0.002
"""What the steps of inverse kinematics may go beyond a margin, as they are straight [m]."""


@pytest.fixture(scope="module", params=("man", "woman", "child"))
def human(request: pytest.FixtureRequest) -> Human:
    return Human.of(ready_made(request.param))


def square(half_m: float) -> Support:
    """A base of support from -half to half in x and in y."""
    normals = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    return Support(normals, np.full(4, half_m), np.zeros(2))


def test_how_far_a_place_is_outside_is_measured_from_the_nearest_edge() -> None:
    places = np.array([[0.0, 0.0], [0.15, 0.0], [0.05, -0.13], [0.09, 0.02]])
    np.testing.assert_allclose(square(0.1).outside(places), [-0.1, 0.05, 0.03, -0.01])


def test_the_base_of_support_is_around_both_soles_and_what_is_between_them(human: Human) -> None:
    base = standing_support(human, human.posture())
    feet = human.sites(human.posture()[None], ("right_foot", "left_foot"))
    ankles = {name.removesuffix("_foot"): spots[0] for name, (spots, _) in feet.items()}
    for side, ankle in ankles.items():
        corners = (sole(human, side) + ankle)[:, :2]
        assert base.outside(corners).max() < 1e-6
    between = np.mean(list(ankles.values()), axis=0)[:2]
    assert base.outside(between) < -0.05
    length = human.measures["foot_length"]
    assert base.outside(between + np.array([length, 0.0])) > 0.0
    assert base.outside(between - np.array([0.5 * length, 0.0])) > 0.0
    one = support(human, {"left": RigidTransform.from_translation(ankles["left"])})
    assert one.outside(between) > 0.0


def leaning(human: Human, *, balanced: bool) -> tuple[mink.Configuration, float, float]:
    """Somebody drawn by the right palm to a place too far ahead to be reached without falling.

    Returns:
        The body, how far its weight is outside its feet, and how far the palm misses [m].
    """
    configuration = mink.Configuration(human.model)
    configuration.update(human.posture())
    base = standing_support(human, human.posture())
    palm = mink.FrameTask("right_palm", "site", 60.0, 0.0)
    start = configuration.get_transform_frame_to_world("right_palm", "site").translation()
    goal = start + np.array([0.62 * human.measures["stature"], 0.0, 0.0])
    palm.set_target(mink.SE3.from_translation(goal))
    feet = [mink.FrameTask(f"{side}_foot", "body", 60.0, 8.0) for side in ("right", "left")]
    ease = mink.PostureTask(human.model, cost=share_costs(human, 0.05))
    for foot in feet:
        foot.set_target_from_configuration(configuration)
    ease.set_target(human.posture())
    tasks = [palm, *feet, ease, mink.DampingTask(human.model, cost=0.05)]
    if balanced:
        solver = Solver(human, [*tasks, BalanceTask(base)], limits=[BalanceLimit(base)])
    else:
        solver = Solver(human, tasks)
    for _ in range(200):
        solver.step(configuration)
        if solver.settled:
            break
    outside = float(base.outside(configuration.data.subtree_com[1, :2]))
    spot = configuration.get_transform_frame_to_world("right_palm", "site").translation()
    return configuration, outside, float(np.linalg.norm(spot - goal))


def test_hips_stay_back_when_a_hand_is_drawn_far_ahead(human: Human) -> None:
    free, falls, _ = leaning(human, balanced=False)
    kept, stands, _ = leaning(human, balanced=True)
    assert falls > 0.0
    assert stands <= -MARGIN_M + SLACK_M
    assert kept.q[0] < free.q[0] - 0.03, "the pelvis is further back [m]"


def test_weight_that_is_beside_the_feet_is_drawn_back_above_them(human: Human) -> None:
    configuration = mink.Configuration(human.model)
    posture = human.posture()
    base = standing_support(human, posture)
    posture[0] += 0.3
    configuration.update(posture)
    edge, ease = BalanceTask(base), mink.PostureTask(human.model, cost=0.05)
    ease.set_target(posture)
    assert edge.compute_error(configuration)[0] > 0.05
    solver = Solver(human, [edge, ease], limits=[BalanceLimit(base)])
    for _ in range(40):
        solver.step(configuration)
    assert edge.compute_error(configuration)[0] < SLACK_M


@pytest.mark.long
@pytest.mark.parametrize("far", [0.25, 0.4, 0.5])
def test_a_performer_slides_a_far_mug_without_falling(far: float) -> None:
    human = Human.of(ready_made("child"))
    tall = human.measures["stature"]
    mug = Thing("mug", cup(0.035, 0.09), (far * tall, -0.1 * tall, 0.45 * tall), round=True)
    desk = table(0.45 * tall, near_m=0.13 * tall)
    made = perform(human, scene(desk, mug), slide("mug", (0.0, 0.1, 0.0)), rate_hz=20.0)
    base = standing_support(human, made.motion[0])
    places = np.array([human.centre_of_mass(posture)[:2] for posture in made.motion])
    assert base.outside(places).max() <= -MARGIN_M + SLACK_M
