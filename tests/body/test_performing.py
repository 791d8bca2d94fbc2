"""Virtual performers do what their scripts say, and what they do is observed."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from combinations import EVERY
from virtual_bodies.drinking import steps_of

from capar import regeneration
from capar.body.anthropometry import ready_made
from capar.body.gaze_control import lines_of_sight
from capar.body.human import Human
from capar.body.performing import Performance, PerformanceError, perform
from capar.body.recording import record, truth_of, write_bundle
from capar.body.scripted_actions import action_capture, performed
from capar.body.scripts import (
    GRAVITY_MPS2,
    Script,
    drink,
    lift_with_both_hands,
    sip,
    slide,
    touch,
)
from capar.body.sensors import Tracker
from capar.body.virtual_scenes import Scene, Thing, box, cup, scene, table
from capar.model.errors import UnknownNameError
from capar.pipelines.observation import observe
from capar.regeneration.collisions import Pair, Surroundings
from extractors.readers.bundle.capture_toml import read_capture

pytestmark = pytest.mark.long

RATE_HZ = 30.0
BODIES = ("man", "woman", "child") if EVERY else ("child",)


def _scene(human: Human) -> Scene:
    """A table at hip height with a cup on the right and a box ahead."""
    tall = human.measures["stature"]
    top = 0.52 * tall
    mug = Thing("mug", cup(0.035, 0.09), (0.22 * tall, -0.10 * tall, top), round=True)
    crate = Thing("crate", box(0.15, 0.20, 0.15), (0.24 * tall, 0.08 * tall, top))
    return scene(table(top, near_m=0.13 * tall), mug, crate)


SCRIPTS: dict[str, Script] = {
    "drink": drink("mug"),
    "sip": sip("mug"),
    "touch": touch("crate"),
    "reach": touch("crate", side="left", seconds=0.25),
    "slide": slide("mug", (0.0, 0.12, 0.0)),
    "lift": lift_with_both_hands("crate", height=0.2),
}


@cache
def _act(who: str, what: str) -> Performance:
    human = Human.of(ready_made(who))
    return perform(human, _scene(human), SCRIPTS[what], rate_hz=RATE_HZ)


ACTED = [
    *(("man", what) for what in SCRIPTS),
    ("child", "drink"),
    ("woman", "lift"),
    ("woman", "sip"),
]


@pytest.fixture(scope="module", params=ACTED, ids=" ".join)
def acted(request: pytest.FixtureRequest) -> Performance:
    return _act(*request.param)


def test_every_agent_does_every_action_like_a_body(acted: Performance) -> None:
    human, motion = acted.human, acted.motion
    assert not human.outside(motion, margin=1e-4).any()
    speeds = np.abs(np.diff(motion[:, 7:], axis=0)) * RATE_HZ
    assert speeds.max() < 20.0, "no joint jumps [rad/s]"
    feet = human.sites(motion, ["right_foot", "left_foot"])
    for spots, _ in feet.values():
        assert np.ptp(spots, axis=0).max() < 0.004
    heights = [human.centre_of_mass(posture)[:2] for posture in motion[::25]]
    assert np.ptp(heights, axis=0).max() < 0.08, "the weight stays over the feet"


def test_what_is_not_held_stays_where_it_was(acted: Performance) -> None:
    moved = {name for phase in acted.script for name in phase.moves}
    for name, path in acted.things.items():
        travelled = float(np.ptp(path.translation, axis=0).max())
        assert (travelled > 0.05) == (name in moved)
        assert path.translation[:, 2].min() >= acted.scene.thing(name).place[2] - 1e-9


@pytest.mark.parametrize("who", ["man", "woman"])
def test_no_forearm_is_inside_the_box_that_is_lifted(who: str) -> None:
    acted = _act(who, "lift")
    around = Surroundings(acted.human, regeneration.Scene(acted.scene.things, (0.0, 0.0), 0.0))
    for frame in range(0, len(acted.times), 2):
        around.pose(acted.motion[frame], {n: path[frame] for n, path in acted.things.items()})
        found = around.near(["right_forearm", "left_forearm", "right_hand", "left_hand"])
        assert min(pair.distance_m for pair in [*found, Pair(1.0, "", "")]) > -0.001


def test_the_gaze_is_at_the_thing_before_the_hand_is(acted: Performance) -> None:
    name, start, end = next(each for each in acted.phases if each[0] == "reach")
    assert name == "reach"
    looked = next(p.look for p in acted.script if p.name == "reach")
    frame = int(np.flatnonzero(acted.times < start + 0.5 * (end - start))[-1])
    spots, ways = lines_of_sight(acted.human, acted.motion[frame][None])
    thing = acted.scene.thing(looked)
    middle = np.array(thing.place) + np.array([0.0, 0.0, 0.5 * thing.size[2]])
    wanted = (middle - spots[0]) / np.linalg.norm(middle - spots[0])
    assert np.degrees(np.arccos(np.clip(wanted @ ways[0], -1.0, 1.0))) < 3.0


def test_a_drink_meets_the_mouth_and_ends_where_it_began() -> None:
    acted = _act("man", "drink")
    contacts = truth_of(acted).contacts
    assert [pair[:2] for pair in contacts] == [
        ("crate", "table"),
        ("mug", "head"),
        ("mug", "table"),
        ("mug", "table"),
        ("right_hand", "mug"),
    ]
    start, end = next(each[1:] for each in acted.phases if each[0] == "drink")
    sip = contacts[1]
    assert sip[2] <= start + 0.05
    assert sip[3] >= end - 0.05
    last = acted.things["mug"].translation[-1]
    np.testing.assert_allclose(last, acted.scene.thing("mug").place, atol=1e-9)


def test_a_bundle_reads_back_as_the_capture_and_is_the_same_each_time(tmp_path: Path) -> None:
    acted = _act("man", "slide")
    seen = record(acted, name="slides", seed=3, tracker=Tracker(dropouts_per_s=0.5))
    for folder in ("one", "two"):
        again = record(acted, name="slides", seed=3, tracker=Tracker(dropouts_per_s=0.5))
        write_bundle(again, truth_of(acted), tmp_path / folder)
    files = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert {"capture.toml", "motion.csv", "truth.toml", "mug.obj"} <= set(files)
    for name in files:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()
    read = read_capture(tmp_path / "one")
    assert [each.name for each in read.sensors] == [each.name for each in seen.sensors]
    assert [each.name for each in read.objects] == [each.name for each in seen.objects]
    for name, body in seen.bodies.items():
        np.testing.assert_allclose(
            read.bodies[name].stream.positions, body.stream.positions, atol=1e-6
        )
    assert read.agent.measures["upper_arm"] == acted.human.measures["upper_arm"].__round__(4)


def test_what_cannot_be_reached_is_refused_with_the_distance() -> None:
    human = Human.of(ready_made("child"))
    far = scene(table(0.7), Thing("mug", cup(0.035, 0.09), (1.6, 0.0, 0.7), round=True))
    with pytest.raises(PerformanceError, match=r"misses 'mug' by \d+ mm in 'grasp'"):
        perform(human, far, slide("mug", (0.1, 0.0, 0.0)), rate_hz=20.0)
    with pytest.raises(UnknownNameError, match="no thing 'cup'"):
        perform(human, far, touch("cup"), rate_hz=20.0)


FAST_HZ = 60.0


@pytest.mark.parametrize("who", BODIES)
def test_between_the_hands_only_gravity_moves_it(who: str) -> None:
    made = performed("toss", who, rate_hz=FAST_HZ)
    ((start, end),) = [(start, end) for name, start, end in made.phases if name == "fly"]
    first, last = (round(at * FAST_HZ) - 1 for at in (start, end))
    spots = made.things["mug"].translation[first : last + 1]
    assert len(spots) > 10
    bent = np.diff(spots, n=2, axis=0) * FAST_HZ**2
    np.testing.assert_allclose(bent, np.tile(GRAVITY_MPS2, (len(bent), 1)), atol=1e-6)


@pytest.mark.parametrize("who", BODIES)
def test_it_is_observed_as_thrown_by_one_hand_and_caught_by_the_other(who: str) -> None:
    seen = observe(action_capture("toss", who, rate_hz=FAST_HZ), rules="extended")
    names = {
        link.ee: [part.name for part in link.segments if part.name in {"Throw", "Catch"}]
        for link in seen.links
    }
    assert names == {"right_hand": ["Throw"], "left_hand": ["Catch"]}


SIPS = {
    "extended": (
        "Reach(mug)", "MoveObjTo(mug, head)", "Drink(mug, head)", "MoveObjTo(mug, table)",
        "TouchWith(mug, table)", "ResumePosture(mug)",
    ),
    "thesis": (
        "Reach(mug)", "MoveObjTo(mug, head)", "MoveObj(mug, head)", "MoveObjTo(mug, table)",
        "TouchWith(mug, table)", "ResumePosture(mug)",
    ),
}  # fmt: skip
"""The published steps (thesis 5.2.1); Drink is a MoveObj."""


@pytest.mark.parametrize("who", BODIES)
@pytest.mark.parametrize("noisy", [False, True])
@pytest.mark.parametrize("profile", ["extended", "thesis"])
def test_a_sip_is_the_published_six_steps(who: str, profile: str, *, noisy: bool) -> None:
    capture = action_capture("sip", who, rate_hz=103.3, noisy=noisy)
    assert steps_of(observe(capture, rules=profile)) == SIPS[profile]


"""Each action by another body; how it looks depends on the two apart."""
