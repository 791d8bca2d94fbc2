"""Mesh files as triangles, after a look at what they would expand to or refer to."""

import io
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from capar.model.errors import CaparError, FileError
from extractors.readers.files import check_file, check_zip

MESH_LIMIT = 256 << 20
"""Bytes that a mesh file may hold or expand to [B]."""

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
    _check_size(path)
    try:
        vertices, faces = _load(path, suffix)
    except CaparError:
        raise
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


def open_edges(vertices: Float[np.ndarray, "vertices 3"], faces: Int[np.ndarray, "faces 3"]) -> int:
    """How many edges bound one triangle only; a closed surface has none.

    Vertices at the same place count as one, as files with textures repeat them.
    """
    _, which = np.unique(vertices, axis=0, return_inverse=True)
    corners = which.reshape(-1)[faces]
    corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
    edges = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2))
    _, counts = np.unique(edges, axis=0, return_counts=True)
    return int((counts == 1).sum())


def _load(
    path: Path, suffix: str
) -> tuple[Float[np.ndarray, "vertices 3"], Int[np.ndarray, "faces 3"]]:
    import trimesh

    # from memory, so that nothing the file refers to is opened
    mesh: Any = trimesh.load(
        io.BytesIO(path.read_bytes()), file_type=suffix, force="mesh", skip_materials=True
    )
    faces = np.asarray(mesh.faces, dtype=np.int64)
    return np.asarray(mesh.vertices, dtype=float), faces.reshape(-1, 3)


def _check_size(path: Path) -> None:
    if path.stat().st_size > MESH_LIMIT:
        raise FileError(path, f"is a mesh of more than {MESH_LIMIT >> 20} MiB.", "Decimate it.")
    with path.open("rb") as file:
        zipped = file.read(4) == b"PK\x03\x04"
    if zipped:
        names = check_zip(path, MESH_LIMIT)
        with zipfile.ZipFile(path) as archive:
            for name in names:
                if name.lower().endswith(_XML):
                    with archive.open(name) as member:
                        _check_xml(path, member.read(MESH_LIMIT))
    elif path.suffix.lower() in _XML:
        _check_xml(path, path.read_bytes())


def _check_xml(path: Path, data: bytes) -> None:
    """XML may define no entities: a few lines of them expand without end."""
    text = data.replace(b"\0", b"")  # so that UTF-16 hides nothing
    if b"<!ENTITY" in text or b"<!DOCTYPE" in text:
        raise FileError(
            path,
            "is XML with a DOCTYPE or entities, which are never expanded.",
            "Export it again, without them.",
        )
