"""Drafts have the fewest conditions that tell a segment from others, and short examples."""

from itertools import combinations
from pathlib import Path

import pytest
from bundles import DRINKING
from hypothesis import given, settings
from hypothesis import strategies as st

from capar.rulebook.drafts import rule_from_segment
from capar_rules.authoring.drafting import conditions, distinction
from capar_rules.authoring.user_primitives import read_examples, try_rule
from capar_rules.engine.profiles import profile

FEW = conditions()[:6]

BITS = st.frozensets(st.sampled_from(FEW))


@settings(max_examples=40, deadline=None)
@given(BITS, st.lists(BITS, max_size=6))
def test_conditions_tell_it_from_all_that_can_be_told_and_none_is_needless(
    own: frozenset[str], others: list[frozenset[str]]
) -> None:
    chosen, left = distinction(sorted(own), others)
    assert left == sum(own <= each for each in others)
    assert {*chosen} <= own
    for size in {len(chosen), max(len(chosen) - 1, 0)}:
        for some in combinations(chosen, size):
            alike = sum({*some} <= each for each in others)
            assert (alike == left) == (size == len(chosen))


@pytest.mark.long
def test_a_draft_holds_by_its_own_short_examples_and_says_what_it_left_out(tmp_path: Path) -> None:
    text = rule_from_segment("BringUp", f"{DRINKING}/right_hand/2", rules=profile())
    path = tmp_path / "bring_up.lp"
    path.write_text(text)
    assert 'fits(Segment, "MoveObjTo"),\n    rises(Segment, _).' in text
    assert "feature_row" not in text
    examples = read_examples(text)
    assert [each.positive for each in examples] == [True, False]
    assert try_rule(path) == ()
