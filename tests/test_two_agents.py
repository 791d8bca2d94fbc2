"""Two people hand over a mug: who gives, who takes, and whose action each PAR is."""

import json
import re
import sys
from dataclasses import replace
from pathlib import Path

import jsonschema
import motions
import pytest
from motions.handing import GIVER, GIVING, STEPS, TAKER, TAKING
from write_demo import write_tables

from capar.cli import main
from capar.model.errors import CaptureError, UnknownNameError
from capar.model.json_form import from_json, published_schema, to_json
from capar.model.observation import Observation
from capar.model.par import Step
from capar.pipelines.observation import observe
from capar.views.script import script
from extractors.readers.bundle.capture_toml import read_capture
from kb.actionary import Actionary
from kb.checks import check

BUNDLE = """\
name = "handing_over"
unit = "m"
up = "z"

[files]
motion = "motion.csv"

[[agent]]
name = "woman"
kind = "woman"
measures = { stature = 1.63, mass = 61.0 }

[[agent]]
name = "tall_man"
kind = "man"

[[sensor]]
name = "right_hand"
end_effector = "hand"
side = "right"
body = "right_hand"
shape = { mesh = "right_hand.obj" }

[[sensor]]
name = "guest_hand"
agent = "tall_man"
end_effector = "hand"
side = "right"
body = "guest_hand"
shape = { mesh = "guest_hand.obj" }

[[object]]
name = "mug"
tag = "mobile"
body = "mug"
shape = { mesh = "mug.obj" }

[[object]]
name = "table"
tag = "fixed"
position = [0.4, 0.0, 0.92]
shape = { mesh = "table.obj" }
"""


def bundle(folder: Path, text: str = BUNDLE) -> Path:
    write_tables(motions.hand_over().capture, folder)
    (folder / "capture.toml").write_text(text, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return bundle(tmp_path_factory.mktemp("handing_over"))


@pytest.fixture(scope="module")
def seen(folder: Path) -> Observation:
    return observe(folder)


def names(observation: Observation, ee: str) -> tuple[str, ...]:
    """What it does, but for rest before and after."""
    (link,) = [each for each in observation.links if each.ee == ee]
    return tuple(each.name for each in link.segments if each.name != "Rest")


def test_a_bundle_says_who_performs_and_whose_each_hand_is(folder: Path) -> None:
    capture = read_capture(folder)
    assert [each.name for each in capture.agents] == ["woman", "tall_man"]
    assert capture.agent.measures == {"stature": 1.63, "mass": 61.0}
    hands = {each.name: capture.agent_of(each) for each in capture.sensors}
    assert hands == {GIVING: "woman", TAKING: "tall_man"}


@pytest.mark.parametrize("ee", [GIVING, TAKING])
def test_one_gives_and_the_other_accepts(seen: Observation, ee: str) -> None:
    assert names(seen, ee) == STEPS[ee]


def test_every_par_names_the_agent_who_acted(seen: Observation) -> None:
    who = {GIVING: GIVER.name, TAKING: TAKER.name}
    assert {(each.ee, each.agent) for each in seen.ipars} == set(who.items())
    assert all(each.core.manner == each.agent for each in seen.ipars)
    (given,) = [each for each in seen.ipars if each.upar == "HandOver"]
    (taken,) = [each for each in seen.ipars if each.upar == "Accept"]
    assert (given.agent, given.objects) == (GIVER.name, ("mug",))
    assert (taken.agent, taken.objects) == (TAKER.name, ("mug",))
    assert taken.start_s < given.start_s


def test_what_is_passed_on_is_no_action_of_both(seen: Observation) -> None:
    assert seen.joint == ()


def test_between_the_hands_of_one_it_is_giving_and_receiving() -> None:
    own = observe(motions.hand_over(taker=GIVER.agent).capture)
    assert names(own, GIVING) == (*STEPS[GIVING][:-1], "Give")
    assert names(own, TAKING) == ("Receive", *STEPS[TAKING][1:])
    assert {each.agent for each in own.ipars} == {GIVER.name}
    assert own.others == ()


def test_the_observation_comes_back_from_json(seen: Observation) -> None:
    text = to_json(seen)
    jsonschema.validate(json.loads(text), json.loads(published_schema("observation")))
    assert from_json(text) == seen


def test_the_actionary_knows_who_did_what(seen: Observation) -> None:
    with Actionary.in_memory() as store:
        store.add(seen)
        assert check(store.store, full=True) == ()
        for action, who in (("HandOver", GIVER.name), ("Accept", TAKER.name)):
            assert [row["performer"] for row in store.ask("performers", action=action)] == [who]
        assert {(each.upar, each.agent) for each in store.ipars(seen.capture)} == {
            (each.upar, each.agent) for each in seen.ipars
        }


def test_a_place_is_kept_with_the_agent_and_the_segment_that_made_it(seen: Observation) -> None:
    query = """SELECT ?who ?ee ?action ?frame WHERE {
      ?place capar:agent/capar:name ?who ; capar:ofSegment ?segment .
      ?segment capar:ee ?ee ; capar:action/capar:name ?action ; capar:lastFrame ?frame
    }"""
    with Actionary.in_memory() as store:
        store.add(seen)
        rows = [tuple(row.values()) for row in store.query(query).plain()]
    expected = [(seen.performer(e.ee), e.ee, e.action, e.frame) for e in seen.locations]
    assert sorted(rows) == sorted(expected)


def test_each_step_of_a_script_is_of_the_agent_whose_end_effector_takes_it(
    seen: Observation,
) -> None:
    text = script(seen)
    assert "def execution_steps(self, agent1, agent2, obj1):" in text
    assert "# agent1 was 'woman'\n# agent2 was 'tall_man'\n" in text
    whose = re.findall(r"'agents': (\w+),.*?'EE': '(\w+)'", text, re.DOTALL)
    assert set(whose) == {("agent1", GIVING), ("agent2", TAKING)}


def test_a_step_that_ends_every_link_is_of_all_agents(seen: Observation) -> None:
    last = Step("ResumePosture", "all", ("mug",), 0.1, "", 0.9, ())
    text = script(replace(seen, complex_par=replace(seen.complex_par, common=last)))
    (agents,) = re.findall(r"'ResumePosture', {\s*'agents': (.*),\n", text)
    assert agents == "(agent1, agent2)"


def test_the_command_writes_the_script_and_hatches_what_was_lost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = (place := bundle(tmp_path) / "motion.csv").read_text().splitlines()
    columns = lines[0].split(",")
    for frame in range(210, 240):
        cells = lines[frame + 1].split(",")
        cells[columns.index("mug_valid")] = "0"
        lines[frame + 1] = ",".join(cells)
    place.write_text("\n".join(lines) + "\n")
    picture = tmp_path / "handing.svg"
    command = ["capar", "observe", str(tmp_path), "--script", "--plot", str(picture)]
    monkeypatch.setattr(sys, "argv", command)
    with pytest.raises(SystemExit):
        main()
    assert "'agents': agent2" in capsys.readouterr().out
    assert "fill: url(#h" in picture.read_text(encoding="utf-8")


def test_an_agent_who_is_not_there_is_a_mistake_with_its_line(tmp_path: Path) -> None:
    text = BUNDLE.replace('agent = "tall_man"', 'agent = "tall_men"')
    with pytest.raises(UnknownNameError, match=r"capture.toml:26.*tall_men") as error:
        read_capture(bundle(tmp_path, text))
    assert "tall_man" in str(error.value)


def test_two_agents_of_one_name_are_a_mistake(tmp_path: Path) -> None:
    text = BUNDLE.replace('name = "woman"', 'name = "tall_man"')
    with pytest.raises(CaptureError, match="two agents are called 'tall_man'"):
        read_capture(bundle(tmp_path, text))
