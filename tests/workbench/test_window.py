"""The window is used as its page uses it: what was done, why, what is known, and every mistake."""

import shutil
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from bundles import DRINKING as DEMO
from window_client import Client

from capar.model.observation import SegmentAddress
from capar.workbench.bring import Bring
from capar.workbench.folders import Folders
from capar.workbench.know import Know
from capar.workbench.opening import open_window
from capar.workbench.window import Settings, Window

pytestmark = pytest.mark.long

EVIL = "<img src=x onerror=alert(1)>"


class Opened:
    """A window with the demo in it, observed, and a client of it."""

    def __init__(self, folder: Path) -> None:
        shutil.copytree(DEMO, folder / "drink")
        (folder / "secret").mkdir()
        self.folder = folder / "mine"
        self.folder.mkdir()
        shutil.move(folder / "drink", self.folder / "drink")
        settings = Settings(actionary=str(self.folder / "known"))
        place = str(self.folder / "drink")
        self.window: Window = open_window(Folders([self.folder]), settings, [place])
        self.client = Client(self.window.address)
        self.client.wait_for(lambda: self.window.active.seen is not None)  # type: ignore[union-attr]
        self.settle()

    def settle(self) -> None:
        """Wait until nothing is being done."""
        self.client.read()
        self.window.jobs.wait()
        self.client.read()

    def segment(self, name: str) -> str:
        """The address of the first segment of a name."""
        seen = self.window.active
        assert seen is not None and seen.observation is not None
        own = next(e for e in seen.observation.segments if e.name == name)
        return str(SegmentAddress(own.ee, own.index))


@pytest.fixture(scope="module")
def opened(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Opened]:
    made = Opened(tmp_path_factory.mktemp("window"))
    yield made
    made.client.__exit__()
    made.window.close()


@pytest.fixture(autouse=True)
def alone(request: pytest.FixtureRequest) -> Iterator[None]:
    """Every test leaves a window that answers, and shows no traceback."""
    yield
    made = request.getfixturevalue("opened") if "opened" in request.fixturenames else None
    if made is not None:
        made.settle()
        assert "Traceback" not in made.client.text()
        assert made.window._clock.is_alive()
        Client(made.window.address).__exit__()


def test_what_was_done_is_told_and_drawn_in_lanes(opened: Opened) -> None:
    text = opened.client.text()
    assert "reached for the mug" in text
    assert "touches mug" in text and "<svg" in text and "mug moves" in text


def test_a_moment_shows_what_is_done_then(opened: Opened) -> None:
    opened.client.updates.clear()
    opened.window.choose(opened.segment("Reach"))
    opened.client.set("time [s]", 1.3)
    opened.client.wait_for("right hand: Reach")
    assert opened.window.time_s == 1.3
    assert any("/c0/" in name for _, name in opened.client.updates)


def test_play_goes_on_and_loop_stays_in_the_segment(opened: Opened) -> None:
    segment = opened.window.choose(opened.segment("Reach"))
    opened.window.loop()
    opened.window.speed = 4.0
    end = time.monotonic() + 1.0
    seen = []
    while time.monotonic() < end:
        seen.append(opened.window.time_s)
        time.sleep(0.02)
    opened.window.loop()
    opened.window.playing, opened.window.speed = False, 1.0
    assert min(seen) >= segment.start_s - 1e-6 and max(seen) <= segment.end_s + 1e-6
    assert len(set(seen)) > 5


def test_contacts_light_up_while_they_last(opened: Opened) -> None:
    shown = opened.window.active.shown  # type: ignore[union-attr]
    assert ("right_hand", "mug") in shown.touching(2.0)
    assert ("right_hand", "mug") not in shown.touching(0.5)


def test_a_chosen_segment_is_explained_with_values_and_limits(opened: Opened) -> None:
    opened.window.choose(opened.segment("Reach"))
    opened.client.wait_for("Reach because")
    text = opened.client.text()
    assert "at most" in text and " mm" in text
    assert "<details" in text


def test_why_not_names_what_is_lacking(opened: Opened) -> None:
    opened.window.choose(opened.segment("MoveObjTo"))
    opened.settle()
    opened.client.set("another name", "MoveObj")
    opened.client.press("Why not?")
    opened.client.wait_for("Nearest rule: move_obj.lp")


def test_keys_step_and_choose(opened: Opened) -> None:
    opened.window.choose(opened.segment("Reach"))
    before = opened.window.time_s
    opened.window.step(3)
    rate = opened.window.active.trial.rate_hz  # type: ignore[union-attr]
    assert opened.window.time_s == pytest.approx(before + 3 / rate)
    opened.window.choose_next(1)
    assert opened.window.segment is not None and opened.window.segment.index == 2


def test_an_answer_leads_to_its_moment(opened: Opened) -> None:
    opened.client.press("Keep what was observed")
    opened.client.wait_for("kept drink_from_mug")
    opened.client.set("question", "segments")
    opened.client.press("Ask")
    opened.client.wait_for("ResumePosture</td>")
    know = next(each for each in opened.window.panels if isinstance(each, Know))
    know.go_to(2)
    assert opened.window.segment is not None and opened.window.segment.index == 2
    assert opened.window.time_s == pytest.approx(opened.window.segment.start_s)


def test_sparql_and_everything_about_an_object(opened: Opened) -> None:
    opened.client.press("Run")
    opened.client.wait_for("Reach")
    know = next(each for each in opened.window.panels if isinstance(each, Know))
    assert "mug" in know.about("object", "mug")
    assert "MoveObjTo" in know.about("action", know._name.options[1])


def test_a_person_corrects_a_segment(opened: Opened) -> None:
    opened.client.press("Keep what was observed")
    opened.client.wait_for("kept drink_from_mug")
    opened.window.choose(opened.segment("Reach"))
    opened.settle()
    opened.client.set("value", "Grope")
    opened.client.set("by", "Ada")
    opened.client.press("Keep this claim")
    opened.client.wait_for("Grope</td>")


def test_a_rule_and_a_purpose_are_kept_and_both_are_taken_back(opened: Opened) -> None:
    file, rule = opened.folder / "drink" / "capture.toml", opened.folder / "known/rules/seize.lp"
    before = file.read_text()
    opened.client.press("Keep what was observed")
    opened.client.wait_for("kept drink_from_mug")
    opened.window.choose(opened.segment("Reach"))
    opened.settle()
    opened.client.set("name", "Seize", "Text")
    opened.client.set("purpose", "Fetch", "Text")
    opened.client.press("Draft a rule")
    opened.client.wait_for("drafted; read it below", 240.0)  # seconds of work, more beside other
    opened.client.press("Keep it")
    opened.client.wait_for("Seize counts now")
    assert rule.exists() and "Fetch" in file.read_text()
    opened.settle()
    opened.client.press("Undo")
    opened.client.wait_for("Seize does not count any more")
    assert not rule.exists() and file.read_text() == before
    opened.client.set("purpose", "", "Text")


def test_names_are_shown_as_text(opened: Opened) -> None:
    know = next(each for each in opened.window.panels if isinstance(each, Know))
    know.query(f'SELECT ("{EVIL}" AS ?x) WHERE {{ }}')
    text = opened.client.text()
    assert EVIL not in text and "&lt;img" in text
    opened.window.complain(EVIL)
    assert EVIL not in opened.client.text()


def refused(opened: Opened, label: str, words: str) -> None:
    """Press a button, and find a new message of what is wrong that has some words."""

    def alerts() -> list[dict[str, Any]]:
        every = [each["props"] for each in opened.client.controls.values()]
        return [each for each in every if 'role="alert"' in each.get("content", "")]

    for each in alerts():
        each["content"] = ""
    opened.client.press(label)
    opened.client.wait_for(lambda: any(words.lower() in e["content"].lower() for e in alerts()))


RULE = 'primitive("Nudge").\n'
MISTAKES = [
    ({"query": "SELECT ?x WHERE {"}, "Run", "no SPARQL"),
    ({"query": "INSERT DATA { <a:b> <a:c> 1 }"}, "Run", "may not write"),
    ({"query": "SELECT * { SERVICE <http://x> {} }"}, "Run", "SERVICE"),
    ({"question": "touching"}, "Ask", "must be given"),
    ({"question": "touching", "object *": "nosuch"}, "Ask", "nosuch"),
    ({"segment": "no address", "by": "Ada", "value": "Grope"}, "Keep this claim", "address"),
    ({"by": ""}, "Keep this claim", "who says so"),
    ({"change": "start", "value": "soon", "by": "Ada"}, "Keep this claim", "no time in seconds"),
    ({"text": "primitive("}, "Check it", "primitive"),
    ({"text": RULE + 'fits(S, "Nudge") :- segment(S, F, T), nosuch(S).'}, "Check it", "nosuch"),
    ({"text": "#script(python)\n#end.\n" + RULE}, "Check it", "script"),
    ({"text": "% nothing"}, "Keep it", "introduces no primitive"),
    ({"text": RULE}, "Keep it", "Nudge"),
    ({"text": 'primitive("Reach").'}, "What would it change?", "Reach"),
    ({"purpose": "to drink"}, "Keep it", "no purpose"),
    ({"name": "not a name"}, "Draft a rule", "name"),
    ({"name": "Reach"}, "Draft a rule", "already"),
    ({"word": "nosuchword"}, "Explain it", "nosuchword"),
    ({"primitive": "Reach"}, "Remove it", "Reach"),
    ({"primitive": "(none)"}, "Take its text above", "choose a primitive"),
    ({}, "Undo", "nothing was kept"),
    ({"another name": "(a name)"}, "Why not?", "choose another name"),
    ({"duration [s]": 0.01}, "Perform it", "at least 0.1 s"),
    ({"new folder": "../outside"}, "Export the motion", "nothing was performed"),
    ({}, "Take this text", "draft a motion file first"),
    ({}, "Add it as an object", "draft a motion file first"),
    ({}, "Leave this sensor or object out", "draft a motion file first"),
    ({"source": "tracker at an address", "tracker": ""}, "Start", "say the address"),
    ({"source": "tracker at an address", "tracker": "nosuch:device"}, "Start", "nosuch"),
    ({}, "End and keep it in the window", "nothing is observed live"),
]  # fmt: skip
TEXTS = {"name", "segment", "text", "word", "capture", "purpose"}
"""Labels that lists have too."""


@pytest.mark.parametrize(("fields", "button", "words"), MISTAKES)
def test_a_mistake_is_told_beside_its_field(
    opened: Opened, fields: dict[str, object], button: str, words: str
) -> None:
    """And the window goes on, as every test of this file leaves it."""
    opened.window.choose(opened.segment("Reach"))
    opened.settle()
    for label, value in fields.items():
        opened.client.set(label, value, "Text" if label in TEXTS else "")
        opened.client.read()
    refused(opened, button, words)


@pytest.mark.parametrize("name", ["../x.bvh", "x.exe", "", ".hidden.bvh", "a/../../x.toml"])
def test_an_upload_stays_in_the_folder_under_a_plain_name(opened: Opened, name: str) -> None:
    bring = next(each for each in opened.window.panels if isinstance(each, Bring))
    try:
        bring.upload(name, b"HIERARCHY")
    except Exception as error:
        assert type(error).__name__ == "FileError"
    outside = {each.name for each in opened.folder.parent.iterdir()}
    assert outside == {"mine", "secret"}
    (opened.folder / "x.bvh").unlink(missing_ok=True)


def test_damaged_files_are_told(opened: Opened) -> None:
    bring = next(each for each in opened.window.panels if isinstance(each, Bring))
    (opened.folder / "broken.bvh").write_text("HIERARCHY\nROOT x\n{")
    (opened.folder / "broken.c3d").write_bytes(b"\x00P" + bytes(600))
    for name in ("broken.bvh", "broken.c3d", "missing.csv"):
        bring.draft(name)
        opened.settle()
        assert 'role="alert"' in bring._file_said.content
    for path in opened.folder.glob("broken.*"):
        path.unlink()
