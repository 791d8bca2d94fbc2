"""Several things in one hand: they go together, and a hand that is too small is told."""

import numpy as np
import pytest
from combinations import one_of
from recorded_actions import good_trip, recorded
from scipy.spatial.transform import RigidTransform

from capar.pipelines.round_trips import body
from capar.regeneration import PlanError, search
from capar.regeneration.holds import Hold, co_held_of
from capar.regeneration.scenes import moved, raised, resized_with
from capar.regeneration.search import reachable


def _way(*heights: float) -> RigidTransform:
    return RigidTransform.from_translation([[0.0, 0.0, height] for height in heights])


def test_two_things_in_one_palm_are_observed_as_held_by_one_hand() -> None:
    steps = [s for s in recorded("carry_two").observation.segments if s.ee == "right_hand"]
    both = {step.name for step in steps if set(step.objects) >= {"carton", "tin"}}
    assert {"Reach", "Lift", "Carry", "Lower", "Withdraw"} <= both
    (companion,) = recorded("carry_two").co_held
    assert (companion.hold.thing, companion.lead.thing) == ("tin", "carton")


@pytest.mark.parametrize("agent", one_of(["woman", "child"]))
def test_another_body_carries_both_and_neither_slides_in_its_hand(agent: str) -> None:
    source = recorded("carry_two")
    scene = resized_with(raised(source.scene, "table", -0.1), "carton", 1.2)
    trip = good_trip(source, agent, scene)
    assert trip.motion
    assert trip.quality
    things = trip.motion.plan.things
    seat = things["carton"].inv() * things["tin"]
    assert np.ptp(seat.translation, axis=0).max() < 1e-9
    assert things["tin"].translation[-1][1] > things["tin"].translation[0][1] + 0.15
    assert trip.quality.gate("in one hand: not to slide").value < 2.0
    assert {grip.hold.thing for grip in trip.motion.plan.grips} == {"carton", "tin"}


def test_a_hand_that_is_too_small_for_both_is_refused_with_what_would_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(search, "STEPS_M", ())
    monkeypatch.setattr(search, "HIGHER_M", (0.1,))
    source = recorded("carry_two")
    large = resized_with(source.scene, "carton", 3.0)
    with pytest.raises(PlanError, match=r"too small to hold 'tin' .* of 0.7 times the size would"):
        reachable(source, large, body("child", source))


def test_what_does_not_stand_together_is_not_taken_together() -> None:
    source = recorded("carry_two")
    tin = source.scene.thing("tin")
    x, y, z = tin.place
    apart = moved(source.scene, "tin", (x + 0.05, y, z), tin.heading)
    with pytest.raises(PlanError, match="stands 58 mm from 'carton'"):
        reachable(source, apart, body("man", source))
    inside = moved(source.scene, "tin", (x - 0.02, y, z), tin.heading)
    with pytest.raises(PlanError, match="12 mm inside 'carton'"):
        reachable(source, inside, body("man", source))


def test_a_hand_that_moves_one_of_two_alone_is_refused() -> None:
    holds = Hold("right", "cup", 0, 5), Hold("right", "spoon", 2, 5)
    paths = {"cup": _way(0.0, 0.1, 0.1, 0.2, 0.3, 0.3), "spoon": _way(0.1, 0.1, 0.1, 0.2, 0.3, 0.3)}
    with pytest.raises(PlanError, match="'cup' by 100 mm without the other"):
        co_held_of(holds, paths)
