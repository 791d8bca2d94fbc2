"""One hinge or one rail on which a body moves, fitted to its poses by least squares."""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from jaxtyping import Bool, Float

from capar.model import geometry
from extractors.bodies.body_geometry import BodyGeometry

HINGE, RAIL = "hinge", "rail"

ROUNDS = 3
"""How often the orientation that angles are counted from is averaged anew [1]: the first round
takes it from one frame, the second from all, the third changes it by less than a microradian."""

ROUNDED = 1e-9
"""By this share a bound is wider than what it bounds [1], as numbers are rounded."""

_INVERSE = np.array([1.0, -1.0, -1.0, -1.0])
"""What a unit quaternion's parts are multiplied with to make it the opposite rotation's [1]."""

_Vector: TypeAlias = Float[np.ndarray, "3"]
_Frames: TypeAlias = Float[np.ndarray, "frames"]


@dataclass(frozen=True, eq=False)
class GuideFit:
    """The line about which, or along which, a body moves, and how far it strays from that."""

    kind: str
    """``hinge`` or ``rail``."""

    axis: _Vector
    """Unit direction of the line in the world; its largest part is positive."""

    point: _Vector
    """A point of the line in the world [m]; of a rail, the mean place of the body's middle."""

    course: _Frames
    """How far the body has turned [rad] or gone [m] at each frame; NaN where it was lost."""

    stray_m: _Frames
    """How far its middle is from where the guide would have it [m]; NaN where it was lost."""

    stray_rad: _Frames
    """By which angle its orientation is off [rad]; NaN where it was lost."""

    lever_m: float
    """Distance of the body's outermost point from its middle [m]."""

    radius_m: float
    """Distance of its middle from the line [m]."""

    @property
    def span(self) -> float:
        """From one end of its range to the other [rad] or [m]."""
        return float(np.nanmax(self.course) - np.nanmin(self.course))

    @property
    def residual_m(self) -> float:
        """Root mean square of what is left [m]: stray of the middle, and of the rim by turning."""
        left = self.stray_m**2 + (self.lever_m * self.stray_rad) ** 2
        return float(np.sqrt(np.nanmean(left)))


def in_one_plane(body: BodyGeometry, within_m: float) -> bool:
    """Whether a body's middle may be within a distance [m] of some plane at every frame.

    On a hinge or a rail it is; where the mean square from the best plane is more, it never is.
    """
    _, middles, _ = _known(body)
    if not len(middles):
        return True
    offset = middles - middles.mean(axis=0)
    least = np.linalg.eigvalsh(offset.T @ offset / len(offset))[0]
    return bool(least <= within_m**2 * (1.0 + ROUNDED))


def fit_hinge(body: BodyGeometry) -> GuideFit | None:
    """The fixed line about which a body turns; None where it was never seen to turn.

    The axis is the main direction of the vector parts of the rotations from one orientation, the
    angle of each frame the turn about it. The middle then goes on a circle, m = c + R(angle) q
    plus a height along the axis, which is linear in c and q.
    """
    known, middles, turns = _known(body)
    found = _axis_and_angles(turns)
    if found is None:
        return None
    axis, angles, stray_rad = found
    across = _across(axis)
    places = middles @ across[0] + 1j * (middles @ across[1])
    terms = np.stack([np.ones_like(places), np.exp(1j * angles)], axis=1)
    solved = np.linalg.lstsq(terms, places, rcond=None)[0]
    heights = middles @ axis
    height = float(heights.mean())
    stray_m = np.hypot(np.abs(places - terms @ solved), heights - height)
    point = solved[0].real * across[0] + solved[0].imag * across[1] + height * axis
    return GuideFit(
        HINGE,
        axis,
        point,
        _spread(known, angles),
        _spread(known, stray_m),
        _spread(known, stray_rad),
        _lever(body),
        float(np.abs(solved[1])),
    )


def fit_rail(body: BodyGeometry) -> GuideFit | None:
    """The line along which a body goes without turning; None where it never went anywhere."""
    known, middles, turns = _known(body)
    mean = middles.mean(axis=0) if len(middles) else np.zeros(3)
    axis = _main_direction(middles - mean)
    if axis is None:
        return None
    course = (middles - mean) @ axis
    stray_m = np.linalg.norm(middles - mean - course[:, None] * axis, axis=1)
    usual = geometry.quaternions(geometry.rotations(turns).mean())
    stray_rad = geometry.angle_between(turns, usual[None])
    return GuideFit(
        RAIL,
        axis,
        mean,
        _spread(known, course),
        _spread(known, stray_m),
        _spread(known, stray_rad),
        _lever(body),
        0.0,
    )


def _known(
    body: BodyGeometry,
) -> tuple[Bool[np.ndarray, "frames"], Float[np.ndarray, "known 3"], Float[np.ndarray, "known 4"]]:
    known = ~(np.isnan(body.middles).any(axis=1) | np.isnan(body.orientations).any(axis=1))
    return known, body.middles[known], body.orientations[known]


def _axis_and_angles(
    turns: Float[np.ndarray, "known 4"],
) -> tuple[_Vector, Float[np.ndarray, "known"], Float[np.ndarray, "known"]] | None:
    """The axis, the angle about it at each frame, and by how much the orientation is off it."""
    if not len(turns):
        return None
    base = turns[:1]
    for _ in range(ROUNDS):
        moved = geometry.continuous(geometry.products(turns, base * _INVERSE))
        found = _main_direction(moved[:, 1:])
        if found is None:
            return None
        axis = found
        angles = np.unwrap(2.0 * np.arctan2(moved[:, 1:] @ axis, moved[:, 0]))
        back = geometry.products(_about(axis, -angles), turns)
        base = geometry.quaternions(geometry.rotations(back).mean())[None]
    stray_rad = geometry.angle_between(back, base)
    return axis, angles, stray_rad


def _about(axis: _Vector, angles: Float[np.ndarray, "known"]) -> Float[np.ndarray, "known 4"]:
    """Quaternions of turns about an axis [rad]."""
    half = 0.5 * angles[:, None]
    return np.hstack([np.cos(half), np.sin(half) * axis])


def _main_direction(vectors: Float[np.ndarray, "known 3"]) -> _Vector | None:
    """The unit direction of the largest sum of squares; its largest part is positive."""
    values, directions = np.linalg.eigh(vectors.T @ vectors)
    if not len(vectors) or values[-1] <= 0.0:
        return None
    direction = directions[:, -1]
    return np.asarray(direction * np.sign(direction[np.argmax(np.abs(direction))]))


def _across(axis: _Vector) -> Float[np.ndarray, "2 3"]:
    """Two unit directions that make a right-handed frame with an axis."""
    one = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    one /= np.linalg.norm(one)
    return np.stack([one, np.cross(axis, one)])


def _spread(known: Bool[np.ndarray, "frames"], values: Float[np.ndarray, "known"]) -> _Frames:
    out = np.full(len(known), np.nan)
    out[known] = values
    return out


def _lever(body: BodyGeometry) -> float:
    return float(np.linalg.norm(body.corners, axis=1).max())
