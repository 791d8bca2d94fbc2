"""From a recorded action to one on the things of a scene by a body: UPAR to IPAR (thesis 4.1.2)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from capar.body.human import Human
from capar.body.scenes import Thing
from capar.pipelines.applicability import Abilities, Applied, check_applicable
from capar.pipelines.recordings import Recording
from capar.regeneration.bindings import (
    Ask,
    Binding,
    Kinds,
    Role,
    bind,
    ends_on,
    kind_of,
    roles_of,
)
from capar.regeneration.casting import cast, check_movable, own_names, with_only
from capar.regeneration.errors import PlanError
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source

BEYOND = 0.9
"""No palm is further from where a body stands, as a share of its stature: arm and trunk [1]."""

BESIDE_M = 0.2
"""So far from where it stands another place is tried [m]."""


@dataclass(frozen=True, eq=False)
class Asked:
    """What a user asks for: an action, who does it, where, and with which things."""

    action: str
    agent: tuple[str, ...]
    """Who performs: the name, and the kind if that is another."""

    human: Human
    stated: Mapping[str, str]
    """The scene's thing for recorded ones."""

    scene: Scene
    own: bool
    """Whether it is the recorded scene, with other places and sizes at most."""

    steps_m: float = 0.0
    """How far the performer may step before it [m]."""


@dataclass(frozen=True, eq=False)
class Instance:
    """An action whose things are all bound, before anything moves."""

    asked: Asked
    recording: Recording
    source: Source
    """What was recorded, of what takes part in it."""

    roles: tuple[Role, ...]
    bindings: tuple[Binding, ...]
    notes: tuple[str, ...]

    @property
    def parts(self) -> dict[str, str]:
        """The scene's thing for each recorded one."""
        return {binding.role: binding.thing for binding in self.bindings}

    def placed(self, scene: Scene) -> tuple[Source, Scene, dict[str, str]]:
        """The recorded performance and a scene, in which its things have their recorded names.

        What does not stand where it is put in the end is put there in that thing's measures.

        Args:
            scene: Where it is performed.

        Returns:
            Both, and the scene's names by the recorded ones.
        """
        parts, goals = self.parts, {}
        for role in self.roles:
            first, last = ends_on(self.source, role.name)
            stays = role.moved and first == last and last in parts
            if stays and scene.support(parts[role.name]) != parts[last]:
                goals[role.name] = parts[last]
        made, where = cast(self.source, scene, parts, goals)
        return made, where, own_names(self.source, scene, parts)


@dataclass(frozen=True)
class Knowledge:
    """What is known of kinds and abilities."""

    kinds: Kinds
    abilities: Abilities


def instantiate(
    asked: Asked,
    recording: Recording,
    source: Source,
    known: Knowledge,
    ask: Ask | None = None,
) -> Instance:
    """Bind every part of a recorded action, and check that it is applicable.

    Args:
        asked: What is to be done.
        recording: The recording that holds it.
        source: That recording, ready to be performed.
        known: What is known of kinds and abilities.
        ask: Asks a user where several things fit a part; None where there is nobody to ask.

    Raises:
        UnknownNameError: A part or a thing that was stated does not exist.
        PlanError: A part is open, or the action is not applicable; the message says what would
            make it possible.
    """
    scene = asked.scene
    roles = roles_of(source)
    bindings = bind(roles, scene, asked.stated, known.kinds, ask, own=asked.own)
    parts = {binding.role: binding.thing for binding in bindings}
    kinds = {role: kind_of(scene.thing(name)) for role, name in parts.items()}
    applied = Applied(
        asked.action, recording.par, recording.steps, recording.general, asked.agent, kinds
    )
    notes = check_applicable(applied, known.abilities)
    check_movable(source, scene, parts)
    for name in {hold.thing for hold in source.holds if hold.thing in parts}:
        _check_near(scene.thing(parts[name]), scene, asked)
    told = tuple(_told(binding) for binding in bindings if binding.role != binding.thing)
    source = with_only(source, parts)
    return Instance(asked, recording, source, roles, bindings, (*told, *notes))


def _check_near(thing: Thing, scene: Scene, asked: Asked) -> None:
    """Nothing that is taken is further than any posture reaches, after steps if these may be."""
    human = asked.human
    far_m = float(np.hypot(*(np.asarray(thing.place)[:2] - scene.place)))
    far_m -= 0.5 * float(np.linalg.norm(thing.size[:2]))
    beside_m = 0.0 if scene.stays else BESIDE_M
    most_m = BEYOND * human.measures["stature"] + max(beside_m, asked.steps_m)
    after = " after steps" if asked.steps_m > beside_m else ""
    if far_m > most_m:
        raise PlanError(
            f"reach does not hold: {thing.name!r} is {far_m:.1f} m from where the performer "
            f"stands, and no posture of a body {human.measures['stature']:.2f} m tall reaches "
            f"{most_m:.1f} m{after}; standing {far_m - most_m:.1f} m nearer to it at least, or the "
            "thing so much nearer, is needed"
        )


def _told(binding: Binding) -> str:
    return f"{binding.thing!r} has the part of {binding.role!r}, {binding.reason}"
