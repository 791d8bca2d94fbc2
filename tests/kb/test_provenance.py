"""Who performed and when and by what it was observed: individuals, runs, rules, calibration."""

import json
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from observations import drink_from_mug

from capar.model.calibration import Calibration
from capar.model.capture import Agent, Source
from capar.model.json_form import value_from_json
from capar.pipelines.observation import observe
from capar_rules.engine.profiles import profile
from capar_rules.pars.pars import naming_rules
from kb.actionary import Actionary
from kb.store.names import GRAPHS


def unnamed(capture: str) -> Actionary:
    actionary = Actionary.in_memory()
    for name in (capture, "another"):
        actionary.add(replace(drink_from_mug(), capture=name, agent=Agent()))
    return actionary


def values(actionary: Actionary, query: str) -> list[object]:
    return [value for row in actionary.query(query).plain() for value in row.values()]


def test_an_unnamed_performer_belongs_to_the_capture() -> None:
    actionary = unnamed("mine")
    labels = values(actionary, "SELECT ?l { ?a a capar:Agent ; rdfs:label ?l } ORDER BY ?l")
    assert labels == ["agent of another", "agent of mine"]
    assert {each.agent for each in actionary.ipars("mine")} == {"agent"}
    actionary.forget("mine")
    assert values(actionary, "SELECT ?l { ?a a capar:Agent ; rdfs:label ?l }") == [
        "agent of another"
    ]


def test_a_run_says_when_and_from_which_files_and_goes_with_its_observation(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("CAPAR_TRIALS", "/trials")
    source = Source("${CAPAR_TRIALS}/a.csv", "csv", "0" * 64)
    actionary = Actionary.in_memory()
    made = replace(drink_from_mug(), sources=(source,))
    actionary.add(made)
    asked = "SELECT ?at ?file { ?r a capar:Run ; prov:endedAtTime ?at ; capar:readFrom ?file }"
    at, file = values(actionary, asked)
    assert file == "/trials/a.csv"
    assert datetime.now(UTC) - datetime.fromisoformat(str(at)) < timedelta(minutes=5)
    actionary.add(made)
    assert len(values(actionary, asked)) == 2
    actionary.forget(made.capture)
    assert actionary.store.graph(GRAPHS["runs"]) == []


def test_the_calibration_is_stored_whole() -> None:
    from actionaries import ACTIONS
    from motions import PERFORMERS

    made = observe(ACTIONS["TouchFromRest"](PERFORMERS[0]).capture)
    actionary = Actionary.in_memory()
    actionary.add(made)
    (text,) = values(actionary, "SELECT ?c { ?o capar:calibration ?c }")
    assert value_from_json(str(text), Calibration) == made.calibration
    assert "cutoff_hz" in json.loads(str(text))


def test_each_primitive_has_a_rule_with_its_text_and_its_thresholds() -> None:
    base = profile()
    lift, carry = naming_rules(base, ["Lift", "Carry", "Unknown"])[::-1]
    assert (lift.file, carry.file) == ("primitives/lift.lp", "primitives/carry.lp")
    assert 'primitive("Lift").' in lift.text
    stated = {each.name: each.value for each in lift.thresholds}
    assert stated["height_mm"] == 50 and "rest_ms" not in stated
    assert "aside_mm" in {each.name for each in carry.thresholds}
