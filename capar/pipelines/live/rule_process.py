"""Rules that are asked for hours without memory that grows.

The solver frees no term that it ever saw, and every frame has terms of its own: within an hour they
would fill some hundred megabytes. So a process of its own is asked, which another one replaces in
time. The first minutes need none: to start one takes as long as some answers.

Run as a program this module is such a worker: a pickled profile comes in, then one pickled list of
facts after the other; for each list the pickled answer goes out, or the error that it raised.
"""

import pickle
import subprocess
import sys
import weakref
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from threading import Thread

import capar
from capar.model.errors import CaparError
from capar.model.facts import Fact
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import Profile
from capar_rules.pars.inference import Inference, infer

OWN_ASKS = 400  # So often this process asks the rules itself [1]: in three minutes or more.
ASKS = 800
"""So often a worker is asked before another one takes over [1]: some ten megabytes of terms."""

AHEAD = 40  # The next worker is started so many questions before [1]: in twenty seconds or so.
WARMING = 3  # Who has answered so often has read the rules for good [1].

_START = (
    "import runpy, sys; sys.path.insert(0, sys.argv[1]); "
    "runpy.run_module('capar.pipelines.live.rule_process', run_name='__main__')"
)
"""Runs the worker of this very copy of the package, from wherever that was imported."""


def inferred(facts: Sequence[Fact], rules: Profile) -> Inference:
    """What rules say of facts, their flicker resolved as the profile has it.

    Raises:
        RuleError: The rules have a fault, or not exactly one answer.
    """
    return infer(steady(facts) if rules.steady else tuple(facts), profile=rules)


class RuleProcess:
    """Answers what rules say of facts, from this process or from workers that follow each other.

    Args:
        rules: The rule base.
        own_asks: How often this process answers itself, at first.
        asks: How often each worker is asked.
    """

    def __init__(self, rules: Profile, *, own_asks: int = OWN_ASKS, asks: int = ASKS) -> None:
        self._rules = rules
        self._left = own_asks
        self._asks = asks
        self._worker: _Worker | None = None
        self._next: _Worker | None = None

    @property
    def worker(self) -> int | None:
        """The number of the worker's process; None while this process answers itself."""
        return self._worker.process.pid if self._worker else None

    def warm(self, facts: Sequence[Fact]) -> None:
        """Read the rules for good, so that no later question waits for it; the answers are left.

        Raises:
            RuleError: The rules have a fault.
        """
        for _ in range(WARMING):
            inferred(facts, self._rules)

    def ask(self, facts: Sequence[Fact]) -> Inference:
        """What the rules say of facts.

        Raises:
            RuleError: The rules have a fault, or not exactly one answer.
        """
        if self._left <= AHEAD and self._next is None:
            self._next = _Worker(self._rules, facts)
        if self._left <= 0 and self._next is not None:
            self._end_worker()
            self._worker, self._next, self._left = self._next, None, self._asks
            self._worker.warming.join()
        self._left -= 1
        if self._worker is not None:
            try:
                return self._worker.answer(facts)
            except _EndedError:
                # Until another one takes over, this process answers itself; for good, if none can
                # be started here.
                starts = self._worker.answered
                self._end_worker()
                self._left = min(self._left, AHEAD) if starts else sys.maxsize
        return inferred(facts, self._rules)

    def close(self) -> None:
        """End the workers; this process answers what is asked then."""
        self._end_worker()
        self._worker, self._next = self._next, None
        self._end_worker()
        self._left = sys.maxsize

    def _end_worker(self) -> None:
        if self._worker is not None:
            self._worker.warming.join()
            self._worker.end()
        self._worker = None


class _EndedError(Exception):
    """A worker has ended by itself."""


class _Worker:
    """A process that answers; it reads the rules for good aside, until ``warming`` has ended."""

    def __init__(self, rules: Profile, facts: Sequence[Fact]) -> None:
        # In a session of its own: who interrupts this process still wants its last answer.
        command = [sys.executable, "-P", "-c", _START, str(Path(capar.__file__).parents[1])]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True
        )
        self.answered = False
        self.end = weakref.finalize(self, _end, self.process)
        self.warming = Thread(target=self._warm, args=(rules, tuple(facts)), daemon=True)
        self.warming.start()

    def _warm(self, rules: Profile, facts: Sequence[Fact]) -> None:
        with suppress(CaparError, _EndedError, BrokenPipeError):
            self._send(rules)
            for _ in range(WARMING):
                self.answer(facts)

    def answer(self, facts: Sequence[Fact]) -> Inference:
        assert self.process.stdout is not None
        try:
            self._send(tuple(facts))
            answer = pickle.load(self.process.stdout)
            self.answered = True
        except (EOFError, BrokenPipeError, pickle.UnpicklingError):
            raise _EndedError from None
        if isinstance(answer, CaparError):
            raise answer
        assert isinstance(answer, Inference)
        return answer

    def _send(self, value: object) -> None:
        assert self.process.stdin is not None
        pickle.dump(value, self.process.stdin, protocol=pickle.HIGHEST_PROTOCOL)
        self.process.stdin.flush()


def _end(process: "subprocess.Popen[bytes]") -> None:
    assert process.stdin is not None and process.stdout is not None
    with suppress(BrokenPipeError):
        process.stdin.close()
    process.stdout.close()
    process.wait()


def _serve() -> None:
    """Answer until nothing more is asked."""
    asked, answered = sys.stdin.buffer, sys.stdout.buffer
    rules: Profile = pickle.load(asked)
    with suppress(EOFError):
        while True:
            facts: Sequence[Fact] = pickle.load(asked)
            answer: Inference | CaparError
            try:
                answer = inferred(facts, rules)
            except CaparError as error:
                answer = error
            pickle.dump(answer, answered, protocol=pickle.HIGHEST_PROTOCOL)
            answered.flush()


if __name__ == "__main__":
    _serve()
