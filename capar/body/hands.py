"""A simple grasp: fingers and thumb closed until a given width fits between their tips."""

import numpy as np
from jaxtyping import Float

from capar.body.human import Human
from capar.model.errors import CaparError

OPEN = {"knuckle_flexion": 0.0, "finger_flexion": 0.0, "thumb_opposition": 0.0}
"""Angles of an open hand [rad]."""

FIST = {"knuckle_flexion": 1.4, "finger_flexion": 1.6, "thumb_opposition": 1.0}
"""Angles of a closed hand [rad] (estimate)."""


class GraspError(CaparError):
    """A width that a hand cannot close round."""


def grasp(human: Human, side: str, width_m: float | None) -> dict[str, float]:
    """Angles of one hand's hinges [rad].

    Args:
        human: Whose hand.
        side: ``right`` or ``left``.
        width_m: What lies between finger and thumb tips [m]; None opens the hand.

    Raises:
        GraspError: The hand is too small for that width, or too large.
    """
    if width_m is None:
        return _angles(side, 0.0)
    grid = np.linspace(0.0, 1.0, 201)
    widths = _apertures(human, side, grid)
    closing = int(np.argmin(widths)) + 1
    if not widths[:closing].min() <= width_m <= widths[0]:
        raise GraspError(
            f"no grasp {width_m * 1000:.0f} mm wide; this hand closes round "
            f"{widths.min() * 1000:.0f} to {widths[0] * 1000:.0f} mm"
        )
    share = np.interp(width_m, widths[:closing][::-1], grid[:closing][::-1])
    return _angles(side, float(share))


def _angles(side: str, share: float) -> dict[str, float]:
    return {f"{side}_{n}": (1.0 - share) * OPEN[n] + share * FIST[n] for n in OPEN}


def _apertures(
    human: Human, side: str, shares: Float[np.ndarray, "shares"]
) -> Float[np.ndarray, "shares"]:
    """Distance between finger tip and thumb tip of a hand so far closed [m]."""
    postures = np.array([human.posture(_angles(side, float(share))) for share in shares])
    tips = (f"{side}_fingertip", f"{side}_thumb_tip")
    places = human.sites(postures, tips)
    return np.array(
        [
            np.linalg.norm(finger - thumb)
            for finger, thumb in zip(places[tips[0]][0], places[tips[1]][0], strict=True)
        ]
    )
