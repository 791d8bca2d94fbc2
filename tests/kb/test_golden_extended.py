"""The same questions of the default rules, kept as `capar observe --actionary` keeps them.

One folder takes what the command keeps; the store in memory takes the folder's export.
"""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import motions
import pytest
from actionaries import ACTIONS, STORES, opened
from observations import with_unknown

from capar.cli.observe import _store
from capar.model.observation import Observation
from kb.actionary import Actionary
from kb.checks import check
from kb.exchange import bring_in, export, misplaced, read
from kb.queries.questions import questions
from kb.store.names import GRAPHS

PERFORMERS = sorted(each.name for each in motions.PERFORMERS)
FIRST = next(iter(motions.PERFORMERS)).name
ASKED_HERE = {
    "touching", "goal", "before", "follows", "grasped", "hand", "performers", "shared",
    "unknown", "unexplained", "instruments", "world", "allen", "observations", "actions",
    "notices", "looked_at", "where", "both_hands",
}  # fmt: skip
SEQUENCES = {
    "DrinkFromMug": ("Reach", "MoveObjTo", "Drink", "MoveObjTo", "TouchWith", "ResumePosture"),
    "PickUpWithBothHands": ("Reach", "Touch", "Lift", "Lower", "TouchWith"),
    "SlideObject": ("Reach", "Push"),
    "TouchCycle": ("Reach", "Touch", "ResumePosture"),
    "TouchFromRest": ("Reach", "Touch"),
}
"""What every link of each action does; PickUpWithBothHands ends in one common ResumePosture."""


def keep_all(place: str, observations: tuple[Observation, ...]) -> None:
    """What the command does with each observation; those without a name are to be recognised."""
    for each in (*observations, with_unknown()):
        name = each.complex_par.name
        _store(each, place, name="" if name == each.capture else name, wait_s=0)


@pytest.fixture(scope="module")
def folder(
    tmp_path_factory: pytest.TempPathFactory, extended_five_by_three: tuple[Observation, ...]
) -> Path:
    place = tmp_path_factory.mktemp("extended") / "actionary"
    keep_all(str(place), extended_five_by_three)
    return place


@pytest.fixture(scope="module", params=STORES)
def known(
    request: pytest.FixtureRequest,
    folder: Path,
    extended_five_by_three: tuple[Observation, ...],
) -> Iterator[Actionary]:
    if request.param == "folder":
        with Actionary.open(folder, read_only=True) as kept:
            yield kept
        return
    with opened(request.param, folder, request) as fresh:
        if request.param == "server":
            keep_all(fresh.store.place, extended_five_by_three)
        else:
            with Actionary.open(folder, read_only=True) as kept:
                bring_in(fresh.store, read(export(kept.store, "trig"), "trig"))
        yield fresh


def test_every_question_that_is_asked_here_exists() -> None:
    assert set(questions()) >= ASKED_HERE  # test_competency.py asks the others


def test_an_action_is_one_and_the_same_whoever_performs_it(
    known: Actionary, extended_five_by_three: tuple[Observation, ...]
) -> None:
    signatures = {each.complex_par.signature for each in extended_five_by_three}
    assert len(signatures) == len(ACTIONS)
    listed = {row["observation"]: row for row in known.ask("observations")}
    assert len(listed) == len(ACTIONS) * len(PERFORMERS) + 1
    wholes = Counter(row["whole"] for row in listed.values())
    assert wholes == dict.fromkeys(ACTIONS, len(PERFORMERS)) | {"Strange": 1}
    assert {row["profile"] for row in listed.values()} == {"extended"}
    for each in extended_five_by_three:
        assert known.recognise(each.complex_par) == listed[each.capture]["whole"]
    asked = "SELECT DISTINCT ?par WHERE { ?seen capar:enacts ?par }"
    assert len(known.query(asked).rows) == len(ACTIONS) + 1


def test_every_link_does_the_steps_of_its_action(known: Actionary) -> None:
    for row in known.ask("observations"):
        if row["whole"] in SEQUENCES:
            par = known.complex_par(str(row["observation"]))
            for link in par.links:
                assert tuple(step.action for step in link.steps) == SEQUENCES[par.name]
            both = par.name == "PickUpWithBothHands"
            assert (len(par.links), par.common is not None) == ((2, True) if both else (1, False))


def test_nothing_is_stored_twice_or_wrong(folder: Path) -> None:
    with Actionary.open(folder, read_only=True) as kept:
        before = _without_runs(kept)
        assert check(kept.store, full=False) == ()
        assert misplaced(kept.store) == 0
    with Actionary.open(folder) as again:
        (part,) = [e for e in again.observations() if e.name == f"touch_cycle_{FIRST}"]
        trial = ACTIONS["TouchCycle"](next(iter(motions.PERFORMERS)))
        from capar.pipelines.observation import observe

        added = again.add(observe(trial.capture, name=part.action))
        assert added.replaced
        assert _without_runs(again) == before


def _without_runs(actionary: Actionary) -> set[object]:
    """What an Actionary holds, but for when and where it was observed."""
    return {quad for quad in actionary.store.quads() if quad.graph_name != GRAPHS["runs"]}


def test_where_bodies_are_and_go(
    known: Actionary, extended_five_by_three: tuple[Observation, ...]
) -> None:
    found = {
        (r["observation"], r["ee"], r["index"], r["preposition"], r["body"], other)
        for r in known.ask("where")
        for other in str(r["other"]).split()
    }
    assert found == {
        (each.capture, segment.ee, segment.index, *said)
        for each in extended_five_by_three
        for segment in each.segments
        for said in segment.prepositions
    }
    onto = Counter(
        (r["action"], r["body"], r["other"]) for r in known.ask("where", preposition="onto")
    )
    assert onto == {
        ("MoveObjTo", "mug", "table"): 3,
        ("Lower", "box", "table"): 6,
        ("Reach", "right_hand", "box"): 6,
    }
    off = Counter(
        (r["action"], r["body"]) for r in known.ask("where", preposition="off", body="box")
    )
    assert off == {("Lift", "box"): 6}
    assert known.ask("where", preposition="into") == []


def test_borders_say_what_happens_there(known: Actionary) -> None:
    """A Drink ends where the mug leaves the head; a Lift ends where the box turns back down."""
    query = (
        "SELECT DISTINCT ?action ?kind ?body ?other WHERE {{ ?s capar:action/capar:name ?action ; "
        "capar:endsWith ?b . ?b capar:borderKind/capar:name ?kind ; capar:body/capar:name ?body ; "
        "capar:other/capar:name ?other FILTER(?action = '{0}') }}"
    )
    drink = [tuple(row.values()) for row in known.query(query.format("Drink")).plain()]
    assert drink == [("Drink", "ends", "mug", "head")]
    lift = [tuple(row.values()) for row in known.query(query.format("Lift")).plain()]
    assert lift == [("Lift", "reverses", "box", "box")]


def test_what_touches_a_mug(known: Actionary) -> None:
    rows = known.ask("touching", object="mug")
    assert [tuple(row.values()) for row in rows if row["whole"] == "DrinkFromMug"] == [
        (name, "DrinkFromMug", 6 if name == "MoveObjTo" else 3)
        for name in sorted(set(SEQUENCES["DrinkFromMug"]))
    ]


def test_what_moves_something_to_a_table(known: Actionary) -> None:
    rows = known.ask("goal", goal="table")
    assert [(row["whole"], row["performer"]) for row in rows] == [
        (whole, each) for whole in ("DrinkFromMug", "PickUpWithBothHands") for each in PERFORMERS
    ]


def test_what_must_hold_before_drinking(known: Actionary) -> None:
    needed = [
        (row["condition"], row["otherwise"])
        for row in known.ask("before", action="Drink")
        if row["why"] == "preparation"
    ]
    assert needed == [
        ("contact(EE, obj1)", "Reach(obj1)"),
        ("contact(obj1, obj2)", "MoveObjTo(obj1 obj2)"),
    ]


def test_what_follows_and_what_is_shared(known: Actionary) -> None:
    follows = [tuple(row.values()) for row in known.ask("follows", action="Reach")]
    assert follows == [("Touch", 12), ("MoveObjTo", 3), ("Push", 3), ("Unknown", 1)]
    shared = known.ask("shared", first="DrinkFromMug", second="PickUpWithBothHands")
    assert [tuple(row.values()) for row in shared] == [
        ("Reach", 1, 2),
        ("ResumePosture", 1, 1),
        ("TouchWith", 1, 2),
    ]


def test_where_a_mug_was_grasped_and_what_was_looked_at(
    known: Actionary, extended_five_by_three: tuple[Observation, ...]
) -> None:
    places = [
        (each.capture, place)
        for each in (*extended_five_by_three, with_unknown())
        for place in each.locations
        if place.action == "Reach"
    ]
    rows = known.ask("grasped", object="mug", purpose="Drink")
    assert {row["observation"]: (row["x"], row["y"], row["z"]) for row in rows} == {
        capture: place.goal_nlt.position
        for capture, place in places
        if capture.startswith("drink") and place.goal_nlt
    }
    assert [row["performer"] for row in rows] == PERFORMERS
    looked = known.ask("looked_at", action="Reach")
    assert {(row["observation"], row["seen"]) for row in looked} == {
        (capture, place.seen) for capture, place in places if place.v_nlt
    }


def test_which_hand_who_and_how_long(known: Actionary) -> None:
    hands = [tuple(row.values()) for row in known.ask("hand", action="Lift")]
    assert hands == [("left_hand", "left", 3), ("right_hand", "right", 3)]
    rows = known.ask("performers", action="DrinkFromMug")
    assert [row["performer"] for row in rows] == PERFORMERS
    for row in rows:
        who = next(each for each in motions.PERFORMERS if each.name == row["performer"])
        lasted = motions.drink_from_mug(who).truth.duration_s
        assert abs(float(row["seconds"] or 0) - lasted) < 0.02


def test_what_is_unknown_is_only_what_no_rule_names(known: Actionary) -> None:
    assert {row["nearest"] for row in known.ask("unknown")} == {"MoveObj", "MoveObjTo"}
    assert [row["observation"] for row in known.ask("unexplained")] == ["Strange"]


def test_which_actions_use_an_instrument(known: Actionary) -> None:
    assert [tuple(row.values()) for row in known.ask("instruments")] == [
        ("Drink", "mug", "head", 3),
        ("Lower", "box", "table", 6),
        ("MoveObjTo", "mug", "head", 3),
        ("MoveObjTo", "mug", "table", 3),
        ("Push", "box", "table", 3),
        ("TouchWith", "box", "table", 6),
        ("TouchWith", "mug", "table", 3),
    ]


def test_every_action_is_counted(
    known: Actionary, extended_five_by_three: tuple[Observation, ...]
) -> None:
    counted = {row["action"]: row["times"] for row in known.ask("actions")}
    both = {"DrinkFromMug": 1, "PickUpWithBothHands": 2}
    steps = Counter(
        step for name, steps in SEQUENCES.items() for step in steps * both.get(name, 1) * 3
    )
    assert counted.pop("Rest") == sum(
        segment.name == "Rest" for each in extended_five_by_three for segment in each.segments
    )
    assert counted == steps + Counter(ResumePosture=6, Reach=1)
    told = sum(len(each.notices) for each in extended_five_by_three)
    assert len(known.ask("notices")) == told


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_the_world_at_a_time_has_the_contacts_that_truly_were(
    known: Actionary, share: float
) -> None:
    trial = motions.drink_from_mug(next(iter(motions.PERFORMERS)))
    time_s = share * trial.truth.duration_s
    rows = known.ask("world", capture=trial.capture.name, time=time_s)
    assert {
        frozenset((str(row["first"]), str(row["second"])))
        for row in rows
        if row["relation"] == "touches"
    } == {
        frozenset((each.body, each.other))
        for each in trial.truth.contacts()
        if each.begin_s <= time_s <= each.end_s
    }


def test_both_hands_lift_at_once(known: Actionary) -> None:
    rows = known.ask("allen", action="PickUpWithBothHands")
    equal = [row for row in rows if row["relation"] == "equals"]
    assert Counter(str(row["first"]).split()[-1] for row in equal) == dict.fromkeys(
        SEQUENCES["PickUpWithBothHands"], len(PERFORMERS)
    )


def test_what_was_done_with_both_hands(
    known: Actionary, extended_five_by_three: tuple[Observation, ...]
) -> None:
    """Every performer holds, lifts, lowers and holds the box with both hands, and nothing else."""
    rows = known.ask("both_hands")
    done: dict[str, list[str]] = {}
    for row in rows:
        done.setdefault(str(row["observation"]), []).append(str(row["action"]))
    seen = [each for each in extended_five_by_three if each.joint]
    assert sorted(done) == sorted(each.capture for each in seen)
    assert list(done.values()) == [["Touch", "Lift", "Lower", "TouchWith"]] * 3
    assert {row["ees"] for row in rows} == {"left_hand right_hand"}
    assert {row["objects"] for row in rows} == {"box", "box table"}
    assert known.ask("both_hands", object="box") == rows
    assert known.ask("both_hands", object="mug") == []
    (capture,) = [each for each in seen if FIRST in each.capture]
    lifts = known.ask("both_hands", action="Lift")
    mine = next(row for row in lifts if row["observation"] == capture.capture)
    (lift,) = [each for each in capture.joint if each.name == "Lift"]
    assert (mine["begins"], mine["ends"]) == (lift.start_s, lift.end_s)
