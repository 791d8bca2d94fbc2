"""Where a thing passes from one performer to another, and the ways of things that all handle."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.model.capture import TagType
from capar.regeneration.body_frames import body_frames
from capar.regeneration.errors import PlanError
from capar.regeneration.joint_sources import HandOver, JointSource, all_holds
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source, moves
from capar.regeneration.styles import Style
from capar.regeneration.thing_goals import Goal, support_at, thing_goals
from capar.regeneration.thing_paths import Ways, thing_paths

SHIFTS = (
    (0.1, 0.0), (-0.1, 0.0), (0.0, 0.1), (0.0, -0.1), (0.1, 0.1), (-0.1, 0.1),
)  # fmt: skip
"""Other places that are tried, from the usual one towards the taker and upwards [m]."""


@dataclass(frozen=True, eq=False)
class Cast:
    """Who performs together, and where each one stands among the same things."""

    humans: Mapping[str, Human]
    """By the agent's name."""

    scenes: Mapping[str, Scene]
    """Likewise."""


@dataclass(frozen=True)
class Place:
    """Where something is handed over, from the usual place between two bodies."""

    nearer_m: float = 0.0
    """Towards the taker [m]."""

    higher_m: float = 0.0
    by_stature: bool = False
    """Whether it is as high as the mean of both statures has it, above what is beneath; else as
    far above where the thing was at first as it was recorded."""

    @property
    def words(self) -> str:
        """How it differs from the usual one; empty where it does not."""
        if self.by_stature:
            return "as high as the mean of both statures has it"
        taker = f"{abs(self.nearer_m):.1f} m nearer to the {'taker' * (self.nearer_m > 0)}"
        taker += "giver" * (self.nearer_m < 0)
        high = f"{abs(self.higher_m):.1f} m {'higher' if self.higher_m > 0 else 'lower'}"
        return " and ".join([taker] * bool(self.nearer_m) + [high] * bool(self.higher_m))


def places() -> Iterator[Place]:
    """The places that are tried, the usual one first."""
    yield Place()
    yield Place(by_stature=True)
    yield from (Place(nearer_m, higher_m) for nearer_m, higher_m in SHIFTS)


def joint_ways(source: JointSource, cast: Cast, style: Style, place: Place) -> Ways:
    """The ways of all things, through the hands of all performers.

    Args:
        source: What was recorded.
        cast: Who performs, and where.
        style: Of the first performer, whose ways of things are everybody's.
        place: Where things are handed over.

    Raises:
        PlanError: Something would be put down where nothing supports it, or meets the head of
            one who was given it.
    """
    first = next(iter(source.sources))
    one = replace(source.sources[first], holds=all_holds(source))
    _check_meetings(source, first)
    scene, human = cast.scenes[first], cast.humans[first]
    goals = thing_goals(one, scene, body_frames(one.human, one.scene), body_frames(human, scene))
    told = []
    for passed in source.hand_overs:
        before, after = one.paths[passed.thing][passed.first], offer(source, cast, passed, place)
        goals[passed.thing] = _through(one, scene, goals[passed.thing], passed, before, after)
        x, y, z = after.translation
        shifted = f", {place.words}, since there it is out of reach" if place.words else ""
        told.append(
            f"{passed.giver} hands {passed.thing!r} to {passed.taker} at "
            f"{one.times[passed.first]:.2f} s at ({x:.2f}, {y:.2f}, {z:.2f}) m, between them as "
            f"their statures are{shifted}"
        )
    ways = thing_paths(one, scene, goals, human, style)
    return replace(ways, told=(*told, *ways.told))


def _check_meetings(source: JointSource, first: str) -> None:
    for name, one in source.sources.items():
        if name != first and one.meetings:
            meeting = one.meetings[0]
            raise PlanError(
                f"{meeting.thing!r} comes to the {meeting.part} of {name!r}, and among several "
                f"performers only the first one, {first!r}, may bring a thing to the head; end "
                "the recording before, or name that agent first"
            )


def offer(source: JointSource, cast: Cast, passed: HandOver, place: Place) -> RigidTransform:
    """Where a thing is handed over.

    Along the line from one performer to the other where the recorded place divides it, each side
    in proportion to that one's stature; as far above where it was at first as it was recorded.

    Args:
        source: What was recorded.
        cast: Who performs, and where.
        passed: What passes between whom.
        place: How far from there.
    """
    pair = (passed.giver, passed.taker)
    olds, news = [source.sources[name] for name in pair], [cast.scenes[name] for name in pair]
    before = olds[0].paths[passed.thing][passed.first]
    ratios = [
        cast.humans[name].measures["stature"] / source.sources[name].human.measures["stature"]
        for name in pair
    ]
    (start, way), (new_start, new_way) = (_line(scenes) for scenes in (
        [old.scene for old in olds], news
    ))  # fmt: skip
    length, new_length = np.linalg.norm(way), np.linalg.norm(new_way)
    local = before.translation[:2] - start
    share = float(local @ way) / length**2
    aside = float(local @ _left(way)) / length
    shares = np.array([share * ratios[0], (1.0 - share) * ratios[1]])
    divided = float(shares[0] / shares.sum()) + place.nearer_m / new_length
    flat = new_start + divided * new_way + aside * np.mean(ratios) * _left(new_way) / new_length
    old_scene, new_scene = olds[0].scene, news[0]
    gone = before.translation[2] - old_scene.thing(passed.thing).place[2]
    high = new_scene.thing(passed.thing).place[2] + gone
    if place.by_stature:
        by_body = float(np.mean(ratios)) * (before.translation[2] - old_scene.floor_m)
        high = max(new_scene.floor_m + by_body, _beneath(new_scene, passed.thing, flat) + gone)
    turn = _heading(new_way) - _heading(way)
    own = Rotation.from_euler("z", turn) * before.rotation
    return RigidTransform.from_components([*flat, high + place.higher_m], own)


def _line(scenes: list[Scene]) -> tuple[Float[np.ndarray, "2"], Float[np.ndarray, "2"]]:
    """Where the giver stands, and the way from there to the taker [m]."""
    giver, taker = (np.asarray(scene.place) for scene in scenes)
    return giver, taker - giver


def _left(way: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
    return np.array([-way[1], way[0]])


def _heading(way: Float[np.ndarray, "2"]) -> float:
    return float(np.arctan2(way[1], way[0]))


def _beneath(scene: Scene, name: str, spot: Float[np.ndarray, "2"]) -> float:
    """How high a thing's origin is when it stands on what is fixed there, or on the floor [m]."""
    tops = [scene.floor_m]
    for thing in scene.things.values():
        if thing.tag is TagType.FIXED:
            corners = thing.pose.apply(np.array(thing.shape.vertices))
            near, far = corners.min(axis=0), corners.max(axis=0)
            if (near[:2] <= spot).all() and (spot <= far[:2]).all():
                tops.append(float(far[2]))
    return max(tops) - float(scene.thing(name).shape.bounds[0, 2])


def _through(
    one: Source,
    scene: Scene,
    goals: list[Goal],
    passed: HandOver,
    before: RigidTransform,
    after: RigidTransform,
) -> list[Goal]:
    """The goals of a thing with those of its being handed over between them.

    What nothing bears afterwards goes as far in metres from there as it did.
    """
    reason = "handed over between both, in proportion to their statures"
    frames = dict.fromkeys((passed.first, passed.last))
    through = [Goal(passed.thing, frame, after, reason) for frame in frames]
    path, kept = one.paths[passed.thing], []
    turn = after.rotation * before.rotation.inv()
    for goal in goals:
        if goal.frame < passed.first:
            arrived = not moves(path[goal.frame : passed.first + 1])
            if not (arrived and goal is not goals[0]):
                kept.append(goal)
        elif goal.frame > passed.last:
            gone = path[goal.frame].translation - before.translation
            if not support_at(one.scene, passed.thing, path[goal.frame]):
                pose = RigidTransform.from_components(
                    after.translation + turn.apply(gone),
                    turn * path[goal.frame].rotation,
                )
                reason = "as far from where it was handed over as it was [m]"
                kept.append(replace(goal, pose=pose, reason=reason))
            else:
                kept.append(goal)
    return sorted([*kept, *through], key=lambda goal: goal.frame)
