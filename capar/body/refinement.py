"""Functional calibration: limb lengths and places of sensors from a motion, with uncertainty.

Arm circles and a reach decide lengths that a reference posture cannot: where a limb is longer
than assumed, no posture fits all sensors at once. Lengths, the places of the sensors and the
postures of some frames are estimated together by Gauss-Newton steps, each from its prior.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures
from capar.body.fitting import Fit
from capar.body.human import ROOT_SIZE, Human
from capar.body.mounting import PLACEMENT_M, Calibration, Mount, mounted, places
from capar.body.targets import Target, target
from capar.model.capture import Stream
from capar.model.errors import CaparError

FREE = (
    "upper_arm", "forearm", "acromial_height", "shoulder_breadth", "cervicale_height",
    "thigh", "shank", "spine_breadth",
)  # fmt: skip
"""The measures that decide where joints are, and are estimated."""

SAMPLES = 60
"""Frames that take part."""

NOISE_M = 0.002
"""Deviation of a filtered sensor's place, soft tissue included [m]."""

NOISE_RAD = float(np.radians(0.7))
"""Deviation of a filtered sensor's orientation, soft tissue included [rad]."""

REFERENCE_RAD = float(np.radians(1.5))
"""Deviation of a hinge from the reference posture that somebody takes up [rad]."""

LOOSE_RAD = 1.0
"""Deviation of a hinge from standing, during the motion [rad]."""

ROUNDS = 6
"""Gauss-Newton steps."""


class RefinementError(CaparError):
    """A motion from which no measures can be estimated."""


@dataclass(frozen=True, eq=False)
class Refinement:
    """What a motion says of its performer's measures."""

    measures: Measures
    """The measures, each with its deviation after the motion was seen."""

    calibration: Calibration
    """The sensors on the body with these measures."""

    gained: Mapping[str, float]
    """Of each estimated measure, its deviation as a share of the one before [1]."""


@dataclass(eq=False)
class _State:
    """Where the estimate stands."""

    measures: Measures
    mounts: dict[str, Mount]
    postures: Float[np.ndarray, "samples posture"]

    @property
    def human(self) -> Human:
        plain = Human.of(self.measures)
        return mounted(plain, Calibration(self.mounts, plain.posture(), {}))


def refine(
    made: Fit, streams: Mapping[str, Stream], calibration: Calibration, *, samples: int = SAMPLES
) -> Refinement:
    """Estimate measures and the places of sensors from a motion that was fitted.

    Args:
        made: The motion fitted to the same sensors.
        streams: By place, as recorded.
        calibration: From the reference posture at the beginning.
        samples: How many frames take part.

    Raises:
        RefinementError: Fewer than ten frames have all the sensors.
    """
    targets = {place: target(streams[place]) for place in calibration.mounts}
    seen = np.flatnonzero(np.min([each.weights for each in targets.values()], axis=0) >= 1.0)
    if len(seen) < 10:
        raise RefinementError(f"{len(seen)} frames with all of {sorted(targets)}; ten are needed")
    frames = np.unique(seen[np.linspace(0, len(seen) - 1, samples).astype(int)])
    postures = made.motion[frames].copy()
    postures[0] = calibration.posture
    state = _State(made.human.measures, dict(calibration.mounts), postures)
    problem = _Problem(targets, frames, calibration, made.human.measures)
    for _ in range(ROUNDS):
        covariance = problem.step(state)
    before = made.human.measures.deviations
    after = {name: float(np.sqrt(covariance[n, n])) for n, name in enumerate(FREE)}
    measures = _with(state.measures, {}, {**before, **after})
    refined = Calibration(state.mounts, calibration.posture, calibration.misplaced)
    return Refinement(measures, refined, {name: after[name] / before[name] for name in FREE})


@dataclass(frozen=True, eq=False)
class _Problem:
    """Targets and priors."""

    targets: Mapping[str, Target]
    frames: np.ndarray
    calibration: Calibration
    prior: Measures

    def step(self, state: _State) -> Float[np.ndarray, "parameters parameters"]:
        """One Gauss-Newton step with the postures eliminated; returns the covariance."""
        human = state.human
        shapes = _by_measure(state, self.frames.size)
        schur, pull = self._priors(state, human)
        kept = []
        for sample in range(len(self.frames)):
            rest, by_posture, by_other = self._frame(state, human, sample, shapes)
            own = by_posture.T @ by_posture + np.diag(self._stiffness(sample) ** 2)
            own_pull = by_posture.T @ rest + self._stiffness(sample) ** 2 * self._away(
                state, sample
            )
            cross = by_posture.T @ by_other
            solved = np.linalg.solve(own, np.column_stack([cross, own_pull]))
            schur += by_other.T @ by_other - cross.T @ solved[:, :-1]
            pull += by_other.T @ rest - cross.T @ solved[:, -1]
            kept.append(solved)
        covariance = np.linalg.inv(schur)
        change = -covariance @ pull
        for sample, solved in enumerate(kept):
            _move(human, state.postures[sample], -solved[:, -1] - solved[:, :-1] @ change)
        self._apply(state, change)
        return covariance

    def _frame(
        self, state: _State, human: Human, sample: int, shapes: Mapping[str, np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Residuals of one frame over noise, and how they change with posture and parameters."""
        data = mujoco.MjData(human.model)
        data.qpos[:] = state.postures[sample]
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

    def _stiffness(self, sample: int) -> np.ndarray:
        """One over the deviation of each degree of freedom from where it is expected."""
        loose = np.full(66, 1.0 / (REFERENCE_RAD if sample == 0 else LOOSE_RAD))
        loose[:6] = 1e-3
        return loose

    def _away(self, state: _State, sample: int) -> np.ndarray:
        """How far each degree of freedom is from where it is expected."""
        away = np.zeros(66)
        expected = self.calibration.posture[ROOT_SIZE:] if sample == 0 else 0.0
        away[6:] = state.postures[sample, ROOT_SIZE:] - expected
        return away

    def _priors(self, state: _State, human: Human) -> tuple[np.ndarray, np.ndarray]:
        """What is known beforehand: measures by survey or tape, sensors near their places."""
        size = len(FREE) + 6 * len(self.targets)
        rows, rest = [], []
        for number, name in enumerate(FREE):
            row = np.zeros(size)
            row[number] = 1.0 / self.prior.deviations[name]
            rows.append(row)
            rest.append((state.measures[name] - self.prior[name]) / self.prior.deviations[name])
        moves = {name: _nominal(_varied(state.measures, name)) for name in FREE}
        usual = _nominal(state.measures)
        for number, place in enumerate(self.targets):
            here = state.mounts[place].pose.translation - usual[place]
            for axis in range(3):
                row = np.zeros(size)
                row[len(FREE) + 6 * number + axis] = 1.0 / PLACEMENT_M
                for n, name in enumerate(FREE):
                    row[n] = -(moves[name][place] - usual[place])[axis] / DELTA_M / PLACEMENT_M
                rows.append(row)
                rest.append(here[axis] / PLACEMENT_M)
        matrix = np.array(rows)
        turns = np.zeros(size)
        for number in range(len(self.targets)):
            turns[len(FREE) + 6 * number + 3 : len(FREE) + 6 * number + 6] = 1e-6
        return matrix.T @ matrix + np.diag(turns), matrix.T @ np.array(rest)

    def _apply(self, state: _State, change: np.ndarray) -> None:
        values = {n: state.measures[n] + float(change[i]) for i, n in enumerate(FREE)}
        state.measures = _with(state.measures, values, state.measures.deviations)
        for number, place in enumerate(self.targets):
            moved, turned = change[len(FREE) + 6 * number :][:6].reshape(2, 3)
            pose = state.mounts[place].pose
            state.mounts[place] = Mount(
                place,
                places()[place],
                RigidTransform.from_components(
                    pose.translation + moved, pose.rotation * Rotation.from_rotvec(turned)
                ),
            )


DELTA_M = 1e-4
"""Step of finite differences [m]."""


def _by_measure(state: _State, samples: int) -> dict[str, np.ndarray]:
    """Change of every sensor's place with every measure, by place: (samples, 3, measures)."""
    names = [f"sensor_{each}" for each in state.mounts]
    base = state.human.sites(state.postures, names)
    out = {place: np.empty((samples, 3, len(FREE))) for place in state.mounts}
    for number, name in enumerate(FREE):
        varied = _State(_varied(state.measures, name), state.mounts, state.postures)
        moved = varied.human.sites(state.postures, names)
        for place in state.mounts:
            step = moved[f"sensor_{place}"][0] - base[f"sensor_{place}"][0]
            out[place][:, :, number] = step / DELTA_M
    return out


def _varied(measures: Measures, name: str) -> Measures:
    return _with(measures, {name: measures[name] + DELTA_M}, measures.deviations)


def _nominal(measures: Measures) -> dict[str, np.ndarray]:
    """Nominal places of the sensors in their segments [m]."""
    model = Human.of(measures).model
    return {place: np.array(model.site(f"sensor_{place}").pos) for place in places()}


def _with(
    measures: Measures, values: Mapping[str, float], deviations: Mapping[str, float]
) -> Measures:
    changed = {**measures.values, **values}
    return Measures(measures.sex, measures.age, changed, measures.given, deviations)


def _move(human: Human, posture: np.ndarray, change: Sequence[float] | np.ndarray) -> None:
    """Move a posture by a step of its degrees of freedom, within the hinges' ranges."""
    mujoco.mj_integratePos(human.model, posture, np.asarray(change), 1.0)
    low, high = human.ranges.T
    posture[ROOT_SIZE:] = np.clip(posture[ROOT_SIZE:], low, high)
