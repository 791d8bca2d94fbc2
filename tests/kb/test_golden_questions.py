"""Each named question answers rightly over five actions by three performers, in every store."""

from collections.abc import Iterator
from pathlib import Path

import motions
import pytest
from actionaries import ACTIONS, STORES, opened
from observations import with_unknown

from capar.model.errors import UnknownNameError
from capar.model.observation import Observation
from kb.actionary import Actionary
from kb.queries.questions import QuestionError, question, questions

PERFORMERS = sorted(each.name for each in motions.PERFORMERS)
ASKED_HERE = {
    "touching", "goal", "before", "follows", "grasped", "hand", "performers", "shared",
    "unknown", "unexplained", "instruments", "world", "allen", "observations", "actions",
    "notices", "looked_at", "where", "both_hands",
}  # fmt: skip

ASKED_OF_RECORDINGS = {
    "segments", "kinds", "durations", "place", "relations", "rule", "sources", "held", "uses",
    "abilities", "verb", "levin", "ambiguous", "arrangements", "looked_before", "speeds",
    "contacts",
}  # fmt: skip
"""The questions that test_competency.py asks."""

ASKED_OF_PERSONS = {"corrections"}
"""The questions that test_corrections.py asks."""


@pytest.fixture(scope="module", params=STORES)
def known(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    five_by_three: tuple[Observation, ...],
) -> Iterator[Actionary]:
    folder: Path = tmp_path_factory.mktemp(request.param)
    with opened(request.param, folder, request) as fresh:
        for each in five_by_three:
            fresh.add(each)
        fresh.add(with_unknown())
        yield fresh


def test_every_question_has_a_golden_answer_here_or_is_asked_of_recordings() -> None:
    assert set(questions()) == ASKED_HERE | ASKED_OF_RECORDINGS | ASKED_OF_PERSONS


def test_which_actions_touch_a_mug(known: Actionary) -> None:
    rows = known.ask("touching", object="mug")
    drinking = [row for row in rows if row["whole"] == "DrinkFromMug"]
    assert [(row["action"], row["times"]) for row in drinking] == [
        ("MoveObj", 3),
        ("MoveObjTo", 6),
        ("Reach", 3),
        ("ResumePosture", 3),
        ("TouchWith", 3),
    ]
    assert {row["whole"] for row in rows} == {"DrinkFromMug", "Strange"}


def test_a_mug_is_touched_where_a_container_is(known: Actionary) -> None:
    rows = known.ask("touching", object="container")
    mug_and_box = {"DrinkFromMug", "PickUpWithBothHands", "Strange"}
    assert {row["whole"] for row in rows} >= mug_and_box


def test_which_whole_actions_move_something_to_a_table(known: Actionary) -> None:
    rows = known.ask("goal", goal="table")
    assert {row["whole"] for row in rows} == {"DrinkFromMug"}
    assert [row["performer"] for row in rows] == PERFORMERS
    assert known.ask("goal", goal="furniture") == rows
    assert known.ask("goal", goal="mug") == []


def test_what_must_hold_before_an_object_is_moved_to_another(known: Actionary) -> None:
    rows = known.ask("before", action="MoveObjTo")
    needed = [row for row in rows if row["why"] == "preparation"]
    assert [(row["condition"], row["otherwise"]) for row in needed] == [
        ("contact(EE, obj1)", "Reach(obj1)")
    ]
    able = [row["condition"] for row in rows if row["why"] == "applicability"]
    assert "capable(agent, MoveObjTo)" in able


def test_what_follows_a_reach_most_often(known: Actionary) -> None:
    rows = known.ask("follows", action="Reach")
    assert [(row["next"], row["times"]) for row in rows] == [
        ("Touch", 6),
        ("TouchWith", 6),
        ("MoveObj", 3),
        ("MoveObjTo", 3),
        ("Unknown", 1),
    ]


def test_where_a_mug_was_grasped_for_drinking(
    known: Actionary, five_by_three: tuple[Observation, ...]
) -> None:
    expected = {
        each.capture: place.goal_nlt.position
        for each in five_by_three
        if each.complex_par.name == "DrinkFromMug"
        for place in each.locations
        if place.action == "Reach" and place.goal_nlt
    }
    rows = known.ask("grasped", object="mug", purpose="Drink")
    assert {row["observation"]: (row["x"], row["y"], row["z"]) for row in rows} == expected
    assert {row["ee"] for row in rows} == {"right_hand"}
    assert known.ask("grasped", object="mug", purpose="Throw") == []


def test_which_hand_reaches(known: Actionary) -> None:
    rows = known.ask("hand", action="Reach")
    assert [(row["ee"], row["segments"]) for row in rows] == [("right_hand", 16), ("left_hand", 3)]
    both = known.ask("hand", action="PickUpWithBothHands")
    assert {row["side"] for row in both} == {"left", "right"}


def test_who_drank_and_how_long_it_took(known: Actionary) -> None:
    rows = known.ask("performers", action="DrinkFromMug")
    assert [row["performer"] for row in rows] == PERFORMERS
    for row in rows:
        who = next(each for each in motions.PERFORMERS if each.name == row["performer"])
        lasted = motions.drink_from_mug(who).truth.duration_s
        assert abs(float(row["seconds"] or 0) - lasted) < 0.02


def test_which_sub_actions_drinking_and_lifting_share(known: Actionary) -> None:
    rows = known.ask("shared", first="DrinkFromMug", second="PickUpWithBothHands")
    assert [row["action"] for row in rows] == ["MoveObj", "Reach", "ResumePosture", "TouchWith"]
    touching = known.ask("shared", first="TouchFromRest", second="TouchCycle")
    assert [row["action"] for row in touching] == ["Reach", "Touch"]


def test_what_is_unknown_is_only_what_no_rule_names(known: Actionary) -> None:
    rows = known.ask("unknown")
    assert [(row["start"], row["end"], row["moved"], row["nearest"]) for row in rows] == [
        ("011", "110", "10", "MoveObj"),
        ("011", "110", "10", "MoveObjTo"),
    ]
    unexplained = known.ask("unexplained")
    assert [(row["observation"], row["first"], row["last"]) for row in unexplained] == [
        ("Strange", 50, 120)
    ]
    assert known.ask("unexplained", observation="drink_from_mug_child") == []


def test_which_actions_use_an_instrument(known: Actionary) -> None:
    rows = known.ask("instruments")
    found = {(row["action"], row["instrument"], row["upon"], row["times"]) for row in rows}
    assert ("MoveObjTo", "mug", "head", 3) in found
    assert ("MoveObjTo", "mug", "table", 3) in found
    assert ("TouchWith", "mug", "table", 3) in found
    assert not any(action in {"Reach", "Touch", "ResumePosture"} for action, *_ in found)


@pytest.mark.parametrize("share", [0.1, 0.3, 0.5, 0.7, 0.9])
def test_the_world_at_a_time_has_the_contacts_that_truly_were(
    known: Actionary, share: float
) -> None:
    performer = next(iter(motions.PERFORMERS))
    trial = motions.drink_from_mug(performer)
    time_s = share * trial.truth.duration_s
    true = {
        frozenset((each.body, each.other))
        for each in trial.truth.contacts()
        if each.begin_s <= time_s <= each.end_s
    }
    rows = known.ask("world", capture=trial.capture.name, time=time_s)
    touching = {
        frozenset((str(row["first"]), str(row["second"])))
        for row in rows
        if row["relation"] == "touches"
    }
    assert touching == true
    assert len([row for row in rows if row["relation"] == "does"]) == 1


def test_relations_of_allen_between_the_hands_are_those_observed(
    known: Actionary, five_by_three: tuple[Observation, ...]
) -> None:
    lifted = [e for e in five_by_three if e.complex_par.name == "PickUpWithBothHands"]
    for each in lifted:
        rows = known.ask("allen", action=each.capture)
        found = {(row["first"], row["relation"], row["second"]) for row in rows}
        steps = {link.ee: link.steps for link in each.complex_par.links}
        assert found == {
            (
                f"{r.first[0]} {r.first[1]}: {steps[r.first[0]][r.first[1]].action}",
                r.relation,
                f"{r.second[0]} {r.second[1]}: {steps[r.second[0]][r.second[1]].action}",
            )
            for r in each.complex_par.relations
        }
    assert len(known.ask("allen", action="PickUpWithBothHands")) == sum(
        len(each.complex_par.relations) for each in lifted
    )


def test_observations_actions_and_notices_are_listed(
    known: Actionary, five_by_three: tuple[Observation, ...]
) -> None:
    rows = known.ask("observations")
    assert len(rows) == len(five_by_three) + 1
    assert {row["whole"] for row in rows} == {*ACTIONS, "Strange"}
    assert len(known.ask("observations", performer="child")) == len(ACTIONS)
    times = {row["action"]: row["times"] for row in known.ask("actions")}
    assert times == {
        "MoveObj": 12,
        "MoveObjTo": 6,
        "Reach": 19,
        "ResumePosture": 12,
        "Touch": 6,
        "TouchWith": 15,
    }
    told = sum(len(each.notices) for each in five_by_three)
    assert len(known.ask("notices")) == told


def test_what_was_looked_at_is_what_the_locations_say(
    known: Actionary, five_by_three: tuple[Observation, ...]
) -> None:
    rows = known.ask("looked_at", action="Reach")
    expected = {
        (each.capture, place.seen)
        for each in (*five_by_three, with_unknown())
        for place in each.locations
        if place.action == "Reach" and place.v_nlt
    }
    assert {(row["observation"], row["seen"]) for row in rows} == expected


def test_rules_without_prepositions_say_nowhere(known: Actionary) -> None:
    assert known.ask("where") == []


def test_a_wrong_parameter_says_which_exist() -> None:
    with pytest.raises(UnknownNameError, match="there are: capture, time"):
        question("world").bind({"captur": "x", "time": 1})
    with pytest.raises(QuestionError, match="capture must be given"):
        question("world").bind({"time": 1})
    with pytest.raises(QuestionError, match="time is a number, not 'soon'"):
        question("world").bind({"capture": "x", "time": "soon"})
    with pytest.raises(UnknownNameError, match="Did you mean 'touching'"):
        question("touchin")


def test_a_value_that_looks_like_sparql_is_a_text(known: Actionary) -> None:
    assert known.ask("touching", object='" } SERVICE <http://127.0.0.1/> { ?s ?p ?o } #') == []


def test_the_thesis_knows_no_action_of_both_hands(known: Actionary) -> None:
    assert known.ask("both_hands") == []
