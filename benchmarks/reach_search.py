"""Another way to find out whether a body can do what the planner refused.

It shares with the planner what is asked for: goals, the frames that are tried, how exactly they
have to be reached, and what counts as penetration. It does not share how that is found: postures
come from Levenberg-Marquardt steps from random starts, grips and standing places are drawn from
whole ranges instead of lists. Feet stay, as the planner assumes. What it solves may still be
impossible to go through in one motion, so that it is rather too severe with the planner.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import ROOT_SIZE, Human
from capar.body.scripts import SIDES
from capar.regeneration.grips import Grip, Turn, is_round
from capar.regeneration.planning import CUT_M, REACH_M, REACH_RAD, Draft, check_stance
from capar.regeneration.scenes import PlanError, Scene
from capar.regeneration.solving import Solver
from capar.regeneration.sources import Source
from capar.regeneration.styles import own_style

PLACES, GRIPS, STARTS = 10, 6, 15
"""Standing places, grips in each, and starts of each posture that are tried."""

NEARBY_M = 0.2
"""How far from the given place it may stand, as the planner has it [m]."""

YAW, PITCH, TILT = 1.05, 0.5, 0.3
"""Largest turns of a grip [rad]."""

FOOT_M = 0.002
"""How far a foot may be from where it stood [m]; about as far as the gate allows."""

LEAN_M = 0.08
"""How far the centre of mass may come from where it is when standing [m]."""

SWAY_M = 0.1
"""How far the pelvis is drawn from where it is when standing [m]."""

HEAD_M = 0.0009
"""How far the head may be from where a thing meets it [m]."""

EVALUATIONS = 60
"""Most evaluations of one posture."""

LARGEST_STEP = 0.4
"""Largest step of a hinge [rad] or of the pelvis [m]."""


@dataclass(frozen=True)
class Found:
    """Whether postures were found that do all that was asked for."""

    solved: bool
    sentence: str


def search(source: Source, scene: Scene, human: Human, seed: int = 1) -> Found:
    """Look for a standing place, grips and postures that reach every key goal."""
    rng = np.random.default_rng(seed)
    furthest, tried, impossible = 0.0, 0, ""
    for number in range(PLACES):
        nearby = scene if number == 0 or scene.stays else _beside(scene, rng)
        try:
            check_stance(nearby, human)
            draft = Draft(source, nearby, human, own_style(source))
        except PlanError as error:
            impossible = str(error)
            continue
        postures = Postures(human, nearby)
        for attempt in range(GRIPS):
            tried += 1
            turn = Turn() if attempt == 0 else _turn(draft, rng)
            share = _share(draft, postures, turn, rng)
            furthest = max(furthest, share)
            if share == 1.0:
                x, y = nearby.place
                return Found(True, f"but a search does it standing at ({x:.2f}, {y:.2f}) m")
    if not tried:
        return Found(False, f"no posture was searched, for wherever it stands: {impossible}")
    return Found(
        False, f"a search of {tried} places and grips comes to {furthest:.0%} of the key postures"
    )


class Postures:
    """Postures of a body that stands somewhere, from anywhere."""

    def __init__(self, human: Human, scene: Scene) -> None:
        solver = Solver(human, (*scene.place, scene.floor_m), scene.heading)
        self.human, self.model, self.rest = human, human.model, solver.rest
        self.data = mujoco.MjData(self.model)
        self._pose(self.rest)
        parts = [f"{side}_foot" for side in SIDES]
        self.feet = {part: self._pose_of(self.data.body(part)) for part in parts}
        self.centre = np.array(self.data.subtree_com[0][:2])
        self.low, self.high = human.ranges.T

    def find(
        self,
        palms: Mapping[str, RigidTransform],
        head: Float[np.ndarray, "3"] | None,
        start: Float[np.ndarray, "posture"],
    ) -> tuple[Float[np.ndarray, "posture"], bool]:
        """The posture nearest to what is asked for from a start, and whether it does it."""
        posture, damping = start.copy(), 1.0
        residuals, jacobian = self._errors(posture, palms, head)
        for _ in range(EVALUATIONS):
            step = self._step(posture, residuals, jacobian, damping)
            tried = posture.copy()
            mujoco.mj_integratePos(self.model, tried, step, 1.0)
            tried[ROOT_SIZE:] = np.clip(tried[ROOT_SIZE:], self.low, self.high)
            errors = self._errors(tried, palms, head)
            if errors[0] @ errors[0] < residuals @ residuals:
                posture, (residuals, jacobian) = tried, errors
                damping = max(0.3 * damping, 1e-4)
                if self._does(palms, head):
                    return posture, True
            else:
                damping *= 4.0
                if damping > 1e8:
                    break
        return posture, False

    def random(self, rng: np.random.Generator) -> Float[np.ndarray, "posture"]:
        """Legs about as when standing, everything else half-way from ease to anywhere."""
        out = self.rest.copy()
        drawn = rng.uniform(self.low, self.high)
        legs = [any(n in j for n in ("hip", "knee", "ankle", "toe")) for j in self.human.joints]
        eased = out[ROOT_SIZE:]
        out[ROOT_SIZE:] = np.where(legs, eased, 0.5 * (eased + drawn))
        out[:3] += rng.uniform(-SWAY_M, SWAY_M, 3)
        return out

    def _step(
        self,
        posture: Float[np.ndarray, "posture"],
        residuals: Float[np.ndarray, "rows"],
        jacobian: Float[np.ndarray, "rows dofs"],
        damping: float,
    ) -> Float[np.ndarray, "dofs"]:
        """A Levenberg-Marquardt step; hinges at the end of their range stay there."""
        gradient = jacobian.T @ residuals
        angles = posture[ROOT_SIZE:]
        stuck = ((angles <= self.low) & (gradient[6:] > 0.0)) | (
            (angles >= self.high) & (gradient[6:] < 0.0)
        )
        free = np.flatnonzero(np.concatenate([np.ones(6, dtype=bool), ~stuck]))
        part = jacobian[:, free]
        step = np.zeros(len(gradient))
        step[free] = -np.linalg.solve(part.T @ part + damping * np.eye(len(free)), gradient[free])
        return step * min(1.0, LARGEST_STEP / max(float(np.abs(step).max()), 1e-9))

    def _pose(self, posture: Float[np.ndarray, "posture"]) -> None:
        self.data.qpos[:] = posture
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)

    @staticmethod
    def _pose_of(part: Any) -> RigidTransform:
        turn = Rotation.from_matrix(np.array(part.xmat).reshape(3, 3))
        return RigidTransform.from_components(np.array(part.xpos), turn)

    def _errors(
        self,
        posture: Float[np.ndarray, "posture"],
        palms: Mapping[str, RigidTransform],
        head: Float[np.ndarray, "3"] | None,
    ) -> tuple[Float[np.ndarray, "rows"], Float[np.ndarray, "rows dofs"]]:
        """What is missed, in units of what is allowed, and its derivatives."""
        self._pose(posture)
        errors, slopes = [], []
        places, turns = (np.empty((3, self.model.nv)) for _ in range(2))
        for part, goal, is_site in self._goals(palms):
            jac = mujoco.mj_jacSite if is_site else mujoco.mj_jacBody
            jac(self.model, self.data, places, turns, part.id)
            metres, radians = _off(self._pose_of(part), goal)
            errors += [metres / REACH_M, radians / REACH_RAD]
            slopes += [places / REACH_M, turns / REACH_RAD]
        if head is not None:
            eyes = self.data.site("between_eyes")
            mujoco.mj_jacSite(self.model, self.data, places, None, eyes.id)
            errors.append((eyes.xpos - head) / HEAD_M)
            slopes.append(places / HEAD_M)
        mujoco.mj_jacSubtreeCom(self.model, self.data, places, 0)
        off = self.data.subtree_com[0][:2] - self.centre
        beyond = np.maximum(np.abs(off) - 0.75 * LEAN_M, 0.0)
        errors.append(np.sign(off) * beyond / FOOT_M)
        slopes.append(np.where(beyond > 0.0, 1.0, 0.0)[:, None] * places[:2] / FOOT_M)
        return np.concatenate(errors), np.concatenate(slopes)

    def _goals(
        self, palms: Mapping[str, RigidTransform]
    ) -> Iterator[tuple[Any, RigidTransform, bool]]:
        for side, goal in palms.items():
            yield self.data.site(f"{side}_palm"), goal, True
        for name, goal in self.feet.items():
            yield self.data.body(name), goal, False

    def _does(
        self, palms: Mapping[str, RigidTransform], head: Float[np.ndarray, "3"] | None
    ) -> bool:
        """Whether the posture that was measured last does what is asked for."""
        for part, goal, is_site in self._goals(palms):
            metres, radians = (float(np.linalg.norm(e)) for e in _off(self._pose_of(part), goal))
            if metres > (REACH_M if is_site else FOOT_M) or (is_site and radians > REACH_RAD):
                return False
        lean = float(np.abs(self.data.subtree_com[0][:2] - self.centre).max())
        off = 0.0 if head is None else self.data.site("between_eyes").xpos - head
        return lean <= LEAN_M and float(np.linalg.norm(off)) <= HEAD_M


def _off(
    first: RigidTransform, second: RigidTransform
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """How far, and how it is turned, in the world [m, rad]."""
    metres = first.translation - second.translation
    return metres, (first.rotation * second.rotation.inv()).as_rotvec()


def _share(draft: Draft, postures: Postures, turn: Turn, rng: np.random.Generator) -> float:
    """How many of the key frames, in their order, are reached without penetration [1]."""
    grips = [draft.gripping.grip(hold, turn) for hold in draft.source.holds]
    keys = sorted({f for hold in draft.source.holds for f in draft.key_frames([hold])})
    last = postures.rest
    for done, frame in enumerate(keys):
        palms = {
            g.hold.side: draft.things[g.hold.thing][frame] * g.pose * draft.new.palms[g.hold.side]
            for g in grips
            if g.hold.first <= frame <= g.hold.last
        }
        head = draft.head.translation[frame] if draft.firmness[frame] > 0.99 else None
        starts = [last, *(postures.random(rng) for _ in range(STARTS))]
        for start in starts:
            found, does = postures.find(palms, head, start)
            if does and _clear(draft, grips, found, frame):
                last = found
                break
        else:
            return done / len(keys)
    return 1.0


def _clear(
    draft: Draft, grips: list[Grip], posture: Float[np.ndarray, "posture"], frame: int
) -> bool:
    pair = draft.deepest_cut(posture, grips, frame)
    return pair is None or pair.distance_m >= -CUT_M


def _turn(draft: Draft, rng: np.random.Generator) -> Turn:
    thing = draft.scene.thing(draft.source.holds[0].thing)
    yaw = float(rng.uniform(-YAW, YAW)) if is_round(thing.shape) else 0.0
    return Turn(yaw, float(rng.uniform(-PITCH, PITCH)), float(rng.uniform(-TILT, TILT)))


def _beside(scene: Scene, rng: np.random.Generator) -> Scene:
    x, y = rng.uniform(-NEARBY_M, NEARBY_M, 2) + np.asarray(scene.place)
    return replace(scene, place=(float(x), float(y)))
