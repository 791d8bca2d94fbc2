"""An observation goes to others as an episode in terms of SOMA and DUL alone."""

import pytest
from observations import drink_from_mug
from pyoxigraph import Literal, NamedNode, Triple, parse

from kb.actionary import Actionary
from kb.exchange import FORMATS, VOCABULARIES, episode, export_episode
from kb.store.statements import TYPE

NAME = "DrinkFromMug"
DUL, SOMA = VOCABULARIES["dul"], VOCABULARIES["soma"]


@pytest.fixture(scope="module")
def drunk() -> Actionary:
    actionary = Actionary.in_memory()
    actionary.add(drink_from_mug())
    return actionary


def of(stated: tuple[Triple, ...], property_: str) -> dict[object, set[object]]:
    found: dict[object, set[object]] = {}
    for each in stated:
        if each.predicate.value == property_:
            found.setdefault(each.subject, set()).add(each.object)
    return found


def test_every_term_is_of_soma_dul_or_rdfs(drunk: Actionary) -> None:
    stated = episode(drunk.store, NAME)
    words = {each.predicate for each in stated if each.predicate != TYPE}
    words |= {each.object for each in stated if each.predicate == TYPE}
    known = tuple(VOCABULARIES.values())
    assert {each.value for each in words if not each.value.startswith(known)} == set()


def test_every_segment_is_an_action_with_its_time_performer_and_task(drunk: Actionary) -> None:
    stated = episode(drunk.store, NAME)
    kinds = of(stated, TYPE.value)
    labels = of(stated, VOCABULARIES["rdfs"] + "label")
    begins = of(stated, SOMA + "hasIntervalBegin")
    told = {}
    actions = {node for node, kind in kinds.items() if NamedNode(DUL + "Action") in kind}
    for action in actions:
        (when,) = of(stated, DUL + "hasTimeInterval")[action]
        (task,) = of(stated, DUL + "executesTask")[action]
        assert len(of(stated, SOMA + "isPerformedBy")[action]) == 1
        (start,), (name,) = begins[when], labels[task]
        assert isinstance(start, Literal)
        assert isinstance(name, Literal)
        told[float(start.value)] = name.value
    rows = {row["begins"]: row["action"] for row in drunk.ask("segments")}
    assert told == rows
    reaching = {node for node, kind in kinds.items() if NamedNode(SOMA + "Reaching") in kind}
    assert {next(iter(labels[each])) for each in reaching} == {Literal("Reach")}


def test_a_contact_is_an_interval_that_is_classified_as_contact(drunk: Actionary) -> None:
    stated = episode(drunk.store, NAME)
    kinds = of(stated, TYPE.value)
    states = [node for node, kind in kinds.items() if NamedNode(SOMA + "State") in kind]
    touching = drunk.query("SELECT ?f { ?f a capar:Touching }").rows
    assert len(states) == len(touching) > 0
    for state in states:
        (kind,) = of(stated, DUL + "isClassifiedBy")[state]
        assert kinds[kind] == {NamedNode(SOMA + "ContactState")}
        assert len(of(stated, DUL + "hasParticipant")[state]) == 2
        assert len(of(stated, DUL + "hasTimeInterval")[state]) == 1


@pytest.mark.parametrize("form", FORMATS)
def test_it_says_the_same_in_every_format(drunk: Actionary, form: str) -> None:
    data = export_episode(drunk.store, form, NAME)
    read = {each.triple for each in parse(data, format=FORMATS[form])}
    assert read == set(episode(drunk.store, NAME))
    assert export_episode(drunk.store, form, NAME) == data
