"""Work on a long capture shared between processor cores, with the results that one core gives."""

import gc
import os
import pickle
import select
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from typing import Any, NoReturn, TypeVar

from capar.model.errors import CaparError

CORES = "CAPAR_CORES"
"""The environment variable with the number of processor cores to use; 1 starts no process."""

MOST_CORES = 2
"""As many are used at most where it says nothing [1]: each takes memory of its own."""

LONG_FRAMES = 6000
"""Captures of fewer frames are measured by one core: to start a process and to send back what it
found takes 0.05 s, and to measure a minute at 100 Hz 1.5 s."""

PATIENCE, PATIENCE_S = 3.0, 10.0
"""Another core may take so many times as long as this one has, and so much longer [s]; then this
one does its tasks, too. A process that was split off cannot be trusted to end: it has copies of
locks, and lacks the threads that would have released them."""

_Result = TypeVar("_Result")


def shared(tasks: Sequence[Callable[[], Iterable[_Result]]], frames: int) -> list[list[_Result]]:
    """What each of some independent tasks yields, in their order.

    Each core takes the next task that no other has taken. Other cores are processes that are split
    off for these tasks (fork), see all that this one has, and end with them; what they keep besides
    the results is lost. Whatever a process fails at this one does itself. None is split off where
    the capture is short, in a thread or a worker process of somebody else's, and outside of Linux.

    ``frames``: length of the capture.

    Raises:
        CaparError: The environment variable CAPAR_CORES is no number above zero.
    """
    others = min(cores(), len(tasks)) - 1 if frames >= LONG_FRAMES and _may_fork() else 0
    if others < 1:
        return [list(task()) for task in tasks]
    done: dict[int, list[_Result]] = {}
    queue = _queue(min(len(tasks), MOST_TURNS))
    children: list[tuple[int, int]] = []
    try:
        with suppress(OSError):  # No more processes may be started.
            for _ in range(others):
                children.append(_split_off(queue, tasks))
        began = time.monotonic()
        done.update(_taken(queue, tasks))
        patience_s = PATIENCE_S + PATIENCE * (time.monotonic() - began)
        for _, results in children:
            done |= _received(results, patience_s)
    finally:
        os.close(queue)
        for pid, results in children:
            os.close(results)
            with suppress(ProcessLookupError, ChildProcessError):  # Somebody else awaited it.
                os.kill(pid, signal.SIGKILL)
                os.waitpid(pid, 0)
    return [done[index] if index in done else list(task()) for index, task in enumerate(tasks)]


def cores() -> int:
    """How many processor cores are used for a long capture [1]."""
    stated = os.environ.get(CORES, "")
    if not stated:
        return min(MOST_CORES, len(os.sched_getaffinity(0)))
    if not stated.isdecimal() or int(stated) < 1:
        raise CaparError(f"{CORES} is {stated!r}; expected a number of processor cores, 1 or more")
    return int(stated)


def _may_fork() -> bool:
    if sys.platform != "linux" or threading.current_thread() is not threading.main_thread():
        return False
    # Several captures are then observed at once, each by a core.
    process = sys.modules.get("multiprocessing.process")
    return process is None or process.parent_process() is None


MOST_TURNS, TURN_BYTES = 2048, 2
"""Cores take so many turns at most [1], each told by so many bytes: any pipe holds 4,096 of them
without a reader. Of more tasks several are done in a turn."""


def _queue(turns: int) -> int:
    """A pipe from which each core reads its next turn; they are written beforehand."""
    queue, write = os.pipe()
    os.write(write, b"".join(turn.to_bytes(TURN_BYTES, "big") for turn in range(turns)))
    os.close(write)
    return queue


def _taken(
    queue: int,
    tasks: Sequence[Callable[[], Iterable[_Result]]],
    parent: int | None = None,
) -> Iterator[tuple[int, list[_Result]]]:
    """The results of the tasks that this core takes, by index, as long as the parent lives."""
    turns = min(len(tasks), MOST_TURNS)
    while parent in (None, os.getppid()) and (turn := os.read(queue, TURN_BYTES)):
        for index in range(int.from_bytes(turn, "big"), len(tasks), turns):
            yield index, list(tasks[index]())


def _split_off(queue: int, tasks: Sequence[Callable[[], Iterable[_Result]]]) -> tuple[int, int]:
    """Another process that takes tasks; its number, and the pipe in which its results arrive."""
    results, write = os.pipe()
    parent = os.getpid()
    ends = {signal.SIGINT, signal.SIGTERM}
    # The child must not run what this process does on them, nor come back from here.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ends)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of threads: hence the patience
            pid = os.fork()
        if pid == 0:
            _serve(queue, write, tasks, parent)
    except OSError:
        os.close(results)
        raise
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        os.close(write)
    return pid, results


def _serve(
    queue: int, write: int, tasks: Sequence[Callable[[], Iterable[_Result]]], parent: int
) -> NoReturn:
    """Take tasks, send their results and end; without results where one of them fails."""
    try:
        for each in (signal.SIGINT, signal.SIGTERM):
            signal.signal(each, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT, signal.SIGTERM})
        gc.freeze()  # A collection would copy the pages of all that is there.
        found = pickle.dumps(dict(_taken(queue, tasks, parent)), pickle.HIGHEST_PROTOCOL)
        with os.fdopen(write, "wb") as out:
            out.write(found)
    finally:
        os._exit(0)


def _received(results: int, patience_s: float) -> dict[int, list[Any]]:
    """What a process has sent; nothing if it ended without, or sends nothing for so long [s]."""
    parts: list[bytes] = []
    arrives = select.poll()
    arrives.register(results, select.POLLIN)
    while arrives.poll(1000.0 * patience_s):
        part = os.read(results, 1 << 20)
        if not part:
            break
        parts.append(part)
    try:
        found: dict[int, list[Any]] = pickle.loads(b"".join(parts))
    except (EOFError, pickle.UnpicklingError):
        return {}
    return found
