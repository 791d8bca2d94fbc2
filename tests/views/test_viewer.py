"""The view of a capture: what is in the page and in the picture, and how the page answers."""

import json
import re
import shutil
import subprocess
import sys
from base64 import b64decode
from dataclasses import replace
from io import BytesIO
from itertools import combinations

import motions
import numpy as np
import pytest
import trimesh
from bundles import DRINKING
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.image import imread
from scipy.spatial.transform import Rotation

from capar.body.scripted_actions import action_capture
from capar.cli import main
from capar.model.facts import Touching
from capar.pipelines.observation import observe
from capar.views.viewer.snapshot import Box, meet, place_labels, snapshot
from capar.views.viewer.stage import stage, with_fingers
from capar.views.viewer.web_page import web_page

CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
FLAGS = (
    "--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-sync",
    "--disable-background-networking", "--disable-component-update", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--virtual-time-budget=20000",
)  # fmt: skip


@pytest.fixture(scope="module")
def capture():
    return motions.drink_from_mug(motions.WOMAN).capture


@pytest.fixture(scope="module")
def page(capture):
    return web_page(stage(capture), observe(capture))


def held(page: str, name: str) -> str:
    """What the page holds in the script element of that name."""
    found = re.search(rf'<script type="[^"]+" id="{name}">(.*?)</script>', page, re.DOTALL)
    assert found
    return found[1]


def floats(text: str) -> np.ndarray:
    return np.frombuffer(b64decode(text), dtype="<f4")


def test_the_page_holds_every_body_where_it_was(capture, page):
    data = json.loads(held(page, "data"))
    times = floats(data["times"])
    assert times[-1] == pytest.approx(capture.times[-1])
    assert {each["name"] for each in data["bodies"]} == set(capture.bodies)
    frames = np.searchsorted(capture.times, times - 1e-4)
    for each in data["bodies"]:
        stream = capture.bodies[each["name"]].stream
        places = floats(each["positions"]).reshape(-1, 3)
        turns = floats(each["orientations"]).reshape(-1, 4)
        np.testing.assert_allclose(places, stream.positions[frames], atol=1e-6)
        np.testing.assert_allclose(turns, stream.orientations[frames], atol=1e-6)


def test_the_surfaces_read_back_as_they_are(capture, page):
    scene = trimesh.load(BytesIO(b64decode(held(page, "surfaces"))), file_type="glb", process=False)
    shaped = {name: each.shape for name, each in capture.bodies.items() if each.shape}
    assert set(scene.geometry) == set(shaped)
    for name, shape in shaped.items():
        mesh = scene.geometry[name]
        np.testing.assert_allclose(
            mesh.vertices[mesh.faces], np.array(shape.vertices)[shape.faces], atol=1e-6
        )


def test_the_timeline_has_each_segment_and_each_contact(capture, page):
    seen = observe(capture)
    data = json.loads(held(page, "data"))
    row = next(each for each in data["rows"] if each.get("label") == "right hand")
    assert [each["label"] for each in row["spans"]] == [each.name for each in seen.segments]
    assert row["spans"][0]["end"] == pytest.approx(seen.segments[0].end_s, abs=1e-3)
    assert ["right_hand", "mug"] in [each[:2] for each in data["contacts"]]


def test_the_page_asks_nothing_of_a_network_and_is_the_same_each_time(capture, page):
    addresses = set(re.findall(r"\bhttps?://[\w./-]+", page))
    assert addresses == {"http://www.w3.org/1999/xhtml"}
    assert page == web_page(stage(capture), observe(capture))


def test_hands_of_virtual_bodies_have_fingers_that_close_on_what_they_touch():
    capture = action_capture("touch", rate_hz=30.0)
    found = observe(capture)
    shown = with_fingers(stage(capture), capture, found.facts)
    bones = {body.name: body for body in shown.bodies if body.kind == "finger"}
    assert len(bones) == 30
    contact = next(
        fact for fact in found.facts if isinstance(fact, Touching) and fact.other == "crate"
    )
    crate, frame = capture.tag_object("crate"), (contact.first + contact.last) // 2
    top = crate.stream.positions[frame, 2] + crate.shape.bounds[1, 2]
    lowest = {}
    for name in ("right_index_3", "right_little_3", "left_index_3"):
        turn = Rotation.from_quat(bones[name].orientations[frame], scalar_first=True)
        spots = turn.apply(np.array(bones[name].shape.vertices)) + bones[name].positions[frame]
        lowest[name] = spots[:, 2].min() - top
    assert -0.002 < lowest["right_index_3"] < 0.002
    assert -0.002 < lowest["right_little_3"] < 0.002
    assert [body.label for body in shown.bodies][:3] == [
        body.label for body in stage(capture).bodies
    ][:3]


def test_recorded_hands_are_shown_as_they_are(capture):
    shown = stage(capture)
    assert with_fingers(shown, capture, observe(capture).facts).bodies == shown.bodies


def test_bodies_without_surfaces_and_without_an_observation_are_shown_too(capture, tmp_path):
    bare = replace(
        capture,
        sensors=tuple(replace(each, shape=None) for each in capture.sensors),
        objects=tuple(replace(each, shape=None) for each in capture.objects),
    )
    data = json.loads(held(web_page(stage(bare)), "data"))
    assert data["rows"] == []
    assert len(data["bodies"]) == len(capture.bodies)
    snapshot(stage(bare), 1.0, tmp_path / "bare.png")
    assert imread(tmp_path / "bare.png").std() > 0.0


def test_a_picture_shows_another_moment_otherwise_and_the_same_alike(capture, tmp_path):
    shown = stage(capture)
    drawn = []
    for name, time_s in (("a", 0.2), ("b", 0.2), ("c", 2.0)):
        snapshot(shown, time_s, tmp_path / f"{name}.png")
        drawn.append((tmp_path / f"{name}.png").read_bytes())
    assert drawn[0] == drawn[1] != drawn[2]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((), "give --html FILE, or --png FILE"),
        (("--at", "1"), "give --png FILE too"),
        (("--png", "{}/a.png", "--at", "77"), "the capture lasts from 0 to"),
        (("--html", "{}/no/such/folder.html"), "needs an existing folder"),
    ],
)
def test_what_cannot_be_shown_is_said_and_nothing_is_written(
    arguments, told, tmp_path, monkeypatch, capsys
):
    given = [each.format(tmp_path) for each in arguments]
    monkeypatch.setattr(sys, "argv", ["capar", "view", str(DRINKING), *given])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    assert told in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here")
def test_a_browser_scrubs_plays_and_goes_to_a_segment_that_is_clicked(page, tmp_path):
    driver = """
    <script>
    const told = {};
    const wait = setInterval(() => {
      if (document.body.dataset.ready !== "yes") return;
      clearInterval(wait);
      const clock = () => document.getElementById("clock").textContent;
      const scrub = document.getElementById("scrub");
      told.start = clock();
      scrub.value = scrub.max; scrub.dispatchEvent(new Event("input")); told.scrubbed = clock();
      const spans = [...document.querySelectorAll(".span")];
      const drink = spans.find((each) => each.textContent === "Drink");
      drink.click(); told.clicked = clock(); told.now = drink.classList.contains("now");
      const play = document.getElementById("play");
      play.click(); told.playing = play.textContent;
      setTimeout(() => {
        told.played = clock();
        document.body.dataset.told = JSON.stringify(told);
      }, 600);
    }, 50);
    </script></html>"""
    path = tmp_path / "page.html"
    path.write_text(page.replace("</html>", driver), encoding="utf-8")
    done = subprocess.run(
        [CHROMIUM, *FLAGS, f"--user-data-dir={tmp_path / 'profile'}", "--dump-dom", path.as_uri()],
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    found = re.search(r'data-told="([^"]+)"', done.stdout)
    assert found, done.stderr[-2000:]
    told = json.loads(found[1].replace("&quot;", '"'))
    data = json.loads(held(page, "data"))
    drink = next(
        span for row in data["rows"] for span in row.get("spans", ()) if span["label"] == "Drink"
    )
    assert told["start"] == "0.00 s"
    assert float(told["scrubbed"].split()[0]) == pytest.approx(floats(data["times"])[-1], abs=0.01)
    assert float(told["clicked"].split()[0]) == pytest.approx(drink["start"], abs=0.02)
    assert told["now"]
    assert told["playing"] == "Pause"
    assert float(told["played"].split()[0]) > float(told["clicked"].split()[0]) + 0.3


PAGE = (9.0, 6.6)
places = st.tuples(st.floats(3.0, 6.0), st.floats(2.0, 4.5))
SCENES = 25
"""So many scenes are tried: one takes a quarter of a second."""

bodies = st.lists(st.tuples(places, st.floats(0.05, 0.6), st.floats(0.3, 1.0)), max_size=12)


@settings(max_examples=SCENES)
@given(bodies)
def test_no_name_stands_on_another_or_leaves_the_page(
    parts: list[tuple[tuple[float, float], float, float]],
) -> None:
    drawn: list[Box] = [(x - half, x + half, y - half, y + half) for (x, y), half, _ in parts]
    boxes = place_labels(drawn, [(wide, 0.17) for *_, wide in parts], PAGE)
    for one, other in combinations(boxes, 2):
        assert not meet(one, other)
    for box in boxes:
        assert box[0] >= 0.0 and box[1] <= PAGE[0] and box[2] >= 0.0 and box[3] <= PAGE[1]
