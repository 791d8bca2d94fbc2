"""One body hands a thing to another: both hold it where both reach, and the same is observed."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from exit_codes import exit_code

from capar.body.recording import truth_together, write_bundle
from capar.body.scripted_actions import joint_capture, performed_together
from capar.model.errors import CaparError, UnknownNameError
from capar.pipelines.observation import observe
from capar.pipelines.round_trips import bodies, observed_joint_source
from capar.pipelines.trials import trial_of
from capar.regeneration import PlanError, hand_overs
from capar.regeneration.captures import joint_capture_of
from capar.regeneration.hand_overs import JointMotion, JointSource, joint_gates, regenerate_together
from capar.regeneration.scenes import read_scenes

pytestmark = pytest.mark.long

RATE_HZ = 30.0


@cache
def _source() -> JointSource:
    return observed_joint_source(joint_capture("hand_over", rate_hz=RATE_HZ))


@cache
def _done(*agents: str) -> JointMotion:
    source = _source()
    return regenerate_together(source, bodies(agents, source))


def test_a_recording_of_two_says_what_each_did_and_what_passed_between_them() -> None:
    source = _source()
    (passed,) = source.hand_overs
    assert (passed.giver, passed.taker, passed.thing) == ("giver", "taker", "mug")
    giving, taking = (source.sources[name].holds for name in ("giver", "taker"))
    assert giving[0].first < taking[0].first == passed.first
    assert giving[0].last == passed.last < taking[0].last
    assert abs(source.sources["taker"].scene.heading) == pytest.approx(np.pi, abs=1e-3)


@pytest.mark.parametrize("agents", [("man", "child"), ("child", "woman")])
def test_other_bodies_hand_it_over_with_every_gate_and_the_same_is_observed(
    agents: tuple[str, str],
) -> None:
    made = _done(*agents)
    assert made.passed, made.failed
    again = observe(joint_capture_of(made, name="again")).complex_par
    assert again.signature == made.source.observation.complex_par.signature
    assert again.relations == made.source.observation.complex_par.relations


def test_bodies_that_are_too_far_apart_are_refused_with_what_would_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hand_overs, "MOST_TURNS", 2)
    source = _source()
    path = tmp_path / "far.toml"
    path.write_text("[stance.taker]\nplace = [3.4, 0.0]\n")
    scenes = read_scenes(path, {name: one.scene for name, one in source.sources.items()})
    assert scenes["giver"].place == source.sources["giver"].scene.place
    with pytest.raises(PlanError, match=r"giver: .* inside .table."):
        regenerate_together(source, bodies(("same",), source), scenes)


def test_a_body_that_stands_in_the_other_one_fails_the_gate_between_them() -> None:
    made = _done("man", "child")
    taker = made.motions["taker"]
    postures = taker.postures.copy()
    postures[:, 0] -= 0.5
    walked = {**made.motions, "taker": replace(taker, postures=postures)}
    gates = {gate.name: gate for gate in joint_gates(made.source, walked)}
    assert not gates["bodies apart"].passed
    assert gates["bodies apart"].value < -5.0


def test_bodies_are_named_once_for_all_or_by_their_agent() -> None:
    source = _source()
    assert bodies(("taker=child",), source)["giver"] is source.sources["giver"].human
    with pytest.raises(UnknownNameError, match="waiter"):
        bodies(("waiter=child",), source)
    with pytest.raises(CaparError, match="3 bodies for 2 performers"):
        bodies(("man", "man", "man"), source)


def test_the_command_performs_a_written_take_and_writes_one_that_reads_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = performed_together("hand_over", rate_hz=RATE_HZ)
    take, out = tmp_path / "take", tmp_path / "out"
    write_bundle(joint_capture("hand_over", rate_hz=RATE_HZ), truth_together(made), take)
    read = trial_of(str(take))
    assert [agent.name for agent in read.agents] == ["giver", "taker"]
    args = ("regenerate", str(take), "--agent", "man", "--agent", "child", "--output", str(out))
    assert exit_code(monkeypatch, *args) == 0
    again = trial_of(str(out))
    assert [sensor.name for sensor in again.sensors] == [sensor.name for sensor in read.sensors]
    assert [agent.kind for agent in again.agents] == ["man", "child"]
    own = joint_capture_of(_done("man", "child"), name="hand_over")
    for sensor in again.sensors:
        there = own.sensor(sensor.name).stream.positions
        np.testing.assert_allclose(sensor.stream.positions, there, atol=1e-3)
    assert exit_code(monkeypatch, "regenerate", str(take), "--hand", "left") == 2
