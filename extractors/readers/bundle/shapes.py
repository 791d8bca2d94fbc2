"""Shapes that capture.toml states, as meshes, and the supports that are placed by them."""

import io
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model import geometry
from capar.model.capture import Notice, Shape, ShapeSource, Source, TagObject, TagType, notice
from capar.model.errors import FileError
from extractors.contact.surfaces import equal_rows, joined
from extractors.readers.file_access import check_file, check_zip, neighbours, source_of
from extractors.readers.recording import UNITS
from extractors.readers.schema.capture import (
    CapsulesShape,
    MarkerBoxShape,
    MeshShape,
    ObjectEntry,
    PartsShape,
    Pose,
)
from extractors.readers.schema.entry import expanded

MESH_LIMIT = 256 << 20  # Bytes that a mesh file may hold or expand to [B].
FORMATS = ("stl", "ply", "obj", "off", "glb", "3mf", "dae", "x3d", "gltf")
"""Suffixes that are tried; the last four need what trimesh asks for."""

_XML = (".model", ".xml", ".dae", ".x3d", ".rels")


def read_mesh(path: Path) -> tuple[Float[np.ndarray, "vertices 3"], Int[np.ndarray, "faces 3"]]:
    """Corners in the file's own unit, and faces.

    Raises:
        FileError: The file is missing, damaged, too large, or XML that defines entities.
    """
    check_file(path)
    suffix = path.suffix.lower().removeprefix(".")
    if suffix not in FORMATS:
        raise FileError(path, f"a mesh of kind {suffix!r}.", f"These are tried: {FORMATS}.")
    if path.stat().st_size > MESH_LIMIT:
        raise FileError(path, f"is a mesh of more than {MESH_LIMIT >> 20} MiB.", "Decimate it.")
    _check_xml(path)
    data = path.read_bytes()
    if suffix == "obj" and (plain := _plain_obj(data)):
        return plain
    try:
        import trimesh  # takes a fifth of a second

        # from memory, so that nothing the file refers to is opened
        mesh: Any = trimesh.load(
            io.BytesIO(data), file_type=suffix, force="mesh", skip_materials=True
        )
        vertices = np.asarray(mesh.vertices, dtype=float)
        faces = np.asarray(mesh.faces, dtype=np.int64).reshape(-1, 3)
    except ImportError as error:
        raise FileError(
            path,
            f"reading {suffix} needs a package that is not installed: {error}.",
            "Install it, or convert the mesh to STL, PLY, OBJ or GLB.",
        ) from error
    except Exception as error:  # damaged bytes make mesh loaders raise anything
        detail = f"{type(error).__name__}: {str(error)[:200]}"
        raise FileError(path, f"is a damaged {suffix} mesh ({detail}).") from error
    if not len(faces) or not np.isfinite(vertices).all():
        raise FileError(path, "has no triangles, or corners at infinity.", "Export it again.")
    return vertices, faces


def _plain_obj(data: bytes) -> "Mesh | None":
    """What an OBJ file holds that states corners and triangles alone; None of any other."""
    rows = [row for row in map(bytes.split, data.splitlines()) if row and row[0][:1] != b"#"]
    if not {(row[0], len(row)) for row in rows} <= {(b"v", 4), (b"f", 4)}:
        return None
    if any(b"_" in cell for row in rows for cell in row):  # which Python takes in numbers
        return None
    corners, threes = ([row[1:] for row in rows if row[0] == kind] for kind in (b"v", b"f"))
    try:
        vertices = np.array([list(map(float, each)) for each in corners]).reshape(-1, 3)
        faces = np.array([list(map(int, each)) for each in threes], np.int64).reshape(-1, 3) - 1
    except (ValueError, OverflowError):
        return None
    if not faces.size or faces.min() < 0 or faces.max() >= len(vertices):
        return None
    return joined(vertices, faces) if np.isfinite(vertices).all() else None


def open_edges(vertices: Float[np.ndarray, "vertices 3"], faces: Int[np.ndarray, "faces 3"]) -> int:
    """How many edges bound one triangle only; a closed surface has none.

    Vertices at the same place count as one, as files with textures repeat them.
    """
    corners = equal_rows(vertices)[0][faces]
    corners = corners[geometry.every(corners != corners[:, [2, 0, 1]])]
    after = corners[:, [1, 2, 0]]
    # An edge as one number, since rows of two are compared slowly.
    edges = np.minimum(corners, after) * len(vertices) + np.maximum(corners, after)
    _, counts = np.unique(edges, return_counts=True)
    return int((counts == 1).sum())


def _check_xml(path: Path) -> None:
    """XML may define no entities: a few lines of them expand without end."""
    found = []
    with path.open("rb") as file:
        zipped = file.read(4) == b"PK\x03\x04"
    if zipped:
        names = [each for each in check_zip(path, MESH_LIMIT) if each.lower().endswith(_XML)]
        with zipfile.ZipFile(path) as archive:
            found = [archive.read(name) for name in names]
    elif path.suffix.lower() in _XML:
        found = [path.read_bytes()]
    for data in found:
        text = data.replace(b"\0", b"")  # so that UTF-16 hides nothing
        if b"<!ENTITY" in text or b"<!DOCTYPE" in text:
            raise FileError(
                path,
                "is XML with a DOCTYPE or entities, which are never expanded.",
                "Export it again, without them.",
            )


LARGEST_M = 20.0  # No shape is longer [m].
STRETCH_M = 0.01
"""A bone changes its length by no more [m]: joints that are tracked by markers shift less."""

Mesh = tuple[np.ndarray, np.ndarray]  # Corners [m] and faces.
Described = tuple[np.ndarray, np.ndarray, str]
"""Corners [m], faces, and what the shape is in words."""


@dataclass
class Frame:
    """What a shape may refer to in its body: points of the body's frame, and a skeleton."""

    names: tuple[str, ...] = ()
    """Markers and other bodies of the file."""

    place: Callable[[str], Float[np.ndarray, "3"]] = lambda _: np.zeros(3)
    """Where one of them is in the body's frame [m]."""

    markers: tuple[str, ...] = ()
    """The names of the body's own markers."""

    bones: Mapping[str, Sequence[tuple[str, str]]] = field(default_factory=dict)
    """``children`` and ``descendants``: pairs of joints, the body itself being ``""``."""

    joint: str = ""
    """What the file calls the body, if it has a skeleton."""

    lengths: Callable[[str, str], tuple[float, float]] | None = None
    """The least and the greatest distance of two joints over time [m], but for outliers."""

    mirrored: bool = False
    """Whether the body's file is left-handed."""

    recorded: Shape | None = None
    """The body's surface, if the file holds it."""

    owner: str = ""
    """Name of the sensor or object, for notices."""

    sources: list[Source] = field(default_factory=list)
    """Mesh files that were read, for the capture's provenance."""

    notices: list[Notice] = field(default_factory=list)
    """What is doubtful about the mesh files."""


def build_shape(entry: Pose, frame: Frame) -> Shape:
    """The shape that a table states.

    Raises:
        CaparError: A mesh cannot be read, or a marker or joint is unknown.
    """
    vertices, faces, description = _placed(entry, frame)
    stand_in = not any("mesh" in part.given() for part in [entry, *getattr(entry, "parts", [])])
    source = ShapeSource.STAND_IN if stand_in else ShapeSource.MESH
    return Shape(vertices=vertices, faces=faces, source=source, description=description)


def _placed(entry: Pose, frame: Frame) -> Described:
    """A shape's corners in the body's frame, after its own pose, its faces and description."""
    vertices, faces, description = _MAKERS[type(entry).__name__](entry, frame)
    return transform(entry).apply(vertices), faces, description


def transform(pose: Pose | None) -> RigidTransform:
    """The rigid transform of a stated pose; none stated is no motion."""
    if pose is None:
        return RigidTransform.identity()
    quaternion = geometry.unit(np.array([pose.orientation]))[0]
    return geometry.transforms(np.array(pose.position), quaternion)


def _mesh(entry: MeshShape, frame: Frame) -> Described:
    path = expanded(entry, "mesh")
    if not path.is_file():
        raise entry.error("mesh", f"no mesh file {entry.mesh!r} ({path}).", neighbours(path))
    vertices, faces = read_mesh(path)
    frame.sources.append(replace(source_of(path, "mesh"), path=entry.mesh))
    if edges := open_edges(vertices, faces):
        frame.notices.append(notice("mesh-not-closed", frame.owner, mesh=path.name, edges=edges))
    vertices = vertices * UNITS[entry.unit]
    if (entry.handedness or ("left" if frame.mirrored else "right")) == "left":
        vertices, faces = mirrored(vertices), faces[:, ::-1]
    size = float((vertices.max(axis=0) - vertices.min(axis=0)).max())
    if not 0.001 <= size <= LARGEST_M:
        raise entry.error(
            "mesh",
            f"in its unit the mesh is {size:.4g} m long.",
            'State its unit: unit = "mm" (or cm, dm, m, in, ft).',
        )
    return vertices, faces, path.name


def _marker_box(entry: MarkerBoxShape, frame: Frame) -> Described:
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
    vertices, faces, text = _box(size)
    return vertices + (low + high) / 2, faces, text


def _box(size: list[float]) -> Described:
    import trimesh

    box = trimesh.creation.box(extents=size)
    return np.array(box.vertices), np.array(box.faces), f"box {_text(size)} m"


def _text(size: list[float]) -> str:
    return " x ".join(f"{each:.3g}" for each in size)


def _cylinder(radius: float, height: float) -> Described:
    import trimesh

    mesh = trimesh.creation.cylinder(radius=radius, height=height, sections=32)
    text = f"cylinder of radius {radius:.3g} m, height {height:.3g} m"
    return np.array(mesh.vertices), np.array(mesh.faces), text


def _capsule(radius: float, height: float) -> Described:
    half = np.array([0.0, 0.0, height / 2])
    text = f"capsule of radius {radius:.3g} m, height {height:.3g} m"
    return *_capsule_between(-half, half, radius), text


def _capsules(entry: CapsulesShape, frame: Frame) -> Described:
    """Capsules between pairs of points; the body itself is ``""``."""
    pairs = entry.capsules
    if isinstance(pairs, str):
        if pairs not in frame.bones:
            raise entry.error(
                "capsules",
                f"capsules = {pairs!r} needs a body with a skeleton.",
                'Give pairs of names: [["WRIST", "INDEX"]].',
            )
        pairs = [[*bone] for bone in frame.bones[pairs]] or [["", ""]]
        for first, second in pairs:
            low, high = frame.lengths(first, second) if frame.lengths else (0.0, 0.0)
            if high - low > STRETCH_M:
                bone, found = (first or frame.joint, second), {"shortest_m": low, "longest_m": high}
                frame.notices.append(notice("bone-stretches", frame.owner, *bone, **found))
    points = {"": np.zeros(3)}
    for name in sorted({name for pair in pairs for name in pair} - {""}):
        points[name] = _point(entry, "capsules", frame, name)
    meshes = [_capsule_between(points[a], points[b], entry.radius_m) for a, b in pairs]
    what = "a capsule" if len(pairs) == 1 else f"{len(pairs)} capsules"
    ((one, other), *more) = pairs
    far = float(np.linalg.norm(points[one] - points[other]))
    long = f" and length {far + 2.0 * entry.radius_m:.2g} m" * (not more and far > 0.0)
    return *_joined(meshes), f"{what} of radius {entry.radius_m:.3g} m{long}"


def _point(entry: Pose, key: str, frame: Frame, name: str) -> Float[np.ndarray, "3"]:
    if name not in frame.names:
        raise entry.unknown("point", name, frame.names, key)
    return frame.place(name)


def _parts(entry: PartsShape, frame: Frame) -> Described:
    parts = [_placed(part, frame) for part in entry.parts]
    meshes = [(vertices, faces) for vertices, faces, _ in parts]
    return *_joined(meshes), " + ".join(text for _, _, text in parts)


def mirrored(points: Float[np.ndarray, "points 3"]) -> Float[np.ndarray, "points 3"]:
    """Points with x negated."""
    return np.asarray(points * np.array([-1.0, 1.0, 1.0]))


def _joined(meshes: list[Mesh]) -> Mesh:
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


def _sphere(radius: float) -> Described:
    zero = np.zeros(3)
    return *_capsule_between(zero, zero, radius), f"sphere of radius {radius:.3g} m"


_MAKERS: dict[str, Callable[[Any, Frame], Described]] = {
    "MeshShape": _mesh,
    "BoxShape": lambda entry, _: _box(entry.box),
    "MarkerBoxShape": _marker_box,
    "CylinderShape": lambda entry, _: _cylinder(*entry.cylinder),
    "SphereShape": lambda entry, _: _sphere(entry.sphere),
    "CapsuleShape": lambda entry, _: _capsule(*entry.capsule),
    "CapsulesShape": _capsules,
    "PartsShape": _parts,
}
"""What builds each kind of shape of the schema."""


NEAR_S = 0.1  # An object must be seen this near the stated time [s].
WorldPose = tuple[Float[np.ndarray, "3"], Float[np.ndarray, "4"]]


def under_object(
    entry: ObjectEntry, shape: Shape | None, others: Sequence[TagObject]
) -> tuple[WorldPose, str]:
    """The pose of a support whose surface is where an object's lowest corner is at a time.

    A pattern in ``top_at_bottom_of`` stands for every mobile object that has a shape, or for all
    if none has: the surface is then at the median or the lowest of their lowest corners. What has
    no shape is a point, its origin. Without a ``position`` the support
    is under the middle of the objects.

    Returns:
        The pose, and how it was derived.

    Raises:
        CaparError: No such object, the support has no shape, or the object is not seen then.
    """
    resting = _resting(entry, others)
    if shape is None:
        raise entry.error("top_at_bottom_of", "the support needs a shape.")
    found = [_corners(entry, thing) for thing in resting]
    bottoms = np.array([float(corners[:, 2].min()) for corners, _ in found])
    top = float(bottoms.min() if entry.of == "lowest" else np.median(bottoms))
    corners = np.concatenate([corners for corners, _ in found])
    x, y = ((corners.min(axis=0) + corners.max(axis=0)) / 2)[:2]
    if entry.position is not None:
        if len(entry.position) != 2:
            raise entry.error(
                "position",
                f"position = {entry.position} has a height, which top_at_bottom_of gives.",
                "Give x and y only.",
            )
        x, y = entry.position
    turn = Rotation.from_euler("z", entry.turn_deg, degrees=True)
    highest = float(turn.apply(np.array(shape.vertices))[:, 2].max())
    height = top - (highest if entry.surface_m is None else entry.surface_m)
    which = f"the lowest point of {resting[0].name}"
    if len(resting) > 1:
        of = {"lowest": "lowest point of the lowest", "median": "median of the lowest points"}
        which = f"the {of[entry.of]} of {len(resting)} objects"
    text = f"top at {top:.3f} m, {which} at rest at {found[0][1]:.2f} s"
    return (np.array([x, y, height]), geometry.quaternions(turn)), text


def _corners(entry: ObjectEntry, thing: TagObject) -> tuple[Float[np.ndarray, "corners 3"], float]:
    """An object's corners in the world at the stated time [m], and the time it is seen at [s]."""
    times, known = thing.stream.times, np.flatnonzero(~thing.stream.lost)
    if entry.at_s is None:
        raise entry.error("top_at_bottom_of", f"'at_s' is missing: when {thing.name} rests there.")
    if not known.size:
        raise entry.error("at_s", f"{thing.name} is never seen.")
    at_s = entry.at_s + (float(times[-1]) if entry.at_s < 0.0 else 0.0)
    frame = int(known[np.argmin(np.abs(times[known] - at_s))])
    seen_s = float(times[frame])
    if abs(seen_s - at_s) > NEAR_S:
        raise entry.error(
            "at_s", f"{thing.name} is not seen near {at_s:g} s, but at {seen_s:.2f} s."
        )
    corners = np.zeros((1, 3)) if thing.shape is None else np.array(thing.shape.vertices)
    return thing.stream.pose(frame).apply(corners), seen_s


def _resting(entry: ObjectEntry, others: Sequence[TagObject]) -> list[TagObject]:
    """The object or, by a pattern, the mobile objects that rest on the support."""
    pattern, names = entry.top_at_bottom_of or "", [each.name for each in others]
    if pattern in names:
        return [others[names.index(pattern)]]
    if "*" not in pattern:
        raise entry.unknown("object", pattern, names, "top_at_bottom_of")
    mobile = (each for each in others if each.tag is TagType.MOBILE)
    fitting = [each for each in mobile if fnmatchcase(each.name, pattern)]
    if not fitting:
        raise entry.error("top_at_bottom_of", f"no mobile object fits {pattern!r}.")
    return [each for each in fitting if each.shape] or fitting
