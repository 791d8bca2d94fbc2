"""What several performers did together, performed by other bodies and verified."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from capar.body.human import Human
from capar.regeneration.drafts import MOST_TURNS, Draft, check_stance
from capar.regeneration.errors import PlanError
from capar.regeneration.hand_overs import Cast, Place, joint_ways, places
from capar.regeneration.joint_quality import joint_gates
from capar.regeneration.joint_sources import JointSource
from capar.regeneration.motions import Motion
from capar.regeneration.planning import FEW_TURNS, TALLER_M, beside
from capar.regeneration.quality import Gate, Quality
from capar.regeneration.regenerating import best_motion
from capar.regeneration.scenes import Scene
from capar.regeneration.style_kinds import Kind
from capar.regeneration.styles import own_style

NEARER_M = (0.1, 0.2, 0.3, 0.5, 0.8, 1.2)
"""How much nearer somebody is placed where something is out of reach [m]."""

FAR_RATIO = 50.0
"""What is missed by more with the recorded grip is not reached with a turned one, in units of what
is allowed [1]."""

MANY_TURNS = 24
"""Turns of a grip that are tried at the usual place [1]."""

MOST_PLACES = 3
"""At so many places turned grips are tried [1]."""


class OutOfReachError(PlanError):
    """No grip of somebody reaches."""

    def __init__(self, message: str, ratio: float) -> None:
        super().__init__(message)
        self.ratio = ratio


@dataclass(frozen=True, eq=False)
class JointMotion:
    """The motions of several bodies that handle the same things."""

    source: JointSource
    motions: Mapping[str, Motion]
    """By the agent's name."""

    qualities: Mapping[str, Quality]
    """Likewise."""

    gates: tuple[Gate, ...]
    """Between the bodies."""

    @property
    def passed(self) -> bool:
        """Whether every gate of every body is, and those between them."""
        alone = all(quality.passed for quality in self.qualities.values())
        return alone and all(gate.passed for gate in self.gates)

    @property
    def failed(self) -> tuple[str, ...]:
        """Gates that are not, with whose they are."""
        own = [f"{who}: {name}" for who, one in self.qualities.items() for name in one.failed]
        return (*own, *(gate.name for gate in self.gates if not gate.passed))


def regenerate_together(
    source: JointSource,
    humans: Mapping[str, Human],
    scenes: Mapping[str, Scene] | None = None,
    kind: Kind = Kind.PATH,
) -> JointMotion:
    """Let bodies do together in a scene what was recorded of others; verified at every frame.

    The things' ways are decided first and are the same for all; then every body is led along its
    own hands' ways.

    Args:
        source: The recorded performance.
        humans: Who performs, by the name of the recorded agent.
        scenes: The same things for all, and where each one stands; as recorded, unless stated.
        kind: What of the recorded ways is kept.

    Raises:
        PlanError: It is out of reach or impossible; the message says what would help.
    """
    cast = Cast(humans, scenes or {name: one.scene for name, one in source.sources.items()})
    place, drafts = _reachable(source, cast, kind)
    motions, qualities = {}, {}
    for name, draft in drafts.items():

        def again(watched: frozenset[int], name: str = name) -> Draft:
            return _drafts(source, cast, kind, place, MOST_TURNS, [name], watched)[name]

        motions[name], qualities[name] = best_motion(draft, again)
    return JointMotion(source, motions, qualities, joint_gates(source, motions))


def _reachable(source: JointSource, cast: Cast, kind: Kind) -> tuple[Place, dict[str, Draft]]:
    """Where things are handed over, and everybody's grips; the first place that all reach.

    Raises:
        PlanError: There is none.
    """
    for name, human in cast.humans.items():
        check_stance(cast.scenes[name], human)
    tried = list(places()) if source.hand_overs else [Place()]
    passing = frozenset(passed.first for passed in source.hand_overs)
    near, why = [], ""
    for place in tried:
        try:
            if passing:
                _drafts(source, cast, kind, place, 1, only=passing)
            return place, _drafts(source, cast, kind, place, 1)
        except OutOfReachError as error:
            near += [place] * (error.ratio < FAR_RATIO)
            why = why or str(error)
        except PlanError as error:
            why = why or str(error)
    for place, most in [(p, FEW_TURNS) for p in near[:MOST_PLACES]] + [
        (p, MANY_TURNS) for p in near[:1]
    ]:
        try:
            return place, _drafts(source, cast, kind, place, most)
        except PlanError as error:
            why = str(error)
    raise PlanError(f"{why}; {_remedy(source, cast, kind, passing)}")


def _drafts(
    source: JointSource,
    cast: Cast,
    kind: Kind,
    place: Place,
    most: int,
    names: list[str] | None = None,
    watched: frozenset[int] = frozenset(),
    only: frozenset[int] = frozenset(),
) -> dict[str, Draft]:
    """Everybody's grips; tried at some frames only, if these are stated.

    Raises:
        PlanError: Somebody has none that reaches.
    """
    first = next(iter(source.sources))
    ways = joint_ways(source, cast, own_style(source.sources[first], kind), place)
    out = {}
    for name in names or list(source.sources):
        one, scene = source.sources[name], cast.scenes[name]
        style = own_style(one, kind)
        draft = Draft(one, scene, cast.humans[name], style, watched, ways)
        draft.only = only
        grips, missed = draft.reachable_grips(most)
        if missed is not None:
            raise OutOfReachError(f"{name}: {missed}", draft.worst.ratio)
        draft.grips = tuple(grips)
        draft.told += [f"whatever the grip, {told}" for told in draft.pressed]
        out[name] = draft
    return out


def _remedy(source: JointSource, cast: Cast, kind: Kind, passing: frozenset[int]) -> str:
    """What would make it possible."""
    for words, changed in _remedies(source, cast):
        try:
            for name, human in changed.humans.items():
                check_stance(changed.scenes[name], human)
            if passing:
                _drafts(source, changed, kind, Place(), 1, only=passing)
            _drafts(source, changed, kind, Place(), 1)
        except PlanError:
            continue
        return f"{words} would do"
    return "no nearer place or recorded body that was tried would do"


def _remedies(source: JointSource, cast: Cast) -> Iterator[tuple[str, Cast]]:
    """What may help, in words, and the cast with it."""
    middle = np.mean([scene.place for scene in cast.scenes.values()], axis=0)
    for by_m in NEARER_M:
        for name in cast.scenes:
            scenes = {**cast.scenes, name: beside(cast.scenes[name], by_m, 0.0)}
            yield f"{name} standing {by_m:.2f} m further ahead", Cast(cast.humans, scenes)
        scenes = {name: _towards(scene, middle, by_m) for name, scene in cast.scenes.items()}
        yield f"everybody standing {by_m:.2f} m nearer", Cast(cast.humans, scenes)
    for name, human in cast.humans.items():
        recorded = source.sources[name].human
        recorded_m, own_m = recorded.measures["stature"], human.measures["stature"]
        if recorded_m > own_m + TALLER_M:
            words = f"{name} being as tall as recorded, {recorded_m:.2f} m,"
            yield words, Cast({**cast.humans, name: recorded}, cast.scenes)


def _towards(scene: Scene, middle: np.ndarray, by_m: float) -> Scene:
    way = middle - np.asarray(scene.place)
    x, y = np.asarray(scene.place) + by_m * way / max(float(np.linalg.norm(way)), 1e-9)
    return replace(scene, place=(float(x), float(y)))
