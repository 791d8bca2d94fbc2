"""One moment of a capture as a picture: bodies from obliquely above, in parallel projection."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model.errors import FileError
from capar.views.lettering import POINTS_PER_INCH, width_in
from capar.views.viewer.stage import UNNAMED, Stage, StagedBody, is_ground, world_bounds

if TYPE_CHECKING:
    from matplotlib.axes import Axes


Box = tuple[float, float, float, float]
"""Left, right, bottom and top, from the lower left corner of the picture [inches]."""

LARGE_IN = 1.1
"""A body that is wider and higher in the picture than this bears its name [inches]."""

RINGS_IN = np.arange(0.08, 6.0, 0.08)
"""How far from a body's edge its name may stand, in the order in which it is tried [inches]."""

ANGLES = np.pi / 2.0 + np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)


def place_labels(
    bodies: Sequence[Box], sizes: Sequence[tuple[float, float]], page: tuple[float, float]
) -> list[Box]:
    """What the name of each body covers [inches], in turn from the smallest body on.

    A name stands on a large body, else as near to its body as it covers no other name and no
    small body.

    Args:
        bodies: What each body covers in the picture.
        sizes: Width and height of each name.
        page: Width and height of the picture.
    """
    extents = [(box[1] - box[0], box[3] - box[2]) for box in bodies]
    large = [min(each) > LARGE_IN for each in extents]
    taken = [box for box, big in zip(bodies, large, strict=True) if not big]
    names: dict[int, Box] = {}
    for index in sorted(range(len(bodies)), key=lambda index: np.prod(extents[index])):
        left, right, bottom, top = bodies[index]
        wide, tall = sizes[index]
        centre = np.array([left + right, bottom + top]) / 2.0
        half = [0.0 if large[index] else min(each, LARGE_IN) / 2.0 for each in extents[index]]
        reach = np.array([half[0] + wide / 2.0, half[1] + tall / 2.0])
        directions = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)
        places = (centre + directions * (reach + ring) for ring in RINGS_IN)
        tries = [each for ring in places for each in ring]
        around = [
            (x - wide / 2, x + wide / 2, y - tall / 2, y + tall / 2)
            for x, y in ([centre, *tries] if large[index] else [*tries, centre])
        ]
        inside = [
            e for e in around if min(e[0], e[2]) >= 0.0 and e[1] <= page[0] and e[3] <= page[1]
        ]
        free = (e for e in inside if not any(meet(e, other) for other in names.values()))
        best = list(free) or inside or around
        clear = (e for e in best if not any(meet(e, other) for other in taken))
        names[index] = next(clear, best[0])
    return [names[index] for index in range(len(bodies))]


def meet(one: Box, other: Box) -> bool:
    """Whether two boxes have a place in common."""
    return one[0] <= other[1] and other[0] <= one[1] and one[2] <= other[3] and other[2] <= one[3]


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

    towards = EYE / np.linalg.norm(EYE)
    across = np.cross([0.0, 0.0, 1.0], towards)
    across /= np.linalg.norm(across)
    up = np.cross(towards, across)
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
    left_out = {*UNNAMED, "sensor", "looks"} if crowded else {*UNNAMED}
    named = [index for index, kind in enumerate(kinds) if kind not in left_out]
    page = SIZE_IN[0], SIZE_IN[1] * PAINTED
    corner = np.array([axes.get_xlim()[0], axes.get_ylim()[0]])
    scale = page[0] / float(np.ptp(axes.get_xlim()))
    boxes: list[Box] = []
    for index in named:
        low, high = (scale * (end(covered[index], axis=0) - corner) for end in (np.min, np.max))
        boxes.append((float(low[0]), float(high[0]), float(low[1]), float(high[1])))
    tall = 1.6 * LABEL_PT / POINTS_PER_INCH
    sizes = [(width_in(known[each].label, points=LABEL_PT) + 0.07, tall) for each in named]
    for index, body, box in zip(named, boxes, place_labels(boxes, sizes, page), strict=True):
        centre = np.array([body[0] + body[1], body[2] + body[3]]) / 2.0
        if min(body[1] - body[0], body[3] - body[2]) <= LARGE_IN:
            nearest = np.clip(centre, [box[0], box[2]], [box[1], box[3]])
            line = np.stack([centre, nearest]) / scale + corner
            axes.plot(*line.T, color="#555555", linewidth=0.6, zorder=2.5)
        x, y = np.array([box[0] + box[1], box[2] + box[3]]) / 2.0 / scale + corner
        axes.text(
            x, y, known[index].label, fontsize=LABEL_PT,
            ha="center", va="center", zorder=5,
            bbox={"boxstyle": "square,pad=0.1", "facecolor": "#ffffffd0", "linewidth": 0},
        )  # fmt: skip


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
    one, other = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    normals = np.cross(one, other)
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
