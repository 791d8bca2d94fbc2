"""From another skeleton's joints or key points to the body's motion."""

from collections.abc import Mapping
from dataclasses import dataclass

import mink
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.anthropometry import Measures, MeasuresError, estimate_measures
from capar.body.fitting import LARGEST_STEP, SOLVER
from capar.body.human import Human
from capar.body.point_task import PointTask
from capar.body.skeleton import HIP_OF_SPINES, SHOULDER_BREADTH
from capar.model.errors import CaparError
from extractors.readers.body_names.body_names import parts, without_side
from extractors.readers.body_names.conventions import Convention

LENGTHS = {
    "upper_arm": ("upper_arm", "forearm"),
    "forearm": ("forearm", "hand"),
    "thigh": ("thigh", "shank"),
    "shank": ("shank", "foot"),
}
"""The two joints, of either side, that a limb's length lies between."""

BREADTHS = {
    "shoulder_breadth": ("upper_arm", SHOULDER_BREADTH),
    "spine_breadth": ("thigh", 2 * HIP_OF_SPINES),
}
"""The paired joint, and the share of the measure that lies between its two sides."""

TRUNKS = (("thigh", "upper_arm"),)
"""Paired joints at the lower and upper end of the trunk; skin moves too much over bones there."""

TRUNK_TRUST = 0.5
"""Weight of a trunk's length as it is seen against that by stature [1]: shoulders rise and fall by
as much as trunks of one stature differ."""

SIDES = ("right", "left")
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

SETTLING = 80
ITERATIONS = 3


class SkeletonError(CaparError):
    """Points that no body can be fitted to."""


@dataclass(frozen=True, eq=False)
class SkeletonFit:
    """A body's motion that follows another skeleton's points."""

    human: Human
    motion: Float[np.ndarray, "frames posture"]
    residuals_m: Mapping[str, Float[np.ndarray, "frames"]]
    """By foreign name, distance of the body's place from the point [m]; NaN if lost."""

    derived: bool
    """Whether orientations of segments come of points only, so that turns about the long axes of
    hands, head and feet are assumed and not seen; always so today: given ones are not used yet."""

    @property
    def median_m(self) -> float:
        """Median of all residuals [m]."""
        return float(np.nanmedian(np.concatenate(list(self.residuals_m.values()))))


def measures_from_points(
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    convention: Convention,
    *,
    sex: str = "male",
    age: float = 30.0,
) -> Measures:
    """Measures that a skeleton's own bones have, the stature from the sum of its limbs.

    Raises:
        SkeletonError: None of the limbs has both its joints.
    """
    places = {place: points[name] for name, place in convention.named(points).items()}
    found = {}
    for measure, (first, second) in LENGTHS.items():
        ends = [(f"{side}_{first}", f"{side}_{second}") for side in SIDES]
        spans = [_apart(places[a], places[b]) for a, b in ends if a in places and b in places]
        if spans:
            found[measure] = float(np.mean(spans))
    for measure, (joint, share) in BREADTHS.items():
        if f"right_{joint}" in places and f"left_{joint}" in places:
            found[measure] = _apart(places[f"right_{joint}"], places[f"left_{joint}"]) / share
    limbs = [name for name in LENGTHS if name in found]
    if not limbs:
        raise SkeletonError(f"no limb has both its joints among {sorted(points)}")
    usual = estimate_measures(sex=sex, age=age)
    scale = sum(found[name] for name in limbs) / sum(usual[name] for name in limbs)
    given = {"stature": scale * usual["stature"], **found}
    made = estimate_measures(sex=sex, age=age, given=given)
    trunk = trunk_share(places, Human.of(made))
    return made if trunk is None else with_trunk(made, trunk)


def trunk_share(places: Mapping[str, Float[np.ndarray, "frames 3"]], body: Human) -> float | None:
    """Likely length of somebody's trunk as a share of a body's [1]; None where it is not seen.

    Args:
        places: Joints and landmarks by the body's own names for them.
        body: Of the same stature.
    """
    for ends in TRUNKS:
        names = [f"{side}_{end}" for end in ends for side in SIDES]
        if all(name in places for name in names):
            own = body.sites(body.posture()[None], names)
            seen, usual = (
                _apart((a + b) / 2, (c + d) / 2)
                for a, b, c, d in (
                    [places[name] for name in names],
                    [own[name][0] for name in names],
                )
            )
            return None if np.isnan(seen) else 1.0 + TRUNK_TRUST * (seen / usual - 1.0)
    return None


def with_trunk(measures: Measures, share: float) -> Measures:
    """The same body with a trunk longer by a factor; the same if no body has such a trunk.

    Legs, arms and the head keep their sizes, so that the stature changes by as much as the trunk.
    """
    hip = measures.hip_height
    names = ("acromial_height", "suprasternale_height", "cervicale_height")
    heights = {name: hip + share * (measures[name] - hip) for name in names}
    longer = heights["cervicale_height"] - measures["cervicale_height"]
    heights |= {name: measures[name] + longer for name in ("eye_height", "stature")}
    given = {name: measures[name] for name in measures.given} | heights
    try:
        return estimate_measures(sex=measures.sex, age=measures.age, given=given)
    except MeasuresError:
        return measures


def _apart(first: np.ndarray, second: np.ndarray) -> float:
    """Median distance of two points [m]."""
    return float(np.nanmedian(np.linalg.norm(first - second, axis=1)))


def fit_skeleton(
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    convention: Convention,
    *,
    human: Human | None = None,
) -> SkeletonFit:
    """Fit the body to joints or key points in a world whose z axis points up.

    Args:
        points: By foreign name [m]; NaN where lost. Names that the convention lacks are ignored.
        convention: What the names mean.
        human: The body; made from the skeleton's own bones where None.

    Raises:
        SkeletonError: Fewer than four places are known, or the points are of no body.
    """
    named = convention.named(points)
    if len(named) < 4:
        raise SkeletonError(f"{len(named)} places of {convention.title}; four or more are needed")
    body = human or Human.of(measures_from_points(points, convention))
    spots = {name: np.asarray(points[name]) for name in named}
    motion = _followed(body, spots, named, convention)
    where = body.sites(motion, set(named.values()))
    residuals = {
        name: np.linalg.norm(where[place][0] - spots[name], axis=1) for name, place in named.items()
    }
    return SkeletonFit(body, motion, residuals, derived=True)


def _followed(
    human: Human,
    spots: Mapping[str, np.ndarray],
    named: Mapping[str, str],
    convention: Convention,
) -> Float[np.ndarray, "frames posture"]:
    costs = [POINT_COST * convention.weight(place) for place in named.values()]
    targets = np.stack([spots[name] for name in named], axis=1)
    seen = np.isfinite(targets).all(axis=2) & (np.array(costs) > 0.0)
    best = int(np.argmax(seen.sum(axis=1)))
    start = _start(human, spots, named, best)
    task = PointTask(human.model, list(named.values()), costs)
    ease = mink.PostureTask(human.model, cost=_ease_costs(human))
    ease.set_target(start)
    tasks = [task, ease, mink.DampingTask(human.model, cost=DAMPING_COST)]
    speeds = dict.fromkeys(human.joints, LARGEST_STEP)
    limits = [mink.ConfigurationLimit(human.model), mink.VelocityLimit(human.model, speeds)]
    configuration = mink.Configuration(human.model)
    out = np.empty((len(seen), len(start)))
    for frames in (range(best, len(out)), range(best - 1, -1, -1)):
        configuration.update(start if frames.step == 1 else out[best])
        for frame in frames:
            task.aim(targets[frame])
            for _ in range((ITERATIONS if frame != best else SETTLING) * bool(seen[frame].any())):
                step = mink.solve_ik(configuration, tasks, 1.0, SOLVER, limits=limits)
                configuration.integrate_inplace(step, 1.0)
            out[frame] = configuration.q
    return out


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
