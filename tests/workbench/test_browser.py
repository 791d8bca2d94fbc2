"""What a person does with the window, done in a browser: from a file to a capture, and on."""

import importlib.util
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest
from bundles import DRINKING

from extractors.readers.bundle.capture_toml import read_capture

CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here"),
    pytest.mark.skipif(
        importlib.util.find_spec("playwright") is None, reason="playwright is not installed"
    ),
]

FLAGS = (
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync",
    "--disable-background-networking", "--disable-component-update", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)  # fmt: skip
WAIT_MS = 120_000


class Person:
    """Looks at the window in a browser, and uses mouse and keys."""

    def __init__(self, page: Any) -> None:
        self.page = page
        self.faults: list[str] = []
        page.on("pageerror", lambda error: self.faults.append(str(error)))

    def tab(self, name: str) -> None:
        """Turn to a tab."""
        self.page.get_by_role("tab", name=name, exact=True).click()

    def unfold(self, name: str) -> None:
        """Open a folder of the tab, or close it."""
        self.page.locator(f'div:visible:text-is("{name}")').last.click()

    def field(self, label: str) -> Any:
        """The field beside a label."""
        beside = self.page.locator(f'label:visible:text-is("{label}")').first
        return beside.locator("xpath=ancestor::div[3]").locator("input, textarea").first

    def write(self, label: str, words: str) -> None:
        """Write into a field."""
        self.field(label).fill(words)

    def pick(self, label: str, words: str) -> None:
        """Choose the first of a list that begins as a pattern says."""
        self.field(label).click()
        options = self.page.get_by_role("option")
        options.filter(has_text=re.compile(f"^{words}")).first.click()

    def press(self, label: str) -> None:
        """Press a button."""
        self.page.locator(f'button:visible:has-text("{label}")').first.click()

    def key(self, key: str) -> None:
        """Press a key while the scene has the attention."""
        self.page.evaluate("document.activeElement.blur()")
        self.page.keyboard.press(key)

    def sees(self, words: str) -> None:
        """Wait until some words are to be seen."""
        found = self.page.locator("*:visible", has_text=re.compile(words)).last
        found.wait_for(timeout=WAIT_MS)

    def rests(self) -> None:
        """Wait until no long work is being done."""
        self.page.locator('button:visible:text-is("Stop")').wait_for(
            state="hidden", timeout=WAIT_MS
        )

    def until(self, holds: Callable[[], bool]) -> None:
        """Wait until something holds."""
        end = time.monotonic() + WAIT_MS / 1e3
        while not holds():
            assert time.monotonic() < end
            self.page.wait_for_timeout(50)

    @property
    def time_s(self) -> float:
        """The moment that is shown [s]."""
        slider = self.page.locator("[role=slider]").first
        return float(slider.get_attribute("aria-valuenow"))


@contextmanager
def served(folder: Path, *arguments: str) -> Iterator[str]:
    """The address of ``capar open``, which is ended by Ctrl-C."""
    capar = Path(sys.executable).parent / "capar"
    command = [str(capar), "open", *arguments, "--no-browser"]
    process = subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    said = ""
    while "the window is at" not in said:
        said = process.stderr.readline()
        assert said, "the window does not open"
    try:
        yield said.split()[-1]
    finally:
        process.send_signal(signal.SIGINT)
        rest = process.communicate(timeout=60)[1]
        assert "Traceback" not in rest
        assert process.returncode in (0, 130)


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=CHROMIUM, args=list(FLAGS))
        yield browser
        browser.close()


@pytest.fixture
def window(chromium: Any, tmp_path: Path) -> Iterator[Callable[..., Person]]:
    """Opens a window with captures of an empty folder, and a browser that looks at it."""
    with ExitStack() as opened:

        def at(*arguments: str) -> Person:
            address = opened.enter_context(served(tmp_path, *arguments))
            page = chromium.new_page(viewport={"width": 1000, "height": 700})
            opened.callback(page.close)
            page.set_default_timeout(WAIT_MS)
            page.goto(address)
            person = Person(page)
            person.tab("Live")  # the last one: everything is there
            person.tab("See")
            person.rests()
            return person

        yield at


def drinking(folder: Path, added: str = "") -> str:
    """A short capture in a folder."""
    path = shutil.copytree(DRINKING, folder / "drink") / "capture.toml"
    path.write_text(added + path.read_text())
    return "drink"


def test_from_a_foreign_bvh_to_a_saved_bundle(
    window: Callable[..., Person], recordings: Path, tmp_path: Path
) -> None:
    person = window(drinking(tmp_path))
    person.tab("File")
    foreign = recordings / "foreign_files" / "test3.bvh"
    person.page.locator("input[type=file]").first.set_input_files(foreign)
    person.sees("test3.bvh is there")
    person.press("Draft its capture.toml")
    person.sees("drafted; look at it below")
    person.pick("up", "y")
    person.pick("of", "sensor .*right_hand")
    person.write("shape", "{ sphere = }")
    person.sees("is no value")
    person.write("shape", "{ sphere = 0.05 }")
    person.pick("of", "general")
    person.pick("up", "z")
    person.write("name", "somebody stands")
    person.write("new folder", "stands")
    person.press("Save the draft")
    person.sees("saved the draft as stands")
    person.rests()
    person.tab("See")
    person.sees("Stand")
    assert "sphere" in (tmp_path / "stands" / "capture.toml").read_text()
    assert read_capture(str(tmp_path / "stands")).name == "somebody stands"
    assert not person.faults


def test_from_the_demo_to_an_explanation_with_the_keys(window: Callable[..., Person]) -> None:
    person = window()
    person.key("n")
    person.key("n")
    person.tab("Why")
    person.sees("because the right hand")
    person.sees("at most")
    person.pick("jump to frame", "1")
    at = person.time_s
    person.key("l")
    person.until(lambda: person.time_s > at)
    person.key("j")
    person.until(lambda: abs(person.time_s - at) < 1e-3)
    person.key("Space")
    person.until(lambda: person.time_s > at + 0.3)
    person.key("Space")
    person.pick("another name", "Drop")
    person.press("Why not?")
    person.sees("Drop")
    assert not person.faults


def test_from_an_unknown_segment_to_a_rule_that_counts_and_back(
    window: Callable[..., Person], tmp_path: Path
) -> None:
    """The capture ends with the mug in the air, which no rule of the thesis names."""
    person = window(drinking(tmp_path, "to_s = 2.15\n"), "--profile", "thesis")
    kept = tmp_path / "rules" / "ferry.lp"
    person.tab("Rules")
    person.pick("unknown here", "right_hand/")
    person.write("name", "Ferry")
    person.press("Draft a rule")
    person.sees("drafted; read it below")
    person.press("What would it change?")
    person.sees("segments that would change: 1; it does not count yet")
    assert not kept.exists()
    person.press("Keep it")
    person.sees("Ferry counts now")
    person.rests()
    assert kept.exists()
    person.sees("right hand: Ferry")
    person.press("Undo")
    person.sees("Ferry does not count any more")
    person.rests()
    assert not kept.exists()
    person.sees("right hand: Unknown")
    assert not person.faults


def test_from_a_recording_to_a_child_who_does_it_beside_it(
    window: Callable[..., Person], tmp_path: Path
) -> None:
    person = window()
    person.tab("Do again")
    person.press("Perform it")
    person.sees("child performs drink_from_mug: ")
    person.press("Stop")
    person.sees("stopped; nothing was kept")
    person.press("Perform it")
    person.sees("performed by child: every gate holds")
    person.rests()
    person.write("new folder", "child_drinks")
    person.press("Save it")
    person.sees("saved drink_from_mug_child as child_drinks")
    assert read_capture(str(tmp_path / "child_drinks")).agent.name == "child"
    assert not person.faults


def test_a_simulated_tracker_is_observed_while_it_moves(
    window: Callable[..., Person], tmp_path: Path
) -> None:
    person = window(drinking(tmp_path))
    person.tab("Live")
    person.press("Start")
    person.sees("live: observing")
    person.sees("MoveObjTo")
    person.press("End and keep it in the window")
    person.sees("frames are in the window as live_1")
    person.rests()
    person.tab("See")
    person.press("Save this capture")
    person.sees("saved live_1 in live_1")
    assert read_capture(str(tmp_path / "live_1")).name == "live_1"
    assert not person.faults
