"""A motion may be drawn to the postures that reach the key frames of its holds."""

import numpy as np
import pytest

from capar.body.human import ROOT_SIZE
from capar.body.scripted_actions import action_capture
from capar.pipelines.round_trips import body, observed_source
from capar.regeneration.motion import FADE_S, guide_of
from capar.regeneration.planning import reachable
from capar.regeneration.solving import Solver

pytestmark = pytest.mark.long


def test_a_guide_is_a_key_posture_at_its_frame_and_fades_beside_the_hold() -> None:
    source = observed_source(action_capture("touch", rate_hz=30.0))
    draft = reachable(source, source.scene, body("woman", source))
    guide, (keys, rest) = guide_of(draft), draft.key_postures()
    (hold,) = source.holds
    for frame, posture in keys.items():
        np.testing.assert_allclose(guide.postures[frame], posture, atol=1e-9)
        assert guide.weights[frame] == pytest.approx(1.0)
    before = source.times < source.times[hold.first] - FADE_S
    assert before.any()
    np.testing.assert_allclose(guide.weights[before], 0.0)
    np.testing.assert_allclose(guide.postures[0], rest, atol=1e-9)


def test_the_same_goal_is_reached_in_a_posture_nearer_to_the_one_that_draws_it() -> None:
    source = observed_source(action_capture("touch", rate_hz=30.0))
    draft = reachable(source, source.scene, source.human)
    keys, rest = draft.key_postures()
    (hold,) = source.holds
    drawn = rest.copy()
    drawn[source.human.index("right_elbow_flexion")] += 0.6
    targets, far = draft.targets(list(draft.grips), hold.first), []
    for weight in (0.0, 1.0):
        solver = Solver(source.human, (*source.scene.place, 0.0), source.scene.heading)
        solver.draw_to(drawn, weight)
        solver.follow(targets, most=40)
        metres, _ = solver.missed(targets)
        assert metres < 0.001
        far.append(float(np.linalg.norm((solver.posture - drawn)[ROOT_SIZE:])))
    assert far[1] < far[0]
    assert hold.first in keys
