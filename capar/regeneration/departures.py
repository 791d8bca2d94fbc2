"""How far performed hands and moved things are from where the capture has them."""

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.geometry import transforms
from capar.regeneration.motions import Motion
from capar.regeneration.quality import Measure


def departures(motion: Motion) -> tuple[Measure, ...]:
    """The largest distance of each hand and each moved thing from its recorded place [mm].

    The capture's own poses are compared, hands by the frame along the axes of their hulls. In
    the recorded scene they say how exactly the recorded body does again what it did.
    """
    plan = motion.plan
    capture, out = plan.source.capture, []
    for side, hand in plan.source.hands.items():
        name = f"{side}_palm"
        spots, turns = plan.human.sites(motion.postures, [name])[name]
        palms = RigidTransform.from_components(spots, Rotation.from_quat(turns, scalar_first=True))
        performed = palms * plan.frames.palms[side].inv()
        stream = capture.sensor(hand.sensor).stream
        known = ~np.isnan(stream.positions[:, 0])
        recorded = transforms(stream.positions[known], stream.orientations[known]) * hand.frame.pose
        out.append(_largest(f"{side} hand", performed.translation, recorded.translation, known))
    for name in plan.goals:
        recorded_spots = capture.tag_object(name).stream.positions
        known = ~np.isnan(recorded_spots[:, 0])
        out.append(_largest(name, plan.things[name].translation, recorded_spots[known], known))
    return tuple(out)


def _largest(
    name: str,
    performed: Float[np.ndarray, "frames 3"],
    recorded: Float[np.ndarray, "known 3"],
    known: np.ndarray,
) -> Measure:
    apart = np.linalg.norm(performed[known] - recorded, axis=1)
    worst = int(apart.argmax())
    frame = int(np.flatnonzero(known)[worst])
    return Measure("from the recorded way", 1e3 * float(apart[worst]), "mm", frame, name)
