"""Every rule case is a story and its end: the facts of a .lp file, and what the rules make of them.

A case opens with a comment that tells it. `% profile: thesis` chooses the rules; else they are the
extended ones. Its .expected file holds one atom a line that must follow; `not` before an atom says
that it must not.
"""

import re
from pathlib import Path

import pytest

from capar.model.facts import read_fact
from capar_rules.borders.deflicker import steady
from capar_rules.borders.ranking import rank
from capar_rules.engine.profiles import profile
from capar_rules.engine.solver import rule_file, solve, text_of

HERE = Path(__file__).parent
CASES = sorted(HERE.glob("*/*.lp"))
CONCEPTS = sorted(
    path.stem
    for room in ("segmentation", "naming", "composition", "explain")
    for path in rule_file(room).glob("*.lp")
    if path.stem
    not in {
        "inputs",
        "thresholds",
        "bit_strings",
        "answers",
        "thesis",
        "extended",
        "derived",
        "explaining",
        "sentences",
    }
)


_SEGMENT = re.compile(r"seg\(\w+,\d+\)")
"""What an expectation is about; of a segment that is not there nothing could be expected."""


@pytest.mark.parametrize("case", CASES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_a_story_ends_as_expected(case: Path) -> None:
    answer = _answer(case)
    lines = case.with_suffix(".expected").read_text().splitlines()
    wanted = [line.removesuffix(".") for line in lines if line and not line.startswith("%")]
    assert wanted, "a case expects something"
    told = set(_SEGMENT.findall(" ".join(wanted)))
    assert told <= {each for line in answer for each in _SEGMENT.findall(line)}
    for line in wanted:
        if line.startswith("not "):
            assert line.removeprefix("not ") not in answer
        else:
            assert line in answer


@pytest.mark.parametrize("case", CASES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_a_case_tells_its_story_first(case: Path) -> None:
    assert case.read_text().startswith("% ")


@pytest.mark.parametrize("concept", CONCEPTS)
def test_every_rule_file_has_a_case(concept: str) -> None:
    assert list((HERE / concept).glob("*.lp")), f"tests/rules/{concept}/ holds no case"


def test_every_expectation_has_its_case() -> None:
    assert [
        each for each in HERE.glob("*/*.expected") if not each.with_suffix(".lp").exists()
    ] == []


def _answer(case: Path) -> set[str]:
    text = case.read_text()
    rules = profile("thesis" if "% profile: thesis" in text else "extended")
    facts = tuple(read_fact(text_of((name, *args))) for name, args in solve([], text).atoms)
    if rules.steady:
        facts = steady(facts)
    ranked = rank(facts, crossings_only=rules.crossings_only)
    whole = HERE / "everything.lp"
    answer = solve((*rules.files, whole), (*facts, *ranked))
    return {text_of((name, *arguments)) for name, arguments in answer.atoms}
