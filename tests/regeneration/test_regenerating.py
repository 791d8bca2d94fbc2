"""Other bodies do in other scenes what was recorded, or it is said why they cannot."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from exit_codes import exit_code
from recorded_actions import recorded

from capar.body.recording import Truth, write_bundle
from capar.body.scripted_actions import action_capture
from capar.model.capture import Capture
from capar.pipelines.round_trips import body, observed_source, round_trips
from capar.regeneration import Motion, PlanError, Quality, regenerate, search
from capar.regeneration.body_frames import body_frames
from capar.regeneration.direct_mapping import departures
from capar.regeneration.grips import Grip, Turn
from capar.regeneration.planning import Draft, Miss
from capar.regeneration.quality import Gate, quality
from capar.regeneration.scenes import moved, raised
from capar.regeneration.search import reachable
from capar.regeneration.sources import body_hand_frame
from capar.regeneration.styles import own_style

pytestmark = pytest.mark.long

RATE_HZ = 30.0


@cache
def _done(action: str, agent: str) -> tuple[Motion, Quality]:
    source = recorded(action)
    return regenerate(source, body(agent, source))


def test_the_frame_on_a_recorded_hand_is_the_one_on_the_body_that_was_recorded() -> None:
    source = recorded("drink")
    for side, hand in source.hands.items():
        own = body_hand_frame(source.human, side)
        np.testing.assert_allclose(hand.frame.extents, own.extents, atol=2e-4)
    rest = body_frames(source.human, source.scene).rest["right"]
    away = rest.inv() * source.hands["right"].path[0]
    assert np.linalg.norm(away.translation) < 0.005
    assert away.rotation.magnitude() < np.radians(1.0)


@pytest.mark.parametrize("action", ["drink", "touch", "pick_up"])
def test_the_recorded_body_in_the_recorded_scene_goes_the_recorded_way(action: str) -> None:
    motion, found = _done(action, "same")
    assert found.passed, found.failed
    assert max(measure.value for measure in departures(motion)) < 5.0


def test_a_child_drinks_at_its_own_mouth_and_the_same_action_is_observed() -> None:
    source = recorded("drink")
    (trip,) = round_trips(source, ("child",))
    assert trip.quality is not None
    assert trip.quality.passed, trip.quality.failed
    assert trip.same_par
    assert trip.same_contacts
    motion = trip.motion
    assert motion is not None
    meeting = source.meetings[0]
    lips = motion.plan.human.sites(motion.postures, ["mouth"])["mouth"][0][meeting.first]
    mug = motion.plan.things["mug"][meeting.first]
    rim = mug.apply(np.array(motion.plan.scene.thing("mug").shape.vertices))
    assert np.linalg.norm(rim - lips, axis=1).min() < 0.03


def _jumped(motion: Motion) -> Motion:
    postures = motion.postures.copy()
    postures[40, motion.plan.human.index("left_elbow_flexion")] += 1.0
    return replace(motion, postures=postures)


def _slid(motion: Motion) -> Motion:
    postures = motion.postures.copy()
    postures[:, 0] += np.linspace(0.0, 0.01, len(postures))
    return replace(motion, postures=postures)


def _let_go(motion: Motion) -> Motion:
    hold = motion.plan.source.holds[0]
    path = motion.plan.things["mug"]
    spots = path.translation.copy()
    spots[hold.first : hold.last, 1] += 0.004
    moved = type(path).from_components(spots, path.rotation)
    return replace(motion, plan=replace(motion.plan, things={**motion.plan.things, "mug": moved}))


def _sunk(motion: Motion) -> Motion:
    scene = raised(motion.plan.scene, "table", 0.0)
    path = motion.plan.things["table"]
    higher = type(path).from_translation([0.0, 0.0, 0.01]) * path
    things = {**motion.plan.things, "table": higher}
    return replace(motion, plan=replace(motion.plan, scene=scene, things=things))


def _clenched(motion: Motion) -> Motion:
    """Fingers that are bent by a fifth more than they should be."""
    out = replace(motion)
    vars(out)["grasps"] = {
        side: tuple(replace(grasp, closed=1.2 * grasp.closed) for grasp in own)
        for side, own in motion.grasps.items()
    }
    return out


@pytest.mark.parametrize(
    ("spoilt", "gate"),
    [
        (_jumped, "joint speed"),
        (_slid, "feet"),
        (_let_go, "on the way"),
        (_sunk, "penetration"),
        (_clenched, "fingers inside"),
    ],
    ids=["a jump", "sliding feet", "a loose grip", "a sunk mug", "a clenched hand"],
)
def test_a_spoilt_motion_does_not_pass(spoilt: object, gate: str) -> None:
    motion, _ = _done("drink", "same")
    assert callable(spoilt)
    assert gate in quality(spoilt(motion)).failed


def test_out_of_reach_is_decided_before_anything_moves_with_what_would_help(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(search, "NEARER_M", (0.05, 0.2))
    source = recorded("touch")
    scene = replace(source.scene, place=(-0.9, 0.0), stays=True)
    with pytest.raises(PlanError, match=r"misses by \d+ mm.*; standing \d\.\d\d m further ahead"):
        reachable(source, scene, source.human)


def test_no_remedy_is_sought_once_enough_postures_were_tried(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(search, "MOST_POSTURES", 0)
    source = recorded("touch")
    scene = replace(source.scene, place=(-0.9, 0.0), stays=True)
    with pytest.raises(PlanError, match=r"misses by \d+ mm.*; no other height, size, nearer"):
        reachable(source, scene, source.human)


def test_nobody_stands_inside_a_table() -> None:
    source = recorded("touch")
    with pytest.raises(PlanError, match="inside 'table'; stand further back"):
        reachable(source, replace(source.scene, place=(0.3, 0.0), stays=True), source.human)


def test_the_same_input_gives_the_same_motion() -> None:
    source = recorded("touch")
    one, two = (regenerate(source, source.human)[0].postures for _ in range(2))
    assert one.tobytes() == two.tobytes()


def _written(capture: Capture, folder: Path) -> Path:
    write_bundle(capture, Truth((), (), (), ()), folder)
    return folder


def test_a_regenerated_bundle_is_observed_as_the_same_action(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = _written(action_capture("touch", rate_hz=RATE_HZ), tmp_path / "man")
    child = tmp_path / "child"
    asked = ("regenerate", str(folder), "--agent", "child", "--output", str(child))
    assert exit_code(monkeypatch, *asked) == 0
    table = capsys.readouterr().out
    assert "event position" in table
    assert "penetration" in table
    again = observed_source(child).observation
    first = recorded("touch").observation.complex_par
    assert again.complex_par.signature == first.signature
    assert again.agent.kind == "child"
    assert exit_code(monkeypatch, "regenerate", str(folder), "--output", str(child)) == 2
    assert "not an empty folder" in capsys.readouterr().err


def test_what_stands_a_little_inside_another_is_reported_and_no_fault_of_the_motion() -> None:
    source = recorded("touch")
    crate = source.scene.thing("crate")
    x, y, z = crate.place
    _, found = regenerate(
        source, source.human, moved(source.scene, "crate", (x, y, z - 0.003), crate.heading)
    )
    assert found.passed, found.failed
    inside = {measure.name: measure.value for measure in found.told}
    assert inside["inside each other at first"] == pytest.approx(-3.0, abs=0.1)


FAILED = Quality((Gate("penetration", -2.0, -1.0, "mm", at_least=True),))


def test_a_motion_that_fails_a_gate_is_written_and_the_exit_code_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    tried: list[Motion] = []
    monkeypatch.setattr(search, "quality", lambda motion: tried.append(motion) or FAILED)
    monkeypatch.setattr(search, "MOST_FRAMES", 1)
    folder = _written(action_capture("touch", rate_hz=RATE_HZ), tmp_path / "man")
    output = tmp_path / "again"
    assert exit_code(monkeypatch, "regenerate", str(folder), "--output", str(output)) == 3
    assert "penetration" in capsys.readouterr().out
    assert (output / "capture.toml").exists()
    assert len(tried) == 1  # more frames than are tried in all


def test_where_the_motion_of_a_grip_fails_one_that_is_missed_by_less_is_tried(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    source = recorded("touch")

    def missed(_: Draft, grips: list[Grip], *_others: object) -> Miss:
        return Miss(0.9 - 4.0 * abs(grips[-1].turn.pitch))

    def judged(motion: Motion) -> Quality:
        return FAILED if motion.plan.grips[0].turn == Turn() else Quality(())

    monkeypatch.setattr(search, "CARES", search.CARES[:1])
    monkeypatch.setattr(search, "quality", judged)
    monkeypatch.setattr(Draft, "missed", missed)
    draft = search.reachable(source, source.scene, source.human)
    assert [grip.turn for grip in draft.grips] == [Turn()]
    motion, found = search.best_motion(draft)
    assert found.passed
    assert [abs(grip.turn.pitch) for grip in motion.plan.grips] == [0.15]


@pytest.mark.parametrize(("ratio", "firm"), [(0.9, 1.0), (2.0, 2.0), (4.0, 1.0)])
def test_what_is_nearly_reached_is_tried_with_hands_that_are_led_more_firmly(
    monkeypatch: pytest.MonkeyPatch, ratio: float, firm: float
) -> None:
    source = recorded("touch")
    monkeypatch.setattr(Draft, "missed", lambda draft, *_: Miss(ratio / draft.firm, "missed"))
    draft = Draft(source, source.scene, source.human, own_style(source))
    assert search.choose_grips(draft) == ("missed" if ratio > 3.0 else "")
    assert draft.firm == firm


def test_a_capture_without_a_head_is_refused() -> None:
    capture = action_capture("touch", rate_hz=RATE_HZ)
    hands = tuple(each for each in capture.sensors if each.end_effector == "hand")
    objects = tuple(each for each in capture.objects if each.name != "head")
    blind = Capture("blind", hands, objects, capture.agent)
    with pytest.raises(PlanError, match="no sensor of the head"):
        observed_source(blind)
