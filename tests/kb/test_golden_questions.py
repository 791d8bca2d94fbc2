"""Each named question answers rightly over five actions by three performers, in every store.

They are observed by the thesis's rules, and by the default ones as ``capar observe`` keeps them.
"""

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from statistics import mean, stdev
from typing import Any

import motions
import pytest
from actionaries import ACTIONS, STORES, opened
from observations import with_unknown

from capar.model.errors import UnknownNameError
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.checks import check
from kb.exchange import bring_in, export, misplaced, read
from kb.queries.questions import QuestionError, question, questions
from kb.store.names import GRAPHS

PERFORMERS = sorted(each.name for each in motions.PERFORMERS)
FIRST = next(iter(motions.PERFORMERS))
ASKED_HERE = {
    "touching", "goal", "before", "follows", "grasped", "hand", "performers", "shared",
    "unknown", "unexplained", "instruments", "world", "allen", "observations", "actions",
    "notices", "looked_at", "where", "both_hands", "statistics", "sequences", "outliers",
}  # fmt: skip

ASKED_OF_RECORDINGS = {
    "segments", "kinds", "durations", "place", "relations", "rule", "sources", "held", "uses",
    "abilities", "verb", "levin", "ambiguous", "arrangements", "looked_before", "speeds",
    "contacts",
}  # fmt: skip
"""The questions that test_competency.py asks."""

ASKED_OF_PERSONS = {"corrections"}
"""The questions that test_corrections.py asks."""

SEQUENCES = {
    "DrinkFromMug": ("Reach", "MoveObjTo", "Drink", "MoveObjTo", "TouchWith", "ResumePosture"),
    "PickUpWithBothHands": ("Reach", "Touch", "Lift", "Lower", "TouchWith"),
    "SlideObject": ("Reach", "Push"),
    "TouchCycle": ("Reach", "Touch", "ResumePosture"),
    "TouchFromRest": ("Reach", "Touch"),
}
"""What every link of each action does by the default rules; PickUpWithBothHands ends in one
common ResumePosture."""


@pytest.fixture(scope="module", params=STORES)
def known(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    five_by_three: tuple[Observation, ...],
) -> Iterator[Actionary]:
    """What the thesis's rules make of them."""
    folder: Path = tmp_path_factory.mktemp(request.param)
    with opened(request.param, folder, request) as fresh:
        for each in (*five_by_three, with_unknown()):
            fresh.add(each)
        yield fresh


@pytest.fixture(scope="module")
def folder(
    tmp_path_factory: pytest.TempPathFactory, extended_five_by_three: tuple[Observation, ...]
) -> Path:
    """What the command keeps by the default rules; those without a name are to be recognised."""
    place = tmp_path_factory.mktemp("extended") / "actionary"
    for each in (*extended_five_by_three, with_unknown()):
        name = each.complex_par.name
        with Actionary.open(place) as actionary:
            known = actionary.recognise(each.complex_par)
            actionary.add(each, name=known if name == each.capture else name)
    return place


@pytest.fixture(scope="module")
def extended(folder: Path) -> Iterator[Actionary]:
    """The same in memory, by way of an export."""
    with Actionary.in_memory() as fresh, Actionary.open(folder, read_only=True) as kept:
        bring_in(fresh.store, read(export(kept.store, "trig"), "trig"))
        yield fresh


def rows(actionary: Actionary, name: str, given: dict[str, str]) -> list[tuple[Any, ...]]:
    return [tuple(row.values()) for row in actionary.ask(name, **given)]


def test_every_question_has_a_golden_answer_here_or_is_asked_elsewhere() -> None:
    assert set(questions()) == ASKED_HERE | ASKED_OF_RECORDINGS | ASKED_OF_PERSONS


THESIS: tuple[tuple[str, dict[str, str], list[tuple[Any, ...]]], ...] = (
    (
        "follows",
        {"action": "Reach"},
        [("Touch", 6), ("TouchWith", 6), ("MoveObj", 3), ("MoveObjTo", 3), ("Unknown", 1)],
    ),
    (
        "hand",
        {"action": "Reach"},
        [("right_hand", "right", 16), ("left_hand", "left", 3)],
    ),
    ("goal", {"goal": "mug"}, []),
    ("grasped", {"object": "mug", "purpose": "Throw"}, []),
    ("where", {}, []),
    ("both_hands", {}, []),
    ("unexplained", {"observation": "drink_from_mug_child"}, []),
    ("touching", {"object": '" } SERVICE <http://127.0.0.1/> { ?s ?p ?o } #'}, []),
)
"""Whole answers by the thesis's rules."""


@pytest.mark.parametrize(("name", "given", "expected"), THESIS)
def test_an_answer_by_the_thesis_is_the_golden_one(known, name, given, expected) -> None:
    found = rows(known, name, given)
    assert sorted(found) == sorted(expected)


EXTENDED: tuple[tuple[str, dict[str, str], list[tuple[Any, ...]]], ...] = (
    (
        "follows",
        {"action": "Reach"},
        [("Touch", 12), ("MoveObjTo", 3), ("Push", 3), ("Unknown", 1)],
    ),
    (
        "shared",
        {"first": "DrinkFromMug", "second": "PickUpWithBothHands"},
        [("Reach", 1, 2), ("ResumePosture", 1, 1), ("TouchWith", 1, 2)],
    ),
    ("hand", {"action": "Lift"}, [("left_hand", "left", 3), ("right_hand", "right", 3)]),
    (
        "instruments",
        {},
        [
            ("Drink", "mug", "head", 3),
            ("Lower", "box", "table", 6),
            ("MoveObjTo", "mug", "head", 3),
            ("MoveObjTo", "mug", "table", 3),
            ("Push", "box", "table", 3),
            ("TouchWith", "box", "table", 6),
            ("TouchWith", "mug", "table", 3),
        ],
    ),
    ("where", {"preposition": "into"}, []),
    ("both_hands", {"object": "mug"}, []),
)
"""Whole answers by the default rules."""


@pytest.mark.parametrize(("name", "given", "expected"), EXTENDED)
def test_an_answer_by_the_default_rules_is_the_golden_one(extended, name, given, expected) -> None:
    assert rows(extended, name, given) == expected


@pytest.mark.parametrize("share", [0.1, 0.3, 0.5, 0.7, 0.9])
def test_the_world_at_a_time_has_the_contacts_that_truly_were(
    known: Actionary, extended: Actionary, share: float
) -> None:
    trial = motions.drink_from_mug(FIRST)
    time_s = share * trial.truth.duration_s
    true = {
        frozenset((each.body, each.other))
        for each in trial.truth.contacts()
        if each.begin_s <= time_s <= each.end_s
    }
    for actionary in (known, extended):
        found = actionary.ask("world", capture=trial.capture.name, time=time_s)
        assert true == {
            frozenset((str(row["first"]), str(row["second"])))
            for row in found
            if row["relation"] == "touches"
        }
        assert len([row for row in found if row["relation"] == "does"]) == 1


def test_relations_of_allen_between_the_hands_are_those_observed(
    known: Actionary, five_by_three: tuple[Observation, ...]
) -> None:
    lifted = [e for e in five_by_three if e.complex_par.name == "PickUpWithBothHands"]
    for each in lifted:
        steps = {link.ee: link.steps for link in each.complex_par.links}

        def label(step: tuple[str, int], steps: dict[str, Any] = steps) -> str:
            ee, index = step
            return f"{ee} {index}: {steps[ee][index].action}"

        found = known.ask("allen", action=each.capture)
        assert {(row["first"], row["relation"], row["second"]) for row in found} == {
            (label(r.first), r.relation, label(r.second)) for r in each.complex_par.relations
        }
    both = known.ask("allen", action="PickUpWithBothHands")
    assert len(both) == sum(len(each.complex_par.relations) for each in lifted)


def test_an_action_is_one_and_the_same_whoever_performs_it(
    extended: Actionary, extended_five_by_three: tuple[Observation, ...]
) -> None:
    signatures = {each.complex_par.signature for each in extended_five_by_three}
    assert len(signatures) == len(ACTIONS)
    listed = {row["observation"]: row for row in extended.ask("observations")}
    wholes = Counter(row["whole"] for row in listed.values())
    assert wholes == dict.fromkeys(ACTIONS, len(PERFORMERS)) | {"Strange": 1}
    for each in extended_five_by_three:
        assert extended.recognise(each.complex_par) == listed[each.capture]["whole"]
        par = extended.complex_par(each.capture)
        for link in par.links:
            assert tuple(step.action for step in link.steps) == SEQUENCES[par.name]
        both = par.name == "PickUpWithBothHands"
        assert (len(par.links), par.common is not None) == ((2, True) if both else (1, False))
    asked = "SELECT DISTINCT ?par WHERE { ?seen capar:enacts ?par }"
    assert len(extended.query(asked).rows) == len(ACTIONS) + 1


def test_nothing_is_stored_twice_or_wrong(folder: Path) -> None:
    def held(actionary: Actionary) -> set[object]:
        return {quad for quad in actionary.store.quads() if quad.graph_name != GRAPHS["runs"]}

    with Actionary.open(folder, read_only=True) as kept:
        before = held(kept)
        assert check(kept.store) == ()
        assert misplaced(kept.store) == 0
    with Actionary.open(folder) as again:
        (part,) = [e for e in again.observations() if e.name == f"touch_cycle_{FIRST.name}"]
        added = again.add(observe(ACTIONS["TouchCycle"](FIRST).capture, name=part.action))
        assert added.replaced
        assert held(again) == before


def test_statistics_of_many_captures_are_those_of_a_plain_computation(
    known: Actionary, five_by_three: tuple[Observation, ...]
) -> None:
    every = (*five_by_three, with_unknown())
    called = {"agent": "agent of Strange"}  # who has no name is called by the capture's
    segments = [
        (
            called.get(who := seen.performer(link.ee), who),
            each.name if each.known else "Unknown",
            each.end_s - each.start_s,
        )
        for seen in every
        for link in seen.links
        for each in link.segments
    ]
    rows = known.ask("statistics")
    assert {(r["performer"], r["action"]): r["times"] for r in rows} == Counter(
        (who, name) for who, name, _ in segments
    )
    for row in rows:
        own = [s for who, name, s in segments if (who, name) == (row["performer"], row["action"])]
        figures = (min(own), sum(own) / len(own), max(own), sum(own))
        found = (row["shortest"], row["mean"], row["longest"], row["total"])
        assert found == pytest.approx(figures, abs=1e-6)
    pairs = Counter(
        tuple(each.name if each.known else "Unknown" for each in pair)
        for seen in every
        for link in seen.links
        for pair in pairwise(link.segments)
    )
    firsts = Counter(first for first, _ in pairs.elements())
    for row in (found := known.ask("sequences")):
        assert row["share"] == pytest.approx(row["times"] / firsts[row["action"]])
    assert {(row["action"], row["next"]): row["times"] for row in found} == pairs
    expected = set()
    for deviations in (1.0, 2.0):
        expected = {
            (name, round(s, 6))
            for index, (_, name, s) in enumerate(segments)
            if name != "Unknown"
            if len(o := [b for n, (_, a, b) in enumerate(segments) if a == name and n != index]) > 2
            if abs(s - mean(o)) > deviations * stdev(o)
        }
        outliers = known.ask("outliers", deviations=deviations)
        assert {
            (row["action"], round(float(str(row["seconds"])), 6)) for row in outliers
        } == expected
    assert expected


def test_where_bodies_are_and_go(
    extended: Actionary, extended_five_by_three: tuple[Observation, ...]
) -> None:
    assert {
        (r["observation"], r["ee"], r["index"], r["preposition"], r["body"], other)
        for r in extended.ask("where")
        for other in str(r["other"]).split()
    } == {
        (each.capture, segment.ee, segment.index, *said)
        for each in extended_five_by_three
        for segment in each.segments
        for said in segment.prepositions
    }
    onto = extended.ask("where", preposition="onto")
    assert Counter((r["action"], r["body"], r["other"]) for r in onto) == {
        ("MoveObjTo", "mug", "table"): 3,
        ("Lower", "box", "table"): 6,
        ("Reach", "right_hand", "box"): 6,
    }
    off = extended.ask("where", preposition="off", body="box")
    assert Counter((r["action"], r["body"]) for r in off) == {("Lift", "box"): 6}


def test_a_wrong_parameter_says_which_exist() -> None:
    with pytest.raises(UnknownNameError, match="there are: capture, time"):
        question("world").bind({"captur": "x", "time": 1})
    with pytest.raises(QuestionError, match="capture must be given"):
        question("world").bind({"time": 1})
    with pytest.raises(QuestionError, match="time is a number, not 'soon'"):
        question("world").bind({"capture": "x", "time": "soon"})
    with pytest.raises(UnknownNameError, match="Did you mean 'touching'"):
        question("touchin")
