"""A hand works drawers, doors and lids: each a closed form, its steps written beforehand.

The furniture stands before the person, its front towards them; the front's lower edge is level with
the table, and x points into it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Unpack

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.capture import Shape, TagType
from motions import figure, shapes
from motions.handled import HAND, HOME_S, PAUSE_S, REACH_S, REST_S
from motions.paths import Moves, Riding, Still, Vector, aimed, minimum_jerk, pose
from motions.performers import Performer
from motions.trials import Body, Options, Sampling, Script, Trial, Truth, record

WORK_S = 1.2
"""How long it takes to open or close [s]."""

WIDE, DEEP, HIGH, WALL = 0.50, 0.40, 0.30, 0.02
"""The furniture outside, and its walls [m]."""

GAP = 0.003
"""Between what moves and what it closes [m]."""

TURN = 12.0
"""How hard it turns back where it is not held in between [ways / duration^2]."""

AHEAD_M = 0.55
"""How far the furniture's front is before the person at most [m]."""


@dataclass(frozen=True)
class Stroke:
    """A motion of what is on the guide, to so far from its closed place, and a pause after it."""

    to: float
    pause: bool = True


@dataclass(frozen=True, eq=False)
class Guided:
    """A thing on a rail or a hinge, that follows strokes one after the other."""

    closed: RigidTransform
    axis: Vector
    """Of the rail, or of the hinge: the way or the sense in which it opens."""

    hinge: Vector | None
    """A point of the hinge in the world [m]; None for a rail."""

    strokes: tuple[tuple[float, float, float, float], ...]
    """When each begins and ends [s], and from where to where it leads [rad] or [m].

    Where one ends as the next begins, the thing turns back without coming to rest in between.
    """

    def course(self, times: Float[np.ndarray, "frames"]) -> Float[np.ndarray, "frames"]:
        """How far it is open at each time [rad] or [m]."""
        out = np.full(len(times), self.strokes[0][2])
        starts, ends = ({each[side] for each in self.strokes} for side in (0, 1))
        for start, end, begin, goal in self.strokes:
            tau = (times - start) / (end - start)
            launch, halt = TURN * (start in ends), TURN * (end in starts)
            share = minimum_jerk(tau, launch=launch, halt=halt)
            out = np.where(times >= start, begin + (goal - begin) * share, out)
        return out

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        course = self.course(np.asarray(times))[:, None]
        axis = np.asarray(self.axis)
        place, turn = self.closed.translation, self.closed.rotation
        if self.hinge is None:
            still = Rotation.concatenate([turn] * len(course))
            return RigidTransform.from_components(place + course * axis, still)
        about = np.asarray(self.hinge)
        turns = Rotation.from_rotvec(course * axis)
        return RigidTransform.from_components(about + turns.apply(place - about), turns * turn)


@dataclass(frozen=True, eq=False)
class Furniture:
    """Something fixed and what moves on it."""

    name: str
    fixed: Shape
    place: RigidTransform
    thing: Shape
    closed: RigidTransform
    axis: Vector
    hinge: Vector | None
    grip: RigidTransform
    """``T_thing_hand``."""

    away: Vector
    """Along which the hand comes from, in the thing's frame [m]."""


@cache
def case(*, front: bool) -> Shape:
    """A hollow case of walls, open in front (towards -x) or above; its origin below its middle."""
    outer = trimesh.creation.box(extents=(DEEP, WIDE, HIGH))
    inner = trimesh.creation.box(extents=(DEEP, WIDE - 2 * WALL, HIGH - 2 * WALL))
    if front:
        inner.apply_translation([-WALL, 0.0, 0.0])
    else:
        inner = trimesh.creation.box(extents=(DEEP - 2 * WALL, WIDE - 2 * WALL, HIGH))
        inner.apply_translation([0.0, 0.0, WALL])
    mesh = trimesh.boolean.difference([outer, inner])
    mesh.apply_translation([0.0, 0.0, HIGH / 2.0])
    return shapes.shape(mesh, "case")


@cache
def drawer_box() -> Shape:
    """An open box with a bar across its front as a handle; its origin below its middle."""
    size = (DEEP - WALL - GAP, WIDE - 2 * WALL - 2 * GAP, 0.15)
    outer = trimesh.creation.box(extents=size)
    inner = trimesh.creation.box(extents=(size[0] - 2 * WALL, size[1] - 2 * WALL, 0.15))
    inner.apply_translation([0.0, 0.0, WALL])
    bar = trimesh.creation.box(extents=(0.04, 0.12, 0.02))
    bar.apply_translation([-size[0] / 2.0 - 0.02, 0.0, 0.0])
    mesh = trimesh.boolean.union([trimesh.boolean.difference([outer, inner]), bar])
    mesh.apply_translation([0.0, 0.0, 0.075])
    return shapes.shape(mesh, "drawer")


def drawer(performer: Performer) -> Furniture:
    """A drawer in a case that is open in front."""
    place = _standing(performer)
    at = place.translation + np.array([-WALL / 2.0, 0.0, WALL + GAP])
    palm = aimed(x=(0.0, 1.0, 0.0), z=(0.0, 0.0, 1.0))
    over = 0.085 - figure.GRIP_DEPTH + figure.thickness(performer)
    grip = pose((-(DEEP - WALL - GAP) / 2.0 - 0.02 - 0.03 * performer.size, 0.0, over), palm)
    return Furniture(
        "drawer", case(front=True), place, drawer_box(), pose(at), (-1.0, 0.0, 0.0), None, grip,
        (-0.08, 0.0, 0.05),
    )  # fmt: skip


def door(performer: Performer) -> Furniture:
    """A cabinet's door, its hinge on the left, with a knob on the right."""
    place = _standing(performer)
    front = place.translation[0] - DEEP / 2.0 - GAP - WALL / 2.0
    at = np.array([front, place.translation[1], place.translation[2] + HIGH / 2.0])
    hinge = (front + WALL / 2.0, float(at[1]) + WIDE / 2.0, 0.0)
    panel = trimesh.creation.box(extents=(WALL, WIDE, HIGH))
    knob = trimesh.creation.box(extents=(0.06, 0.03, 0.03))
    knob.apply_translation([-0.04, -WIDE / 2.0 + 0.04, 0.0])
    mesh = trimesh.boolean.union([panel, knob])
    palm = aimed(x=(1.0, 0.0, 0.0), z=(0.0, -1.0, 0.0))
    beside = -WIDE / 2.0 + 0.025 + figure.GRIP_DEPTH - figure.thickness(performer)
    grip = pose((-0.02 - WALL - 0.09 * performer.size, beside, 0.0), palm)
    return Furniture(
        "door", case(front=True), place, shapes.shape(mesh, "door"), pose(at), (0.0, 0.0, -1.0),
        hinge, grip, (-0.08, -0.08, 0.0),
    )  # fmt: skip


def lid(performer: Performer) -> Furniture:
    """A chest's lid, its hinge at the back, taken below its overhanging front edge."""
    lower = min(0.0, 2.0 * (performer.size - 0.9))  # a child's raised lid would be out of reach
    place = pose((0.0, 0.0, lower)) * _standing(performer)
    at = place.translation + np.array([-0.02, 0.0, HIGH + GAP])
    size = (DEEP + 0.04, WIDE, WALL)
    hinge = (float(at[0]) + size[0] / 2.0, 0.0, float(at[2]))
    palm = aimed(x=(0.0, 1.0, 0.0), z=(-1.0, 0.0, 0.0))
    out = -size[0] / 2.0 + figure.GRIP_DEPTH - figure.thickness(performer)
    grip = pose((out, 0.0, WALL / 2.0), palm)
    return Furniture(
        "lid", case(front=False), place, shapes.box(*size), pose(at), (0.0, 1.0, 0.0), hinge, grip,
        (-0.10, 0.0, 0.02),
    )  # fmt: skip


def work(
    performer: Performer,
    furniture: Furniture,
    strokes: Sequence[Stroke],
    steps: Sequence[str],
    *,
    begin: float = 0.0,
    others: tuple[Body, ...] = (),
    **options: Unpack[Options],
) -> Trial:
    """Reach, hold, the strokes with pauses between them, hold, let go, and rest."""
    taken = REACH_S * performer.pace
    thing, ready = _course(performer, furniture, strokes, taken + PAUSE_S, begin)
    first, last = (thing.at(np.array([each]))[0] for each in (taken, ready))
    home = ready + HOME_S * performer.pace + REST_S
    away = np.asarray(furniture.away)
    reach = figure.reach(
        performer, HAND, goal=first * furniture.grip, start_s=0.1, end_s=taken,
        arrive=_vector(-first.rotation.apply(away)),
    )  # fmt: skip
    back = figure.withdraw(
        performer, HAND, begin=last * furniture.grip, start_s=ready, end_s=home - REST_S,
        depart=_vector(last.rotation.apply(away)),
    )  # fmt: skip
    hand = Riding(Moves((reach, back)), thing, furniture.grip, taken, ready)
    bodies = (
        figure.hand_body(performer, HAND, hand),
        Body(furniture.name, thing, furniture.thing, TagType.MOBILE, mass_kg=2.0),
        Body("case", Still(furniture.place), furniture.fixed, TagType.FIXED, noisy=False),
        *others,
    )
    truth = Truth(home, (), {"extended": {HAND: tuple(steps)}}, {})
    return record(Script(furniture.name, performer, truth, bodies), Sampling(**options))


def _standing(performer: Performer) -> RigidTransform:
    ahead = min(AHEAD_M, 0.6 * performer.size)
    return pose((ahead + DEEP / 2.0, -0.12 + performer.aside_m, performer.table_m))


def _vector(values: np.ndarray) -> Vector:
    x, y, z = map(float, values)
    return x, y, z


def _course(
    performer: Performer,
    furniture: Furniture,
    strokes: Sequence[Stroke],
    start_s: float,
    begin: float,
) -> tuple[Guided, float]:
    """The thing's path, and when it has come to its end and was held there for a moment."""
    found, now, here = [], start_s, begin
    for each in strokes:
        end = now + WORK_S * performer.pace
        found.append((now, end, here, each.to))
        now, here = end + PAUSE_S * each.pause, each.to
    path = Guided(furniture.closed, furniture.axis, furniture.hinge, tuple(found))
    return path, now if strokes[-1].pause else now + PAUSE_S


TAKE, LEAVE = ("Reach", "Touch"), ("ResumePosture",)


def open_and_close_drawer(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A drawer is drawn, held, and pushed shut."""
    steps = (*TAKE, "Open", "TouchWith", "Close", "TouchWith", *LEAVE)
    return work(performer, drawer(performer), (Stroke(0.22), Stroke(0.0)), steps, **options)


def open_and_close_drawer_at_once(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A drawer is drawn and pushed shut without a pause."""
    steps = (*TAKE, "Open", "Close", "TouchWith", *LEAVE)
    strokes = (Stroke(0.22, pause=False), Stroke(0.0))
    return work(performer, drawer(performer), strokes, steps, **options)


def open_loaded_drawer(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A drawer with a block in it is drawn: the block goes along."""
    furniture = drawer(performer)
    steps = (*TAKE, "Open", "TouchWith", *LEAVE)
    inside = pose((0.05, 0.05, WALL))
    path, _ = _course(performer, furniture, (Stroke(0.2),), REACH_S * performer.pace + PAUSE_S, 0.0)
    load = Riding(Still(pose((0.0, 0.0, 0.0))), path, inside, 0.0)
    block = Body("block", load, shapes.box(0.05, 0.05, 0.08), TagType.MOBILE, mass_kg=0.2)
    return work(performer, furniture, (Stroke(0.2),), steps, others=(block,), **options)


def half_close_drawer(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A drawer is pushed in half the way, held, and then shut: it is closed in two stages."""
    steps = (*TAKE, "Close", "TouchWith", "Close", "TouchWith", *LEAVE)
    strokes = (Stroke(0.1), Stroke(0.0))
    return work(performer, drawer(performer), strokes, steps, begin=0.25, **options)


def open_and_close_door(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A cabinet's door is opened by its knob, held, and shut."""
    steps = (*TAKE, "Open", "TouchWith", "Close", "TouchWith", *LEAVE)
    return work(performer, door(performer), (Stroke(1.2), Stroke(0.0)), steps, **options)


def open_door_farther(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A cabinet's door is opened a little, held, and opened farther."""
    steps = (*TAKE, "Open", "TouchWith", "Open", "TouchWith", *LEAVE)
    return work(performer, door(performer), (Stroke(0.5), Stroke(1.3)), steps, **options)


def open_and_close_lid(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A chest's lid is opened at its front edge, held, and closed.

    Woman and child would fall over (POSSIBLE.md).
    """
    steps = (*TAKE, "Open", "TouchWith", "Close", "TouchWith", *LEAVE)
    return work(performer, lid(performer), (Stroke(1.4), Stroke(0.0)), steps, **options)


DOORS: tuple[Callable[..., Trial], ...] = (
    open_and_close_drawer, open_and_close_drawer_at_once, open_loaded_drawer, half_close_drawer,
    open_and_close_door, open_door_farther, open_and_close_lid,
)  # fmt: skip
