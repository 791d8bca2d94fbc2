"""The clock of a recording."""

from weakref import ref

import numpy as np
from jaxtyping import Float

DECIMALS = 9
"""Places to which a step of time is rounded: nanoseconds, so that any part has the whole's step."""

_KEPT: dict[int, tuple["ref[np.ndarray]", float]] = {}
"""Steps of clocks that cannot change, by their identity, as long as they live."""


def time_step(times: Float[np.ndarray, "frames"]) -> float:
    """The median step of a clock [s]."""
    if times.flags.writeable:
        return _median_step(times)
    key = id(times)
    clock, step = _KEPT.get(key, (None, 0.0))
    if clock is None or clock() is not times:
        step = _median_step(times)
        _KEPT[key] = ref(times, lambda _: _KEPT.pop(key, None)), step
    return step


def _median_step(times: Float[np.ndarray, "frames"]) -> float:
    return round(float(np.median(np.diff(times))), DECIMALS)


def frame_rate(times: Float[np.ndarray, "frames"]) -> float:
    """Frames a second, from the median step [Hz]."""
    return 1.0 / time_step(times)
