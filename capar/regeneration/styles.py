"""Styles: what of a recorded path and its timing is kept between a new start and a new goal."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation, Slerp

from capar.model.errors import UnknownNameError
from capar.regeneration.forces import ForceKind
from capar.regeneration.scenes import PlanError
from capar.regeneration.sources import Hold, Meeting, Source


class Kind(StrEnum):
    """What of a recorded path is kept."""

    PATH = "path"
    """Its shape in metres beside the straight path, and its timing."""

    FRAME = "frame"
    """Its shape, turned and enlarged with the path as a whole, and its timing."""

    VEL = "vel"
    """Its timing only: the straight path (VelStyle alone)."""

    EVEN = "even"
    """Nothing: the straight path with minimum jerk."""


def style_kind(name: str) -> Kind:
    """The kind of that name.

    Raises:
        UnknownNameError: There is none.
    """
    if name not in set(Kind):
        raise UnknownNameError("style", name, list(Kind))
    return Kind(name)


SHORTEST_S = 0.15  # A shorter hold may not be observed any more [s].


@dataclass(frozen=True, eq=False)
class Style:
    """The paths of hands and objects that are led to new ends."""

    kind: Kind
    hands: Mapping[str, RigidTransform]
    """By side, at every frame of the source."""

    things: Mapping[str, RigidTransform]
    """By name."""

    name: str = ""
    """Of whom it is borrowed; empty for the recorded performer's own."""

    force: ForceKind = ForceKind.SIMILAR
    """What of a force that sets objects going is kept."""


def own_style(source: Source, kind: Kind = Kind.PATH) -> Style:
    """The style in which something was recorded."""
    hands = {side: hand.path for side, hand in source.hands.items()}
    return Style(kind, hands, source.paths)


def borrowed_style(source: Source, other: Source, kind: Kind = Kind.PATH) -> Style:
    """The style of another recording of the same: its paths and timing between the same events.

    Raises:
        PlanError: Other hands do something, or in another order.
    """
    moved, theirs = (list(dict.fromkeys(h.thing for h in one.holds)) for one in (source, other))
    one, two = _steps(source, moved), _steps(other, theirs)
    if one != two:
        told = [
            ", ".join(f"{verb} {who}" for verb, who, _ in way) or "nothing" for way in (two, one)
        ]
        raise PlanError(
            f"{other.capture.name!r} has another order of events, whose style cannot be borrowed: "
            f"{told[0]} instead of {told[1]}"
        )
    frames = np.interp(np.arange(len(source.times)), _events(source), _events(other))
    names = dict(zip(moved, theirs, strict=True))
    hands = {side: _at(other.hands[side].path, frames) for side in source.hands}
    things = {n: _at(other.paths[names[n]], frames) for n in source.paths if n in names}
    return Style(kind, hands, {**source.paths, **things}, other.capture.agent.name)


def paced(source: Source, duration_s: float) -> Source:
    """The same in another time, every part of it as much faster or slower.

    Raises:
        PlanError: A hold would become shorter than can be observed.
    """
    pace = duration_s / float(source.times[-1] - source.times[0])
    for span in _spans(source):
        held_s = float(source.times[span.last] - source.times[span.first])
        if 0.0 < held_s * pace < SHORTEST_S:  # a blow lasts no time
            least = SHORTEST_S * duration_s / (held_s * pace)
            raise PlanError(
                f"in {duration_s:g} s the contact with {span.thing!r} would last "
                f"{held_s * pace:.2f} s, too short to be observed; at least {least:.1f} s would do"
            )
    return replace(source, pace=source.pace * pace)


def _spans(source: Source) -> list[Hold | Meeting]:
    return [*source.holds, *source.meetings]


def _steps(source: Source, moved: list[str]) -> list[tuple[str, str, int]]:
    """What holds and meetings there are, in order, whatever the objects are called."""
    order = {name: number for number, name in enumerate(moved)}
    events = [(h.first, "holds", h.side, order[h.thing]) for h in source.holds]
    events += [(m.first, "meets", m.part, order.get(m.thing, -1)) for m in source.meetings]
    return [event[1:] for event in sorted(events)]


def _events(source: Source) -> Float[np.ndarray, "events"]:
    """Frames at which holds and meetings begin and end, the capture's ends included."""
    edges = {0, len(source.times) - 1} | {e for s in _spans(source) for e in (s.first, s.last)}
    return np.array(sorted(edges), dtype=float)


def _at(path: RigidTransform, frames: Float[np.ndarray, "frames"]) -> RigidTransform:
    """A path between its frames."""
    known = np.arange(len(path), dtype=float)
    spots = np.stack([np.interp(frames, known, c) for c in path.translation.T], axis=1)
    turns: Rotation = Slerp(known, path.rotation)(frames)
    return RigidTransform.from_components(spots, turns)


def smoothed(
    spots: Float[np.ndarray, "frames columns"], half: int
) -> Float[np.ndarray, "frames columns"]:
    """Weighted means over a bell of so many frames on both sides; the ends go on as they are."""
    window = np.hanning(2 * half + 3)[1:-1]
    padded = np.pad(spots, ((half, half), (0, 0)), mode="edge")
    columns = [np.convolve(c, window / window.sum(), mode="valid") for c in padded.T]
    return np.stack(columns, axis=1)


SHORTEST_M = 0.02  # Object and hand or shoulder that are nearer have no direction between them [m].
UPRIGHT = 0.02  # Sine of the angle to the vertical below which x has no direction [1].


class CoordinateError(PlanError):
    """Two points that do not span a frame."""


SpanFrame = tuple[np.ndarray, np.ndarray]
"""The object's place [m], and in columns the axes x, y and z in the world, each as long as the
distance from the object to the hand or shoulder, to which z leads [m]. Left-handed, as the paper's
equation has it; from one frame into another nothing is mirrored."""


def frame_between(
    goal: Float[np.ndarray, "3"],
    base: Float[np.ndarray, "3"],
    *,
    aside: Float[np.ndarray, "3"] | None = None,
) -> SpanFrame:
    """The frame of an object and a hand or shoulder: z = base - goal, x = z x up, y = x x z.

    Args:
        goal: The object [m].
        base: The hand at the start, or the shoulder [m].
        aside: Takes the place of x where z is vertical.

    Raises:
        CoordinateError: The points are too near, or above each other without an ``aside``.
    """
    length = float(np.linalg.norm(base - goal))
    if length < SHORTEST_M:
        raise CoordinateError(f"object and hand are {1e3 * length:.0f} mm apart: no direction")
    z = (base - goal) / length
    x = np.cross(z, [0.0, 0.0, 1.0])
    if np.linalg.norm(x) < UPRIGHT:
        if aside is None:
            raise CoordinateError("one is above the other, so that x has no direction; say which")
        x = aside - (aside @ z) * z
    x = x / np.linalg.norm(x)
    return goal, length * np.stack([x, np.cross(x, z), z], axis=1)


def replayed(
    path: Float[np.ndarray, "frames 3"], before: SpanFrame, after: SpanFrame
) -> Float[np.ndarray, "frames 3"]:
    """A path turned and enlarged from one frame into another [m]."""
    (old, axes), (new, new_axes) = before, after
    local = (path - old) @ axes / np.sum(axes[:, 2] ** 2)
    return np.asarray(new + local @ new_axes.T)


SHORT_M = 0.05  # A shorter path from start to goal has no direction of its own [m].
SMALLEST_M = 1e-6  # Added to the path of every frame, so that time is a function of the path [m].
PEAK = 256.0 / 27.0  # Makes the largest value of s (1 - s)^3 one [1].


@dataclass(frozen=True)
class Detour:
    """What is added to a path between its ends so that it clears the scene."""

    lift_m: float = 0.0
    """How far it is lifted half-way [m]."""

    back_m: float = 0.0
    """How far it is drawn back, towards the performer, half-way [m]."""

    off_m: float = 0.0
    """How far a hand draws off what it leaves, and keeps off what it comes to, at most [m]."""

    @property
    def size(self) -> float:
        """How far it leads away from the path [m]."""
        return self.lift_m + self.back_m + self.off_m


STRAIGHT = Detour()


def way(positions: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames"]:
    """Length of the path up to each frame [m], strictly increasing."""
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1) + SMALLEST_M
    return np.concatenate([[0.0], np.cumsum(steps)])


def arc_shares(positions: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames"]:
    """Share of the path covered at each frame: VelStyle of the path (thesis eq. 4.1) [1]."""
    covered = way(positions)
    return np.asarray(covered / covered[-1])


def mapped(
    path: RigidTransform,
    start: RigidTransform,
    goal: RigidTransform,
    *,
    turn: float = 0.0,
    detour: Detour = STRAIGHT,
    heading: float = 0.0,
    away: tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]] = (np.zeros(3), np.zeros(3)),
    kind: Kind = Kind.PATH,
) -> RigidTransform:
    """A path with other ends.

    What deviates from the straight path is kept in metres and turned with the path; the share of
    the path's length that is covered at each frame stays the same.

    Args:
        path: As it was recorded; the last frame is the goal's.
        start: Where the new one begins.
        goal: Where it ends.
        turn: How far the deviations are turned about z where the path has no direction [rad].
        detour: What is added between the ends.
        heading: Which way the performer faces [rad].
        away: Directions in which a detour draws off, at the start and at the goal.
        kind: What of the path is kept.
    """
    old, chord = path.translation, path.translation[-1] - path.translation[0]
    new = goal.translation - start.translation
    s = np.linspace(0.0, 1.0, len(path))
    least_jerk = s**3 * (10.0 - 15.0 * s + 6.0 * s * s)  # Flash & Hogan 1985
    shares = arc_shares(old) if kind is not Kind.EVEN else least_jerk
    straight, length = kind in {Kind.VEL, Kind.EVEN}, float(np.linalg.norm(chord))
    # How far along the straight path each frame is; by the path's length where that is short.
    by_length = straight or length <= SHORT_M
    along = shares if by_length else (old - old[0]) @ chord / length**2
    if min(np.hypot(*chord[:2]), np.hypot(*new[:2])) >= SHORT_M:
        turn = float(np.arctan2(new[1], new[0]) - np.arctan2(chord[1], chord[0]))
    about = Rotation.from_euler("z", turn)
    spots = start.translation + np.outer(along, new)
    if not straight:
        aside = about.apply(old - old[0] - np.outer(along, chord))
        if kind is Kind.FRAME:
            with suppress(CoordinateError):
                before = frame_between(old[-1], old[0])
                after = frame_between(goal.translation, start.translation)
                aside = replayed(old, before, after) - spots
        spots = spots + aside
    back = detour.back_m * np.array([-np.cos(heading), -np.sin(heading), 0.0])
    bump = 4.0 * shares * (1.0 - shares)
    leaves, comes = PEAK * shares * (1.0 - shares) ** 3, PEAK * shares**3 * (1.0 - shares)
    spots = spots + np.outer(bump, back + np.array([0.0, 0.0, detour.lift_m]))
    spots = spots + detour.off_m * (np.outer(leaves, away[0]) + np.outer(comes, away[1]))
    # The recorded deviations from an even turn, on the even turn between the new ends.
    first, last = path.rotation[0], path.rotation[-1]
    deviation = path.rotation * _even(first, last, shares).inv()
    even = _even(start.rotation, goal.rotation, shares)
    turns = about * deviation * about.inv() * even
    return RigidTransform.from_components(retimed(spots, shares), turns)


def _even(first: Rotation, last: Rotation, shares: Float[np.ndarray, "frames"]) -> Rotation:
    axis = (last * first.inv()).as_rotvec()
    return Rotation.from_rotvec(np.outer(shares, axis)) * first


def retimed(
    spots: Float[np.ndarray, "frames 3"], shares: Float[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames 3"]:
    """The same path with a given share of its length covered at each frame.

    Args:
        spots: Of the path [m].
        shares: Of its length [1], from 0 to 1.
    """
    covered = arc_shares(spots)
    return np.stack([np.interp(shares, covered, column) for column in spots.T], axis=1)
