"""JSON trajectories: time stamps with a rotation matrix and a translation, alone or in a tar."""

import io
import json
import tarfile
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from capar.model.capture import Stream
from capar.model.errors import FileError
from extractors.readers.file_access import EXPANDED_LIMIT, read_bytes, source_of
from extractors.readers.recording import Recording, track_of_matrices

OPTIONS = frozenset({"folder", "time_unit_s"})
"""``folder``: the folder inside an archive; ``time_unit_s``: seconds per time stamp (0.001)."""

SUFFIX = "_trajectory"


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file is a tar archive, or JSON with time stamps."""
    text = head.lstrip()
    return head[257:262] == b"ustar" or (text[:1] in {b"[", b"{"} and b"timeStamp" in text)


def read(path: Path, options: Mapping[str, Any]) -> Recording:
    """The bodies of one trajectory file or of every ``*_trajectory.json`` in a folder.

    Raises:
        FileError: No trajectory is in it, or one is not as it should be.
    """
    data = read_bytes(path)
    scale = float(options.get("time_unit_s", 0.001))
    if data[257:262] == b"ustar":
        files = _members(path, data, options.get("folder"))
    else:
        files = {path.name.split(".")[0].removesuffix(SUFFIX): data}
    bodies = {name: _body(path, name, each, scale) for name, each in sorted(files.items())}
    return Recording(source=source_of(path, "json"), bodies=bodies)


def _members(path: Path, data: bytes, folder: object) -> dict[str, bytes]:
    found: dict[str, bytes] = {}
    folders: set[str] = set()
    with tarfile.open(fileobj=io.BytesIO(data), mode="r:") as archive:
        for member in archive:
            name = PurePosixPath(member.name)
            if not member.isfile() or not name.name.endswith(f"{SUFFIX}.json"):
                continue
            folders.add(str(name.parent))
            if str(name.parent) == str(folder):
                file = archive.extractfile(member)
                found[name.stem.removesuffix(SUFFIX)] = file.read(EXPANDED_LIMIT) if file else b""
    if not found:
        names = ", ".join(sorted(folders)[:20]) or "none"
        raise FileError(
            path,
            f"no trajectory in folder {str(folder)!r} of the archive; folders: {names}.",
            'Name one in capture.toml: folder = "...".',
        )
    return found


def _body(path: Path, name: str, data: bytes, scale: float) -> Stream:
    try:
        samples = json.loads(data)
        times = np.array([each["timeStamp"] for each in samples], dtype=float) * scale
        matrices = np.array([each["rotation"] for each in samples], dtype=float)
        places = np.array([each["translation"] for each in samples], dtype=float)
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise FileError(
            path,
            f"trajectory {name!r} is not as it should be ({type(error).__name__}: {error}).",
            "It is a list of {timeStamp, rotation: 3x3, translation: 3}.",
        ) from error
    frames = len(times)
    if matrices.shape != (frames, 3, 3) or places.shape != (frames, 3):
        raise FileError(path, f"trajectory {name!r}: rotations {matrices.shape}, {places.shape}.")
    return track_of_matrices(name, times, places, matrices, np.zeros(frames, bool))
