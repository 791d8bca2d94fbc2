"""PARs are what the thesis says they are, and compare as actions."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import FEATURES, drink_from_mug, pick_up_with_both_hands

from capar.model.errors import ParError
from capar.model.par import FeatureSet, Step

PUBLISHED = {
    "Reach": 0.445274,
    "MoveObjTo": 0.171642,
    "MoveObj": 0.0472637,
    "TouchWith": 0.0472637,
    "ResumePosture": 0.179104,
}


@pytest.mark.parametrize("name", FEATURES)
def test_the_published_feature_sets_have_the_lengths_of_thesis_4_4_1(name: str) -> None:
    start, end, change, force = FEATURES[name]
    made = FeatureSet(start, end, change, "hand", force)
    assert len(made.rel_start) == len(made.rel_end) == 2 * made.count - 1


@given(st.integers(0, 6), st.integers(0, 6), st.integers(0, 6), st.integers(0, 6))
def test_feature_strings_agree_in_length_or_are_refused(a: int, b: int, c: int, d: int) -> None:
    good = (a, b, d) == ((2 * c - 1, 2 * c - 1, c) if c else (0, 0, 0))
    if good:
        assert FeatureSet("1" * a, "1" * b, "0" * c, "hand", "0" * d).count == c
    else:
        with pytest.raises(ParError):
            FeatureSet("1" * a, "1" * b, "0" * c, "hand", "0" * d)


def test_feature_strings_are_bits() -> None:
    with pytest.raises(ParError, match="each 0 or 1"):
        FeatureSet("2", "1", "0", "hand", "0")


def test_the_hand_made_drink_has_the_published_shares() -> None:
    par = drink_from_mug().complex_par
    assert par.common is not None
    steps = (*par.links[0].steps, par.common)
    assert sum(each.share for each in steps) == pytest.approx(1.0, abs=1e-12)
    for step, share in ((each, PUBLISHED[each.action]) for each in (*steps[:3], *steps[4:])):
        assert step.share == pytest.approx(share, abs=0.02)


def test_another_performer_and_other_durations_are_the_same_action() -> None:
    par = drink_from_mug().complex_par
    assert drink_from_mug(agent="somebody").complex_par.signature == par.signature
    assert replace(par, duration_s=99.0).signature == par.signature


def test_other_names_of_the_objects_are_the_same_action() -> None:
    par = drink_from_mug().complex_par
    new = {"mug": "cup", "mouth": "lips", "table": "desk"}

    def renamed(step: Step) -> Step:
        return replace(step, objects=tuple(new[each] for each in step.objects))

    other = replace(
        par,
        objects=tuple(new[each] for each in par.objects),
        links=tuple(replace(each, steps=tuple(map(renamed, each.steps))) for each in par.links),
        common=renamed(par.common) if par.common else None,
    )
    assert other != par
    assert other.signature == par.signature


def test_another_order_of_steps_is_another_action() -> None:
    par = drink_from_mug().complex_par
    link = replace(par.links[0], steps=tuple(reversed(par.links[0].steps)))
    assert replace(par, links=(link,)).signature != par.signature


def test_the_common_step_belongs_to_every_link() -> None:
    for _, steps in pick_up_with_both_hands().complex_par.signature:
        assert steps[-1] == ("ResumePosture", (0,))
