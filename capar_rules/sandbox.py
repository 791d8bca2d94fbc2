"""A process that checks rule files, each in a child with bounds on time and memory."""

import json
import os
import resource
import select
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from capar.model.errors import CaparError
from capar_rules.cycles import cycle_findings
from capar_rules.findings import Finding, errors
from capar_rules.profiles import profile
from capar_rules.reading import Reading, read_rules
from capar_rules.statics import Known, known, static_findings
from capar_rules.syntax import Place, parse
from capar_rules.trials import safety_findings, world_findings

CPU_S = 10
"""How long a check may compute [s]."""

WALL_S = 40.0
"""How long it may take [s]."""

MEMORY_BYTES = 1 << 30
"""How much it may hold beyond what the process began with [bytes]."""


def serve() -> None:
    """Answer requests, one a line as JSON, once all of them are there."""
    bases: dict[str, Known] = {}
    for line in sys.stdin.read().splitlines():
        request = json.loads(line)
        name = request["profile"]
        if name not in bases:
            bases[name] = known(parse(profile(name).files))
        findings = _guarded(Path(request["path"]), bases[name], list(request["beside"]))
        sys.stdout.write(json.dumps([each.as_json() for each in findings]) + "\n")
        sys.stdout.flush()


def examine(path: Path, base: Known, beside: list[str]) -> Iterator[Finding]:
    """All findings of one file; the solver is asked only where the text gives no error."""
    found: list[Finding] = []
    reading = read_rules(path, folders=[Path(each).parent for each in (*beside, str(path))])
    found += reading.findings
    yield from reading.findings
    if errors(tuple(found)):
        return
    others = parse([Path(each) for each in beside])
    whole = known([*base.rules, *others])
    for stage in (_static, _safe, _acyclic, _in_worlds):
        for each in stage(reading, whole):
            found.append(each)
            yield each
        if errors(tuple(found)):
            return


def _static(reading: Reading, base: Known) -> Iterator[Finding]:
    return static_findings(reading.statements, base, file=reading.file)


def _safe(reading: Reading, base: Known) -> Iterator[Finding]:
    return safety_findings(reading.text, reading.file)


def _acyclic(reading: Reading, base: Known) -> Iterator[Finding]:
    return cycle_findings(reading.statements, base.rules)


def _in_worlds(reading: Reading, base: Known) -> Iterator[Finding]:
    return world_findings(reading.statements, base)


def _guarded(path: Path, base: Known, beside: list[str]) -> list[Finding]:
    """The findings that a child process states before it ends or is ended."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reader)
        _work(path, base, beside, writer)
    os.close(writer)
    text, status = _collect(reader, child)
    lines = text.splitlines()
    findings = [Finding.from_json(json.loads(each)) for each in lines if each.startswith("{")]
    if "done" not in lines:
        findings.append(_exhausted(path, status))
    return findings


def _work(path: Path, base: Known, beside: list[str], writer: int) -> None:
    _limit()
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    try:
        for each in examine(path, base, beside):
            os.write(writer, (json.dumps(each.as_json()) + "\n").encode())
        os.write(writer, b"done\n")
    except CaparError as error:
        finding = Finding(Place(str(path), 1, 1), "refused", str(error)[:300], "Rewrite it.")
        os.write(writer, (json.dumps(finding.as_json()) + "\ndone\n").encode())
    except (MemoryError, RecursionError):
        os._exit(3)
    finally:
        os._exit(0)


def _limit() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S + 1))
    used = _virtual_bytes()
    resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY_BYTES,) * 2)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _virtual_bytes() -> int:
    status = Path("/proc/self/statm")
    pages = int(status.read_text().split()[0]) if status.exists() else 1 << 18
    return pages * resource.getpagesize()


def _collect(reader: int, child: int) -> tuple[str, int]:
    """What the child wrote, and how it ended."""
    end = time.monotonic() + WALL_S
    chunks: list[bytes] = []
    while select.select([reader], [], [], max(end - time.monotonic(), 0.0))[0]:
        chunk = os.read(reader, 1 << 16)
        if not chunk:
            break
        chunks.append(chunk)
    else:
        os.kill(child, signal.SIGKILL)
    os.close(reader)
    _, status = os.waitpid(child, 0)
    return b"".join(chunks).decode(), status


def _exhausted(path: Path, status: int) -> Finding:
    ended = os.waitstatus_to_exitcode(status)
    why = {
        -signal.SIGXCPU: f"it computes for more than {CPU_S} s",
        -signal.SIGKILL: f"it takes longer than {WALL_S:.0f} s or more memory than there is",
    }.get(ended, f"it needs more than {MEMORY_BYTES >> 20} MB, or breaks the parser")
    return Finding(
        Place(str(path), 1, 1), "unbounded", f"the check was ended: {why}.",
        "Bound every number and every recursion by a measurement.",
    )  # fmt: skip


if __name__ == "__main__":
    serve()
