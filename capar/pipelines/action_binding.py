"""A recorded action bound to the objects of a scene and a body: UPAR to IPAR (thesis 4.1.2)."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from capar.body.human import Human
from capar.body.virtual_scenes import Thing
from capar.model.errors import UnknownNameError
from capar.pipelines.recordings import Recording, observed_actions
from capar.regeneration.roles import (
    Ask,
    Binding,
    Kinds,
    Role,
    bind,
    cast,
    check_movable,
    ends_on,
    kind_of,
    own_names,
    roles_of,
    with_only,
)
from capar.regeneration.scenes import PlanError, Scene
from capar.regeneration.sources import Source
from kb.lookup.agents import Ability

Abilities = Callable[[str], tuple[Ability, ...]]
"""What is declared or observed of an agent or a kind, those of more general kinds included."""

BEYOND = 0.9
"""No palm is further from where a body stands, as a share of its stature: arm and trunk [1]."""

BESIDE_M = 0.2
"""So far from where it stands another place is tried [m]."""


def check_applicable(
    action: str,
    recording: Recording,
    agent: Sequence[str],
    kinds: Mapping[str, str],
    abilities: Abilities,
) -> tuple[str, ...]:
    """Check that what is declared does not rule an action out (thesis 4.6.1.4).

    What an agent or a kind was declared able to do is all that it is able to do, beside what it
    was observed to do. Of whom nothing is declared, nothing is ruled out, which is returned as a
    note. An ability to do a more general action, or the whole one, holds for its steps.

    Raises:
        PlanError: Somebody or something is not able to; the message says what would declare it.
    """
    notes = []
    for part, whose in (("", agent), *((part, (kind,)) for part, kind in kinds.items())):
        steps = [s.action for s in recording.steps if not part or part in s.objects]
        known = [one for name in whose for one in abilities(name)]
        able = {one.action for one in known}
        if not any(one.evidence == "declared" for one in known):
            if not part:
                notes.append(f"of {whose[0]!r} no ability is declared, so none is ruled out")
            continue
        general = recording.general
        lacking = [
            step
            for step in dict.fromkeys(steps)
            if not able.intersection({step, action, recording.par.name, *general.get(step, ())})
        ]
        if lacking:
            who = whose[0]
            raise PlanError(
                f"capable({who}, {lacking[0]}) does not hold: {who!r} is declared able to do "
                f"{', '.join(sorted(able))}, and {action!r} takes {', '.join(lacking)}; "
                f"`capar {'object' if part else 'agent'} can {who} {' '.join(lacking)}` would "
                "declare it"
            )
    return tuple(notes)


@dataclass(frozen=True, eq=False)
class Asked:
    """What a user asks for: an action, who does it, where, and with which objects."""

    action: str
    agent: tuple[str, ...]
    """Who performs: the name, and the kind if that is another."""

    human: Human
    stated: Mapping[str, str]
    """The scene's object for recorded ones."""

    scene: Scene
    own: bool
    """Whether it is the recorded scene, with other places and sizes at most."""

    steps_m: float = 0.0
    """How far the performer may step before it [m]."""


@dataclass(frozen=True, eq=False)
class Instance:
    """An action whose objects are all bound, before anything moves."""

    asked: Asked
    source: Source
    """What was recorded, of what takes part in it."""

    roles: tuple[Role, ...]
    bindings: tuple[Binding, ...]
    notes: tuple[str, ...]

    @property
    def parts(self) -> dict[str, str]:
        """The scene's object for each recorded one."""
        return {binding.role: binding.thing for binding in self.bindings}

    def placed(self, scene: Scene) -> tuple[Source, Scene, dict[str, str]]:
        """The recorded performance and a scene, in which its objects have their recorded names.

        What does not stand where it is put in the end is put there in that object's measures.

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


def instantiate(
    asked: Asked,
    recording: Recording,
    source: Source,
    kinds: Kinds,
    abilities: Abilities,
    ask: Ask | None = None,
) -> Instance:
    """Bind the objects of a recorded action to those of a scene, and check that it is applicable.

    Raises:
        UnknownNameError: A stated part or object does not exist.
        AmbiguousError: Several objects fit a part, and there is nobody to ask.
        PlanError: Nothing fits, or a condition does not hold; the message says what would make it
            possible.
    """
    scene = asked.scene
    roles = roles_of(source)
    bindings = bind(roles, scene, asked.stated, kinds, ask, own=asked.own)
    parts = {binding.role: binding.thing for binding in bindings}
    own = {role: kind_of(scene.thing(name)) for role, name in parts.items()}
    notes = check_applicable(asked.action, recording, asked.agent, own, abilities)
    check_movable(source, scene, parts)
    for name in {hold.thing for hold in source.holds if hold.thing in parts}:
        _check_near(scene.thing(parts[name]), scene, asked)
    told = [
        f"{binding.thing!r} has the part of {binding.role!r}, {binding.reason}"
        for binding in bindings
        if binding.role != binding.thing
    ]
    return Instance(asked, with_only(source, parts), roles, bindings, (*told, *notes))


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


def find_action(
    name: str, recordings: Sequence[Recording], roles: Collection[str] = ()
) -> tuple[Recording, tuple[str, ...]]:
    """The recording that holds an action, as a whole or else as a step or a more special one.

    Of several, those with objects of the stated names count first, then the one with the fewest
    steps of all hands, then the first by name.

    Returns:
        It, and the names of the others that hold the action.

    Raises:
        UnknownNameError: No recording holds it.
    """
    whole = [one for one in recordings if name.lower() in {one.name.lower(), one.par.name.lower()}]
    found = whole or [one for one in recordings if any(one.fits(s, name) for s in one.steps)]
    if not found:
        raise UnknownNameError("recorded action", name, observed_actions(recordings))
    found.sort(key=lambda one: (len({*roles} - {*one.par.objects}), len(one.steps), one.name))
    return found[0], tuple(one.name for one in found[1:])
