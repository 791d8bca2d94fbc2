"""Rules that are asked for hours without memory that grows.

The solver frees no term that it ever saw, and every frame has terms of its own: within an hour they
would fill some hundred megabytes. So a process of its own is asked, which another one replaces in
time. The first minutes need none: to start one takes as long as some answers.
"""

import signal
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from multiprocessing import get_context
from types import ModuleType

from capar.model.errors import CaparError
from capar.model.facts import Fact
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import Profile
from capar_rules.pars.inference import Inference, infer

OWN_ASKS = 400  # So often this process asks the rules itself [1]: in three minutes or more.
ASKS = 800  # So often a worker is asked before another one replaces it [1]: some ten megabytes.
AHEAD = 40  # The next worker is started so many questions before [1]: in twenty seconds or so.
WARMING = 3  # Who has answered so often has read the rules for good [1].


def inferred(facts: Sequence[Fact], rules: Profile) -> Inference:
    """What rules say of facts, their flicker resolved as the profile has it.

    Raises:
        RuleError: The rules have a fault, or not exactly one answer.
    """
    return infer(steady(facts) if rules.steady else tuple(facts), profile=rules)


class RuleProcess:
    """Answers what rules say of facts, from this process or from workers that follow each other."""

    def __init__(self, rules: Profile, *, own_asks: int = OWN_ASKS, asks: int = ASKS) -> None:
        self._rules = rules
        self._left = own_asks
        self._asks = asks
        self._worker: ProcessPoolExecutor | None = None
        self._next: ProcessPoolExecutor | None = None

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
            self._next = _worker(self._rules, tuple(facts))
        if self._left <= 0 and self._next is not None:
            self._end_worker()
            self._worker, self._next, self._left = self._next, None, self._asks
        self._left -= 1
        if self._worker is not None:
            try:
                return self._worker.submit(inferred, tuple(facts), self._rules).result()
            except BrokenProcessPool:
                # Until another one takes over, this process answers itself; for good, if none can
                # be started here.
                starts = self._left < self._asks - 1
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
            self._worker.shutdown()
        self._worker = None


def _worker(rules: Profile, facts: Sequence[Fact]) -> ProcessPoolExecutor:
    """A worker in a new interpreter, as a fork would keep the terms of this one.

    It starts at its first task, while this process has no main module to show: else it would run a
    user's script from its beginning.
    """
    made = ProcessPoolExecutor(1, get_context("spawn"), _start, (rules, facts))
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        made.submit(int)
    finally:
        sys.modules["__main__"] = main
    return made


def _start(rules: Profile, facts: Sequence[Fact]) -> None:
    """Make a worker ready: who interrupts its parent still wants its last answer."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with suppress(CaparError):
        for _ in range(WARMING):
            inferred(facts, rules)
