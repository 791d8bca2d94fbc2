"""`capar observe` and `capar facts`: what they print, and how they ask for what is unknown."""

import io
import json
import re
import sys
from dataclasses import replace
from importlib import resources
from pathlib import Path

import jsonschema
import motions
import pytest

from capar.cli import main
from capar.model.capture import Capture, Stream
from capar.model.json_form import from_json, published_schema
from capar_rules.engine.solver import rule_file, solve

DEMO = str(resources.files("capar") / "demo" / "drink_from_mug")
STEPS = ["Reach", "MoveObjTo", "MoveObj", "MoveObjTo", "TouchWith", "ResumePosture"]


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("CAPAR_RULES", "CAPAR_ACTIONARY"):
        monkeypatch.delenv(name, raising=False)


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str, typed: str = "") -> int:
    """The exit code of the command line with these arguments, as if this were typed."""
    monkeypatch.setattr(sys, "argv", ["capar", *arguments])
    monkeypatch.setattr(sys, "stdin", io.StringIO(typed))
    try:
        main()
    except SystemExit as end:
        return int(end.code or 0)
    return 0


def first_seconds(capture: Capture, seconds: float) -> Capture:
    frames = int(seconds * capture.rate_hz)

    def cut(stream: Stream) -> Stream:
        return Stream(
            stream.times[:frames], stream.positions[:frames], stream.orientations[:frames]
        )

    return replace(
        capture,
        sensors=tuple(replace(each, stream=cut(each.stream)) for each in capture.sensors),
        objects=tuple(replace(each, stream=cut(each.stream)) for each in capture.objects),
    )


@pytest.fixture
def lifted(monkeypatch: pytest.MonkeyPatch) -> None:
    """A capture that ends with the mug in the air, which is no row of the published table."""
    capture = first_seconds(motions.drink_from_mug(motions.TALL_MAN).capture, 2.15)
    monkeypatch.setattr(
        "extractors.readers.bundle.capture_toml.read_capture", lambda place: capture
    )


def test_the_tables_show_segments_and_steps(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "observe", DEMO, "--profile", "thesis", "--plot", "out.png") == 0
    printed = capsys.readouterr()
    steps = [line.split()[1] for line in printed.out.split("\n\n")[1].splitlines()[1:]]
    assert steps == STEPS
    assert "note [contact-tolerance]" in printed.err
    assert Path("out.png").read_bytes().startswith(b"\x89PNG")


def test_json_keeps_to_the_published_schema_and_reads_back(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "observe", DEMO, "--json") == 0
    text = capsys.readouterr().out
    jsonschema.validate(json.loads(text), json.loads(published_schema("observation")))
    assert from_json(text).capture == "drink_from_mug_tall_man"


@pytest.mark.usefixtures("lifted")
def test_in_batch_the_unknown_is_kept_and_reported(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "observe", "x", "--profile", "thesis") == 0
    printed = capsys.readouterr().out
    assert "Unknown" in printed
    assert not Path("rules").exists()


@pytest.mark.usefixtures("lifted")
def test_the_unknown_can_be_an_error(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "observe", "x", "--profile", "thesis", "--on-unknown", "fail") == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "no rule names every segment" in printed.err


@pytest.mark.usefixtures("lifted")
def test_a_name_that_is_asked_for_becomes_a_rule(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = ("observe", "x", "--profile", "thesis", "--on-unknown", "ask")
    assert run(monkeypatch, *asked, typed="not a name\nFerry\n") == 0
    printed = capsys.readouterr()
    assert "Ferry" in printed.out
    assert "Unknown" not in printed.out
    assert "A name reads like MoveObjTo" in printed.err
    assert 'primitive("Ferry").' in Path("rules/ferry.lp").read_text()
    assert run(monkeypatch, "observe", "x", "--profile", "thesis") == 0
    assert "Ferry" in capsys.readouterr().out


def test_printed_facts_with_the_rule_files_are_a_program(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "facts", DEMO, "--profile", "thesis") == 0
    answer = solve([rule_file("thesis.lp")], capsys.readouterr().out)
    assert sorted(name for _, name in answer.of("named")) == sorted(STEPS)


def test_what_is_not_there_is_a_users_mistake(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "observe", "nowhere") == 2
    assert run(monkeypatch, "observe", DEMO, "--profile", "theses") == 2
    assert "Did you mean 'thesis'?" in capsys.readouterr().err


@pytest.mark.usefixtures("lifted")
def test_a_name_that_is_asked_for_goes_beside_the_actionary_that_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = ("observe", "x", "--profile", "thesis", "--on-unknown", "ask", "--actionary", "known")
    assert run(monkeypatch, *asked, typed="Ferry\n") == 0
    assert "wrote known/rules/ferry.lp" in capsys.readouterr().err
    assert not Path("rules").exists()
    assert run(monkeypatch, *asked[:4]) == 0
    assert "Ferry" not in capsys.readouterr().out
    assert run(monkeypatch, *asked[:4], "--actionary", "known") == 0
    assert "Ferry" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        (("--plot", "x.bmp"), "x.bmp: no picture format '.bmp'; there are: .png, .svg, .pdf."),
        (("--plot", "nodir/x.png"), "nodir/x.png: cannot be used: No such file or directory."),
        (("--json", "--script"), "--json and --script print different things; say one of them"),
        (("--script", "--pars"), "--script and --pars print different things; say one of them"),
    ],
)
def test_what_cannot_come_out_is_refused_before_anything_is_computed(
    asked: tuple[str, ...],
    told: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("extractors.readers.bundle.capture_toml.read_capture", pytest.fail)
    assert run(monkeypatch, "observe", DEMO, *asked) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("obsreve", DEMO), "no command 'obsreve'; .* Did you mean 'observe'?"),
        (("observe", "notes.md"), r"notes.md: is no capture.toml, and there is none beside it\."),
        (
            ("observe", DEMO, "--actionary", "notes.md"),
            "notes.md: is a file; an Actionary is a fol",
        ),
    ],
)
def test_a_mistyped_command_or_place_is_reported_before_anything_is_computed(
    arguments: tuple[str, ...],
    message: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("notes.md").write_text("# Notes\n")
    assert run(monkeypatch, *arguments) == 2
    printed = capsys.readouterr()
    assert re.search(message, printed.err)
    assert not printed.out


def test_a_fitted_body_changes_nothing_where_its_parts_are_stated(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "observe", DEMO) == 0
    plain = capsys.readouterr().out
    assert run(monkeypatch, "observe", DEMO, "--fit") == 0
    assert capsys.readouterr().out == plain
