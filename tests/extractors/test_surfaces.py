"""Surfaces and plain files of meshes are what trimesh makes of them, which takes long to import."""

import io
from collections.abc import Callable

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from capar.model.capture import Shape, ShapeSource
from extractors.bodies.bodies import AROUND
from extractors.contact.surfaces import Surface
from extractors.readers.bundle.shapes import read_mesh

MADE: dict[str, Callable[[], trimesh.Trimesh]] = {
    "box": lambda: trimesh.creation.box(extents=(0.1, 0.2, 0.4)),
    "ball": lambda: trimesh.creation.icosphere(2, 0.05),
    "ring": lambda: trimesh.creation.annulus(0.02, 0.05, 0.03),
    "two": lambda: trimesh.creation.box() + trimesh.creation.box().apply_translation((3, 0, 0)),
}


def pair(mesh: trimesh.Trimesh) -> tuple[Surface, trimesh.Trimesh]:
    """A surface of triangles with corners of their own, and what trimesh makes of them."""
    corners = np.array(mesh.triangles).reshape(-1, 3)
    faces = np.arange(len(corners)).reshape(-1, 3)
    surface = Surface(Shape(corners, faces, ShapeSource.STAND_IN, "made"))
    whole = trimesh.Trimesh(corners, faces, process=False)
    whole.merge_vertices()
    return surface, whole


@pytest.mark.parametrize("name", MADE)
@given(st.integers(0, 10_000), st.booleans(), st.integers(0, 2))
def test_corners_sides_and_rays_are_those_of_trimesh(
    name: str, seed: int, turned: bool, missing: int
) -> None:
    mesh = MADE[name]()
    if turned:
        mesh.invert()
    mesh.update_faces(np.arange(len(mesh.faces)) >= missing)
    ours, theirs = pair(mesh)
    assert np.array_equal(ours.mesh[0], theirs.vertices)
    assert np.array_equal(ours.mesh[1], theirs.faces)
    assert np.array_equal(ours.normals, theirs.face_normals)
    assert ours.closed == (theirs.is_watertight and theirs.is_winding_consistent) == (not missing)
    assert ours.inverted == (turned and not missing)
    random = np.random.default_rng(seed)
    origins = theirs.bounds.mean(axis=0) + random.uniform(-1.0, 1.0, (40, 3)) * theirs.extents
    directions = random.normal(size=(40, 3))
    for first in (True, False):
        places, rays = ours.hits(origins, directions, first=first)
        there, which, _ = theirs.ray.intersects_location(
            origins, directions, multiple_hits=not first
        )
        assert np.array_equal(rays, which)
        assert np.array_equal(places, there)
    if not missing:
        assert np.array_equal(ours.contains(origins), theirs.contains(origins))


def test_a_surface_whose_sides_face_either_way_bounds_no_solid() -> None:
    mesh = trimesh.creation.box()
    mesh.faces[0] = mesh.faces[0][::-1]
    ours, theirs = pair(mesh)
    assert theirs.is_watertight
    assert not ours.closed


OBJ = "# a corner is there twice, and one is of no triangle\n" + "".join(
    f"v {each}\n" for each in ("0 0 0", "1e-1 0 0", "0 .1 0", "0 0 0.1", "0 0 0", "9 9 9")
)


@pytest.mark.parametrize(
    "rest",
    [
        "f 1 2 3\nf 5 4 2\n",
        "o half\nf 1 2 3\no other\nf 5 4 2\n",
        "f 1 2 3 4\n",
        "f -6 -5 -4\n",
        "vn 0 0 1\nf 1//1 2//1 3//1\n",
    ],
)
def test_a_file_of_corners_and_triangles_is_read_as_trimesh_reads_it(
    rest: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    file = tmp_path_factory.mktemp("meshes") / "made.obj"
    file.write_text(OBJ + rest)
    vertices, faces = read_mesh(file)
    there = trimesh.load(io.BytesIO(file.read_bytes()), file_type="obj", force="mesh")
    assert np.array_equal(vertices, there.vertices)
    assert np.array_equal(faces, there.faces)


def test_directions_all_around_are_the_corners_of_a_divided_icosahedron() -> None:
    ball = trimesh.creation.icosphere(subdivisions=2)
    assert {*map(tuple, AROUND)} == {*map(tuple, np.asarray(ball.vertices))}
