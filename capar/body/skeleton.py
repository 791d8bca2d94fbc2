"""The skeleton in its standing posture: where each segment begins and ends, from measures."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.body.anthropometry import Measures
from capar.body.data_files import is_right, mirrored

SPINE = {
    "lumbar_lower": (0.0, 0.15),
    "lumbar_upper": (0.15, 0.38),
    "thorax_lower": (0.38, 0.70),
    "thorax_upper": (0.70, 1.0),
}
"""Where the spine bends, from the sacrum (0) to cervicale (1): L5/S1, L3/4, T12/L1, T6/7."""

SACRUM_ABOVE_HIPS = 0.045
"""Height of L5/S1 above the hip joints [share of stature] (estimate)."""

SHOULDER_BELOW_ACROMION = 0.0265
"""Depth of the shoulder's centre below the acromion [share of stature]."""

SHOULDER_BREADTH = 0.92
"""Distance of the shoulders' centres as a share of the biacromial breadth [1] (estimate)."""

HIP_OF_SPINES = 0.36
"""Distance of a hip joint from the midline, of the breadth between the spines (Bell 1990) [1]."""

HEAD_BELOW_EYES = 0.013
"""Depth of the head's joint below the eyes [share of stature] (estimate)."""


HEEL = 0.26
"""How far the heel lies behind the ankle [share of the foot's length] (estimate)."""

BALL = 0.47
"""How far the ball of the foot lies before the ankle [share of the foot's length] (estimate)."""


@dataclass(frozen=True, eq=False)
class Segment:
    """One rigid part of the body, in the world's axes, standing with the arms down."""

    name: str
    parent: str
    """Name of the segment that it hangs on; empty for the pelvis."""

    origin: Float[np.ndarray, "3"]
    """Its joint with the parent [m]."""

    tip: Float[np.ndarray, "3"]
    """Its far end: the next joint, or where it ends [m]."""

    @property
    def length(self) -> float:
        """From joint to far end [m]."""
        return float(np.linalg.norm(self.tip - self.origin))


def skeleton(measures: Measures) -> Mapping[str, Segment]:
    """Every segment by name, each after its parent; x forward, y left, z up, feet on z = 0."""
    right = [*_arm(measures), *_leg(measures), _eye(measures)]
    segments = [*_trunk(measures), *right, *(_mirror(each) for each in right)]
    return {each.name: each for each in segments}


def _trunk(m: Measures) -> list[Segment]:
    tall, hip, neck = m["stature"], m.hip_height, m["cervicale_height"]
    sacrum = hip + SACRUM_ABOVE_HIPS * tall
    out = [_upright("pelvis", "", hip, sacrum)]
    for name, (low, high) in SPINE.items():
        span = neck - sacrum
        out.append(_upright(name, out[-1].name, sacrum + low * span, sacrum + high * span))
    skull = m["eye_height"] - HEAD_BELOW_EYES * tall
    at = np.array([0.008 * tall, 0.0, skull])
    out.append(Segment("neck", "thorax_upper", np.array([0.0, 0.0, neck]), at))
    out.append(Segment("head", "neck", at, np.array([0.008 * tall, 0.0, tall])))
    return out


def _upright(name: str, parent: str, low: float, high: float) -> Segment:
    return Segment(name, parent, np.array([0.0, 0.0, low]), np.array([0.0, 0.0, high]))


def eyes_between(m: Measures) -> Float[np.ndarray, "3"]:
    """The point between the eyes, standing [m]."""
    forward = 0.008 * m["stature"] + 0.40 * m["head_length"]
    return np.array([forward, 0.0, m["eye_height"]])


def _eye(m: Measures) -> Segment:
    at = eyes_between(m) - [0.0, 0.5 * m["pupil_distance"], 0.0]
    return Segment("right_eye", "head", at, at + np.array([0.012, 0.0, 0.0]))


def _arm(m: Measures) -> list[Segment]:
    tall, down = m["stature"], np.array([0.0, 0.0, -1.0])
    aside = -0.5 * SHOULDER_BREADTH * m["shoulder_breadth"]
    shoulder = np.array([0.0, aside, m["acromial_height"] - SHOULDER_BELOW_ACROMION * tall])
    sternum = np.array([0.03 * tall, -0.012 * tall, m["suprasternale_height"] - 0.005 * tall])
    elbow = shoulder + m["upper_arm"] * down
    wrist = elbow + m["forearm"] * down
    hand = m["hand_length"]
    knuckle, middle = wrist + 0.52 * hand * down, wrist + 0.78 * hand * down
    base = wrist + 0.22 * hand * down + [0.16 * hand, 0.04 * hand, 0.0]
    thumb = base + 0.36 * hand * np.array([0.45, 0.15, -0.88])
    return [
        Segment("right_clavicle", "thorax_upper", sternum, shoulder),
        Segment("right_upper_arm", "right_clavicle", shoulder, elbow),
        Segment("right_forearm", "right_upper_arm", elbow, wrist),
        Segment("right_hand", "right_forearm", wrist, knuckle),
        Segment("right_fingers", "right_hand", knuckle, middle),
        Segment("right_fingertips", "right_fingers", middle, wrist + hand * down),
        Segment("right_thumb", "right_hand", base, thumb),
    ]


def _leg(m: Measures) -> list[Segment]:
    aside, foot = -HIP_OF_SPINES * m["spine_breadth"], m["foot_length"]
    hip = np.array([0.0, aside, m.hip_height])
    knee = hip - [0.0, 0.0, m["thigh"]]
    ankle = knee - [0.0, 0.0, m["shank"]]
    ball = np.array([BALL * foot, aside, 0.35 * m["ankle_height"]])
    toe = ball + np.array([(1.0 - HEEL - BALL) * foot, 0.0, 0.0])
    return [
        Segment("right_thigh", "pelvis", hip, knee),
        Segment("right_shank", "right_thigh", knee, ankle),
        Segment("right_foot", "right_shank", ankle, ball),
        Segment("right_toes", "right_foot", ball, toe),
    ]


def _mirror(each: Segment) -> Segment:
    parent = mirrored(each.parent) if is_right(each.parent) else each.parent
    flip = np.array([1.0, -1.0, 1.0])
    return Segment(mirrored(each.name), parent, each.origin * flip, each.tip * flip)
