"""Captures as a person looks at them, drafts them, records and performs them."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import motion_files as samples
import pytest
from bundles import DRINKING
from shell import capar, run

from capar.model.calibration import Calibration
from capar.model.errors import CaparError, FileError, UnknownNameError
from capar.model.json_form import value_from_json
from capar.pipelines.observation import observe
from extractors.calibration import calibrate
from extractors.readers.bundle.capture_toml import read_capture

RUN = "from capar.cli import main; main()"


@pytest.mark.parametrize("kind", ["csv", "bvh", "c3d", "tsv6d", "trc", "json"])
def test_a_new_capture_is_read_back_once_its_axes_are_right(kind: str, tmp_path: Path) -> None:
    name, write = samples.WRITERS[kind]
    path = write(tmp_path / name)
    said = run("new-capture", path, "-o", tmp_path / "capture.toml")
    assert "look at" in said or "it reads as a capture" in said
    text = (tmp_path / "capture.toml").read_text()
    (tmp_path / "capture.toml").write_text(text.replace('unit = "m" ', 'unit = "dm" '))
    assert len(read_capture(tmp_path).sensors) >= 1


def test_what_is_there_is_never_overwritten_unless_forced(tmp_path: Path) -> None:
    path = samples.write_csv(tmp_path / "m.csv")
    output = tmp_path / "capture.toml"
    output.write_text("mine")
    assert isinstance(capar("new-capture", path, "-o", output).exception, FileError)
    assert output.read_text() == "mine"
    run("new-capture", path, "-o", output, "--force")
    assert output.read_text() != "mine"


def test_inspect_tells_rate_gaps_and_ranges_of_a_file(tmp_path: Path) -> None:
    path = samples.write_csv(tmp_path / "m.csv")
    lines = path.read_text().splitlines()
    lines[5:8] = [each[:-1] + "0" for each in lines[5:8]]
    path.write_text("\n".join(lines))
    (hand,) = json.loads(run("inspect", path, "--json"))["streams"]
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
    report = json.loads(run("inspect", tmp_path, "--json"))
    assert [each["kind"] for each in report["streams"]] == ["sensor, acts", "object, mobile"]
    (pair,) = report["pairs"]
    assert (pair["first"], pair["second"]) == ("h", "mug")
    assert pair["least_m"] == pytest.approx(0.011, abs=0.002)


def test_inspect_prints_the_calibration_as_tables_and_as_json() -> None:
    known = calibrate(read_capture(DRINKING))
    assert (
        value_from_json(run("inspect", DRINKING, "--calibration", "--json"), Calibration) == known
    )
    tables = run("inspect", DRINKING, "--calibration")
    assert f"{1e3 * known.contact_tolerance_m:.2f} mm" in tables
    assert f"{1e3 * known.tag_object('mug').noise_m:.2f}" in tables
    assert "median" in tables


def test_a_long_name_is_whole_in_a_pipe(tmp_path: Path) -> None:
    name = "marker_on_the_second_knuckle_of_the_left_glove_of_the_first_performer"
    path = samples.write_csv(tmp_path / "m.csv")
    head, _, rest = path.read_text().partition("\n")
    body = next(each[:-2] for each in head.split(",") if each.endswith("_x"))
    path.write_text(head.replace(body, name) + "\n" + rest)
    assert name in run("inspect", path)


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


@pytest.mark.parametrize("kind", ["flock", "motionstar", "fastrak", "vrpn"])
def test_what_a_simulated_tracker_sends_is_told(kind: str) -> None:
    with simulated(kind, "--sensors", "2") as address:
        report = json.loads(run("devices", address, "--seconds", "1", "--json"))
    assert report["kind"] == kind
    assert report["counts"]["frames"] > 3
    assert report["counts"]["lost_records"] == 0
    assert len([each for each in report["positions_m"].values() if each]) == 2


def test_a_capture_that_is_played_is_recorded_as_a_bundle(tmp_path: Path) -> None:
    with simulated("motionstar", "--capture", DRINKING) as address:
        said = run("record", address, tmp_path / "trial", "--seconds", "2")
    assert "0 poses lost" in said
    capture = read_capture(tmp_path / "trial")
    assert {each.name for each in capture.sensors} == {"right_hand", "head"}
    assert {each.name for each in capture.objects} == {"mug", "table"}
    run("record", tmp_path / "trial.live", tmp_path / "again")
    assert (tmp_path / "again" / "motion.csv").read_bytes() == (
        tmp_path / "trial" / "motion.csv"
    ).read_bytes()


def test_a_wrong_address_or_place_is_an_error_and_leaves_nothing(tmp_path: Path) -> None:
    for place in ("flock", "flok:/dev/x", "flock:/dev/no_such_port"):
        assert isinstance(capar("record", place, tmp_path / "trial").exception, CaparError)
    assert isinstance(capar("record", "flock:/dev/x", tmp_path).exception, FileError)
    assert list(tmp_path.iterdir()) == []
    assert isinstance(capar("simulate", "wii").exception, CaparError)


def test_what_is_performed_is_observed_as_what_it_is(tmp_path: Path) -> None:
    place = tmp_path / "touched"
    run("perform", "touch", "--agent", "woman", "--rate", "30", "-o", place)
    seen = observe(str(place))
    names = [each.name for each in seen.segments if each.ee == "right_hand"]
    assert [name for name in names if name != "Rest"] == ["Reach", "Touch", "ResumePosture"]


def test_the_same_words_give_the_same_bytes(tmp_path: Path) -> None:
    for name in ("one", "two"):
        run("perform", "touch", "--rate", "30", "--noisy", "-o", tmp_path / name)
    one, two = (sorted((tmp_path / name).iterdir()) for name in ("one", "two"))
    assert [each.name for each in one] == [each.name for each in two]
    assert [each.read_bytes() for each in one] == [each.read_bytes() for each in two]


@pytest.mark.parametrize("words", [("dirnk",), ("drink", "--agent", "giant")])
def test_an_unknown_action_or_body_is_named_with_those_that_exist(
    words: tuple[str, ...], tmp_path: Path
) -> None:
    with pytest.raises(UnknownNameError, match="there are: "):
        run("perform", *words, "-o", tmp_path / "new")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_with_something_in_it_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(FileError, match="not an empty folder"):
        run("perform", "touch", "-o", tmp_path)
