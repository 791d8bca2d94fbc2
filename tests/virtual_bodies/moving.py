"""Motions of a body in closed form: hinges swing smoothly out of the standing posture."""

from typing import TypeAlias

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.anthropometry import mirrored, ready_made
from capar.body.human import ROOT_SIZE, Human

MILLIMETRE = 1e-3
TENTH_DEG = float(np.radians(0.1))
"""How exactly a motion that was written is to be read back [m], [rad]."""

Moved: TypeAlias = tuple[Human, np.ndarray, np.ndarray]
"""A body, times [s], and what each joint does."""

SPINE = ("lumbar_lower", "lumbar_upper", "thorax_lower", "thorax_upper")
HINGES = {
    "clavicle_protraction": (-5, 12),
    "clavicle_elevation": (-2, 15),
    "shoulder_flexion": (-15, 80),
    "shoulder_abduction": (2, 35),
    "shoulder_rotation": (-30, 35),
    "elbow_flexion": (8, 110),
    "forearm_pronation": (-40, 50),
    "wrist_flexion": (-30, 30),
    "wrist_deviation": (-15, 12),
    "hip_flexion": (0, 30),
    "hip_abduction": (-2, 8),
    "hip_rotation": (-8, 8),
    "knee_flexion": (2, 45),
    "ankle_dorsiflexion": (-10, 15),
    "ankle_inversion": (-5, 5),
}
"""Range in which a paired hinge swings [degrees]."""

AXES = {"flexion": 25, "bend": 10, "turn": 15}
"""Largest sum over spine, and over neck and head [degrees], shared as the levels' ranges are."""


def turning(who: str, *, rate_hz: float, seed: int, turns_radps: float) -> Moved:
    """Two seconds of somebody who moves every joint while turning round so fast."""
    human = Human.of(ready_made(who))
    times = np.arange(0.0, 2.0, 1.0 / rate_hz)
    motion = swinging(human, times, seed, still_s=0.1)
    heading = Rotation.from_euler("z", turns_radps * times[:, None])
    motion[:, 3:7] = heading.as_quat(scalar_first=True)
    return human, times, motion


def swinging(
    human: Human, times: Float[np.ndarray, "frames"], seed: int, *, still_s: float = 0.5
) -> Float[np.ndarray, "frames posture"]:
    """A motion of the whole body after standing still; observed hinges all move."""
    rng = np.random.default_rng(seed)
    out = np.tile(human.posture(), (len(times), 1))
    for name, (low, high) in HINGES.items():
        for joint in (f"right_{name}", mirrored(f"right_{name}")):
            out[:, human.index(joint)] = np.radians(_swing(times, low, high, rng, still_s))
    for axis, most in AXES.items():
        for levels in (SPINE, ("neck", "head")):
            swing = _swing(times, -0.3 * most, most, rng, still_s)
            _share(human, out, [f"{each}_{axis}" for each in levels], np.radians(swing))
    out[:, 0] += _swing(times, -0.1, 0.1, rng, still_s)
    out[:, 1] += _swing(times, -0.1, 0.1, rng, still_s)
    out[:, 2] += _swing(times, -0.05, 0.0, rng, still_s)
    return out


def _share(human: Human, out: np.ndarray, joints: list[str], total: np.ndarray) -> None:
    numbers = [human.index(each) for each in joints]
    wide = np.ptp(human.ranges[np.array(numbers) - ROOT_SIZE], axis=1)
    out[:, numbers] = total[:, None] * wide / wide.sum()


def _swing(
    times: np.ndarray, low: float, high: float, rng: np.random.Generator, still_s: float
) -> np.ndarray:
    """Two sines between bounds, faded in from zero with continuous acceleration."""
    slow, fast = rng.uniform(0.15, 0.35), rng.uniform(0.4, 0.8)
    a, b = rng.uniform(0.0, 2 * np.pi, 2)
    wave = 0.7 * np.sin(2 * np.pi * slow * times + a) + 0.3 * np.sin(2 * np.pi * fast * times + b)
    share = np.clip((times - still_s) / 1.5, 0.0, 1.0)
    fade = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return fade * (0.5 * (low + high) + 0.5 * (high - low) * wave)
