"""``capar simulate``, ``capar devices`` and ``capar record`` as a person uses them."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import CaparError, FileError
from extractors.readers.bundle.capture_toml import read_capture

RUNNER = CliRunner()
DEMO = Path(__file__).parents[2] / "capar" / "demo" / "drink_from_mug"
RUN = "from capar.cli import main; main()"


@contextmanager
def simulated(*options: str) -> Iterator[str]:
    """The address of a simulator in a process of its own."""
    command = [sys.executable, "-c", RUN, "simulate", *options, "--json"]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        text=True,
        env=environment,
        preexec_fn=_interruptible,  # noqa: PLW1509
    ) as child:
        assert child.stdout is not None
        try:
            yield json.loads(child.stdout.readline())["address"]
        finally:
            child.send_signal(signal.SIGINT)
            try:
                assert child.wait(20.0) == 0
            finally:
                child.kill()


def _interruptible() -> None:
    """Let Ctrl-C end the process, also where the tests run in the background of a shell."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def test_drivers_are_listed_with_addresses() -> None:
    result = RUNNER.invoke(app, ["devices", "--json"])
    assert sorted(json.loads(result.output)["drivers"]) == [
        "fastrak", "flock", "lsl", "motionstar", "vrpn"
    ]  # fmt: skip
    assert "flock:/dev/ttyUSB0" in RUNNER.invoke(app, ["devices"]).output


@pytest.mark.parametrize("kind", ["flock", "motionstar", "fastrak", "vrpn"])
def test_what_a_simulated_tracker_sends_is_told(kind: str) -> None:
    with simulated(kind, "--sensors", "2") as address:
        result = RUNNER.invoke(app, ["devices", address, "--seconds", "1", "--json"])
        assert result.exit_code == 0, result.output
    report = json.loads(result.output)
    assert report["kind"] == kind
    assert report["counts"]["frames"] > 3
    assert report["counts"]["lost_records"] == 0
    assert len([each for each in report["positions_m"].values() if each]) == 2


def test_a_capture_that_is_played_is_recorded_as_a_bundle(tmp_path: Path) -> None:
    with simulated("motionstar", "--capture", str(DEMO)) as address:
        result = RUNNER.invoke(app, ["record", address, str(tmp_path / "trial"), "--seconds", "2"])
        assert result.exit_code == 0, result.output
    assert "0 poses lost" in result.output
    capture = read_capture(tmp_path / "trial")
    assert {each.name for each in capture.sensors} == {"right_hand", "head"}
    assert {each.name for each in capture.objects} == {"mug", "table"}
    again = RUNNER.invoke(app, ["record", str(tmp_path / "trial.live"), str(tmp_path / "again")])
    assert again.exit_code == 0, again.output
    assert (tmp_path / "again" / "motion.csv").read_bytes() == (
        tmp_path / "trial" / "motion.csv"
    ).read_bytes()


def test_a_wrong_address_or_place_is_an_error_and_leaves_nothing(tmp_path: Path) -> None:
    for place in ("flock", "flok:/dev/x", "flock:/dev/no_such_port"):
        result = RUNNER.invoke(app, ["record", place, str(tmp_path / "trial")])
        assert isinstance(result.exception, CaparError)
    result = RUNNER.invoke(app, ["record", "flock:/dev/x", str(tmp_path)])
    assert isinstance(result.exception, FileError)
    assert list(tmp_path.iterdir()) == []
    assert isinstance(RUNNER.invoke(app, ["simulate", "wii"]).exception, CaparError)
