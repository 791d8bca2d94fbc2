"""Paths of objects from goal to goal, and of hands from hold to hold, clear of the scene."""

import functools
import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from jaxtyping import Float
from scipy.ndimage import maximum_filter1d, uniform_filter1d
from scipy.spatial.transform import RigidTransform

from capar.body.human import Human
from capar.body.recording import HAND_SEGMENTS
from capar.model.capture import TagType
from capar.regeneration.body_frames import BodyFrames, free_pose
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

BESIDE_M = 0.01  # How far a held object keeps from what stands beside its path [m].
SLACK_M = 0.0005  # How much nearer than at both ends it may come [m].
CUT_M = 0.001  # How much deeper than at both ends it may be inside something [m].
SUNK_M = 0.005  # A recorded object that sinks no deeper into what is fixed does so by error [m].
SPREAD = 9  # Over so many frames it is raised out of it [1].
STEEPEST_M = 0.001  # Nor faster than this from either end of its path [m a frame].
STRIDE = 2  # Frames between two at which a path is checked.

Places = Mapping[str, Float[np.ndarray, "7"]]
"""Where objects are, by name, as ``vectors`` has it."""


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
        still = {n: vectors(pose) for n, pose in others.items()}
        seats = {name: RigidTransform.identity(), **along}
        tried: list[tuple[float, RigidTransform, Detour]] = []
        for detour in (Detour(lift) for lift in LIFTS_M):
            path = mapped(
                part, *ends, turn=turn, detour=detour, heading=self.scene.heading, kind=self.kind
            )
            path = self._out_of_ground(name, path, still)
            short = max(self._short(one, path * seat, still) for one, seat in seats.items())
            tried.append((short, path, detour))
            if short <= 0.0:
                break
        short, path, detour = min(tried, key=lambda row: row[0])
        if short > 0.0:
            for one, seat in seats.items():
                self._check_free(one, path * seat, still)
        return path, detour

    def _out_of_ground(self, name: str, path: RigidTransform, still: Places) -> RigidTransform:
        """The path raised where it sinks a little deeper into something fixed than both ends do.

        Recorded objects do, as they are tipped up: their poses are a few millimetres off.
        """
        things = self.scene.things
        fixed = {n: pose for n, pose in still.items() if things[n].tag is TagType.FIXED}
        gaps = [self._gaps(name, pose, fixed) for pose in vectors(path)]
        usual = {n: min(0.0, gaps[0].get(n, 0.0), gaps[-1].get(n, 0.0)) for n in fixed}
        sunk = np.array([max([0.0, *(usual[n] - gap for n, gap in g.items())]) for g in gaps])
        if not 0.0 < sunk.max() <= SUNK_M:
            return path
        wide = uniform_filter1d(maximum_filter1d(sunk, SPREAD), SPREAD)
        frames = np.arange(len(sunk))
        by_m = np.minimum(wide, STEEPEST_M * np.minimum(frames, frames[::-1]))
        return RigidTransform.from_translation(np.outer(by_m, [0.0, 0.0, 1.0])) * path

    def _check_free(self, name: str, path: RigidTransform, still: Places) -> None:
        """No path leads deeper into something than both of its ends are."""
        gaps = [self._gaps(name, pose, still) for pose in vectors(path)]
        gap, other = min(((gap, n) for g in gaps for n, gap in g.items()), default=(0.0, ""))
        if gap < min(0.0, *(end.get(other, 0.0) for end in (gaps[0], gaps[-1]))) - CUT_M:
            raise PlanError(
                f"{name!r} would go {-1e3 * gap:.0f} mm into {other!r} on its way, however far it "
                "is lifted"
            )

    def _short(self, name: str, path: RigidTransform, still: Places) -> float:
        """By how much it comes too near something, at worst [m]."""
        poses = vectors(path)
        ends = [self._gaps(name, poses[row], still) for row in (0, -1)]
        worst = 0.0
        for pose in poses[::STRIDE]:
            for other, gap in self._gaps(name, pose, still).items():
                least = min(BESIDE_M, *(end.get(other, BESIDE_M) for end in ends))
                worst = max(worst, least - SLACK_M - gap)
        return worst

    def _gaps(self, name: str, pose: Float[np.ndarray, "7"], still: Places) -> dict[str, float]:
        """Distances from the others near it [m]."""
        self.around.place(self.posture, {**still, name: pose})
        pairs = (p for p in self.around.things_near() if name in (p.part, p.thing))
        found = {p.thing if p.part == name else p.part: p.distance_m for p in pairs}
        return {other: gap for other, gap in found.items() if other in still}


@dataclass(frozen=True, eq=False)
class ObjectPaths:
    """The paths of all objects."""

    goals: dict[str, list[Goal]]
    """By name, in order of time."""

    paths: dict[str, RigidTransform]
    """``T_world_thing`` by name at every frame."""

    notes: tuple[str, ...]


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
    beside = {companion.hold.thing for companion in source.co_held}
    loads = (*(companion.load for companion in source.co_held), *source.loads)
    notes = [
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
        poses, own = [still[name]] * count, [] if name in beside else goals.get(name, [])
        for start, goal in itertools.pairwise(own):
            frames = slice(start.frame, goal.frame + 1)
            poses[goal.frame :] = [goal.pose] * (count - goal.frame)
            if goal.frame == start.frame or throw_of(source, name, first=start.frame):
                continue
            if rests(recorded[frames], start.pose, goal.pose):
                poses[frames] = [start.pose] * (goal.frame + 1 - start.frame)
                continue
            part = style.things[name][frames]
            along: dict[str, RigidTransform] = {}
            for load in loads:  # what it bears, what lies in the hand with it, and what these bear
                now = load.first < goal.frame and start.frame < load.last
                if now and (load.bearer == name or load.bearer in along):
                    along[load.thing] = still[load.bearer].inv() * still[load.thing]
            others = {n: pose for n, pose in still.items() if n not in {name, *along}}
            part = flattened(part) if kind == PLANE else part
            piece, detour = carrying.way(name, part, (start.pose, goal.pose), others, turn, along)
            piece = flattened(piece) if kind == PLANE and detour == STRAIGHT else piece
            poses[frames] = list(piece)
            if detour != STRAIGHT:
                notes.append(
                    f"{name!r} is lifted {1e3 * detour.lift_m:.0f} mm over what stands in its way "
                    f"at {source.times[start.frame]:.2f} s"
                )
        for goal in own:
            if goal.on is not None:
                poses[goal.frame : goal.frame + len(goal.on)] = list(goal.on)
        out[name] = with_throws(source, scene, name, RigidTransform.concatenate(poses))
    notes += [
        f"{load.thing!r} goes along with {load.bearer!r} from {source.times[load.first]:.2f} to "
        f"{source.times[load.last]:.2f} s"
        for load in loads
    ]
    return ObjectPaths(goals, with_loads(out, loads), tuple(notes))


def borne_steadily(
    source: Source, scene: Scene, paths: Mapping[str, RigidTransform], load: Load
) -> Steadiness:
    """Whether an object would stay on what bears it along these paths."""
    bearer = paths[load.bearer][load.first : load.last + 1]
    seat = bearer[0].inv() * paths[load.thing][load.first]
    return steadiness(scene.thing(load.thing), seat, bearer, source.rate_hz)


HAND_LIFTS_M = (0.0, 0.04, 0.08, 0.12, 0.18, 0.25, 0.35)
BACKS_M = (0.0, 0.05, 0.1, 0.15, 0.2, 0.3)
OFFS_M = (0.0, 0.003, 0.02, 0.05)  # Detours that are tried [m].

WORTH_M = 0.0005
"""By how much nearer to clear a larger detour must come where none is clear [m].

A smaller gain is not visible, being half the tolerance of 1 mm for a hand at rest; a detour takes
the hand up to 0.7 m off its path, and the performer's style with it.
"""

CHECK_S = 0.02
"""Most time between two frames at which a path is checked, unless frames are farther apart [s]."""

LEAVING_S = 0.3  # So long after it let something go a hand may be near it [s].
HAND_CUT_M = 0.0003  # How far a hand may cut what it is about to hold or has just left [m].


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
    clearance = _Clearance(scene, new, things, care, source.rate_hz)
    out, detours = {}, {}
    for side in source.hands:
        holds = [hold for hold in source.holds if hold.side == side]
        poses: list[RigidTransform] = [new.rest[side]] * len(source.times)
        for hold in holds:
            part = slice(hold.first, hold.last + 1)
            poses[part] = list(things[hold.thing][part] * grips[hold])
        spans = dict(hand_spans(holds, source.co_held))
        for before, after in zip([None, *spans], [*spans, None], strict=True):
            first = before.last if before else 0
            last = after.first if after else len(source.times) - 1
            if last <= first:
                continue
            start, goal = poses[first], poses[last]
            if not before:
                start = free_pose(source, old, new, side, (first, last), goal if after else None)
            if not after:
                held = start if before else None
                goal = free_pose(source, old, new, side, (last, first), held)
            lead = functools.partial(
                mapped,
                style.hands[side][first : last + 1],
                start,
                goal,
                turn=scene.heading - source.scene.heading,
                heading=scene.heading,
                away=(_off(start, before), _off(goal, after)),
                kind=style.kind,
            )
            apart = ""
            if after:  # an object that is moved as soon as it is taken
                spots = source.paths[after.thing].translation
                soon = min(after.first + round(AT_ONCE_S * source.rate_hz), after.last)
                if np.linalg.norm(spots[soon] - spots[after.first]) > SOON_M:
                    apart = after.thing
            short = functools.partial(
                clearance.short, lead, side=side, first=first, apart=apart,
                touched={thing for each in (before, after) if each for thing in spans[each]},
                held=(before is not None, after is not None),
            )  # fmt: skip
            best = smallest_detour(short)
            poses[first : last + 1] = list(lead(detour=best))
            if best != STRAIGHT:
                detours[side, first] = best
        out[side] = RigidTransform.concatenate(poses)
    return out, detours


def _off(hand: RigidTransform, hold: Hold | None) -> Float[np.ndarray, "3"]:
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

    def short(
        self,
        lead: Callable[..., RigidTransform],
        detour: Detour,
        enough: float,
        *,
        side: str,
        first: int,
        touched: set[str],
        held: tuple[bool, bool],
        apart: str,
    ) -> float:
        """By how much the path is too near, at worst; not further than is decided [m].

        A hand may be as near as where it hangs at ease, and around a hold as near as there. Of an
        object that is moved as soon as it is taken it is clear until shortly before.
        """
        path = lead(detour=detour)
        margin_m, last = self.care.margin_m, len(path) - 1
        # Where objects are if the scene is moved so that the hand stays at ease.
        shift, part = (
            self.new.rest[side] * path.inv(),
            slice(first, first + last + 1),
        )
        around = {name: vectors(shift * track[part]) for name, track in self.things.items()}
        ends = [self._gaps(side, around, frame) for frame in (0, last)]
        beside = [{name: gap.get(name, margin_m) - 0.001 for name in self.things} for gap in ends]
        resting = [gaps for gaps, holds in zip(beside, held, strict=True) if not holds]
        wanted = {
            near: {name: min([margin_m, *(gaps[name] for gaps in some)]) for name in self.things}
            for near, some in ((True, beside), (False, resting))
        }
        worst = 0.0
        for frame in range(0, last + 1, self.stride):
            near = min(frame, last - frame) <= self.leaving
            for name, gap in self._gaps(side, around, frame).items():
                least = wanted[near][name]
                if name in touched:
                    least = -HAND_CUT_M if near else self.care.off_m
                if name == apart and last - frame > self.coming and frame > self.leaving:
                    least = max(least, COMING_M)
                worst = max(worst, least - gap)
            if worst >= enough:
                break
        return worst

    def _gaps(
        self, side: str, around: Mapping[str, Float[np.ndarray, "frames 7"]], frame: int
    ) -> dict[str, float]:
        """The hand's distance from each object near it."""
        self.around.place(self.posture, {name: rows[frame] for name, rows in around.items()})
        out: dict[str, float] = {}
        for pair in self.around.near([f"{side}_{each}" for each in HAND_SEGMENTS]):
            out[pair.thing] = min(out.get(pair.thing, np.inf), pair.distance_m)
        return out
