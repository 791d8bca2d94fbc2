"""The meshes of the scenes, in metres, each in the frame of its body."""

from functools import cache

import numpy as np
import trimesh

from capar.model.capture import Shape

MUG_RADIUS = 0.040
MUG_HEIGHT = 0.120
HANDLE_HEIGHT = 0.070
HANDLE_REACH = MUG_RADIUS + 0.036
"""From the mug's axis to the outermost of its handle, which points along -y [m]."""

HAND = (0.18, 0.085, 0.03)
"""Length, width and thickness of the hand of a person of 1.75 m [m]."""

HEAD = (0.098, 0.076, 0.120)
"""Half axes of a head [m]."""

MOUTH = (0.0, 0.0, -0.055)
"""Height of the mouth in the head's frame [m]; it lies on the surface in front."""


@cache
def mug() -> Shape:
    """A mug with a cavity and a handle that a finger fits through; its origin under its middle."""
    outer = trimesh.creation.cylinder(
        radius=MUG_RADIUS, sections=48, segment=np.array([[0, 0, 0], [0, 0, MUG_HEIGHT]])
    )
    handle = trimesh.creation.torus(0.030, 0.006, major_sections=40, minor_sections=12)
    handle.apply_transform([[0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]])
    handle.apply_translation([0.0, -MUG_RADIUS, HANDLE_HEIGHT])
    cavity = trimesh.creation.cylinder(
        radius=MUG_RADIUS - 0.004, sections=48, segment=np.array([[0, 0, 0.006], [0, 0, 0.2]])
    )
    return shape(trimesh.boolean.difference([outer.union(handle), cavity]), "mug with handle")


@cache
def box(length: float, width: float, height: float) -> Shape:
    """A box whose origin lies in the middle of its bottom."""
    mesh = trimesh.creation.box(extents=(length, width, height))
    mesh.apply_translation([0.0, 0.0, height / 2.0])
    return shape(mesh, f"box {length:g} x {width:g} x {height:g} m")


@cache
def ball(radius: float) -> Shape:
    """A ball, its origin in its middle."""
    return shape(trimesh.creation.icosphere(subdivisions=3, radius=radius), "ball")


@cache
def bowl(radius: float, height: float) -> Shape:
    """An open bowl with upright walls; its origin under its middle."""
    outer = trimesh.creation.cylinder(
        radius=radius, sections=48, segment=np.array([[0, 0, 0], [0, 0, height]])
    )
    cavity = trimesh.creation.cylinder(
        radius=radius - 0.005, sections=48, segment=np.array([[0, 0, 0.006], [0, 0, 0.5]])
    )
    return shape(trimesh.boolean.difference([outer, cavity]), "bowl")


@cache
def table(length: float, width: float) -> Shape:
    """A table's top of 4 cm, whose origin lies in the middle of its upper face."""
    mesh = trimesh.creation.box(extents=(length, width, 0.04))
    mesh.apply_translation([0.0, 0.0, -0.02])
    return shape(mesh, f"table top {length:g} x {width:g} x 0.04 m")


@cache
def drum() -> Shape:
    """A drum whose origin lies in the middle of its skin."""
    mesh = trimesh.creation.cylinder(
        radius=0.18, sections=48, segment=np.array([[0, 0, -0.25], [0, 0, 0]])
    )
    return shape(mesh, "drum of radius 0.18 m")


@cache
def roller(radius: float, length: float) -> Shape:
    """A can that lies along y, its origin in its middle."""
    half = length / 2.0
    mesh = trimesh.creation.cylinder(
        radius=radius, sections=96, segment=np.array([[0, -half, 0], [0, half, 0]])
    )
    return shape(mesh, f"can of radius {radius:g} m, lying")


@cache
def hand(scale: float) -> Shape:
    """A flat hand: fingers along x, its back along z, its sensor in the middle of its back."""
    mesh = trimesh.creation.box(extents=np.array(HAND) * scale)
    mesh.apply_translation([0.0, 0.0, -HAND[2] * scale / 2.0])
    for _ in range(3):
        mesh = mesh.subdivide()
    return shape(mesh, f"hand of length {HAND[0] * scale:.3f} m")


@cache
def head() -> Shape:
    """A head as an ellipsoid, its face along x."""
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=1.0)
    mesh.apply_scale(HEAD)
    return shape(mesh, "head")


def shape(mesh: trimesh.Trimesh, description: str) -> Shape:
    """The mesh as a capture's shape."""
    return Shape(np.asarray(mesh.vertices, dtype=float), mesh.faces, description=description)


def surface(shape: Shape) -> trimesh.Trimesh:
    """The capture's shape as a mesh."""
    return trimesh.Trimesh(shape.vertices, shape.faces, process=False)


def mouth() -> np.ndarray:
    """The place of the mouth in the head's frame [m]."""
    front = HEAD[0] * np.sqrt(1.0 - (MOUTH[2] / HEAD[2]) ** 2)
    return np.array([front, 0.0, MOUTH[2]])
