"""Many captures: observed by processes or a cluster, kept by one writer, resumed after a kill."""

import os
import pickle
import signal
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from queue import Queue
from typing import Any, Self

from capar import __version__
from capar.model.errors import CaparError
from capar.model.observation import Observation
from capar.pipelines.observation import observe_measured
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from extractors.measure import measure
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.bundle.patterns import find_captures

AHEAD = 2
"""So many captures a process are observed before the first of them is kept: results take memory."""

FLUSHED_S = 4.0
"""How often what is kept is put on disk, and then told; each time costs, more as there is more."""

CONNECT_S = 10.0
"""How long a cluster's scheduler is waited for [s]."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one of many captures."""

    place: str
    observation: Observation | None = None
    """None where it failed, or was known."""

    known: str = ""
    """The name under which the Actionary has it already, from the same files by the same rules."""

    error: str = ""
    """What was wrong with it; empty if nothing was."""


Known = Mapping[str, tuple[str, str, tuple[str, ...]]]
"""By name, what an Actionary holds: its rules, the program's version, its files' digests."""


def observe_many(
    captures: Iterable[str | Path],
    *,
    jobs: int = 1,
    rules: Profile | str = DEFAULT,
    actionary: str | Path | None = None,
    wait_s: float = 0.0,
    scheduler: str = "",
) -> Iterator[Outcome]:
    """Observe captures, in their order; failures are reported, and do not end the others.

    With an Actionary each is on disk when it is yielded, put there by this process alone, and one
    that is there from the same files, by the same rules and version, is not observed again: what
    was killed goes on where it was when it is started again.

    Args:
        captures: Patterns: folders, globs, FOLDER:TAKE, FOLDER:*.
        jobs: How many processes observe; with 1 it is this one.
        rules: A rule profile or its name.
        actionary: The folder of an Actionary, or a server's address; None keeps nothing.
        wait_s: How long to wait for another writer [s].
        scheduler: The address of a dask cluster whose workers observe, in place of ``jobs``; they
            have this version installed, and the captures under the same paths.

    Raises:
        CaparError: A pattern means no capture, the Actionary cannot be written, a process died, or
            there is no cluster.
    """
    places = find_captures([str(each) for each in captures])
    base = profile(rules) if isinstance(rules, str) else rules
    if actionary is None:
        yield from _outcomes(places, jobs, base, {}, scheduler)
        return
    from kb import Actionary
    from kb.lookup.observations import source_files

    with Actionary.open(actionary, wait_s=wait_s) as store:
        known = {
            each.name: (
                each.rules,
                each.version,
                tuple(sorted(digest for _, digest in source_files(store.store, each.name))),
            )
            for each in store.observations()
        }
        with store.store.together() as flush:
            since, kept = -FLUSHED_S, list[Outcome]()
            for outcome in _outcomes(places, jobs, base, known, scheduler):
                try:
                    if outcome.observation is not None:
                        store.add(outcome.observation)
                    kept.append(outcome)
                except CaparError as error:  # another capture of its name is there
                    kept.append(Outcome(outcome.place, error=str(error)))
                if time.monotonic() - since > FLUSHED_S:
                    flush()
                    yield from kept
                    since, kept = time.monotonic(), []
            flush()
            yield from kept


def _outcomes(
    places: list[str], jobs: int, rules: Profile, known: Known, scheduler: str
) -> Iterator[Outcome]:
    """The outcome of each place, in their order."""
    if not scheduler and (jobs <= 1 or len(places) <= 1):
        yield from (_outcome(place, rules, known) for place in places)
        return
    with ExitStack() as stack:
        if scheduler:
            submit, jobs = _on_cluster(stack, scheduler, rules, known)
        else:
            jobs = min(jobs, len(places))
            submit = _by_processes(stack, jobs, rules, known)
        running: deque[Any] = deque()
        left = iter(places)
        while True:
            while len(running) < AHEAD * jobs and (place := next(left, "")):
                running.append(submit(place))
            if not running:
                return
            yield running.popleft().result()


def _by_processes(
    stack: ExitStack, jobs: int, rules: Profile, known: Known
) -> Callable[[str], Any]:
    """What has a capture observed by one of several processes, and gives its future outcome."""
    idle: Queue[_Process] = Queue()
    for _ in range(jobs):
        idle.put(stack.enter_context(_Process(rules, known)))
    pool = ThreadPoolExecutor(jobs)
    stack.callback(pool.shutdown, wait=False, cancel_futures=True)

    def observed(place: str) -> Outcome:
        process = idle.get()
        try:
            return process.outcome(place)
        finally:
            idle.put(process)

    return lambda place: pool.submit(observed, place)


def _on_cluster(
    stack: ExitStack, address: str, rules: Profile, known: Known
) -> tuple[Callable[[str], Any], int]:
    """What has a capture observed by a dask cluster, and how many it observes at once.

    Raises:
        CaparError: The package is missing, nothing answers there, or no worker is there.
    """
    try:
        distributed = import_module("distributed")
    except ImportError:
        remedy = "`pip install 'capar[cluster]'` brings it"
        raise CaparError(f"--scheduler needs the package distributed; {remedy}") from None
    try:
        client = stack.enter_context(distributed.Client(address, timeout=CONNECT_S))
    except (OSError, ValueError) as error:
        raise CaparError(
            f"no dask scheduler answers at {address} ({error}); `dask scheduler` prints its address"
        ) from None
    slots = sum(client.nthreads().values())
    if not slots:
        raise CaparError(f"{address} has no workers; start some: `dask worker {address}`")
    rules, known = client.scatter([rules, dict(known)], broadcast=True)

    def submit(place: str) -> Any:
        return client.submit(_outcome, place, rules, known, str(Path.cwd()), pure=False)

    return submit, slots


def _outcome(place: str, rules: Profile, known: Known, folder: str = "") -> Outcome:
    try:
        if folder:
            os.chdir(folder)  # places, and what is kept of sources, are relative to it
        capture = read_capture(place)
        own = (rules.fingerprint, __version__, tuple(sorted(s.sha256 for s in capture.sources)))
        if known.get(capture.name) == own:
            return Outcome(place, known=capture.name)
        return Outcome(place, observe_measured(capture, measure(capture), rules=rules))
    except (CaparError, OSError) as error:
        return Outcome(place, error=str(error))


class _Process:
    """A process that observes; it ends when its standard input does, as when we are killed."""

    def __init__(self, rules: Profile, known: Known) -> None:
        """Start it with the rules, and what need not be observed."""
        command = "from capar.pipelines.many import serve; serve()"
        environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "CAPAR_CORES": "1"}
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", command],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment,
        )  # fmt: skip
        self._unsent: list[object] = [(rules, known)]

    def __enter__(self) -> Self:
        """Use it until it is left."""
        return self

    def __exit__(self, *_: object) -> None:
        """End it, whatever it is at."""
        self._process.kill()
        with suppress(BrokenPipeError):
            self._process.communicate()

    def outcome(self, place: str) -> Outcome:
        """What becomes of a capture.

        Raises:
            CaparError: The process died of it.
        """
        assert self._process.stdout is not None
        try:
            self._send(place)
            found: Outcome = pickle.load(self._process.stdout)
        except (EOFError, BrokenPipeError, pickle.UnpicklingError):
            raise CaparError(
                f"the process that observed {place} died; was there too little memory? Start again "
                "with fewer --jobs: what is kept is not observed again"
            ) from None
        return found

    def _send(self, value: object) -> None:
        assert self._process.stdin is not None
        for each in (*self._unsent, value):
            pickle.dump(each, self._process.stdin)
        self._unsent.clear()
        self._process.stdin.flush()


def serve() -> None:
    """Observe the captures that standard input names, and answer each on standard output."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # it is the command that is interrupted
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever a library prints is no answer
    with suppress(EOFError, BrokenPipeError):
        rules, known = pickle.load(sys.stdin.buffer)
        while True:
            pickle.dump(_outcome(pickle.load(sys.stdin.buffer), rules, known), out)
            out.flush()
