"""From points to motion: the body drawn to joints, key points or markers, and its measures."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

import mink
import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures, MeasuresError, estimate_measures
from capar.body.human import Human, body_spec
from capar.body.inverse_kinematics import DirectionTask, GroundTask, PointTask, joint_limits
from capar.body.sensor_fitting import LARGEST_STEP, SOLVER
from capar.body.skeleton import HIP_OF_SPINES, SHOULDER_BREADTH
from capar.model.errors import CaparError
from extractors.readers.drafting.contents import Points
from extractors.readers.names import SIDES, BodyName, parts, without_side

#: Where the search begins [rad]: a straight limb does not tell which way it bends
BENT = {"elbow_flexion": 0.4, "knee_flexion": 0.1, "hip_flexion": 0.05}
#: What names of hinges of spine, neck and shoulder girdle begin with, without their side
SPINE = ("lumbar", "thorax", "neck", "head", "clavicle")
#: Weights of a metre between a point and its place; of a radian away from standing, and of a hinge
#: of the spine, where few points see so many hinges; of a step: points slightly out of reach would
#: throw a straight limb about
POINT_COST, EASE_COST, SPINE_EASE_COST, DAMPING_COST = 10.0, 0.05, 0.5, 0.3
#: Weights of a radian of a foot's tilt while it stands flat, of a metre of its sole's height above
#: the ground, and of a metre by which a heel or toes are in the ground
FLAT_COST, SOLE_COST, GROUND_COST = 2.0, 5.0, 20.0
#: Weights where no leg is seen of a radian of tilt of pelvis and feet and of a metre of a foot from
#: where it stands; of a radian by which an unseen arm does not hang straight down
STANCE_COST, PLANTED_COST, HANGING_COST = 0.3, 0.5, 0.5
#: Weights of a radian between the face and where it looks, and of tilt of an unseen head
FACE_COST, HEAD_COST = 3.0, 1.5
#: Places that keep above the ground by a share of their height above the sole [1]: a foot that
#: rolls over its heel or toes has them nearer to it
SOLE_PLACES, SOLE_SHARE = ("heel", "second_metatarsal", "toe_tip"), 0.7
ROAMING_M = 0.5  # who goes further than this on unseen legs is not taken to stand on one spot [m]

#: Iterations for the first frame and for the others; how many places fit a body at least
SETTLING, ITERATIONS, LEAST_PLACES = 80, 3, 4
#: The two joints, of either side, that a limb's length lies between
LENGTHS = {
    "upper_arm": ("upper_arm", "forearm"),
    "forearm": ("forearm", "hand"),
    "thigh": ("thigh", "shank"),
    "shank": ("shank", "foot"),
}
#: The paired joint, and the share of the measure that lies between its two sides
BREADTHS = {
    "shoulder_breadth": ("upper_arm", SHOULDER_BREADTH),
    "spine_breadth": ("thigh", 2 * HIP_OF_SPINES),
}
#: Paired joints at the lower and upper end of the trunk; and paired landmarks, over which the skin
#: moves much, where nothing else shows its length
TRUNK, TRUNK_OF_LANDMARKS = ("thigh", "upper_arm"), ("asis", "acromion")
#: Weight of a trunk's length as it is seen against that by stature [1]: shoulders rise and fall by
#: as much as trunks of one stature differ
TRUNK_TRUST = 0.5
TRUNK_HEIGHTS = ("acromial_height", "suprasternale_height", "cervicale_height")
UPPER_HEIGHTS = ("eye_height", "stature")
#: Ankles are taken to be as high as they are seen if that is between these shares of the usual
#: height [1]: soles of shoes raise them, and skeletons have them somewhere between heel and shank
ANKLE_SHARE = (0.6, 1.7)


class SkeletonError(CaparError):
    """Points that no body can be fitted to."""


@dataclass(frozen=True)
class Guidance:
    """What is known of a body besides where points of it are."""

    #: By side, when a foot stands flat
    flat: Mapping[str, Bool[np.ndarray, "frames"]] = field(default_factory=dict)
    ground_m: float | None = None  #: Height of the ground on which they do [m]
    #: Where the face looks, as directions in the world [1]; NaN where that is not known
    faces: Float[np.ndarray, "frames 3"] | None = None
    ease: float = 1.0  #: How much more than usual the standing posture counts [1]

    def at(self, frames: Int[np.ndarray, "some"]) -> "Guidance":
        """The same for some of the frames."""
        flat = {side: when[frames] for side, when in self.flat.items()}
        return replace(self, flat=flat, faces=None if self.faces is None else self.faces[frames])


@dataclass(frozen=True, eq=False)
class PointFit:
    """A body's motion that follows points."""

    human: Human
    motion: Float[np.ndarray, "frames posture"]
    #: By name, distance of the body's place from the point [m]; NaN if lost
    residuals_m: Mapping[str, Float[np.ndarray, "frames"]]
    segments: Mapping[str, str]  #: By name, the segment that its place is on

    @property
    def median_m(self) -> float:
        """Median of all residuals [m]."""
        return float(np.nanmedian(np.concatenate(list(self.residuals_m.values()))))


def fit_points(
    human: Human,
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    places: Mapping[str, str],
    weights: Mapping[str, float] | None = None,
    guidance: Guidance | None = None,
) -> PointFit:
    """Draw places of the body to points [m] in a world whose z axis points up; NaN where lost.

    ``places`` are sites or segments by name of a point, ``weights`` are 1 where not given.

    Raises:
        SkeletonError: Fewer than four places are known, or there are never three points at once.
    """
    named = {name: places[name] for name in points if name in places}
    if len(named) < LEAST_PLACES:
        raise SkeletonError(f"{len(named)} known places on the body; four or more are needed")
    spots = {name: np.asarray(points[name]) for name in named}
    motion = _followed(human, spots, named, weights or {}, guidance or Guidance())
    where = human.sites(motion, set(named.values()))
    residuals = {n: np.linalg.norm(where[on][0] - spots[n], axis=1) for n, on in named.items()}
    segments = {name: segment_of(human, place) for name, place in named.items()}
    return PointFit(human, motion, residuals, segments)


def _followed(
    human: Human,
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    places: Mapping[str, str],
    weights: Mapping[str, float],
    guidance: Guidance,
) -> Float[np.ndarray, "frames posture"]:
    """Postures of a body, from the frame in which most is seen onwards and backwards."""
    costs = [POINT_COST * weights.get(place, 1.0) for place in places.values()]
    targets = np.stack([points[name] for name in places], axis=1)
    seen = np.isfinite(targets).all(axis=2) & (np.array(costs) > 0.0)
    best = int(np.argmax(seen.sum(axis=1)))
    start = _start(human, points, places, best)
    task = PointTask(human, list(places.values()), costs)
    spine = np.array([without_side(joint).startswith(SPINE) for joint in human.joints])
    easy = np.r_[np.zeros(6), np.where(spine, SPINE_EASE_COST, EASE_COST)]
    ease = mink.PostureTask(human.model, cost=guidance.ease * easy)
    ease.set_target(start)
    tasks = [task, ease, mink.DampingTask(human.model, cost=DAMPING_COST)]
    level = {side: DirectionTask(f"{side}_foot", FLAT_COST) for side in guidance.flat}
    height: dict[str, mink.FrameTask] = {}
    for side, flat in level.items():
        tasks.append(flat)
        if guidance.ground_m is not None:
            height[side] = mink.FrameTask(f"{side}_foot", "body", 0.0, 0.0)
            ankle = np.array([0.0, 0.0, guidance.ground_m + human.measures["ankle_height"]])
            height[side].set_target(mink.SE3.from_translation(ankle))
            tasks.append(height[side])
    tasks += _unseen(human, {segment_of(human, place) for place in places.values()}, guidance)
    face = DirectionTask("head", FACE_COST, (1.0, 0.0, 0.0))
    tasks += [] if guidance.faces is None else [face]
    # Where a thigh begins is the pelvis's to say.
    joints = {without_side(segment_of(human, place)) for place in places.values()} - {"thigh"}
    if not any(parts().get(joint) in {"thigh", "shank", "foot"} for joint in joints):
        tasks += _stance(human, start, targets)
    limits = joint_limits(human, LARGEST_STEP)
    configuration = mink.Configuration(human.model)
    out = np.empty((len(seen), len(start)))
    for frames in (range(best, len(out)), range(best - 1, -1, -1)):
        configuration.update(start if frames.step == 1 else out[best])
        for frame in frames:
            task.aim(targets[frame])
            for side, flat in level.items():
                trust = float(guidance.flat[side][frame])
                flat.trust(trust)
                if height:
                    height[side].set_position_cost([0.0, 0.0, trust * SOLE_COST])
            if guidance.faces is not None:
                face.trust(float(np.isfinite(guidance.faces[frame]).all()))
                face.aim(np.nan_to_num(guidance.faces[frame]))
            for _ in range((ITERATIONS if frame != best else SETTLING) * bool(seen[frame].any())):
                step = mink.solve_ik(configuration, tasks, 1.0, SOLVER, limits=limits)
                configuration.integrate_inplace(step, 1.0)
            out[frame] = configuration.q
    return out


def segment_of(human: Human, place: str) -> str:
    """The segment of the body that a place is on; a segment is its own."""
    site = next((s for s in range(human.model.nsite) if human.model.site(s).name == place), -1)
    return place if site < 0 else str(human.model.body(human.model.site_bodyid[site]).name)


def _unseen(human: Human, segments: Collection[str], guidance: Guidance) -> list[mink.Task]:
    """Unseen arms hang, an unseen head is upright, heels and toes are not in a known ground."""
    tasks: list[mink.Task] = [
        DirectionTask(f"{side}_upper_arm", HANGING_COST)
        for side in SIDES
        if not {f"{side}_forearm", f"{side}_hand"} & set(segments)
    ]
    if not {"head", "neck"} & set(segments):
        tasks.append(DirectionTask("head", HEAD_COST))
    if guidance.ground_m is not None:
        places = [f"{side}_{place}" for side in SIDES for place in SOLE_PLACES]
        standing = human.sites(human.posture()[None], places)
        low = {n: guidance.ground_m + SOLE_SHARE * float(p[0, 2]) for n, (p, _) in standing.items()}
        tasks.append(GroundTask(human.model, low, GROUND_COST))
    return tasks


def _stance(
    human: Human, start: Float[np.ndarray, "posture"], targets: Float[np.ndarray, "frames points 3"]
) -> list[mink.Task]:
    """Tasks of a body of whose legs nothing is seen: pelvis upright, feet flat as at first.

    They are on one spot unless it roams. Else who bends forward would tilt as one piece.
    """
    seen = targets[np.isfinite(targets).all(axis=2).any(axis=1)]
    low, high = np.quantile(np.nanmean(seen[..., :2], axis=1), [0.05, 0.95], axis=0)
    roams = np.linalg.norm(high - low) > ROAMING_M
    upright = np.array(start)
    w, _, _, z = start[3:7] / np.linalg.norm(start[3:7])
    upright[3:7] = np.array([w, 0.0, 0.0, z]) / np.hypot(w, z)
    configuration = mink.Configuration(human.model)
    configuration.update(upright)
    along = [0.0 if roams else PLANTED_COST] * 2
    tasks: list[mink.Task] = [DirectionTask("pelvis", STANCE_COST)]
    for side in SIDES:
        foot = mink.FrameTask(f"{side}_foot", "body", [*along, PLANTED_COST], 0.0)
        foot.set_target_from_configuration(configuration)
        tasks += [foot, DirectionTask(f"{side}_foot", STANCE_COST)]
    return tasks


def _start(
    human: Human, spots: Mapping[str, np.ndarray], named: Mapping[str, str], frame: int
) -> Float[np.ndarray, "posture"]:
    """The standing posture, moved and turned as a whole to the points of one frame."""
    bent = {f"{side}_{joint}": angle for joint, angle in BENT.items() for side in SIDES}
    standing = human.posture(bent)
    where = human.sites(standing[None], set(named.values()))
    known = [name for name in named if np.isfinite(spots[name][frame]).all()]
    trunk = [  # on it, or where a limb hangs on it
        n
        for n in known
        if without_side(named[n]) in {"thigh", "upper_arm"}
        or parts().get(without_side(named[n])) in {"trunk", "pelvis"}
    ]
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


def measures_from_points(
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    named: Mapping[str, str],
    *,
    sex: str = "male",
    age: float = 30.0,
) -> Measures:
    """Measures that a skeleton's own bones have, the stature from the sum of its limbs.

    Raises:
        SkeletonError: None of the limbs has both its joints.
    """
    places = {named[name]: where for name, where in points.items() if name in named}
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


def trunk_share(
    places: Mapping[str, Float[np.ndarray, "frames 3"]], body: Human, ends: tuple[str, str] = TRUNK
) -> float | None:
    """Likely length of a trunk as a share of that of a body of its stature [1]; None if not seen.

    The ends are paired places, of the lower and the upper end.
    """
    names = [f"{side}_{end}" for end in ends for side in SIDES]
    if not all(name in places for name in names):
        return None
    own = body.sites(body.posture()[None], names)
    seen, usual = (
        _apart((a + b) / 2, (c + d) / 2)
        for a, b, c, d in ([places[name] for name in names], [own[name][0] for name in names])
    )
    return None if np.isnan(seen) else 1.0 + TRUNK_TRUST * (seen / usual - 1.0)


def with_trunk(measures: Measures, share: float) -> Measures:
    """The same body with a trunk longer by a factor, if there is such; legs, arms and head stay."""
    hip = measures.hip_height
    heights = {name: hip + share * (measures[name] - hip) for name in TRUNK_HEIGHTS}
    longer = heights["cervicale_height"] - measures["cervicale_height"]
    heights |= {name: measures[name] + longer for name in UPPER_HEIGHTS}
    return _changed(measures, heights)


def with_head(measures: Measures, higher_m: float) -> Measures:
    """The same body with a neck longer by so much [m]; the same if no body has such a neck."""
    return _changed(measures, {name: measures[name] + higher_m for name in UPPER_HEIGHTS})


def with_legs(measures: Measures, lengths: Mapping[str, float]) -> Measures:
    """The same body with other thighs, shanks or ankle heights [m]; all above moves with them."""
    higher = sum(length - measures[name] for name, length in lengths.items())
    raised = {name: measures[name] + higher for name in (*TRUNK_HEIGHTS, *UPPER_HEIGHTS)}
    return _changed(measures, raised | dict(lengths))


def with_ankles(
    measures: Measures,
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    places: Mapping[str, str],
    guidance: Guidance,
) -> Measures:
    """The same body with ankles as high as they are while feet are flat, if there is such."""
    heights = [
        float(np.nanmedian(points[name][flat, 2])) - guidance.ground_m
        for name, place in places.items()
        for side, flat in guidance.flat.items()
        if guidance.ground_m is not None
        and place in {f"{side}_foot", f"{side}_ankle_lateral"}
        and np.isfinite(points[name][flat, 2]).any()
    ]
    usual = measures["ankle_height"]
    if not heights or not ANKLE_SHARE[0] < np.mean(heights) / usual < ANKLE_SHARE[1]:
        return measures
    return with_legs(measures, {"ankle_height": usual + (float(np.mean(heights)) - usual)})


def _changed(measures: Measures, values: Mapping[str, float]) -> Measures:
    """The body with some measures given too; the same if there is none such."""
    given = {name: measures[name] for name in measures.given} | dict(values)
    try:
        return estimate_measures(sex=measures.sex, age=measures.age, given=given)
    except MeasuresError:
        return measures


def _apart(first: np.ndarray, second: np.ndarray) -> float:
    """Median distance of two points [m]."""
    return float(np.nanmedian(np.linalg.norm(first - second, axis=1)))


SAMPLES = 60  # frames by which sizes and places of markers are found

#: Places of the middle of the body, which need no side
MIDDLE = {
    "c7", "t10", "sternum_top", "sternum_low", "sacrum", "head_top", "head", "neck", "pelvis",
    "nose", "thorax_upper", "thorax_lower", "lumbar_upper", "lumbar_lower",
}  # fmt: skip


def is_sided(each: BodyName) -> bool:
    """Whether a name tells all that a place of the body needs."""
    return each.side != "none" or each.place in MIDDLE


def sample_frames(points: Points, names: Mapping[str, BodyName]) -> np.ndarray:
    """Frames in which most markers are seen, evenly through the recording."""
    seen = np.sum([~np.isnan(points[name]).any(axis=1) for name in names], axis=0)
    known = np.flatnonzero(seen >= 0.8 * seen.max())
    return known[np.unique(np.linspace(0, len(known) - 1, SAMPLES).round().astype(int))]


def local_places(
    made: PointFit, points: Points, names: Mapping[str, BodyName]
) -> dict[str, Float[np.ndarray, "3"]]:
    """The median place of every marker in its segment's frame [m]."""
    human = made.human
    sided = {name: each.place for name, each in names.items() if is_sided(each)}
    segments = {name: segment_of(human, place) for name, place in sided.items()}
    known = {human.model.body(each).name for each in range(human.model.nbody)}
    segments = {name: each for name, each in segments.items() if each in known}
    poses = human.sites(made.motion, set(segments.values()))
    out = {}
    for name, segment in segments.items():
        places, turns = poses[segment]
        seen = ~np.isnan(points[name]).any(axis=1)
        if seen.any():
            frame = RigidTransform.from_components(
                places[seen], Rotation.from_quat(turns[seen], scalar_first=True)
            )
            out[name] = np.median(frame.inv().apply(points[name][seen]), axis=0)
    return out


def with_markers(
    measures: Measures, local: Mapping[str, Float[np.ndarray, "3"]], names: Mapping[str, BodyName]
) -> Human:
    """The body with a site for every marker, ``marker_<name>``."""
    plain = Human.of(measures)
    spec = body_spec(measures)
    for name, place in local.items():
        segment = segment_of(plain, names[name].place)
        spec.body(segment).add_site(name=f"marker_{name}", pos=place, size=[0.006, 0.0, 0.0])
    return Human(measures, spec.compile())
