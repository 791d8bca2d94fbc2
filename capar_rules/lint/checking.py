"""Rule files checked before they count, in a process of their own that can come to no harm."""

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from capar.model.errors import RuleError
from capar_rules.engine.profiles import DEFAULT
from capar_rules.lint.findings import Finding, errors


def check(
    path: Path, *, profile: str = DEFAULT, beside: Sequence[Path] = ()
) -> tuple[Finding, ...]:
    """What is wrong with a rule file; nothing of it is run.

    Args:
        path: The file.
        profile: The rule base that it would join.
        beside: Other rule files of the user's that it would stand beside.
    """
    return check_all([path], profile=profile, beside=beside)[0]


def check_all(
    paths: Sequence[Path], *, profile: str = DEFAULT, beside: Sequence[Path] = ()
) -> list[tuple[Finding, ...]]:
    """The same for many files, each by itself, in order."""
    requests = [
        json.dumps(
            {"path": str(path), "profile": profile, "beside": [str(each) for each in beside]}
        )
        for path in paths
    ]
    done = subprocess.run(
        [sys.executable, "-I", "-m", "capar_rules.lint.sandbox"],
        input="\n".join(requests) + "\n",
        capture_output=True,
        text=True,
        check=False,
    )
    answers = done.stdout.splitlines()
    if len(answers) != len(paths):
        raise RuleError(f"the checking process failed: {done.stderr.strip()[-300:]}")
    return [
        tuple(sorted({Finding.from_json(each) for each in json.loads(line)})) for line in answers
    ]


def require(path: Path, findings: Sequence[Finding]) -> None:
    """Refuse a file with errors.

    Raises:
        RuleError: There are some; it lists them, one a line.
    """
    wrong = errors(tuple(findings))
    if wrong:
        lines = "\n".join(map(str, wrong))
        raise RuleError(f"{path} does not count:\n{lines}")
