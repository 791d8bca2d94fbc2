"""The table of formats: a file's content selects its reader."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from capar.model.errors import CaparError, CaptureError, FileError, UnknownNameError
from extractors.readers.file_access import HEAD, read_bytes
from extractors.readers.formats import (
    bvh,
    c3d,
    csv_table,
    json_trajectory,
    motive,
    npz,
    qualisys,
    rosbag,
    trc,
    vicon,
)
from extractors.readers.recording import Recording

Options = Mapping[str, Any]


@dataclass(frozen=True)
class Reader:
    """One format: how it is known and how it is read."""

    format: str
    description: str
    recognises: Callable[[Path, bytes], bool]
    read: Callable[[Path, Options], Recording]
    options: frozenset[str] = frozenset()
    """What a capture.toml may say about a file of the format."""


READERS = (
    Reader("c3d", "C3D: markers and ROTATION data", c3d.recognises, c3d.read),
    Reader("bvh", "BVH: every joint of a skeleton", bvh.recognises, bvh.read),
    Reader("rosbag", "ROS 1 and 2 bags: poses, tf, rigid bodies", rosbag.recognises, rosbag.read),
    Reader("qualisys", "Qualisys TSV: markers or 6D", qualisys.recognises, qualisys.read),
    Reader("trc", "TRC: markers", trc.recognises, trc.read),
    Reader("motive", "Motive CSV: bodies, bones, markers", motive.recognises, motive.read),
    Reader(
        "vicon",
        "Vicon CSV: trajectories, segments, objects",
        vicon.recognises,
        vicon.read,
        vicon.OPTIONS,
    ),
    Reader("npz", "NPZ: arrays that capture.toml maps", npz.recognises, npz.read, npz.OPTIONS),
    Reader(
        "json",
        "JSON trajectories, alone or in a tar archive",
        json_trajectory.recognises,
        json_trajectory.read,
        json_trajectory.OPTIONS,
    ),
    Reader(
        "csv",
        "CSV: <body>_x,_y,_z,_qx,_qy,_qz,_qw[,_valid] and a column of time",
        csv_table.recognises,
        csv_table.read,
        csv_table.OPTIONS,
    ),
)
"""Every format, the surest sign first; text files may be compressed with gzip or xz."""


READER_OPTIONS = frozenset().union(*(reader.options for reader in READERS))
"""What a capture.toml may say about a file of some format."""


def reader_for(path: Path) -> Reader:
    """The reader of a file.

    Raises:
        FileError: The file is not there, is empty, or is of no known format.
    """
    head = b"" if path.is_dir() else read_bytes(path, HEAD)
    for reader in READERS:
        if reader.recognises(path, head):
            return reader
    kind = "is a folder and no ROS 2 bag." if path.is_dir() else "is of no format known here."
    known = "; ".join(each.description for each in READERS)
    raise FileError(path, kind, f"These are read: {known}.")


def read_recording(path: Path | str, *, options: Options | None = None) -> Recording:
    """One file's bodies and markers.

    Args:
        path: The file, or the folder of a ROS 2 bag.
        options: What a capture.toml says about the file: columns, arrays, members.

    Raises:
        CaparError: The file is missing, damaged, of no known format, or contradicts itself.
    """
    path = Path(path)
    reader = reader_for(path)
    given = dict(options or {})
    for name in sorted(given):
        if name not in reader.options:
            raise UnknownNameError(f"{reader.format} option", name, reader.options, where=str(path))
    try:
        return reader.read(path, given)
    except CaptureError as error:
        raise CaptureError(f"{path}: {error}") from error
    except CaparError:
        raise
    except MemoryError as error:
        raise FileError(
            path, f"a damaged {reader.format} file asks for too much memory."
        ) from error
    except Exception as error:  # damaged bytes make parsers raise anything
        detail = f"{type(error).__name__}: {str(error)[:200]}"
        raise FileError(
            path, f"is a damaged {reader.format} file ({detail}).", "Copy or export it again."
        ) from error
