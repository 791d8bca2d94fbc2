"""`capar observe` and `capar facts`, also live: what they print, refuse and ask for."""

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import jsonschema
import motions
import pytest
from bundles import DRINKING
from shell import capar, refused, run

from capar.model.capture import Capture, Stream
from capar.model.json_form import from_json, published_schema
from capar_rules.engine.solver import rule_file, solve

STEPS = ["Reach", "MoveObjTo", "MoveObj", "MoveObjTo", "TouchWith", "ResumePosture"]
THESIS = ("--profile", "thesis")


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("CAPAR_RULES", "CAPAR_ACTIONARY"):
        monkeypatch.delenv(name, raising=False)


def first_seconds(capture: Capture, seconds: float) -> Capture:
    part = slice(int(seconds * capture.rate_hz))

    def cut(stream: Stream) -> Stream:
        return Stream(stream.times[part], stream.positions[part], stream.orientations[part])

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


def test_the_tables_show_segments_and_steps() -> None:
    done = capar("observe", DRINKING, *THESIS, "--plot", "out.png")
    steps = [line.split()[1] for line in done.stdout.split("\n\n")[1].splitlines()[1:]]
    assert steps == STEPS
    assert "note [contact-tolerance]" in done.stderr
    assert Path("out.png").read_bytes().startswith(b"\x89PNG")


def test_a_take_is_asked_for_by_the_name_by_which_it_was_observed() -> None:
    shutil.copytree(DRINKING, "kitchen")
    text = Path("kitchen/capture.toml").read_text()
    text = re.sub('^name = ".*"$', 'takes = ["motion"]', text, count=1, flags=re.MULTILINE)
    Path("kitchen/capture.toml").write_text(text.replace("motion.csv", "{take}.csv"))
    kept = ("--actionary", "actionary")
    run("observe", "kitchen:motion", *THESIS, *kept, "--new")
    asked = run("query", "segments", "capture=kitchen:motion", *kept)
    assert "kitchen:motion/right_hand/0" in asked
    assert "Reach" in run("show", "kitchen:motion", *kept)
    assert "kitchen:motion" in run("export", "--observation", "kitchen:motion", *kept)
    run("forget", "kitchen:motion", *kept)
    assert "kitchen:motion" not in run("query", "observations", *kept)


def test_json_keeps_to_the_published_schema_and_reads_back() -> None:
    text = run("observe", DRINKING, "--json")
    jsonschema.validate(json.loads(text), json.loads(published_schema("observation")))
    assert from_json(text).capture == "drink_from_mug_tall_man"


@pytest.mark.usefixtures("lifted")
def test_the_unknown_is_kept_in_batch_or_an_error() -> None:
    assert "Unknown" in run("observe", "x", *THESIS)
    assert not Path("rules").exists()
    said = refused("observe", "x", *THESIS, "--on-unknown", "fail")
    assert "no rule names every segment" in said


@pytest.mark.usefixtures("lifted")
def test_a_name_that_is_asked_for_becomes_a_rule() -> None:
    done = capar("observe", "x", *THESIS, "--on-unknown", "ask", typed="not a name\nFerry\n")
    assert "Ferry" in done.stdout
    assert "Unknown" not in done.stdout
    assert "A name reads like MoveObjTo" in done.stderr
    assert 'primitive("Ferry").' in Path("rules/ferry.lp").read_text()
    assert "Ferry" in run("observe", "x", *THESIS)


@pytest.mark.usefixtures("lifted")
def test_a_name_that_is_asked_for_goes_beside_the_actionary_that_is_named() -> None:
    asked = ("observe", "x", *THESIS)
    known = ("--actionary", "known")
    done = capar(*asked, *known, "--on-unknown", "ask", typed="Ferry\n")
    assert "wrote known/rules/ferry.lp" in done.stderr
    assert not Path("rules").exists()
    assert "Ferry" not in run(*asked)
    assert "Ferry" in run(*asked, *known)


def test_printed_facts_with_the_rule_files_are_a_program() -> None:
    answer = solve([rule_file("thesis.lp")], run("facts", DRINKING, *THESIS))
    assert sorted(name for _, name in answer.of("named")) == sorted(STEPS)


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        (
            ("observe", DRINKING, "--plot", "x.bmp"),
            "no picture format '.bmp'; there are: .png, .svg",
        ),
        (("observe", DRINKING, "--plot", "no/x.png"), "No such file or directory"),
        (("observe", DRINKING, "--json", "--script"), "--json and --script print different things"),
        (("observe", DRINKING, "--script", "--pars"), "--script and --pars print different things"),
        (("obsreve", DRINKING), "Did you mean 'observe'?"),
        (("observe", DRINKING, "--actionary", "notes.md"), "is a file; an Actionary is a folder"),
        (("observe", DRINKING, "--profile", "theses"), "Did you mean 'thesis'?"),
        (("observe", "--live"), "CAPTURE to replay, or --device"),
        (("observe", "--live", DRINKING, "--device", "lsl:x"), "CAPTURE to replay, or --device"),
        (("observe", "--live", "--device", "lsl:x"), "needs --rig"),
        (("observe", "--live", "--device", "lsl:x", "--rig", DRINKING), "needs --calibration"),
        (("observe", "--live", DRINKING, "--plot", "x.png"), "not for --live"),
        (("observe",), "expected a CAPTURE"),
    ],
)
def test_what_cannot_be_done_is_refused_before_anything_is_computed(
    asked: tuple[str, ...], told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("notes.md").write_text("# Notes\n")
    monkeypatch.setattr("extractors.readers.bundle.capture_toml.read_capture", pytest.fail)
    assert told in refused(*asked)


def test_a_fitted_body_changes_nothing_where_its_parts_are_stated() -> None:
    shutil.copytree(DRINKING, "drunk")
    about = Path("drunk/capture.toml")
    about.write_text(f"to_s = 0.7\n{about.read_text()}")
    assert run("observe", "drunk", "--fit") == run("observe", "drunk")


def test_a_replayed_capture_ends_in_what_observing_it_gives() -> None:
    live = run("observe", "--live", DRINKING, "--speed", "0", "--json")
    rows = [json.loads(line) for line in live.splitlines()]
    assert {each["event"] for each in rows} >= {"provisional", "settled", "observation"}
    told = [each for each in rows if each["event"] == "settled"]
    assert "drank from the mug" in " ".join(each["sentence"] for each in told)
    whole = json.loads(run("observe", DRINKING, "--json"))
    assert rows[-1]["observation"] == whole
    assert [each["name"] for each in told] == [
        each["name"] for link in whole["links"] for each in link["segments"]
    ]
