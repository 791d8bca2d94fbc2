"""Where things are throughout: at rest, on the way between goals, and at the head."""

from collections.abc import Mapping
from dataclasses import dataclass

from scipy.spatial.transform import RigidTransform

from capar.body.human import Human
from capar.regeneration.bearing import Ride, Steadiness, steadiness, with_riders
from capar.regeneration.carrying import Carrying
from capar.regeneration.constrained_ways import (
    HINGE,
    PLANE,
    RAIL,
    flattened,
    guided_poses,
    scene_constraints,
    told_of_constraints,
)
from capar.regeneration.forces.tosses import toss_notes, with_tosses
from capar.regeneration.path_mapping import STRAIGHT, Detour
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source
from capar.regeneration.styles import Style
from capar.regeneration.thing_goals import Goal, handled, rests, toss_of


@dataclass(frozen=True, eq=False)
class Ways:
    """The ways of all things."""

    goals: dict[str, list[Goal]]
    """By name, in order of time."""

    paths: dict[str, RigidTransform]
    """``T_world_thing`` by name at every frame."""

    told: tuple[str, ...]
    """What is to be told of them."""


def thing_paths(
    source: Source, scene: Scene, goals: dict[str, list[Goal]], human: Human, style: Style
) -> Ways:
    """Where things are at every frame, from goal to goal.

    Other things stand where they were at first while a way is sought.
    """
    count, turn = len(source.times), scene.heading - source.scene.heading
    carrying = Carrying(human, scene, style.kind)
    still = {name: thing.pose for name, thing in scene.things.items()}
    out, constraints = {}, scene_constraints(source, scene)
    beside = {companion.hold.thing: companion for companion in source.companions}
    told = told_of_constraints(constraints)
    for name, recorded in source.paths.items():
        kind = constraints[name].kind if name in constraints else ""
        if kind in {HINGE, RAIL}:
            spans = handled(source, name)
            out[name] = guided_poses(source, scene, name, style.things[name], spans)
            continue
        poses = [scene.thing(name).pose] * count
        if name in beside:
            out[name] = RigidTransform.concatenate(poses)
            continue
        for start, goal in zip(goals.get(name, []), goals.get(name, [])[1:], strict=False):
            part = style.things[name][start.frame : goal.frame + 1]
            if goal.frame > start.frame and not toss_of(source, name, first=start.frame):
                if rests(recorded[start.frame : goal.frame + 1], start.pose, goal.pose):
                    poses[start.frame : goal.frame + 1] = [start.pose] * len(part)
                else:
                    ends = start.pose, goal.pose
                    part = flattened(part) if kind == PLANE else part
                    along = _borne(source, scene, name, start.frame, goal.frame)
                    others = {n: pose for n, pose in still.items() if n not in {name, *along}}
                    piece, detour = carrying.way(name, part, ends, others, turn, along)
                    piece = flattened(piece) if kind == PLANE and detour == STRAIGHT else piece
                    poses[start.frame : goal.frame + 1] = list(piece)
                    if detour != STRAIGHT:
                        told.append(_lifted(name, source.times[start.frame], detour))
            poses[goal.frame :] = [goal.pose] * (count - goal.frame)
        out[name] = with_tosses(source, scene, name, RigidTransform.concatenate(poses))
        told += toss_notes(source, scene, out[name], name)
    told += [
        f"{ride.thing!r} goes along on {ride.bearer!r} from {source.times[ride.first]:.2f} to "
        f"{source.times[ride.last]:.2f} s"
        for ride in source.rides
    ]
    told += [
        f"{name!r} lies in the {one.hold.side} hand beside {one.lead.thing!r} from "
        f"{source.times[one.ride.first]:.2f} to {source.times[one.ride.last]:.2f} s"
        for name, one in beside.items()
    ]
    rides = (*(companion.ride for companion in source.companions), *source.rides)
    return Ways(goals, with_riders(out, rides), tuple(told))


def _borne(
    source: Source, scene: Scene, name: str, first: int, last: int
) -> dict[str, RigidTransform]:
    """``T_thing_other`` of what goes along with a thing between two frames, from frame to frame.

    That is what it bears, and what lies in the hand beside it, with what these bear.
    """
    out: dict[str, RigidTransform] = {}
    for ride in (*(companion.ride for companion in source.companions), *source.rides):
        if ride.first < last and first < ride.last and (ride.bearer == name or ride.bearer in out):
            below, own = scene.thing(name).pose, scene.thing(ride.thing).pose
            out[ride.thing] = below.inv() * own
    return out


def borne_steadily(
    source: Source, scene: Scene, paths: Mapping[str, RigidTransform], ride: Ride
) -> Steadiness:
    """Whether a thing would stay on what bears it along these ways.

    Args:
        source: The recorded performance.
        scene: Where it is performed.
        paths: ``T_world_thing`` by name at every frame.
        ride: Which thing, on what and when.
    """
    bearer = paths[ride.bearer][ride.first : ride.last + 1]
    seat = bearer[0].inv() * paths[ride.thing][ride.first]
    return steadiness(scene.thing(ride.thing), seat, bearer, source.rate_hz)


def _lifted(name: str, at_s: float, detour: Detour) -> str:
    over = f"{1e3 * detour.lift_m:.0f} mm over what stands in its way"
    return f"{name!r} is lifted {over} at {at_s:.2f} s"
