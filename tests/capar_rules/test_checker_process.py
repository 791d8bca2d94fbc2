"""The process that checks rule files: its limits, and what is said when it reaches them."""

from pathlib import Path

import hostile_rules
import pytest

from capar.model.errors import RuleError
from capar_rules.lint import checking
from capar_rules.lint.checker_process import Request
from capar_rules.lint.checking import answer

LIMITED = """
import sys
sys.path.insert(0, sys.argv[1])
import capar_rules.lint.checker_process as process

def judge(request):
    {judge}

process.CPU_S, process.MEMORY_BYTES, process.findings_of = 1, 1 << 26, judge
process.serve(sys.stdin)
"""
"""A checker whose limits are low, and in which a file does what no rule should manage to do."""


def requests(folder: Path, *texts: str) -> list[Request]:
    paths = [folder / f"file_{number}.lp" for number in range(len(texts))]
    for path, text in zip(paths, texts, strict=True):
        path.write_text(text)
    return [Request((str(path),), "thesis") for path in paths]


@pytest.mark.parametrize(
    ("judge", "reason"),
    [
        ("while True: pass", "it computes for more than"),
        ("return [bytearray(1 << 30)]", "it needs more than"),
        ("return judge(request)", "it needs more than"),
        ("import os; os.kill(os.getpid(), 11)", "breaks the parser"),
        ("import os; os.kill(os.getpid(), 9)", "takes longer than"),
    ],
)
def test_a_file_that_exceeds_a_limit_is_refused_with_the_limit(
    judge, reason, tmp_path, monkeypatch
):
    monkeypatch.setattr(checking, "_START", LIMITED.format(judge=judge))
    asked = requests(tmp_path, "p(1).\n")
    (found,) = answer(asked[0])
    assert (found.code, found.place.file) == ("unbounded", asked[0].files[0])
    assert reason in found.message


def test_a_check_that_takes_too_long_is_ended_from_outside(tmp_path, monkeypatch):
    monkeypatch.setattr(checking, "_START", "import time; time.sleep(60)")
    monkeypatch.setattr(checking, "WALL_S", 0.2)
    (found,) = answer(requests(tmp_path, "p(1).\n")[0])
    assert found.code == "unbounded"
    assert "takes longer than" in found.message


def test_files_after_one_that_breaks_the_parser_are_checked_all_the_same(tmp_path):
    breaking = hostile_rules.BY_HAND["deep_minus"]
    asked = requests(tmp_path, "p(1).\n", breaking, "p(2).\n", breaking)
    codes = [[each.code for each in found] for found in map(answer, asked)]
    assert "unbounded" in codes[1]
    assert codes[3] == codes[1]
    assert codes[0] == codes[2]
    assert "no-primitive" in codes[0]


def test_a_checker_that_fails_by_itself_blames_no_file(tmp_path, monkeypatch):
    monkeypatch.setattr(checking, "_START", "raise SystemExit('out of order')")
    with pytest.raises(RuleError, match="the checker process failed: out of order"):
        answer(requests(tmp_path, "p(1).\n")[0])
