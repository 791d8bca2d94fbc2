"""Stepping to where an action can be done, where it is out of reach from the given place."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from jaxtyping import Float

from capar.body.human import Human
from capar.model.errors import RuleError
from capar.regeneration.collisions import Surroundings
from capar.regeneration.drafts import check_stance
from capar.regeneration.errors import PlanError
from capar.regeneration.planning import beside, is_possible, why_unreachable
from capar.regeneration.quality import Quality
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver
from capar.regeneration.sources import Source
from capar.regeneration.stepping import STRIDE, Stepping, step_to
from capar.regeneration.stepping_quality import stepping_quality
from capar.regeneration.styles import Style
from capar_rules.engine.solver import Answer, best, rule_file

PROGRAM = "planning/stepping.lp"

GRID_M = 0.1
AHEAD, ASIDE = range(-3, 11), range(-5, 6)
"""The places that are considered, from the given one ahead and to the left [grid steps]."""

FARTHEST_M = GRID_M * AHEAD[-1]
"""How far ahead it is stepped at most [m]."""

REACH = 0.62
"""No posture reaches the middle of a thing farther away on the floor [share of stature]
(estimate)."""

HIGHEST = 1.3
"""Nor higher above the floor [share of stature] (estimate)."""

MOST_STEPS, MOST_TRIES = 6, 6
"""So many places are gone to one after the other at most, and so many are tried of those that are
as many steps away [1]."""

MOST_TOLD = 3
"""So many of them are told where none helps [1]."""

Made = TypeVar("Made")
Spot = tuple[int, int]
"""Of the grid: ahead and to the left."""


@dataclass(frozen=True, eq=False)
class Approach:
    """Steps that prepare an action."""

    why: str
    """Why they are needed."""

    steps: Stepping
    quality: Quality
    ahead_m: float
    aside_m: float
    """How far ahead and to the left they lead."""

    tried: tuple[str, ...]
    """Other places, and why the action is not possible there."""


def approached(
    source: Source,
    human: Human,
    scene: Scene,
    style: Style,
    act: Callable[[Scene], tuple[Made, Quality]],
) -> tuple[Approach | None, Made, Quality]:
    """Perform an action where it can be done, after as few steps there as the solver finds.

    Args:
        source: The recorded performance.
        human: Who performs.
        scene: Where, and where the performer stands at first.
        style: How it is done.
        act: Performs it in a scene; raises PlanError where that is not possible.

    Returns:
        The steps, None where none is needed; what was performed, and how good it is.

    Raises:
        PlanError: The performer stands in something, or it is out of reach and no step helps.
    """
    check_stance(scene, human)
    why = _beyond(source, human, scene) or why_unreachable(source, scene, human, style)
    if why is None:
        return None, *act(replace(scene, stays=True))
    spots = {spot: beside(scene, *_metres(spot)) for spot in _free_spots(scene, human)}
    facts, failed = list(_facts(source, human, scene, spots)), dict[Spot, str]()
    for steps in range(1, MOST_STEPS + 1):
        for _ in range(MOST_TRIES):
            way = _way(facts, failed, steps)
            if not way:
                break
            found = _tried(source, human, scene, [spots[spot] for spot in way], act)
            if isinstance(found, str):
                failed[way[-1]] = found
                continue
            made, quality, walked, walked_quality = found
            tried = tuple(_told(spot, said) for spot, said in failed.items())
            approach = Approach(why, walked, walked_quality, *_metres(way[-1]), tried)
            return approach, made, quality
    said = [_told(spot, reason) for spot, reason in failed.items()]
    raise PlanError(
        f"{why}; no step helps of {len(failed)} places that were tried "
        f"({'; '.join(said[:MOST_TOLD])}{'; and so on' if len(said) > MOST_TOLD else ''})"
        if failed
        else f"{why}; no step helps, since nothing nearer is free or it is too high"
    )


def _tried(
    source: Source,
    human: Human,
    scene: Scene,
    way: Sequence[Scene],
    act: Callable[[Scene], tuple[Made, Quality]],
) -> tuple[Made, Quality, Stepping, Quality] | str:
    """Steps by some places and the action at the last, or why that is not possible."""
    if not is_possible(source, replace(way[-1], stays=True), human):
        return "out of reach"
    walked = step_to(human, scene, *(there.place for there in way), rate_hz=source.rate_hz)
    walked_quality = stepping_quality(walked)
    if not walked_quality.passed:
        return f"the steps there fail {_failed(walked_quality)}"
    try:
        made, quality = act(walked.after)
    except PlanError as error:
        return str(error)
    if not quality.passed:
        return f"it fails {_failed(quality)}"
    return made, quality, walked, walked_quality


def _failed(quality: Quality) -> str:
    rows = (gate for gate in quality.gates if not gate.passed)
    return ", ".join(f"{gate.name} {gate.value:.1f} {gate.unit} ({gate.bodies})" for gate in rows)


def _told(spot: Spot, why: str) -> str:
    ahead_m, aside_m = _metres(spot)
    return f"{ahead_m:+.1f} m ahead and {aside_m:+.1f} m to the left: {why}"


def _metres(spot: Spot) -> tuple[float, float]:
    return GRID_M * spot[0], GRID_M * spot[1]


def _free_spots(scene: Scene, human: Human) -> Iterator[Spot]:
    """Where somebody at ease stands in nothing; the first place is always one."""
    around = Surroundings(human, scene)
    posture = Solver(human, (*scene.place, scene.floor_m), scene.heading).rest
    things = {name: thing.pose for name, thing in scene.things.items()}
    for spot in ((ahead, aside) for ahead in AHEAD for aside in ASIDE):
        there = posture.copy()
        there[:2] += np.subtract(beside(scene, *_metres(spot)).place, scene.place)
        around.pose(there, things)
        if spot == (0, 0) or all(pair.distance_m >= 0.0 for pair in around.near()):
            yield spot


def _facts(source: Source, human: Human, scene: Scene, spots: dict[Spot, Scene]) -> Iterator[str]:
    names = {_name(spot): spot for spot in spots}
    wish = _wish(source, human, scene)
    yield f"at_first({_name((0, 0))})."
    for name, spot in names.items():
        place = np.asarray(spots[spot].place)
        yield f"stance({name})."
        yield f"amiss({name},{round(1e3 * float(np.linalg.norm(place - wish)))})."
        if not _beyond(source, human, spots[spot]):
            yield f"useful({name})."
        for other, there in names.items():
            apart = GRID_M * float(np.hypot(there[0] - spot[0], there[1] - spot[1]))
            if other != name and apart <= STRIDE * human.measures["stature"]:
                yield f"within_step({name},{other})."


def _beyond(source: Source, human: Human, scene: Scene) -> str:
    """What is handled farther away or higher than any posture reaches, in words; empty if none."""
    tall = human.measures["stature"]
    for name in dict.fromkeys(hold.thing for hold in source.holds):
        place = np.asarray(scene.thing(name).place)
        far_m = float(np.linalg.norm(place[:2] - scene.place))
        high_m = float(place[2]) - scene.floor_m
        if far_m > REACH * tall:
            more_m = far_m - REACH * tall
            return (
                f"{name!r} is {far_m:.1f} m away, {more_m:.1f} m farther than any posture reaches"
            )
        if high_m > HIGHEST * tall:
            return f"{name!r} is {high_m:.1f} m above the floor, higher than any posture reaches"
    return ""


def _wish(source: Source, human: Human, scene: Scene) -> Float[np.ndarray, "2"]:
    """Where the performer would stand by the things as the recorded one did, by stature [m]."""
    names = [hold.thing for hold in source.holds]
    old, new = (
        np.mean([one.thing(name).place for name in names], axis=0)[:2]
        for one in (source.scene, scene)
    )
    turn = scene.heading - source.scene.heading
    away = (old - source.scene.place) * human.measures["stature"] / source.human.measures["stature"]
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    return np.asarray(new - rotation @ away)


def _way(facts: list[str], failed: dict[Spot, str], steps: int) -> list[Spot]:
    """The best places one after the other; none where so many steps lead to no useful one."""
    known = [f"failed({_name(spot)})." for spot in failed]
    try:
        answer: Answer = best(
            [rule_file(PROGRAM)], "\n".join([*facts, *known, f"horizon({steps})."])
        )
    except RuleError:
        return []
    rows = sorted(answer.of("stands"), key=lambda row: int(str(row[0])))
    return [_spot(row[1]) for row in rows[1:]]


def _name(spot: Spot) -> str:
    return f"spot({spot[0]},{spot[1]})"


def _spot(term: object) -> Spot:
    assert isinstance(term, tuple)
    return int(term[1]), int(term[2])
