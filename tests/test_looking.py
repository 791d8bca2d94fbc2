"""Where performers look is told of each segment; a head that acts looks as an action of its own."""

from dataclasses import replace

import motions
import pytest
from motions import PERFORMERS, TALL_MAN, Performer

from capar.model.capture import Capture, Role
from capar.model.facts import LookingAt
from capar.model.json_form import from_json, to_json
from capar.pipelines.observation import observe
from kb.actionary import Actionary

performer = pytest.mark.parametrize("performer", PERFORMERS, ids=lambda each: each.name)


def acting(capture: Capture) -> Capture:
    """The capture with its head among the end-effectors that act."""
    sensors = (
        replace(each, role=Role.ACTS) if each.name == "head" else each for each in capture.sensors
    )
    return replace(capture, sensors=tuple(sensors))


@performer
def test_who_lays_a_hand_on_a_box_looks_at_it(performer: Performer) -> None:
    seen = observe(motions.touch_cycle(performer).capture)
    looks = {each.name: each.looks for each in seen.segments}
    assert looks["Reach"] == (("box", "end"),)
    assert looks["Touch"] == (("box", "throughout"),)
    assert looks["ResumePosture"] == (("box", "start"),)


@performer
def test_looks_are_those_of_the_measured_line_of_sight(performer: Performer) -> None:
    seen = observe(motions.drink_from_mug(performer).capture)
    spans = [each for each in seen.facts if isinstance(each, LookingAt)]
    for segment in seen.segments:
        for thing in segment.objects:
            mine = [(each.first, each.last) for each in spans if each.object == thing]
            at = {
                when
                for when, frame in (("start", segment.first), ("end", segment.last))
                if any(first <= frame <= last for first, last in mine)
            }
            told = {when for name, when in segment.looks if name == thing}
            if "throughout" in told:
                assert told == {"throughout"}
                assert any(a <= segment.first and b >= segment.last for a, b in mine)
            else:
                assert told & {"start", "end"} == at


@performer
def test_a_head_that_acts_looks_where_one_that_attends_does(performer: Performer) -> None:
    capture = motions.touch_cycle(performer).capture
    plain, other = observe(capture), observe(acting(capture))
    assert [each for each in other.segments if each.ee != "head"] == list(plain.segments)
    (look,) = [each for each in other.segments if each.name == "LookAt"]
    assert look.objects == ("box",)
    assert look.looks == (("box", "throughout"),)
    (span,) = [each for each in plain.facts if isinstance(each, LookingAt) and each.object == "box"]
    assert (look.first, look.last) == (span.first, span.last)
    others = {each.name for each in other.segments if each.ee == "head"} - {"LookAt"}
    assert others <= {"PostureChange", "Rest"}


def test_the_thesis_knows_no_looking() -> None:
    capture = motions.touch_cycle(TALL_MAN).capture
    seen = observe(acting(capture), rules="thesis")
    assert not [each for each in seen.segments if each.name == "LookAt" or each.looks]


def test_looks_survive_json_and_their_borders_are_words_of_the_actionary() -> None:
    seen = observe(acting(motions.touch_cycle(TALL_MAN).capture))
    assert from_json(to_json(seen)) == seen
    with Actionary.in_memory() as known:
        known.add(seen)
        found = known.query(
            'SELECT ?index { ?segment capar:ee "head" ; capar:index ?index ; '
            "capar:beginsWith/capar:borderKind capar:BeginsLooking }"
        )
    assert len(found.rows) == 1
