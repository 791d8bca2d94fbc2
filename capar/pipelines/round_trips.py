"""Observe, perform on another body, and observe again: does the same action come out?"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.sensors import CUTOFF_HZ
from capar.model.capture import Capture
from capar.model.errors import UnknownNameError
from capar.model.facts import Touching
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from capar.pipelines.trials import trial_of
from capar.regeneration.captures import capture_of
from capar.regeneration.completing import Completion, completed
from capar.regeneration.errors import PlanError
from capar.regeneration.mirroring import OTHER, mirrored
from capar.regeneration.motions import Motion
from capar.regeneration.quality import Quality
from capar.regeneration.regenerating import regenerate
from capar.regeneration.scene_files import USUAL, Draw, drawn_scene
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source, source_of

SAME = "same"
"""Names the body that was recorded."""


@dataclass(frozen=True)
class Trip:
    """One performance on another body, observed again."""

    agent: str
    scene: int
    """Number of the drawn scene; 0 for the recorded one."""

    refused: str
    """Why it was not performed; empty where it was."""

    quality: Quality | None
    same_par: bool
    same_contacts: bool
    same_relations: bool
    names: str
    """What was done according to the second observation, where that differs."""

    motion: Motion | None
    """What was performed; None where it was refused."""

    @property
    def passed(self) -> bool:
        """Whether the same action came out of a good motion."""
        good = self.quality is not None and self.quality.passed
        return good and self.same_par and self.same_contacts and self.same_relations


def observed_source(
    capture: Capture | Path | str,
    completion: Completion | None = None,
    *,
    rules: str = "extended",
    cutoff_hz: float | None = CUTOFF_HZ,
) -> Source:
    """A capture, observed and ready to be performed.

    Args:
        capture: What was recorded, or where it is described.
        completion: What is assumed where the recording does not say it.
        rules: Profile by which it is observed.
        cutoff_hz: Of the filter that takes noise from paths [Hz]; None leaves them as recorded.

    Raises:
        PlanError: The capture does not determine a performance.
        CaparError: What is assumed contradicts it.
    """
    trial = trial_of(capture)
    if completion is None:
        return source_of(trial, observe(trial, rules=rules), cutoff_hz=cutoff_hz)
    trial = completed(trial, completion)
    return source_of(
        trial,
        observe(trial, rules=rules),
        stance=completion.stance,
        floor_m=completion.floor_m,
        axes=completion.axes,
        notes=completion.notes,
        cutoff_hz=cutoff_hz,
    )


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
    """Perform on every agent in every scene, and observe again.

    Args:
        source: What was recorded.
        agents: Who performs.
        scenes: How many scenes are drawn; 0 performs in the recorded one.
        seed: Of the scenes.
    """
    bodies = {agent: body(agent, source) for agent in agents}
    for number in range(1, scenes + 1) if scenes else (0,):
        scene = numbered_scene(source, number, seed)
        for agent, human in bodies.items():
            yield round_trip(source, agent, human, number, scene)


def numbered_scene(source: Source, number: int, seed: int, draw: Draw = USUAL) -> Scene:
    """The drawn scene of that number; 0 is the recorded one.

    Args:
        source: What was recorded.
        number: Of the scene.
        seed: Of all scenes.
        draw: The ranges from which it is drawn.
    """
    if not number:
        return source.scene
    return drawn_scene(source.scene, np.random.default_rng([seed, number]), draw)


def round_trip(source: Source, agent: str, human: Human, number: int, scene: Scene) -> Trip:
    """Perform on one body in one scene, and observe again.

    Args:
        source: What was recorded.
        agent: Name of who performs.
        human: Likewise, the body.
        number: Of the scene.
        scene: Where it is performed.
    """
    try:
        motion, quality = regenerate(source, human, scene)
    except PlanError as error:
        return Trip(agent, number, str(error), None, False, False, False, "", None)
    made = capture_of(motion, name=source.capture.name, agent=agent)
    first, again = source.observation, observe(made, rules=source.observation.profile)
    one, two = first.complex_par, again.complex_par
    differ = one.signature != two.signature
    return Trip(
        agent, number, "", quality,
        not differ,
        contact_pairs(first) == contact_pairs(again),
        one.relations == two.relations,
        step_names(again) if differ else "",
        motion,
    )  # fmt: skip


def contact_pairs(observation: Observation) -> list[tuple[str, str]]:
    """Who touched what, in order of time for each pair of bodies."""
    facts = (each for each in observation.facts if isinstance(each, Touching))
    return sorted((each.body, each.other) for each in facts)


def step_names(observation: Observation) -> str:
    """The names of all segments, link by link."""
    return "; ".join(
        f"{link.ee}: {' '.join(each.name for each in link.segments)}" for link in observation.links
    )
