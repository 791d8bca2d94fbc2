"""What is left out of a rule base does not change what it answers."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from capar_rules.engine.solver import brave
from capar_rules.engine.syntax import Signature, asked_for, firing, parse_text

RULES = parse_text(
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
        for rules in (RULES, firing(RULES, told))
    )
    assert whole == part


@pytest.mark.parametrize(
    ("kinds", "heads"),
    [
        ((), set()),
        ((("seen", 1),), {"lost", "many", "all_near", "odd"}),
        ((("moved", 1), ("turned", 1)), {"shaken"}),
        ((("near", 2), ("moved", 1)), {"held", "carried"}),
    ],
)
def test_a_rule_is_left_out_when_nothing_that_it_asks_for_is_measured(
    kinds: tuple[Signature, ...], heads: set[str]
) -> None:
    kept = firing(RULES, kinds)
    assert {head.signature[0] for each in kept for head in each.heads} == heads
    assert [each for each in kept if each.kind == "definition"] == [RULES[0]]


SHOWING = "#show lost/1. #show shaken/1.\n"


@settings(max_examples=80, deadline=None)
@given(facts())
def test_the_rules_that_are_asked_for_answer_as_all_do(told: dict[Signature, set[str]]) -> None:
    rules = (*parse_text(SHOWING), *RULES)
    text = "\n".join(sorted(each for several in told.values() for each in several))
    asked = [("lost", 1), ("shaken", 1)]
    whole, part = (
        brave("\n".join([*(rule.text for rule in chosen), text]), asked)
        for chosen in (rules, asked_for(rules))
    )
    assert whole == part


def test_a_rule_is_left_out_when_nothing_that_is_shown_depends_on_it() -> None:
    kept = asked_for((*parse_text(SHOWING), *RULES))
    heads = {head.signature[0] for rule in kept for head in rule.heads}
    assert heads == {"held", "lost", "shaken"}


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
    rules = (*parse_text(SHOWING + further), *RULES)
    assert asked_for(rules) == list(rules)


def test_all_rules_stay_where_everything_is_shown() -> None:
    assert asked_for(RULES) == list(RULES)
