"""What the Actionary finds: PARs, places, styles, kinds, features and abilities."""

from dataclasses import replace

import motions
import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.model.errors import ParError, UnknownNameError
from capar.model.observation import Observation
from capar.model.par import FeatureSet, Ipar, Nlt, Upar
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.errors import StoreError
from kb.lookup.pars import effective


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


def test_an_instance_overrides_its_action() -> None:
    made = drink_from_mug()
    reach, known = made.ipars[0], tuple(e for e in made.upars if e.name == "Reach")
    whole = effective(known, reach)
    assert (whole.agent, whole.objects) == ("agent", ("mug",))
    assert whole.core.duration_s == reach.core.duration_s
    assert whole.applicability[0].arguments == ("agent", "Reach")
    bare = effective(known, replace(reach, preparation=(), post_assertions=()))
    assert bare.post_assertions[0].arguments == ("right_hand", "mug")
    assert bare.preparation == known[0].preparation


def test_pars_are_found_by_action_objects_and_performer(actionary: Actionary) -> None:
    for each in MADE:
        actionary.add(each)
    found = actionary.find_pars
    assert [each.name for each in found(action="MoveObjTo")] == ["DrinkFromMug"]
    assert [each.name for each in found(objects=["container", "table"])] == [
        "DrinkFromMug",
        "PickUpWithBothHands",
        "Strange",
    ]
    assert [each.name for each in found(objects=["mug", "mouth"])] == ["DrinkFromMug"]
    assert found(performer="nobody") == ()


def test_a_place_is_found_by_kind_action_purpose_and_side(actionary: Actionary) -> None:
    actionary.add(drink_from_mug())
    right = actionary.location("mug", action="Reach", purpose="PickUp", side="right")
    assert right is not None and right.goal_nlt == Nlt((0.0, -0.5, 0.5), (0.6, 0.8, 0.0, 0.0))
    left = actionary.location("mug", action="Reach", purpose="PickUp", side="left")
    assert left is not None and left.side == "left"
    assert left.goal_nlt == Nlt((0.0, 0.5, 0.5), (0.6, -0.8, 0.0, 0.0))
    assert actionary.location("mug", action="Reach", purpose="Throw") is None
    assert actionary.location("table", action="MoveObjTo") is not None


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


def test_what_is_kept_with_a_kind_holds_for_the_kinds_below_it(actionary: Actionary) -> None:
    actionary.add(drink_from_mug())
    actionary.define_kind("beer_mug", broader="mug")
    assert actionary.kinds_above("beer_mug") == ("beer_mug", "mug", "container", "object", "thing")
    (found,) = actionary.locations("beer_mug", action="Reach")
    assert (found.kind, found.inherited, found.mirrored) == ("mug", True, False)
    assert actionary.locations("container", action="Reach") == ()
    rows = actionary.ask("touching", object="container")
    assert {row["whole"] for row in rows} == {"DrinkFromMug"}


def test_a_kind_is_never_above_itself(actionary: Actionary) -> None:
    actionary.define_kind("stein", broader="mug")
    with pytest.raises(StoreError, match="more general than itself"):
        actionary.define_kind("mug", broader="stein")


def test_a_style_is_found_by_agent_action_purpose_and_hand(actionary: Actionary) -> None:
    actionary.add(drink_from_mug(agent="ann"))
    found = actionary.style("ann", action="Reach", purpose="PickUp", ee="right_hand")
    assert found == drink_from_mug().styles[0]
    assert actionary.style("ann", action="Reach", ee="left_hand") is None
    assert actionary.style("ben", action="Reach") is None


def test_the_feature_table_starts_empty_and_learns(actionary: Actionary) -> None:
    assert actionary.feature_table() == ()
    actionary.add(drink_from_mug())
    seen = {row.name: row for row in actionary.feature_table()}
    assert set(seen) == {"Reach", "MoveObjTo", "MoveObj", "TouchWith", "ResumePosture"}
    assert seen["MoveObjTo"].seen == 2 and not seen["MoveObjTo"].declared
    strange = FeatureSet("011", "110", "10", "hand", "00")
    row = actionary.add_feature_row("Swap", strange, general=("MoveObj",))
    assert row.declared and row.general == ("MoveObj",)
    with pytest.raises(ParError, match="named 'Swap' already"):
        actionary.add_feature_row("Other", strange)
    text = actionary.feature_program()
    assert 'feature_row("Swap", hand, "011", "110", "10", "00").' in text.splitlines()
    assert 'specialises("Swap", "MoveObj").' in text.splitlines()
    assert 'primitive("Reach").' in text.splitlines()


def test_abilities_are_declared_or_observed(actionary: Actionary) -> None:
    actionary.add(drink_from_mug(agent="ann"))
    assert ("Reach", "observed") in {(e.action, e.evidence) for e in actionary.abilities("ann")}
    assert actionary.unmet("MoveObjTo", agent="ann", objects=["mug", "table"]) == ()
    (missing,) = actionary.unmet("MoveObjTo", agent="ben", objects=["mug", "table"])
    assert missing.arguments == ("agent", "MoveObjTo")
    actionary.add_ability("MoveObjTo", agent="ben")
    assert actionary.unmet("MoveObjTo", agent="ben", objects=["mug", "table"]) == ()
    actionary.add_ability("Pour", kind="container")
    assert ("Pour", "declared") in {(e.action, e.evidence) for e in actionary.abilities("mug")}
    with pytest.raises(UnknownNameError, match="MoveObjTo"):
        actionary.unmet("MoveObjTwo", agent="ben")
    with pytest.raises(StoreError, match="name one of them"):
        actionary.add_ability("Pour")


def test_rdflib_reads_the_same_actionary(actionary: Actionary) -> None:
    actionary.add(drink_from_mug())
    name = "https://w3id.org/capar/ontology#Segment"
    rows = actionary.dataset().query(f"SELECT ?s WHERE {{ ?s a <{name}> }}")
    assert len(list(rows)) == 6


numbers = st.floats(-10, 10, allow_nan=False)


@given(st.tuples(numbers, numbers, numbers), st.tuples(numbers, numbers, numbers, numbers))
def test_mirroring_twice_is_no_mirroring(
    place: tuple[float, float, float], turn: tuple[float, float, float, float]
) -> None:
    value = Nlt(place, turn)
    assert value.mirrored().mirrored() == value
    assert value.mirrored().position[::2] == value.position[::2]
