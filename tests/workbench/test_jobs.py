"""Long work is done beside the window, told of, and ended when somebody says so."""

import threading
import time

import pytest

from capar.model.errors import CaparError
from capar.workbench.jobs import Jobs


def test_a_result_is_handed_on_and_progress_is_told() -> None:
    told: list[tuple[str, float]] = []
    made: list[int] = []
    jobs = Jobs(lambda what, share: told.append((what, share)))
    jobs.start("counting", lambda report: report("one", 0.5) or 7, made.append, pytest.fail)  # type: ignore[func-returns-value]
    jobs.wait()
    assert made == [7]
    assert told == [("counting", 0.0), ("counting: one", 0.5), ("", 1.0)]


def test_work_is_stopped_and_nothing_is_handed_on() -> None:
    begun, failed, made = threading.Event(), list[str](), list[object]()

    def work(report: object) -> None:
        begun.set()
        while True:
            time.sleep(0.01)

    jobs = Jobs()
    jobs.start("for ever", work, made.append, failed.append)
    begun.wait(5.0)
    assert jobs.stop()
    jobs.wait(5.0)
    assert failed == ["stopped; nothing was kept"] and not made
    assert not jobs.running
    assert not jobs.stop()


def test_a_stop_that_a_finalizer_swallows_still_ends_the_work(
    capfd: pytest.CaptureFixture[str],
) -> None:
    collected, failed = threading.Event(), list[str]()

    class Late:
        def __del__(self) -> None:
            collected.set()
            while True:  # until the stop falls into it
                time.sleep(0.01)

    def work(report: object) -> None:
        late = Late()
        del late
        while True:
            time.sleep(0.01)

    jobs = Jobs()
    jobs.start("for ever", work, lambda _: None, failed.append)
    collected.wait(5.0)
    assert jobs.stop()
    jobs.wait(5.0)
    assert failed == ["stopped; nothing was kept"]
    assert not capfd.readouterr().err


def test_one_thing_is_done_at_a_time() -> None:
    free = threading.Event()
    jobs = Jobs()
    jobs.start("first", lambda report: free.wait(5.0), lambda _: None, pytest.fail)
    with pytest.raises(CaparError, match="first"):
        jobs.start("second", lambda report: None, lambda _: None, pytest.fail)
    free.set()
    jobs.wait()
    jobs.start("third", lambda report: None, lambda _: None, pytest.fail)
    jobs.wait()


@pytest.mark.parametrize("error", [CaparError("no sensor 'x'"), OSError(28, "no room", "/x")])
def test_a_mistake_is_told_as_a_message(error: Exception) -> None:
    failed: list[str] = []

    def work(report: object) -> None:
        raise error

    jobs = Jobs()
    jobs.start("failing", work, pytest.fail, failed.append)
    jobs.wait()
    assert len(failed) == 1 and ("no sensor" in failed[0] or "no room" in failed[0])


def test_a_fault_of_ours_is_told_too_and_ends_nothing() -> None:
    failed: list[str] = []
    jobs = Jobs()
    jobs.start("failing", lambda report: 1 / 0, pytest.fail, failed.append)
    jobs.wait()
    assert "ZeroDivisionError" in failed[0] and "Traceback" not in failed[0]
    jobs.start("again", lambda report: None, lambda _: None, pytest.fail)
    jobs.wait()
