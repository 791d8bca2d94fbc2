"""Inverse kinematics of a body that follows points: joints, key points or markers."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

import mink
import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial.transform import Rotation

from capar.body.flat_feet import DirectionTask, GroundTask, UprightTask
from capar.body.human import Human
from capar.body.point_task import PointTask
from capar.body.sensor_following import LARGEST_STEP, SOLVER
from capar.model.errors import CaparError
from extractors.readers.body_names.body_names import SIDES, parts, without_side
from extractors.readers.body_names.conventions import Convention

BENT = {"elbow_flexion": 0.4, "knee_flexion": 0.1, "hip_flexion": 0.05}
"""Where the search begins [rad]: a straight limb does not tell which way it bends."""

POINT_COST = 10.0
EASE_COST = 0.05
"""Weight of a radian away from standing."""

SPINE_EASE_COST = 0.5
"""... of a hinge of spine, neck and shoulder girdle: few points see so many hinges, which
would bend to and fro for millimetres."""

SPINE = ("lumbar", "thorax", "neck", "head", "clavicle")
"""What names of such hinges begin with, without their side."""

DAMPING_COST = 0.3
"""Points slightly out of reach would throw a straight limb about: large damping keeps it calm."""

FLAT_COST = 2.0
"""Weight of a radian of a foot's tilt while it stands flat."""

SOLE_COST = 5.0
"""Weight of a metre of its sole's height above the ground."""

STANCE_COST = 0.3
"""Weight of a radian of tilt of the pelvis, and of the feet, where no leg is seen."""

PLANTED_COST = 0.5
"""Weight of a metre of such a foot from where it stands."""

HANGING_COST = 0.5
"""Weight of a radian by which the upper arm of an unseen arm does not hang straight down."""

GROUND_COST = 20.0
"""Weight of a metre by which a heel or toes are in the ground."""

SOLE_PLACES = ("heel", "second_metatarsal", "toe_tip")
SOLE_SHARE = 0.7
"""Share of the height of such places above the sole that they keep above the ground [1]: a foot
that rolls over its heel or toes has them nearer to it."""

FACE_COST = 3.0
"""Weight of a radian between the face and where it looks, as of a sensor's orientation."""

HEAD_COST = 1.5
"""Weight of a radian by which an unseen head is not upright: who leans looks ahead all the same."""

ROAMING_M = 0.5
"""Who goes further than this on unseen legs is not taken to stand on one spot [m]."""

SETTLING = 80
ITERATIONS = 3


class SkeletonError(CaparError):
    """Points that no body can be fitted to."""


@dataclass(frozen=True)
class Guidance:
    """What is known of a body besides where points of it are."""

    flat: Mapping[str, Bool[np.ndarray, "frames"]] = field(default_factory=dict)
    """By side, when a foot stands flat."""

    ground_m: float | None = None
    """Height of the ground on which they do [m]."""

    faces: Float[np.ndarray, "frames 3"] | None = None
    """Where the face looks, as directions in the world [1]; NaN where that is not known."""

    ease: float = 1.0
    """How much more than usual the standing posture counts [1]."""

    def at(self, frames: Int[np.ndarray, "some"]) -> "Guidance":
        """The same for some of the frames."""
        flat = {side: when[frames] for side, when in self.flat.items()}
        return replace(self, flat=flat, faces=None if self.faces is None else self.faces[frames])


def followed(
    human: Human,
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    places: Mapping[str, str],
    convention: Convention,
    guidance: Guidance,
) -> Float[np.ndarray, "frames posture"]:
    """Postures of a body whose places are drawn to points.

    Args:
        human: The body.
        points: By name [m]; NaN where lost.
        places: Site or segment of the body for each of them.
        convention: How much each place counts.
        guidance: What else is known.

    Raises:
        SkeletonError: There are never three points at once.
    """
    costs = [POINT_COST * convention.weight(place) for place in places.values()]
    targets = np.stack([points[name] for name in places], axis=1)
    seen = np.isfinite(targets).all(axis=2) & (np.array(costs) > 0.0)
    best = int(np.argmax(seen.sum(axis=1)))
    start = _start(human, points, places, best)
    task = PointTask(human.model, list(places.values()), costs)
    ease = mink.PostureTask(human.model, cost=guidance.ease * _ease_costs(human))
    ease.set_target(start)
    feet = {side: _Foot(human, side, guidance.ground_m) for side in guidance.flat}
    tasks = [task, ease, mink.DampingTask(human.model, cost=DAMPING_COST)]
    tasks += [one for foot in feet.values() for one in foot.tasks]
    segments = {segment_of(human, place) for place in places.values()}
    tasks += _hanging(segments) + _above_ground(human, guidance.ground_m)
    face = DirectionTask("head", (1.0, 0.0, 0.0), FACE_COST)
    tasks += [] if guidance.faces is None else [face]
    if not any(_on_leg(segment) for segment in segments):
        tasks += _stance(human, start, roams=_roams(targets))
    speeds = dict.fromkeys(human.joints, LARGEST_STEP)
    limits = [mink.ConfigurationLimit(human.model), mink.VelocityLimit(human.model, speeds)]
    configuration = mink.Configuration(human.model)
    out = np.empty((len(seen), len(start)))
    for frames in (range(best, len(out)), range(best - 1, -1, -1)):
        configuration.update(start if frames.step == 1 else out[best])
        for frame in frames:
            task.aim(targets[frame])
            for side, foot in feet.items():
                foot.trust(float(guidance.flat[side][frame]))
            if guidance.faces is not None:
                face.trust(float(np.isfinite(guidance.faces[frame]).all()))
                face.aim(np.nan_to_num(guidance.faces[frame]))
            for _ in range((ITERATIONS if frame != best else SETTLING) * bool(seen[frame].any())):
                step = mink.solve_ik(configuration, tasks, 1.0, SOLVER, limits=limits)
                configuration.integrate_inplace(step, 1.0)
            out[frame] = configuration.q
    return out


class _Foot:
    """Tasks of a foot while it stands: flat, and on the ground where its height is known."""

    def __init__(self, human: Human, side: str, ground_m: float | None) -> None:
        self._level = UprightTask(f"{side}_foot", FLAT_COST)
        self.tasks: list[mink.Task] = [self._level]
        self._height: mink.FrameTask | None = None
        if ground_m is not None:
            self._height = mink.FrameTask(f"{side}_foot", "body", 0.0, 0.0)
            ankle = [0.0, 0.0, ground_m + human.measures["ankle_height"]]
            self._height.set_target(mink.SE3.from_translation(np.array(ankle)))
            self.tasks.append(self._height)

    def trust(self, share: float) -> None:
        """Let both count by a share of their weight [1]."""
        self._level.trust(share)
        if self._height is not None:
            self._height.set_position_cost([0.0, 0.0, share * SOLE_COST])


def segment_of(human: Human, place: str) -> str:
    """The segment of the body that a place is on; a segment is its own."""
    site = next((s for s in range(human.model.nsite) if human.model.site(s).name == place), -1)
    return place if site < 0 else str(human.model.body(human.model.site_bodyid[site]).name)


def _on_leg(segment: str) -> bool:
    """Whether a segment is of a leg; where a thigh begins is the pelvis's to say."""
    joint = without_side(segment)
    return joint != "thigh" and parts().get(joint) in {"thigh", "shank", "foot"}


def _hanging(segments: Collection[str]) -> list[mink.Task]:
    """Tasks that let arms hang and keep a head upright of which nothing is seen.

    They do so whichever way the trunk leans.
    """
    arms: list[mink.Task] = [
        UprightTask(f"{side}_upper_arm", HANGING_COST)
        for side in SIDES
        if not {f"{side}_{name}" for name in ("forearm", "hand")} & set(segments)
    ]
    head = [] if {"head", "neck"} & set(segments) else [UprightTask("head", HEAD_COST)]
    return [*arms, *head]


def _above_ground(human: Human, ground_m: float | None) -> list[mink.Task]:
    """A task that keeps heels and toes out of the ground, where its height is known."""
    if ground_m is None:
        return []
    places = [f"{side}_{place}" for side in SIDES for place in SOLE_PLACES]
    standing = human.sites(human.posture()[None], places)
    low = {name: ground_m + SOLE_SHARE * float(one[0][0, 2]) for name, one in standing.items()}
    return [GroundTask(human.model, low, GROUND_COST)]


def _roams(targets: Float[np.ndarray, "frames points 3"]) -> bool:
    """Whether a body is somewhere else for long, as one is who walks."""
    seen = targets[np.isfinite(targets).all(axis=2).any(axis=1)]
    middle = np.nanmean(seen[..., :2], axis=1)
    low, high = np.quantile(middle, [0.05, 0.95], axis=0)
    return bool(np.linalg.norm(high - low) > ROAMING_M)


def _stance(human: Human, start: Float[np.ndarray, "posture"], *, roams: bool) -> list[mink.Task]:
    """Tasks of a body of whose legs nothing is seen: it stands, its pelvis upright.

    The feet are flat at the height at which they are in the first posture, on one spot if the body
    stays there; else whoever bends forward would tilt as one piece.
    """
    upright = np.array(start)
    w, _, _, z = start[3:7] / np.linalg.norm(start[3:7])
    upright[3:7] = np.array([w, 0.0, 0.0, z]) / np.hypot(w, z)
    configuration = mink.Configuration(human.model)
    configuration.update(upright)
    along = [0.0 if roams else PLANTED_COST] * 2
    tasks: list[mink.Task] = [UprightTask("pelvis", STANCE_COST)]
    for side in SIDES:
        foot = mink.FrameTask(f"{side}_foot", "body", [*along, PLANTED_COST], 0.0)
        foot.set_target_from_configuration(configuration)
        tasks += [foot, UprightTask(f"{side}_foot", STANCE_COST)]
    return tasks


def _ease_costs(human: Human) -> Float[np.ndarray, "dofs"]:
    """Weight of each hinge's angle; none for the pelvis's pose."""
    spine = np.array([without_side(joint).startswith(SPINE) for joint in human.joints])
    return np.r_[np.zeros(6), np.where(spine, SPINE_EASE_COST, EASE_COST)]


def _start(
    human: Human, spots: Mapping[str, np.ndarray], named: Mapping[str, str], frame: int
) -> Float[np.ndarray, "posture"]:
    """The standing posture, moved and turned as a whole to the points of one frame."""
    bent = {f"{side}_{joint}": angle for joint, angle in BENT.items() for side in SIDES}
    standing = human.posture(bent)
    where = human.sites(standing[None], set(named.values()))
    known = [name for name in named if np.isfinite(spots[name][frame]).all()]
    trunk = [n for n in known if _steady(named[n])]
    used = trunk if len(trunk) >= 3 else known
    if len(used) < 3:
        raise SkeletonError(f"{len(used)} points at once; three or more place the body")
    body = np.array([where[named[name]][0][0] for name in used])
    world = np.array([spots[name][frame] for name in used])
    turn, _ = Rotation.align_vectors(world - world.mean(axis=0), body - body.mean(axis=0))
    out = standing.copy()
    out[:3] = world.mean(axis=0) + turn.apply(standing[:3] - body.mean(axis=0))
    out[3:7] = turn.as_quat(scalar_first=True)
    return out


def _steady(place: str) -> bool:
    """Whether a place is on the trunk, or is where a limb hangs on it."""
    joint = without_side(place) in {"thigh", "upper_arm"}
    return joint or parts().get(without_side(place)) in {"trunk", "pelvis"}
