"""The solver reads the same program from facts in however many blocks."""

from pathlib import Path

import pytest

from capar.model.errors import RuleError
from capar.model.facts import (
    Fact,
    Frames,
    Link,
    Moving,
    RateMhz,
    Tag,
    Touching,
    ZeroCrossing,
)
from capar_rules.engine import solver
from capar_rules.engine.profiles import profile
from capar_rules.pars.inference import infer

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


REACHED = """
#defined touching/4.
#defined zero_crossing/2.
#show named/1.
near(A, B) :- touching(A, B, _, _).
seated(A) :- near(A, chair), zero_crossing(A, _).
named(A) :- near(A, _), not seated(A).
named(none) :- not near(_, _).
named(nobody_sits) :- #count { A : seated(A) } = 0.
:- seated(A), not near(A, _).
"""
TOUCHES = [Touching("hand", "mug", 20, 39), Touching("man", "chair", 0, 99)]
CROSSINGS = [ZeroCrossing("man", 12)]


@pytest.mark.parametrize("facts", [TOUCHES, CROSSINGS, TOUCHES + CROSSINGS, [Frames(0, 99)]])
def test_rules_that_are_asked_often_answer_as_they_did_at_first(
    facts: list[Fact], tmp_path: Path
) -> None:
    rules = tmp_path / "rules.lp"
    rules.write_text(REACHED)
    first = solver.solve([rules], facts)
    later = [solver.solve([rules], facts) for _ in range(solver.OFTEN + 1)]
    assert later == [first] * len(later)


def test_rules_that_change_are_read_anew_however_often_they_were_asked(tmp_path: Path) -> None:
    rules = tmp_path / "rules.lp"
    rules.write_text(REACHED)
    for _ in range(solver.OFTEN + 2):
        before = solver.solve([rules], TOUCHES)
    rules.write_text(REACHED.replace("nobody_sits", "no_one_is_seated"))
    after = solver.solve([rules], TOUCHES)
    assert before.of("named") != after.of("named")
    assert ("no_one_is_seated",) in after.of("named")


def test_the_shipped_rules_answer_the_same_whole_and_reduced_to_what_facts_reach() -> None:
    rules = profile()
    facts: list[Fact] = [Frames(0, 300), RateMhz(100_000), Link("hand", "hand", "right")]
    facts += [Tag("mug", "mobile"), Touching("hand", "mug", 100, 200), Moving("mug", 120, 180)]
    found = [infer(facts, profile=rules) for _ in range(solver.OFTEN + 2)]
    assert found == [found[0]] * len(found)
    assert found[0].links[0].segments[0].name == "Reach"


def test_over_many_facts_rules_are_reduced_at_once_and_answer_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rules = tmp_path / "rules.lp"
    rules.write_text(REACHED)
    whole = solver.solve([rules], TOUCHES + CROSSINGS)
    rules.write_text(f"{REACHED}% The same again, not asked yet.")
    monkeypatch.setattr(solver, "MANY_FACTS", 1)
    assert solver.solve([rules], TOUCHES + CROSSINGS) == whole


def test_remarks_on_rules_are_heard_over_many_facts_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rules = tmp_path / "rules.lp"
    rules.write_text(REACHED.replace("seated(A) :- near(A, chair)", "seated(A) :- naer(A, chair)"))
    monkeypatch.setattr(solver, "MANY_FACTS", 1)
    with pytest.raises(RuleError, match="naer"):
        solver.solve([rules], TOUCHES + CROSSINGS)
