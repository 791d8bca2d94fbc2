"""Steps of the whole body to where an action can be done, and their gates."""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

import mink
import mujoco
import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.body.inverse_kinematics import Solver as Steps
from capar.body.inverse_kinematics import support
from capar.body.scripts import SIDES, minimum_jerk
from capar.model.geometry import runs
from capar.regeneration.collisions import NEAR_M, Pair, Surroundings
from capar.regeneration.quality import (
    NONE,
    Gate,
    Quality,
    distance_gate,
    failures,
    is_hand,
    joint_gates,
    within,
    worst_of,
)
from capar.regeneration.scenes import PlanError, Scene
from capar.regeneration.search import beside, check_stance, is_possible, why_unreachable
from capar.regeneration.solving import DAMPING_COST, FrameLimit, vectors
from capar.regeneration.solving import Solver as Standing
from capar.regeneration.sources import Source
from capar.regeneration.styles import Style

STRIDE = 0.16
"""How far a foot goes in a step at most [share of stature] (estimate: half a usual step)."""

RISE_M = 0.05  # How high a foot is lifted [m].

SHIFT_S, SWING_S, STAND_S = 0.7, 0.7, 0.5
"""How long the weight is shifted to a foot, the other one is moved, and both stand before and
after [s]."""

FOOT_COST, MASS_COST, UPRIGHT_COST = 240.0, 60.0, 4.0
"""Weights of a metre and a radian at the feet, of a metre of the centre of mass, and of a radian
of the pelvis."""

EASE_COSTS = (0.1, 5.0)
"""Weights of a radian from standing at ease: of the legs, and of all else [1/rad]."""

LEGS = ("hip", "knee", "ankle", "toe")  # What the names of the legs' joints hold.
ITERATIONS = 12  # Steps of inverse kinematics a frame at most [1].


Place = tuple[float, float]
"""Where somebody stands [m]."""


@dataclass(frozen=True)
class Stride:
    """A step of one foot."""

    side: str
    by: tuple[float, float]
    """How far it goes in the world [m]."""


@dataclass(frozen=True, eq=False)
class Stepping:
    """A body that steps from one place to another."""

    human: Human
    scene: Scene
    """Where it stands at first, and the objects."""

    goal: Place
    """Where it stands in the end [m]."""

    strides: tuple[Stride, ...]
    times: Float[np.ndarray, "frames"]
    """[s]."""

    postures: Float[np.ndarray, "frames posture"]
    bears: dict[str, Bool[np.ndarray, "frames"]]
    """By side, whether a foot bears weight."""


def _count(human: Human, far_m: float) -> int:
    """How many steps of each foot, at most ``STRIDE`` long, lead so far."""
    return max(int(np.ceil(far_m / (STRIDE * human.measures["stature"]) - 1e-9)), 1)


def step_to(human: Human, scene: Scene, goal: Place, *, rate_hz: float = 30.0) -> Stepping:
    """Step straight to another place [m] in the fewest steps, facing the same way.

    Each foot comes beside the other; the one on the side to which it goes steps first, else the
    right one.
    """
    x, y = np.asarray(goal) - scene.place
    count = _count(human, float(np.hypot(x, y)))
    left = -np.sin(scene.heading) * x + np.cos(scene.heading) * y
    order = ("left", "right") if left > 1e-6 else ("right", "left")
    strides = tuple(Stride(side, (x / count, y / count)) for _ in range(count) for side in order)
    body = _Stepper(human, scene, 1.0 / rate_hz)
    body.shift(body.spot, STAND_S)
    for stride in strides:
        body.shift(body.over(SIDES[1 - SIDES.index(stride.side)]), SHIFT_S)
        body.swing(stride, SWING_S)
    body.shift(np.asarray(goal) + body.ahead, SHIFT_S)
    body.shift(body.spot, STAND_S)
    times = np.arange(len(body.postures)) / rate_hz
    bears = {side: np.array(rows) for side, rows in body.bears.items()}
    return Stepping(human, scene, goal, strides, times, np.array(body.postures), bears)


class _Stepper:
    """Inverse kinematics of feet, the centre of mass and an upright pelvis, frame by frame."""

    def __init__(self, human: Human, scene: Scene, step_s: float) -> None:
        self.human, self.step_s = human, step_s
        standing = Standing(human, (*scene.place, scene.floor_m), scene.heading)
        self.configuration = standing.configuration
        self.feet = {s: mink.FrameTask(f"{s}_foot", "body", FOOT_COST, FOOT_COST) for s in SIDES}
        self.mass = mink.ComTask(cost=[MASS_COST, MASS_COST, 0.0])
        pelvis = mink.FrameTask("pelvis", "body", 0.0, UPRIGHT_COST)
        legs, others = EASE_COSTS
        own = [legs if any(part in joint for part in LEGS) else others for joint in human.joints]
        ease = mink.PostureTask(human.model, cost=np.array([*np.zeros(6), *own]))
        ease.set_target(standing.rest)
        for frame in (*self.feet.values(), pelvis):
            frame.set_target_from_configuration(self.configuration)
        self.mass.set_target_from_configuration(self.configuration)
        self.poses = {}
        for side in SIDES:
            foot = self.configuration.get_transform_frame_to_world(f"{side}_foot", "body")
            turn = Rotation.from_quat(foot.rotation().wxyz, scalar_first=True)
            self.poses[side] = RigidTransform.from_components(foot.translation(), turn)
        self.spot = np.array(self.configuration.data.subtree_com[1, :2])
        self.ahead = self.spot - scene.place
        """Where the centre of mass is from the middle of a standing place [m]."""

        self.limit = FrameLimit(len(human.joints))
        slow = mink.DampingTask(human.model, cost=DAMPING_COST)
        tasks = [*self.feet.values(), self.mass, pelvis, ease, slow]
        self.steps = Steps(human, tasks, longest_rad=0.15, limits=[self.limit])
        self.limit.bound(step_s)
        self.postures: list[np.ndarray] = []
        self.bears: dict[str, list[bool]] = {side: [] for side in SIDES}

    def over(self, side: str) -> Float[np.ndarray, "2"]:
        """Above the middle of a foot's sole [m]."""
        return support(self.human, {side: self.poses[side]}).middle

    def shift(self, spot: Float[np.ndarray, "2"], seconds: float) -> None:
        """Bring the centre of mass above a spot, both feet bearing."""
        start, count = self.spot, round(seconds / self.step_s)
        for number in range(count):
            self.spot = start + minimum_jerk((number + 1) / count) * (spot - start)
            self.frame()

    def swing(self, stride: Stride, seconds: float) -> None:
        """Lift a foot, move it and set it down."""
        start, count = self.poses[stride.side], round(seconds / self.step_s)
        for number in range(count):
            share = (number + 1) / count
            way, rise = minimum_jerk(share), RISE_M * np.sin(np.pi * share) ** 2
            by = [way * stride.by[0], way * stride.by[1], rise]
            self.poses[stride.side] = RigidTransform.from_translation(by) * start
            self.frame("" if number + 1 == count else stride.side)

    def frame(self, swings: str = "") -> None:
        """Go on to one frame, a foot being in the air."""
        for side, task in self.feet.items():
            task.set_target(mink.SE3(vectors(self.poses[side])))
        self.mass.set_target(np.array([*self.spot, 0.0]))
        self.limit.begin()
        self.steps.restart()
        for _ in range(ITERATIONS):
            self.limit.gone += self.steps.step(self.configuration)
            if self.steps.settled:
                break
        self.postures.append(np.array(self.configuration.q))
        for side in SIDES:
            self.bears[side].append(side != swings)


INSIDE_MM = 10.0  # How far inside the soles that bear it the centre of mass stays [mm].


def stepping_quality(made: Stepping) -> Quality:
    """Verify steps at every frame."""
    model = made.human.model
    data, inside = mujoco.MjData(model), []
    feet = {}
    for name, (spots, turns) in made.human.sites(
        made.postures, [f"{side}_foot" for side in SIDES]
    ).items():
        turn = Rotation.from_quat(turns, scalar_first=True)
        feet[name.removesuffix("_foot")] = RigidTransform.from_components(spots, turn)
    slid, missed, last = [NONE], [NONE], len(made.times) - 1
    for side, path in feet.items():
        spots = path.translation
        for first, end in runs(made.bears[side]):
            off = np.linalg.norm(spots[first : end + 1] - spots[first], axis=1)
            slid.append(worst_of(off, f"{side}_foot", first))
        gone = spots[-1] - spots[0] - [*(np.asarray(made.goal) - made.scene.place), 0.0]
        missed.append((float(np.linalg.norm(gone)), last, f"{side}_foot"))
    for frame, posture in enumerate(made.postures):
        data.qpos[:] = posture
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        soles = {side: path[frame] for side, path in feet.items() if made.bears[side][frame]}
        inside.append(-float(support(made.human, soles).outside(data.subtree_com[1, :2])))
    worst = int(np.argmin(inside))
    rate_hz = 1.0 / float(made.times[1] - made.times[0])
    return Quality(
        (
            within("foot that bears", max(slid), 3.0),
            within("foot comes there", max(missed), 3.0),
            Gate("balance", 1e3 * inside[worst], INSIDE_MM, "mm", True, worst),
            *_contact_gates(made),
            *joint_gates(made.human, made.postures, rate_hz),
        )
    )


def _contact_gates(made: Stepping) -> list[Gate]:
    """Penetration of anything, and how far hands keep from what they do not touch."""
    around = Surroundings(made.human, made.scene)
    things = {name: vectors(thing.pose) for name, thing in made.scene.things.items()}
    near: list[tuple[Pair, int]] = []
    for frame, posture in enumerate(made.postures):
        around.place(posture, things)
        near += [(pair, frame) for pair in around.near()]
    far = (Pair(NEAR_M, "", ""), -1)
    hands = [found for found in near if is_hand(found[0].part)]
    return [
        distance_gate("penetration", -1.0, min([far, *near])),
        distance_gate("free hand clear", 10.0, min([far, *hands])),
    ]


GRID_M = 0.1
AHEAD, ASIDE = range(-3, 11), range(-5, 6)
"""The places that are considered, from the given one ahead and to the left [grid steps]."""

FARTHEST_M = GRID_M * AHEAD[-1]  # How far ahead it is stepped at most [m].

REACH, HIGHEST = 0.62, 1.3
"""No posture reaches the middle of an object farther away on the floor, or higher above it
[share of stature] (estimate)."""

MOST_TRIES = 6  # So many places are tried of those that are as many steps away [1].
MOST_NAMED = 3  # So many of them are named where none helps [1].

Made = TypeVar("Made")


@dataclass(frozen=True, eq=False)
class Approach:
    """Steps that prepare an action."""

    why: str
    """Why they are needed."""

    steps: Stepping
    quality: Quality
    ahead_m: float
    aside_m: float
    """How far ahead and to the left they lead."""

    tried: tuple[str, ...]
    """Other places, and why the action is not possible there."""


def approached(
    source: Source,
    human: Human,
    scene: Scene,
    style: Style,
    act: Callable[[Scene], tuple[Made, Quality]],
) -> tuple[Approach | None, Made, Quality]:
    """Perform an action where it can be done, after as few steps there as possible.

    ``act`` performs it in a scene, and raises PlanError where that is not possible. The steps are
    None where none is needed.

    Raises:
        PlanError: The performer stands in something, or it is out of reach and no step helps.
    """
    check_stance(scene, human)
    why = _beyond(source, human, scene) or why_unreachable(source, scene, human, style)
    if not why:
        return None, *act(replace(scene, stays=True))
    tried: list[str] = []
    for ahead_m, aside_m in _places(source, human, scene):
        there = replace(beside(scene, ahead_m, aside_m), stays=True)
        failed = "out of reach"
        if is_possible(source, there, human):
            walked = step_to(human, scene, there.place, rate_hz=source.rate_hz)
            gates = stepping_quality(walked)
            failed = f"the steps there fail {failures(gates)}"
            if gates.passed:
                try:
                    made, quality = act(there)
                except PlanError as error:
                    failed = str(error)
                else:
                    if quality.passed:
                        found = Approach(why, walked, gates, ahead_m, aside_m, tuple(tried))
                        return found, made, quality
                    failed = f"it fails {failures(quality)}"
        tried.append(f"{ahead_m:+.1f} m ahead and {aside_m:+.1f} m to the left: {failed}")
    if not tried:
        raise PlanError(f"{why}; no step helps, since nothing nearer is free or it is too high")
    some = "; ".join(tried[:MOST_NAMED]) + ("; and so on" if len(tried) > MOST_NAMED else "")
    raise PlanError(f"{why}; no step helps of {len(tried)} places that were tried ({some})")


def _places(source: Source, human: Human, scene: Scene) -> Iterator[tuple[float, float]]:
    """Places ahead and to the left [m], those of the fewest steps first, ``MOST_TRIES`` of each.

    Of equally few, those by which the performer stands by the objects as the recorded one did.
    Somebody at ease stands in nothing there, and nothing that is taken is beyond every posture.
    """
    around = Surroundings(human, scene)
    posture = Standing(human, (*scene.place, scene.floor_m), scene.heading).rest
    poses = {name: thing.pose for name, thing in scene.things.items()}
    names = [hold.thing for hold in source.holds]
    old, new = (
        np.mean([one.thing(name).place for name in names], axis=0)[:2]
        for one in (source.scene, scene)
    )
    away = (old - source.scene.place) * human.measures["stature"] / source.human.measures["stature"]
    turn = Rotation.from_euler("z", scene.heading - source.scene.heading)
    wish, tries = new - turn.apply([*away, 0.0])[:2], Counter[int]()
    rows = []
    for spot in ((GRID_M * ahead, GRID_M * aside) for ahead in AHEAD for aside in ASIDE):
        place = beside(scene, *spot).place
        steps, off = _count(human, float(np.hypot(*spot))), np.subtract(place, wish)
        rows.append((steps, round(1e3 * float(np.linalg.norm(off))), spot))
    for steps, _, spot in sorted(rows):
        there = beside(scene, *spot)
        if spot == (0.0, 0.0) or tries[steps] == MOST_TRIES or _beyond(source, human, there):
            continue
        standing = posture.copy()
        standing[:2] += np.subtract(there.place, scene.place)
        around.pose(standing, poses)
        if all(pair.distance_m >= 0.0 for pair in around.near()):
            tries[steps] += 1
            yield spot


def _beyond(source: Source, human: Human, scene: Scene) -> str:
    """What is handled farther away or higher than any posture reaches, in words; empty if none."""
    tall = human.measures["stature"]
    for name in dict.fromkeys(hold.thing for hold in source.holds):
        place = np.asarray(scene.thing(name).place)
        far_m = float(np.linalg.norm(place[:2] - scene.place))
        high_m = float(place[2]) - scene.floor_m
        more_m = far_m - REACH * tall
        if more_m > 0.0:
            return (
                f"{name!r} is {far_m:.1f} m away, {more_m:.1f} m farther than any posture reaches"
            )
        if high_m > HIGHEST * tall:
            return f"{name!r} is {high_m:.1f} m above the floor, higher than any posture reaches"
    return ""
