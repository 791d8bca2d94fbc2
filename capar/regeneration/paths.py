"""Paths of objects from goal to goal, and of hands from hold to hold, clear of the scene."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from jaxtyping import Float
from scipy.ndimage import maximum_filter1d, uniform_filter1d
from scipy.spatial.transform import RigidTransform

from capar.body.human import Human
from capar.body.recording import HAND_SEGMENTS
from capar.model.capture import TagType
from capar.regeneration.body_frames import BodyFrames, free_pose, rest_pose
from capar.regeneration.collisions import Surroundings
from capar.regeneration.forces import with_throws
from capar.regeneration.goals import (
    HINGE,
    PLANE,
    RAIL,
    Goal,
    flattened,
    guided_poses,
    handled,
    rests,
    scene_constraints,
    throw_of,
)
from capar.regeneration.holds import Load, Steadiness, hand_spans, steadiness, with_loads
from capar.regeneration.scenes import PlanError, Scene
from capar.regeneration.solving import Solver, vectors
from capar.regeneration.sources import Hold, Source
from capar.regeneration.styles import STRAIGHT, Detour, Kind, Style, mapped

LIFTS_M = (0.0, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.3)
"""How far a path is lifted half-way, in order [m]."""

BESIDE_M = 0.01
"""How far a held object keeps from what stands beside its path [m]."""

SLACK_M = 0.0005
"""How much nearer than at both ends it may come [m]."""

CUT_M = 0.001
"""How much deeper than at both ends it may be inside something [m]."""

SUNK_M = 0.005
"""A recorded object that sinks no deeper into what is fixed does so by error [m]."""

SPREAD = 9
"""Over so many frames it is raised out of it [1]."""

STEEPEST_M = 0.001
"""Nor faster than this from either end of its path [m a frame]."""

STRIDE = 2
"""Frames between two at which a path is checked."""


class Carrying:
    """Paths of held objects through a scene."""

    def __init__(self, human: Human, scene: Scene, kind: Kind) -> None:
        self.scene, self.kind = scene, kind
        self.around = Surroundings(human, scene)
        self.posture = Solver(human, (*scene.place, scene.floor_m), scene.heading).rest

    def way(
        self,
        name: str,
        part: RigidTransform,
        ends: tuple[RigidTransform, RigidTransform],
        others: Mapping[str, RigidTransform],
        turn: float,
        along: Mapping[str, RigidTransform] = MappingProxyType({}),
    ) -> tuple[RigidTransform, Detour]:
        """``T_world_thing`` from one goal to the next, and the detour that it makes.

        Args:
            name: Of the object.
            part: As it was recorded.
            ends: Where it starts and where it has to go.
            others: Where the other objects are meanwhile.
            turn: How far the new scene faces another way about z [rad].
            along: ``T_thing_borne`` of what it bears, which goes the same way.

        Raises:
            PlanError: However far it is lifted, it goes through something.
        """
        best, least = STRAIGHT, np.inf
        for detour in (Detour(lift) for lift in LIFTS_M):
            path = self._mapped(name, part, ends, turn, detour, others)
            short = self._short(name, path, others)
            for borne, seat in along.items():
                short = max(short, self._short(borne, path * seat, others))
            if short < least:
                best, least = detour, short
            if least <= 0.0:
                break
        path = self._mapped(name, part, ends, turn, best, others)
        if least > 0.0:
            self._check_free(name, path, others)
            for borne, seat in along.items():
                self._check_free(borne, path * seat, others)
        return path, best

    def _mapped(
        self,
        name: str,
        part: RigidTransform,
        ends: tuple[RigidTransform, RigidTransform],
        turn: float,
        detour: Detour,
        others: Mapping[str, RigidTransform],
    ) -> RigidTransform:
        path = mapped(
            part, *ends, turn=turn, detour=detour, heading=self.scene.heading, kind=self.kind
        )
        return self._out_of_ground(name, path, others)

    def _out_of_ground(
        self, name: str, path: RigidTransform, others: Mapping[str, RigidTransform]
    ) -> RigidTransform:
        """The path raised where it sinks a little deeper into something fixed than both ends do.

        Recorded objects do, as they are tipped up: their poses are a few millimetres off.
        """
        things = self.scene.things
        fixed = {n: vectors(p) for n, p in others.items() if things[n].tag is TagType.FIXED}
        gaps = [dict(self._gaps(name, pose, fixed)) for pose in vectors(path)]
        usual = {n: min(0.0, gaps[0].get(n, 0.0), gaps[-1].get(n, 0.0)) for n in fixed}
        sunk = np.array([max([0.0, *(usual[n] - gap for n, gap in g.items())]) for g in gaps])
        if not 0.0 < sunk.max() <= SUNK_M:
            return path
        wide = uniform_filter1d(maximum_filter1d(sunk, SPREAD), SPREAD)
        frames = np.arange(len(sunk))
        by_m = np.minimum(wide, STEEPEST_M * np.minimum(frames, frames[::-1]))
        return RigidTransform.from_translation(np.outer(by_m, [0.0, 0.0, 1.0])) * path

    def _check_free(
        self, name: str, path: RigidTransform, others: Mapping[str, RigidTransform]
    ) -> None:
        """No path leads deeper into something than both of its ends are."""
        poses, still = vectors(path), {n: vectors(pose) for n, pose in others.items()}
        ends = [dict(self._gaps(name, poses[row], still)) for row in (0, -1)]
        found = (pair for pose in poses for pair in self._gaps(name, pose, still))
        other, gap = min(found, key=lambda pair: pair[1], default=("", 0.0))
        if gap < min(0.0, *(end.get(other, 0.0) for end in ends)) - CUT_M:
            raise PlanError(
                f"{name!r} would go {-1e3 * gap:.0f} mm into {other!r} on its way, however far it "
                "is lifted"
            )

    def _short(
        self, name: str, path: RigidTransform, others: Mapping[str, RigidTransform]
    ) -> float:
        """By how much it comes too near something, at worst [m]."""
        poses, still = vectors(path), {n: vectors(pose) for n, pose in others.items()}
        ends = [dict(self._gaps(name, poses[row], still)) for row in (0, -1)]
        worst = 0.0
        for row in range(0, len(path), STRIDE):
            for other, gap in self._gaps(name, poses[row], still):
                least = min(BESIDE_M, *(end.get(other, BESIDE_M) for end in ends))
                worst = max(worst, least - SLACK_M - gap)
        return worst

    def _gaps(
        self, name: str, pose: Float[np.ndarray, "7"], others: Mapping[str, Float[np.ndarray, "7"]]
    ) -> Iterator[tuple[str, float]]:
        self.around.place(self.posture, {**others, name: pose})
        for pair in self.around.things_near():
            other = pair.thing if pair.part == name else pair.part
            if name in (pair.part, pair.thing) and other in others:
                yield other, pair.distance_m


@dataclass(frozen=True, eq=False)
class ObjectPaths:
    """The paths of all objects."""

    goals: dict[str, list[Goal]]
    """By name, in order of time."""

    paths: dict[str, RigidTransform]
    """``T_world_thing`` by name at every frame."""

    told: tuple[str, ...]
    """What is to be reported of them."""


def object_paths(
    source: Source, scene: Scene, goals: dict[str, list[Goal]], human: Human, style: Style
) -> ObjectPaths:
    """Where objects are at every frame, from goal to goal.

    Other objects stand where they were at first while a path is sought.
    """
    count, turn = len(source.times), scene.heading - source.scene.heading
    carrying = Carrying(human, scene, style.kind)
    still = {name: thing.pose for name, thing in scene.things.items()}
    out, constraints = {}, scene_constraints(source, scene)
    beside = {companion.hold.thing: companion for companion in source.co_held}
    told = [
        f"{name!r} keeps to its {one.kind} on {one.other!r}"
        for name, one in constraints.items()
        if one.kind != PLANE
    ]
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
            if goal.frame > start.frame and not throw_of(source, name, first=start.frame):
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
        out[name] = with_throws(source, scene, name, RigidTransform.concatenate(poses))
    loads = (*(companion.ride for companion in source.co_held), *source.loads)
    told += [
        f"{ride.thing!r} goes along with {ride.bearer!r} from {source.times[ride.first]:.2f} to "
        f"{source.times[ride.last]:.2f} s"
        for ride in loads
    ]
    return ObjectPaths(goals, with_loads(out, loads), tuple(told))


def _borne(
    source: Source, scene: Scene, name: str, first: int, last: int
) -> dict[str, RigidTransform]:
    """``T_thing_other`` of what goes along with an object between two frames, from frame to frame.

    That is what it bears, and what lies in the hand beside it, with what these bear.
    """
    out: dict[str, RigidTransform] = {}
    for ride in (*(companion.ride for companion in source.co_held), *source.loads):
        if ride.first < last and first < ride.last and (ride.bearer == name or ride.bearer in out):
            below, own = scene.thing(name).pose, scene.thing(ride.thing).pose
            out[ride.thing] = below.inv() * own
    return out


def borne_steadily(
    source: Source, scene: Scene, paths: Mapping[str, RigidTransform], ride: Load
) -> Steadiness:
    """Whether an object would stay on what bears it along these paths."""
    bearer = paths[ride.bearer][ride.first : ride.last + 1]
    seat = bearer[0].inv() * paths[ride.thing][ride.first]
    return steadiness(scene.thing(ride.thing), seat, bearer, source.rate_hz)


def _lifted(name: str, at_s: float, detour: Detour) -> str:
    over = f"{1e3 * detour.lift_m:.0f} mm over what stands in its way"
    return f"{name!r} is lifted {over} at {at_s:.2f} s"


HAND_LIFTS_M = (0.0, 0.04, 0.08, 0.12, 0.18, 0.25, 0.35)
BACKS_M = (0.0, 0.05, 0.1, 0.15, 0.2, 0.3)
OFFS_M = (0.0, 0.003, 0.02, 0.05)
"""Detours that are tried [m]."""

WORTH_M = 0.0005
"""By how much nearer to clear a larger detour must come where none is clear [m].

A smaller gain is not visible, being half the tolerance of 1 mm for a hand at rest; a detour takes
the hand up to 0.7 m off its path, and the performer's style with it.
"""

CHECK_S = 0.02
"""Most time between two frames at which a path is checked, unless frames are farther apart [s]."""

LEAVING_S = 0.3
"""So long after it let something go a hand may be near it [s]."""

HAND_CUT_M = 0.0003
"""How far a hand may cut what it is about to hold or has just left [m]."""


AT_ONCE_S, SOON_M = 0.15, 0.005
"""An object that is moved so far within that time of being taken is moved at once [s, m]."""

COMING_S, COMING_M = 0.1, 0.007
"""Until so long before that a hand keeps so far off it, or it would be seen to touch it [s, m]."""


@dataclass(frozen=True)
class Care:
    """How carefully free hands move."""

    margin_m: float = 0.013
    """How far they keep from what they do not touch [m]."""

    off_m: float = 0.0103
    """How far they are from what they let go after ``LEAVING_S`` [m]."""

    firm_s: float = 0.5
    """How long before and after a hold they are led firmly [s]."""

    weight: float = 1.0
    """How many times as much as usual their places weigh at events, against all else [1]."""


def hand_paths(
    source: Source,
    scene: Scene,
    old: BodyFrames,
    new: BodyFrames,
    grips: Mapping[Hold, RigidTransform],
    things: Mapping[str, RigidTransform],
    *,
    care: Care,
    style: Style,
) -> tuple[dict[str, RigidTransform], dict[tuple[str, int], Detour]]:
    """``T_world_hand`` by side at every frame, and the detours that were taken."""
    turn = scene.heading - source.scene.heading
    clearance = _Clearance(scene, new, things, care, source.rate_hz)
    out, detours = {}, {}
    for side in source.hands:
        holds = [hold for hold in source.holds if hold.side == side]
        poses: list[RigidTransform] = [new.rest[side]] * len(source.times)
        for hold in holds:
            for frame in range(hold.first, hold.last + 1):
                poses[frame] = things[hold.thing][frame] * grips[hold]
        spans = dict(hand_spans(holds, source.co_held))
        for before, after in zip([None, *spans], [*spans, None], strict=True):
            first = before.last if before else 0
            last = after.first if after else len(source.times) - 1
            if last <= first:
                continue
            start, goal = poses[first], poses[last]
            if not before:
                start = _free(source, old, new, side, (first, last), goal if after else None)
            if not after:
                goal = _free(source, old, new, side, (last, first), start if before else None)
            touched = {thing for each in (before, after) if each for thing in spans[each]}
            part = style.hands[side][first : last + 1]
            away = _away(start, before), _away(goal, after)

            def path(
                detour: Detour,
                part: RigidTransform = part,
                ends: tuple[RigidTransform, RigidTransform] = (start, goal),
                away: tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]] = away,
            ) -> RigidTransform:
                facing = scene.heading
                return mapped(
                    part,
                    *ends,
                    turn=turn,
                    detour=detour,
                    heading=facing,
                    away=away,
                    kind=style.kind,
                )

            held = before is not None, after is not None
            apart = after.thing if after and _moved_at_once(source, after) else ""
            best = clearance.first_clear(side, path, first, touched, held, apart)
            poses[first : last + 1] = list(path(best))
            if best != STRAIGHT:
                detours[side, first] = best
        out[side] = RigidTransform.concatenate(poses)
    return out, detours


def _free(
    source: Source,
    old: BodyFrames,
    new: BodyFrames,
    side: str,
    frames: tuple[int, int],
    held: RigidTransform | None,
) -> RigidTransform:
    """Where a hand begins or ends that is free then, by the hold next to that if there is one."""
    if held is None:
        return rest_pose(source, old, new, side, frames[0])
    return free_pose(source, old, new, side, frames, held)


def _moved_at_once(source: Source, hold: Hold) -> bool:
    """Whether an object is moved as soon as it is taken."""
    spots = source.paths[hold.thing].translation
    soon = min(hold.first + round(AT_ONCE_S * source.rate_hz), hold.last)
    return bool(np.linalg.norm(spots[soon] - spots[hold.first]) > SOON_M)


def _away(hand: RigidTransform, hold: Hold | None) -> Float[np.ndarray, "3"]:
    """Off what a hand holds, along its palm; nowhere where it holds nothing."""
    return np.asarray(hand.rotation.apply([0.0, 0.0, -1.0])) if hold else np.zeros(3)


DETOURS = sorted(
    (Detour(lift, back, off) for lift in HAND_LIFTS_M for back in BACKS_M for off in OFFS_M),
    key=lambda each: each.size,
)


def smallest_detour(short: Callable[[Detour, float], float]) -> Detour:
    """The smallest detour that is clear; if none is, the smallest within ``WORTH_M`` of the best.

    Args:
        short: By how much a path with a detour is too near objects [m], 0 where it is clear. It may
            stop at any value that is not below its second argument [m].
    """
    shorts: dict[Detour, float] = {}
    least = np.inf
    for detour in DETOURS:
        shorts[detour] = short(detour, least + WORTH_M)
        least = min(least, shorts[detour])
        if least <= 0.0:
            return detour
    return next(detour for detour in DETOURS if shorts[detour] < least + WORTH_M)


class _Clearance:
    """How far a hand on its way is from objects, whatever the arm does."""

    def __init__(
        self,
        scene: Scene,
        new: BodyFrames,
        things: Mapping[str, RigidTransform],
        care: Care,
        rate_hz: float,
    ) -> None:
        self.around = Surroundings(new.human, scene)
        self.posture = Solver(new.human, (*scene.place, scene.floor_m), scene.heading).rest
        self.new, self.things, self.care = new, things, care
        self.leaving, self.coming = round(LEAVING_S * rate_hz), round(COMING_S * rate_hz)
        self.stride = max(int(CHECK_S * rate_hz), 1)

    def first_clear(
        self,
        side: str,
        path: Callable[[Detour], RigidTransform],
        first: int,
        touched: set[str],
        held: tuple[bool, bool],
        apart: str,
    ) -> Detour:
        """The smallest detour that is clear; if none is, the smallest about as good as the best.

        Of an object that is moved as soon as it is taken the hand is clear until shortly before.
        """
        return smallest_detour(
            lambda detour, enough: self._short(
                side, path(detour), first, touched, held, apart, enough
            )
        )

    def _short(
        self,
        side: str,
        path: RigidTransform,
        first: int,
        touched: set[str],
        held: tuple[bool, bool],
        apart: str,
        enough: float,
    ) -> float:
        """By how much the path is too near, at worst; not further than is decided [m].

        A hand may be as near as where it hangs at ease, and around a hold as near as there.
        """
        around, margin_m = self._seen_from(side, path, first), self.care.margin_m
        ends = [self._gaps(side, around, k) for k in (0, len(path) - 1)]
        beside = [{name: gap.get(name, margin_m) - 0.001 for name in self.things} for gap in ends]
        resting = [gaps for gaps, holds in zip(beside, held, strict=True) if not holds]
        wanted = {
            near: {name: min([margin_m, *(gaps[name] for gaps in some)]) for name in self.things}
            for near, some in ((True, beside), (False, resting))
        }
        worst = 0.0
        for frame in range(0, len(path), self.stride):
            ahead = len(path) - 1 - frame
            near = min(frame, ahead) <= self.leaving
            for name, gap in self._gaps(side, around, frame).items():
                least = (
                    wanted[near][name]
                    if name not in touched
                    else -HAND_CUT_M
                    if near
                    else self.care.off_m
                )
                if name == apart and ahead > self.coming and frame > self.leaving:
                    least = max(least, COMING_M)
                worst = max(worst, least - gap)
            if worst >= enough:
                break
        return worst

    def _seen_from(
        self, side: str, path: RigidTransform, first: int
    ) -> dict[str, Float[np.ndarray, "frames 7"]]:
        """Where objects are if the scene is moved so that the hand stays at ease."""
        shift, part = self.new.rest[side] * path.inv(), slice(first, first + len(path))
        return {name: vectors(shift * track[part]) for name, track in self.things.items()}

    def _gaps(
        self, side: str, around: Mapping[str, Float[np.ndarray, "frames 7"]], frame: int
    ) -> dict[str, float]:
        """The hand's distance from each object near it."""
        self.around.place(self.posture, {name: rows[frame] for name, rows in around.items()})
        out: dict[str, float] = {}
        for pair in self.around.near([f"{side}_{each}" for each in HAND_SEGMENTS]):
            out[pair.thing] = min(out.get(pair.thing, np.inf), pair.distance_m)
        return out
