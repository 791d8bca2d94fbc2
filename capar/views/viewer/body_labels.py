"""Where the names of bodies stand in a picture: on no other name, and beside what is small."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.views.number_places import Box, Place, distance, meet

LARGE_IN = 1.1
"""A body that is wider and higher in the picture than this bears its name [inches]."""

NEAR_IN, RINGS, ANGLES = 0.08, 16, 24
"""Between rings of places around a body [inches]; how many rings, and places on each."""

GAP_IN = 0.02
"""Least room between names [inches]."""

SAMPLES = 24
"""At so many places of a line it is told what it crosses."""

MET, CROSSED, COVERED, FAR = 1000.0, 40.0, 12.0, 3.0
"""How bad it is to stand on a name, on a line or a name's line on it, to cover a body whole, and to
be an inch away."""


@dataclass(frozen=True)
class Labelled:
    """A body that gets a name: what it covers in the picture, and how large its name is."""

    box: Box
    size: tuple[float, float]

    @property
    def middle(self) -> Place:
        """The middle of what it covers [inches]."""
        return (self.box[0] + self.box[1]) / 2.0, (self.box[2] + self.box[3]) / 2.0

    @property
    def large(self) -> bool:
        """Whether names may stand on it."""
        return min(self.box[1] - self.box[0], self.box[3] - self.box[2]) > LARGE_IN


def place_labels(bodies: Sequence[Labelled], page: tuple[float, float]) -> list[Box]:
    """What the name of each body covers [inches], in turn from the smallest body on.

    Args:
        bodies: What is named.
        page: Width and height of the picture [inches].
    """
    small = [body.box for body in bodies if not body.large]
    placed: dict[int, Box] = {}
    lines: list[Float[np.ndarray, "samples 2"]] = []
    for index in sorted(range(len(bodies)), key=lambda index: _area(bodies[index].box)):
        body = bodies[index]
        tries = [box for box in _tries(body) if _on(box, page)] or [_around(body, body.middle)]
        costs = [_cost(box, body, small, list(placed.values()), lines) for box in tries]
        placed[index] = tries[int(np.argmin(costs))]
        lines.append(leader(placed[index], body.middle))
    return [placed[index] for index in range(len(bodies))]


def leader(box: Box, place: Place) -> Float[np.ndarray, "samples 2"]:
    """Places on the line from a body to its name; where it stands on the body, one place."""
    start = np.array(place)
    end = np.array([np.clip(place[0], *box[:2]), np.clip(place[1], *box[2:])])
    return np.asarray(start + np.linspace(0.0, 1.0, SAMPLES)[:, None] * (end - start))


def _tries(body: Labelled) -> list[Box]:
    """Places of its name: on it if it is large, and on rings around it."""
    half = (
        0.5 * (0.0 if body.large else min(body.box[1] - body.box[0], LARGE_IN)),
        0.5 * (0.0 if body.large else min(body.box[3] - body.box[2], LARGE_IN)),
    )
    out = [_around(body, body.middle)] if body.large else []
    for ring in range(1, RINGS + 1):
        for angle in np.linspace(0.0, 2.0 * np.pi, ANGLES, endpoint=False) + np.pi / 2.0:
            x = (half[0] + body.size[0] / 2.0 + NEAR_IN * ring) * float(np.cos(angle))
            y = (half[1] + body.size[1] / 2.0 + NEAR_IN * ring) * float(np.sin(angle))
            out.append(_around(body, (body.middle[0] + x, body.middle[1] + y)))
    return out


def _around(body: Labelled, place: Place) -> Box:
    wide, tall = body.size[0] / 2.0, body.size[1] / 2.0
    return place[0] - wide, place[0] + wide, place[1] - tall, place[1] + tall


def _on(box: Box, page: tuple[float, float]) -> bool:
    return box[0] >= 0.0 and box[2] >= 0.0 and box[1] <= page[0] and box[3] <= page[1]


def _cost(
    box: Box,
    body: Labelled,
    small: Sequence[Box],
    names: Sequence[Box],
    lines: Sequence[Float[np.ndarray, "samples 2"]],
) -> float:
    wide = box[0] - GAP_IN, box[1] + GAP_IN, box[2] - GAP_IN, box[3] + GAP_IN
    own = leader(box, body.middle)
    crossed = sum(_crosses(line, wide) for line in lines)
    crossed += sum(_crosses(own, name) for name in names)
    return (
        MET * sum(meet(wide, name) for name in names)
        + CROSSED * crossed
        + COVERED * sum(_shared(box, other) / max(_area(other), 1e-3) for other in small)
        + FAR * distance(box, body.middle)
    )


def _crosses(line: Float[np.ndarray, "samples 2"], box: Box) -> bool:
    x, y = line.T
    return bool(((x > box[0]) & (x < box[1]) & (y > box[2]) & (y < box[3])).any())


def _area(box: Box) -> float:
    return (box[1] - box[0]) * (box[3] - box[2])


def _shared(one: Box, other: Box) -> float:
    """The area that two boxes have in common."""
    wide = min(one[1], other[1]) - max(one[0], other[0])
    tall = min(one[3], other[3]) - max(one[2], other[2])
    return max(wide, 0.0) * max(tall, 0.0)
