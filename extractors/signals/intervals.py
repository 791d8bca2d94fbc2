"""Closed intervals of frames, and seconds as frames."""

from collections.abc import Callable, Sequence
from weakref import ref

import numpy as np
from jaxtyping import Bool

from capar.model import geometry
from capar.model.geometry import Holds, Series

DECIMALS = 9
"""Places to which a step of time is rounded: nanoseconds, so that any part has the whole's step."""

_KEPT: dict[int, tuple["ref[np.ndarray]", float]] = {}
"""Steps of clocks that cannot change, by their identity, as long as they live."""


def time_step(times: Series) -> float:
    """The median step of a clock [s]."""
    key = id(times)
    clock, step = _KEPT.get(key, (None, 0.0))
    if clock is None or clock() is not times:
        step = round(float(np.median(np.diff(times))), DECIMALS)
        if not times.flags.writeable:
            _KEPT[key] = ref(times, lambda _: _KEPT.pop(key, None)), step
    return step


def frame_rate(times: Series) -> float:
    """Frames a second, from the median step [Hz]."""
    return 1.0 / time_step(times)


Interval = tuple[int, int]
"""First and last frame, both inside."""

FramePredicate = Callable[[slice], Bool[np.ndarray, "some"]]
"""Whether something holds at each of some consecutive frames."""

NEAREST = 64
"""How many frames are asked about at first when one is looked for; each further time twice."""


def intervals(holds: Holds, times: Series, *, dropout_s: float, minimum_s: float) -> list[Interval]:
    """Where something holds, with short interruptions closed, then short stretches dropped.

    ``holds``: whether it holds at each frame. ``dropout_s``: an interruption shorter than this is
    closed [s]. ``minimum_s``: A stretch shorter than this is dropped [s]; a stretch of one frame
    lasts one step of time.
    """
    step = time_step(times)
    closed: list[Interval] = []
    for first, last in geometry.runs(holds):
        if closed and times[first] - times[closed[-1][1]] - step < dropout_s - 1e-9:
            closed[-1] = (closed[-1][0], last)
        else:
            closed.append((first, last))
    return [each for each in closed if duration(each, times, step) >= minimum_s - 1e-9]


def duration(interval: Interval, times: Series, step: float) -> float:
    """How long the frames of an interval last [s], each for one step of time [s]."""
    return float(times[interval[1]] - times[interval[0]]) + step


def mask(found: Sequence[Interval], frames: int) -> Holds:
    """Whether each frame lies in one of the intervals."""
    out = np.zeros(frames, dtype=bool)
    for first, last in found:
        out[first : last + 1] = True
    return out


def first_where(holds: FramePredicate, frame: int, frames: int) -> int | None:
    """The first of so many frames, from one on, at which something holds.

    It costs what the way to that frame does, however long the capture is.
    """
    few = NEAREST
    while frame < frames:
        found = np.flatnonzero(holds(slice(frame, min(frame + few, frames))))
        if found.size:
            return frame + int(found[0])
        frame, few = frame + few, 2 * few
    return None


def last_where(holds: FramePredicate, frame: int) -> int | None:
    """The last frame up to one at which something holds, at the same cost."""
    few = NEAREST
    while frame >= 0:
        begin = max(frame + 1 - few, 0)
        found = np.flatnonzero(holds(slice(begin, frame + 1)))
        if found.size:
            return begin + int(found[-1])
        frame, few = begin - 1, 2 * few
    return None
