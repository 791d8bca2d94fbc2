"""The table of formats: a file's content selects its reader."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from capar.model.errors import CaparError, CaptureError, FileError, UnknownNameError
from extractors.readers.file_access import HEAD, read_bytes
from extractors.readers.formats import (
    bvh,
    c3d,
    csv_table,
    demonstrations,
    json_trajectory,
    lerobot,
    motive,
    npz,
    qualisys,
    rosbag,
    trc,
    vicon,
)
from extractors.readers.recording import Recording

Options = Mapping[str, Any]
Read = TypeVar("Read")


@dataclass(frozen=True)
class Reader:
    """One format: how it is known and how it is read."""

    format: str
    description: str
    recognises: Callable[[Path, bytes], bool]
    read: Callable[[Path, Options], Recording]
    options: frozenset[str] = frozenset()
    """What a capture.toml may say about a file of the format."""

    draft: Callable[[Path, str, str], str] | None = None
    """The capture.toml of a file that itself says what is what: of its path, how the path is to be
    stated, and the trial in it that is described."""

    trials: Callable[[Path], list[str]] | None = None
    """The names of a data set's trials; each is a take where a capture.toml states neither."""


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
    Reader(
        "hdf5",
        "HDF5 demonstrations of robomimic and robosuite",
        demonstrations.recognises,
        demonstrations.read,
        demonstrations.OPTIONS,
        demonstrations.draft,
    ),
    Reader(
        "lerobot",
        "LeRobot data sets of version 3: features that capture.toml maps",
        lerobot.recognises,
        lerobot.read,
        lerobot.OPTIONS,
        trials=lerobot.episodes,
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
    kind = (
        "is a folder, and neither a ROS 2 bag nor a LeRobot data set."
        if path.is_dir()
        else "is of no format known here."
    )
    known = "; ".join(each.description for each in READERS)
    raise FileError(path, kind, f"These are read: {known}.")


def read_recording(path: Path | str, *, options: Options | None = None) -> Recording:
    """One file's bodies and markers.

    Args:
        path: The file, or the folder of a ROS 2 bag or a LeRobot data set.
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
    return _undamaged(path, reader, lambda: reader.read(path, given))


def says_itself(path: Path) -> bool:
    """Whether a file itself says what in it is what, and amounts to a capture.toml."""
    return _drafting(path) is not None


def _drafting(path: Path) -> Reader | None:
    head = read_bytes(path, HEAD) if path.is_file() else b""
    return next((each for each in READERS if each.draft and each.recognises(path, head)), None)


def own_bundle(path: Path, shown: str, trial: str = "") -> str:
    """The capture.toml that a file itself amounts to; empty where a person has to write it.

    Args:
        path: The file.
        shown: Its path as the text states it.
        trial: The trial that is described; of several none is, if it is not given.

    Raises:
        CaparError: The file is damaged, or has no such trial.
    """
    reader = _drafting(path)
    if reader is None or (draft := reader.draft) is None:
        return ""
    return _undamaged(path, reader, lambda: draft(path, shown, trial))


def trials(path: Path) -> list[str]:
    """The trials of a data set by name; none of anything else.

    Raises:
        CaparError: The data set is damaged, or of another version.
    """
    for reader in READERS if path.is_dir() else ():
        if (names := reader.trials) and reader.recognises(path, b""):
            return _undamaged(path, reader, lambda: names(path))
    return []


def _undamaged(path: Path, reader: Reader, read: Callable[[], Read]) -> Read:
    """What a reader reads; whatever a damaged file makes it raise becomes an error of ours."""
    try:
        return read()
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
