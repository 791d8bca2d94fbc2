"""Things of a scene: a body with a form, and the places where a hand can touch it."""

from dataclasses import dataclass, field

import numpy as np

from capar.model.capture import TagType
from scenes.hands.paths import Body
from scenes.hands.shapes import Form

SITES = {
    "+x": (1.0, 0.0, 0.0),
    "-x": (-1.0, 0.0, 0.0),
    "+y": (0.0, 1.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
    "+z": (0.0, 0.0, 1.0),
    "-z": (0.0, 0.0, -1.0),
}
"""Sides of a thing, as directions out of it in its own frame."""


@dataclass(eq=False)
class Thing:
    """Something in the scene that is no acting hand."""

    body: Body
    form: Form
    tag: TagType
    free: list[tuple[float, float]] = field(default_factory=list)
    """When it moves without being held: it was struck or thrown [s]."""

    @property
    def name(self) -> str:
        """Its name in the capture."""
        return self.body.name

    def site(self, side: str, up: float, time: float) -> tuple[np.ndarray, np.ndarray]:
        """A point on one of its sides at a time, and the direction out of it.

        Args:
            side: One of ``SITES``.
            up: Height of the point as a share of the thing's height (of the side's middle).
            time: When [s].
        """
        corners = self.form.vertices
        low, high = corners.min(axis=0), corners.max(axis=0)
        out = np.asarray(SITES[side])
        point = (low + high) / 2.0
        point[2] = low[2] + up * (high[2] - low[2])
        axis = int(np.argmax(np.abs(out)))
        point[axis] = high[axis] if out[axis] > 0 else low[axis]
        matrix = self.body.at(time)
        return matrix[:3, :3] @ point + matrix[:3, 3], matrix[:3, :3] @ out
