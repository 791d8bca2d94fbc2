"""Every kind of fact declares what others derive from it, as rules and ontology know it."""

import re
from dataclasses import fields

import pytest

from capar.model.errors import FactError
from capar.model.facts import (
    ALL_FACT_KINDS,
    Bears,
    ContactNormal,
    FactIntervals,
    Frames,
    Lies,
    Observed,
    Passage,
    Span,
    Touching,
    fact_kind,
)
from capar_rules.engine.solver import rule_file
from ontology import terms

INPUTS = rule_file("inputs.lp").read_text()
KINDS = pytest.mark.parametrize("kind", ALL_FACT_KINDS, ids=lambda kind: kind.__name__)


def declare(**changes: object) -> None:
    given: dict[str, object] = {"about": "body", "span": Span.INTERVAL}
    given["terms"] = "Touching body firstFrame lastFrame"

    @fact_kind("wrong", **{**given, **changes})
    class Wrong(Observed):
        body: str
        first: int
        last: int


@pytest.mark.parametrize(
    "changes",
    [
        {"about": "hand"},
        {"span": Span.INSTANT},
        {"span": Lies},
        {"others": ("other",)},
        {"stretch": "bears_{share}"},
        {"terms": "Touching body"},
        {"powers": {"body": -3}},
        {"powers": {"speed": -3}},
        {"span": Span.ALWAYS, "negated": "apart"},
    ],
    ids=str,
)
def test_a_declaration_that_does_not_fit_the_fields_is_refused(changes: dict[str, object]) -> None:
    declare()
    with pytest.raises(FactError, match="Wrong"):
        declare(**changes)


def test_the_kinds_are_the_inputs_of_the_rules() -> None:
    measured = INPUTS.split("% Borders.")[0] + INPUTS.split("% What was doubted")[1]
    stated = {(kind.predicate, len(fields(kind))) for kind in ALL_FACT_KINDS}
    found = re.findall(r"^#defined (\w+)/(\d+)\.", measured, re.MULTILINE)
    assert {(name, int(arity)) for name, arity in found} == stated


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
