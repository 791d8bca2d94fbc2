"""Plans for others are read by the tools of their fields, and come to what was observed."""

from functools import cache
from pathlib import Path

import behaviortreepy
import motions
import pytest
from bml_standard import check_bml, synchronized, times_of
from bundles import DRINKING
from motions.performers import PERFORMERS
from plan_tools import World, problem_of, shortest_plan, ticked
from typer.testing import CliRunner

from capar.cli import app
from capar.export.pddl import pddl
from capar.export.plans import NAMESPACE, PlanSource, behavior_tree, bml
from capar.model.errors import CaparError
from capar.model.facts import Touching
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from capar.pipelines.plan_export import observed_plan, plan_files
from kb import Actionary

MOTIONS = {
    "touch_cycle": motions.touch_cycle,
    "slide_object": motions.slide_object,
    "pick_up": motions.pick_up_with_both_hands,
}
"""Three motions, of one hand and of two."""

NAMES = ("demo", *MOTIONS)


@cache
def _seen(name: str) -> Observation:
    return observe(DRINKING if name == "demo" else MOTIONS[name](PERFORMERS[0]).capture)


@cache
def _source(name: str) -> PlanSource:
    return observed_plan(_seen(name))


def _by_link(steps: list[tuple[str, ...]]) -> dict[str, list[tuple[str, ...]]]:
    found: dict[str, list[tuple[str, ...]]] = {}
    for name, ee, *rest in steps:
        found.setdefault(ee, []).append((name, *rest))
    return found


def _observed(name: str) -> dict[str, list[tuple[str, ...]]]:
    steps = pddl(_source(name)).observed
    return _by_link([tuple(w.lower() for w in (s.action, *s.arguments)) for s in steps])


def _planned(name: str) -> dict[str, list[tuple[str, ...]]]:
    made = pddl(_source(name))
    plan = shortest_plan(problem_of(made.domain, made.problem))
    return _by_link([tuple(word.lower() for word in step) for step in plan])


@pytest.mark.parametrize("name", NAMES)
def test_the_shortest_plan_is_the_observed_sequence_of_each_hand(name: str) -> None:
    assert _planned(name) == _observed(name)


def test_a_step_that_changes_nothing_is_not_planned_twice() -> None:
    made = pddl(_source("touch_cycle"))
    goal = made.problem.index("(lasted", made.problem.index("(:goal"))
    end = made.problem.index(")", goal) + 1
    shorter = made.problem[:goal] + made.problem[end:]
    steps = shortest_plan(problem_of(made.domain, shorter))
    assert len(steps) == len(made.observed) - 1
    assert "touch" not in {name for name, *_ in steps}


def test_what_nobody_is_capable_of_is_not_planned() -> None:
    made = pddl(_source("demo"))
    able = "(capable the_mug Drink_action)"
    assert able in made.problem
    assert not shortest_plan(problem_of(made.domain, made.problem.replace(able, "", 1)))


def test_types_are_the_kinds_of_the_actionary() -> None:
    domain = pddl(_source("demo")).domain
    assert "    mug - container\n    container - thing\n" in domain
    assert "    table - furniture\n    furniture - support\n" in domain


def _world(name: str) -> World:
    source = _source(name)
    after = {each.upar.name: each.upar.post_assertions for each in source.steps}
    prepared = {p.action.action for each in source.steps for p in each.upar.preparation}
    touching = (each for each in _seen(name).facts if isinstance(each, Touching))
    at_first = [(each.body, each.other) for each in touching if each.first == 0]
    contacts = {pair for a, b in at_first for pair in ((a, b), (b, a))}
    return World(dict.fromkeys(prepared, ()) | after, contacts, set(source.links))


def _done(name: str) -> list[tuple[str, ...]]:
    steps = _source(name).steps
    return [(each.ipar.upar, each.ipar.ee, *each.ipar.objects) for each in steps]


@pytest.mark.parametrize("name", NAMES)
def test_a_tree_is_loaded_and_ticked_and_does_the_observed_steps(name: str) -> None:
    world = _world(name)
    text = behavior_tree(_source(name))
    assert ticked(text, world) == behaviortreepy.NodeStatus.SUCCESS
    assert sorted(world.done) == sorted(_done(name))
    for ee in _source(name).links:
        assert [d for d in world.done if d[1] == ee] == [d for d in _done(name) if d[1] == ee]


def test_a_tree_makes_true_what_a_step_needs_and_stops_where_nobody_is_capable() -> None:
    text = behavior_tree(_source("demo"))
    away = _world("demo")
    away.postures.clear()
    assert ticked(text, away) == behaviortreepy.NodeStatus.SUCCESS
    assert away.done[0] == ("PostureChange", "right_hand")
    unable = _world("demo")
    unable.unable = frozenset({"head"})
    assert ticked(text, unable) == behaviortreepy.NodeStatus.FAILURE
    assert [name for name, *_ in unable.done] == ["Reach"]


@pytest.mark.parametrize("name", NAMES)
def test_a_block_of_behaviours_is_as_the_standard_says(name: str) -> None:
    source = _source(name)
    root = check_bml(bml(source))
    times = times_of(root)
    for ee, steps in source.links.items():
        for number, each in enumerate(steps):
            span = times[f"{ee}_{number}"]
            begin = each.step.begin * source.duration_s
            assert span["start"] == pytest.approx(begin, abs=0.002)
            length = each.step.share * source.duration_s
            assert span["end"] - span["start"] == pytest.approx(length, abs=0.002)
    for points in synchronized(root):
        when = [times[behaviour][point] for behaviour, point in points]
        assert max(when) - min(when) < 0.002, points


def test_hands_that_let_go_together_are_kept_together() -> None:
    root = check_bml(bml(_source("pick_up")))
    assert any(
        {behaviour.rpartition("_")[0] for behaviour, _ in points} == {"left_hand", "right_hand"}
        for points in synchronized(root)
    )


@pytest.mark.parametrize(
    ("spoilt", "into"),
    [
        ("gesture ", "grasp "),
        (' mode="RIGHT_HAND"', ' mode="RIGHT"'),
        (":end", ":finish"),
        (' lexeme="Reach"', ""),
        ("right_hand_0:start", "nobody:start"),
    ],
)
def test_what_the_standard_does_not_have_is_found(spoilt: str, into: str) -> None:
    text = bml(_source("demo"))
    assert spoilt in text
    changed = (
        text.replace(spoilt, into).replace("</gesture", f"</{into.strip()}")
        if (spoilt == "gesture ")
        else text.replace(spoilt, into)
    )
    with pytest.raises(AssertionError):
        check_bml(changed)


def test_the_same_action_gives_the_same_bytes() -> None:
    source = _source("pick_up")
    assert NAMESPACE in bml(source)
    for write in (bml, behavior_tree, pddl):
        assert write(source) == write(source)


def _run(*arguments: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["export", *arguments])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        assert isinstance(result.exception, CaparError), result.exception
        return 2, str(result.exception)
    return result.exit_code, result.output


def test_a_stored_observation_gives_the_same_plan_as_its_capture(tmp_path: Path) -> None:
    with Actionary.open(tmp_path / "actionary") as words:
        words.add(_seen("demo"))
    place = str(tmp_path / "actionary")
    name = _seen("demo").capture
    for form in ("bt", "bml"):
        code, text = _run(name, "--format", form, "--actionary", place)
        assert code == 0
        assert text == "".join(plan_files(_source("demo"), form).values())
    out = tmp_path / "pddl"
    assert _run(name, "--format", "pddl", "--actionary", place, "--output", str(out))[0] == 0
    assert (out / "domain.pddl").read_text() == pddl(_source("demo")).domain
    assert (out / "problem.pddl").read_text() == pddl(_source("demo")).problem
    code, said = _run("nobody", "--format", "bt", "--actionary", place)
    assert code == 2
    assert name in said


def test_a_plan_that_is_not_named_whole_is_refused_with_the_remedy(tmp_path: Path) -> None:
    for arguments, remedy in (
        (("--format", "bml"), "name a capture or an observation"),
        ((str(DRINKING), "--format", "pddl"), "name a folder by --output"),
        ((str(DRINKING), "--format", "pddl", "--output", str(DRINKING)), "new folder"),
        ((str(DRINKING), "--format", "bt", "--soma"), "leave it out"),
        (("--output", "x.ttl", "--actionary", str(tmp_path)), "RDF goes to FILE"),
        (("nowhere", "--format", "bml", "--actionary", str(tmp_path)), "nowhere: is no capture"),
    ):
        code, said = _run(*arguments)
        assert code == 2
        assert remedy in said
