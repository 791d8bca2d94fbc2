"""A person's word stands beside the machine's, outlasts another observation, and can be asked."""

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug

from capar.cli.actionary import correct as command
from capar.evaluation import Kind
from capar.evaluation.labels import read_labels
from capar.model.errors import UnknownNameError
from capar.model.observation import SegmentAddress
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from kb.actionary import Actionary
from kb.checks import check
from kb.corrections import (
    Correction,
    Span,
    account,
    claims,
    correct,
    corrected,
    corrected_links,
    overlay,
)
from kb.errors import CorrectionError
from kb.language.describe import describe as described
from kb.store import names
from ontology import CAPAR

CAPTURE = "DrinkFromMug"

times = st.integers(0, 40).map(lambda tenth: tenth / 10)
claims_made = st.tuples(times, times).filter(lambda two: two[0] < two[1])


def at(index: int) -> SegmentAddress:
    return SegmentAddress("right_hand", index, CAPTURE)


def said(actionary: Actionary) -> list[tuple[str, float, float, str]]:
    spans = account(actionary.store, CAPTURE)
    return [(each.name, each.start_s, each.end_s, each.by) for each in spans]


@pytest.fixture
def drunk(actionary: Actionary) -> Actionary:
    actionary.add(drink_from_mug())
    return actionary


@given(st.lists(claims_made, max_size=6))
def test_claims_leave_every_moment_with_one_name_and_the_later_claim_holds(made) -> None:
    spans = tuple(Span("hand", float(second), second + 1.0, "Touch") for second in range(4))
    for number, (start, end) in enumerate(made):
        spans = overlay(spans, Span("hand", start, end, f"Claim{number}", by="Ada"))
    assert spans[0].start_s == 0.0
    assert spans[-1].end_s == 4.0
    assert all(one.end_s == pytest.approx(two.start_s) for one, two in pairwise(spans))
    for moment in (tenth / 10 + 0.05 for tenth in range(40)):
        latest = [n for n, (start, end) in enumerate(made) if start < moment < end]
        (span,) = (each for each in spans if each.start_s < moment < each.end_s)
        assert span.name == (f"Claim{latest[-1]}" if latest else "Touch")


def test_the_machines_segments_stay_and_the_account_differs(drunk: Actionary) -> None:
    before = drunk.ask("segments")
    machine = said(drunk)
    correct(drunk.store, at(2), Correction(name="Sip"), by="Ada")
    assert drunk.ask("segments") == before
    name, start, end, _ = machine[2]
    assert said(drunk) == [*machine[:2], ("Sip", start, end, "Ada"), *machine[3:]]
    assert name != "Sip"
    assert check(drunk.store) == ()


def test_a_damaged_claim_is_found(drunk: Actionary) -> None:
    correct(drunk.store, at(2), Correction(name="Sip"), by="Ada")
    assert check(drunk.store) == ()
    graph = f"GRAPH {names.GRAPHS['corrections']}"
    drunk.store.change(f"DELETE WHERE {{ {graph} {{ ?claim {CAPAR.actionName} ?name }} }}")
    assert any("names one action" in each.message for each in check(drunk.store))


def test_a_claim_outlasts_observing_and_forgetting(drunk: Actionary) -> None:
    correct(drunk.store, at(2), Correction(name="Sip"), by="Ada")
    before = said(drunk)
    drunk.add(drink_from_mug())
    assert said(drunk) == before
    drunk.forget(CAPTURE)
    assert [each.name for each in claims(drunk.store, CAPTURE)] == ["Sip"]
    with pytest.raises(UnknownNameError):
        account(drunk.store, CAPTURE)


def test_a_border_is_moved_for_both_of_its_segments(drunk: Actionary) -> None:
    (_, _, _, _), (_, start, end, _), (_, _, _, _), *_ = said(drunk)
    middle = (start + end) / 2
    correct(drunk.store, at(1), Correction(end_s=middle), by="Ada")
    assert (said(drunk)[1][2], said(drunk)[2][1]) == (middle, middle)
    correct(drunk.store, at(1), Correction(start_s=(start + middle) / 2), by="Ada")
    assert said(drunk)[0][2] == said(drunk)[1][1] == (start + middle) / 2


def test_one_segment_becomes_two_and_two_become_one(drunk: Actionary) -> None:
    machine = said(drunk)
    name, start, end, _ = machine[1]
    correct(drunk.store, at(1), Correction(split_s=(start + end) / 2), by="Ada")
    assert len(said(drunk)) == len(machine) + 1
    correct(drunk.store, at(1), Correction(join=True), by="Bo")
    assert said(drunk) == [machine[0], (name, start, end, "Bo"), *machine[2:]]


def test_questions_are_answered_by_the_account_on_request(drunk: Actionary) -> None:
    correct(drunk.store, at(1), Correction(name="Sip"), by="Ada")
    assert drunk.ask("performers", action="Sip") == []
    copy = Actionary(corrected(drunk.store))
    (row,) = copy.ask("performers", action="Sip")
    assert row["begins"] == pytest.approx(said(drunk)[1][1])
    assert [each["action"] for each in copy.ask("segments")] == [each[0] for each in said(drunk)]
    assert copy.ask("follows", action="Sip") == [{"next": said(drunk)[2][0], "times": 1}]
    (claim,) = drunk.ask("corrections")
    assert (claim["person"], claim["action"]) == ("Ada", "Sip")


def test_the_corrected_links_are_the_account_and_are_described(drunk: Actionary) -> None:
    seen = drink_from_mug()
    machine = said(drunk)
    _, start, end, _ = machine[1]
    correct(drunk.store, at(1), Correction(split_s=(start + end) / 2), by="Ada")
    correct(drunk.store, at(2), Correction(name="Lift"), by="Ada")
    found = replace(seen, links=corrected_links(seen.links, claims(drunk.store, CAPTURE)))
    (hand,) = (each for each in found.links if each.ee == "right_hand")
    assert [(e.name, e.start_s, e.end_s) for e in hand.segments] == [e[:3] for e in said(drunk)]
    assert [each.index for each in hand.segments] == list(range(len(machine) + 1))
    assert all(one.last == two.first for one, two in pairwise(hand.segments))
    words = primitive_words(primitive_files())
    assert "lifted it" in described(found, words=words)
    assert "lifted" not in described(seen, words=words)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({}, "say one change"),
        ({"name": "Sip", "join": True}, "say one change"),
        ({"name": "sip it"}, "no name of an action"),
    ],
)
def test_a_change_that_is_none_or_several_is_refused(change, why) -> None:
    with pytest.raises(CorrectionError, match=why):
        Correction(**change)


def test_a_claim_outside_its_segment_or_of_nobody_is_refused_and_nothing_kept() -> None:
    with Actionary.in_memory() as drunk:
        drunk.add(drink_from_mug())
        last = len(said(drunk)) - 1
        for index, change, by, why in (
            (1, Correction(split_s=99.0), "Ada", "does not lie between"),
            (1, Correction(start_s=99.0), "Ada", "does not lie between"),
            (last, Correction(join=True), "Ada", "the last segment"),
            (1, Correction(name="Sip"), " ", "--by PERSON"),
        ):
            with pytest.raises(CorrectionError, match=why):
                correct(drunk.store, at(index), change, by=by)
        with pytest.raises(UnknownNameError, match="right_hand/99"):
            correct(drunk.store, at(99), Correction(name="Sip"), by="Ada")
        assert claims(drunk.store, CAPTURE) == ()


def test_the_command_prints_the_account_and_writes_it_as_labels(tmp_path: Path, capsys) -> None:
    place, labels = str(tmp_path / "actionary"), tmp_path / "labels.csv"
    with Actionary.open(place) as actionary:
        actionary.add(replace(drink_from_mug(), capture="take"))
    command("take/right_hand/1", name="Sip", by="Ada", labels=labels, json=True, actionary=place)
    told = json.loads(capsys.readouterr().out)
    assert (told[1]["name"], told[1]["by"]) == ("Sip", "Ada")
    marks = read_labels(labels, kind=Kind.ACTIONS).marks
    assert [(each.label, each.start) for each in marks] == [
        (each["name"], each["start_s"]) for each in told
    ]
