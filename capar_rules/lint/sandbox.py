"""A process that checks rule files, each in a child with bounds on time and memory."""

import faulthandler
import json
import os
import resource
import select
import signal
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path

from capar.model.errors import CaparError
from capar_rules.engine.syntax import Place
from capar_rules.lint.findings import Finding, errors
from capar_rules.lint.judging import Told, base_of, judge_one, read_together, whole
from capar_rules.lint.rule_text import Reading
from capar_rules.lint.text_checks import Known
from capar_rules.lint.world_checks import safety_findings, world_findings

CPU_S = 30
"""How long a check may compute [s]: a sound file needs about 5 s, on a slow machine 10 s."""

WALL_S = 90.0
"""How long it may take, beside other work [s]."""

DONE = "done"
"""What a child says last, once it has told everything."""

MEMORY_BYTES = 1 << 30
"""How much it may hold beyond what the process began with [bytes]."""


def serve() -> None:
    """Answer requests, one a line as JSON, once all of them are there."""
    for line in sys.stdin.read().splitlines():
        request = json.loads(line)
        path, beside = Path(request["path"]), [Path(each) for each in request["beside"]]
        base = base_of(request["profile"])
        findings = guarded(path, partial(examine, path, base, beside))
        sys.stdout.write(json.dumps([each.as_json() for each in findings]) + "\n")
        sys.stdout.flush()


def examine(path: Path, base: Known, beside: Sequence[Path]) -> Iterator[Told]:
    """All findings of one file; the solver is asked only where the text gives no error."""
    readings = []
    for each in read_together([path, *beside]):
        if isinstance(each, Path):
            yield each
        else:
            readings.append(each)
            yield from each.findings
    if any(errors(each.findings) for each in readings):
        return
    yield path
    others = {each.resolve() for each in beside}
    for each in readings:
        if Path(each.file).resolve() not in others:
            words = whole(base, (other for other in readings if other is not each))
            found = tuple(judge_one(each, words))
            yield from found
            if errors(found):
                return
    yield from _solved(readings[0], whole(base, readings[1:]))


def _solved(reading: Reading, base: Known) -> Iterator[Finding]:
    """What only the solver can say of a file whose text gives no error."""
    found = tuple(safety_findings(reading.text, reading.file))
    yield from found
    if not errors(found):
        yield from world_findings(reading.statements, base)


def guarded(path: Path, judge: Callable[[], Iterator[Told]]) -> list[Finding]:
    """The findings that a child process states before it ends or is ended.

    Args:
        path: The file that is judged first.
        judge: Tells findings, and each further file that it comes to.
    """
    reader, writer = os.pipe()
    with warnings.catch_warnings():
        # The child asks nothing of the threads that numerical libraries may have begun.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        os.close(reader)
        _work(path, judge, writer)
    os.close(writer)
    text, status = _collect(reader, child)
    lines = text.split("\n")[:-1]
    findings = [Finding.from_json(json.loads(each)) for each in lines if each.startswith("{")]
    if DONE not in lines:
        reached = [json.loads(each) for each in lines if each.startswith('"')]
        findings.append(_exhausted(Path([str(path), *reached][-1]), status))
    return findings


def _work(path: Path, judge: Callable[[], Iterator[Told]], writer: int) -> None:
    try:
        faulthandler.disable()  # a file that breaks the parser is told as a finding, by the parent
        _limit()
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        for each in judge():
            told = str(each) if isinstance(each, Path) else each.as_json()
            os.write(writer, (json.dumps(told) + "\n").encode())
        os.write(writer, f"{DONE}\n".encode())
    except CaparError as error:
        finding = Finding(Place(str(path), 1, 1), "refused", str(error)[:300], "Rewrite it.")
        os.write(writer, (json.dumps(finding.as_json()) + f"\n{DONE}\n").encode())
    except (MemoryError, RecursionError):
        os._exit(3)
    finally:
        os._exit(0)


def _limit() -> None:
    bounds = {
        resource.RLIMIT_CPU: (CPU_S, CPU_S + 1),
        resource.RLIMIT_AS: (_virtual_bytes() + MEMORY_BYTES,) * 2,
        resource.RLIMIT_FSIZE: (0, 0),
        resource.RLIMIT_CORE: (0, 0),
    }
    for kind, (soft, hard) in bounds.items():
        # Not every system knows every bound; an administrator's may be lower already.
        with suppress(ValueError, OSError):
            resource.setrlimit(kind, (soft, hard))


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
