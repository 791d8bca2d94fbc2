"""Looking at a point: eyes, head, neck and trunk share the turn (thesis 3.5)."""

import mink
import numpy as np
from jaxtyping import Float

from capar.body.human import Human
from capar.model import geometry

EYES = ("right_pupil", "left_pupil")
LOOK_COST = 4.0  # weight of a radian that a line of sight misses its point by

#: Weight of a radian of each part that turns with the gaze: what costs more turns less
SHARES = {"eye": 0.045, "head": 0.05, "neck": 0.05, "thorax": 0.7, "lumbar": 1.0}
#: Likewise of the legs, which do not take part and keep standing
STANCE = {"hip": 1.0, "knee": 1.0, "ankle": 1.0}


class LookTask(mink.LookAtTask):
    """Measures its error without the Jacobian, which a trial of a step does not need."""

    def compute_error(self, configuration: mink.Configuration) -> Float[np.ndarray, "3"]:
        """The axis less the direction of the target, both in the frame that looks [1]."""
        pose = configuration.get_transform_frame_to_world(self.frame_name, self.frame_type)
        way = pose.rotation().as_matrix().T @ (self.target_pos - pose.translation())
        return np.asarray(self.axis - way / max(float(np.linalg.norm(way)), 1e-12))


def look_tasks() -> dict[str, mink.LookAtTask]:
    """A task for each eye's line of sight, along its x axis."""
    return {eye: LookTask(eye, "site", axis=(1.0, 0.0, 0.0), cost=LOOK_COST) for eye in EYES}


def share_costs(human: Human, usual: float) -> Float[np.ndarray, "dofs"]:
    """Weight of every degree of freedom in posture tasks: ``usual`` where gaze has no part."""
    out = np.full(human.model.nv, usual)
    out[:6] = 0.0
    for number, joint in enumerate(human.joints):
        for part, cost in (SHARES | STANCE).items():
            if part in joint:
                out[6 + number] = cost
    return out


def lines_of_sight(
    human: Human, motion: Float[np.ndarray, "frames posture"]
) -> tuple[Float[np.ndarray, "frames 3"], Float[np.ndarray, "frames 3"]]:
    """From where one looks [m], and in which direction: the mean of both eyes."""
    sites = human.sites(motion, EYES)
    spots = np.mean([sites[eye][0] for eye in EYES], axis=0)
    ways = np.sum([geometry.rotations(sites[e][1]).apply([1.0, 0.0, 0.0]) for e in EYES], axis=0)
    return spots, ways / np.linalg.norm(ways, axis=-1, keepdims=True)
