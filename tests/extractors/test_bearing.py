"""The weight on each foot is what statics says of where the body's middle is."""

from dataclasses import replace

import motions
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from motions import PERFORMERS, TALL_MAN, Performer, standing

from capar.model.capture import Capture
from capar.model.facts import Bears, LookingAt
from capar.pipelines.explanation import explained
from capar.pipelines.observation import observe
from capar_rules.engine.profiles import profile
from extractors.measure import measure
from extractors.relations.support import share_of_first
from extractors.thresholds import Thresholds
from kb.actionary import Actionary

LIMITS = Thresholds()
Point = tuple[float, float]
places = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))


def share(one: Point, two: Point, middle: Point | None, down: tuple[bool, bool]) -> float:
    """Of the first of two feet at these places on the floor, at one instant."""
    first, second = (np.array([[*each, 0.0]]) for each in (one, two))
    above = None if middle is None else np.array([[*middle, 0.95]])
    on = [np.array([each]) for each in down]
    return float(share_of_first(first, second, *on, above, LIMITS)[0])


@given(st.floats(0.15, 0.8), st.floats(0.0, 1.0), st.floats(-0.25, 0.25), st.floats(0.0, 6.28))
def test_two_feet_hold_the_body_by_the_law_of_the_lever(
    apart: float, along: float, aside: float, heading: float
) -> None:
    way = np.array([np.cos(heading), np.sin(heading)])
    across = np.array([-way[1], way[0]])
    middle = along * apart * way + aside * across
    found = share((0.0, 0.0), tuple(apart * way), tuple(middle), (True, True))
    # Moments about the second foot: the weight's arm over that of the first foot's load.
    assert found == pytest.approx(1.0 - along, abs=1e-9)


@given(places, places, places)
def test_the_shares_of_both_feet_make_the_whole(one: Point, two: Point, middle: Point) -> None:
    whole = share(one, two, middle, (True, True)) + share(two, one, middle, (True, True))
    assert np.isnan(whole) or whole == pytest.approx(1.0)


def test_a_foot_alone_on_the_floor_bears_all_unless_the_body_is_elsewhere() -> None:
    assert share((0.0, 0.0), (0.3, 0.0), (0.1, 0.0), (True, False)) == 1.0
    assert share((0.0, 0.0), (0.3, 0.0), (0.1, 0.0), (False, True)) == 0.0
    assert share((0.0, 0.0), (0.3, 0.0), None, (True, False)) == 1.0
    assert np.isnan(share((0.0, 0.0), (0.3, 0.0), (-0.4, 0.0), (True, False)))


def test_what_cannot_be_known_is_not_said() -> None:
    both = (True, True)
    assert np.isnan(share((0.0, 0.0), (0.3, 0.0), None, both))
    assert np.isnan(share((0.0, 0.0), (0.05, 0.0), (0.02, 0.0), both)), "feet together"
    assert np.isnan(share((0.0, 0.0), (0.3, 0.0), (0.15, 0.5), both)), "seated behind the feet"
    assert np.isnan(share((0.0, 0.0), (0.3, 0.0), (0.15, 0.0), (False, False))), "in the air"


@pytest.mark.parametrize("performer", PERFORMERS, ids=lambda each: each.name)
@pytest.mark.parametrize("noise_m", [0.0, 0.001])
def test_whoever_stands_on_one_leg_does_so_by_name(performer: Performer, noise_m: float) -> None:
    trial = motions.stand_on_one_leg(performer, noise_m=noise_m, noise_rad=5.0 * noise_m)
    seen = observe(trial.capture)
    for link in seen.links:
        names = tuple(each.name for each in link.segments)
        assert names == trial.truth.steps["extended"][link.ee]
    left = seen.links[0].segments[1]
    assert left.general == ("Stand", "Touch")
    assert standing.SHIFTS_S < left.start_s < standing.SHIFTED_S
    assert left.end_s > standing.BACK_S


def test_the_weight_is_whole_while_the_other_foot_is_off_the_floor() -> None:
    facts = bears(motions.stand_on_one_leg(TALL_MAN, rate_hz=100.0).capture)
    ((first, last),) = [each[1:] for each in facts["left_foot"] if each[0] == "whole"]
    assert first < 100.0 * standing.LIFTS_S
    assert last > 100.0 * standing.DOWN_S
    assert [each[0] for each in facts["left_foot"]] == ["part", "whole", "part"]
    assert [each[0] for each in facts["right_foot"]] == ["part", "none", "none", "part"]


def test_without_a_trunk_two_feet_on_the_floor_bear_nobody_knows_how_much() -> None:
    capture = motions.stand_on_one_leg(TALL_MAN).capture
    feet = replace(capture, sensors=tuple(each for each in capture.sensors if each.side != "none"))
    facts = bears(feet)
    assert [each[0] for each in facts["left_foot"]] == ["whole"]
    assert "right_foot" not in facts
    names = [each.name for each in observe(feet).segments if each.ee == "right_foot"]
    assert names == ["Stand", "Withdraw", "Rest", "Step", "Stand"]


def test_without_a_floor_feet_are_down_where_they_rest_lowest() -> None:
    capture = replace(motions.stand_on_one_leg(TALL_MAN).capture, objects=())
    facts = bears(capture)
    assert [each[0] for each in facts["left_foot"]] == ["part", "whole", "part"]
    assert [each[0] for each in facts["right_foot"]] == ["part", "none", "none", "part"]


def test_one_foot_alone_says_nothing_and_a_pelvis_looks_at_nothing() -> None:
    capture = motions.stand_on_one_leg(TALL_MAN).capture
    one = replace(capture, sensors=tuple(e for e in capture.sensors if e.name != "right_foot"))
    assert bears(one) == {}
    assert not [each for each in measure(capture).facts if isinstance(each, LookingAt)]


def test_an_explanation_says_what_the_foot_bore_and_when_that_was_measured() -> None:
    capture = motions.stand_on_one_leg(TALL_MAN).capture
    told = explained(capture, rules=profile())
    ((_, first, last),) = [each for each in bears(capture)["left_foot"] if each[0] == "whole"]
    explanation = told.explainer.explain(told.observation.links[0].segments[1])
    assert explanation.summary.count("the left foot bore the whole weight of the body") == 1
    leaves = {each.frames for each in explanation.reason.walk() if each.atom.startswith("bears(")}
    assert leaves == {(first, last)}


def test_shifts_of_weight_are_borders_that_the_actionary_knows() -> None:
    seen = observe(motions.stand_on_one_leg(TALL_MAN).capture)
    kinds = {border.kind for segment in seen.segments for border in segment.begins}
    assert "shifts_weight" in kinds
    with Actionary.in_memory() as known:
        known.add(seen)
        found = known.query("SELECT ?border { ?border capar:borderKind capar:ShiftsWeight }")
    assert found.rows


def bears(capture: Capture) -> dict[str, list[tuple[str, int, int]]]:
    """What was measured of each foot, in time."""
    out: dict[str, list[tuple[str, int, int]]] = {}
    found = [each for each in measure(capture).facts if isinstance(each, Bears)]
    for each in sorted(found, key=lambda fact: (fact.foot, fact.first)):
        out.setdefault(each.foot, []).append((each.share, each.first, each.last))
    return out
