"""The architecture holds: who imports whom, style, types, and what is shipped."""

import ast
import subprocess
import sys
from collections import Counter
from importlib import resources
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BIN = Path(sys.executable).parent
PACKAGES = ("capar", "extractors", "capar_rules", "kb", "ontology")
CHECKS = {
    "imports go one way": ["lint-imports"],
    "the code is formatted": ["ruff", "format", "--check", "."],
    "the code is clean": ["ruff", "check", "."],
    "types hold": ["mypy"],
}


@pytest.mark.long
@pytest.mark.parametrize("check", CHECKS)
def test_the_architecture_and_style_rules_hold(check: str) -> None:
    tool, *arguments = CHECKS[check]
    done = subprocess.run(
        [str(BIN / tool), *arguments], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("package", PACKAGES)
def test_what_is_installed_holds_every_file_of_the_source(package: str) -> None:
    """Rules, words, questions and schemas too, not only Python."""
    installed = Path(str(resources.files(package)))
    kept = {".py", ".lp", ".ttl", ".rq", ".json", ".tsv", ".toml", ".csv", ".obj"}
    kept |= {".css", ".html", ".js"}
    for path in (ROOT / package).rglob("*"):
        if path.suffix in kept and "__pycache__" not in path.parts:
            assert (installed / path.relative_to(ROOT / package)).exists(), path


@pytest.mark.parametrize("package", PACKAGES)
def test_a_constant_of_a_module_is_given_its_value_once(package: str) -> None:
    """Of two the first would say nothing, and whoever changes it would wonder."""
    for path in (ROOT / package).rglob("*.py"):
        body = ast.parse(path.read_text(encoding="utf-8")).body
        targets = [each.targets for each in body if isinstance(each, ast.Assign)]
        names = [each.id for (each, *_) in targets if isinstance(each, ast.Name)]
        assert [name for name, times in Counter(names).items() if times > 1] == [], path
