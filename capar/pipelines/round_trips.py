"""Round trips: observe, perform on other bodies, observe again, and compare."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.sensors import CUTOFF_HZ
from capar.model.capture import Capture
from capar.model.errors import CaparError, UnknownNameError
from capar.model.facts import Touching
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from capar.pipelines.trials import trial_of
from capar.regeneration.captures import (
    OTHER,
    Completion,
    capture_of,
    completed,
    joint_capture_of,
    mirrored,
    read_completion,
)
from capar.regeneration.hand_overs import JointSource, joint_source, regenerate_together
from capar.regeneration.motion import Motion
from capar.regeneration.quality import Quality
from capar.regeneration.scenes import PlanError, Scene, drawn_scene
from capar.regeneration.search import regenerate
from capar.regeneration.sources import Source, source_of

SAME = "same"
"""Names the body that was recorded."""


@dataclass(frozen=True)
class Trip:
    """One performance on another body, or on others together, observed again."""

    agent: str
    """Whose body; of several performers joined by a plus sign, in the order of the recorded."""

    scene: int
    """Number of the drawn scene; 0 for the recorded one."""

    refused: str = ""
    """Why it was not performed; empty where it was."""

    same_par: bool = False
    same_contacts: bool = False
    same_relations: bool = False
    names: str = ""
    """What was done according to the second observation, where that differs."""

    failed: tuple[str, ...] = ()
    """Gates that do not hold, and of what or whom."""

    quality: Quality | None = None
    motion: Motion | None = None
    """What was performed; None where it was refused, or by several."""

    @property
    def passed(self) -> bool:
        """Whether the same action came out of a good motion."""
        same = self.same_par and self.same_contacts and self.same_relations
        return not self.refused and not self.failed and same

    def row(self) -> dict[str, Any]:
        """What came of it, for machines."""
        names = (each.name for each in fields(self) if each.name not in {"motion", "quality"})
        gates = self.quality and self.quality.gates
        return {name: getattr(self, name) for name in names} | {"gates": gates}


def observed_source(
    capture: Capture | Path | str,
    completion: Completion | Path | None = None,
    *,
    cutoff_hz: float | None = CUTOFF_HZ,
) -> Source:
    """A capture, observed and ready to be performed.

    Args:
        capture: What was recorded, or where it is described.
        completion: What is assumed where the recording does not say it, or the file of it.
        cutoff_hz: Of the filter that takes noise from paths [Hz]; None leaves them as recorded.

    Raises:
        PlanError: The capture does not determine a performance.
        CaparError: What is assumed contradicts it.
    """
    trial = trial_of(capture)
    if completion is None:
        return source_of(trial, observe(trial), cutoff_hz=cutoff_hz)
    known = read_completion(completion) if isinstance(completion, Path) else completion
    trial = completed(trial, known)
    return source_of(
        trial, observe(trial), stance=known.stance, floor_m=known.floor_m, axes=known.axes,
        notes=known.notes, cutoff_hz=cutoff_hz,
    )  # fmt: skip


def by_hand(source: Source, side: str) -> Source:
    """The same done by a hand: mirrored, where it was the other one that took something.

    Raises:
        UnknownNameError: There is no such side.
        PlanError: Both hands take something.
    """
    if side not in OTHER:
        raise UnknownNameError("hand", side, sorted(OTHER))
    acting = {hold.side for hold in source.holds}
    if len(acting) > 1:
        raise PlanError("both hands take something; leave out which hand does it")
    if side in acting:
        return source
    scene = source.scene
    return observed_source(mirrored(source.capture, scene.place, scene.heading))


def body(agent: str, source: Source) -> Human:
    """The body of an agent: ``man``, ``woman``, ``child``, or ``same`` for the recorded one.

    Raises:
        UnknownNameError: There is no such agent.
    """
    return source.human if agent == SAME else Human.of(ready_made(agent))


def round_trips(
    source: Source, agents: tuple[str, ...], *, scenes: int = 0, seed: int = 0
) -> Iterator[Trip]:
    """Perform on every agent in every scene, and observe again."""
    bodies = {agent: body(agent, source) for agent in agents}
    for number in range(1, scenes + 1) if scenes else (0,):
        scene = numbered_scene(source, number, seed)
        for agent, human in bodies.items():
            yield round_trip(source, agent, human, number, scene)


def numbered_scene(source: Source, number: int, seed: int) -> Scene:
    """The drawn scene of that number; 0 is the recorded one."""
    if not number:
        return source.scene
    return drawn_scene(source.scene, np.random.default_rng([seed, number]))


def round_trip(source: Source, agent: str, human: Human, number: int, scene: Scene) -> Trip:
    """Perform on one body in one scene, and observe again."""
    try:
        motion, quality = regenerate(source, human, scene)
    except PlanError as error:
        return Trip(agent, number, str(error))
    made = capture_of(motion, name=source.capture.name, agent=agent)
    failed = tuple(
        f"{gate.name} {gate.value:.2f} {gate.unit} {gate.bodies}".strip()
        for gate in quality.gates
        if not gate.passed
    )
    same = _again(source.observation, made)
    return Trip(agent, number, "", *same, failed, quality, motion)


def _again(first: Observation, made: Capture) -> tuple[bool, bool, bool, str]:
    """Whether PAR, contacts and relations come out again, and what came instead of the PAR."""
    again = observe(made, rules=first.profile)
    one, two = first.complex_par, again.complex_par
    pairs = [
        sorted((each.body, each.other) for each in seen.facts if isinstance(each, Touching))
        for seen in (first, again)
    ]
    same = one.signature == two.signature
    names = "; ".join(
        f"{link.ee}: {' '.join(each.name for each in link.segments)}" for link in again.links
    )
    return same, pairs[0] == pairs[1], one.relations == two.relations, "" if same else names


def observed_joint_source(capture: Capture) -> JointSource:
    """A capture of several performers, observed and ready to be performed.

    Raises:
        PlanError: The capture does not determine a performance.
    """
    return joint_source(capture, observe(capture))


def bodies(agents: Sequence[str], source: JointSource) -> dict[str, Human]:
    """The bodies that perform, by the name of the recorded agent.

    Raises:
        UnknownNameError: There is no such agent or body.
        CaparError: There are more or fewer bodies than agents.
    """
    names = list(source.sources)
    if any("=" in agent for agent in agents):
        pairs = dict(agent.partition("=")[::2] for agent in agents)
        unknown = [name for name in pairs if name not in names]
        if unknown:
            raise UnknownNameError("agent", unknown[0], names)
    elif len(agents) in {1, len(names)}:
        pairs = dict(zip(names, [*agents] * len(names), strict=False))
    else:
        raise CaparError(
            f"{len(agents)} bodies for {len(names)} performers: name one for all, one for each of "
            f"{', '.join(names)} in this order, or {names[-1]}=child"
        )
    return {name: body(pairs.get(name, "same"), one) for name, one in source.sources.items()}


def joint_round_trips(
    source: JointSource, casts: Sequence[str], *, scenes: int = 0, seed: int = 0
) -> Iterator[Trip]:
    """Perform with every cast in every scene, and observe again.

    Of a drawn scene the objects are drawn, and everybody is where that one stood.
    """
    people = {cast: bodies(cast.split("+"), source) for cast in casts}
    recorded = {name: one.scene for name, one in source.sources.items()}
    for number in range(1, scenes + 1) if scenes else (0,):
        where = recorded
        if number:
            first = next(iter(recorded.values()))
            things = drawn_scene(first, np.random.default_rng([seed, number])).things
            where = {name: replace(scene, things=things) for name, scene in recorded.items()}
        for cast, humans in people.items():
            try:
                made = regenerate_together(source, humans, where)
            except PlanError as error:
                yield Trip(cast, number, str(error))
                continue
            again = joint_capture_of(made, name=source.capture.name)
            yield Trip(cast, number, "", *_again(source.observation, again), made.failed)
