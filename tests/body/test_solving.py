"""Steps of inverse kinematics get nearer to what is wanted, also where plain steps do not."""

import mink
import numpy as np
import pytest

from capar.body.anthropometry import measures_of
from capar.body.gaze import share_costs
from capar.body.human import Human
from capar.body.inverse_kinematics import Solver
from capar.body.performing import RELAXED
from capar.body.scripts import SIDES
from capar.model.capture import Agent

UPRIGHT_PALM = np.array([0.0, 0.5**0.5, 0.0, 0.5**0.5, 0.623, -0.16, 0.88])
"""``T_world_palm``, w x y z and [m]: a child's palm far before it, its fingers up."""


@pytest.fixture(scope="module")
def human() -> Human:
    """A child of 1.36 m."""
    return Human.of(measures_of(Agent("child", "child", {"stature": 1.36, "mass": 30.5})))


def asked(human: Human) -> tuple[mink.Configuration, list[mink.Task]]:
    """A child at ease whose feet stay and whose palm is asked far forward; the palm is first."""
    eased = {f"{s}_{n}": float(np.radians(a)) for n, a in RELAXED.items() for s in SIDES}
    configuration = mink.Configuration(human.model)
    configuration.update(human.posture(eased))
    palm = mink.FrameTask("right_palm", "site", 60.0, 8.0)
    feet = [mink.FrameTask(f"{s}_foot", "body", 60.0, 8.0) for s in SIDES]
    ease = mink.PostureTask(human.model, cost=share_costs(human, 0.05))
    balance = mink.ComTask(cost=[2.0, 2.0, 0.0])
    for task in (*feet, ease, balance):
        task.set_target_from_configuration(configuration)
    palm.set_target(mink.SE3(UPRIGHT_PALM))
    damping = mink.DampingTask(human.model, cost=0.05)
    return configuration, [palm, *feet, ease, balance, damping]


def missed_m(configuration: mink.Configuration, tasks: list[mink.Task]) -> float:
    """How far the palm is from where it is asked to be [m]."""
    return float(np.linalg.norm(tasks[0].compute_error(configuration)[:3]))


def test_no_step_leads_further_away_and_the_palm_gets_there(human: Human) -> None:
    configuration, tasks = asked(human)
    solver = Solver(human, tasks)
    errors = [solver.error(configuration)]
    while not solver.settled and len(errors) < 200:
        solver.step(configuration)
        errors.append(solver.error(configuration))
    assert solver.settled
    assert (np.diff(errors) <= 0.0).all()
    assert missed_m(configuration, tasks) < 0.002
    assert not human.outside(configuration.q[None], margin=1e-3).any()


def test_plain_steps_to_the_same_place_go_to_and_fro_beside_it(human: Human) -> None:
    configuration, tasks = asked(human)
    limits = Solver(human, tasks).limits
    missed = []
    for _ in range(100):
        velocity = mink.solve_ik(configuration, tasks, 1.0, "daqp", limits=limits)
        configuration.integrate_inplace(velocity, 1.0)
        missed.append(missed_m(configuration, tasks))
    assert min(missed[-20:]) > 0.010


def test_a_solver_that_has_settled_takes_long_steps_again_when_restarted(human: Human) -> None:
    configuration, tasks = asked(human)
    solver = Solver(human, tasks)
    while not solver.settled:
        solver.step(configuration)
    nearer = UPRIGHT_PALM - [0.0, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0]
    tasks[0].set_target(mink.SE3(nearer))
    solver.restart()
    assert not solver.settled
    while not solver.settled:
        solver.step(configuration)
    assert missed_m(configuration, tasks) < 0.002
