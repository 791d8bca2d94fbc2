"""Roles: which object of a scene takes the part of each recorded one."""

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import RigidTransform

from capar.body.virtual_scenes import Thing
from capar.model.capture import Shape, TagType
from capar.model.errors import UnknownNameError
from capar.regeneration.scenes import PlanError, Scene, moved
from capar.regeneration.sources import Source, moves

Kinds = Callable[[str], tuple[str, ...]]
"""A kind and every more general one, nearest first."""

Ask = Callable[["Role", tuple[str, ...]], str]
"""Asks a user which of several objects takes a part."""


@dataclass(frozen=True)
class Role:
    """A recorded object that takes part in an action."""

    name: str
    kind: str
    tag: TagType
    bears: tuple[str, ...]
    """What stands on it when the action begins."""

    moved: bool


@dataclass(frozen=True)
class Binding:
    """The object of a scene that takes a part, and why that one."""

    role: str
    thing: str
    reason: str


class AmbiguousError(PlanError):
    """Several objects of a scene fit a part that nothing was stated for.

    Attributes:
        role: The part.
        fitting: The objects, sorted.
    """

    def __init__(self, role: Role, fitting: tuple[str, ...]) -> None:
        self.role, self.fitting = role, fitting
        listed = ", ".join(fitting)
        super().__init__(
            f"the part of {role.name!r} ({role.kind}) may be taken by {listed}; say which: "
            f"--object {role.name}={fitting[0]}"
        )


def kind_of(thing: Thing) -> str:
    """The noun for an object: its kind, else its own name."""
    return thing.kind or thing.name


def roles_of(source: Source) -> tuple[Role, ...]:
    """What takes part in a recorded action: what is acted on, what that bears, and its supports.

    Other objects of the recorded scene have no part.
    """
    acted = list(source.observation.complex_par.objects)
    acted += [hold.thing for hold in source.holds]
    acted += [poise.other for poise in source.leanings]
    acted += [ride.thing for ride in source.loads]
    taking = [name for name in dict.fromkeys(acted) if name in source.scene.things]
    for name in tuple(taking):
        taking += [one for one in dict.fromkeys(ends_on(source, name)) if one and one not in taking]
    return tuple(
        Role(
            name,
            kind_of(source.scene.thing(name)),
            source.scene.thing(name).tag,
            tuple(other for other in taking if source.scene.support(other) == name),
            moves(source.paths[name]),
        )
        for name in taking
    )


def ends_on(source: Source, name: str) -> tuple[str, str]:
    """What a recorded object stands on at first and in the end; empty where it is nothing."""
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
    """The object of a scene for every part.

    What is stated counts first; then a part that bears another one is taken by what that one's
    object stands on; then the only object that can be moved, or is fixed, like the recorded one
    and is nearest of kind. Where several are equally near, it is asked.

    Raises:
        UnknownNameError: A stated part or object does not exist.
        AmbiguousError: Several objects fit, and there is nobody to ask.
        PlanError: Nothing fits, or one object has two parts.
    """
    known = {role.name for role in roles}
    found: dict[str, Binding] = {}
    for name, thing in stated.items():
        if name not in known:
            raise UnknownNameError("part", name, known)
        scene.thing(thing)
        taken = next((one.role for one in found.values() if one.thing == thing), None)
        if taken is not None:
            raise PlanError(f"{thing!r} cannot take the parts of {taken!r} and {name!r} both")
        found[name] = Binding(name, thing, "as stated")
    while open_roles := [role for role in roles if role.name not in found]:
        binding = _next(open_roles, scene, found, kinds, ask, own=own)
        found[binding.role] = binding
    return tuple(found[role.name] for role in roles)


def _next(
    roles: Sequence[Role],
    scene: Scene,
    found: Mapping[str, Binding],
    kinds: Kinds,
    ask: Ask | None,
    *,
    own: bool,
) -> Binding:
    """The object of the part that is decided next: supports wait for what they bear."""
    names, taken = {role.name for role in roles}, {binding.thing for binding in found.values()}
    ready = [role for role in roles if not names.intersection(role.bears)] or list(roles)
    free = {name: thing for name, thing in scene.things.items() if name not in taken}
    options = []
    for role in ready:
        borne = [found[name].thing for name in role.bears if name in found]
        beneath = next((below for thing in borne if (below := scene.support(thing))), "")
        if beneath in free and free[beneath].tag is role.tag:
            return Binding(role.name, beneath, f"what {borne[0]!r} stands on")
        if own and role.name in free:
            return Binding(role.name, role.name, "as recorded")
        how = "is fixed" if role.tag is TagType.FIXED else "can be moved"
        same = [thing for thing in free.values() if thing.tag is role.tag]
        for rank, general in enumerate(kinds(role.kind)):
            fits = sorted(thing.name for thing in same if general in kinds(kind_of(thing)))
            if fits:
                options.append((rank, general, tuple(fits), how, role))
                break
        else:
            raise PlanError(
                f"nothing is left that {how} for the part of {role.name!r} ({role.kind}); the "
                f"scene has {', '.join(sorted(scene.things))}; one more {role.kind} in it, or "
                f"another one stated with --object {role.name}=NAME, would do"
            )
    sure = [option for option in options if len(option[2]) == 1]
    if sure:
        _, general, fitting, how, role = min(sure, key=lambda option: option[0])
        return Binding(role.name, fitting[0], f"the only {general} that {how}")
    _, _, fitting, _, role = options[0]
    if ask is None:
        raise AmbiguousError(role, fitting)
    return Binding(role.name, ask(role, fitting), "as answered")


ASIDE = "_beside"
"""What is put after the name of an object that has no part and the name of one that has."""

Cast = Mapping[str, str]
"""The object of the scene that takes each recorded object's part."""


def cast(
    source: Source, scene: Scene, parts: Cast, goals: Mapping[str, str] | None = None
) -> tuple[Source, Scene]:
    """A recorded performance, and a scene in which others have the parts of its objects.

    In both the objects bear their recorded names; an object without a part keeps its own and stands
    in the path.

    Raises:
        PlanError: A recorded object has no part, or a fixed one is to be moved.
    """
    check_movable(source, scene, parts)
    named: dict[str, str] = {}
    things: dict[str, Thing] = {}
    for name, thing in source.scene.things.items():
        if name not in parts:
            raise PlanError(f"nothing in the scene has the part of {name!r}")
        actor = scene.thing(parts[name])
        things[name] = replace(_fitted(actor, thing), name=name)
        named[actor.name] = name
    extras = {}
    for name, thing in scene.things.items():
        if name not in named:
            named[name] = name if name not in things else name + ASIDE
            extras[named[name]] = replace(thing, name=named[name])
    spots = {}
    for name, fitted in things.items():  # where its origin is when the object's own is at a spot
        if parts[name] in scene.spots:
            off = np.subtract(fitted.place, scene.thing(parts[name]).place)
            x, y, z = (float(value) for value in off + scene.spots[parts[name]])
            spots[name] = (x, y, z)
    count = len(source.times)
    still = {n: RigidTransform.concatenate([thing.pose] * count) for n, thing in extras.items()}
    ends = {name: named[goal] for name, goal in (goals or {}).items()}
    where = replace(scene, things={**things, **extras}, goals=ends, spots=spots)
    recorded = replace(source.scene, things={**source.scene.things, **extras})
    return replace(source, scene=recorded, paths={**source.paths, **still}), where


def with_only(source: Source, names: Container[str]) -> Source:
    """A recorded performance without the objects that take no part in it."""
    scene = source.scene
    things = {name: thing for name, thing in scene.things.items() if name in names}
    paths = {name: path for name, path in source.paths.items() if name in names}
    return replace(source, scene=replace(scene, things=things), paths=paths)


def check_movable(source: Source, scene: Scene, parts: Cast) -> None:
    """Check that nothing fixed has the part of what is taken and moved.

    Raises:
        PlanError: Something has.
    """
    for name, actor in parts.items():
        if scene.thing(actor).tag is TagType.FIXED and moves(source.paths[name]):
            mobile = sorted(o.name for o in scene.things.values() if o.tag is TagType.MOBILE)
            others = f"what can be moved is {', '.join(mobile)}"
            raise PlanError(
                f"{actor!r} is fixed and cannot be moved; "
                f"{others if mobile else 'nothing there can be moved'}"
            )


def own_names(source: Source, scene: Scene, parts: Cast) -> dict[str, str]:
    """The scene's names of the objects that a performance calls by their recorded ones."""
    taken = set(parts.values())
    found = {name: parts[name] for name in source.scene.things if name in parts}
    for name in scene.things:
        if name not in taken:
            found[name if name not in parts else name + ASIDE] = name
    return found


def _fitted(actor: Thing, part: Thing) -> Thing:
    """The object with its frame's origin at the same share of its box as the recorded one's."""
    low, high = part.shape.bounds
    share = -low / np.maximum(high - low, 1e-9)
    origin = actor.shape.bounds[0] + share * actor.size
    shape = Shape(
        np.array(actor.shape.vertices) - origin,
        np.array(actor.shape.faces),
        actor.shape.source,
        actor.shape.description,
    )
    x, y, z = (float(each) for each in actor.pose.apply(origin))
    return replace(actor, shape=shape, place=(x, y, z))
