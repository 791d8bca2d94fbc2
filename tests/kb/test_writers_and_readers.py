"""One writer holds a folder; others wait or are told who; readers go on reading."""

import json
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import kill
import pytest
from observations import drink_from_mug

from kb.actionary import Actionary
from kb.errors import LockedError, StoreError

HOLD = (
    "import sys, time\n"
    "from kb.actionary import Actionary\n"
    "held = Actionary.open(sys.argv[1])\n"
    "print('held', flush=True)\n"
    "time.sleep(float(sys.argv[2]))\n"
    "held.close()\n"
)


def holder(folder: Path, seconds: float) -> subprocess.Popen[str]:
    """Another process that holds the folder for a while."""
    command = [sys.executable, "-c", HOLD, str(folder), str(seconds)]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert running.stdout is not None and running.stdout.readline() == "held\n"
    return running


def test_a_second_writer_is_told_who_holds_the_folder(tmp_path: Path) -> None:
    running = holder(tmp_path / "a", 30)
    try:
        with pytest.raises(LockedError) as told:
            Actionary.open(tmp_path / "a")
    finally:
        running.kill()
        running.wait()
    assert f"process {running.pid} on " in str(told.value)
    assert "since 20" in str(told.value) and "--wait" in str(told.value)


def test_a_second_writer_waits_if_asked_to(tmp_path: Path) -> None:
    running = holder(tmp_path / "a", 0.5)
    with Actionary.open(tmp_path / "a", wait_s=30) as mine:
        mine.add(drink_from_mug())
    assert running.wait() == 0


def test_the_lock_of_a_killed_writer_holds_nobody_up(tmp_path: Path) -> None:
    running = holder(tmp_path / "a", 30)
    running.send_signal(signal.SIGKILL)
    running.wait()
    left = json.loads((tmp_path / "a" / "writer.lock").read_text())
    assert left["pid"] == running.pid
    with Actionary.open(tmp_path / "a") as mine:
        mine.add(drink_from_mug())


def test_a_reader_reads_beside_a_writer_and_sees_more_when_refreshed(tmp_path: Path) -> None:
    with Actionary.open(tmp_path / "a") as writer:
        writer.add(drink_from_mug())
        with Actionary.open(tmp_path / "a", read_only=True) as reader:
            writer.add(replace(drink_from_mug(), capture="second"))
            assert [each.name for each in reader.observations()] == ["DrinkFromMug"]
            reader.refresh()
            assert [each.name for each in reader.observations()] == ["DrinkFromMug", "second"]
            with pytest.raises(StoreError, match="opened to be read"):
                reader.forget("second")


def test_readers_go_on_while_a_writer_writes_much(tmp_path: Path) -> None:
    with Actionary.open(tmp_path / "a") as writer:
        writer.add(drink_from_mug())
        seen = 0
        for index in range(12):
            writer.add(replace(drink_from_mug(), capture=f"again_{index}"))
            with Actionary.open(tmp_path / "a", read_only=True) as reader:
                found = reader.ask("performers", action="DrinkFromMug")
                assert len(found) == index + 2
                seen += 1
        assert seen == 12


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(StoreError, match="file"):
        Actionary.open(tmp_path / "file")


def test_kills_lose_nothing_and_tear_nothing(tmp_path: Path) -> None:
    outcome = kill.run(5, seed=1, folder=tmp_path)
    assert outcome.problems == ()
    assert outcome.kills == 5
    assert outcome.acknowledged > 0
