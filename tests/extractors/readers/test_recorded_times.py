"""The recording's own date: from files that carry it, else as stated, else unknown; and kept."""

from datetime import UTC, datetime
from pathlib import Path

import motion_files as samples
import pytest
from bundles import DRINKING
from typer.testing import CliRunner

from capar.cli import app
from capar.model.capture import recorded_at
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.recording import iso_of_stamp, iso_time
from extractors.readers.registry import read_recording
from kb import Actionary
from ontology import CAPAR


@pytest.mark.parametrize(
    ("text", "stated"),
    [
        ("2021-08-26", "2021-08-26"),
        ("2021-08-26T15:19:24+02:00", "2021-08-26T15:19:24+02:00"),
        ("2021-08-26, 15:19:24.317", "2021-08-26T15:19:24.317"),
        (" 2021-08-26, 15:19:24 ", "2021-08-26T15:19:24"),
        ("2021-02-30", ""),
        ("26 August", ""),
        ("", ""),
    ],
)
def test_a_stated_time_is_read_and_nothing_added_to_it(text: str, stated: str) -> None:
    assert iso_time(text) == stated


def test_a_stamp_is_a_date_unless_it_counts_from_the_start_of_something() -> None:
    stamp = int(datetime(2020, 2, 3, 4, 5, 6, 789000, tzinfo=UTC).timestamp() * 1000) * 1_000_000
    assert iso_of_stamp(stamp) == "2020-02-03T04:05:06.789Z"
    assert iso_of_stamp(12_500_000_000) == ""
    assert iso_of_stamp(1 << 80) == ""


def test_the_header_of_a_qualisys_file_says_when_it_was_recorded(tmp_path: Path) -> None:
    path = samples.write_tsv(tmp_path / "walk.tsv")
    assert read_recording(path).source.recorded_at == ""
    path.write_text(f"{_opening(path)}TIME_STAMP\t2021-08-26, 15:19:24.317\t1.5\n{_rest(path)}")
    assert read_recording(path).source.recorded_at == "2021-08-26T15:19:24.317"


def _opening(path: Path) -> str:
    return path.read_text().splitlines(keepends=True)[0]


def _rest(path: Path) -> str:
    return "".join(path.read_text().splitlines(keepends=True)[1:])


def test_a_bag_is_as_old_as_its_first_stamp_if_that_is_a_date(tmp_path: Path) -> None:
    uptime = samples.write_bag(tmp_path / "uptime.bag")
    dated = samples.write_bag(tmp_path / "dated.bag", since_s=1_580_702_706)
    assert read_recording(uptime).source.recorded_at == ""
    assert read_recording(dated).source.recorded_at == "2020-02-03T04:05:06Z"


def bundle(folder: Path, line: str) -> Path:
    """The demo with a line on top of its capture.toml."""
    for each in DRINKING.iterdir():
        (folder / each.name).write_bytes(each.read_bytes())
    toml = folder / "capture.toml"
    toml.write_text(f"{line}\n{toml.read_text(encoding='utf-8')}", encoding="utf-8")
    return folder


@pytest.mark.parametrize(
    ("line", "stated", "datatype"),
    [
        ("recorded = 2021-08-26", "2021-08-26", "date"),
        ('recorded = "2021-08-26T15:19:24Z"', "2021-08-26T15:19:24Z", "dateTime"),
    ],
)
def test_the_stated_date_is_shown_stored_and_asked_for(
    line: str, stated: str, datatype: str, tmp_path: Path
) -> None:
    folder = bundle(tmp_path, line)
    assert recorded_at(read_capture(folder).sources) == stated
    shown = CliRunner().invoke(app, ["inspect", str(folder)])
    assert stated in shown.output
    place = tmp_path / "actionary"
    CliRunner().invoke(app, ["observe", str(folder), "--actionary", str(place), "--new"])
    with Actionary.open(str(place), read_only=True) as actionary:
        assert {str(row["recorded"]) for row in actionary.ask("sources")} == {stated}
        (row,) = actionary.store.ask(
            f"SELECT (DATATYPE(?at) AS ?type) {{ ?c {CAPAR.recordedAt} ?at }}"
        ).rows
        assert str(row[0].value).endswith(f"#{datatype}")
    checked = CliRunner().invoke(app, ["check", "--actionary", str(place)])
    assert checked.exit_code == 0, checked.output
