"""The facts that inputs are numbered from are those that they vanish without."""

from functools import cache
from pathlib import Path

import pytest

from capar.model.facts import Fact
from capar.pipelines.observation import observe
from capar_rules.authoring.glossary import NUMBERED
from capar_rules.borders.border_numbers import number_borders

DEMO = Path(__file__).parents[2] / "capar" / "demo" / "drink_from_mug"


@cache
def measured() -> tuple[Fact, ...]:
    """The facts of the demo."""
    return observe(DEMO).facts


def numbered(facts: tuple[Fact, ...]) -> set[str]:
    return {type(each).predicate for each in number_borders(facts, crossings_only=False)}


@pytest.mark.parametrize("number", sorted(NUMBERED.keys() & numbered(measured())))
def test_what_is_numbered_vanishes_with_the_facts_that_it_comes_from(number):
    for source in NUMBERED[number]:
        rest = tuple(each for each in measured() if type(each).predicate != source)
        assert number not in numbered(rest), source
