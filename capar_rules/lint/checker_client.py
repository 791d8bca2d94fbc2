"""The parent's side of the checker process: one is started when needed, and asked until it ends."""

import atexit
import os
import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from tempfile import TemporaryFile
from threading import Lock, Timer
from typing import IO

from capar_rules.engine.solver import rule_file

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


@dataclass(frozen=True)
class _Checker:
    """A checker process that waits for requests, and where it writes its remarks."""

    process: "subprocess.Popen[str]"
    remarks: IO[str]

    def answer(self, request: str) -> tuple[list[str], int | None]:
        """The lines of an answer, and the exit code if the process ended instead of answering."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        late = Timer(WALL_S, self.process.kill)
        late.start()
        lines: list[str] = []
        try:
            self.process.stdin.write(request + "\n")
            self.process.stdin.flush()
            while (line := self.process.stdout.readline()).endswith("\n"):
                if line.strip() == END:
                    return lines, None
                lines.append(line)
        except BrokenPipeError:
            pass  # it ended before it had read the request
        except BaseException:
            self.end()  # what it still writes would be taken for the next answer
            raise
        finally:
            late.cancel()
        return lines, self.process.wait()

    def end(self) -> None:
        """End the process, whatever it does."""
        self.process.kill()
        self.process.communicate()


def ask(request: str) -> tuple[list[str], int | None, str]:
    """What the checker process writes on a request.

    Args:
        request: A request as JSON, in one line.

    Returns:
        The lines of the answer; the process's exit code (negative: the signal that ended it) if it
        ended before the answer was complete, else None; and what it remarked.
    """
    with _LOCK:
        checker = _running(_START, os.getpid())
        if checker.process.poll() is not None:
            _running.cache_clear()
            checker = _running(_START, os.getpid())
        lines, ended = checker.answer(request)
        if ended is None:
            return lines, None, ""
        _running.cache_clear()
        checker.remarks.seek(0)
        return lines, ended, checker.remarks.read()


@cache
def _running(start: str, _owner: int) -> _Checker:
    """A process of this one; a copy of this process that was forked starts its own."""
    remarks = TemporaryFile("w+")  # noqa: SIM115 - it lasts as long as the process
    process = subprocess.Popen(
        [sys.executable, "-I", "-c", start, str(rule_file("").parent)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=remarks,
        text=True,
    )
    checker = _Checker(process, remarks)
    atexit.register(checker.end)
    return checker
