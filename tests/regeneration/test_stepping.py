"""Who does not reach from the given place steps to where it does, and keeps its balance."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from combinations import one_of
from recorded_actions import recorded
from typer.testing import CliRunner

from capar.body.recording import Truth, write_bundle
from capar.cli import app
from capar.pipelines.observation import observe
from capar.pipelines.round_trips import body
from capar.pipelines.trials import trial_of
from capar.regeneration import PlanError, regenerate, stepping
from capar.regeneration.captures import capture_of_steps
from capar.regeneration.quality import Quality
from capar.regeneration.scenes import Scene, raised
from capar.regeneration.search import beside
from capar.regeneration.stepping import (
    RISE_M,
    STRIDE,
    Stepping,
    approached,
    step_to,
    stepping_quality,
)
from capar.regeneration.styles import own_style


def _away(ahead_m: float, aside_m: float) -> Scene:
    return replace(beside(recorded("touch").scene, ahead_m, aside_m), stays=True)


@cache
def _stepped(agent: str, ahead_m: float, aside_m: float) -> Stepping:
    """Steps back and aside from the table."""
    source = recorded("touch")
    goal = beside(source.scene, ahead_m, aside_m).place
    return step_to(body(agent, source), source.scene, goal)


@pytest.mark.parametrize("agent", one_of(["man", "child"]))
def test_steps_pass_every_gate_and_end_where_they_should(agent: str) -> None:
    made = _stepped(agent, -0.2, 0.15)
    quality = stepping_quality(made)
    assert quality.passed, quality.failed
    gone = made.postures[-1][:2] - made.postures[0][:2]
    np.testing.assert_allclose(gone, np.subtract(made.goal, made.scene.place), atol=0.005)


def test_one_foot_bears_at_every_moment_and_the_other_one_is_lifted() -> None:
    made = _stepped("man", -0.2, 0.15)
    assert np.logical_or(made.bears["right"], made.bears["left"]).all()
    feet = made.human.sites(made.postures, ["right_foot", "left_foot"])
    for side in ("right", "left"):
        heights = feet[f"{side}_foot"][0][:, 2]
        assert np.ptp(heights[made.bears[side]]) < 0.003
        assert np.ptp(heights) == pytest.approx(RISE_M, abs=0.005)


def test_a_foot_that_slides_while_it_bears_and_a_lost_balance_fail() -> None:
    made = _stepped("man", -0.2, 0.15)
    slid = made.postures.copy()
    slid[:, 1] += np.linspace(0.0, 0.4, len(slid))
    failed = stepping_quality(replace(made, postures=slid)).failed
    assert {"foot that bears", "foot comes there"} <= set(failed)
    lifted = {"right": made.bears["right"], "left": np.zeros(len(slid), dtype=bool)}
    lifted["right"] = np.ones(len(slid), dtype=bool)
    assert "balance" in stepping_quality(replace(made, bears=lifted)).failed


def test_steps_are_observed_as_steps() -> None:
    made = _stepped("child", -0.1, 0.1)
    seen = observe(capture_of_steps(made, name="steps", agent="child"))
    for foot in ("right_foot", "left_foot"):
        names = [segment.name for segment in seen.segments if segment.ee == foot]
        assert names == ["Stand", "Step", "Stand"]


def _act(agent: str, scene: Scene) -> tuple[str, Quality]:
    source = recorded("touch")
    motion, quality = regenerate(source, body(agent, source), scene)
    return motion.plan.human.measures.adult, quality


def test_nobody_steps_who_reaches() -> None:
    source = recorded("touch")
    found, _, quality = approached(
        source, body("man", source), _away(0.0, 0.0), own_style(source), lambda s: _act("man", s)
    )
    assert found is None
    assert quality.passed


def test_what_no_step_brings_into_reach_is_still_refused() -> None:
    source, child = recorded("touch"), body("child", recorded("touch"))
    high = replace(raised(source.scene, "table", 1.2), stays=True)
    with pytest.raises(
        PlanError, match=r"2\.\d m above the floor, higher .*; no step helps, since"
    ):
        approached(source, child, high, own_style(source), lambda scene: _act("child", scene))


def test_places_that_need_fewer_steps_are_tried_first_and_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    source, man = recorded("touch"), body("man", recorded("touch"))
    tried: list[tuple[float, float]] = []

    def reaches(_: object, scene: Scene, __: object) -> bool:
        tried.append(scene.place)
        return False

    monkeypatch.setattr(stepping, "why_unreachable", lambda *_: "too far")
    monkeypatch.setattr(stepping, "is_possible", reaches)
    start = _away(-0.5, 0.0)
    with pytest.raises(PlanError, match=r"of \d+ places that were tried \([+-]0.2 m ahead"):
        approached(source, man, start, own_style(source), lambda scene: _act("man", scene))
    far = [float(np.hypot(*np.subtract(place, start.place))) for place in tried]
    assert max(far[: stepping.MOST_TRIES]) <= STRIDE * man.measures["stature"]
    assert len(set(tried)) == len(tried) > stepping.MOST_TRIES


def test_a_child_that_stands_too_far_away_steps_and_touches(tmp_path: Path) -> None:
    write_bundle(recorded("touch").capture, Truth((), (), (), ()), tmp_path / "touch")
    stance = tmp_path / "away.toml"
    stance.write_text("[stance]\nplace = [-0.8, 0.3]\n", "utf-8")
    call = ["regenerate", str(tmp_path / "touch"), "--agent", "child", "--scene", str(stance)]
    made = CliRunner().invoke(app, [*call, "--step", "--output", str(tmp_path / "out")])
    assert made.exit_code == 0, made.output
    assert "strides:" in made.output
    assert " NO " not in made.output
    steps, action = (trial_of(tmp_path / "out" / name) for name in ("1_steps", "2_touch"))
    ends, begins = (
        trial.sensor("head").stream.positions[frame] for trial, frame in ((steps, -1), (action, 0))
    )
    np.testing.assert_allclose(ends[:2], begins[:2], atol=0.03)
