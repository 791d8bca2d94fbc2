"""Roles: which object of a scene takes the part of each recorded one."""

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import RigidTransform

from capar.body.anthropometry import measures_of
from capar.body.human import Human
from capar.body.scenes import Thing
from capar.model.capture import Capture, Shape, TagType
from capar.model.errors import UnknownNameError
from capar.regeneration.scenes import PlanError, Scene, moved
from capar.regeneration.sources import Source, moves, scene_of

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
    return tuple(_role(source, name, taking) for name in taking)


def _role(source: Source, name: str, taking: Sequence[str]) -> Role:
    thing = source.scene.thing(name)
    bears = tuple(other for other in taking if source.scene.support(other) == name)
    return Role(name, kind_of(thing), thing.tag, bears, moves(source.paths[name]))


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
    """The part that is decided next, and its object: supports wait for what they bear."""
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
    """What the object stands on that has a part which this one bears."""
    borne = (found[name].thing for name in role.bears if name in found)
    return next((support for thing in borne if (support := scene.support(thing))), "")


def _fitting(role: Role, free: Sequence[Thing], kinds: Kinds) -> tuple[str, tuple[str, ...]]:
    """The nearest kind above a part's that free objects are cases of, and these objects."""
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


ASIDE = "_beside"
"""What is put after the name of an object that has no part and the name of one that has."""

Cast = Mapping[str, str]
"""The object of the scene that takes each recorded object's part."""


def captured_scene(capture: Capture) -> Scene:
    """The scene that a capture was recorded in: its objects, and where the performer stood.

    Raises:
        PlanError: An object has no shape, or there is no sensor of the head.
    """
    return scene_of(capture, Human.of(measures_of(capture.agent)))


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
            own = name if name not in things else name + ASIDE
            extras[own] = replace(thing, name=own)
            named[name] = own
    count = len(source.times)
    still = {
        name: RigidTransform.concatenate([thing.pose] * count) for name, thing in extras.items()
    }
    ends = {name: named[goal] for name, goal in (goals or {}).items()}
    spots = {
        name: _shifted(scene.spots[parts[name]], scene.thing(parts[name]), things[name])
        for name in things
        if parts[name] in scene.spots
    }
    where = replace(scene, things={**things, **extras}, goals=ends, spots=spots)
    recorded = replace(source.scene, things={**source.scene.things, **extras})
    return replace(source, scene=recorded, paths={**source.paths, **still}), where


def _shifted(
    spot: tuple[float, float, float], actor: Thing, fitted: Thing
) -> tuple[float, float, float]:
    """Where the fitted object's origin is when the object's own is at a spot."""
    x, y, z = np.asarray(spot) + np.asarray(fitted.place) - np.asarray(actor.place)
    return float(x), float(y), float(z)


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
            raise PlanError(f"{actor!r} is fixed and cannot be moved; {_movable(scene)}")


def own_names(source: Source, scene: Scene, parts: Cast) -> dict[str, str]:
    """The scene's names of the objects that a performance calls by their recorded ones."""
    taken = set(parts.values())
    found = {name: parts[name] for name in source.scene.things if name in parts}
    for name in scene.things:
        if name not in taken:
            found[name if name not in parts else name + ASIDE] = name
    return found


def _movable(scene: Scene) -> str:
    names = sorted(each.name for each in scene.things.values() if each.tag is TagType.MOBILE)
    return f"what can be moved is {', '.join(names)}" if names else "nothing there can be moved"


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
