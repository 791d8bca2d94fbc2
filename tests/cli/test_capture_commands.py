"""``capar inspect`` and ``capar new-capture`` as a person uses them."""

import json
from pathlib import Path

import motion_files as samples
import pytest
from typer.testing import CliRunner

import capar
from capar.cli import app
from capar.model.calibration import Calibration
from capar.model.errors import FileError
from capar.model.json_form import value_from_json
from extractors.calibration import calibrate
from extractors.readers.bundle.capture_toml import read_capture

RUNNER = CliRunner()


@pytest.mark.parametrize("kind", ["csv", "bvh", "c3d", "tsv6d", "trc", "json"])
def test_a_new_capture_is_read_back_once_its_axes_are_right(kind: str, tmp_path: Path) -> None:
    name, write = samples.WRITERS[kind]
    path = write(tmp_path / name)
    result = RUNNER.invoke(app, ["new-capture", str(path), "-o", str(tmp_path / "capture.toml")])
    assert result.exit_code == 0, result.output
    assert "look at" in result.output or "it reads as a capture" in result.output
    text = (tmp_path / "capture.toml").read_text()
    (tmp_path / "capture.toml").write_text(text.replace('unit = "m" ', 'unit = "dm" '))
    assert len(read_capture(tmp_path).sensors) >= 1


def test_what_is_there_is_never_overwritten_unless_forced(tmp_path: Path) -> None:
    path = samples.write_csv(tmp_path / "m.csv")
    output = tmp_path / "capture.toml"
    output.write_text("mine")
    result = RUNNER.invoke(app, ["new-capture", str(path), "-o", str(output)])
    assert isinstance(result.exception, FileError)
    assert output.read_text() == "mine"
    assert (
        RUNNER.invoke(app, ["new-capture", str(path), "-o", str(output), "--force"]).exit_code == 0
    )
    assert output.read_text() != "mine"


def test_inspect_tells_rate_gaps_and_ranges_of_a_file(tmp_path: Path) -> None:
    path = samples.write_csv(tmp_path / "m.csv")
    lines = path.read_text().splitlines()
    lines[5:8] = [each[:-1] + "0" for each in lines[5:8]]
    path.write_text("\n".join(lines))
    result = RUNNER.invoke(app, ["inspect", str(path), "--json"])
    (hand,) = json.loads(result.output)["streams"]
    assert hand["rate_hz"] == pytest.approx(samples.RATE)
    assert (hand["lost"], hand["gaps"]) == (3, 1)
    assert hand["range_m"][0] == pytest.approx(0.1)


def test_inspect_of_a_bundle_names_its_sensors_and_near_pairs(tmp_path: Path) -> None:
    samples.write_csv(tmp_path / "m.csv")
    (tmp_path / "capture.toml").write_text(
        'unit = "m"\nup = "z"\n[files]\nm = "m.csv"\n'
        '[[sensor]]\nname = "h"\nend_effector = "hand"\nbody = "hand"\n'
        '[[object]]\nname = "mug"\ntag = "mobile"\nposition = [0.5, 0.2, 0.9]\n'
    )
    report = json.loads(RUNNER.invoke(app, ["inspect", str(tmp_path), "--json"]).output)
    assert [each["kind"] for each in report["streams"]] == ["sensor, acts", "object, mobile"]
    (pair,) = report["pairs"]
    assert (pair["first"], pair["second"]) == ("h", "mug")
    assert pair["least_m"] == pytest.approx(0.011, abs=0.002)


def test_inspect_prints_the_calibration_as_tables_and_as_json() -> None:
    place = str(Path(capar.__file__).parent / "demo" / "drink_from_mug")
    known = calibrate(read_capture(place))
    result = RUNNER.invoke(app, ["inspect", place, "--calibration", "--json"])
    assert result.exit_code == 0, result.output
    assert value_from_json(result.output, Calibration) == known
    tables = RUNNER.invoke(app, ["inspect", place, "--calibration"]).output
    assert f"{1e3 * known.contact_tolerance_m:.2f} mm" in tables
    assert f"{1e3 * known.tag_object('mug').noise_m:.2f}" in tables
    assert "median" in tables


def test_a_long_name_is_whole_in_a_pipe(tmp_path: Path) -> None:
    name = "marker_on_the_second_knuckle_of_the_left_glove_of_the_first_performer"
    path = samples.write_csv(tmp_path / "m.csv")
    head, _, rest = path.read_text().partition("\n")
    body = next(each[:-2] for each in head.split(",") if each.endswith("_x"))
    path.write_text(head.replace(body, name) + "\n" + rest)
    result = RUNNER.invoke(app, ["inspect", str(path)])
    assert result.exit_code == 0, result.output
    assert name in result.output
