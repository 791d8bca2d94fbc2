"""What is known with reservations is said with it: by ``describe`` and by ``explain``."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import motions
import numpy as np
import pytest
from typer.testing import CliRunner
from write_demo import write_tables

from capar.cli import app
from capar.model.capture import Capture, Stream

HEADING = "Known with reservations:"
BUNDLE = """\
name = "touching"
unit = "m"
up = "z"

[files]
motion = "motion.csv"

[agent]
name = "anna"
kind = "woman"

[[sensor]]
name = "right_hand"
end_effector = "hand"
side = "right"
body = "right_hand"
shape = { mesh = "right_hand.obj" }

[[object]]
name = "box"
tag = "mobile"
body = "box"
shape = { box = [0.22, 0.16, 0.12], position = [0.0, 0.0, 0.06] }

[[object]]
name = "post"
tag = "fixed"
position = [3.0, 3.0, 0.0]
shape = { sphere = 0.1 }
"""


def lost(capture: Capture, name: str, first: int, last: int) -> Capture:
    """The capture, an object of which was not tracked in those frames."""

    def cut(stream: Stream) -> Stream:
        positions, orientations = stream.positions.copy(), stream.orientations.copy()
        positions[first:last], orientations[first:last] = np.nan, np.nan
        return Stream(stream.times, positions, orientations)

    objects = (
        replace(each, stream=cut(each.stream)) if each.name == name else each
        for each in capture.objects
    )
    return replace(capture, objects=tuple(objects))


@pytest.fixture
def bundle(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[int, int], str]:
    monkeypatch.chdir(tmp_path)
    for each in ("CAPAR_ACTIONARY", "CAPAR_RULES"):
        monkeypatch.delenv(each, raising=False)

    def written(first: int, last: int) -> str:
        capture = motions.touch_from_rest(motions.WOMAN).capture
        write_tables(lost(capture, "box", first, last), tmp_path / "touching")
        (tmp_path / "touching" / "capture.toml").write_text(BUNDLE, encoding="utf-8")
        return "touching"

    return written


def run(*arguments: str) -> str:
    result = CliRunner().invoke(app, list(arguments), catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.stdout


def test_stand_ins_are_told_after_the_text(bundle: Callable[[int, int], str]) -> None:
    told, _, notes = run("describe", bundle(0, 0)).partition(f"\n{HEADING}\n")
    assert told == "Anna reached for the box with the right hand and touched it.\n"
    assert notes.splitlines()[0].endswith("assumed: box, post.")


def test_json_lists_them_by_code(bundle: Callable[[int, int], str]) -> None:
    found = json.loads(run("describe", bundle(0, 0), "--json"))
    assert [each["code"] for each in found["notices"]] == ["stand-in-shape"] * 2
    assert found["notices"][0]["message"].startswith("'box' is a stand-in")


def test_what_was_never_tracked_is_said_to_be_lost_throughout_and_once(
    bundle: Callable[[int, int], str],
) -> None:
    place = bundle(0, 10_000)
    told = run("describe", place)
    assert told.startswith("Anna moved the right hand without touching anything.")
    assert sum("not tracked" in each.lower() for each in told.splitlines()) == 1


def test_a_loss_is_told_once_with_its_interval(bundle: Callable[[int, int], str]) -> None:
    told = run("describe", bundle(20, 60))
    (line,) = [each for each in told.splitlines() if "tracked" in each]
    assert "from 0.19 to 0.57 s" in line
    assert line.endswith("box.")


def test_explain_tells_those_of_the_bodies_that_its_segment_is_about(
    bundle: Callable[[int, int], str],
) -> None:
    place = bundle(0, 0)
    for arguments in ((place,), (place, "right_hand/1"), (place, "--why-not", "Hit")):
        told, _, notes = run("explain", *arguments).partition(f"\n{HEADING}\n")
        assert "the right hand touched the box" in told or "Nearest rule: hit" in told
        assert "box" in notes
        assert "post" not in notes
    for arguments in ((), ("--why-not", "Hit")):
        rows = json.loads(run("explain", place, *arguments, "--json"))
        codes = [[each["code"] for each in row["notices"]] for row in rows]
        assert ["stand-in-shape"] in codes
        assert not any("post" in str(row["notices"]) for row in rows)


def test_observe_tells_many_alike_in_one_line(bundle: Callable[[int, int], str]) -> None:
    place = Path(bundle(0, 0)) / "capture.toml"
    post = BUNDLE.partition('[[object]]\nname = "post"')[2]
    posts = [f'\n[[object]]\nname = "post{each}"{post}' for each in range(5)]
    place.write_text(BUNDLE + "".join(posts), encoding="utf-8")
    result = CliRunner().invoke(app, ["observe", "touching"], catch_exceptions=False)
    (line,) = [each for each in result.stderr.splitlines() if "stand-in" in each]
    names = "box, post, post0 and others (--json tells all)"
    assert line == f"note [stand-in-shape]: 7 stand-in shapes: {names}"


def test_what_is_known_without_reservation_has_none_said(tmp_path: Path) -> None:
    capture = motions.touch_from_rest(motions.WOMAN).capture
    write_tables(capture, tmp_path)
    text = BUNDLE.partition('[[object]]\nname = "post"')[0]
    text = re.sub(r"{ box = .*}", '{ mesh = "box.obj" }', text)
    (tmp_path / "capture.toml").write_text(text, encoding="utf-8")
    assert HEADING not in run("describe", str(tmp_path)) + run("explain", str(tmp_path))
    assert json.loads(run("describe", str(tmp_path), "--json"))["notices"] == []
