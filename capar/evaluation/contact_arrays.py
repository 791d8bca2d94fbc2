"""Labels of contact that a recording holds as an array: a value for each frame and body."""

import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar.evaluation.labels import Label, Labels
from capar.evaluation.plan_schema import ContactArrays
from capar.model.errors import FileError, UnknownNameError
from capar.model.geometry import runs
from extractors.readers.files import check_zip
from extractors.readers.schema.document import substituted
from extractors.readers.schema.names import constant_name


def read_contact_arrays(
    path: Path,
    entry: ContactArrays,
    words: Mapping[str, str],
    times: Float[np.ndarray, "frames"],
) -> tuple[Labels, tuple[tuple[str, str], ...]]:
    """Labels of contact from an NPZ file, and every pair of bodies that they are about.

    Bodies bear the names that ``[[sensors_from]]`` gives them: ``L_Hip`` is ``l_hip``.

    Args:
        path: The NPZ file.
        entry: Which arrays, and what their values mean.
        words: The take's words.
        times: Time of each frame of the recording [s].

    Raises:
        FileError: It is no NPZ file, or the array has not a value for each frame and body.
        UnknownNameError: It has no such array.
    """
    values, names = _arrays(path, entry)
    if values.shape != (len(times), len(names)):
        raise FileError(
            path,
            f"array {entry.labels!r} has the shape {values.shape}.",
            f"For {len(times)} frames and {len(names)} bodies it has "
            f"the shape {(len(times), len(names))}.",
        )
    other = str(substituted(entry.other, words))
    step = float(np.median(np.diff(times)))
    after = np.append(times[1:], times[-1] + step)
    marks = []
    for column, name in enumerate(names):
        for value, sure in ((entry.touching, True), (entry.open, False)):
            for first, last in runs(values[:, column] == value) if value is not None else ():
                marks.append(
                    Label(
                        name, float(times[first]), float(after[last]), "contact", other, sure=sure,
                        where=f"{path}: {entry.labels}[{first}:{last + 1}, {column}]",
                    )
                )  # fmt: skip
    labels = Labels(path, tuple(sorted(marks)), in_frames=False)
    return labels, tuple((name, other) for name in names)


def _arrays(path: Path, entry: ContactArrays) -> tuple[np.ndarray, list[str]]:
    check_zip(path)
    try:
        with np.load(path, allow_pickle=False) as content:
            for name in (entry.labels, entry.bodies):
                if name not in content:
                    raise UnknownNameError("array", name, content, where=str(path))
            return content[entry.labels], [constant_name(str(each)) for each in
                                           content[entry.bodies]]  # fmt: skip
    except (OSError, ValueError, zipfile.BadZipFile) as error:
        raise FileError(path, f"is no NPZ file: {error}.") from None
