"""Phases of an object's motion: rising, level, sinking, turning or still, by its path."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float, Int

from capar.model import geometry
from extractors.bodies.body_geometry import BodyGeometry
from extractors.motion.object_motion import slopes
from extractors.signals.clock import frame_rate
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds

RISING, LEVEL, SINKING, TURNING, STILL = "rising", "level", "sinking", "turning", "still"
HEADINGS = {1: RISING, 0: LEVEL, -1: SINKING}
"""Phases of a path that leads anywhere, by whether it goes up, aside or down."""


@dataclass(frozen=True, slots=True)
class Phase:
    """A part of a motion; it begins at the frame at which the one before ends."""

    kind: str
    first: int
    last: int


def phases(
    body: BodyGeometry, motions: tuple[Interval, ...], thresholds: Thresholds
) -> tuple[Phase, ...]:
    """The phases of each motion of a body, in time.

    The path is steep where it goes up or down more than aside: at 45 degrees, where a straight
    line is fitted to the places around each frame. A phase changes only where the path has become
    clearly steep or clearly flat, and the change is placed where it passed 45 degrees, or, if the
    body hardly moves meanwhile, in the middle of that time. Phases that lead nowhere are part of
    their neighbours.

    Args:
        body: The body.
        motions: When it moves, as closed intervals of frames, in time.
        thresholds: Window of the fit, speeds of rest, angles and the least way of a phase.
    """
    stream = body.poses.smooth
    rate_hz = frame_rate(stream.times)
    found: list[Phase] = []
    for motion in motions:
        for first, last in geometry.runs(~stream.lost[motion[0] : motion[1] + 1]):
            span = slice(motion[0] + first, motion[0] + last + 1)
            parts = _parts(body, span, rate_hz, thresholds)
            found += _joined(parts, body.middles, thresholds)
    return tuple(found)


def turns_of_height(
    found: tuple[Phase, ...],
    middles: Float[np.ndarray, "frames 3"],
    met: Collection[int],
    thresholds: Thresholds,
) -> tuple[int, ...]:
    """Frames at which a body that rose steeply by a real way begins to sink by one.

    They lie in the middle of the longest level part between the two, or, where there is none, in
    the middle between the end of the rise and the beginning of the sink. A pause in the air changes
    nothing, but that where nothing else lies between it needs no turn beside it; where the body
    comes to touch another in between, its way has ended there. A sink that such a frame begins ends
    at the next one, if the body then rises again.

    Args:
        found: Phases, in time; a motion's follow each other without a gap.
        middles: Places of the body [m].
        met: Frames at which it begins to touch another body that does not move it.
        thresholds: The least way up or down.
    """
    frames: list[int] = []
    before: Phase | None = None
    after_top = False
    between: list[Phase] = []
    for phase in found:
        if abs(_rise(phase, middles)) < thresholds.reversal_m or phase.kind not in (
            RISING,
            SINKING,
        ):
            between.append(phase)
            continue
        if before is not None and any(before.first < frame < phase.first for frame in met):
            before, after_top = None, False
        if (
            before is not None
            and before.kind != phase.kind
            and (before.kind == RISING or after_top)
        ):
            frames += _turn(before, between, phase, middles)
            after_top = True
        before, between = phase, []
    return tuple(frames)


def _turn(
    rise: Phase, between: Sequence[Phase], sink: Phase, middles: Float[np.ndarray, "frames 3"]
) -> list[int]:
    level = [phase for phase in between if phase.kind == LEVEL]
    if level:
        longest = max(level, key=lambda phase: _way(phase, middles))
        return [(longest.first + longest.last) // 2]
    parts = [rise, *between, sink]
    if any(one.last != other.first for one, other in pairwise(parts)):
        return []
    return [(rise.last + sink.first) // 2]


def _rise(phase: Phase, middles: Float[np.ndarray, "frames 3"]) -> float:
    return float(middles[phase.last, 2] - middles[phase.first, 2])


def _parts(body: BodyGeometry, span: slice, rate_hz: float, thresholds: Thresholds) -> list[Phase]:
    """The phases of one stretch of known frames, however short they are."""
    half = max(1, round(0.5 * thresholds.rest_window_s * rate_hz))
    way = slopes(body.middles[span], half) * rate_hz
    turn = 2.0 * np.linalg.norm(slopes(body.poses.smooth.orientations[span], half), axis=1)
    slow = np.linalg.norm(way, axis=1) < thresholds.rest_speed_mps
    if slow.all():
        turning = bool((turn * rate_hz >= thresholds.rest_speed_radps).any())
        return [Phase(TURNING if turning else STILL, span.start, span.stop - 1)]
    heading = _headings(way, slow, thresholds)
    kinds = np.array([HEADINGS[int(index)] for index in heading], dtype=object)
    still = turn * rate_hz < thresholds.rest_speed_radps
    least = round(thresholds.rest_minimum_s * rate_hz)
    for first, last in geometry.runs(slow):
        if last - first + 1 >= least and first > 0 and last < len(slow) - 1:
            kinds[first : last + 1] = STILL if still[first : last + 1].all() else TURNING
    edges = [0, *(np.flatnonzero(kinds[1:] != kinds[:-1]) + 1), len(kinds) - 1]
    return [
        Phase(str(kinds[first]), span.start + int(first), span.start + int(last))
        for first, last in pairwise(edges)
        if last > first
    ]


def _headings(
    way: Float[np.ndarray, "frames 3"], slow: Float[np.ndarray, "frames"], thresholds: Thresholds
) -> Int[np.ndarray, "frames"]:
    """Up, aside or down at each frame, with hysteresis; while it is slow, as the nearest does."""
    angle = np.arctan2(way[:, 2], np.hypot(way[:, 0], way[:, 1]))
    known = np.flatnonzero(~slow)
    # Each slow frame takes the direction of the nearest one that is not.
    middle = (known[1:] + known[:-1] + 1) // 2
    angle = angle[known[np.searchsorted(middle, np.arange(len(angle)), side="right")]]
    plain = np.where(np.abs(angle) < thresholds.bend_rad, 0, np.sign(angle)).astype(np.int64)
    flat = np.abs(angle) < thresholds.flat_rad
    sure = np.where(np.abs(angle) > thresholds.steep_rad, np.sign(angle), 0).astype(np.int64)
    out = plain.copy()
    state = int(plain[0])
    for frame in range(len(angle)):
        clear = int(sure[frame])
        if clear != state and (clear or flat[frame]):
            state = clear
            begin = frame
            while begin > 0 and plain[begin - 1] == state:
                begin -= 1
            out[begin:frame] = state
        out[frame] = state
    return out


def _joined(
    parts: list[Phase], middles: Float[np.ndarray, "frames 3"], thresholds: Thresholds
) -> list[Phase]:
    """The same without phases that lead nowhere: the shortest first, half to either neighbour."""
    out = list(parts)
    while len(out) > 1:
        ways = [_way(phase, middles) for phase in out]
        place = int(np.argmin(ways))
        if ways[place] >= thresholds.motion_floor_m:
            break
        _give_up(out, place)
    return out


def _way(phase: Phase, middles: Float[np.ndarray, "frames 3"]) -> float:
    """How far a phase leads [m]; being still or turning is meant to lead nowhere."""
    if phase.kind in (TURNING, STILL):
        return float("inf")
    return float(np.linalg.norm(middles[phase.last] - middles[phase.first]))


def _give_up(out: list[Phase], place: int) -> None:
    gone = out.pop(place)
    middle = (gone.first + gone.last) // 2
    if place == 0:
        out[0] = Phase(out[0].kind, gone.first, out[0].last)
    elif place == len(out):
        out[-1] = Phase(out[-1].kind, out[-1].first, gone.last)
    elif out[place - 1].kind == out[place].kind:
        after = out.pop(place)
        out[place - 1] = Phase(after.kind, out[place - 1].first, after.last)
    else:
        out[place - 1] = Phase(out[place - 1].kind, out[place - 1].first, middle)
        out[place] = Phase(out[place].kind, middle, out[place].last)
