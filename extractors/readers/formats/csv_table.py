"""CSV: poses and points in columns named after their bodies."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model.errors import FileError, UnknownNameError
from extractors.readers.file_access import number_of, read_rows, read_text, source_of
from extractors.readers.recording import Recording, check_rate, track, uniform_clock

OPTIONS = frozenset({"time", "columns", "order", "rate_hz", "delimiter"})
"""``time``: the column of seconds; ``columns``: body to its 3 or 7 columns; ``order``: of its
quaternions (``xyzw``); ``rate_hz``: where there is no column of time."""

TIMES = ("t_s", "time_s", "time", "t", "timestamp")
POSE = ("x", "y", "z", "qx", "qy", "qz", "qw")
ORDERS = {"xyzw": [3, 0, 1, 2], "wxyz": [0, 1, 2, 3]}
"""Where w x y z stand in quaternions of each order."""


def recognises(path: Path, head: bytes) -> bool:
    """Whether the first line names columns and the second, if there is one, holds numbers."""
    lines = [each for each in head.decode("utf-8-sig", "ignore").splitlines() if each.strip()]
    if not lines or "\0" in lines[0]:
        return False
    delimiter, names = _header(lines[0])
    if len(lines) == 1:
        return len(names) > 2 and bool(_groups(names) or {*TIMES} & {n.lower() for n in names})
    cells = [number_of(each) for each in lines[1].split(delimiter)]
    return (
        len(cells) > 2 and any(each is not None for each in cells) and number_of(names[0]) is None
    )


def read(path: Path, options: Mapping[str, Any]) -> Recording:
    """The bodies (seven columns) and markers (three) of a table.

    Raises:
        FileError: No column of time and no rate, no row, or a row is damaged.
        UnknownNameError: The options name a column that is not there.
    """
    lines = read_text(path).splitlines()
    start = next((n for n, each in enumerate(lines) if each.strip()), 0)
    delimiter, names = _header(lines[start], options.get("delimiter"))
    if len(set(names)) != len(names):
        raise FileError(path, "names a column twice.")
    if not any(each.strip() for each in lines[start + 1 :]):
        raise FileError(
            path, "holds no frames: a header, and no rows under it.", "Export it again."
        )
    rows = read_rows(
        lines[start + 1 :], path=path, first_line=start + 2, columns=len(names), delimiter=delimiter
    )
    table = dict(zip(names, rows.T, strict=True))
    times = _times(path, table, options)
    groups = options.get("columns") or _groups(names)
    order = str(options.get("order", "xyzw"))
    if order not in ORDERS:
        raise UnknownNameError("order of quaternions", order, ORDERS, where=str(path))
    bodies, markers = {}, {}
    for body, columns in groups.items():
        for column in columns:
            if column not in table:
                raise UnknownNameError("column", column, table, where=str(path))
        if len(columns) not in {3, 7}:
            raise FileError(path, f"{body!r} has {len(columns)} columns; a body has 7, a point 3.")
        values = np.stack([table[each] for each in columns], axis=1)
        if (valid := table.get(f"{body}_valid")) is not None:
            values = np.where((valid > 0.5)[:, None], values, np.nan)
        if len(columns) == 7:
            bodies[body] = track(body, times, values[:, :3], values[:, 3:][:, ORDERS[order]])
        else:
            markers[body] = values
    if not bodies and not markers:
        raise FileError(
            path,
            f"no columns like <body>_x,_y,_z,_qx,_qy,_qz,_qw among {sorted(table)[:12]}.",
            "Name them in capture.toml: columns = { hand = [seven names] }.",
        )
    return Recording(
        source=source_of(path, "csv"),
        bodies=bodies,
        orders=dict.fromkeys(bodies, order),
        markers=markers,
        marker_times=times if markers else np.empty(0),
    )


def _header(line: str, delimiter: str | None = None) -> tuple[str, list[str]]:
    """What separates cells, and the names of the columns."""
    delimiter = delimiter or max(",;\t", key=line.count)
    return delimiter, [each.strip().strip('"') for each in line.split(delimiter)]


def _groups(names: list[str]) -> dict[str, list[str]]:
    """Bodies and points that the columns' names tell, in their order."""
    out: dict[str, list[str]] = {}
    for body in [name[:-2] for name in names if name.endswith("_x")]:
        columns = [f"{body}_{each}" for each in POSE]
        columns = columns if {*columns} <= {*names} else columns[:3]
        if {*columns} <= {*names}:
            out[body] = columns
    return out


def _times(
    path: Path, table: dict[str, Float[np.ndarray, "frames"]], options: Mapping[str, Any]
) -> Float[np.ndarray, "frames"]:
    wanted = options.get("time")
    if wanted is not None and wanted not in table:
        raise UnknownNameError("column", str(wanted), table, where=str(path))
    lowered = {each.lower(): each for each in reversed(list(table))}
    name = wanted or next((lowered[each] for each in TIMES if each in lowered), None)
    if name is not None:
        check_rate(table[str(name)], options)
        return table[str(name)]
    if "rate_hz" in options:
        return uniform_clock(len(next(iter(table.values()))), float(options["rate_hz"]))
    raise FileError(
        path,
        f"no column of time among {sorted(table)[:12]}.",
        'Name it in capture.toml (time = "column") or state rate_hz.',
    )
