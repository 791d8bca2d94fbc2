"""Agents are declared, shown with what is not recorded of them, and joined where two are one."""

from dataclasses import replace

import pytest
from observations import drink_from_mug

from capar.model.errors import UnknownNameError
from capar.model.observation import Observation
from kb.actionary import Actionary
from kb.checks import by_shacl, check
from kb.errors import StoreError
from kb.exchange import bring_in
from kb.lookup.agents import PROFILES
from kb.store.names import GRAPHS, shared


def by(agent: str, capture: str) -> Observation:
    return replace(drink_from_mug(agent=agent), capture=capture)


def reachers(actionary: Actionary) -> set[object]:
    return {row["performer"] for row in actionary.ask("performers", action="Reach")}


def test_a_declared_agent_has_what_was_said_and_stays(actionary: Actionary) -> None:
    actionary.declare_agent("Ada", kind="woman", can=["Drink"])
    actionary.add(by("Ada", "take"))
    actionary.forget("take")
    assert actionary.agents() == ("Ada",)
    fields = actionary.agent_profile("Ada")
    assert (fields["kind"], fields["capabilities (declared)"]) == (("woman",), ("Drink",))
    assert fields["captures"] == fields["grasp sites"] == ()
    with pytest.raises(StoreError, match="an agent 'Ada' already"):
        actionary.declare_agent("Ada")
    assert check(actionary.store) == ()


def test_what_one_of_two_joined_agents_did_is_the_others(actionary: Actionary) -> None:
    actionary.add(by("Ada", "morning"))
    actionary.add(by("agent", "evening"))
    assert reachers(actionary) == {"Ada", "agent of evening"}
    actionary.same_agent("Ada", "agent of evening")
    assert reachers(actionary) == {"Ada"}
    assert actionary.agent_profile("Ada")["captures"] == ("evening", "morning")
    actionary.add(by("agent", "evening"))
    assert (reachers(actionary), actionary.agents()) == ({"Ada"}, ("Ada",))
    assert check(actionary.store) == ()


def test_joining_twice_or_with_nobody_is_refused(actionary: Actionary) -> None:
    actionary.declare_agent("Ada")
    actionary.declare_agent("Bo", can=["Lift"])
    actionary.declare_agent("Cy")
    actionary.same_agent("Bo", "Cy")
    actionary.same_agent("Ada", "Bo")
    assert actionary.agents() == ("Ada",)
    assert actionary.agent_profile("Cy")["capabilities (declared)"] == ("Lift",)
    with pytest.raises(StoreError, match="are one agent already"):
        actionary.same_agent("Ada", "Cy")
    with pytest.raises(UnknownNameError, match="Dee"):
        actionary.same_agent("Ada", "Dee")


def test_an_export_from_before_keeps_agents_joined() -> None:
    with Actionary.in_memory() as actionary:
        actionary.add(by("Ada", "morning"))
        actionary.add(by("agent", "evening"))
        before = list(actionary.store.quads())
        actionary.same_agent("Ada", "agent of evening")
        bring_in(actionary.store, before)
        assert actionary.agents() == ("Ada",)
        assert reachers(actionary) == {"Ada"}


def test_every_field_of_a_listing_is_shown_whether_filled_or_empty(actionary: Actionary) -> None:
    actionary.add(by("Ada", "take"))
    mug = actionary.object_profile("mug")
    assert mug.keys() == PROFILES["object"].keys()
    assert mug["tag"] == ("mobile",)
    assert "container" in mug["more general"]
    assert "Reach" in mug["actions (observed)"]
    assert mug["constraint locations"]
    assert mug["state: restitution"] == ()
    assert actionary.agent_profile("Ada").keys() == PROFILES["agent"].keys()
    with pytest.raises(UnknownNameError, match="mug"):
        actionary.object_profile("mgu")


def test_a_kind_that_only_an_agent_has_fulfils_the_shape_of_kinds(actionary: Actionary) -> None:
    actionary.declare_agent("Ada", kind="vicar")
    stated = [
        each for name in ("agents", "objects") for each in actionary.store.graph(GRAPHS[name])
    ]
    vicar = shared("kind", "vicar")
    assert {each.object for each in stated if each.subject == vicar} >= {
        vicar,
        shared("kind", "thing"),
    }
    assert by_shacl([each.triple for each in stated]) == []
