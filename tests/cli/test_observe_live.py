"""``capar observe --live`` as a person and as a program use it."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import CaparError, FileError

RUNNER = CliRunner()
DEMO = str(Path(__file__).parents[2] / "capar" / "demo" / "drink_from_mug")


def test_a_replayed_capture_ends_in_what_observing_it_gives() -> None:
    live = RUNNER.invoke(app, ["observe", "--live", DEMO, "--speed", "0", "--json"])
    rows = [json.loads(line) for line in live.stdout.splitlines()]
    assert {each["event"] for each in rows} >= {"provisional", "settled", "observation"}
    told = [each for each in rows if each["event"] == "settled"]
    assert "drank from the mug" in " ".join(each["sentence"] for each in told)
    whole = json.loads(RUNNER.invoke(app, ["observe", DEMO, "--json"]).stdout)
    assert rows[-1]["observation"] == whole
    assert [each["name"] for each in told] == [
        each["name"] for link in whole["links"] for each in link["segments"]
    ]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--live"], "CAPTURE to replay, or --device"),
        (["--live", DEMO, "--device", "lsl:x"], "CAPTURE to replay, or --device"),
        (["--live", "--device", "lsl:x"], "needs --rig"),
        (["--live", "--device", "lsl:x", "--rig", DEMO], "needs --calibration"),
        (["--live", DEMO, "--plot", "x.png"], "not for --live"),
        ([], "expected a CAPTURE"),
    ],
)
def test_what_cannot_be_observed_live_is_said_with_what_can(
    options: list[str], message: str
) -> None:
    result = RUNNER.invoke(app, ["observe", *options])
    assert isinstance(result.exception, CaparError)
    assert message in str(result.exception)


def test_a_calibration_file_that_is_none_is_refused_with_the_command_that_writes_one(
    tmp_path: Path,
) -> None:
    path = tmp_path / "calibration.json"
    path.write_text('{"step_s": 1}', encoding="utf-8")
    result = RUNNER.invoke(app, ["observe", "--live", DEMO, "--calibration", str(path)])
    assert isinstance(result.exception, FileError)
    assert "capar inspect CAPTURE --calibration --json" in str(result.exception)
