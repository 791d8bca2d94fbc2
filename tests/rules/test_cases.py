"""Every rule case ends as its expectations say; a case is reported by its file and title."""

import re
from collections.abc import Mapping
from functools import cache

import pytest
from case_batches import solve_batch
from rule_cases import HERE, Case, all_cases

from capar.model.errors import RuleError
from capar_rules.engine.solver import rule_file, solve, text_of

SHOWN = HERE / "everything.lp"
CASES = pytest.mark.parametrize("case", all_cases(), ids=str)
RULE_PACKAGES = ("segmentation", "naming", "composition", "circumstances")
CONCEPTS = sorted(
    f"{package}/{path.stem}"
    for package in RULE_PACKAGES
    for path in rule_file(package).glob("*.lp")
    if path.stem != "bit_strings"
)

_SEGMENT = re.compile(r"seg\(\w+,\d+\)")
"""What an expectation is about; of a segment that is not there nothing could be expected."""

_NAMED = re.compile(r"\bnamed\((seg\(\w+,\d+\)),")


def solved_alone(case: Case) -> set[str]:
    """What the rules make of one case by itself, as of any capture."""
    answer = solve((*case.profile.files, SHOWN), case.numbered())
    return {text_of((name, *arguments)) for name, arguments in answer.atoms}


@pytest.fixture(scope="session")
def chosen(request: pytest.FixtureRequest) -> frozenset[Case]:
    """The cases that run; others need not be solved along with them."""
    found = (getattr(item, "callspec", None) for item in request.session.items)
    cases = (each.params.get("case") for each in found if each)
    return frozenset(each for each in cases if isinstance(each, Case))


@cache
def solved_together(chosen: frozenset[Case], profile: str) -> Mapping[Case, set[str]]:
    """What the rules make of the cases of a profile; nothing if they have no answer together."""
    cases = [case for case in all_cases() if case in chosen and case.profile.name == profile]
    try:
        found = solve_batch((*cases[0].profile.files, SHOWN), [case.numbered() for case in cases])
    except RuleError:
        return {}
    return dict(zip(cases, found, strict=True))


@CASES
def test_a_story_ends_as_expected(case: Case, chosen: frozenset[Case]) -> None:
    answer = solved_together(chosen, case.profile.name).get(case) or solved_alone(case)
    assert case.expected, "a case expects something"
    told = set(_SEGMENT.findall(" ".join(case.expected)))
    assert told <= {each for atom in answer for each in _SEGMENT.findall(atom)}
    for wanted in case.expected:
        if wanted.startswith("not "):
            assert wanted.removeprefix("not ") not in answer
        else:
            assert wanted in answer


@CASES
def test_no_segment_has_two_names(case: Case, chosen: frozenset[Case]) -> None:
    answer = solved_together(chosen, case.profile.name).get(case) or solved_alone(case)
    named = _NAMED.findall(" ".join(sorted(answer)))
    assert len(named) == len(set(named)), sorted(each for each in answer if "named(" in each)


@pytest.mark.parametrize("case", all_cases()[::25], ids=str)
def test_cases_that_are_solved_together_do_not_meet(case: Case, chosen: frozenset[Case]) -> None:
    assert solved_together(chosen, case.profile.name)[case] == solved_alone(case)


@CASES
def test_a_case_tells_its_story_first(case: Case) -> None:
    assert case.story.startswith("% ")


def test_each_case_has_a_name_of_its_own() -> None:
    names = [str(case) for case in all_cases()]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("concept", CONCEPTS)
def test_every_rule_file_has_a_case(concept: str) -> None:
    assert any(case.concept == concept for case in all_cases()), f"tests/rules/{concept}.cases"


def test_every_file_of_cases_belongs_to_a_rule_file() -> None:
    found = {case.concept for case in all_cases() if not case.concept.startswith("prepositions/")}
    assert [each for each in sorted(found) if not rule_file(f"{each}.lp").exists()] == []
