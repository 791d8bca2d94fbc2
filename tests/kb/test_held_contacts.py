"""Contacts of end-effectors tell for how long the thing is held in them, and how long it moves."""

from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug, pick_up_with_both_hands

from capar.model.facts import Moving, Touching
from kb.actionary import Actionary
from kb.encode.facts import held_contacts, overlap_s
from ontology import CAPAR

times = st.lists(st.integers(0, 200), min_size=2, max_size=12, unique=True).map(sorted)


@given(times, st.tuples(st.integers(0, 200), st.integers(0, 200)).map(sorted))
def test_the_time_shared_with_others_is_what_lies_in_both(ends: list[int], of: list[int]) -> None:
    spans = list(zip(ends[::2], ends[1::2], strict=False))
    counted = sum(any(a <= at < b for a, b in spans) for at in range(of[0], of[1]))
    assert overlap_s((of[0], of[1]), spans) == counted


def test_only_contacts_of_end_effectors_tell_how_long_the_thing_is_held() -> None:
    for seen in (drink_from_mug(), pick_up_with_both_hands()):
        effectors = {link.ee for link in seen.links}
        contacts = [each for each in seen.facts if isinstance(each, Touching)]
        told = held_contacts(seen, 100.0)
        assert set(told) == {each for each in contacts if each.body in effectors}
        for contact, of in told.items():
            lasts = (contact.last - contact.first) / 100.0
            assert 0.0 <= float(str(of[CAPAR.heldFor])) <= lasts + 1e-9
            moves = any(
                isinstance(each, Moving)
                and each.object == contact.other
                and each.first < contact.last
                and contact.first < each.last
                for each in seen.facts
            )
            assert (float(str(of[CAPAR.movedFor])) > 0.0) == moves


def test_what_is_held_is_told_by_contact_and_in_all() -> None:
    actionary = Actionary.in_memory()
    actionary.add(drink_from_mug())
    (row,) = actionary.ask("held")
    query = "SELECT (SUM(?held) AS ?all) { ?contact capar:heldFor ?held }"
    ((held,),) = (each.values() for each in actionary.query(query).plain())
    assert row["ee"] == "right_hand"
    assert 0.0 < float(str(row["held"])) == float(str(held)) <= float(str(row["touched"]))
