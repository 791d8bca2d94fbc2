"""What the Actionary finds: PARs, places, styles, kinds, features and abilities."""

from dataclasses import replace

import motions
import pytest
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.model.observation import Observation
from capar.model.par import Ipar, Upar
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.errors import StoreError


def ordered(value: Ipar | Upar) -> Ipar | Upar:
    """The same with its sets of conditions in order."""
    core = replace(value.core, termination=tuple(sorted(value.core.termination)))
    out = replace(value, core=core, post_assertions=tuple(sorted(value.post_assertions)))
    if isinstance(out, Upar):
        return replace(out, applicability=tuple(sorted(out.applicability)), parent="")
    return out


MADE = (drink_from_mug(), pick_up_with_both_hands(), with_unknown())


@pytest.mark.parametrize("made", MADE, ids=lambda each: each.capture)
def test_actions_come_back_as_they_went_in(actionary: Actionary, made: Observation) -> None:
    actionary.add(made)
    assert actionary.complex_par(made.capture) == made.complex_par
    assert actionary.ipars(made.capture) == tuple(map(ordered, made.ipars))
    expected = sorted((ordered(each) for each in made.upars), key=repr)
    assert sorted(actionary.upars(), key=repr) == expected


def test_observed_actions_come_back_as_they_were_observed(
    five_by_three: tuple[Observation, ...],
) -> None:
    with Actionary.in_memory() as actionary:
        for each in five_by_three:
            actionary.add(each)
        for each in five_by_three:
            back = actionary.complex_par(each.capture)
            assert replace(back, relations=()) == replace(each.complex_par, relations=())
            assert set(back.relations) == set(each.complex_par.relations)
            assert actionary.ipars(each.capture) == tuple(map(ordered, each.ipars))


def test_what_the_performer_looks_at_in_a_segment_can_be_asked() -> None:
    seen = observe(motions.drink_from_mug(motions.WOMAN).capture)
    assert any(each.looks for each in seen.segments)
    query = """SELECT ?ee ?index ?seen ?when WHERE {
      ?segment capar:look [ capar:seen/capar:name ?seen ; capar:when ?when ] ;
        capar:ee ?ee ; capar:index ?index
    }"""
    with Actionary.in_memory() as store:
        store.add(seen)
        rows = [tuple(row.values()) for row in store.query(query).plain()]
    expected = [(each.ee, each.index, *look) for each in seen.segments for look in each.looks]
    assert sorted(rows, key=str) == sorted(expected, key=str)


def test_abilities_are_declared_or_observed(actionary: Actionary) -> None:
    actionary.add(drink_from_mug(agent="ann"))
    assert ("Reach", "observed") in {(e.action, e.evidence) for e in actionary.abilities("ann")}
    assert actionary.kinds_above("mug") == ("mug", "container", "object", "thing")
    actionary.add_ability("MoveObjTo", agent="ben")
    assert ("MoveObjTo", "declared") in {(e.action, e.evidence) for e in actionary.abilities("ben")}
    actionary.add_ability("Pour", kind="container")
    assert ("Pour", "declared") in {(e.action, e.evidence) for e in actionary.abilities("mug")}
    with pytest.raises(StoreError, match="name one of them"):
        actionary.add_ability("Pour")


def test_rdflib_reads_the_same_actionary(actionary: Actionary) -> None:
    actionary.add(drink_from_mug())
    name = "https://w3id.org/capar/ontology#Segment"
    rows = actionary.dataset().query(f"SELECT ?s WHERE {{ ?s a <{name}> }}")
    assert len(list(rows)) == 6
