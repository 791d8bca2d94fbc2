"""``observe`` and ``inspect`` print faults of a recording, each with what to state."""

import json
from pathlib import Path
from typing import Any

import pytest
from faulty import changed, scaled, turned
from motions.encounters import throw
from motions.performers import TALL_MAN
from typer.testing import CliRunner
from write_demo import write_tables

from capar.cli import app
from capar.model.capture import upward

BUNDLE = """\
name = "thrown"
unit = "{unit}"
up = "{up}"

[files]
motion = "motion.csv"

[[sensor]]
name = "right_hand"
end_effector = "hand"
side = "right"
body = "right_hand"
shape = {{ mesh = "right_hand.obj" }}

[[object]]
name = "ball"
tag = "mobile"
body = "ball"
shape = {{ mesh = "ball.obj" }}
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A throw recorded with y upward, in decimetres."""
    monkeypatch.chdir(tmp_path)
    for name in ("CAPAR_ACTIONARY", "CAPAR_RULES"):
        monkeypatch.delenv(name, raising=False)
    capture = throw(TALL_MAN, noise_m=0.0005).capture
    sound = turned(upward("y").inv())
    write_tables(changed(capture, lambda stream: scaled(10.0)(sound(stream))), tmp_path / "thrown")
    return tmp_path / "thrown"


def told(folder: Path, command: str, *, up: str, unit: str) -> list[dict[str, Any]]:
    text = BUNDLE.format(up=up, unit=unit)
    (folder / "capture.toml").write_text(text, encoding="utf-8")
    result = CliRunner().invoke(app, [command, str(folder), "--json"], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    notices = (document["observations"][0] if "observations" in document else document)["notices"]
    kinds = ("up-contradicted", "unit-contradicted", "fall-rate", "order-contradicted")
    return [each for each in notices if each["code"] in kinds]


@pytest.mark.parametrize("command", ["observe", "inspect"])
def test_a_sound_bundle_has_no_fault(folder: Path, command: str) -> None:
    assert told(folder, command, up="y", unit="dm") == []


@pytest.mark.parametrize("command", ["observe", "inspect"])
def test_a_wrong_axis_is_told_with_the_line_to_write(folder: Path, command: str) -> None:
    (each,) = told(folder, command, up="z", unit="dm")
    assert each["bodies"] == ["ball"]
    assert 'state up = "y" for its file, which was read with "z"' in str(each["message"])


@pytest.mark.parametrize("command", ["observe", "inspect"])
def test_a_wrong_unit_is_told_with_the_line_to_write(folder: Path, command: str) -> None:
    (each,) = told(folder, command, up="y", unit="m")
    assert 'state unit = "dm" for its file, which was read in m' in str(each["message"])
