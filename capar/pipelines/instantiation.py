"""From a recorded action to one on the things of a scene by a body: UPAR to IPAR (thesis 4.1.2)."""

from collections.abc import Mapping
from dataclasses import dataclass

from capar.body.human import Human
from capar.pipelines.applicability import Abilities, Applied, check_applicable
from capar.pipelines.recordings import Recording
from capar.regeneration.bindings import Ask, Binding, Kinds, bind, kind_of, roles_of
from capar.regeneration.casting import cast, own_names, with_only
from capar.regeneration.errors import PlanError
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source


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


@dataclass(frozen=True, eq=False)
class Instance:
    """An action whose things are all bound, before anything moves."""

    asked: Asked
    recording: Recording
    source: Source
    """What was recorded, in the scene it is performed in."""

    scene: Scene
    """Its things by their recorded names."""

    bindings: tuple[Binding, ...]
    names: Mapping[str, str]
    """The scene's names by those that the source has."""

    notes: tuple[str, ...]


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
    source = with_only(source, parts)
    for role in roles:
        for borne in role.bears:
            if scene.support(parts[borne]) != parts[role.name]:
                raise _unsupported(scene, parts[borne], parts[role.name])
    made, where = cast(source, scene, parts)
    names = own_names(source, scene, parts)
    told = tuple(_told(binding) for binding in bindings if binding.role != binding.thing)
    return Instance(asked, recording, made, where, bindings, names, (*told, *notes))


def _told(binding: Binding) -> str:
    return f"{binding.thing!r} has the part of {binding.role!r}, {binding.reason}"


def _unsupported(scene: Scene, thing: str, support: str) -> PlanError:
    beneath = scene.support(thing)
    where = f"it stands on {beneath!r}" if beneath else "nothing of the scene is beneath it"
    return PlanError(
        f"contact({thing}, {support}) does not hold at the start: {where}; {thing!r} put on "
        f"{support!r} first, or another thing stated with --object, would do"
    )
