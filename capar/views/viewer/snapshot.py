"""One moment of a capture as a picture: bodies from obliquely above, in parallel projection."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model.errors import FileError
from capar.views.lettering import POINTS_PER_INCH, width_in
from capar.views.viewer.stage import Stage, StagedBody, is_ground, world_bounds

if TYPE_CHECKING:
    from matplotlib.axes import Axes


Box = tuple[float, float, float, float]
"""Left, right, bottom and top, from the lower left corner of the picture [inches]."""

Place = tuple[float, float]
"""Rightward and upward from that corner [inches]."""

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


EYE = np.array([0.9, -1.1, 0.7])
"""From where it is seen, in the world."""

SUN = np.array([0.3, -0.5, 0.8])
EDGE_M = 0.04
"""Larger triangles are divided, so that each is before or behind a thing [m]."""

MOST_FACES = 6000
"""A surface of more is drawn as its convex hull [1]: leaving out faces would make holes."""

SIZE_IN, DPI = (9.0, 7.0), 130
PAINTED = 0.94
"""Share of the picture's height below its title."""

FAINT = 0.3
"""How opaque what is assumed or was not recorded is drawn [1]; floors are drawn as they are."""

MARGIN = 1.08
LEAST_M = 0.3
"""The picture is at least so high [m]."""

MOST_NAMES = 15
"""With more sensors than this only objects are named: names would cover them."""

POINT_M, POINT_PT = 0.015, 8.0
"""How large a body without a surface is [m], and is drawn in any case [points]."""

LABEL_PT = 7.5
"""Size of the letters of names [points]."""


ROUNDED_S = 1e-6
"""Times that differ by no more are one [s]."""


def snapshot(shown: Stage, time_s: float, path: Path) -> None:
    """Draw the moment that is nearest to a time to a PNG file, which is overwritten.

    Args:
        shown: The bodies and their ways.
        time_s: When [s].
        path: The file.

    Raises:
        FileError: The capture has no such time, or the file cannot be written.
    """
    first, last = float(shown.times[0]), float(shown.times[-1])
    if not first - ROUNDED_S <= time_s <= last + ROUNDED_S:
        raise FileError(
            path, f"no moment at {time_s:g} s;", f"the capture lasts from {first:g} to {last:g} s."
        )
    from matplotlib.figure import Figure

    frame = shown.nearest(time_s)
    figure = Figure(figsize=SIZE_IN, dpi=DPI)
    axes = figure.add_axes((0.0, 0.0, 1.0, PAINTED))
    _paint(axes, shown, frame)
    figure.suptitle(f"{shown.title}, {shown.times[frame]:.2f} s", fontsize=11)
    try:
        figure.savefig(path, format="png", metadata={"Software": None})
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}.") from None


def _paint(axes: "Axes", shown: Stage, frame: int) -> None:
    from matplotlib.collections import PolyCollection

    across, up, towards = _view()
    known = [body for body in shown.bodies if not np.isnan(body.positions[frame, 0])]
    patches, shades, depths = [np.zeros((0, 3, 2))], [np.zeros((0, 4))], [np.zeros(0)]
    for body in known:
        triangles = _triangles(body, frame)
        patches.append(np.stack([triangles @ across, triangles @ up], axis=2))
        depths.append(triangles.mean(axis=1) @ towards)
        opaque = FAINT if body.faint and not is_ground(body) else 1.0
        shade = _shaded(body.colour, triangles)
        shades.append(np.column_stack([shade, np.full(len(shade), opaque)]))
    order = np.argsort(np.concatenate(depths), kind="stable")
    colours = np.concatenate(shades)[order]
    axes.add_collection(
        PolyCollection(
            list(np.concatenate(patches)[order]),
            facecolors=colours,
            edgecolors=np.where(colours[:, 3:] < 1.0, 0.0, colours),
            linewidths=0.2,
        )
    )
    _frame(axes, shown, across, up)
    covered = [part.reshape(-1, 2) for part in patches[1:]]
    _points(axes, known, covered)
    _labels(axes, known, covered)


def _points(
    axes: "Axes", known: Sequence[StagedBody], covered: Sequence[Float[np.ndarray, "corners 2"]]
) -> None:
    """Bodies without a surface, before all others, as they may be inside of one."""
    found = [index for index, body in enumerate(known) if body.shape is None]
    size_pt = POINT_PT if len(found) <= MOST_NAMES else POINT_PT / 2.0
    for index in found:
        axes.plot(
            *covered[index].mean(axis=0),
            "o",
            color=known[index].colour,
            markeredgecolor="black",
            markeredgewidth=0.8,
            markersize=size_pt,
            zorder=3,
        )


def _labels(
    axes: "Axes", known: Sequence[StagedBody], covered: Sequence[Float[np.ndarray, "corners 2"]]
) -> None:
    """Names of bodies, clear of each other and of what is small, with lines to their bodies."""
    kinds = [body.kind for body in known]
    crowded = sum(kind in ("sensor", "looks") for kind in kinds) > MOST_NAMES
    left_out = {"body", "sensor", "looks"} if crowded else {"body"}
    named = [index for index, kind in enumerate(kinds) if kind not in left_out]
    page = SIZE_IN[0], SIZE_IN[1] * PAINTED
    corner = np.array([axes.get_xlim()[0], axes.get_ylim()[0]])
    scale = page[0] / float(np.ptp(axes.get_xlim()))
    bodies = []
    for index in named:
        low, high = (scale * (end(covered[index], axis=0) - corner) for end in (np.min, np.max))
        wide = width_in(known[index].label, points=LABEL_PT) + 0.07
        box = (float(low[0]), float(high[0]), float(low[1]), float(high[1]))
        bodies.append(Labelled(box, (wide, 1.6 * LABEL_PT / POINTS_PER_INCH)))
    for index, body, box in zip(named, bodies, place_labels(bodies, page), strict=True):
        line = leader(box, body.middle) / scale + corner
        if not body.large:
            axes.plot(*line.T, color="#555555", linewidth=0.6, zorder=2.5)
        middle = np.array([box[0] + box[1], box[2] + box[3]]) / 2.0
        x, y = middle / scale + corner
        axes.text(
            x, y, known[index].label, fontsize=LABEL_PT,
            ha="center", va="center", zorder=5,
            bbox={"boxstyle": "square,pad=0.1", "facecolor": "#ffffffd0", "linewidth": 0},
        )  # fmt: skip


def _view() -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """Unit vectors to the right and upward in the picture, and out of it."""
    towards = EYE / np.linalg.norm(EYE)
    across = np.cross([0.0, 0.0, 1.0], towards)
    across /= np.linalg.norm(across)
    return across, np.cross(towards, across), towards


def _triangles(body: StagedBody, frame: int) -> Float[np.ndarray, "triangles 3 3"]:
    """A body's surface in the world at a frame [m]."""
    if body.shape is None:
        mesh = trimesh.creation.icosphere(subdivisions=1, radius=POINT_M)
        vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    else:
        vertices, faces = np.array(body.shape.vertices), np.array(body.shape.faces)
        if len(faces) > MOST_FACES:
            hull = trimesh.Trimesh(vertices, faces, process=False).convex_hull
            vertices, faces = np.asarray(hull.vertices), np.asarray(hull.faces)
    edge_m = max(EDGE_M, float(np.ptp(vertices, axis=0).max()) / 40.0)
    whole = trimesh.Trimesh(vertices, faces, process=False)
    divided = cast(trimesh.Trimesh, whole.subdivide_to_size(edge_m))
    vertices, faces = np.asarray(divided.vertices), np.asarray(divided.faces)
    turn = Rotation.from_quat(body.orientations[frame], scalar_first=True)
    return np.asarray((turn.apply(vertices) + body.positions[frame])[faces])


def _shaded(
    colour: str, triangles: Float[np.ndarray, "triangles 3 3"]
) -> Float[np.ndarray, "triangles 3"]:
    """The colour of each triangle, lighter where it faces the sun, on either side."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    lengths = np.maximum(np.linalg.norm(normals, axis=1), 1e-12)
    light = 0.55 + 0.45 * np.abs(normals @ (SUN / np.linalg.norm(SUN))) / lengths
    base = np.array([int(colour[at : at + 2], 16) for at in (1, 3, 5)]) / 255.0
    return np.clip(light[:, None] * base, 0.0, 1.0)


def _frame(
    axes: "Axes", shown: Stage, across: Float[np.ndarray, "3"], up: Float[np.ndarray, "3"]
) -> None:
    """Set the limits to what moves, the same at every moment, and hide the axes."""
    low, high = world_bounds(shown)
    corners = np.array(np.meshgrid(*np.stack([low, high], axis=1))).reshape(3, -1).T
    right, top = corners @ across, corners @ up
    ratio = SIZE_IN[0] / (SIZE_IN[1] * PAINTED)
    height = MARGIN * max(float(np.ptp(top)), float(np.ptp(right)) / ratio, LEAST_M)
    middle_x, middle_y = (right.min() + right.max()) / 2.0, (top.min() + top.max()) / 2.0
    axes.set_xlim(middle_x - ratio * height / 2.0, middle_x + ratio * height / 2.0)
    axes.set_ylim(middle_y - height / 2.0, middle_y + height / 2.0)
    axes.axis("off")


def distance(box: Box, place: Place) -> float:
    """How far a place is from a box [inches]."""
    aside = max(box[0] - place[0], place[0] - box[1], 0.0)
    return float(np.hypot(aside, max(box[2] - place[1], place[1] - box[3], 0.0)))


def meet(one: Box, other: Box) -> bool:
    """Whether two boxes have a place in common."""
    return one[0] <= other[1] and other[0] <= one[1] and one[2] <= other[3] and other[2] <= one[3]
