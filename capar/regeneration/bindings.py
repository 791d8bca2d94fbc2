"""Which thing of a scene takes the part of each recorded one: stated, by support, or by kind."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from capar.body.scenes import Thing
from capar.model.capture import TagType
from capar.model.errors import UnknownNameError
from capar.regeneration.errors import PlanError
from capar.regeneration.scenes import Scene, moved
from capar.regeneration.sources import Source, moves

Kinds = Callable[[str], tuple[str, ...]]
"""A kind and every more general one, nearest first."""

Ask = Callable[["Role", tuple[str, ...]], str]
"""Asks a user which of several things takes a part."""


@dataclass(frozen=True)
class Role:
    """A recorded thing that takes part in an action."""

    name: str
    kind: str
    tag: TagType
    bears: tuple[str, ...]
    """What stands on it when the action begins."""

    moved: bool


@dataclass(frozen=True)
class Binding:
    """The thing of a scene that takes a part, and why that one."""

    role: str
    thing: str
    reason: str


class AmbiguousError(PlanError):
    """Several things of a scene fit a part that nothing was stated for.

    Attributes:
        role: The part.
        fitting: The things, sorted.
    """

    def __init__(self, role: Role, fitting: tuple[str, ...]) -> None:
        self.role, self.fitting = role, fitting
        listed = ", ".join(fitting)
        super().__init__(
            f"the part of {role.name!r} ({role.kind}) may be taken by {listed}; say which: "
            f"--object {role.name}={fitting[0]}"
        )


def kind_of(thing: Thing) -> str:
    """The noun for a thing: its kind, else its own name."""
    return thing.kind or thing.name


def roles_of(source: Source) -> tuple[Role, ...]:
    """What takes part in a recorded action: what is acted on, what that bears, and its supports.

    Other things of the recorded scene have no part.
    """
    acted = list(source.observation.complex_par.objects)
    acted += [hold.thing for hold in source.holds]
    acted += [poise.other for poise in source.poises]
    acted += [ride.thing for ride in source.rides]
    taking = [name for name in dict.fromkeys(acted) if name in source.scene.things]
    for name in tuple(taking):
        taking += [one for one in dict.fromkeys(ends_on(source, name)) if one and one not in taking]
    return tuple(_role(source, name, taking) for name in taking)


def _role(source: Source, name: str, taking: Sequence[str]) -> Role:
    thing = source.scene.thing(name)
    bears = tuple(other for other in taking if source.scene.support(other) == name)
    return Role(name, kind_of(thing), thing.tag, bears, moves(source.paths[name]))


def ends_on(source: Source, name: str) -> tuple[str, str]:
    """What a recorded thing stands on at first and in the end; empty where it is nothing.

    Args:
        source: What was recorded.
        name: Of the thing.
    """
    x, y, z = (float(value) for value in source.paths[name].translation[-1])
    after = moved(source.scene, name, (x, y, z), source.scene.thing(name).heading)
    return source.scene.support(name), after.support(name)


def bind(
    roles: Sequence[Role],
    scene: Scene,
    stated: Mapping[str, str],
    kinds: Kinds,
    ask: Ask | None = None,
    *,
    own: bool = False,
) -> tuple[Binding, ...]:
    """The thing of a scene for every part.

    What is stated counts first; then a part that bears another one is taken by what that one's
    thing stands on; then the only thing that can be moved, or is fixed, as the recorded one and is
    nearest of kind. Where several are equally near, it is asked.

    Args:
        roles: The parts.
        scene: The things that there are.
        stated: The thing's name for some parts.
        kinds: The hierarchy of kinds.
        ask: Asks a user; None where there is nobody to ask.
        own: Whether it is the recorded scene, where a thing has its own part unless stated.

    Raises:
        UnknownNameError: A stated part or thing does not exist.
        AmbiguousError: Several things fit, and there is nobody to ask.
        PlanError: Nothing fits, or one thing has two parts.
    """
    found = _stated(roles, scene, stated)
    while open_roles := [role for role in roles if role.name not in found]:
        role, binding = _next(open_roles, scene, found, kinds, ask, own=own)
        found[role.name] = binding
    return tuple(found[role.name] for role in roles)


def _stated(roles: Sequence[Role], scene: Scene, stated: Mapping[str, str]) -> dict[str, Binding]:
    known = {role.name for role in roles}
    found: dict[str, Binding] = {}
    for role, thing in stated.items():
        if role not in known:
            raise UnknownNameError("part", role, known)
        scene.thing(thing)
        taken = next((one.role for one in found.values() if one.thing == thing), None)
        if taken is not None:
            raise PlanError(f"{thing!r} cannot take the parts of {taken!r} and {role!r} both")
        found[role] = Binding(role, thing, "as stated")
    return found


def _next(
    roles: Sequence[Role],
    scene: Scene,
    found: Mapping[str, Binding],
    kinds: Kinds,
    ask: Ask | None,
    *,
    own: bool,
) -> tuple[Role, Binding]:
    """The part that is decided next, and its thing: supports wait for what they bear."""
    names = {role.name for role in roles}
    ready = [role for role in roles if not names.intersection(role.bears)] or list(roles)
    free = [thing for thing in scene.things.values() if not _taken(thing.name, found)]
    for role in ready:
        beneath = _beneath(role, scene, found)
        if any(thing.name == beneath and thing.tag is role.tag for thing in free):
            borne = next(found[name].thing for name in role.bears if name in found)
            return role, Binding(role.name, beneath, f"what {borne!r} stands on")
        if own and any(thing.name == role.name for thing in free):
            return role, Binding(role.name, role.name, "as recorded")
    options = [(*_fitting(role, free, kinds), role) for role in ready]
    for _, fitting, role in options:
        if not fitting:
            raise _nothing(role, scene)
    sure = [row for row in options if len(row[1]) == 1]
    if sure:
        general, fitting, role = min(sure, key=lambda row: kinds(row[2].kind).index(row[0]))
        return role, Binding(role.name, fitting[0], f"the only {general} that {_free(role)}")
    general, fitting, role = options[0]
    if ask is None:
        raise AmbiguousError(role, fitting)
    return role, Binding(role.name, ask(role, fitting), "as answered")


def _taken(name: str, found: Mapping[str, Binding]) -> bool:
    return any(binding.thing == name for binding in found.values())


def _beneath(role: Role, scene: Scene, found: Mapping[str, Binding]) -> str:
    """What the thing stands on that has a part which this one bears."""
    borne = (found[name].thing for name in role.bears if name in found)
    return next((support for thing in borne if (support := scene.support(thing))), "")


def _fitting(role: Role, free: Sequence[Thing], kinds: Kinds) -> tuple[str, tuple[str, ...]]:
    """The nearest kind above a part's that free things are cases of, and these things."""
    same = [thing for thing in free if thing.tag is role.tag]
    for general in kinds(role.kind):
        fitting = [thing.name for thing in same if general in kinds(kind_of(thing))]
        if fitting:
            return general, tuple(sorted(fitting))
    return role.kind, ()


def _free(role: Role) -> str:
    return "is fixed" if role.tag is TagType.FIXED else "can be moved"


def _nothing(role: Role, scene: Scene) -> PlanError:
    there = ", ".join(sorted(scene.things))
    return PlanError(
        f"nothing is left that {_free(role)} for the part of {role.name!r} ({role.kind}); the "
        f"scene has {there}; one more {role.kind} in it, or another one stated with --object "
        f"{role.name}=NAME, would do"
    )
