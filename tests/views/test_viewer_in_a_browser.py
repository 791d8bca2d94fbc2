"""The page of a fitted body in a browser: what the mouse and keys change, against the recording."""

import json
import time
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from browser import Page, browser_missing, opened
from marker_people import RATE_HZ, walker, write_trc
from matplotlib.image import imread
from typer.testing import CliRunner

from capar.cli import app
from extractors.readers.drafting.draft import draft
from extractors.readers.registry import read_recording

pytestmark = pytest.mark.skipif(bool(browser_missing()), reason=browser_missing() or "-")

ANKLE_M = 0.09
"""The ankle's joint is half a foot's breadth inside of the marker on the malleolus [m]."""


@pytest.fixture(scope="module")
def markers() -> dict[str, np.ndarray]:
    """Two seconds of somebody who walks [m]."""
    return {name: at[100:300] for name, at in walker().items()}


@pytest.fixture(scope="module")
def written(markers: dict[str, np.ndarray], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page that ``capar view --fit --html`` writes of it."""
    folder = tmp_path_factory.mktemp("walk")
    write_trc(folder / "walk.trc", {name: 1000.0 * at for name, at in markers.items()})
    text = draft([read_recording(folder / "walk.trc")], folder, "walk")
    (folder / "capture.toml").write_text(text)
    asked = ["view", str(folder), "--fit", "--html", str(folder / "walk.html")]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 0, done.output
    return folder / "walk.html"


@pytest.fixture
def page(written: Path, tmp_path: Path) -> Iterator[Page]:
    with opened(written, tmp_path / "profile") as found:
        yield found


def clock(page: Page) -> float:
    """The time that the page shows [s]."""
    return float(page.evaluate('document.getElementById("clock").textContent').split()[0])


def place(page: Page, body: str) -> np.ndarray:
    """Where a body is drawn [m]."""
    name = json.dumps(body)
    return np.array(page.evaluate(f"bodies.get({name}).group.getWorldPosition(new THREE.Vector3())"
                                  ".toArray()"))  # fmt: skip


def turn(page: Page, body: str) -> np.ndarray:
    """Its orientation, scalar last."""
    name = json.dumps(body)
    return np.array(page.evaluate(f"bodies.get({name}).group.quaternion.toArray()"))


def feet_are_at_their_markers(page: Page, markers: dict[str, np.ndarray]) -> None:
    """Whether the skeleton is drawn where the ankles' markers were at the time that is shown."""
    frame = round(clock(page) * RATE_HZ)
    for side, marker in (("right", "RANK"), ("left", "LANK")):
        apart = place(page, f"body_{side}_foot") - markers[marker][frame]
        assert np.linalg.norm(apart) < ANKLE_M


def picture(page: Page) -> np.ndarray:
    """The drawn scene."""
    height = page.evaluate('document.getElementById("scene").clientHeight')
    return np.asarray(imread(BytesIO(page.screenshot()))[: int(height), :, :3])


def test_scrubbing_moves_time_the_skeleton_and_the_picture(
    page: Page, markers: dict[str, np.ndarray]
) -> None:
    assert clock(page) == 0.0
    feet_are_at_their_markers(page, markers)
    before, foot = picture(page), place(page, "body_left_foot")
    page.click("#scrub", across=0.75)
    duration = (len(markers["C7"]) - 1) / RATE_HZ
    assert clock(page) == pytest.approx(0.75 * duration, abs=0.05)
    feet_are_at_their_markers(page, markers)
    assert np.linalg.norm(place(page, "body_left_foot") - foot) > 0.3
    changed = np.abs(picture(page) - before).max(axis=2) > 0.1
    assert 0.005 < changed.mean() < 0.5


def test_playing_runs_on_and_stops(page: Page, markers: dict[str, np.ndarray]) -> None:
    page.evaluate('element("speed").value = "0.25"')
    page.click("#play")
    assert page.evaluate('document.getElementById("play").textContent') == "Pause"
    page.wait_for("times[frame] > 0.3")
    page.click("#play")
    assert page.evaluate('document.getElementById("play").textContent') == "Play"
    stopped, pelvis = clock(page), place(page, "body_pelvis")
    assert 0.3 <= stopped < 1.9  # the page shows hundredths
    feet_are_at_their_markers(page, markers)
    time.sleep(0.3)
    assert clock(page) == stopped
    np.testing.assert_array_equal(place(page, "body_pelvis"), pelvis)
    page.press("ArrowRight")
    assert clock(page) > stopped


def test_an_event_that_is_clicked_is_shown_and_highlighted(
    page: Page, markers: dict[str, np.ndarray]
) -> None:
    asked = (
        '[...document.querySelectorAll(".span")].map((e) => [Number(e.dataset.start), '
        "Number(e.dataset.end), e.classList.contains('now'), e.textContent])"
    )
    index = next(
        number
        for number, (first, _, _, label) in enumerate(page.evaluate(asked))
        if label in ("Walk", "Step") and first > 0.5
    )
    assert not page.evaluate(asked)[index][2]
    page.click(".span", index=index)
    spans = page.evaluate(asked)
    start = spans[index][0]
    now = page.evaluate("times[frame]")
    assert now == pytest.approx(start, abs=0.02)
    assert spans[index][2]
    for first, last, shown, _ in spans:
        assert shown == (first <= now <= last)
    assert not all(shown for _, _, shown, _ in spans)
    feet_are_at_their_markers(page, markers)
    left, track = page.evaluate(
        '[element("cursor").getBoundingClientRect().x, '
        'document.querySelectorAll(".span")[' + str(index) + "].getBoundingClientRect().x]"
    )
    assert left == pytest.approx(track, abs=12.0)


def test_the_knee_bends_between_stance_and_swing(page: Page) -> None:
    page.click("#scrub", across=0.02)
    angles = []
    for across in (0.02, 0.1, 0.2, 0.3, 0.4):
        page.click("#scrub", across=across)
        thigh, shank = turn(page, "body_left_thigh"), turn(page, "body_left_shank")
        angles.append(2.0 * np.arccos(min(abs(float(thigh @ shank)), 1.0)))
    assert np.degrees(max(angles) - min(angles)) > 15.0


def test_nothing_is_asked_of_a_network(page: Page) -> None:
    assert page.requests
    assert all(each.startswith(("file:", "data:", "blob:")) for each in page.requests)
