"""The solver reads the same program from facts in however many blocks."""

from pathlib import Path

import pytest

from capar.model.facts import Fact, Frames, Touching, ZeroCrossing
from capar_rules.engine import solver

RULES = """
#show seen/1.
seen(F) :- zero_crossing(hand, F), touching(hand, mug, First, Last), First <= F, F <= Last.
"""


@pytest.mark.parametrize("facts_a_block", [1, 7, 1000])
def test_an_answer_does_not_depend_on_how_many_facts_are_given_at_once(
    facts_a_block: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(solver, "BLOCK_FACTS", facts_a_block)
    rules = tmp_path / "rules.lp"
    rules.write_text(RULES)
    facts: list[Fact] = [Frames(0, 99), Touching("hand", "mug", 20, 39)]
    facts += [ZeroCrossing("hand", frame) for frame in range(100)]
    answer = solver.solve([rules], facts)
    assert [frame for (frame,) in answer.of("seen")] == list(range(20, 40))
