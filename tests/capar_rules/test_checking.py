"""Rule files are checked before they count: every file gets an answer, and nothing of it runs."""

import os
from pathlib import Path

import hostile_rules
import pytest

from capar_rules.authoring.glossary import glossary
from capar_rules.engine.profiles import profile
from capar_rules.engine.syntax import parse_text
from capar_rules.lint.checker_process import base_of
from capar_rules.lint.checking import check
from capar_rules.lint.findings import NOTE, Finding, errors
from capar_rules.lint.world_checks import world_findings

EXPECTED = {
    "script_python": "script",
    "script_lua": "script",
    "script_later": "script",
    "at_function": "external-function",
    "include_passwd": "include",
    "include_above": "include",
    "include_device": "include",
    "include_hidden": "include",
    "choice": "choice-head",
    "disjunction": "disjunction-head",
    "constraint": "constraint-head",
    "minimize": "refused-statement",
    "external": "refused-statement",
    "program_part": "refused-statement",
    "even_loop": "negative-cycle",
    "loop_through_names": "negative-cycle",
    "const_taken": "taken-constant",
    "redefines": "redefined-predicate",
    "redefines_input": "redefined-predicate",
    "renames_reach": "taken-name",
    "speaks_for_others": "foreign-name",
    "circle": "circular",
    "unsafe": "unsafe-variable",
    "unknown_word": "unknown-predicate",
    "wrong_arity": "wrong-arity",
    "wrong_bits": "wrong-bits",
    "no_full_stop": "syntax",
    "open_string": "syntax",
    "empty": "no-primitive",
    "zero_byte": "encoding",
    "latin_1": "encoding",
    "too_large": "too-large",
    "deep_brackets": "too-deep",
    "big_number": "number",
    "endless": "unbounded",
    "include_library": "include",
    "not_a_program": "syntax",
    "deep_minus": "unbounded",
    "long_sum": "unbounded",
    "explodes": "unbounded",
    "explodes_in_body": "unbounded",
    "endless_terms": "unbounded",
    "endless_text": "unbounded",
}
"""What is wrong with some of the files made by hand."""


@pytest.fixture(scope="module")
def answers(tmp_path_factory) -> dict[str, tuple[Finding, ...]]:
    folder = tmp_path_factory.mktemp("hostile")
    made = {name: content for name, content in hostile_rules.rule_files(10_000) if name in EXPECTED}
    paths = []
    for name, content in made.items():
        path = folder / f"{name}.lp"
        path.write_bytes(content)
        paths.append(path)
    before = Path.cwd()
    os.chdir(folder)
    try:
        found = [check(each, profile="thesis") for each in paths]
    finally:
        os.chdir(before)
    assert not (folder / "HARMED").exists()
    return dict(zip(made, found, strict=True))


@pytest.mark.parametrize("name", sorted(EXPECTED))
def test_what_is_wrong_is_named_with_its_place_and_remedy(answers, name):
    found = errors(answers[name])
    assert EXPECTED[name] in {each.code for each in found}
    for each in found:
        assert each.place.line >= 1
        assert each.place.column >= 1
        assert each.place.file.endswith(f"{name}.lp")
        assert each.remedy.endswith((".", "...", ". *%"))
        assert str(each).startswith(f"{each.place}: error: ")


def test_a_rule_that_can_never_fire_and_one_that_always_does_are_found(tmp_path):
    path = tmp_path / "bad.lp"
    path.write_text(
        '%* Bad: bad. *%\nprimitive("Bad").\n'
        'fits(Segment, "Bad") :-\n    segment(Segment, From, _),\n    From < 0,\n    From > 0.\n'
        'fits(Segment, "Bad") :- segment(Segment, _, _).\n'
    )
    found = {(each.code, each.place.line) for each in check(path, profile="thesis")}
    assert {("never-fires", 3), ("always-fires", 7), ("ambiguous", 2)} <= found


def test_a_rule_over_measurements_outside_the_world_is_not_judged_but_noted(tmp_path):
    path = tmp_path / "gaze.lp"
    path.write_text(
        '%* Gaze: one touches what one looks at. *%\nprimitive("Gaze").\n'
        'specialises("Gaze", "Touch").\n'
        'fits(Segment, "Gaze") :-\n    fits(Segment, "Touch"),\n'
        "    object_at(Segment, 0, Object),\n    looking_at(_, Object, _, _).\n"
    )
    found = check(path, profile="thesis")
    assert [(each.code, each.level) for each in found] == [("not-judged", NOTE)]


def test_rules_over_words_of_which_the_world_has_few_are_not_judged_but_noted(tmp_path):
    """What lies above another is measured; the world only knows what is in another, or dips."""
    path = tmp_path / "tap.lp"
    path.write_text(
        '%* Tap: tap. *%\nprimitive("Tap").\nspecialises("Tap", "MoveObj").\n'
        'fits(S, "Tap") :- fits(S, "MoveObj"), overlaps(S, above, _, _).\n'
        'fits(S, "Tap") :- fits(S, "MoveObj"), lies_at(S, end, below, _, _).\n'
        'fits(S, "Tap") :- fits(S, "MoveObj"), regrasps(S, _).\n'
        'fits(S, "Tap") :- fits(S, "MoveObj"), segment(S, From, _), From < 0.\n'
    )
    found = [(each.place.line, each.code) for each in check(path)]
    assert sorted(found) == [
        (2, "ambiguous"), (4, "not-judged"), (5, "not-judged"), (6, "not-judged"),
        (7, "never-fires"),
    ]  # fmt: skip


def test_every_word_of_rules_can_stand_in_one_and_no_such_rule_is_said_never_to_fire():
    words = {
        each.signature: ",".join("S" if name == "Segment" else "_" for name in each.arguments)
        for each in glossary(profile()).words
        if each.arguments
    }
    rules = parse_text(
        "\n".join(
            f"speaks(S) :- segment(S,_,_), {name}({inside})." for (name, _), inside in words.items()
        )
    )
    found = list(world_findings(rules, base_of("extended")))
    assert len(words) > 200
    assert {each.code for each in found} == {"not-judged"}
