"""Shapes as capture.toml states them: mesh files, primitives, capsules over joints, and parts."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model import geometry
from capar.model.capture import Shape, ShapeSource, Source
from capar.model.errors import UnknownNameError
from extractors.readers.bundle.mesh import read_mesh
from extractors.readers.bundle.toml_table import Table, expanded
from extractors.readers.bundle.world import mirrored
from extractors.readers.files import source_of
from extractors.readers.formats.trc import UNITS

FORMS = ("mesh", "box", "cylinder", "sphere", "capsule", "capsules", "parts")
HANDS = {"right": False, "left": True}

Mesh = tuple[np.ndarray, np.ndarray]
"""Corners [m] and faces."""


@dataclass
class Frame:
    """What a shape may refer to in its body: points of the body's frame, and a skeleton."""

    points: Mapping[str, Float[np.ndarray, "3"]] = field(default_factory=dict)
    """Markers and other bodies, by name, in the body's frame [m]."""

    markers: tuple[str, ...] = ()
    """The names of the body's own markers."""

    bones: Mapping[str, tuple[tuple[str, str], ...]] = field(default_factory=dict)
    """``children`` and ``descendants``: pairs of joints, the body itself being ``""``."""

    mirrored: bool = False
    """Whether the body's file is left-handed."""

    sources: list[Source] = field(default_factory=list)
    """Mesh files that were read, for the capture's provenance."""


def read_shape(table: Table, frame: Frame) -> Shape:
    """The shape that a table states.

    Raises:
        CaparError: The table states none, or several, or a mesh cannot be read.
    """
    vertices, faces, description = _placed(table, frame)
    stand_in = "mesh" not in table and not any("mesh" in each for each in table.tables("parts"))
    source = ShapeSource.STAND_IN if stand_in else ShapeSource.MESH
    return Shape(vertices=vertices, faces=faces, source=source, description=description)


def assumed(shape: Shape) -> Shape:
    """The same shape, marked as assumed."""
    return replace(shape, source=ShapeSource.ASSUMED)


def _placed(table: Table, frame: Frame) -> tuple[np.ndarray, np.ndarray, str]:
    """A shape's corners in the body's frame, after its own pose."""
    form = _form(table)
    vertices, faces, description = _MAKERS[form](table, frame)
    pose = read_pose(table)
    table.close()
    return pose.apply(vertices), faces, description


def _form(table: Table) -> str:
    given = [each for each in table.given() if each in FORMS]
    if len(given) != 1:
        raise table.error("", f"a shape states one of {', '.join(FORMS)}, not {given or 'none'}.")
    return given[0]


def read_pose(table: Table) -> RigidTransform:
    """``position`` [m] and ``orientation`` (w x y z) of a table; nothing given is no move."""
    position = table.vector("position", 3, (0.0, 0.0, 0.0))
    quaternion = np.array([table.vector("orientation", 4, (1.0, 0.0, 0.0, 0.0))])
    if abs(float(np.linalg.norm(quaternion)) - 1.0) > geometry.UNIT_TOLERANCE:
        raise table.error(
            "orientation",
            f"a quaternion of norm {np.linalg.norm(quaternion):.4g}.",
            "It is a unit quaternion w x y z.",
        )
    return geometry.transforms(np.array(position), geometry.unit(quaternion)[0])


def _mesh(table: Table, frame: Frame) -> tuple[np.ndarray, np.ndarray, str]:
    text = table.text("mesh")
    path = expanded(table, "mesh", text)
    if not path.is_file():
        raise table.error("mesh", f"no mesh file {text!r} ({path}).", _others(path))
    vertices, faces = read_mesh(path)
    frame.sources.append(replace(source_of(path, "mesh"), path=text))
    vertices = vertices * UNITS[table.choice("unit", UNITS, "m")]
    left = HANDS[table.choice("handedness", HANDS, "left" if frame.mirrored else "right")]
    if left:
        vertices, faces = mirrored(vertices), faces[:, ::-1]
    _check_size(table, vertices)
    return vertices, faces, path.name


def _others(path: Any) -> str:
    if not path.parent.is_dir():
        return f"There is no folder {path.parent}."
    return (
        f"The folder holds: {', '.join(sorted(each.name for each in path.parent.iterdir())[:12])}"
    )


def _check_size(table: Table, vertices: np.ndarray) -> None:
    size = float((vertices.max(axis=0) - vertices.min(axis=0)).max())
    if not 0.001 <= size <= 20.0:
        raise table.error(
            "mesh",
            f"in its unit the mesh is {size:.4g} m long.",
            'State its unit: unit = "mm" (or cm, dm, m, in, ft).',
        )


def _sizes(table: Table, key: str, values: list[float]) -> list[float]:
    if not all(0.0 < each <= 20.0 for each in values):
        raise table.error(key, f"{key} of {values} m; sizes lie between 0 and 20 m.")
    return values


def _box(table: Table, frame: Frame) -> tuple[np.ndarray, np.ndarray, str]:
    import trimesh

    if table.raw("box") == "markers":
        return _box_around(table, frame)
    size = _sizes(table, "box", table.vector("box", 3))
    box = trimesh.creation.box(extents=size)
    return np.array(box.vertices), np.array(box.faces), f"box {_text(size)} m"


def _box_around(table: Table, frame: Frame) -> tuple[np.ndarray, np.ndarray, str]:
    import trimesh

    names = table.texts("around") or list(frame.markers)
    if len(names) < 2:
        raise table.error("box", 'box = "markers" needs markers: a body\'s own, or around = [..].')
    points = np.stack([_point(table, "around", frame, each) for each in names])
    margin = table.number("margin_m", 0.0)
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    size = _sizes(table, "box", [float(each) for each in np.maximum(high - low, 0.001)])
    box = trimesh.creation.box(extents=size)
    return np.array(box.vertices) + (low + high) / 2, np.array(box.faces), f"box {_text(size)} m"


def _cylinder(table: Table, frame: Frame) -> tuple[np.ndarray, np.ndarray, str]:
    import trimesh

    radius, height = _sizes(table, "cylinder", table.vector("cylinder", 2))
    mesh = trimesh.creation.cylinder(radius=radius, height=height, sections=32)
    text = f"cylinder of radius {radius:.3g} m, height {height:.3g} m"
    return np.array(mesh.vertices), np.array(mesh.faces), text


def _sphere(table: Table, frame: Frame) -> tuple[np.ndarray, np.ndarray, str]:
    (radius,) = _sizes(table, "sphere", [table.number("sphere")])
    zero = np.zeros(3)
    return *_capsule_between(zero, zero, radius), f"sphere of radius {radius:.3g} m"


def _capsule(table: Table, frame: Frame) -> tuple[np.ndarray, np.ndarray, str]:
    radius, height = _sizes(table, "capsule", table.vector("capsule", 2))
    half = np.array([0.0, 0.0, height / 2])
    text = f"capsule of radius {radius:.3g} m, height {height:.3g} m"
    return *_capsule_between(-half, half, radius), text


def _capsules(table: Table, frame: Frame) -> tuple[np.ndarray, np.ndarray, str]:
    (radius,) = _sizes(table, "radius_m", [table.number("radius_m")])
    wanted = table.raw("capsules")
    if isinstance(wanted, str):
        if wanted not in frame.bones:
            known = frame.bones or {"children": (), "descendants": ()}
            raise UnknownNameError("bones", wanted, known, where=table.where("capsules"))
        pairs = list(frame.bones[wanted]) or [("", "")]
    else:
        pairs = [_pair(table, each) for each in wanted]
    points = {"": np.zeros(3)}
    for name in {name for pair in pairs for name in pair} - {""}:
        points[name] = _point(table, "capsules", frame, name)
    meshes = [_capsule_between(points[a], points[b], radius) for a, b in pairs]
    return *joined(meshes), f"{len(pairs)} capsules of radius {radius:.3g} m"


def _pair(table: Table, value: Any) -> tuple[str, str]:
    if not (isinstance(value, list) and len(value) == 2 and all(map(_is_text, value))):
        raise table.error("capsules", f"{value!r} is no pair of names.", 'Like ["WRIST", "INDEX"].')
    return (value[0], value[1])


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _point(table: Table, key: str, frame: Frame, name: str) -> Float[np.ndarray, "3"]:
    if name not in frame.points:
        raise UnknownNameError("point", name, frame.points, where=table.where(key))
    return frame.points[name]


def _parts(table: Table, frame: Frame) -> tuple[np.ndarray, np.ndarray, str]:
    parts = [_placed(each, frame) for each in table.tables("parts")]
    if not parts:
        raise table.error("parts", "parts is a list of shapes, and it is empty.")
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


_MAKERS = {
    "mesh": _mesh,
    "box": _box,
    "cylinder": _cylinder,
    "sphere": _sphere,
    "capsule": _capsule,
    "capsules": _capsules,
    "parts": _parts,
}
