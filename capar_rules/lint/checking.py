"""Check rule files in a separate process, which a hostile file can neither harm nor escape."""

import atexit
import json
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path
from tempfile import TemporaryFile
from threading import Lock, Timer
from typing import IO

from capar.model.errors import RuleError
from capar_rules.engine.profiles import DEFAULT, Profile
from capar_rules.engine.profiles import profile as unchecked_profile
from capar_rules.engine.solver import rule_file
from capar_rules.engine.syntax import Place
from capar_rules.lint.checker_process import CPU_S, MEMORY_BYTES, OUT_OF_MEMORY, Request
from capar_rules.lint.findings import Finding, errors

WALL_S = 300.0
"""Limit of elapsed time for each request [s]: ten times that of computing, for a busy machine."""

_START = (
    "import runpy, sys; sys.path.insert(0, sys.argv[1]); "
    "runpy.run_module('capar_rules.lint.checker_process', run_name='__main__')"
)
"""Runs the checker of this very copy of the package; ``-I -m`` would ignore PYTHONPATH."""

END = "null"
"""The line that ends the answer to a request."""

_LOCK = Lock()


def ask(request: str) -> tuple[list[str], int | None, str]:
    """What the checker process writes on a request.

    Returns:
        The lines of the answer; the process's exit code (negative: the signal that ended it) if it
        ended before the answer was complete, else None; and what it wrote to standard error.
    """
    with _LOCK:
        process, remarks = _running(_START, os.getpid())
        if process.poll() is not None:
            _running.cache_clear()
            process, remarks = _running(_START, os.getpid())
        lines, complete = _answer(process, request)
        if complete:
            return lines, None, ""
        ended = process.wait()
        _running.cache_clear()
        remarks.seek(0)
        return lines, ended, remarks.read()


def _answer(process: "subprocess.Popen[str]", request: str) -> tuple[list[str], bool]:
    """The lines of an answer, and whether it is complete."""
    assert process.stdin is not None
    assert process.stdout is not None
    late = Timer(WALL_S, process.kill)
    late.start()
    lines: list[str] = []
    try:
        process.stdin.write(request + "\n")
        process.stdin.flush()
        while (line := process.stdout.readline()).endswith("\n"):
            if line.strip() == END:
                return lines, True
            lines.append(line)
    except BrokenPipeError:
        pass  # it ended before it had read the request
    except BaseException:
        _end(process)  # what it still writes would be taken for the next answer
        raise
    finally:
        late.cancel()
    return lines, False


def _end(process: "subprocess.Popen[str]") -> None:
    process.kill()
    process.communicate()


@cache
def _running(start: str, _owner: int) -> tuple["subprocess.Popen[str]", IO[str]]:
    """A checker of this process and its standard error; a fork starts its own."""
    remarks = TemporaryFile("w+")  # noqa: SIM115 - it lasts as long as the process
    process = subprocess.Popen(
        [sys.executable, "-I", "-c", start, str(rule_file("").parent)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=remarks,
        text=True,
    )
    atexit.register(_end, process)
    return process, remarks


Findings = tuple[Finding, ...]
"""Findings sorted by place, none twice."""


def check(path: Path, *, profile: str = DEFAULT, beside: Sequence[Path] = ()) -> Findings:
    """What is wrong with a rule file; nothing in it is executed.

    Raises:
        RuleError: The checker process failed for a reason other than its limits.
    """
    return answer(Request((str(path),), profile, tuple(map(str, beside)), by_text_alone=False))


def require(path: Path, findings: Sequence[Finding]) -> None:
    """Refuse a file with errors.

    Raises:
        RuleError: There are some; it lists them, one a line.
    """
    wrong = errors(tuple(findings))
    if wrong:
        lines = "\n".join(map(str, wrong))
        raise RuleError(f"{path} does not count:\n{lines}")


def answer(request: Request) -> Findings:
    """The findings for one request; the last one says why, if the process was ended."""
    findings: set[Finding] = set()
    file = request.files[0]
    asked = {"folder": str(Path.cwd()), "request": asdict(request)}
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


HARMLESS = {"no-primitive", "nothing-fits"}
"""Errors of `rules check` that do not keep a file from being loaded: it may only help others."""


def admitted_profile(
    name: str = DEFAULT, *, added: tuple[Path, ...] = (), steady: bool | None = None
) -> Profile:
    """The profile of that name with rule files of users added, each checked by its text first.

    Args:
        name: Of the profile.
        added: Rule files of the user.
        steady: Whether to resolve flicker; None for what is usual in the profile.

    Raises:
        UnknownNameError: There is none.
        RuleError: An added file has an error; nothing in it was executed.
    """
    chosen = unchecked_profile(name, added=added, steady=steady)
    if added:
        admit(added, profile=name)
    return chosen


def admit(files: Sequence[Path], *, profile: str) -> None:
    """Accept rule files that are to be loaded together, unless their text alone shows an error.

    That is syntax, predicates and names, what could run code or read other files, choices,
    negative cycles and unbounded growth. It takes well below a second, in one separate process
    for all files. Checks that ask the solver are left to `capar rules check`.

    Raises:
        RuleError: There is an error; it gives each with file, line, column and remedy.
    """
    if wrong := faults(files, profile=profile):
        lines = "\n".join(map(str, wrong))
        raise RuleError(
            f"rules that cannot count, so nothing was done:\n{lines}\n"
            "Mend them, or take them out of their folder; `capar rules check FILE` says more."
        )


def faults(files: Sequence[Path], *, profile: str) -> tuple[Finding, ...]:
    """The errors that keep rule files from being loaded together, by place."""
    found = answer(Request(tuple(map(str, files)), profile)) if files else ()
    return tuple(each for each in errors(found) if each.code not in HARMLESS)
