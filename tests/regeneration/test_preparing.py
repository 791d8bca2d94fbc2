"""What an action needs is measured, planned for and performed, and contacts are as PARs assert."""

import json
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from combinations import EVERY
from exit_codes import exit_code
from recorded_actions import recorded
from recorded_worlds import Worlds, worlds_in

from capar.body.scripted_actions import ACTIONS
from capar.body.virtual_scenes import Thing, box
from capar.model.capture import TagType
from capar.pipelines.action_binding import Asked, Instance, instantiate
from capar.pipelines.preparation import (
    Problem,
    Procedure,
    World,
    asserted,
    measured_world,
    prepare,
    problem_of,
    procedures_of,
    shortest,
    unmet,
)
from capar.pipelines.recordings import observed_recording
from capar.pipelines.trials import trial_of
from capar.regeneration import regenerate
from capar.regeneration.quality import Asserted, contact_gate
from capar.regeneration.scenes import Scene

RATE_HZ = 30.0


def _kinds(kind: str) -> tuple[str, ...]:
    return (kind, "object")


def _instance(action: str, scene: Scene | None = None) -> Instance:
    source = recorded(action)
    asked = Asked(action, ("man",), source.human, {}, scene or source.scene, own=True)
    recording = observed_recording(source.observation, Path(action))
    return instantiate(asked, recording, source, _kinds, lambda _: ())


def _ways(*actions: str) -> tuple[Procedure, ...]:
    recordings = [observed_recording(recorded(one).observation, Path(one)) for one in actions]
    return procedures_of(recordings, lambda recording: recorded(recording.name))


def _beside(scene: Scene, tag: TagType = TagType.MOBILE) -> Scene:
    """With a box where the mug of ``carry`` is put."""
    x, y, z = scene.thing("mug").place
    made = Thing("crate", box(0.12, 0.12, 0.12), (x, y + 0.2, z), tag=tag)
    return replace(scene, things={**scene.things, "crate": made})


def _problem(action: str, scene: Scene, *touching: tuple[str, str]) -> Problem:
    return problem_of(_instance(action, scene), World(scene, frozenset(touching)), _kinds)


@pytest.mark.parametrize("action", sorted(ACTIONS)[:: 1 if EVERY else 3])
def test_nothing_has_to_be_prepared_for_an_action_in_the_scene_in_which_it_was_recorded(
    action: str,
) -> None:
    source = recorded(action)

    def unopened() -> tuple[Procedure, ...]:
        raise AssertionError

    made = prepare(_instance(action), measured_world(source), _kinds, unopened)
    assert made.wanted
    assert not made.lacking
    assert not made.done


def test_what_stands_in_the_goal_place_is_moved_by_the_shortest_recorded_way() -> None:
    problem = _problem("carry", _beside(recorded("carry").scene))
    assert unmet(problem) == (("clear", "mug"),)
    ((stage,), left) = shortest(problem, _ways("carry", "slide"))
    assert not left
    assert [step.action for step in stage.steps] == [
        "Reach",
        "Touch",
        "Push",
        "TouchWith",
        "ResumePosture",
    ]
    assert {(step.thing, step.hand) for step in stage.steps} == {("crate", "right")}
    ((stage,), _) = shortest(problem, _ways("carry"))
    assert len(stage.steps) == 7
    assert stage.goal is not None
    assert stage.goal.place is not None
    away = np.linalg.norm(np.subtract(stage.goal.place, problem.goals["mug"].translation))
    assert away > 0.12
    ((other,), _) = shortest(problem, _ways("carry"), [stage.failed])
    assert other.goal is not None
    assert other.goal.place != stage.goal.place


def test_a_hand_that_holds_something_puts_it_down_before_it_reaches_for_another_thing() -> None:
    scene = _beside(recorded("carry").scene)
    x, y, z = scene.thing("mug").place
    raised = replace(scene.thing("mug"), place=(x, y, z + 0.2))
    scene = replace(scene, things={**scene.things, "mug": raised})
    source = recorded("touch")
    things = {**scene.things, "crate": source.scene.thing("crate")}
    problem = _problem("touch", replace(scene, things=things), ("right", "mug"))
    assert unmet(problem) == (("free", "right"),)
    ((stage,), _) = shortest(problem, _ways("carry", "slide", "touch"))
    assert [step.action for step in stage.steps] == ["Lower", "TouchWith", "ResumePosture"]
    assert stage.touching == frozenset()


def test_a_table_that_is_not_as_geometry_has_it_fails_with_both_said() -> None:
    source = recorded("touch")
    motion, found = regenerate(source, source.human)
    assert found.passed
    steps = asserted(source)
    assert contact_gate(motion, steps).passed
    held = Asserted("Touch", 60, ((("right", "crate"), False),), "")
    assert contact_gate(motion, [held]).frame == 60
    gone = Asserted("ResumePosture", len(source.times) - 1, ((("right", "crate"), True),), "")
    gate = contact_gate(motion, [held, gone])
    assert not gate.passed
    assert gate.value == 2.0
    assert (
        "right and crate do not touch by the table, and are 1 mm apart by geometry" in gate.bodies
    )


def _crowded() -> Iterator[Thing]:
    scene = _beside(recorded("carry").scene)
    for thing in scene.things.values():
        yield replace(thing, kind=thing.kind or thing.name)


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> Worlds:
    """Recordings of carrying and sliding, and a scene whose goal place is taken."""
    scenes = {"crowded": tuple(_crowded())}
    return worlds_in(tmp_path_factory.mktemp("prepared"), ("carry", "slide"), scenes)


def test_a_plan_is_performed_told_and_written_in_as_many_bundles_as_it_has_stages(
    worlds: Worlds,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sys.stdin, "isatty", lambda: False)
    out = tmp_path / "out"
    scene = ("--scene", str(worlds.scene("crowded")), "--object", "mug=mug")
    asked = ("regenerate", "carry", *scene, *worlds.options, "--output", str(out), "--json")
    assert exit_code(monkeypatch, *asked) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["passed"] is True
    assert told["plan"]["lacking"] == [["clear", "mug"]]
    (stage,) = told["plan"]["stages"]
    assert [step["thing"] for step in stage["steps"]] == ["crate"] * 5
    first, second = (trial_of(out / name) for name in ("1_slide", "2_carry"))
    gone = np.ptp(first.tag_object("crate").stream.positions[:, 1])
    assert gone == pytest.approx(0.12, abs=0.002)
    there = second.tag_object("crate").stream.positions
    assert np.ptp(there, axis=0).max() < 0.001
    np.testing.assert_allclose(there[0], first.tag_object("crate").stream.positions[-1], atol=0.001)
