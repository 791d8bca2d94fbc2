"""One moment of a capture as a picture: bodies from obliquely above, in parallel projection."""

from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model.errors import FileError
from capar.views.viewer.stage import Stage, StagedBody, is_ground, world_bounds

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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
"""Of more bodies than this only the objects are named: names would cover them."""

POINT_M = 0.015
"""How large a body without a surface is drawn."""


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
    if not first <= time_s <= last:
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
    for body in known:
        crowded = len(known) > MOST_NAMES and body.kind in ("sensor", "looks")
        if crowded or body.kind == "body":
            continue
        place = body.positions[frame]
        axes.annotate(
            body.label, (place @ across, place @ up), fontsize=7, ha="center",
            bbox={"boxstyle": "round,pad=0.15", "facecolor": "#ffffffb0", "linewidth": 0},
        )  # fmt: skip
    _frame(axes, shown, across, up)


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
