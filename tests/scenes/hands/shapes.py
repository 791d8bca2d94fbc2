"""Surfaces of hands and things, each as convex parts in metres."""

from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise

import numpy as np
import trimesh
from trimesh import Trimesh

HAND_DEPTH = 0.028
"""Thickness of a palm [m]."""


@dataclass(frozen=True, eq=False)
class Form:
    """A surface made of convex parts, in its body's frame."""

    kind: str
    parts: tuple[Trimesh, ...]

    @property
    def mesh(self) -> Trimesh:
        """All parts as one."""
        return trimesh.util.concatenate(list(self.parts))

    @cached_property
    def vertices(self) -> np.ndarray:
        """Corners of all parts."""
        return np.concatenate([each.vertices for each in self.parts])

    def scaled(self, factor: float) -> "Form":
        """The same form, larger or smaller."""
        parts = []
        for each in self.parts:
            part = each.copy()
            part.apply_scale(factor)
            parts.append(part)
        return Form(self.kind, tuple(parts))


def block(low: tuple[float, float, float], high: tuple[float, float, float]) -> Trimesh:
    """A box between two corners."""
    size = np.subtract(high, low)
    middle = (np.add(high, low)) / 2.0
    return trimesh.creation.box(size, trimesh.transformations.translation_matrix(middle))


def box(length: float, width: float, height: float, kind: str = "box") -> Form:
    """A solid box that stands on its frame's origin."""
    return Form(kind, (block((-length / 2, -width / 2, 0), (length / 2, width / 2, height)),))


def flat_hand(side: str) -> Form:
    """An open hand: it faces along x with its palm at the origin, fingers along y."""
    parts = [block((-HAND_DEPTH, -0.045, -0.04), (0.0, 0.045, 0.04))]
    for low in (-0.04, -0.019, 0.002, 0.023):
        parts.append(block((-0.019, 0.04, low), (-0.001, 0.12, low + 0.017)))
    low, high = (0.035, 0.06) if side == "left" else (-0.06, -0.035)
    parts.append(block((-0.021, -0.02, low), (-0.001, 0.045, high)))
    return Form("hand", tuple(parts))


def gripping_hand(opening: float, fingers: float) -> Form:
    """A hand bent to a U: palm at the origin facing along x, fingers and thumb at both sides."""
    half = opening / 2.0
    parts = [block((-HAND_DEPTH, -half - 0.018, -0.04), (0.0, half + 0.016, 0.04))]
    for low in (-0.04, -0.019, 0.002, 0.023):
        parts.append(block((-0.01, half, low), (fingers, half + 0.016, low + 0.017)))
    parts.append(block((-0.01, -half - 0.018, -0.011), (0.8 * fingers, -half, 0.011)))
    return Form("hand", tuple(parts))


def pointing_hand() -> Form:
    """A fist with the index finger out along x, its tip at the origin."""
    fist = block((-0.15, -0.04, -0.035), (-0.065, 0.04, 0.035))
    return Form("hand", (fist, block((-0.07, -0.008, -0.008), (0.0, 0.008, 0.008))))


def ring(inner: float, outer: float, low: float, high: float, sections: int = 20) -> list[Trimesh]:
    """A round wall as convex wedges."""
    return [each.copy() for each in _wedges(inner, outer, low, high, sections)]


@cache
def _wedges(
    inner: float, outer: float, low: float, high: float, sections: int
) -> tuple[Trimesh, ...]:
    """The wedges of a wall; many scenes have the same mug."""
    angles = np.linspace(0.0, 2.0 * np.pi, sections + 1)
    wedges = []
    for first, last in pairwise(angles):
        corners = [
            (radius * np.cos(angle), radius * np.sin(angle), z)
            for radius in (inner, outer)
            for angle in (first, last)
            for z in (low, high)
        ]
        wedges.append(trimesh.convex.convex_hull(corners))
    return tuple(wedges)


def disc(radius: float, low: float, high: float, sections: int = 20) -> Trimesh:
    """A round plate as a prism with the same corners as a ring."""
    return _plate(radius, low, high, sections).copy()


@cache
def _plate(radius: float, low: float, high: float, sections: int) -> Trimesh:
    angles = np.linspace(0.0, 2.0 * np.pi, sections + 1)[:-1]
    corners = [(radius * np.cos(a), radius * np.sin(a), z) for a in angles for z in (low, high)]
    return trimesh.convex.convex_hull(corners)


def vessel(radius: float, height: float, kind: str = "mug", wall: float = 0.005) -> Form:
    """An open round vessel that stands on its origin: a mug, a cup, a bowl."""
    parts = [disc(radius, 0.0, wall), *ring(radius - wall, radius, 0.5 * wall, height)]
    return Form(kind, tuple(parts))


def bottle(radius: float = 0.034, height: float = 0.2) -> Form:
    """A round bottle with a neck, standing on its origin."""
    body = disc(radius, 0.0, 0.7 * height)
    return Form("bottle", (body, disc(0.4 * radius, 0.65 * height, height)))


def carton(length: float, width: float, height: float, wall: float = 0.006) -> Form:
    """An open carton of a floor and four walls, standing on its origin."""
    x, y = length / 2.0, width / 2.0
    return Form(
        "carton",
        (
            block((-x, -y, 0.0), (x, y, wall)),
            block((-x, -y, 0.0), (-x + wall, y, height)),
            block((x - wall, -y, 0.0), (x, y, height)),
            block((-x, -y, 0.0), (x, -y + wall, height)),
            block((-x, y - wall, 0.0), (x, y, height)),
        ),
    )


def drawer_box(length: float, width: float, height: float) -> Form:
    """A box with an upright handle plate on its near side (towards negative x)."""
    parts = box(length, width, height).parts
    low, high = (-length / 2 - 0.06, -0.004, 0.3 * height), (-length / 2, 0.004, 0.9 * height)
    return Form("box", (*parts, block(low, high)))


def tray(length: float, width: float) -> Form:
    """A tray with a rim that hands can take, standing on its origin."""
    return Form("tray", carton(length, width, 0.09, 0.008).parts)


def ball(radius: float, kind: str = "ball") -> Form:
    """A ball about its origin."""
    return Form(kind, (trimesh.creation.icosphere(3, radius),))


def rod(length: float, width: float, kind: str = "spoon") -> Form:
    """An upright rod whose lower end is the origin: a spoon, a stick."""
    return Form(kind, (block((-width, -width, 0.0), (width, width, length)),))
