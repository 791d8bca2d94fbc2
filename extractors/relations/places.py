"""Where bodies are, how far they have gone and turned, at the frames that matter."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool, Float

from capar.model import geometry
from capar.model.facts import Distance, Fact, Place, Posture, SweptAzimuth, Travelled
from extractors.bodies.body_geometry import Figure
from extractors.motion.leaning import lean, spin
from extractors.relations.arrangement import beyond_shadow


def places(
    figure: Figure, upright: Float[np.ndarray, "3"], frames: tuple[int, ...]
) -> Iterator[Fact]:
    """Place, way, turn and posture of a body at some frames; lost frames are left out.

    Args:
        figure: The body.
        upright: The axis that points up while it stands, in its own frame.
        frames: Frames, ascending.
    """
    way, turn = _cumulated(figure)
    leant, spun = lean(figure.orientations, upright), spin(figure.orientations)
    for frame in frames:
        middle = figure.middles[frame]
        if not np.isnan(middle).any():
            x, y, z = (round(1000.0 * float(each)) for each in middle)
            yield Place(figure.name, frame, x, y, z)
            yield Travelled(
                figure.name, frame, round(1000.0 * way[frame]), round(1000.0 * turn[frame])
            )
            yield Posture(
                figure.name, frame, round(1000.0 * leant[frame]), round(1000.0 * spun[frame])
            )


def distances(figure: Figure, other: Figure, frames: tuple[int, ...]) -> Iterator[Fact]:
    """Distance of two bodies' middles, and the angle by which one has gone about the other."""
    offset = figure.middles - other.middles
    apart = np.linalg.norm(offset, axis=1)
    wound = _wound(offset, beyond_shadow(figure.middles, *other.boxes) > 0.0)
    for frame in frames:
        if not np.isnan(apart[frame]):
            yield Distance(figure.name, other.name, frame, round(1000.0 * float(apart[frame])))
            yield SweptAzimuth(figure.name, other.name, frame, round(1000.0 * float(wound[frame])))


def _cumulated(figure: Figure) -> tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]]:
    """Length of the path [m] and sum of the rotation [rad] up to each frame."""
    steps = np.linalg.norm(np.diff(figure.middles, axis=0), axis=1)
    angles = geometry.angle_between(figure.orientations[1:], figure.orientations[:-1])
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
