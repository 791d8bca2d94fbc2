"""What is shown of a capture: each body with its surface and its way, thinned for the eye."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from capar.model.capture import Capture, Role, Sensor, Shape, TagObject, TagType

SMOOTH_HZ = 60.0
"""Frames are thinned to about this rate [Hz]: what screens show."""

GROUND_M = 2.0
"""What is fixed and wider than this both ways is a floor [m]."""

COLOURS = {
    "sensor": "#c98d6b",
    "looks": "#8a6bc9",
    "mobile": "#4477aa",
    "fixed": "#a9a9a9",
    "self": "#c98d6b",
    "body": "#e3d3c4",
}
"""The colour of a body by what it is."""


@dataclass(frozen=True, eq=False)
class StagedBody:
    """A sensor or an object, in the world: metres, z up."""

    name: str
    kind: str
    """``sensor``, ``looks`` (it attends), the tag of an object, or ``body``: of a fitted body."""

    shape: Shape | None
    positions: Float[np.ndarray, "frames 3"]
    """[m]; NaN where it was lost."""

    orientations: Float[np.ndarray, "frames 4"]
    """Unit quaternions, scalar first; NaN where it was lost."""

    faint: bool = False
    """Whether it is drawn translucent: it is assumed, or nothing of it was recorded."""

    @property
    def label(self) -> str:
        """Its name in words, and whether it is assumed."""
        words = self.name.replace("_", " ")
        told = self.faint and self.kind != "body" and "assumed" not in words
        return f"{words} (assumed)" if told else words

    @property
    def colour(self) -> str:
        """As a hexadecimal number after ``#``."""
        return COLOURS[self.kind]


@dataclass(frozen=True, eq=False)
class Stage:
    """Every body of a capture at the frames that are shown."""

    title: str
    times: Float[np.ndarray, "frames"]
    """[s]."""

    bodies: tuple[StagedBody, ...]

    def nearest(self, time_s: float) -> int:
        """The frame that is nearest to a time."""
        return int(np.argmin(np.abs(self.times - time_s)))


def stage(capture: Capture, *, at_s: float | None = None) -> Stage:
    """A capture as it is shown; bodies of which a bone changes its length are only points.

    Args:
        capture: The capture.
        at_s: The frame nearest to this time is shown, whatever others are left out [s].
    """
    frames = shown_frames(capture)
    if at_s is not None:
        frames = np.union1d(frames, np.argmin(np.abs(capture.times - at_s)))
    stretching = {one.bodies[0] for one in capture.notices if one.code == "bone-stretches"}
    bodies = tuple(
        replace(one, shape=None) if one.name in stretching else one
        for one in (_staged(body, frames) for body in capture.bodies.values())
    )
    return Stage(capture.name, capture.times[frames], bodies)


def shown_frames(capture: Capture) -> Int[np.ndarray, "frames"]:
    """The frames that are shown: every so many, and the last one."""
    every = max(round(capture.rate_hz / SMOOTH_HZ), 1)
    last = len(capture.times) - 1
    return np.unique([*range(0, last, every), last])


def _staged(body: Sensor | TagObject, frames: Int[np.ndarray, "frames"]) -> StagedBody:
    stream = body.stream
    at = stream.positions[frames], stream.orientations[frames]
    faint = isinstance(body, TagObject) and bool(body.assumed)
    return StagedBody(body.name, _kind(body), body.shape, *at, faint=faint)


def _kind(body: Sensor | TagObject) -> str:
    if isinstance(body, TagObject):
        return {TagType.MOBILE: "mobile", TagType.FIXED: "fixed"}.get(body.tag, "self")
    return "looks" if body.role is Role.ATTENDS else "sensor"


def world_bounds(shown: Stage) -> Float[np.ndarray, "2 3"]:
    """Lowest and highest place where anything small is [m]: what a picture has to hold."""
    small = [body for body in shown.bodies if not is_ground(body)] or shown.bodies
    places = np.concatenate([each for body in small for each in _extent(body)])
    return np.stack([np.nanmin(places, axis=0), np.nanmax(places, axis=0)])


def is_ground(body: StagedBody) -> bool:
    """Whether it is fixed and as wide as a floor: wherever its middle is, nothing need be there."""
    if body.kind != "fixed" or body.shape is None:
        return False
    return bool(np.sort(np.ptp(body.shape.vertices, axis=0))[1] > GROUND_M)


def _extent(body: StagedBody) -> Iterator[Float[np.ndarray, "places 3"]]:
    yield body.positions
    if body.shape is not None and body.kind != "fixed":
        radius = float(np.linalg.norm(body.shape.vertices, axis=1).max())
        yield body.positions - radius
        yield body.positions + radius
