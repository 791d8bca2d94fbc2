"""From sensors to motion: inverse kinematics, residuals, and limb lengths from the motion."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import mink
import mujoco
import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures, measures_of, table
from capar.body.human import ROOT_SIZE, Human
from capar.body.inverse_kinematics import DirectionTask, Solver, joint_limits
from capar.body.scripts import minimum_jerk
from capar.body.sensors import (
    PLACEMENT_M,
    Calibration,
    Mount,
    Target,
    calibrate,
    mounted,
    places,
    target,
)
from capar.model import geometry
from capar.model.capture import Capture, Stream
from capar.model.errors import CaparError
from extractors.readers.names import SIDES, without_side

SOLVER = "daqp"
#: Weights of a metre and of a radian between a sensor and its place on the body
POSITION_COST, ORIENTATION_COST = 10.0, 3.0
#: Weights of a radian away from the posture aimed at: for a hinge of one radian's range, and where
#: a sensor is lost
POSTURE_COST, BRIDGE_COST = 0.05, 0.5
#: Weight of a radian's step from frame to frame: without it solutions chatter at joint limits
DAMPING_COST = 0.03
#: Weights where no sensor is below the chest: of a radian of the pelvis's tilt; of a metre of a
#: foot's height and a radian of its tilt; of a metre of a foot and of the pelvis from where they
#: stood if the sensors stay near
UPRIGHT_COST, STANDING_COST, ON_SPOT_COST = 0.5, (5.0, 0.5), (2.0, 1.0)
#: Who moves no further than this, by the mean of all sensors, stands on one spot [m]
ON_SPOT_M = 0.5
#: Weight of a radian of the upper trunk's tilt where no sensor is on it: hands and head alone would
#: let it lean as far as they reach together
TRUNK_COST = 0.15
#: Iterations for the first frame, and more of them at most where a sensor is left behind
SETTLING, CATCHING_UP = 60, 20
#: A sensor farther than this from its place after the usual steps is left behind [m]
FAR_BEHIND_M = 0.02
LARGEST_STEP = 0.35  # largest step of a hinge in one iteration [rad], whatever the recording's rate
LIMIT_MARGIN = float(np.radians(0.1))  # a hinge this near its limit counts as at it [rad]

#: How the names of segments of the lower body end
LOWER = ("pelvis", "thigh", "shank", "foot", "toes")
#: Segments that are taken to be seen with those that they are on
ENDS = (
    "fingers",
    "thumb",
    *(f"{finger}_1" for finger in table("fingers")["finger"]),
    "toes",
    "eye",
)
#: What sensors are called besides the names of their places
OTHER_NAMES = {"pelvis": "l5", "sacrum": "l5", "neck_base": "neck"}
#: The measures that decide where joints are, and are estimated from a motion
FREE = (
    "upper_arm", "forearm", "acromial_height", "shoulder_breadth", "cervicale_height",
    "thigh", "shank", "spine_breadth",
)  # fmt: skip
SAMPLES, ROUNDS = 60, 6  # frames and Gauss-Newton steps by which they are

#: Deviations of a filtered sensor's pose, soft tissue included [m] and [rad]
NOISE_M, NOISE_RAD = 0.002, float(np.radians(0.7))
#: Deviations of a hinge from the reference posture that somebody takes up, and from standing during
#: the motion [rad]
REFERENCE_RAD, LOOSE_RAD = float(np.radians(1.5)), 1.0
DELTA_M = 1e-4  # step of finite differences [m]


class FitError(CaparError):
    """Sensors that the body cannot be fitted to."""


class RefinementError(CaparError):
    """A motion from which no measures can be estimated."""


class _Follower:
    """Inverse kinematics that keeps the sites of sensors on their targets."""

    def __init__(
        self, human: Human, targets: Mapping[str, Target], rest: Float[np.ndarray, "posture"]
    ) -> None:
        self.human, self.targets = human, targets
        self.frames = {
            place: mink.FrameTask(f"sensor_{place}", "site", POSITION_COST, ORIENTATION_COST)
            for place in targets
        }
        self.posture_cost = np.zeros(human.model.nv)
        self.posture_cost[6:] = POSTURE_COST / np.sqrt(np.ptp(human.ranges, axis=1))
        self.posture = mink.PostureTask(human.model, cost=self.posture_cost)
        self.posture.set_target(rest)
        self.damping = mink.DampingTask(human.model, cost=DAMPING_COST)
        self.limits = joint_limits(human, LARGEST_STEP)
        self.configuration = mink.Configuration(human.model)
        self.segments = [places()[place] for place in targets]
        legs_seen = any(segment.endswith(LOWER) for segment in self.segments)
        self.stance = [] if legs_seen else self._stance(rest)

    def _stance(self, rest: Float[np.ndarray, "posture"]) -> list[mink.Task]:
        """Tasks of a body of whose legs nothing is seen: pelvis upright, feet flat as at rest."""
        self.configuration.update(rest)
        middle = np.mean([target.positions[:, :2] for target in self.targets.values()], axis=0)
        stays = float(np.linalg.norm(np.ptp(middle, axis=0)) < ON_SPOT_M)
        level = np.array([1.0, 1.0, 0.0])
        foot, pelvis = (np.multiply(stays * cost, level) for cost in ON_SPOT_COST)
        foot[2] = STANDING_COST[0]
        standing = [mink.FrameTask("pelvis", "body", pelvis, UPRIGHT_COST * level)]
        for side in SIDES:
            standing.append(mink.FrameTask(f"{side}_foot", "body", foot, STANDING_COST[1] * level))
        for task in standing:
            task.set_target_from_configuration(self.configuration)
        on_trunk = any(segment.startswith(("thorax", "lumbar")) for segment in self.segments)
        trunk = [] if on_trunk else [DirectionTask("thorax_upper", TRUNK_COST)]
        return [*standing, *trunk]

    def run(self, start: Float[np.ndarray, "posture"]) -> Float[np.ndarray, "frames posture"]:
        """Postures at all frames, from a posture near the first."""
        self.configuration.update(start)
        out = np.empty((len(next(iter(self.targets.values())).weights), len(start)))
        for frame in range(len(out)):
            self._aim(frame)
            for _ in range(1 if frame else SETTLING):
                self._step()
            self._catch_up()
            out[frame] = self.configuration.q
        return out

    def bridge(
        self, motion: Float[np.ndarray, "frames posture"]
    ) -> Float[np.ndarray, "frames posture"]:
        """The motion with unseen hinges led from the one end of every loss to the other."""
        faint = np.min([each.weights for each in self.targets.values()], axis=0) < 1.0
        out = motion.copy()
        for first, last in geometry.runs(faint):
            ends = [max(first - 1, 0), min(last + 1, len(motion) - 1)]
            if (
                faint[ends[0]] or faint[ends[1]]
            ):  # a loss at an end of the recording: hold the other
                ends = ends[1:] * 2 if faint[ends[0]] else ends[:1] * 2
            start, end = motion[ends[0]], motion[ends[1]]
            self.configuration.update(start)
            for frame in range(first, last + 1):
                way = minimum_jerk((frame - first + 1) / (last - first + 2))
                self.posture.set_target(start + way * (end - start))
                self.posture.set_cost(self.posture_cost + self._unseen(frame) * BRIDGE_COST)
                self._aim(frame)
                for _ in range(2):
                    self._step()
                out[frame] = self.configuration.q
        return out

    def _catch_up(self) -> None:
        """Go on in steps that never overshoot, where plain ones leave sensors far behind."""
        if self._behind_m() < FAR_BEHIND_M:
            return
        tasks = [*self._seen(), *self.stance, self.posture]
        solver = Solver(self.human, tasks, longest_rad=LARGEST_STEP)
        for _ in range(CATCHING_UP):
            solver.step(self.configuration)
            if solver.settled or self._behind_m() < FAR_BEHIND_M:
                break

    def _behind_m(self) -> float:
        """How far the farthest of the sensors seen is from where it should be [m]."""
        errors = [task.compute_error(self.configuration)[:3] for task in self._seen()]
        return max((float(np.linalg.norm(error)) for error in errors), default=0.0)

    def _seen(self) -> list[mink.FrameTask]:
        """Tasks of sensors that are not lost."""
        return [task for task in self.frames.values() if task.cost[0] > 0.0]

    def _aim(self, frame: int) -> None:
        """Set every task to a frame's targets."""
        for place, task in self.frames.items():
            one = self.targets[place]
            weight = one.weights[frame]
            task.set_position_cost(POSITION_COST * weight)
            task.set_orientation_cost(ORIENTATION_COST * weight)
            if weight > 0.0:
                pose = np.concatenate([one.orientations[frame], one.positions[frame]])
                task.set_target(mink.SE3(pose))

    def _unseen(self, frame: int) -> Float[np.ndarray, "dofs"]:
        """How little each hinge is seen at a frame: 1 between a lost sensor and the next seen."""
        model, out = self.human.model, np.zeros(self.human.model.nv)
        weights = {places()[place]: target.weights[frame] for place, target in self.targets.items()}
        for segment, weight in weights.items():
            body = model.body(segment).id
            while weight < 1.0 and body > model.body("pelvis").id:
                start = model.body_dofadr[body]
                out[start : start + model.body_dofnum[body]] = 1.0 - weight
                body = model.body_parentid[body]
                if weights.get(model.body(body).name, 0.0) >= 1.0:
                    break
        return out

    def _step(self) -> None:
        """One step of inverse kinematics."""
        tasks = [*self._seen(), *self.stance, self.posture, self.damping]
        velocity = mink.solve_ik(self.configuration, tasks, 1.0, SOLVER, limits=self.limits)
        self.configuration.integrate_inplace(velocity, 1.0)


@dataclass(frozen=True, eq=False)
class Fit:
    """A body's motion that follows a recording."""

    human: Human  #: With its sensors where they were found
    times: Float[np.ndarray, "frames"]  #: [s]
    motion: Float[np.ndarray, "frames posture"]
    #: By place, where its sensor was lost and the posture was interpolated
    bridged: Mapping[str, Bool[np.ndarray, "frames"]]
    #: By place, distance of the body's sensor site from the filtered sensor [m]; NaN if lost
    residuals_m: Mapping[str, Float[np.ndarray, "frames"]]
    #: Likewise the angle between them [rad]
    residuals_rad: Mapping[str, Float[np.ndarray, "frames"]]
    seconds: float  #: How long fitting took [s]
    #: By place followed, the segment that it is on
    segments: Mapping[str, str] = field(default_factory=dict)

    @property
    def unrecorded(self) -> tuple[str, ...]:
        """Segments of which nothing is followed, on them or beyond them from the pelvis."""
        parents = {name: one.parent for name, one in self.human.segments.items()}
        seen: set[str] = set()
        for followed in self.segments.values():
            above = followed
            while above and above not in seen:
                seen.add(above)
                above = parents[above]
        ends = {name for name in parents if without_side(name) in ENDS and parents[name] in seen}
        for _ in range(2):
            ends |= {name for name in parents if parents[name] in ends}
        return tuple(name for name in parents if name not in seen | ends)

    @property
    def at_limit(self) -> Bool[np.ndarray, "frames hinges"]:
        """Which hinges are at the end of their range."""
        low, high = self.human.ranges.T
        angles = self.motion[:, ROOT_SIZE:]
        return (angles <= low + LIMIT_MARGIN) | (angles >= high - LIMIT_MARGIN)


def fit(human: Human, streams: Mapping[str, Stream], calibration: Calibration) -> Fit:
    """Fit the body to any subset of its calibrated sensors, by place and on one clock.

    Raises:
        FitError: No sensor is calibrated, or the clocks differ.
    """
    began = time.perf_counter()
    known = {place: each for place, each in streams.items() if place in calibration.mounts}
    if not known:
        raise FitError("none of the sensors was calibrated; calibrate with the same ones")
    clock = next(iter(known.values())).times
    for place, stream in known.items():
        if not np.array_equal(stream.times, clock):
            raise FitError(f"sensor {place!r} is on another clock; resample them to one")
    body = mounted(human, calibration.mounts)
    targets = {place: target(each) for place, each in known.items()}
    follower = _Follower(body, targets, calibration.posture)
    motion = follower.bridge(follower.run(calibration.posture))
    seconds = time.perf_counter() - began
    sites = body.sites(motion, [f"sensor_{each}" for each in targets])
    metres, radians = {}, {}
    for place, one in targets.items():
        spots, turns = sites[f"sensor_{place}"]
        metres[place] = np.linalg.norm(spots - one.positions, axis=1)
        radians[place] = geometry.angle_between(turns, one.orientations)
    return Fit(
        body, clock, motion,
        {place: each.weights == 0.0 for place, each in targets.items()},
        metres, radians, seconds, {place: places()[place] for place in known},
    )  # fmt: skip


def worn(capture: Capture) -> dict[str, Stream]:
    """The streams of the sensors that the capture's first agent wears, by place on the body."""
    out: dict[str, Stream] = {}
    for sensor in capture.sensors:
        if capture.agent_of(sensor) == capture.agent.name:
            sided = "" if sensor.side == "none" else f"{sensor.side}_"
            names = (sensor.name, OTHER_NAMES.get(sensor.name, ""), sided + sensor.end_effector)
            place = next((each for each in names if each in places() and each not in out), None)
            if place:
                out[place] = sensor.stream
    return out


def fit_capture(capture: Capture, *, angles: Mapping[str, float] | None = None) -> Fit:
    """The body of a capture's performer, fitted to the sensors it wears.

    The first 0.4 s are the reference posture [rad]: arms down, palms inwards, where not given.

    Raises:
        CaparError: No sensor is on a place of the body, or too few; or the measures are of no body.
    """
    streams = worn(capture)
    if not streams:
        names = ", ".join(each.name for each in capture.sensors)
        raise FitError(f"none of the sensors ({names}) is on a known place: {', '.join(places())}")
    human = Human.of(measures_of(capture.agent))
    return fit_refined(human, streams, calibrate(human, streams, angles=angles))


def fit_refined(human: Human, streams: Mapping[str, Stream], calibration: Calibration) -> Fit:
    """Fit the body to its sensors; again with refined measures where one is off by ``NOISE_M``.

    The second fit is kept if its worst sensor fits better.
    """
    began = time.perf_counter()
    made = fit(human, streams, calibration)
    if worst_m(made) <= NOISE_M:
        return made
    try:
        measures, refined = refine(made, streams, calibration)
    except RefinementError:
        return made
    again = fit(Human.of(measures), streams, refined)
    kept = again if worst_m(again) < worst_m(made) else made
    return replace(kept, seconds=time.perf_counter() - began)


def worst_m(made: Fit) -> float:
    """Root mean square of the distance of that sensor from its place which fits worst [m]."""
    squares = (np.nanmean(np.square(metres)) for metres in made.residuals_m.values())
    return float(np.sqrt(max(squares)))


def refine(
    made: Fit, streams: Mapping[str, Stream], calibration: Calibration, *, samples: int = SAMPLES
) -> tuple[Measures, Calibration]:
    """Functional calibration: limb lengths and places of sensors from a motion that was fitted.

    Where a limb is longer than assumed, no posture fits all sensors at once. Lengths, places of the
    sensors and postures of some frames are estimated by Gauss-Newton steps, each from its prior.
    The measures have their deviations after the motion was seen.

    Raises:
        RefinementError: Fewer than ten frames have all the sensors.
    """
    targets = {place: target(streams[place]) for place in calibration.mounts}
    seen = np.flatnonzero(np.min([each.weights for each in targets.values()], axis=0) >= 1.0)
    if len(seen) < 10:
        raise RefinementError(f"{len(seen)} frames with all of {sorted(targets)}; ten are needed")
    frames = np.unique(seen[np.linspace(0, len(seen) - 1, samples).astype(int)])
    estimate = _Estimate(targets, frames, calibration, made.human.measures, made.motion[frames])
    for _ in range(ROUNDS):
        covariance = estimate.step()
    after = {name: float(np.sqrt(covariance[n, n])) for n, name in enumerate(FREE)}
    deviations = {**made.human.measures.deviations, **after}
    measures = replace(estimate.measures, deviations=deviations)
    return measures, Calibration(estimate.mounts, calibration.posture)


class _Estimate:
    """Measures, mounts and postures of some frames, with targets and priors."""

    def __init__(
        self,
        targets: Mapping[str, Target],
        frames: np.ndarray,
        calibration: Calibration,
        prior: Measures,
        postures: Float[np.ndarray, "samples posture"],
    ) -> None:
        self.targets, self.frames, self.reference = targets, frames, calibration.posture
        self.prior = self.measures = prior
        self.mounts, self.postures = dict(calibration.mounts), postures.copy()
        self.postures[0] = calibration.posture

    def step(self) -> Float[np.ndarray, "parameters parameters"]:
        """One Gauss-Newton step with the postures eliminated; returns the covariance."""
        usual = Human.of(self.measures)
        longer = [Human.of(_longer(self.measures, {name: DELTA_M})) for name in FREE]
        human = mounted(usual, self.mounts)
        shapes = self._by_measure(human, longer)
        schur, pull = self._priors(usual, longer)
        kept = []
        for sample in range(len(self.frames)):
            rest, by_posture, by_other = self._frame(human, sample, shapes)
            # One over the deviation of each hinge from where it is expected, and how far it is.
            loose = np.full(66, 1.0 / (REFERENCE_RAD if sample == 0 else LOOSE_RAD))
            loose[:6], away = 1e-3, np.zeros(66)
            expected = self.reference[ROOT_SIZE:] if sample == 0 else 0.0
            away[6:] = self.postures[sample, ROOT_SIZE:] - expected
            own = by_posture.T @ by_posture + np.diag(loose**2)
            own_pull = by_posture.T @ rest + loose**2 * away
            cross = by_posture.T @ by_other
            solved = np.linalg.solve(own, np.column_stack([cross, own_pull]))
            schur += by_other.T @ by_other - cross.T @ solved[:, :-1]
            pull += by_other.T @ rest - cross.T @ solved[:, -1]
            kept.append(solved)
        covariance = np.linalg.inv(schur)
        change = -covariance @ pull
        low, high = human.ranges.T
        for posture, solved in zip(self.postures, kept, strict=True):
            turned = -solved[:, -1] - solved[:, :-1] @ change
            mujoco.mj_integratePos(human.model, posture, np.asarray(turned), 1.0)
            posture[ROOT_SIZE:] = np.clip(posture[ROOT_SIZE:], low, high)
        self._apply(change)
        return covariance

    def _frame(
        self, human: Human, sample: int, shapes: Mapping[str, np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Residuals of one frame over noise, and how they change with posture and parameters."""
        data = mujoco.MjData(human.model)
        data.qpos[:] = self.postures[sample]
        mujoco.mj_kinematics(human.model, data)
        mujoco.mj_comPos(human.model, data)
        count, nv = len(self.targets), human.model.nv
        rest, by_posture = np.zeros(6 * count), np.zeros((6 * count, nv))
        by_other = np.zeros((6 * count, len(FREE) + 6 * count))
        for number, (place, one) in enumerate(self.targets.items()):
            site = human.model.site(f"sensor_{place}").id
            rows, columns = slice(6 * number, 6 * number + 6), len(FREE) + 6 * number
            matrix = data.site_xmat[site].reshape(3, 3)
            seen = Rotation.from_quat(one.orientations[self.frames[sample]], scalar_first=True)
            turned = (Rotation.from_matrix(matrix) * seen.inv()).as_rotvec()
            apart = data.site_xpos[site] - one.positions[self.frames[sample]]
            rest[rows] = [*(apart / NOISE_M), *(turned / NOISE_RAD)]
            jacobian = np.zeros((6, nv))
            mujoco.mj_jacSite(human.model, data, jacobian[:3], jacobian[3:], site)
            by_posture[rows] = jacobian / np.repeat([NOISE_M, NOISE_RAD], 3)[:, None]
            body = data.xmat[human.model.site_bodyid[site]].reshape(3, 3)
            by_other[rows.start : rows.start + 3, columns : columns + 3] = body / NOISE_M
            by_other[rows.start + 3 : rows.stop, columns + 3 : columns + 6] = matrix / NOISE_RAD
            by_other[rows.start : rows.start + 3, : len(FREE)] = shapes[place][sample] / NOISE_M
        return rest, by_posture, by_other

    def _priors(self, usual: Human, longer: Sequence[Human]) -> tuple[np.ndarray, np.ndarray]:
        """What is known beforehand: measures by survey or tape, sensors near their places."""
        free, size = len(FREE), len(FREE) + 6 * len(self.targets)
        matrix = np.zeros((free + 3 * len(self.targets), size))
        rest = np.zeros(len(matrix))
        for number, name in enumerate(FREE):
            matrix[number, number] = 1.0 / self.prior.deviations[name]
            rest[number] = self.measures[name] - self.prior[name]
            rest[number] /= self.prior.deviations[name]
        moves, turns = [_nominal(body) for body in longer], np.zeros(size)
        nominal = _nominal(usual)
        for number, place in enumerate(self.targets):
            rows = slice(free + 3 * number, free + 3 * number + 3)
            column = free + 6 * number
            matrix[rows, column : column + 3] = np.eye(3) / PLACEMENT_M
            for n, moved in enumerate(moves):
                matrix[rows, n] = -(moved[place] - nominal[place]) / DELTA_M / PLACEMENT_M
            rest[rows] = (self.mounts[place].pose.translation - nominal[place]) / PLACEMENT_M
            turns[column + 3 : column + 6] = 1e-6
        return matrix.T @ matrix + np.diag(turns), matrix.T @ rest

    def _apply(self, change: np.ndarray) -> None:
        self.measures = _longer(self.measures, dict(zip(FREE, change, strict=False)))
        for number, place in enumerate(self.targets):
            moved, turned = change[len(FREE) + 6 * number :][:6].reshape(2, 3)
            pose = self.mounts[place].pose
            spot, turn = pose.translation + moved, pose.rotation * Rotation.from_rotvec(turned)
            pose = RigidTransform.from_components(spot, turn)
            self.mounts[place] = Mount(place, places()[place], pose)

    def _by_measure(
        self, human: Human, longer: Sequence[Human]
    ) -> dict[str, Float[np.ndarray, "samples 3 measures"]]:
        """Change of every sensor's place with every measure, by place."""
        sites = {place: f"sensor_{place}" for place in self.mounts}
        base = human.sites(self.postures, sites.values())
        moved = [mounted(body, self.mounts).sites(self.postures, sites.values()) for body in longer]
        return {
            place: np.stack([(each[site][0] - base[site][0]) / DELTA_M for each in moved], axis=2)
            for place, site in sites.items()
        }


def _nominal(human: Human) -> dict[str, np.ndarray]:
    """Nominal places of the sensors in their segments [m]."""
    return {place: np.array(human.model.site(f"sensor_{place}").pos) for place in places()}


def _longer(measures: Measures, by_m: Mapping[str, float]) -> Measures:
    """The measures with some of them longer [m]."""
    values = {name: measures[name] + float(more) for name, more in by_m.items()}
    return replace(measures, values={**measures.values, **values})
