"""Observations are kept whole, replaced, recognised and forgotten, in every store."""

from dataclasses import replace

import motions
import pytest
from actionaries import ACTIONS
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.model.capture import Agent
from capar.model.errors import UnknownNameError
from capar.model.observation import Observation
from capar.model.par import Nlt
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.checks import check
from kb.encode.shared import ENDED
from kb.errors import ExistsError, ShapeError
from kb.store import names


def statements(actionary: Actionary) -> set[str]:
    """All but when an observation was made, which is another second each time."""
    return {str(each) for each in actionary.store.quads() if each.predicate != ENDED}


def by(agent: str, capture: str, *, name: str = "") -> Observation:
    drunk = drink_from_mug(agent=agent)
    return replace(drunk, capture=capture, complex_par=replace(drunk.complex_par, name=name))


def test_what_was_added_is_listed(actionary: Actionary) -> None:
    added = actionary.add(drink_from_mug())
    assert (added.name, added.action, added.recognised) == ("DrinkFromMug", "DrinkFromMug", "")
    (stored,) = actionary.observations()
    assert (stored.name, stored.agent, stored.profile) == ("DrinkFromMug", "agent", "thesis")
    assert stored.duration_s == pytest.approx(401 / 103.3)


def test_adding_the_same_again_changes_nothing(actionary: Actionary) -> None:
    actionary.add(drink_from_mug())
    before = statements(actionary)
    assert actionary.add(drink_from_mug()).replaced
    assert statements(actionary) == before


def test_a_second_capture_is_recognised_and_only_its_own_is_added(actionary: Actionary) -> None:
    actionary.add(by("ann", "first", name="DrinkFromMug"))
    shared = statements(actionary)
    added = actionary.add(by("ben", "second"))
    assert (added.action, added.recognised) == ("DrinkFromMug", "DrinkFromMug")
    kept = actionary.store.graph(names.GRAPHS["actions"])
    assert {str(each) for each in kept} <= shared
    for kind in ("AgentStyle", "ConstraintLocation"):
        query = f'SELECT ?s {{ ?s a capar:{kind} ; capar:actionName "Reach" }}'
        assert len(actionary.query(query).rows) == 2
    rows = actionary.ask("performers", action="DrinkFromMug")
    assert [row["performer"] for row in rows] == ["ann", "ben"]
    complexes = actionary.store.ask(
        "SELECT DISTINCT ?c WHERE { ?c a <https://w3id.org/capar/ontology#ComplexPar> }"
    )
    assert len(complexes.rows) == 1


def test_forgetting_leaves_the_store_as_if_it_had_never_been_added(actionary: Actionary) -> None:
    actionary.add(by("ann", "first", name="DrinkFromMug"))
    before = statements(actionary)
    actionary.add(by("ben", "second"))
    actionary.add(pick_up_with_both_hands())
    actionary.add(with_unknown())
    for name in ("Strange", "second", "PickUpWithBothHands"):
        actionary.forget(name)
    assert statements(actionary) == before


def test_forgetting_the_first_of_two_keeps_what_the_second_says(actionary: Actionary) -> None:
    actionary.add(by("ben", "second", name="DrinkFromMug"))
    alone = statements(actionary)
    actionary.add(by("ann", "first"))
    actionary.forget("first")
    assert statements(actionary) == alone
    assert check(actionary.store, full=False) == ()


def test_what_a_user_declared_is_not_forgotten(actionary: Actionary) -> None:
    actionary.add_ability("Reach", agent="agent")
    before = statements(actionary)
    actionary.add(drink_from_mug())
    actionary.forget("DrinkFromMug")
    assert statements(actionary) == before


def test_forgetting_what_is_not_there_says_what_is(actionary: Actionary) -> None:
    actionary.add(drink_from_mug())
    with pytest.raises(UnknownNameError, match="there are: DrinkFromMug"):
        actionary.forget("DrinkFromMugs")


def test_a_capture_of_the_same_name_is_not_silently_replaced(actionary: Actionary) -> None:
    actionary.add(drink_from_mug())
    other = replace(drink_from_mug(), agent=Agent("another"))
    with pytest.raises(ExistsError, match="another name"):
        actionary.add(other)
    assert actionary.add(other, replace=True).replaced
    assert [each.agent for each in actionary.observations()] == ["another"]
    assert check(actionary.store, full=False) == ()


def test_an_observation_that_breaks_the_model_is_refused_whole(actionary: Actionary) -> None:
    before = statements(actionary)
    good = drink_from_mug()
    crooked = replace(good.locations[0], goal_nlt=Nlt((0, 0, 0), (0.9, 0.0, 0.0, 0.0)))
    with pytest.raises(ShapeError, match=r"quaternion of length 0\.9"):
        actionary.add(replace(good, locations=(crooked, *good.locations[1:])))
    with pytest.raises(ShapeError, match="rule profile thesis or extended"):
        actionary.add(replace(good, profile="guess"))
    assert statements(actionary) == before


def test_names_of_any_letters_are_kept_apart(actionary: Actionary) -> None:
    odd = ("a b", "a%20b", "ü/#?<>", "quote\"'")
    for name in odd:
        actionary.add(replace(drink_from_mug(), capture=name))
    assert [each.name for each in actionary.observations()] == sorted(odd)
    for name in odd:
        actionary.forget(name)
    assert actionary.observations() == ()


@pytest.mark.parametrize("name", ACTIONS)
def test_what_the_extended_rules_find_is_kept_whole(name: str) -> None:
    performer = next(iter(motions.PERFORMERS))
    seen = observe(ACTIONS[name](performer).capture, rules="extended", name=name)
    with Actionary.in_memory() as actionary:
        before = statements(actionary)
        actionary.add(seen)
        assert check(actionary.store) == ()
        back = actionary.complex_par(name)
        assert [link.steps for link in back.links] == [s.steps for s in seen.complex_par.links]
        actionary.forget(seen.capture)
        assert statements(actionary) == before
