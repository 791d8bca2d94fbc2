"""The postures found for key frames, to which a motion can be drawn.

Frame by frame, inverse kinematics may come to a hold with the arm bent another way than in the
posture that reaches it, and stay there.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.regeneration.drafts import Draft

FADE_S = 0.6
"""How long before the first key frame and after the last one a motion is drawn to them [s]."""


@dataclass(frozen=True, eq=False)
class Guide:
    """A posture for every frame, and how strongly a motion is drawn to it."""

    postures: Float[np.ndarray, "frames posture"]
    weights: Float[np.ndarray, "frames"]
    """[1]."""


def guide_of(draft: Draft) -> Guide:
    """The key postures of a draft whose grips are chosen, and straight ways between them.

    Args:
        draft: With grips that reach.
    """
    keys, rest = draft.key_postures()
    times, shown = draft.source.times, sorted(keys)
    at_s = [times[shown[0]] - FADE_S, *times[shown], times[shown[-1]] + FADE_S]
    rows = np.array([rest, *(keys[frame] for frame in shown), rest])
    postures = np.stack([np.interp(times, at_s, column) for column in rows.T], axis=1)
    weights = np.interp(times, at_s, [0.0, *np.ones(len(shown)), 0.0])
    return Guide(postures, weights)
