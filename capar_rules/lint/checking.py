"""Check rule files in a separate process, which a hostile file can neither harm nor escape."""

import json
import signal
from collections.abc import Sequence
from pathlib import Path

from capar.model.errors import RuleError
from capar_rules.engine.profiles import DEFAULT
from capar_rules.engine.syntax import Place
from capar_rules.lint.checker_client import WALL_S, ask
from capar_rules.lint.checker_process import CPU_S, MEMORY_BYTES, OUT_OF_MEMORY
from capar_rules.lint.file_checks import Request
from capar_rules.lint.findings import Finding, errors

Findings = tuple[Finding, ...]
"""Findings sorted by place, none twice."""


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
    """The findings for each request, in order.

    Raises:
        RuleError: The checker process failed for a reason other than its limits.
    """
    return [_answer(request) for request in requests]


def require(path: Path, findings: Sequence[Finding]) -> None:
    """Refuse a file with errors.

    Raises:
        RuleError: There are some; it lists them, one a line.
    """
    wrong = errors(tuple(findings))
    if wrong:
        lines = "\n".join(map(str, wrong))
        raise RuleError(f"{path} does not count:\n{lines}")


def _answer(request: Request) -> Findings:
    """The findings for one request; the last one says why, if the process was ended."""
    findings: set[Finding] = set()
    file = request.files[0]
    asked = {"folder": str(Path.cwd()), "request": request.as_json()}
    messages, ended, remarks = ask(json.dumps(asked))
    for message in map(json.loads, messages):
        if isinstance(message, str):
            file = message
        else:
            findings.add(Finding.from_json(message))
    if ended is not None:
        if ended >= 0 and ended != OUT_OF_MEMORY:
            raise RuleError(f"the checker process failed: {remarks.strip()[-300:]}")
        findings.add(_exceeded(file, ended))
    return tuple(sorted(findings))


def _exceeded(file: str, ended: int) -> Finding:
    why = {
        -signal.SIGXCPU: f"it computes for more than {CPU_S} s",
        -signal.SIGKILL: f"it takes longer than {WALL_S:.0f} s or more memory than there is",
    }.get(ended, f"it needs more than {MEMORY_BYTES >> 20} MB, or breaks the parser")
    return Finding(
        Place(file, 1, 1), "unbounded", f"the check was ended: {why}.",
        "Bound every number and every recursion by a measurement. If they are, the rules that "
        "count beside it ask too much of the worlds of the audit: check it without them, "
        "--rules EMPTY_FOLDER.",
    )  # fmt: skip
