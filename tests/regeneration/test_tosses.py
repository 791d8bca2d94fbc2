"""What one hand throws and the other catches flies to other bodies' hands by gravity alone."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from combinations import one_of
from recorded_actions import recorded
from scipy.spatial.transform import RigidTransform

from capar.pipelines.round_trips import Trip, body, round_trips
from capar.regeneration import PlanError, search
from capar.regeneration.body_frames import body_frames
from capar.regeneration.forces import ForceKind, flight_faults
from capar.regeneration.goals import object_goals
from capar.regeneration.holds import releases_of
from capar.regeneration.quality import quality
from capar.regeneration.scenes import raised
from capar.regeneration.search import reachable
from extractors.forces.free_motion import GRAVITY_MPS2

RATE_HZ = 30.0


@cache
def _trip(agent: str) -> Trip:
    (trip,) = round_trips(recorded("toss"), (agent,))
    return trip


def test_a_recording_says_from_which_hand_to_which_it_flies() -> None:
    (toss,) = recorded("toss").throws
    assert (toss.thing, toss.side, toss.catcher) == ("mug", "right", "left")
    assert not recorded("toss").releases
    throwing, catching = recorded("toss").holds
    assert (throwing.last, catching.first) == (toss.first, toss.last)


@pytest.mark.parametrize("agent", one_of(["man", "woman", "child"]))
def test_other_bodies_throw_and_catch_it_with_every_gate_and_the_same_is_observed(
    agent: str,
) -> None:
    trip = _trip(agent)
    assert trip.passed, trip


def test_a_child_throws_less_far_in_proportion_or_as_far_with_the_same_motion() -> None:
    source, child = recorded("toss"), body("child", recorded("toss"))
    old, new = body_frames(source.human, source.scene), body_frames(child, source.scene)
    (toss,) = source.throws
    spots = source.paths["mug"].translation
    gone = spots[toss.last] - spots[toss.first]
    ways, ends = {}, {}
    for kind in ForceKind:
        goals = object_goals(source, source.scene, old, new, kind)["mug"]
        places = {goal.frame: goal.pose.translation for goal in goals}
        ways[kind] = places[toss.last] - places[toss.first]
        ends[kind] = places[goals[-1].frame] - places[toss.last]
    ratio = child.measures["stature"] / source.human.measures["stature"]
    np.testing.assert_allclose(ways[ForceKind.SIMILAR], gone * [ratio, ratio, 1.0], atol=1e-6)
    np.testing.assert_allclose(ways[ForceKind.SAME], gone, atol=1e-6)
    np.testing.assert_allclose(ends[ForceKind.SIMILAR], ends[ForceKind.SAME], atol=1e-6)


def test_a_hand_that_is_at_rest_does_not_throw() -> None:
    motion = _trip("man").motion
    assert motion is not None
    (toss,) = motion.plan.source.throws
    stiff = motion.postures.copy()
    stiff[toss.first - 6 : toss.first + 1] = stiff[toss.first]
    gate = quality(replace(motion, postures=stiff)).gate("flight speed")
    assert not gate.passed
    assert gate.value > 1.0


def test_what_floats_or_is_pushed_in_flight_fails_the_gates() -> None:
    times = np.arange(10) / RATE_HZ
    spots = np.outer(times, [0.0, 1.0, 2.0]) + np.outer(times**2, [0.0, 0.0, -0.5 * GRAVITY_MPS2])
    sound = flight_faults(times, spots)
    assert max(value for value, _ in sound) < 1e-9
    (off_m, _), _ = flight_faults(times, np.outer(times, [0.0, 1.0, 0.0]))
    assert off_m == pytest.approx(GRAVITY_MPS2 * times[-1] ** 2 / 8.0, rel=0.02)
    pushed = spots + np.outer(times**2, [0.0, 2.0, 0.0])
    assert flight_faults(times, pushed)[1][0] > 0.5


def test_what_does_not_fly_freely_to_a_hand_is_refused() -> None:
    source = recorded("toss")
    sides = {hand.sensor: side for side, hand in source.hands.items()}
    (toss,) = source.throws
    spots = source.paths["mug"].translation.copy()
    spots[toss.first : toss.last + 1] = np.linspace(
        spots[toss.first], spots[toss.last], toss.last - toss.first + 1
    )
    path = RigidTransform.from_components(spots, source.paths["mug"].rotation)
    forces, holds = source.observation.forces, source.holds
    with pytest.raises(PlanError, match="otherwise than in free flight"):
        releases_of(forces, sides, holds, source.times, {"mug": path})
    alone = tuple(hold for hold in holds if hold.side == "right")
    releases, throws = releases_of(forces, sides, alone, source.times, source.paths)
    assert [launch.thing for launch in releases] == ["mug"]
    assert throws == ()


def test_what_a_child_cannot_throw_is_refused_with_what_fails_and_what_would_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene, child = raised(recorded("toss").scene, "table", 0.5), body("child", recorded("toss"))
    monkeypatch.setattr(search, "STEPS_M", ())
    monkeypatch.setattr(search, "HIGHER_M", (0.1, -0.4))
    with pytest.raises(PlanError, match=r"cannot throw 'mug' .*misses by \d+ mm; .*lower would do"):
        reachable(recorded("toss"), scene, child)
