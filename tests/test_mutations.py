"""Mutants change what a program does: never its comments, its texts or what nobody calls."""

import ast

import pytest
from mutations import Mutation, of_python, of_rules, python_differs, rules_differ

RULES = """%* Lift: goes up from start to 1. *%
#include "other.lp".
% A comment with 7 and start.
fits(Segment, "Lift") :-
    frame_at(Segment, start, Frame),
    Frame > 2,
    not low(Segment).
low(seg(Hand, 1)) :- hand(Hand).
"""

MODULE = '''"""A module of 3 numbers."""

from typing import Literal

SIDES: Literal[1, 2] = 2


def area(width: "Float[ndarray, '3']", height: int = 4) -> int:
    """Width times height, not 5."""
    # 6 comments
    if not width or height < 7:
        raise ValueError(f"{width + 8} is less than 9")
    return width * height + SIDES


def unused(number: int) -> int:
    return number + 10
'''

WORDS = {"area": 2, "unused": 1}


def changed(text: str, found: list[Mutation]) -> set[tuple[str, str, str]]:
    content = text.encode()
    return {
        (each.kind, content[each.start : each.end].decode(), each.replacement) for each in found
    }


def test_conditions_numbers_words_and_whole_rules_are_mutated():
    found = changed(RULES, list(of_rules(RULES)))
    assert ("comparison", "Frame > 2", "Frame >= 2") in found
    assert ("negation", "not low(Segment)", "low(Segment)") in found
    assert ("condition", "Frame > 2", "#true") in found
    assert ("word", "start", "end") in found
    assert ("number", "2", "3") in found
    assert ("rule", "low(seg(Hand, 1)) :- hand(Hand).", "") in found


def test_no_comment_of_rules_is_mutated_and_each_mutant_says_something_else():
    first = RULES.index("fits(")
    valid = [each for each in of_rules(RULES) if rules_differ(RULES, each.applied(RULES))]
    assert len(valid) >= 8
    for each in valid:
        assert each.applied(RULES)[:first] == RULES[:first]


@pytest.mark.parametrize(
    ("other", "differs"),
    [
        (RULES.replace("    Frame > 2,\n", "    Frame  >  2, % more\n"), False),
        (RULES.replace("Frame > 2", "Frame > 2, #true"), False),
        (RULES.replace("Frame > 2", "Frame > 3"), True),
        (RULES.replace("frame_at(Segment, start, Frame)", "#true"), False),
        (RULES.replace("not low(Segment).", "not low(Segment"), False),
    ],
)
def test_equal_unsafe_and_malformed_rules_are_no_mutants(other, differs):
    assert rules_differ(RULES, other) == differs


def test_numbers_comparisons_and_conditions_of_python_are_mutated():
    found = changed(MODULE, list(of_python(MODULE, words=WORDS)))
    assert found == {
        ("number", "2", "3"),
        ("number", "4", "5"),
        ("number", "7", "8"),
        ("negation", "not width", "(width)"),
        ("comparison", "height < 7", "(height <= 7)"),
        ("connective", "not width or height < 7", "(not width and height < 7)"),
        ("arithmetic", "width * height", "(width / height)"),
        ("arithmetic", "width * height + SIDES", "(width * height - SIDES)"),
    }


def test_every_mutant_of_python_compiles_and_is_another_program():
    for each in of_python(MODULE, words=WORDS):
        after = each.applied(MODULE)
        ast.parse(after)
        assert python_differs(MODULE, after)
    assert not python_differs(MODULE, MODULE.replace("# 6", "#  7"))
