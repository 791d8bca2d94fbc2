"""Looking at a point: eyes, head, neck and trunk share the turn (thesis 3.5)."""

from collections.abc import Iterable
from dataclasses import dataclass

import mink
import numpy as np
from jaxtyping import Float

from capar.body.human import Human

EYES = ("right_pupil", "left_pupil")
LOOK_COST = 4.0
"""Weight of a radian that a line of sight misses its point by."""

SHARES = {"eye": 0.045, "head": 0.05, "neck": 0.05, "thorax": 0.7, "lumbar": 1.0}
"""Weight of a radian of each part that turns with the gaze: what costs more turns less."""

STANCE = {"hip": 1.0, "knee": 1.0, "ankle": 1.0}
"""Likewise of the legs, which do not take part and keep standing."""

ROUNDS = 40
"""Iterations for a single posture."""


@dataclass(frozen=True, eq=False)
class Gaze:
    """A posture that looks at a point, and how well."""

    posture: Float[np.ndarray, "posture"]
    missed_rad: Float[np.ndarray, "2"]
    """Angle between each eye's line of sight and the point, right eye first [rad]."""

    eyes_rad: float
    """Angle that the eyes take of the whole turn, seen from between them [rad]."""

    head_rad: float
    """Angle that head, neck and trunk take [rad]."""


def look_tasks() -> dict[str, mink.LookAtTask]:
    """A task for each eye's line of sight, along its x axis."""
    return {eye: mink.LookAtTask(eye, "site", axis=(1.0, 0.0, 0.0), cost=LOOK_COST) for eye in EYES}


def share_costs(human: Human, usual: float) -> Float[np.ndarray, "dofs"]:
    """Weight of every degree of freedom in posture tasks: ``usual`` where gaze has no part."""
    out = np.full(human.model.nv, usual)
    out[:6] = 0.0
    for number, joint in enumerate(human.joints):
        for part, cost in (SHARES | STANCE).items():
            if part in joint:
                out[6 + number] = cost
    return out


def look_at(human: Human, posture: Float[np.ndarray, "posture"], point: Iterable[float]) -> Gaze:
    """Turn eyes, head and trunk to a point [m], the pelvis and the limbs kept as they are."""
    configuration = mink.Configuration(human.model)
    configuration.update(posture)
    tasks = look_tasks()
    goal = np.array(list(point), dtype=float)
    for task in tasks.values():
        task.set_target(goal)
    aim = mink.PostureTask(human.model, cost=share_costs(human, 10.0))
    aim.set_target(posture)
    still = mink.FrameTask("pelvis", "body", 100.0, 100.0)
    still.set_target_from_configuration(configuration)
    limits = [mink.ConfigurationLimit(human.model)]
    for _ in range(ROUNDS):
        step = mink.solve_ik(
            configuration, [*tasks.values(), aim, still], 1.0, "daqp", limits=limits
        )
        configuration.integrate_inplace(step, 1.0)
    return measured_gaze(human, np.array(configuration.q), goal)


def measured_gaze(
    human: Human, posture: Float[np.ndarray, "posture"], point: Float[np.ndarray, "3"]
) -> Gaze:
    """How well a posture looks at a point, and which part turned how far from straight ahead."""
    sites = human.sites(posture[None], (*EYES, "head", "pelvis"))
    misses, sights = [], []
    for eye in EYES:
        sight = _forward(sites[eye][1][0])
        misses.append(_angle(sight, point - sites[eye][0][0]))
        sights.append(sight)
    head, body = (_forward(sites[each][1][0]) for each in ("head", "pelvis"))
    middle = np.sum(sights, axis=0)
    return Gaze(posture, np.array(misses), _angle(head, middle), _angle(body, head))


def lines_of_sight(
    human: Human, motion: Float[np.ndarray, "frames posture"]
) -> tuple[Float[np.ndarray, "frames 3"], Float[np.ndarray, "frames 3"]]:
    """From where one looks [m], and in which direction: the mean of both eyes."""
    sites = human.sites(motion, EYES)
    spots = np.mean([sites[eye][0] for eye in EYES], axis=0)
    ways = np.sum([_forward(sites[eye][1]) for eye in EYES], axis=0)
    return spots, ways / np.linalg.norm(ways, axis=-1, keepdims=True)


def _forward(quaternions: Float[np.ndarray, "*frames 4"]) -> Float[np.ndarray, "*frames 3"]:
    """The x axes of orientations w x y z."""
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    return np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=-1)


def _angle(first: Float[np.ndarray, "3"], second: Float[np.ndarray, "3"]) -> float:
    cross = np.linalg.norm(np.cross(first, second))
    return float(np.arctan2(cross, first @ second))
