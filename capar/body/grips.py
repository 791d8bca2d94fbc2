"""Where a palm lies on a thing: from the side or from above, thumb up or fingers forward."""

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures
from capar.body.body_shapes import PALM, PALM_FROM_WRIST
from capar.body.things import Thing

AIR_M = 0.0005
"""What is left between palm and thing, so that surfaces touch and do not cut [m]."""

CLEAR_M = 0.014
"""How far a hand at a thing's side stays above what the thing stands on [m]."""

WRIST_OUT_M = 0.022
"""How far the wrist of a hand at a box's side is out of the box, and with it the forearm [m]."""

YAWS = (0.0, -0.35, -0.7, -1.05, 0.35)
"""Directions of the fingers tried on a round thing, outwards positive [rad]."""

ROLLS = (0.0, 0.7, 1.2, 1.4, 1.57)
"""How far the fingers on a thing's near side lean outwards from upright [rad]."""

PITCHES = (0.0, 0.25, 0.5)
"""Likewise their rise above the level [rad]."""


def side_grip(
    thing: Thing, side: str, measures: Measures, *, yaw: float = 0.0, pitch: float = 0.0
) -> RigidTransform:
    """``T_thing_palm`` of a hand at its own side of a thing, thumb up, fingers forward.

    Args:
        thing: Whose frame it is in; fingers point along its x axis.
        side: ``right`` or ``left``.
        measures: Whose hand; it stays clear of what the thing stands on.
        yaw: Turn of the grip about the thing's axis, outwards positive [rad].
        pitch: Rise of the fingers above the level [rad].
    """
    sign = 1.0 if side == "right" else -1.0
    turn = Rotation.from_euler("z", -sign * yaw)
    inwards = turn.apply([0.0, sign, 0.0])
    fingers = turn.apply([np.cos(pitch), 0.0, np.sin(pitch)])
    low, high = thing.shape.bounds
    heel = PALM[0] * np.cos(pitch) + 0.44 * np.sin(pitch)
    height = max(0.5 * (low[2] + high[2]), low[2] + heel * measures["hand_length"] + CLEAR_M)
    reach = (-low[1] if side == "right" else high[1]) + AIR_M
    place = np.array([0.0, 0.0, height]) - inwards * reach
    if not thing.round:
        wrist = PALM_FROM_WRIST * np.cos(pitch) * measures["hand_length"]
        place[0] = min(0.0, low[0] - WRIST_OUT_M + wrist)
    return RigidTransform.from_components(place, palm_turn(inwards, fingers))


def top_grip(thing: Thing, side: str, measures: Measures, *, yaw: float = 0.0) -> RigidTransform:
    """``T_thing_palm`` of a hand laid on top of a thing, fingers forward."""
    sign = 1.0 if side == "right" else -1.0
    fingers = Rotation.from_euler("z", sign * yaw).apply([1.0, 0.0, 0.0])
    top = np.array([0.0, 0.0, thing.shape.bounds[1, 2] + AIR_M])
    back = 0.1 * measures["hand_length"] * fingers
    return RigidTransform.from_components(top - back, palm_turn([0.0, 0.0, -1.0], fingers))


def back_grip(thing: Thing, side: str, measures: Measures, *, roll: float = 0.0) -> RigidTransform:
    """``T_thing_palm`` of a hand on the side that faces the performer, fingers upwards.

    Args:
        thing: Whose frame it is in; its x axis leads away from the performer.
        side: ``right`` or ``left``.
        measures: Whose hand; its heel stays clear of what the thing stands on.
        roll: How far the fingers lean outwards from upright [rad].
    """
    sign = 1.0 if side == "right" else -1.0
    fingers = np.array([0.0, -sign * np.sin(roll), np.cos(roll)])
    low, high = thing.shape.bounds
    heel = PALM[0] * np.cos(roll) + 0.44 * np.sin(roll)
    height = max(0.5 * (low[2] + high[2]), low[2] + heel * measures["hand_length"] + CLEAR_M)
    place = np.array([low[0] - AIR_M, 0.0, height])
    return RigidTransform.from_components(place, palm_turn([1.0, 0.0, 0.0], fingers))


def palm_turn(
    inwards: Float[np.ndarray, "3"] | list[float], fingers: Float[np.ndarray, "3"]
) -> Rotation:
    """Orientation of a palm that faces one way and whose fingers point another."""
    z, x = np.asarray(inwards, dtype=float), np.asarray(fingers, dtype=float)
    return Rotation.from_matrix(np.stack([x, np.cross(z, x), z], axis=1))
