"""A whole person: feet stand, step, walk and kick; hands meet; parts make one hand or foot."""

from collections.abc import Callable
from dataclasses import replace

import motions
import numpy as np
import pytest
from combinations import meeting
from motions.trials import Options
from motions.whole import WHOLE, pinch, walk
from test_uses import RECORDED

from capar.model.capture import Capture, Sensor, Stream, TagObject, TagType
from capar.model.errors import CaptureError, UnknownNameError
from capar.model.facts import Touching
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from extractors.contact.contacts import with_meeting_hands
from extractors.measure import measure
from extractors.readers.bundle.capture_toml import grouped

Act = Callable[..., motions.Trial]
PEOPLE = pytest.mark.parametrize("performer", motions.PERFORMERS, ids=lambda each: each.name)


def names_of(seen: Observation) -> dict[str, tuple[str, ...]]:
    """The steps of each end-effector but its rests."""
    return {
        each.ee: tuple(one.name for one in each.segments if one.name != "Rest")
        for each in seen.links
    }


@pytest.mark.parametrize(
    ("act", "performer", "options"), meeting(WHOLE, motions.PERFORMERS, RECORDED)
)
def test_the_steps_are_those_that_were_performed(
    act: Act, performer: motions.Performer, options: dict[str, float]
) -> None:
    trial = act(performer, **options)
    assert names_of(observe(trial.capture)) == trial.truth.steps["extended"]


@PEOPLE
def test_a_walk_is_one_action_of_both_feet_from_its_first_step_to_its_last(
    performer: motions.Performer,
) -> None:
    seen = observe(walk(performer).capture)
    (joint,) = seen.joint
    steps = [each for each in seen.segments if each.name == "Walk"]
    assert (joint.name, joint.objects, joint.who) == (
        "Walk", ("floor",), ("left_foot", "right_foot"),
    )  # fmt: skip
    assert seen.who(joint) == "both feet"
    assert sorted(zip(joint.ees, joint.segments, strict=True)) == sorted(
        (each.ee, each.index) for each in steps
    )
    assert joint.start_s == min(each.start_s for each in steps)
    assert joint.end_s == max(each.end_s for each in steps)
    assert "Step" in steps[0].general


def test_feet_that_are_lifted_and_set_down_where_they_were_do_not_walk() -> None:
    seen = observe(walk(motions.WOMAN, length=0.0).capture)
    assert not seen.joint
    assert not any("Walk" in (each.name, *each.general) for each in seen.segments)


@PEOPLE
def test_heel_and_toes_are_one_foot_from_heel_strike_to_toe_off(
    performer: motions.Performer,
) -> None:
    apart = walk(performer, parts=True)
    together = grouped(apart.capture)
    seen = observe(together)
    assert names_of(seen) == apart.truth.steps["extended"]
    parts = _touching(apart.capture)
    whole = _touching(together)
    for side in ("right", "left"):
        heel, toe, foot = (
            [each for each in group if each.body == f"{side}_{name}"]
            for group, name in ((parts, "heel"), (parts, "toe"), (whole, "foot"))
        )
        assert [each.first for each in foot] == [each.first for each in heel]
        assert [each.last for each in foot] == [each.last for each in toe]
        assert heel != foot


def test_parts_that_are_not_grouped_are_told_each_by_itself() -> None:
    seen = observe(walk(motions.WOMAN, parts=True).capture)
    assert [each.ee for each in seen.links] == [
        "left_heel", "left_toe", "right_heel", "right_toe",
    ]  # fmt: skip


@pytest.mark.parametrize("options", RECORDED.values(), ids=RECORDED)
@PEOPLE
def test_a_hand_of_palm_and_fingers_does_what_the_same_hand_does_as_one_body(
    performer: motions.Performer, options: Options
) -> None:
    of_parts = observe(grouped(pinch(performer, fingers=True, **options).capture))
    in_one = observe(pinch(performer, fingers=False, **options).capture)
    assert names_of(of_parts) == names_of(in_one)
    for one, other in zip(of_parts.segments, in_one.segments, strict=True):
        assert one.objects == other.objects
        assert abs(one.start_s - other.start_s) <= 0.05


def test_fingers_that_touch_move_and_hold_a_thing_are_told_as_the_hand() -> None:
    seen = observe(grouped(pinch(motions.WOMAN, fingers=True).capture))
    assert names_of(seen) == {"right_hand": ("Reach", "Touch", "Lift", "Touch")}
    assert {each.code for each in seen.notices} == {"contact-tolerance", "sensors-grouped"}
    (told,) = [each for each in seen.notices if each.code == "sensors-grouped"]
    assert told["sensors"] == (
        "right_palm, right_thumb, right_index, right_middle, right_ring, right_pinky"
    )


def test_a_part_of_nobody_or_of_another_agent_is_refused() -> None:
    capture = walk(motions.WOMAN).capture
    first, second = capture.sensors

    guest = replace(capture.agent, name="guest")
    with pytest.raises(UnknownNameError, match="rihgt_foot"):
        replace(capture, sensors=(first, replace(second, part_of="rihgt_foot")))
    with pytest.raises(CaptureError, match="another agent wears"):
        hers = replace(second, part_of=first.name, agent="guest")
        replace(capture, sensors=(first, hers), others=(guest,))


def test_hands_that_have_a_thing_between_them_do_not_clap() -> None:
    capture = WHOLE[2](motions.WOMAN).capture
    hand = capture.sensor("right_hand")
    assert hand.shape is not None
    card = TagObject("card", TagType.MOBILE, _copy(hand), hand.shape)
    held = replace(capture, objects=(card,))
    assert with_meeting_hands(held) is held
    assert {each.name for each in with_meeting_hands(capture).objects} == {
        "right_hand",
        "left_hand",
    }
    assert not any(each.name == "Clap" for each in observe(held).segments)


def test_hands_that_never_meet_are_no_objects() -> None:
    capture = motions.drink_from_mug(motions.WOMAN).capture
    assert with_meeting_hands(capture) is capture
    claps = WHOLE[2](motions.WOMAN).capture
    left = claps.sensor("left_hand")
    far = replace(left.stream, positions=left.stream.positions + np.array([0.0, 5.0, 0.0]))
    apart = tuple(replace(left, stream=far) if each is left else each for each in claps.sensors)
    assert with_meeting_hands(replace(claps, sensors=apart)).objects == claps.objects


def test_a_hand_that_rests_while_the_other_one_comes_to_it_does_nothing() -> None:
    seen = observe(WHOLE[3](motions.WOMAN).capture)
    (left,) = [each for each in seen.links if each.ee == "left_hand"]
    assert [each.name for each in left.segments] == ["Rest"]


def _copy(sensor: Sensor) -> Stream:
    """The same motion as a stream of its own."""
    own = sensor.stream
    return Stream(own.times, own.positions.copy(), own.orientations.copy())


def _touching(capture: Capture) -> list[Touching]:
    return [each for each in measure(capture).facts if isinstance(each, Touching)]
