"""Shapes that capture.toml states, as meshes: files, primitives, capsules over joints, parts."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model import geometry
from capar.model.capture import Notice, Shape, ShapeSource, Source, notice
from extractors.readers.bundle.mesh import open_edges, read_mesh
from extractors.readers.bundle.world import mirrored
from extractors.readers.files import source_of
from extractors.readers.recording import UNITS
from extractors.readers.schema.document import expanded

if TYPE_CHECKING:
    from extractors.readers.schema.shapes import (
        BoxShape,
        CapsuleShape,
        CapsulesShape,
        CylinderShape,
        MarkerBoxShape,
        MeshShape,
        PartsShape,
        Pose,
        SphereShape,
    )

LARGEST_M = 20.0
"""No shape is longer [m]."""

STRETCH_M = 0.01
"""A bone changes its length by no more [m]: joints that are tracked by markers shift less."""

Mesh = tuple[np.ndarray, np.ndarray]
"""Corners [m] and faces."""

Described = tuple[np.ndarray, np.ndarray, str]
"""Corners [m], faces, and what the shape is in words."""


@dataclass
class Frame:
    """What a shape may refer to in its body: points of the body's frame, and a skeleton."""

    points: Mapping[str, Float[np.ndarray, "3"]] = field(default_factory=dict)
    """Markers and other bodies, by name, in the body's frame [m]."""

    markers: tuple[str, ...] = ()
    """The names of the body's own markers."""

    bones: Mapping[str, tuple[tuple[str, str], ...]] = field(default_factory=dict)
    """``children`` and ``descendants``: pairs of joints, the body itself being ``""``."""

    joint: str = ""
    """What the file calls the body, if it has a skeleton."""

    lengths: Callable[[str, str], tuple[float, float]] | None = None
    """The least and the greatest distance of two joints over time [m], but for outliers."""

    mirrored: bool = False
    """Whether the body's file is left-handed."""

    owner: str = ""
    """Name of the sensor or object, for notices."""

    sources: list[Source] = field(default_factory=list)
    """Mesh files that were read, for the capture's provenance."""

    notices: list[Notice] = field(default_factory=list)
    """What is doubtful about the mesh files."""


def build_shape(entry: "Pose", frame: Frame) -> Shape:
    """The shape that a table states.

    Raises:
        CaparError: A mesh cannot be read, or a marker or joint is unknown.
    """
    vertices, faces, description = _placed(entry, frame)
    stand_in = not any("mesh" in part.given() for part in [entry, *getattr(entry, "parts", [])])
    source = ShapeSource.STAND_IN if stand_in else ShapeSource.MESH
    return Shape(vertices=vertices, faces=faces, source=source, description=description)


def assumed(shape: Shape) -> Shape:
    """The same shape, marked as assumed."""
    return replace(shape, source=ShapeSource.ASSUMED)


def _placed(entry: "Pose", frame: Frame) -> Described:
    """A shape's corners in the body's frame, after its own pose, its faces and description."""
    vertices, faces, description = _MAKERS[type(entry).__name__](entry, frame)
    return transform(entry).apply(vertices), faces, description


def transform(pose: "Pose | None") -> RigidTransform:
    """The rigid transform of a stated pose; none stated is no motion."""
    if pose is None:
        return RigidTransform.identity()
    quaternion = geometry.unit(np.array([pose.orientation]))[0]
    return geometry.transforms(np.array(pose.position), quaternion)


def _mesh(entry: "MeshShape", frame: Frame) -> Described:
    path = expanded(entry, "mesh")
    if not path.is_file():
        raise entry.error("mesh", f"no mesh file {entry.mesh!r} ({path}).", _others(path))
    vertices, faces = read_mesh(path)
    frame.sources.append(replace(source_of(path, "mesh"), path=entry.mesh))
    if edges := open_edges(vertices, faces):
        frame.notices.append(notice("mesh-not-closed", frame.owner, mesh=path.name, edges=edges))
    vertices = vertices * UNITS[entry.unit]
    if (entry.handedness or ("left" if frame.mirrored else "right")) == "left":
        vertices, faces = mirrored(vertices), faces[:, ::-1]
    _check_size(entry, vertices)
    return vertices, faces, path.name


def _others(path: Path) -> str:
    if not path.parent.is_dir():
        return f"There is no folder {path.parent}."
    names = sorted(file.name for file in path.parent.iterdir())
    return f"The folder holds: {', '.join(names[:12])}"


def _check_size(entry: "MeshShape", vertices: np.ndarray) -> None:
    size = float((vertices.max(axis=0) - vertices.min(axis=0)).max())
    if not 0.001 <= size <= LARGEST_M:
        raise entry.error(
            "mesh",
            f"in its unit the mesh is {size:.4g} m long.",
            'State its unit: unit = "mm" (or cm, dm, m, in, ft).',
        )


def _box(entry: "BoxShape", frame: Frame) -> Described:
    return _box_about(np.zeros(3), entry.box)


def _marker_box(entry: "MarkerBoxShape", frame: Frame) -> Described:
    names = entry.around or list(frame.markers)
    if len(names) < 2:
        problem = 'box = "markers" needs markers: a body\'s own, or around = [..].'
        raise entry.error("box", problem)
    points = np.stack([_point(entry, "around", frame, name) for name in names])
    low, high = points.min(axis=0) - entry.margin_m, points.max(axis=0) + entry.margin_m
    size = [float(length) for length in np.maximum(high - low, 0.001)]
    if max(size) > LARGEST_M:
        raise entry.error(
            "box", f"the box would be {_text(size)} m.", "Are the markers of one body?"
        )
    return _box_about((low + high) / 2, size)


def _box_about(middle: np.ndarray, size: list[float]) -> Described:
    import trimesh

    box = trimesh.creation.box(extents=size)
    return np.array(box.vertices) + middle, np.array(box.faces), f"box {_text(size)} m"


def _cylinder(entry: "CylinderShape", frame: Frame) -> Described:
    import trimesh

    radius, height = entry.cylinder
    mesh = trimesh.creation.cylinder(radius=radius, height=height, sections=32)
    text = f"cylinder of radius {radius:.3g} m, height {height:.3g} m"
    return np.array(mesh.vertices), np.array(mesh.faces), text


def _sphere(entry: "SphereShape", frame: Frame) -> Described:
    zero = np.zeros(3)
    return *_capsule_between(zero, zero, entry.sphere), f"sphere of radius {entry.sphere:.3g} m"


def _capsule(entry: "CapsuleShape", frame: Frame) -> Described:
    radius, height = entry.capsule
    half = np.array([0.0, 0.0, height / 2])
    text = f"capsule of radius {radius:.3g} m, height {height:.3g} m"
    return *_capsule_between(-half, half, radius), text


def _capsules(entry: "CapsulesShape", frame: Frame) -> Described:
    pairs = _pairs(entry, frame)
    points = {"": np.zeros(3)}
    for name in {name for pair in pairs for name in pair} - {""}:
        points[name] = _point(entry, "capsules", frame, name)
    meshes = [_capsule_between(points[a], points[b], entry.radius_m) for a, b in pairs]
    what = "a capsule" if len(pairs) == 1 else f"{len(pairs)} capsules"
    ((one, other), *more) = pairs
    far = float(np.linalg.norm(points[one] - points[other]))
    long = f" and length {far + 2.0 * entry.radius_m:.2g} m" * (not more and far > 0.0)
    return *joined(meshes), f"{what} of radius {entry.radius_m:.3g} m{long}"


def _pairs(entry: "CapsulesShape", frame: Frame) -> list[tuple[str, str]]:
    """The pairs of points that capsules are put between; the body itself is ``""``."""
    if not isinstance(entry.capsules, str):
        return [(first, second) for first, second in entry.capsules]
    if entry.capsules not in frame.bones:
        raise entry.error(
            "capsules",
            f"capsules = {entry.capsules!r} needs a body with a skeleton.",
            'Give pairs of names: [["WRIST", "INDEX"]].',
        )
    pairs = list(frame.bones[entry.capsules]) or [("", "")]
    frame.notices += _stretching(pairs, frame)
    return pairs


def _stretching(pairs: list[tuple[str, str]], frame: Frame) -> Iterator[Notice]:
    """Of each bone that becomes longer and shorter: its ends are not joined to each other."""
    for first, second in pairs:
        shortest, longest = frame.lengths(first, second) if frame.lengths else (0.0, 0.0)
        if longest - shortest > STRETCH_M:
            bone = first or frame.joint, second
            yield notice(
                "bone-stretches", frame.owner, *bone, shortest_m=shortest, longest_m=longest
            )


def _point(entry: "Pose", key: str, frame: Frame, name: str) -> Float[np.ndarray, "3"]:
    if name not in frame.points:
        raise entry.unknown("point", name, frame.points, key)
    return frame.points[name]


def _parts(entry: "PartsShape", frame: Frame) -> Described:
    parts = [_placed(part, frame) for part in entry.parts]
    meshes = [(vertices, faces) for vertices, faces, _ in parts]
    return *joined(meshes), " + ".join(text for _, _, text in parts)


def joined(meshes: list[Mesh]) -> Mesh:
    """Several meshes as one; they may overlap."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    faces = [faces + start for (_, faces), start in zip(meshes, starts, strict=False)]
    return np.concatenate([vertices for vertices, _ in meshes]), np.concatenate(faces)


def _capsule_between(
    first: Float[np.ndarray, "3"], second: Float[np.ndarray, "3"], radius: float
) -> Mesh:
    """A sphere at the first point, stretched to the second."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=2, radius=radius)
    way = second - first
    length = float(np.linalg.norm(way))
    vertices, faces = np.array(ball.vertices), np.array(ball.faces)
    if length < 1e-6:
        return vertices + first, faces
    turn, _ = Rotation.align_vectors([way / length], [[0.0, 0.0, 1.0]])
    vertices[vertices[:, 2] > 1e-9 * radius] += [0.0, 0.0, length]
    return turn.apply(vertices) + first, faces


def _text(size: list[float]) -> str:
    return " x ".join(f"{each:.3g}" for each in size)


_MAKERS: dict[str, Callable[[Any, Frame], Described]] = {
    "MeshShape": _mesh,
    "BoxShape": _box,
    "MarkerBoxShape": _marker_box,
    "CylinderShape": _cylinder,
    "SphereShape": _sphere,
    "CapsuleShape": _capsule,
    "CapsulesShape": _capsules,
    "PartsShape": _parts,
}
"""What builds each kind of shape of the schema."""
