"""The checker process: reads requests, checks rule files within limits, writes messages.

Input: one request a line, as JSON, with the folder that its paths start from. Output: one JSON
value a line: a string is the file that is checked next, an object is a finding, ``null`` ends the
answer to a request. A file that exceeds a limit or crashes the parser ends the process;
``checker_client.py`` starts another for the next.
"""

import json
import os
import resource
import sys
import time
from collections.abc import Iterable
from contextlib import suppress
from math import ceil
from pathlib import Path

from capar.model.errors import CaparError
from capar_rules.engine.syntax import Place
from capar_rules.lint.file_checks import Message, Request, base_of, findings_of
from capar_rules.lint.findings import Finding

CPU_S = 30
"""Limit of processor time of one request [s]: a sound file needs 2 to 4 s, at most 10 s."""

MEMORY_BYTES = 1 << 30
"""Limit of memory beyond what the process holds when it has read the rule base [bytes]."""

OUT_OF_MEMORY = 3
"""Exit code of a process that has reached its limit of memory, or of recursion."""


def serve(lines: Iterable[str]) -> None:
    """Answer requests on standard output, each as it comes."""
    for line in lines:
        asked = json.loads(line)
        os.chdir(asked["folder"])
        request = Request.from_json(asked["request"])
        base_of(request.profile)
        _limit_memory()
        _limit_time()
        try:
            answer(request)
        except (MemoryError, RecursionError):
            sys.exit(OUT_OF_MEMORY)


def answer(request: Request) -> None:
    """Write the messages of one request."""
    try:
        for message in findings_of(request):
            _write(message)
    except CaparError as error:
        place = Place(request.files[0], 1, 1)
        _write(Finding(place, "refused", str(error)[:300], "Rewrite it."))
    _write(None)


def _write(message: Message | None) -> None:
    value = message.as_json() if isinstance(message, Finding) else message and str(message)
    sys.stdout.write(json.dumps(value) + "\n")
    sys.stdout.flush()


def _limit_memory() -> None:
    _limit(resource.RLIMIT_AS, _virtual_bytes() + MEMORY_BYTES)
    _limit(resource.RLIMIT_FSIZE, 0)
    _limit(resource.RLIMIT_CORE, 0)


def _limit_time() -> None:
    _limit(resource.RLIMIT_CPU, ceil(time.process_time()) + CPU_S)


def _limit(kind: int, value: int) -> None:
    """Set the soft limit, which can be moved for the next request."""
    _, hard = resource.getrlimit(kind)
    # Not every system knows every limit, and an administrator's may be lower already.
    with suppress(ValueError, OSError):
        resource.setrlimit(kind, (value, hard))


def _virtual_bytes() -> int:
    status = Path("/proc/self/statm")
    pages = int(status.read_text().split()[0]) if status.exists() else 1 << 18
    return pages * resource.getpagesize()


if __name__ == "__main__":
    serve(sys.stdin)
