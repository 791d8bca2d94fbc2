"""The clock of a recording."""

import numpy as np
from jaxtyping import Float

DECIMALS = 9
"""Places to which a step of time is rounded: nanoseconds, so that any part has the whole's step."""


def time_step(times: Float[np.ndarray, "frames"]) -> float:
    """The median step of a clock [s]."""
    return round(float(np.median(np.diff(times))), DECIMALS)


def frame_rate(times: Float[np.ndarray, "frames"]) -> float:
    """Frames a second, from the median step [Hz]."""
    return 1.0 / time_step(times)
