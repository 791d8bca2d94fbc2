"""Where bodies are, how far they have gone and turned, at the frames that matter."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool, Float

from capar.model import geometry
from capar.model.facts import Distance, Fact, Place, Posture, SweptAzimuth, Travelled
from extractors.bodies.body_geometry import BodyGeometry
from extractors.motion.leaning import lean, spin
from extractors.relations.arrangement import beyond_shadow


def places(
    body: BodyGeometry, upright: Float[np.ndarray, "3"], frames: tuple[int, ...]
) -> Iterator[Fact]:
    """Place, way, turn and posture of a body at some frames; lost frames are left out.

    Args:
        body: The body.
        upright: The axis that points up while it stands, in its own frame.
        frames: Frames, ascending.
    """
    if not frames:
        return
    way, turn = _cumulated(body)
    at = np.asarray(frames)
    at = at[~np.isnan(body.middles[at]).any(axis=1)]
    middles = _thousandths(body.middles[at])
    ways = _thousandths(np.stack([way[at], turn[at]], axis=1))
    orientations = body.orientations
    postures = np.stack([lean(orientations[at], upright), spin(orientations)[at]], axis=1)
    rows = zip(at.tolist(), middles, ways, _thousandths(postures), strict=True)
    for frame, middle, travelled, posture in rows:
        yield Place(body.name, frame, *middle)
        yield Travelled(body.name, frame, *travelled)
        yield Posture(body.name, frame, *posture)


def distances(body: BodyGeometry, other: BodyGeometry, frames: tuple[int, ...]) -> Iterator[Fact]:
    """Distance of two bodies' middles, and the angle by which one has gone about the other."""
    if not frames:
        return
    offset = body.middles - other.middles
    wound = _wound(offset, beyond_shadow(body.middles, *other.boxes) > 0.0)
    at = np.asarray(frames)
    apart = np.linalg.norm(offset[at], axis=1)
    known = ~np.isnan(apart)
    values = _thousandths(np.stack([apart[known], wound[at[known]]], axis=1))
    for frame, (millimetres, milliradians) in zip(at[known].tolist(), values, strict=True):
        yield Distance(body.name, other.name, frame, millimetres)
        yield SweptAzimuth(body.name, other.name, frame, milliradians)


def _thousandths(values: Float[np.ndarray, "rows columns"]) -> list[list[int]]:
    """Metres as whole millimetres, radians as milliradians, row by row."""
    rounded: list[list[int]] = np.rint(1000.0 * values).astype(np.int64).tolist()
    return rounded


def _cumulated(
    body: BodyGeometry,
) -> tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]]:
    """Length of the path [m] and sum of the rotation [rad] up to each frame."""
    steps = np.linalg.norm(np.diff(body.middles, axis=0), axis=1)
    angles = geometry.angle_between(body.orientations[1:], body.orientations[:-1])
    return _sum(steps), _sum(angles)


def _sum(steps: Float[np.ndarray, "steps"]) -> Float[np.ndarray, "frames"]:
    return np.concatenate(([0.0], np.cumsum(np.nan_to_num(steps))))


def _wound(
    offset: Float[np.ndarray, "frames 3"], outside: Bool[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames"]:
    """Unwrapped azimuth of a body about another [rad].

    Nothing is added where it is lost, nor above or below the other, where it goes about nothing.
    """
    azimuth = np.arctan2(offset[:, 1], offset[:, 0])
    steps = np.nan_to_num(np.diff(azimuth))
    turns = (steps + np.pi) % (2.0 * np.pi) - np.pi
    return _sum(np.where(outside[1:] & outside[:-1], turns, 0.0))
