"""Where motion turns back, and motion to and fro."""

from collections.abc import Iterable, Iterator

import numpy as np
from jaxtyping import Float, Int

from capar.model import geometry
from capar.model.capture import Stream
from extractors.bodies.poses import Poses
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds


def turning_points(values: Float[np.ndarray, "frames"], least: float) -> Int[np.ndarray, "turns"]:
    """Frames of extrema that lie at least so far from the extremum before and the one after.

    Args:
        values: A coordinate over time, known throughout.
        least: The least way between neighbouring extrema, in the coordinate's unit.
    """
    found: list[int] = []
    low = high = direction = 0
    for frame, value in enumerate(values):
        if direction >= 0 and value > values[high]:
            high = frame
        if direction <= 0 and value < values[low]:
            low = frame
        if direction >= 0 and values[high] - value >= least:
            found += [high] if direction else []
            direction, low = -1, frame
        elif direction <= 0 and value - values[low] >= least:
            found += [low] if direction else []
            direction, high = 1, frame
    return np.array(found, dtype=np.int64)


def level_turns(
    middles: Float[np.ndarray, "frames 3"],
    motions: Iterable[Interval],
    thresholds: Thresholds,
) -> tuple[int, ...]:
    """Frames at which a body turns back on the level, after a real way and before another one.

    Args:
        middles: The middles of the body [m]; a motion in which it is lost is left out.
        motions: When it moves, as closed intervals of frames.
        thresholds: The least way, and what is level.
    """
    found: list[int] = []
    for first, last in motions:
        part = middles[first : last + 1]
        if np.isnan(part).any() or len(part) < 2:
            continue
        offsets = part - part.mean(axis=0)
        axis = np.linalg.svd(offsets, full_matrices=False)[2][0]
        if abs(axis[2]) < thresholds.steep:
            found += [
                first + int(at) for at in turning_points(offsets @ axis, thresholds.reversal_m)
            ]
    return tuple(found)


def swings(
    poses: Poses, moving: tuple[Interval, ...], thresholds: Thresholds
) -> tuple[Interval, ...]:
    """Closed intervals of frames in which a body moves to and fro along an axis of the world.

    To and fro is a chain of turning points, each soon after the one before, whose strokes add up
    to more than the way from the first to the last: what bobs as it is carried along does not
    swing. Several axes that swing at a time are one swinging. It begins and ends with the motion
    itself, if that is soon before or after and no further than one stroke.
    """
    stream = poses.smooth
    chains: list[Interval] = []
    for first, last in _known(stream, moving):
        part = stream.positions[first : last + 1]
        for axis in range(3):
            turns = first + turning_points(part[:, axis], thresholds.swing_m)
            for chain in _chains(turns, stream.times, thresholds):
                if _outweighs(chain, stream, axis):
                    chains.append(_whole(chain, (first, last), stream, axis, thresholds))
    out: list[Interval] = []
    for first, last in sorted(chains):
        if out and first <= out[-1][1]:
            out[-1] = (out[-1][0], max(last, out[-1][1]))
        else:
            out.append((first, last))
    return tuple(out)


def most_turns(
    stream: Stream, span: Interval, thresholds: Thresholds
) -> tuple[int, Int[np.ndarray, "turns"]]:
    """The axis of the world along which a body turns back most between two frames, and where.

    Args:
        stream: The body's poses; where it is lost it is taken to go straight on.
        span: First and last frame.
        thresholds: The least way between turning points.

    Returns:
        The number of the axis, and the frames of its turning points.
    """
    first, last = span
    part = stream.positions[first : last + 1]
    known = np.flatnonzero(~stream.lost[first : last + 1])
    if not known.size:
        return 0, np.array([], dtype=np.int64)
    every = np.arange(len(part))
    paths = [np.interp(every, known, part[known, axis]) for axis in range(3)]
    found = [first + turning_points(path, thresholds.swing_m) for path in paths]
    axis = max(range(3), key=lambda one: (len(found[one]), float(np.ptp(paths[one]))))
    return axis, found[axis]


def _known(stream: Stream, moving: tuple[Interval, ...]) -> Iterator[Interval]:
    """The parts of the motions in which the body was not lost."""
    for first, last in moving:
        for begin, end in geometry.runs(~stream.lost[first : last + 1]):
            yield first + begin, first + end


def _chains(
    turns: Int[np.ndarray, "turns"], times: Float[np.ndarray, "frames"], thresholds: Thresholds
) -> list[Int[np.ndarray, "turns"]]:
    if not len(turns):
        return []
    breaks = np.flatnonzero(np.diff(times[turns]) > thresholds.swing_s) + 1
    groups = np.split(turns, breaks)
    return [each for each in groups if len(each) >= thresholds.swing_turns]


def _outweighs(turns: Int[np.ndarray, "turns"], stream: Stream, axis: int) -> bool:
    """Whether the strokes add up to more than the way from the first turn to the last."""
    way = np.linalg.norm(stream.positions[turns[-1]] - stream.positions[turns[0]])
    return bool(np.abs(np.diff(stream.positions[turns, axis])).sum() > way)


def _whole(
    turns: Int[np.ndarray, "turns"],
    moving: Interval,
    stream: Stream,
    axis: int,
    thresholds: Thresholds,
) -> Interval:
    """Between its first and last turning point, or the rest that is no more than a stroke away."""
    stroke = np.abs(np.diff(stream.positions[turns, axis])).max()

    def near(edge: int, turn: int) -> bool:
        way = np.linalg.norm(stream.positions[edge] - stream.positions[turn])
        soon = abs(stream.times[edge] - stream.times[turn]) <= thresholds.swing_s
        return bool(soon and way <= stroke)

    first, last = int(turns[0]), int(turns[-1])
    return (
        moving[0] if near(moving[0], first) else first,
        moving[1] if near(moving[1], last) else last,
    )
