"""Work shared between cores: the results of one core, and no process that outlives its caller."""

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from measured_bodies import pick_and_place
from windows import repeated

from capar.model.errors import CaparError
from extractors import cores
from extractors.cores import LONG_FRAMES, shared
from extractors.measure import measure

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="no process is split off")


@pytest.fixture(autouse=True)
def two_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cores.CORES, "2")


def process(task: int) -> Iterator[tuple[int, int]]:
    time.sleep(0.05)
    yield task, os.getpid()


TASKS = [partial(process, index) for index in range(8)]


def processes(frames: int = LONG_FRAMES) -> set[int]:
    found = shared(TASKS, frames)
    assert [task for ((task, _),) in found] == list(range(8))
    return {pid for ((_, pid),) in found}


@given(
    st.sampled_from([30.0, 100.0]), st.sampled_from([0.0003, 0.003]), st.integers(0, 1000),
    st.integers(1, 2),
)  # fmt: skip
@settings(
    max_examples=4, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_two_cores_measure_what_one_does(
    monkeypatch: pytest.MonkeyPatch, rate_hz: float, noise_m: float, seed: int, times_over: int
) -> None:
    capture = repeated(pick_and_place(rate_hz=rate_hz, noise_m=noise_m, seed=seed), times_over)
    with monkeypatch.context() as shorter:
        shorter.setattr(cores, "LONG_FRAMES", 1)
        two = measure(capture)
        shorter.setenv(cores.CORES, "1")
        one = measure(capture)
    assert two.facts == one.facts
    assert two.notices == one.notices
    assert two.calibration == one.calibration
    assert two.arriving == one.arriving


def test_tasks_of_a_long_capture_are_done_by_two_processes_and_those_of_a_short_one_by_one() -> (
    None
):
    assert len(processes()) == 2
    assert processes(LONG_FRAMES - 1) == {os.getpid()}


def test_more_tasks_than_a_pipe_holds_are_all_done() -> None:
    found = shared([partial(iter, [index]) for index in range(100_000)], LONG_FRAMES)
    assert [each for (each,) in found] == list(range(100_000))


def test_the_environment_says_how_many_cores_are_used(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cores.CORES, "1")
    assert processes() == {os.getpid()}
    for wrong in ("0", "two", "-1"):
        monkeypatch.setenv(cores.CORES, wrong)
        with pytest.raises(CaparError, match="expected a number of processor cores"):
            processes()


def test_a_thread_and_a_worker_process_work_alone() -> None:
    found: list[set[int]] = []
    thread = threading.Thread(target=lambda: found.append(processes()))
    thread.start()
    thread.join()
    assert found == [{os.getpid()}]
    with multiprocessing.get_context("fork").Pool(1) as pool:  # A daemon, which has no children.
        assert len(pool.apply(processes)) == 1


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGSTOP])
def test_what_a_process_that_dies_or_hangs_has_not_done_is_done_here(
    monkeypatch: pytest.MonkeyPatch, end: signal.Signals
) -> None:
    monkeypatch.setattr(cores, "PATIENCE_S", 0.1)
    own = os.getpid()

    def ends(task: int) -> Iterator[tuple[int, int]]:
        if os.getpid() != own:
            os.kill(os.getpid(), end)
        yield from process(task)

    found = shared([partial(ends, index) for index in range(8)], LONG_FRAMES)
    assert [each for (each,) in found] == [(index, own) for index in range(8)]


def test_a_task_that_fails_raises_what_it_raises_on_one_core() -> None:
    def fails() -> Iterator[int]:
        raise CaparError("no such body")
        yield 0

    with pytest.raises(CaparError, match="no such body"):
        shared([*TASKS, fails, *TASKS], LONG_FRAMES)


SCRIPT = """
import time
from extractors.cores import LONG_FRAMES, shared

def slow():
    time.sleep(0.2)
    yield 1

print("begins", flush=True)
shared([slow] * 300, LONG_FRAMES)
"""


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_who_interrupts_a_script_that_observes_leaves_no_process_behind(
    tmp_path: Path, end: signal.Signals
) -> None:
    (tmp_path / "script.py").write_text(SCRIPT)
    script = subprocess.Popen(
        [sys.executable, "script.py"], cwd=tmp_path, start_new_session=True, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert script.stdout is not None
    assert script.stdout.readline() == "begins\n"
    time.sleep(0.5)
    script.send_signal(end)
    rest, _ = script.communicate(timeout=30.0)  # Until no process has its output open.
    assert script.returncode != 0
    assert rest == ""  # No process has run the script again.
