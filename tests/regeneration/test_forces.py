"""Things that a hand sets going are set going by other bodies, as hard or as far."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from combinations import one_of
from virtual_bodies.striking import STRIKE_MPS, let_go, struck

from capar.model.capture import Capture, Sensor
from capar.pipelines.observation import observe
from capar.pipelines.round_trips import body, observed_source, round_trips
from capar.regeneration import Motion, PlanError, Quality, Source, regenerate
from capar.regeneration.forces import ForceKind, arm_mass
from capar.regeneration.scenes import raised, resized
from capar.regeneration.styles import own_style

pytestmark = pytest.mark.long


@cache
def _source(name: str = "strike") -> Source:
    return observed_source(struck() if name == "strike" else let_go(name))


@cache
def _done(agent: str, kind: ForceKind) -> tuple[Motion, Quality]:
    source = _source()
    style = replace(own_style(source), force=kind)
    return regenerate(source, body(agent, source), None, style)


def _alone(motion: Motion) -> np.ndarray:
    """The crate's places from the blow on, from where it was [m]."""
    (launch,) = motion.plan.source.releases
    spots = motion.plan.things[launch.thing].translation[launch.frame :]
    return np.asarray(spots - spots[0])


@pytest.mark.parametrize("seed", one_of([0, 1, 2]))
def test_restitution_and_damping_of_a_blow_come_back_from_noisy_captures(seed: int) -> None:
    (force,) = observe(struck(noise_m=0.0015, seed=seed)).forces
    assert force.struck
    assert force.restitution is not None
    assert force.damping_per_s is not None
    assert abs(force.restitution - 0.5) < 0.05
    np.testing.assert_allclose(force.damping_per_s, 3.0, atol=0.15)
    np.testing.assert_allclose(force.velocity_mps, [0.0, STRIKE_MPS, 0.0], atol=0.03)


@pytest.mark.parametrize("agent", one_of(["same", "woman", "child"]))
def test_a_blow_is_the_same_action_on_every_body(agent: str) -> None:
    (trip,) = round_trips(_source(), (agent,))
    assert trip.quality is not None
    assert trip.quality.passed, trip.quality.failed
    assert trip.same_par
    assert trip.same_contacts


def test_similar_force_sends_the_crate_as_far_as_the_arm_is_heavy() -> None:
    far = {}
    source = _source()
    for agent in ("same", "woman", "child"):
        motion, _ = _done(agent, ForceKind.SIMILAR)
        far[agent] = float(np.linalg.norm(_alone(motion)[-1]))
        assert (np.diff(np.linalg.norm(_alone(motion), axis=1)) > -1e-9).all()
    recorded = source.paths["crate"].translation
    np.testing.assert_allclose(far["same"], np.linalg.norm(recorded[-1] - recorded[0]), atol=0.02)
    masses = [arm_mass(body(agent, source), "right") for agent in ("same", "woman", "child")]
    assert masses == sorted(masses, reverse=True)
    assert far["same"] > far["woman"] > far["child"]


@pytest.mark.parametrize("agent", one_of(["woman", "child"]))
def test_the_same_motion_takes_a_faster_hand(agent: str) -> None:
    motion, found = _done(agent, ForceKind.SAME)
    assert found.passed, found.failed
    recorded = _source().paths["crate"].translation
    (launch,) = motion.plan.source.releases
    np.testing.assert_allclose(_alone(motion)[-1], recorded[-1] - recorded[launch.frame], atol=0.01)
    slower, _ = _done(agent, ForceKind.SIMILAR)

    def pace(made: Motion) -> float:
        palms = made.plan.human.sites(made.postures, ["right_palm"])["right_palm"][0]
        steps = np.diff(palms[launch.frame - 3 : launch.frame + 1], axis=0)
        return float(np.linalg.norm(steps, axis=1).max())

    assert pace(motion) > 1.05 * pace(slower)


def test_from_a_narrower_way_to_the_edge_the_crate_falls_and_stays_on_the_floor() -> None:
    source = _source()
    scene = resized(raised(source.scene, "table", 0.05), "crate", 0.8)
    table, crate = scene.thing("table"), scene.thing("crate")
    right = replace(table, place=(table.place[0], crate.place[1] - 0.45, table.place[2]))
    scene = replace(scene, things={**scene.things, "table": right})
    motion, _ = regenerate(source, source.human, scene)
    low = motion.plan.things["crate"].translation[-1][2] + crate.shape.bounds[0, 2]
    assert abs(low) < 0.01
    assert any("falls" in note for note in motion.plan.notes)


@pytest.mark.parametrize("action", ["slide", "carry"])
def test_a_push_and_a_toss_are_the_same_action_on_a_child(action: str) -> None:
    (trip,) = round_trips(_source(action), ("child",))
    assert trip.quality is not None
    assert trip.quality.passed, trip.quality.failed
    assert trip.same_par


def _with_a_foot(capture: Capture) -> Capture:
    """The same done by something that is called a foot."""
    sensors = [s for s in capture.sensors if s.name != "right_hand"]
    hand = capture.sensor("right_hand")
    foot = Sensor("right_foot", "foot", "right", "right_leg", hand.stream, hand.shape)
    return replace(capture, sensors=(*sensors, foot))


def test_a_kick_is_refused_since_feet_keep_their_place() -> None:
    with pytest.raises(PlanError, match=r"'right_foot' sets 'crate' going.*feet keep their place"):
        observed_source(_with_a_foot(struck()))
