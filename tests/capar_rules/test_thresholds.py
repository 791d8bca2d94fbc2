"""Each time that decides stands once: in the thresholds of the rules, or of the extractors."""

import ast
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from capar.model.errors import RuleError
from capar_rules.borders.ticks import in_frames, times
from capar_rules.engine.solver import rule_file

PROCESS_LIMITS = {"lint/checker_process.py", "lint/checker_client.py"}
"""How long a process that checks untrusted rules may run: no time of a capture."""

MODULES = sorted(
    path
    for path in rule_file("").rglob("*.py")
    if path.relative_to(rule_file("")).as_posix() not in PROCESS_LIMITS
)


def times_in(source: str) -> Iterator[str]:
    """Numbers that are called seconds or milliseconds, or are multiplied by a rate."""
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if _is_time(name, value):
                yield f"{name}, line {node.lineno}"
            case ast.AnnAssign(target=ast.Name(id=name), value=value) if _is_time(name, value):
                yield f"{name}, line {node.lineno}"
            case ast.keyword(arg=str(name), value=value) if _is_time(name, value):
                yield f"{name}, line {node.lineno}"
            case ast.BinOp(left=left, op=ast.Mult(), right=right):
                if _is_rate(left, right) or _is_rate(right, left):
                    yield f"a number times a rate, line {node.lineno}"


def _is_time(name: str, value: ast.expr | None) -> bool:
    return bool(re.search(r"_m?s$", name, re.IGNORECASE)) and _is_number(value)


def _is_rate(one: ast.expr, other: ast.expr) -> bool:
    return _is_number(one) and "rate" in ast.unparse(other)


def _is_number(value: ast.expr | None) -> bool:
    return isinstance(value, ast.Constant) and isinstance(value.value, int | float)


@pytest.mark.parametrize("module", MODULES, ids=lambda path: path.stem)
def test_no_module_of_the_rules_decides_by_a_time_of_its_own(module: Path) -> None:
    assert list(times_in(module.read_text())) == []


@pytest.mark.parametrize(
    "source", ["NEAR_S = 0.15", "near_ms: int = 150", "f(near_s=0.1)", "reach = 0.15 * scene.rate"]
)
def test_a_time_that_stands_in_a_module_is_found(source: str) -> None:
    assert list(times_in(source))


def test_times_are_those_of_the_rules() -> None:
    text = rule_file("thresholds.lp").read_text()
    assert f"#const merge_ms = {times().merge_ms}." in text
    assert f"#const flicker_ms = {times().flicker_ms}." in text
    assert in_frames(150, 100.0) == 15.0


def test_borders_that_could_merge_may_not_be_cut_apart() -> None:
    with pytest.raises(RuleError, match="merge_ms <= settled_ms"):
        replace(times(), merge_ms=250, settled_ms=200, margin_ms=1000)
