"""Facts: what a kind declares, and how facts are written and read."""

from dataclasses import fields
from typing import Any, get_type_hints

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug

from capar.model.errors import FactError
from capar.model.facts import (
    ALL_FACT_KINDS,
    LARGEST,
    Bears,
    ContactNormal,
    Fact,
    FactIntervals,
    Frames,
    Lies,
    Observed,
    Passage,
    Tag,
    Touching,
    ZeroCrossing,
    fact_kind,
    program,
    read_fact,
)
from capar_rules.engine.solver import rule_file
from capar_rules.inputs import inputs
from ontology import terms

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


INPUTS = rule_file("inputs.lp").read_text()
KINDS = pytest.mark.parametrize("kind", ALL_FACT_KINDS, ids=lambda kind: kind.__name__)


def declare(**changes: object) -> None:
    given: dict[str, Any] = {"terms": "Touching body firstFrame lastFrame", **changes}

    @fact_kind("wrong", **given)
    class Wrong(Observed):
        body: str
        first: int
        last: int


@pytest.mark.parametrize(
    "changes",
    [
        {"span": Lies},
        {"others": ("other",)},
        {"stretch": "bears_{share}"},
        {"terms": "Touching body"},
        {"powers": {"body": -3}},
        {"powers": {"speed": -3}},
    ],
    ids=str,
)
def test_a_declaration_that_does_not_fit_the_fields_is_refused(changes: dict[str, object]) -> None:
    declare()
    with pytest.raises(FactError, match="Wrong"):
        declare(**changes)


def test_the_kinds_are_the_inputs_of_the_rules() -> None:
    assert inputs(INPUTS) == INPUTS


@KINDS
def test_the_ontology_has_the_declared_class_and_properties(kind: type[Observed]) -> None:
    assert set(kind.declaration.rdf) <= set(terms())


def test_no_two_kinds_share_a_class_of_their_own() -> None:
    own = [kind.declaration.rdf[0] for kind in ALL_FACT_KINDS]
    assert len(set(own)) == len(own)


def test_a_foot_draws_borders_only_where_it_bears_all_or_nothing() -> None:
    found = {share: Bears("foot", share, 0, 9).is_border() for share in ("whole", "part", "none")}
    assert found == {"whole": True, "part": False, "none": True}


def test_a_fact_about_a_contact_holds_while_the_contact_lasts() -> None:
    intervals = FactIntervals([Touching("hand", "cup", 3, 9), Lies("cup", "inside", "box", 3, 5)])
    assert intervals.of(ContactNormal("hand", "cup", 3, 900)) == (3, 9)
    assert intervals.of(ContactNormal("hand", "cup", 4, 900)) is None
    assert intervals.of(Passage("cup", "inside", "box", 3, "other")) == (3, 5)
    assert intervals.of(Passage("cup", "above", "box", 3, "other")) is None
    assert intervals.of(Frames(0, 9)) is None
