"""Check rule files in a separate process, which a hostile file can neither harm nor escape."""

import json
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from capar.model.errors import RuleError
from capar_rules.engine.profiles import DEFAULT
from capar_rules.engine.solver import rule_file
from capar_rules.engine.syntax import Place
from capar_rules.lint.checker_process import CPU_S, MEMORY_BYTES, OUT_OF_MEMORY
from capar_rules.lint.file_checks import Request
from capar_rules.lint.findings import Finding, errors

Findings = tuple[Finding, ...]
"""Findings sorted by place, none twice."""

WALL_S = 300.0
"""Limit of elapsed time for each request [s]: ten times that of computing, for a busy machine."""

_START = (
    "import runpy, sys; sys.path.insert(0, sys.argv[1]); "
    "runpy.run_module('capar_rules.lint.checker_process', run_name='__main__')"
)
"""Runs the checker of this very copy of the package; ``-I -m`` would ignore PYTHONPATH."""


def check(path: Path, *, profile: str = DEFAULT, beside: Sequence[Path] = ()) -> Findings:
    """What is wrong with a rule file; nothing in it is executed.

    Args:
        path: The file.
        profile: The rule base that it would join.
        beside: Other rule files of the user that it would stand beside.
    """
    return check_all([path], profile=profile, beside=beside)[0]


def check_all(
    paths: Sequence[Path], *, profile: str = DEFAULT, beside: Sequence[Path] = ()
) -> list[Findings]:
    """The same for many files, each by itself, in order."""
    others = tuple(map(str, beside))
    return answers([Request((str(path),), profile, others, by_text_alone=False) for path in paths])


def answers(requests: Sequence[Request]) -> list[Findings]:
    """The findings for each request, in order, from as few processes as possible.

    Raises:
        RuleError: The checker process failed for a reason other than its limits.
    """
    found: list[Findings] = []
    while len(found) < len(requests):
        found += _answers_of_one_process(requests[len(found) :])
    return found


def require(path: Path, findings: Sequence[Finding]) -> None:
    """Refuse a file with errors.

    Raises:
        RuleError: There are some; it lists them, one a line.
    """
    wrong = errors(tuple(findings))
    if wrong:
        lines = "\n".join(map(str, wrong))
        raise RuleError(f"{path} does not count:\n{lines}")


def _answers_of_one_process(requests: Sequence[Request]) -> list[Findings]:
    """The answers of a process until it ends; the last one says why, if it was ended."""
    output, ended, remarks = _run(requests)
    answered: list[Findings] = []
    findings: set[Finding] = set()
    file = requests[0].files[0]
    for message in map(json.loads, output.split("\n")[:-1]):
        if isinstance(message, str):
            file = message
        elif message:
            findings.add(Finding.from_json(message))
        else:
            answered.append(tuple(sorted(findings)))
            findings, file = set(), requests[len(answered) % len(requests)].files[0]
    if len(answered) < len(requests):
        if ended >= 0 and ended != OUT_OF_MEMORY:
            raise RuleError(f"the checker process failed: {remarks.strip()[-300:]}")
        answered.append(tuple(sorted({*findings, _exceeded(file, ended)})))
    return answered


def _run(requests: Sequence[Request]) -> tuple[str, int, str]:
    """Output, exit code (negative: the signal that ended it) and remarks of a checker process."""
    lines = [json.dumps(request.as_json()) for request in requests]
    root = str(rule_file("").parent)
    try:
        done = subprocess.run(
            [sys.executable, "-I", "-c", _START, root],
            input="\n".join(lines),
            capture_output=True,
            text=True,
            check=False,
            timeout=WALL_S * len(requests),
        )
    except subprocess.TimeoutExpired as late:
        output = late.stdout or b""
        return output.decode() if isinstance(output, bytes) else output, -signal.SIGKILL, ""
    return done.stdout, done.returncode, done.stderr


def _exceeded(file: str, ended: int) -> Finding:
    why = {
        -signal.SIGXCPU: f"it computes for more than {CPU_S} s",
        -signal.SIGKILL: f"it takes longer than {WALL_S:.0f} s or more memory than there is",
    }.get(ended, f"it needs more than {MEMORY_BYTES >> 20} MB, or breaks the parser")
    return Finding(
        Place(file, 1, 1), "unbounded", f"the check was ended: {why}.",
        "Bound every number and every recursion by a measurement.",
    )  # fmt: skip
