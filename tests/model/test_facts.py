"""Facts are atoms of the rules, and come back from them."""

from dataclasses import fields
from typing import get_type_hints

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug

from capar.model.errors import FactError
from capar.model.facts import (
    ALL_FACT_KINDS,
    LARGEST,
    Fact,
    Frames,
    Tag,
    Touching,
    ZeroCrossing,
    program,
    read_fact,
)

texts = st.text(st.characters(blacklist_categories=["Cs"], blacklist_characters="\0"), max_size=20)
integers = st.integers(-LARGEST, LARGEST)


def _facts(kind: type[Fact]) -> st.SearchStrategy[Fact]:
    hints = get_type_hints(kind)
    return st.builds(
        kind, *(integers if hints[each.name] is int else texts for each in fields(kind))
    )


every = st.one_of(*map(_facts, ALL_FACT_KINDS))


@given(every)
def test_a_fact_comes_back_from_the_solvers_value(fact: Fact) -> None:
    assert type(fact).from_symbol(fact.symbol()) == fact


@given(every)
def test_a_fact_comes_back_from_its_text(fact: Fact) -> None:
    assert read_fact(str(fact)) == fact


def test_an_atom_is_written_as_the_rules_read_it() -> None:
    assert str(Touching("right_hand", "mug", 118, 335)) == "touching(right_hand,mug,118,335)"
    assert str(Tag("Mug 1", "mobile")) == 'tag("Mug 1",mobile)'


def test_a_program_has_one_fact_a_line_in_order() -> None:
    assert (
        program((Frames(0, 9), ZeroCrossing("hand", 3))) == "frames(0,9).\nzero_crossing(hand,3).\n"
    )


def test_every_measured_fact_of_an_observation_can_be_read_back() -> None:
    facts = drink_from_mug().facts
    assert tuple(read_fact(line[:-1]) for line in program(facts).splitlines()) == facts


@given(st.integers(LARGEST + 1, 2**63))
def test_an_integer_that_the_solver_would_wrap_is_refused(number: int) -> None:
    for each in (number, -number):
        with pytest.raises(FactError, match="32 bits"):
            Frames(0, each).symbol()


@pytest.mark.parametrize(
    "text",
    [
        "",
        "touching",
        "touching(a,b)",
        "frames(a,b)",
        "tag(1,2)",
        "moves(mug)",
        "3",
        "a(",
        "-tag(a,b)",
    ],
)
def test_what_is_no_measured_fact_is_refused(text: str) -> None:
    with pytest.raises(FactError):
        read_fact(text)


def test_each_predicate_belongs_to_one_kind_of_fact() -> None:
    names = [each.predicate for each in ALL_FACT_KINDS]
    assert len(set(names)) == len(names)
