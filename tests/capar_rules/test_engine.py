"""The engine: rules parsed, sliced and solved."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from capar.model.errors import RuleError
from capar.model.facts import Fact, Frames, Touching, ZeroCrossing, program
from capar_rules.engine import solver, syntax
from capar_rules.engine.solver import brave
from capar_rules.engine.syntax import Signature, asked_for, firing, parse, parse_text

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
@pytest.mark.parametrize("kept", [None, "", '[["named(', "null"])
def test_rules_that_are_reduced_or_kept_answer_as_whole_ones(
    facts: list[Fact], kept: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    rules = tmp_path / "rules.lp"
    rules.write_text(REACHED)
    whole = solver.solve([rules], program(facts))
    for _ in range(2):
        solver._rule_base.cache_clear()
        assert solver.solve([rules], facts) == whole
        (stored,) = tmp_path.glob("capar/rules/*.json")
        if kept is not None:
            stored.write_text(kept)


def test_rules_answer_where_nothing_can_be_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    rules = tmp_path / "rules.lp"
    rules.write_text(REACHED)
    assert solver.solve([rules], TOUCHES) == solver.solve([rules], program(TOUCHES))


def test_a_remark_names_the_place_in_the_file(tmp_path: Path) -> None:
    rules = tmp_path / "rules.lp"
    for fault in ("named(A / 0) :- touching(_, _, A, _).", "named(A) :- touching(_, _, B, _)."):
        rules.write_text(f"{REACHED}{fault}\n")
        for _ in range(2):
            with pytest.raises(RuleError, match=r"rules\.lp:11:"):
                solver.solve([rules], TOUCHES)


def test_rules_that_change_are_read_anew_however_often_they_were_asked(tmp_path: Path) -> None:
    rules = tmp_path / "rules.lp"
    rules.write_text(REACHED)
    before = solver.solve([rules], TOUCHES)
    rules.write_text(REACHED.replace("nobody_sits", "no_one_is_seated"))
    after = solver.solve([rules], TOUCHES)
    assert before.of("named") != after.of("named")
    assert ("no_one_is_seated",) in after.of("named")


SLICING_RULES = parse_text(
    """
    #const enough = 2.
    held(X) :- near(X, Far), Far < enough.
    lost(X) :- seen(X), not held(X).
    carried(X) :- held(X), moved(X), not shaken(X).
    shaken(X) :- moved(X), turned(X).
    many(N) :- N = #count { X : held(X) }, seen(_).
    odd(X) :- lost(X), not not shaken(X).
    round(X) :- square(X).
    square(X) :- round(X).
    all_near :- seen(_), held(X) : seen(X).
    """
)
KINDS: tuple[Signature, ...] = (("near", 2), ("seen", 1), ("moved", 1), ("turned", 1))
ASKED: tuple[Signature, ...] = tuple(
    (name, arity)
    for name, arity in (
        ("held", 1), ("lost", 1), ("carried", 1), ("shaken", 1), ("many", 1), ("odd", 1),
        ("round", 1), ("square", 1), ("all_near", 0),
    )
)  # fmt: skip


@st.composite
def facts(draw: st.DrawFn) -> dict[Signature, set[str]]:
    """Some facts of some kinds."""
    things = st.sampled_from("ab")
    told = draw(st.sets(st.tuples(st.sampled_from(KINDS), things, st.integers(0, 4)), max_size=6))
    out: dict[Signature, set[str]] = {}
    for kind, thing, number in told:
        inside = f"{thing},{number}" if kind[1] == 2 else thing
        out.setdefault(kind, set()).add(f"{kind[0]}({inside}).")
    return out


@settings(max_examples=80, deadline=None)
@given(facts())
def test_the_rules_that_can_fire_answer_as_all_do(told: dict[Signature, set[str]]) -> None:
    text = "\n".join(sorted(each for several in told.values() for each in several))
    whole, part = (
        brave("\n".join([*(each.text for each in rules), text]), ASKED)
        for rules in (SLICING_RULES, firing(SLICING_RULES, told))
    )
    assert whole == part


SHOWING = "#show lost/1. #show shaken/1.\n"


@settings(max_examples=80, deadline=None)
@given(facts())
def test_the_rules_that_are_asked_for_answer_as_all_do(told: dict[Signature, set[str]]) -> None:
    rules = (*parse_text(SHOWING), *SLICING_RULES)
    text = "\n".join(sorted(each for several in told.values() for each in several))
    asked = [("lost", 1), ("shaken", 1)]
    whole, part = (
        brave("\n".join([*(rule.text for rule in chosen), text]), asked)
        for chosen in (rules, asked_for(rules))
    )
    assert whole == part


@pytest.mark.parametrize(
    "further",
    [
        ":- held(X), lost(X).",
        "{ chosen(X) } :- seen(X).",
        "one(X); other(X) :- seen(X).",
        ":~ held(X). [1, X]",
        "#show X : held(X).",
    ],
)
def test_all_rules_stay_where_more_than_definitions_decides_on_the_answer(further: str) -> None:
    rules = (*parse_text(SHOWING + further), *SLICING_RULES)
    assert asked_for(rules) == list(rules)


@pytest.fixture
def including(tmp_path: Path) -> Path:
    """A file that includes another one, ``below.lp``."""
    (tmp_path / "below.lp").write_text("a(1).\n")
    path = tmp_path / "top.lp"
    path.write_text('#include "below.lp".\nb(X) :- a(X).\n')
    return path


def test_a_file_that_did_not_change_is_parsed_once(
    including: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = parse([including])
    monkeypatch.setattr(syntax, "_parsed", lambda run: pytest.fail("it was parsed again"))
    assert parse([including]) is first
