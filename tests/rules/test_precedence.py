"""A user's primitive precedes what it is no kind of: where both fit, it alone names a segment."""

from pathlib import Path

import pytest
from rule_cases import HERE, read_cases

from capar_rules.engine.solver import solve

HOIST = """
primitive("Hoist").
precedes("Hoist", "Lift").
fits(Segment, "Hoist") :-
    fits(Segment, "Lift"),
    dominant(Segment, {thing}).
"""
LIFTED = next(read_cases(HERE / "primitives" / "lift.cases"))


@pytest.mark.parametrize(("thing", "name"), [("box", "Hoist"), ("crate", "Lift")])
def test_what_precedes_names_a_segment_only_where_it_fits(
    thing: str, name: str, tmp_path: Path
) -> None:
    added = tmp_path / "hoist.lp"
    added.write_text(HOIST.format(thing=thing))
    answer = solve((*LIFTED.profile.files, added), LIFTED.numbered())
    lift = ("seg", "right_hand", 2)
    assert [told for segment, told in answer.of("named") if segment == lift] == [name]
