"""Warm processes that answer for a server: slow ones step aside, and lost ones are replaced.

They are forked from a nursery, ``python -m kb.workers``, which has imported what they need and
ends with the server, however that ends, and all of them with it.
"""

import asyncio
import gc
import os
import pickle
import resource
import signal
import socket
import subprocess
import sys
from collections import deque
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from typing import Any

from kb.errors import BusyError, LostError, TimeLimitError

AT_WORK = STANDING_BY = max(4, 2 * (os.cpu_count() or 1))
"""How many processes answer, and how many take the place of those that step aside."""

AT_ONCE, PROMPT_S = 4, 0.02
"""How many messages a process is sent at once, and until when more than one [s].

Messages behind one that takes longer are given to another process.
"""

SLOW_S = 0.25
"""After this, if others wait, a process steps aside and goes on at a lower priority [s]."""

MOST_ASIDE, NICENESS = AT_WORK, 10
"""How many processes go on aside, and how much they give way; a slow one beyond those is ended."""

MOST_WAITING, LONGEST_WAIT_S = 1024, 1.5
"""How many messages wait for a process, and how long each [s]."""

MOST_REMEMBERED = 1024
"""How many messages that were slow are remembered; sent again, they are answered aside."""

MOST_MEMORY, SPENT_MEMORY = 1 << 30, 512 << 20
"""What a process may allocate, and from what size on it is replaced after its answer [bytes]."""

TICK_S = 0.05
"""How often those that wait and those that answer are looked after [s]."""

Answering = Callable[[bytes], bytes]
Gone = Callable[[], Awaitable[bool]]
"""Whether a client no longer waits for its answer."""


@dataclass(eq=False, slots=True)
class _Asked:
    message: bytes
    gone: Gone | None
    answer: asyncio.Future[bytes]
    since_s: float
    """When it came, by the loop's clock."""


class _Worker(asyncio.Protocol):
    """A process, and the channel to it."""

    def __init__(self, pid: int, heard: Callable[["_Worker"], None]) -> None:
        self.pid, self._heard = pid, heard
        self._data = bytearray()
        self.transport: Any = None
        self.asked: deque[_Asked | None] = deque([None])
        """What it answers in turn; None for its start, and for what another one answers now."""

        self.since_s = 0.0
        """When it began with the first of them, by the loop's clock."""

        self.ready = self.spent = self.lost = False
        self.refusal: BusyError | None = None
        """Why it was ended."""

    def ask(self, asked: _Asked) -> None:
        if not self.asked:
            self.since_s = asyncio.get_running_loop().time()
        self.asked.append(asked)
        self.transport.write(len(asked.message).to_bytes(8) + asked.message)

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = transport

    def data_received(self, data: bytes) -> None:
        self._data += data
        while len(self._data) >= 9:
            end = 9 + int.from_bytes(self._data[:8])
            if len(self._data) < end:
                return
            first = self.asked.popleft()
            if first is not None and not first.answer.done():
                first.answer.set_result(bytes(self._data[9:end]))
            self.spent = not self._data[8]
            del self._data[:end]
            self.ready, self.since_s = True, asyncio.get_running_loop().time()
            self._heard(self)

    def connection_lost(self, _: Exception | None) -> None:
        self.lost = True
        self._heard(self)

    def take_back(self) -> list[_Asked]:
        """What it was sent beside the first, which it is not to answer now."""
        rest = [each for each in islice(self.asked, 1, None) if each is not None]
        self.asked = deque([*islice(self.asked, 1), *[None] * (len(self.asked) - 1)])
        return rest

    def step_aside(self) -> None:
        """Go on at a lower priority."""
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, self.pid, NICENESS)

    def end(self, refusal: BusyError | None = None) -> None:
        """End the process, and so what it answers."""
        self.refusal = self.refusal or refusal
        if not self.lost:
            with suppress(ProcessLookupError):
                os.kill(self.pid, signal.SIGKILL)


class Workers:
    """Processes that answer messages."""

    def __init__(self, begin: Callable[[], Answering], *, seconds: float) -> None:
        """Start them.

        Args:
            begin: What a process does first; it gives what answers in it. It is pickled.
            seconds: How long an answer may take [s]; the system ends a process that takes longer.
        """
        self._begin, self._seconds = begin, seconds
        self._waiting: deque[_Asked] = deque()
        self._workers: set[_Worker] = set()
        self._aside: set[_Worker] = set()
        self._slow: dict[int, None] = {}
        self._alone = asyncio.Lock()
        self._closed = False
        self._nursery()
        self._fresh = [self._started() for _ in range(AT_WORK + STANDING_BY)]

    def _nursery(self) -> None:
        self._control, its = socket.socketpair()
        with its:
            command = [sys.executable, "-P", "-m", "kb.workers"]
            self._process = subprocess.Popen(command, stdin=its.fileno(), start_new_session=True)
        told = pickle.dumps((self._begin, self._seconds))
        self._control.sendall(len(told).to_bytes(8) + told)

    def _started(self, *, limited: bool = True) -> tuple[int, socket.socket]:
        """A new process and the channel to it; from a new nursery, if the old one was ended."""
        if self._process.poll() is not None:
            self._control.close()
            self._nursery()
        ours, its = socket.socketpair()
        pid = 0
        with its, suppress(OSError):
            socket.send_fds(self._control, [bytes([limited])], [its.fileno()])
            pid = int.from_bytes(self._control.recv(8))
        if pid == 0:
            ours.close()
            raise BusyError("no process could be started")
        return pid, ours

    async def _joined(self, pid: int, channel: socket.socket, to: set[_Worker]) -> _Worker:
        worker = _Worker(pid, self._hear)
        to.add(worker)
        await asyncio.get_running_loop().create_unix_connection(lambda: worker, sock=channel)
        return worker

    def close(self) -> None:
        """End them, and so whatever waits for their answers."""
        self._closed = True
        self._control.close()
        self._process.wait()
        for _, channel in self._fresh:
            channel.close()
        for asked in self._waiting:
            if not asked.answer.done():
                asked.answer.set_exception(BusyError(_STOPS))
        for worker in (*self._workers, *self._aside):
            worker.refusal = BusyError(_STOPS)

    async def answer(self, message: bytes, gone: Gone) -> bytes:
        """What a process that is free answers.

        Raises:
            BusyError: None was free in time, or this is slow and too many others are.
            TimeLimitError: It took longer than it may.
            LostError: The process ended.
        """
        if hash(message) in self._slow:
            if len(self._aside) >= MOST_ASIDE:
                raise BusyError(_SLOW)
            return await self._answer_aside(message, gone)
        if len(self._waiting) >= MOST_WAITING:
            raise BusyError(f"{MOST_WAITING} others wait for an answer")
        asked = self._asked(message, gone)
        self._waiting.append(asked)
        self._dispatch()
        return await asked.answer

    async def answer_alone(self, message: bytes) -> bytes:
        """What a new process answers, without a time limit, one after the other.

        Raises:
            LostError: The process ended.
        """
        async with self._alone:
            return await self._answer_aside(message, None)

    async def _answer_aside(self, message: bytes, gone: Gone | None) -> bytes:
        asked = self._asked(message, gone)
        worker = await self._joined(*self._started(limited=gone is not None), self._aside)
        if gone is not None:
            worker.step_aside()
        worker.ask(asked)
        found = await asked.answer
        if asyncio.get_running_loop().time() - asked.since_s < SLOW_S:
            self._slow.pop(hash(message), None)
        return found

    def _asked(self, message: bytes, gone: Gone | None) -> _Asked:
        loop = asyncio.get_running_loop()
        if self._closed:
            raise BusyError(_STOPS)
        return _Asked(message, gone, loop.create_future(), loop.time())

    def _dispatch(self) -> None:
        """Send what waits to those that have least to do, and are prompt at it."""
        now_s = asyncio.get_running_loop().time()
        while self._waiting:
            busy = [each for each in self._workers if each.ready and each.asked]
            free = [
                each
                for each in (busy if len(busy) >= AT_WORK else self._workers)
                if not each.asked
                or (each.ready and len(each.asked) < AT_ONCE and now_s - each.since_s < PROMPT_S)
            ]
            if not free:
                return
            asked = self._waiting.popleft()
            if not asked.answer.done():
                min(free, key=lambda each: len(each.asked)).ask(asked)

    def _hear(self, worker: _Worker) -> None:
        """Go on after a process has answered or ended."""
        if worker.lost:
            self._workers.discard(worker)
            self._aside.discard(worker)
            self._waiting.extendleft(reversed(worker.take_back()))
            first = worker.asked[0] if worker.asked else None
            if first is not None and not first.answer.done():
                took_s = asyncio.get_running_loop().time() - worker.since_s
                late = first.gone is not None and took_s >= self._seconds
                lost = TimeLimitError(self._seconds) if late else LostError(MOST_MEMORY)
                first.answer.set_exception(worker.refusal or lost)
        elif worker.spent or (worker in self._aside and not any(worker.asked)):
            worker.asked.appendleft(None)
            worker.end()
        self._dispatch()

    async def watch(self) -> None:
        """Look after those that wait and those that answer, until it is cancelled."""
        loop = asyncio.get_running_loop()
        fresh, self._fresh = self._fresh, []
        for each in fresh:
            await self._joined(*each, self._workers)
        while True:
            await asyncio.sleep(TICK_S)
            for worker in [*self._workers]:
                if len(worker.asked) > 1 and loop.time() - worker.since_s > PROMPT_S:
                    self._waiting.extendleft(reversed(worker.take_back()))
            while self._waiting and loop.time() - self._waiting[0].since_s > LONGEST_WAIT_S:
                late = self._waiting.popleft()
                if not late.answer.done():
                    late.answer.set_exception(BusyError("others are answered first"))
            for worker in [*self._workers, *self._aside]:
                if worker.asked and worker.ready and loop.time() - worker.since_s > SLOW_S:
                    await self._judge(worker)
            for message in [*self._slow][:-MOST_REMEMBERED]:
                del self._slow[message]
            with suppress(BusyError):  # tried again at the next tick
                while len(self._workers) < AT_WORK + STANDING_BY:
                    await self._joined(*self._started(), self._workers)
            self._dispatch()

    async def _judge(self, worker: _Worker) -> None:
        """Have a slow process step aside, or end it."""
        first = worker.asked[0]
        gone = first is None or (first.gone is not None and await first.gone())
        if first not in islice(worker.asked, 1):
            return  # it has answered meanwhile
        if first is None or gone:
            worker.end()
        elif self._waiting and worker in self._workers:
            self._slow[hash(first.message)] = None
            if len(self._aside) < MOST_ASIDE:
                self._workers.discard(worker)
                self._aside.add(worker)
                worker.step_aside()
            else:
                worker.end(BusyError(_SLOW))


_STOPS = "it stops"
_SLOW = f"this takes long, as do {MOST_ASIDE} others that are being answered"


def _nursery() -> None:
    """Fork a process for each channel that comes, until the server is gone; then end them all."""
    control = socket.socket(fileno=os.dup(sys.stdin.fileno()))
    # Else those that are forked hold the channel open, and the server awaits a killed nursery.
    os.dup2(os.open(os.devnull, os.O_RDONLY), sys.stdin.fileno())
    size = int.from_bytes(control.recv(8, socket.MSG_WAITALL))
    begin, seconds = pickle.loads(control.recv(size, socket.MSG_WAITALL))
    gc.freeze()  # or each process would copy what the collector touches
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # so that those that end are gone at once
    while True:
        limited, channels, *_ = socket.recv_fds(control, 1, 1)
        if not limited:
            signal.signal(signal.SIGTERM, signal.SIG_IGN)
            os.killpg(0, signal.SIGTERM)
            with suppress(ChildProcessError):
                os.wait()
            return
        pid = os.fork()
        if pid == 0:
            break
        os.close(channels[0])
        control.sendall(pid.to_bytes(8))
    control.close()
    _work(socket.socket(fileno=channels[0]), begin, seconds if limited[0] else 0.0)


def _work(channel: socket.socket, begin: Callable[[], Answering], seconds: float) -> None:
    """Answer each message that comes, until the server closes the channel."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    with suppress(ValueError):
        hard = resource.getrlimit(resource.RLIMIT_DATA)[1]
        resource.setrlimit(resource.RLIMIT_DATA, (MOST_MEMORY, hard))
    unit = 1 if sys.platform == "darwin" else 1024
    answer = begin()
    with channel, channel.makefile("rb", 1 << 16) as messages, suppress(BrokenPipeError):
        channel.sendall(_framed(b"", again=True))
        while len(head := messages.read(8)) == 8:
            message = messages.read(int.from_bytes(head))
            signal.setitimer(signal.ITIMER_REAL, seconds)  # its signal ends the process
            found = answer(message)
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            held = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
            channel.sendall(_framed(found, again=held < SPENT_MEMORY))


def _framed(found: bytes, *, again: bool) -> bytes:
    return len(found).to_bytes(8) + bytes([again]) + found


if __name__ == "__main__":
    _nursery()
