"""Every primitive and every preposition has cases that it must and that it must not fit."""

import re
from collections import defaultdict

import pytest
from rule_cases import all_cases

from capar_rules.engine.profiles import profile
from capar_rules.engine.solver import rule_file, solve

LEAST = 3
PRIMITIVES = sorted(
    str(name) for (name,) in solve(profile().files, "#show primitive/1.").of("primitive")
)
PREPOSITIONS = sorted(
    set(
        re.findall(
            r'^preposition\(Segment, "([a-z ]+)"',
            rule_file("vocabulary/prepositions.lp").read_text(),
            re.MULTILINE,
        )
    )
)
NAMED = re.compile(r'^(not )?(?:named|fits)\(.*,"(\w+)"\)$')
RELATED = re.compile(r'^(not )?preposition\(seg\(\w+,\d+\),"?([a-z ]+)"?,\w+,\w+\)$')


def _cases() -> tuple[dict[str, set[str]], dict[str, set[str]]]:
    """By primitive or preposition, the cases in which it must hold, and those in which not."""
    must: dict[str, set[str]] = defaultdict(set)
    must_not: dict[str, set[str]] = defaultdict(set)
    for case in all_cases():
        for line in case.expected:
            match = NAMED.match(line) or RELATED.match(line)
            if match:
                (must_not if match[1] else must)[match[2]].add(str(case))
    return must, must_not


MUST, MUST_NOT = _cases()


@pytest.mark.parametrize("name", [*PRIMITIVES, *PREPOSITIONS])
def test_each_has_cases_for_and_against(name: str) -> None:
    assert len(MUST[name]) >= LEAST, f"{name}: add cases in which it must hold"
    assert len(MUST_NOT[name]) >= LEAST, f"{name}: add cases in which it must not hold"


def test_each_primitive_is_told_by_one_verb() -> None:
    told = [str(name) for name, _ in solve(profile().files, "#show verb/2.").of("verb")]
    assert sorted(told) == PRIMITIVES


def test_no_case_names_what_there_is_not() -> None:
    assert {*MUST, *MUST_NOT} <= {*PRIMITIVES, *PREPOSITIONS}
