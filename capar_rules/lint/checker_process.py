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
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from math import ceil
from pathlib import Path

from capar.model.errors import CaparError
from capar_rules.engine.profiles import profile as shipped
from capar_rules.engine.syntax import Place, parse
from capar_rules.lint.findings import Finding, errors, unsafe_findings
from capar_rules.lint.text_checks import (
    Known,
    Reading,
    cycle_findings,
    growth_findings,
    known,
    read_rules,
    static_findings,
)
from capar_rules.lint.word_checks import fitting_findings, single_findings, slip_findings
from capar_rules.lint.world_checks import world_findings

Message = Finding | Path
"""What a check yields: a finding, or the file that it turns to next."""


@dataclass(frozen=True, slots=True)
class Request:
    """Rule files to check together."""

    files: tuple[str, ...]
    """Paths of the files to check; files that they include are checked with them."""

    profile: str
    """Name of the rule base that they join."""

    beside: tuple[str, ...] = ()
    """Paths of other rule files of the user that are loaded too; only their syntax is checked."""

    by_text_alone: bool = True
    """Whether to leave out the checks that ask the solver, which take seconds."""


@cache
def base_of(profile: str) -> Known:
    """The vocabulary of the rule base of a profile."""
    return known(parse(shipped(profile).files))


def findings_of(request: Request) -> Iterator[Message]:
    """Check rule files; each stage runs only if the stages before found no error."""
    base = base_of(request.profile)
    beside = {Path(each).resolve() for each in request.beside}
    readings = []
    for message in read_all(map(Path, (*request.files, *request.beside))):
        if isinstance(message, Path):
            yield message
        else:
            readings.append(message)
            yield from message.findings
    if any(errors(reading.findings) for reading in readings):
        return
    sound = True
    for reading in readings:
        if Path(reading.file).resolve() not in beside:
            yield Path(reading.file)
            added = [rule for each in readings if each is not reading for rule in each.statements]
            found = tuple(text_findings(reading, known([*base.rules, *added]) if added else base))
            sound = sound and not errors(found)
            yield from found
    if sound and not request.by_text_alone:
        first, *others = readings
        yield Path(first.file)
        found = tuple(unsafe_findings(first.text, first.file, ground=True))
        yield from found
        if not errors(found):
            rules = [rule for each in others for rule in each.statements]
            yield from world_findings(first.statements, base, rules)


def read_all(paths: Iterable[Path]) -> Iterator[Reading | Path]:
    """Read rule files and all that they include, each once; before each, its path."""
    waiting = list(paths)
    folders = sorted({path.parent for path in waiting})
    seen: set[Path] = set()
    for path in waiting:
        if path.resolve() not in seen:
            seen.add(path.resolve())
            yield path
            reading = read_rules(path, folders=folders)
            waiting += reading.included
            yield reading


def text_findings(reading: Reading, base: Known) -> Iterator[Finding]:
    """What is wrong with one file by its text alone; a stage with errors is the last."""
    own = reading.statements
    stages = (
        (*static_findings(own, base, file=reading.file), *slip_findings(own, base)),
        unsafe_findings(reading.text, reading.file),
        growth_findings(own),
        cycle_findings(own, base.rules),
        (*fitting_findings(own, base), *single_findings(own)),
    )
    for stage in stages:
        found = tuple(stage)
        yield from found
        if errors(found):
            return


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
        request = Request(**asked["request"])
        base_of(request.profile)
        status = Path("/proc/self/statm")
        pages = int(status.read_text().split()[0]) if status.exists() else 1 << 18
        _limit(resource.RLIMIT_AS, pages * resource.getpagesize() + MEMORY_BYTES)
        _limit(resource.RLIMIT_FSIZE, 0)
        _limit(resource.RLIMIT_CORE, 0)
        _limit(resource.RLIMIT_CPU, ceil(time.process_time()) + CPU_S)
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


def _limit(kind: int, value: int) -> None:
    """Set the soft limit, which can be moved for the next request."""
    _, hard = resource.getrlimit(kind)
    # Not every system knows every limit, and an administrator's may be lower already.
    with suppress(ValueError, OSError):
        resource.setrlimit(kind, (value, hard))


if __name__ == "__main__":
    serve(sys.stdin)
