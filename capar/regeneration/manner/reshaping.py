"""A style with another effort: the ways of hands and things between the same events."""

import itertools
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation, Slerp

from capar.regeneration.body_frames import body_frames
from capar.regeneration.manner.efforts import Effort
from capar.regeneration.manner.profiles import overshot, paused, shaped, timed
from capar.regeneration.path_mapping import SHORT_M, arc_shares, retimed
from capar.regeneration.sources import Source
from capar.regeneration.styles import Style
from capar.regeneration.thing_goals import thing_goals

ARM_M = 0.1
"""A turn of one radian counts as so long a way [m]."""

SLOWLY = 0.1
"""Where a hand is slower than this share of its highest speed a step's border parts its way [1]."""

OFF_M = 0.05
"""A thing that is so far above where it is taken and put down may go another way [m]."""

ROUND_S = 0.15
"""Free flow rounds the way over so long on both sides of a border between steps [s]."""


@dataclass(frozen=True)
class Stretch:
    """A part of a way between two events, or between slow borders of steps."""

    first: int
    last: int
    pauses: tuple[bool, bool] = (True, True)
    """Whether it may be paused at its start and at its end: nothing is let go or taken there."""

    ends_free: bool = False
    """Whether nothing is held in its last frame, nor taken then."""


def with_effort(style: Style, source: Source, effort: Effort) -> Style:
    """The style with another effort; events keep their frames and places.

    Between events the speeds along each way are reshaped by time, weight and bound flow, and the
    shape of ways in free air by space, weight and free flow. How long everything takes is not
    changed here.

    Args:
        style: As it was recorded or borrowed.
        source: What is done.
        effort: How, compared with the style.
    """
    hands, things = dict(style.hands), dict(style.things)
    for side, path in style.hands.items():
        edges = hand_edges(source, side)
        rounded = _rounded(path, source, edges, effort.flow)
        for stretch in hand_stretches(source, side):
            part = rounded[stretch.first : stretch.last + 1]
            rounded = _replaced(rounded, stretch.first, _reshaped(part, stretch, effort))
        hands[side] = rounded
    recorded = body_frames(source.human, source.scene)
    for name, goals in thing_goals(source, source.scene, recorded, recorded).items():
        frames = sorted({goal.frame for goal in goals})
        free = _off_ground(style.things[name], frames[0], frames[-1])
        path = _rounded(style.things[name], source, frames, effort.flow)
        sides = {hold.side for hold in source.holds if hold.thing == name}
        borders = {border for side in sides for border in _borders(source, side)}
        edges = sorted({*frames, *(b for b in borders if frames[0] < b < frames[-1])})
        for first, last in itertools.pairwise(edges):
            part = path[first : last + 1]
            made = _reshaped(part, Stretch(first, last), effort, free[first : last + 1])
            path = _replaced(path, first, made)
        things[name] = path
    return replace(style, hands=hands, things=things)


def hand_edges(source: Source, side: str) -> list[int]:
    """Frames at which a hand takes something or lets it go, and the first and last of all."""
    holds = [hold for hold in source.holds if hold.side == side]
    frames = {frame for hold in holds for frame in (hold.first, hold.last)}
    return sorted({0, len(source.times) - 1, *frames})


def hand_stretches(source: Source, side: str) -> Iterator[Stretch]:
    """The stretches in which a hand holds nothing, in order."""
    holds = [hold for hold in source.holds if hold.side == side]
    firsts, lasts = {hold.first for hold in holds}, {hold.last for hold in holds}
    edges = sorted({*hand_edges(source, side), *_borders(source, side)})
    for first, last in itertools.pairwise(edges):
        if not any(hold.first <= first and last <= hold.last for hold in holds):
            pauses = first not in lasts, last not in firsts
            later = any(hold.first >= last for hold in holds)
            yield Stretch(first, last, pauses, not later)


def _borders(source: Source, side: str) -> list[int]:
    """Frames between steps of a hand at which it is slow."""
    hand = source.hands[side]
    steps = np.linalg.norm(np.diff(hand.path.translation, axis=0), axis=1)
    slow = SLOWLY * float(steps.max())
    ends = {part.last for part in source.observation.segments if part.ee == hand.sensor}
    return sorted(frame for frame in ends if 0 < frame < len(steps) and steps[frame - 1] < slow)


def turned_way(path: RigidTransform) -> Float[np.ndarray, "frames"]:
    """Length of a way up to each frame, turning included [m], strictly increasing."""
    gone = np.linalg.norm(np.diff(path.translation, axis=0), axis=1)
    turned = (path[1:].rotation * path[:-1].rotation.inv()).magnitude()
    return np.concatenate([[0.0], np.cumsum(np.hypot(gone, ARM_M * turned) + 1e-9)])


def _reshaped(
    path: RigidTransform,
    stretch: Stretch,
    effort: Effort,
    free: Float[np.ndarray, "frames"] | None = None,
) -> RigidTransform:
    """A stretch with another effort; as it is where it is too short to have one."""
    length = turned_way(path)
    if length[-1] < SHORT_M or len(path) < 4:
        return path
    frames = np.arange(len(path), dtype=float)
    shares = timed(length / length[-1], effort.time, effort.weight)
    shares = paused(shares, effort.flow, stretch.pauses)
    chord = path.translation[-1] - path.translation[0]
    far = float(np.linalg.norm(chord)) >= SHORT_M
    beyond = np.zeros(len(path))
    if stretch.ends_free and far:
        gone, beyond = overshot(len(path), effort.flow)
        shares = np.interp(gone, frames / frames[-1], shares)
    at = np.interp(shares, length / length[-1], frames)
    spots = np.stack([np.interp(at, frames, column) for column in path.translation.T], axis=1)
    turns: Rotation = Slerp(frames, path.rotation)(at)
    if far:
        free = np.ones(len(path)) if free is None else np.interp(at, frames, free)
        covered = arc_shares(spots)
        spots = retimed(shaped(spots, effort.space, effort.weight, free), covered)
        spots = spots + np.outer(beyond, chord)
    return RigidTransform.from_components(spots, turns)


def _rounded(
    path: RigidTransform, source: Source, pinned: Collection[int], flow: float
) -> RigidTransform:
    """A way that flows through the borders between steps where nothing has to be anywhere."""
    half = round(ROUND_S * source.rate_hz * max(-flow, 0.0))
    if half < 1 or len(path) < 4:
        return path
    window = np.hanning(2 * half + 3)[1:-1]
    padded = np.pad(path.translation, ((half, half), (0, 0)), mode="edge")
    smooth = np.stack(
        [np.convolve(column, window / window.sum(), mode="valid") for column in padded.T], axis=1
    )
    near = np.min([np.abs(np.arange(len(path)) - frame) for frame in pinned], axis=0)
    inside = (np.arange(len(path)) >= min(pinned)) & (np.arange(len(path)) <= max(pinned))
    share = np.clip(near / (4.0 * half), 0.0, 1.0) * inside
    share = share**2 * (3.0 - 2.0 * share)
    spots = path.translation + share[:, None] * (smooth - path.translation)
    return RigidTransform.from_components(spots, path.rotation)


def _off_ground(path: RigidTransform, first: int, last: int) -> Float[np.ndarray, "frames"]:
    """How far a thing may go another way at each frame [1]: not while it is on what bears it."""
    heights = path.translation[:, 2]
    rise = np.clip((heights - max(heights[first], heights[last])) / OFF_M - 0.2, 0.0, 1.0)
    return np.asarray(rise**2 * (3.0 - 2.0 * rise))


def _replaced(path: RigidTransform, first: int, part: RigidTransform) -> RigidTransform:
    """The path with another part from a frame on."""
    after = first + len(part)
    pieces = [path[:first], part, path[after:]]
    return RigidTransform.concatenate([piece for piece in pieces if len(piece)])
