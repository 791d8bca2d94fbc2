"""Several bodies perform together what was recorded of several performers, observed again."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from capar.body.human import Human
from capar.model.capture import Capture
from capar.model.errors import CaparError, UnknownNameError
from capar.pipelines.observation import observe
from capar.pipelines.round_trips import body, contact_pairs, step_names
from capar.regeneration.errors import PlanError
from capar.regeneration.joint_captures import joint_capture_of
from capar.regeneration.joint_regenerating import JointMotion, regenerate_together
from capar.regeneration.joint_sources import JointSource, joint_source
from capar.regeneration.scene_files import drawn_scene
from capar.regeneration.scenes import Scene


@dataclass(frozen=True)
class JointTrip:
    """One performance by several other bodies, observed again."""

    agents: str
    """Their bodies, in the order of the recorded agents, joined by a plus sign."""

    scene: int
    """Number of the drawn scene; 0 for the recorded one."""

    refused: str
    """Why it was not performed; empty where it was."""

    failed: tuple[str, ...]
    """Gates that do not hold, and whose."""

    same_par: bool
    same_contacts: bool
    same_relations: bool
    names: str
    """What was done according to the second observation, where that differs."""

    @property
    def passed(self) -> bool:
        """Whether the same action came out of good motions."""
        same = self.same_par and self.same_contacts and self.same_relations
        return not self.refused and not self.failed and same


def observed_joint_source(capture: Capture, *, rules: str = "extended") -> JointSource:
    """A capture of several performers, observed and ready to be performed.

    Args:
        capture: What was recorded.
        rules: Profile by which it is observed.

    Raises:
        PlanError: The capture does not determine a performance.
    """
    return joint_source(capture, observe(capture, rules=rules))


def bodies(agents: Sequence[str], source: JointSource) -> dict[str, Human]:
    """The bodies that perform, by the name of the recorded agent.

    Args:
        agents: Bodies in the order of the recorded agents, one for all, or ``NAME=BODY``; who is
            not named performs with the recorded body.
        source: What was recorded.

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


def drawn_scenes(source: JointSource, number: int, seed: int) -> dict[str, Scene]:
    """The drawn things of a number, and everybody where that one stood; 0 is as recorded."""
    scenes = {name: one.scene for name, one in source.sources.items()}
    if not number:
        return scenes
    first = next(iter(scenes.values()))
    things = drawn_scene(first, np.random.default_rng([seed, number])).things
    return {name: replace(scene, things=things) for name, scene in scenes.items()}


def joint_round_trips(
    source: JointSource, casts: Sequence[str], *, scenes: int = 0, seed: int = 0
) -> Iterator[JointTrip]:
    """Perform with every cast in every scene, and observe again.

    Args:
        source: What was recorded.
        casts: Bodies joined by plus signs.
        scenes: How many scenes are drawn; 0 performs in the recorded one.
        seed: Of the scenes.
    """
    for number in range(1, scenes + 1) if scenes else (0,):
        where = drawn_scenes(source, number, seed)
        for agents in casts:
            humans = bodies(agents.split("+"), source)
            yield joint_round_trip(source, agents, humans, number, where)


def joint_round_trip(
    source: JointSource,
    agents: str,
    humans: Mapping[str, Human],
    number: int,
    scenes: Mapping[str, Scene],
) -> JointTrip:
    """Perform with some bodies in one scene, and observe again.

    Args:
        source: What was recorded.
        agents: How the bodies are called.
        humans: The bodies, by the name of the recorded agent.
        number: Of the scene.
        scenes: Where it is performed, and where each one stands.
    """
    try:
        made = regenerate_together(source, humans, scenes)
    except PlanError as error:
        return JointTrip(agents, number, str(error), (), False, False, False, "")
    return compared(source, agents, number, made)


def compared(source: JointSource, agents: str, number: int, made: JointMotion) -> JointTrip:
    """What comes out when the motions are observed again.

    Args:
        source: What was recorded.
        agents: How the bodies are called.
        number: Of the scene.
        made: What was performed.
    """
    capture = joint_capture_of(made, name=source.capture.name)
    first = source.observation
    again = observe(capture, rules=first.profile)
    one, two = first.complex_par, again.complex_par
    same = one.signature == two.signature
    return JointTrip(
        agents, number, "", made.failed, same, contact_pairs(first) == contact_pairs(again),
        one.relations == two.relations, "" if same else step_names(again),
    )  # fmt: skip
