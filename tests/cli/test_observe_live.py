"""``capar observe --live`` as a person and as a program use it."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import CaparError

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
