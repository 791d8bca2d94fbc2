"""Where hands are throughout: on what they hold, and in between on paths clear of the scene."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.body.recording import HAND_SEGMENTS
from capar.regeneration.body_frames import BodyFrames, free_pose, rest_pose
from capar.regeneration.collisions import Surroundings
from capar.regeneration.companions import hand_spans
from capar.regeneration.path_mapping import STRAIGHT, Detour, mapped
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver, vectors
from capar.regeneration.sources import Hold, Source
from capar.regeneration.styles import Style

LIFTS_M = (0.0, 0.04, 0.08, 0.12, 0.18, 0.25, 0.35)
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

CUT_M = 0.0003
"""How far a hand may cut what it is about to hold or has just left [m]."""


AT_ONCE_S, SOON_M = 0.15, 0.005
"""A thing that is moved so far within that time of being taken is moved at once [s, m]."""

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
        spans = dict(hand_spans(holds, source.companions))
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
                return mapped(
                    part,
                    *ends,
                    turn=turn,
                    detour=detour,
                    heading=scene.heading,
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
    """Whether a thing is moved as soon as it is taken."""
    spots = source.paths[hold.thing].translation
    soon = min(hold.first + round(AT_ONCE_S * source.rate_hz), hold.last)
    return bool(np.linalg.norm(spots[soon] - spots[hold.first]) > SOON_M)


def _away(hand: RigidTransform, hold: Hold | None) -> Float[np.ndarray, "3"]:
    """Off what a hand holds, along its palm; nowhere where it holds nothing."""
    return np.asarray(hand.rotation.apply([0.0, 0.0, -1.0])) if hold else np.zeros(3)


DETOURS = sorted(
    (Detour(lift, back, off) for lift in LIFTS_M for back in BACKS_M for off in OFFS_M),
    key=lambda each: each.size,
)


def smallest_detour(short: Callable[[Detour, float], float]) -> Detour:
    """The smallest detour that is clear; if none is, the smallest within ``WORTH_M`` of the best.

    Args:
        short: By how much a path with a detour is too near things [m], 0 where it is clear. It may
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
    """How far a hand on its way is from things, whatever the arm does."""

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

        Of a thing that is moved as soon as it is taken the hand is clear until shortly before.
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
                    else -CUT_M
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
        """Where things are if the scene is moved so that the hand stays at ease."""
        shift, part = self.new.rest[side] * path.inv(), slice(first, first + len(path))
        return {name: vectors(shift * track[part]) for name, track in self.things.items()}

    def _gaps(
        self, side: str, around: Mapping[str, Float[np.ndarray, "frames 7"]], frame: int
    ) -> dict[str, float]:
        """The hand's distance from each thing near it."""
        self.around.place(self.posture, {name: rows[frame] for name, rows in around.items()})
        out: dict[str, float] = {}
        for pair in self.around.near([f"{side}_{each}" for each in HAND_SEGMENTS]):
            out[pair.thing] = min(out.get(pair.thing, np.inf), pair.distance_m)
        return out
