"""Recorded things are bound to things of a scene, or it is said which fit and what would do."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from exit_codes import exit_code
from recorded_worlds import Worlds, worlds_in

from capar.body.scripted_actions import action_capture
from capar.body.virtual_scenes import Thing, box, cup, table
from capar.model.capture import TagType
from capar.model.errors import UnknownNameError
from capar.pipelines.action_binding import check_applicable
from capar.pipelines.observation import observe
from capar.pipelines.recordings import observed_recording
from capar.pipelines.round_trips import observed_source
from capar.regeneration.roles import AmbiguousError, Binding, Role, bind, roles_of
from capar.regeneration.scenes import PlanError, Scene
from kb.lookup.agents import Ability

MUG = Role("mug", "mug", TagType.MOBILE, (), moved=True)
TABLE = Role("table", "table", TagType.FIXED, ("mug",), moved=False)
ABOVE = {
    "mug": ("mug", "container", "object"),
    "bowl": ("bowl", "container", "object"),
    "table": ("table", "support", "object"),
    "shelf": ("shelf", "support", "object"),
}


def _kinds(kind: str) -> tuple[str, ...]:
    return ABOVE.get(kind, (kind, "object"))


def _scene(*things: Thing) -> Scene:
    return Scene({thing.name: thing for thing in things}, (0.0, 0.0), 0.0)


def _mug(name: str, aside_m: float, kind: str = "mug", top_m: float = 0.8) -> Thing:
    return Thing(name, cup(0.035, 0.09), (0.5, aside_m, top_m), kind=kind)


HIGH = replace(table(0.8), name="high")
LOW = replace(table(0.6), name="low")
SHELF = Thing("shelf", box(0.3, 0.3, 0.03), (0.5, 1.0, 0.97), tag=TagType.FIXED, kind="shelf")


def _things(found: tuple[Binding, ...]) -> list[str]:
    return [binding.thing for binding in found]


def test_the_only_thing_of_a_kind_takes_the_part_and_its_support_that_of_the_support() -> None:
    scene = _scene(HIGH, SHELF, _mug("cup", 0.0), _mug("jar", 0.2, "crate"))
    found = bind((TABLE, MUG), scene, {}, _kinds)
    assert _things(found) == ["high", "cup"]
    assert [one.reason for one in found] == [
        "what 'cup' stands on",
        "the only mug that can be moved",
    ]
    on_shelf = _scene(HIGH, SHELF, _mug("cup", 1.0, top_m=1.0))
    assert _things(bind((TABLE, MUG), on_shelf, {}, _kinds)) == ["shelf", "cup"]


def test_without_one_of_the_kind_the_nearest_kind_in_the_hierarchy_fits() -> None:
    scene = _scene(HIGH, _mug("dish", 0.0, "bowl"), _mug("parcel", 0.2, "crate"))
    (found,) = bind((MUG,), scene, {}, _kinds)
    assert (found.thing, found.reason) == ("dish", "the only container that can be moved")


def test_of_several_that_fit_the_user_is_asked_or_all_are_told() -> None:
    scene = _scene(HIGH, _mug("red", 0.0), _mug("blue", 0.2))
    with pytest.raises(AmbiguousError, match="may be taken by blue, red; say which: --object mug="):
        bind((MUG, TABLE), scene, {}, _kinds)
    heard: list[tuple[str, tuple[str, ...]]] = []

    def ask(role: Role, fitting: tuple[str, ...]) -> str:
        heard.append((role.name, fitting))
        return "red"

    assert _things(bind((MUG, TABLE), scene, {}, _kinds, ask)) == ["red", "high"]
    assert heard == [("mug", ("blue", "red"))]


def test_what_is_stated_counts_first_and_mistyped_names_are_told_with_the_nearest() -> None:
    scene = _scene(HIGH, LOW, _mug("red", 0.0), _mug("blue", 0.2))
    found = bind((MUG, TABLE), scene, {"table": "low", "mug": "blue"}, _kinds)
    assert _things(found) == ["blue", "low"]
    with pytest.raises(UnknownNameError, match="Did you mean 'blue'"):
        bind((MUG,), scene, {"mug": "bleu"}, _kinds)
    with pytest.raises(UnknownNameError, match="Did you mean 'mug'"):
        bind((MUG,), scene, {"mgu": "blue"}, _kinds)
    with pytest.raises(PlanError, match="parts of 'mug' and 'table' both"):
        bind((MUG, TABLE), scene, {"mug": "blue", "table": "blue"}, _kinds)
    with pytest.raises(PlanError, match="nothing is left that can be moved for the part of 'mug'"):
        bind((MUG,), _scene(HIGH), {}, _kinds)


def test_what_an_action_acts_on_and_its_supports_take_part_and_nothing_else() -> None:
    source = observed_source(action_capture("carry", rate_hz=30.0))
    clutter = replace(source.scene.thing("mug"), name="clutter", place=(0.4, 0.5, 0.9))
    scene = replace(source.scene, things={**source.scene.things, "clutter": clutter})
    paths = {**source.paths, "clutter": source.paths["mug"]}
    mug, top = roles_of(replace(source, scene=scene, paths=paths))
    assert (mug.name, mug.moved, mug.bears) == ("mug", True, ())
    assert (top.name, top.moved, top.bears) == ("table", False, ("mug",))


def test_declared_abilities_rule_out_what_is_not_among_them_and_name_what_would_declare_it() -> (
    None
):
    recording = observed_recording(observe(action_capture("slide", rate_hz=30.0)), Path("slide"))
    known: dict[str, tuple[Ability, ...]] = {}

    def check() -> tuple[str, ...]:
        own = {"mug": "mug"}
        return check_applicable(
            "Push", recording, ("tim", "child"), own, lambda name: known.get(name, ())
        )

    (note,) = check()
    assert "no ability is declared" in note
    known["tim"] = (Ability("Reach", "declared"), Ability("Touch", "observed"))
    with pytest.raises(
        PlanError, match=r"capable\(tim, Push\) .* `capar agent can tim Push Resume"
    ):
        check()
    known["tim"] += (Ability("MoveObj", "declared"), Ability("ResumePosture", "declared"))
    assert not check()
    known["mug"] = (Ability("Drink", "declared"), Ability("Reach", "observed"))
    with pytest.raises(PlanError, match=r"capable\(mug, Touch\) .* `capar object can mug Touch"):
        check()
    known["mug"] = (Ability("Push", "declared"),)
    assert not check()


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> Worlds:
    """An Actionary with one recorded touch, and a scene with two crates."""
    crates = [
        Thing(name, box(0.15, 0.2, 0.15), (0.44, y, 0.9)) for name, y in (("a", 0.0), ("b", 0.4))
    ]
    scene = {"crates": (table(0.9, near_m=0.23), *(replace(one, kind="crate") for one in crates))}
    return worlds_in(tmp_path_factory.mktemp("worlds"), ("touch",), scene)


def test_an_action_of_the_actionary_is_performed_on_what_is_stated_or_refused_with_what_fits(
    worlds: Worlds, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys.stdin, "isatty", lambda: False)
    scene = ("--scene", str(worlds.scene("crates")))
    assert exit_code(monkeypatch, "regenerate", "touch", *scene, *worlds.options) == 2
    assert "may be taken by a, b; say which: --object crate=a" in capsys.readouterr().err
    assert exit_code(monkeypatch, "regenerate", "tuoch", *scene, *worlds.options) == 2
    assert "Did you mean 'touch'" in capsys.readouterr().err
    asked = ("regenerate", "Touch", *scene, "--object", "crate=a", *worlds.options, "--json")
    assert exit_code(monkeypatch, *asked) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["passed"] is True
    assert {one["role"]: one["thing"] for one in told["objects"]} == {
        "crate": "a",
        "table": "table",
    }
