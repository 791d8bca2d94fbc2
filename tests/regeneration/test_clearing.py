"""Limbs are kept out of things while hands stay where they are wanted."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
import trimesh

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.virtual_scenes import Thing, box
from capar.model.capture import Shape, TagType
from capar.regeneration.collisions import CLEAR_M, NEAR_M, ClearTask, Surroundings
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver, Targets, vectors

STEP = 1e-6


def _ring(outer_m: float, inner_m: float) -> Shape:
    """A ring about z, 4 cm high."""
    made = trimesh.creation.annulus(inner_m, outer_m, 0.04, sections=32)
    return Shape(np.array(made.vertices), np.array(made.faces))


@pytest.mark.parametrize(
    ("shape", "place"),
    [(box(0.3, 0.3, 0.3), (0.2, 0.1, 0.9)), (_ring(0.30, 0.24), (0.05, -0.1, 1.0))],
)
def test_slopes_of_distances_are_those_of_small_steps(
    shape: Shape, place: tuple[float, float, float]
) -> None:
    human = Human.of(ready_made("man"))
    thing = Thing("thing", shape, place, 0.3, TagType.MOBILE)
    around = Surroundings(human, Scene({"thing": thing}, (0.0, 0.0), 0.0))
    posture, things = Solver(human, (0.0, 0.0, 0.0), 0.0).posture, {"thing": vectors(thing.pose)}

    def moved(dof: int, by: float, geom: int) -> float:
        there, step = posture.copy(), np.zeros(around.model.nv)
        step[dof] = by
        mujoco.mj_integratePos(around.model, there, step, 1.0)
        around.place(there, things)
        return around.gap(geom, "thing")

    off = []
    for geom, name in around.pairs:
        around.place(posture, things)
        if around.gap(geom, name) < 0.5 * NEAR_M:
            slope = around.slope(geom, name)
            pairs = [(moved(d, STEP, geom), moved(d, -STEP, geom)) for d in range(len(slope))]
            found = np.array([0.5 * (ahead - back) / STEP for ahead, back in pairs])
            off.append(float(np.abs(found - slope).max()))
    assert len(off) > 4
    # Where two points of a surface are equally near, a distance has no slope.
    assert np.median(off) < 1e-3
    assert np.mean(np.array(off) < 0.02) >= 0.7


def _targets(solver: Solver) -> Targets:
    palms = {side: vectors(solver.palm(side)) for side in ("right", "left")}
    head = vectors(solver.site("between_eyes"))
    return Targets(palms, dict.fromkeys(palms, 1.0), head, 0.0, np.array([3.0, 0.0, 1.5]))


def test_an_elbow_leaves_a_thing_and_the_palm_stays() -> None:
    human = Human.of(ready_made("woman"))
    scene = Scene({}, (0.0, 0.0), 0.0)
    solver = Solver(human, (0.0, 0.0, 0.0), 0.0)
    bent = solver.rest.copy()
    for name, angle in (("right_elbow_flexion", 1.4), ("right_shoulder_flexion", 0.3)):
        bent[human.index(name)] = angle
    solver.configuration.update(bent)
    targets = _targets(solver)
    solver.follow(targets, most=40)
    elbow = solver.configuration.data.body("right_forearm").xpos.copy()
    thing = Thing("box", box(0.06, 0.06, 0.06), (elbow[0], elbow[1] - 0.03, elbow[2] - 0.03))
    scene = replace(scene, things={"box": thing})
    around = Surroundings(human, scene)

    def depth(of: Solver) -> float:
        around.pose(of.posture, {"box": thing.pose})
        arm = ("right_forearm", "right_upper_arm")
        return min((pair.distance_m for pair in around.near(arm)), default=NEAR_M)

    assert depth(solver) < -0.005
    clear = ClearTask(Surroundings(human, scene))
    kept = Solver(human, (0.0, 0.0, 0.0), 0.0, (clear,))
    kept.configuration.update(solver.posture)
    kept.follow(targets, most=80)
    assert depth(kept) > CLEAR_M - 0.001
    metres, radians = kept.missed(targets)
    assert metres < 0.001
    assert radians < np.radians(1.0)


@pytest.mark.parametrize(("met", "pushed"), [((), True), (("mug",), False)])
def test_what_the_head_meets_does_not_push_it(met: tuple[str, ...], pushed: bool) -> None:
    human = Human.of(ready_made("woman"))
    solver = Solver(human, (0.0, 0.0, 0.0), 0.0)
    x, y, z = solver.site("mouth").translation
    thing = Thing("mug", box(0.05, 0.05, 0.05), (x + 0.03, y, z - 0.025))
    clear = ClearTask(Surroundings(human, Scene({"mug": thing}, (0.0, 0.0), 0.0)), met)
    assert bool(clear.compute_error(solver.configuration).min() < -0.005) == pushed


@pytest.mark.parametrize(("led", "pushed"), [(("right", "left"), False), (("right",), True)])
def test_a_hand_that_is_not_led_keeps_out_of_what_it_hangs_beside(
    led: tuple[str, ...], pushed: bool
) -> None:
    human = Human.of(ready_made("woman"))
    solver = Solver(human, (0.0, 0.0, 0.0), 0.0)
    x, y, z = solver.site("left_palm").translation
    thing = Thing("chest", box(0.3, 0.3, 0.3), (x, y + 0.18, z - 0.3))
    clear = ClearTask(Surroundings(human, Scene({"chest": thing}, (0.0, 0.0), 0.0)), (), led)
    assert bool(clear.compute_error(solver.configuration).min() < -0.002) == pushed
