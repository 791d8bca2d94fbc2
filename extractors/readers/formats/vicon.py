"""Vicon Nexus and Tracker CSV: sections of trajectories, segments and objects."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.capture import UNITS, Stream
from capar.model.errors import FileError, UnknownNameError
from extractors.readers.file_access import number_of, read_rows, read_text, source_of
from extractors.readers.names import parents_by_names
from extractors.readers.recording import ROTATIONS, Recording, quaternions_of, track

OPTIONS = frozenset({"rotations"})
"""``rotations``: what RX, RY and RZ are, ``helical`` if not given."""

PLACES = {"trajectories": ("X", "Y", "Z"), "segments": ("TX", "TY", "TZ"),
          "objects": ("TX", "TY", "TZ")}  # fmt: skip
"""The columns of a position in each section that is read."""

TURN = ("RX", "RY", "RZ")
SECTIONS = (*PLACES, "devices", "joints", "model outputs", "events")
UNLABELED = "unlabeled"
TITLE = "Global Angle "
"""What names of segments and objects begin with in files of Tracker."""


def recognises(path: Path, head: bytes) -> bool:
    """Whether the first line is the name of a section."""
    lines = head.decode("utf-8-sig", "ignore").lstrip().splitlines()
    return bool(lines) and _title(lines[0]) in SECTIONS


def read(path: Path, options: Mapping[str, Any]) -> Recording:
    """The markers of trajectories, and the bodies of segments and objects.

    What has empty cells was not seen.

    Raises:
        FileError: No section has a position, or one lacks its rate, columns or rows.
        UnknownNameError: The options name another kind of rotations.
    """
    rotations = str(options.get("rotations", "helical"))
    if rotations not in ROTATIONS:
        raise UnknownNameError("kind of rotations", rotations, ROTATIONS, where=str(path))
    lines = read_text(path).splitlines()
    starts = [n for n, each in enumerate(lines) if _title(each) in SECTIONS]
    sections = [
        _Section(path, _title(lines[start]), start + 1, lines[start + 1 : end])
        for start, end in zip(starts, [*starts[1:], len(lines)], strict=True)
        if _title(lines[start]) in PLACES
    ]
    if not sections:
        found = ", ".join(lines[n].strip(" ,;\t") for n in starts)
        raise FileError(
            path, f"has {found} alone.", "Export trajectories, segments or objects too."
        )
    units = {unit for each in sections for unit in each.units}
    if len(units) > 1:
        raise FileError(path, f"has positions in {' and '.join(sorted(units))}.", "Export in one.")
    bodies = {
        name: stream
        for each in sections
        if each.title != "trajectories"
        for name, stream in each.bodies(rotations)
    }
    trajectories = [each for each in sections if each.title == "trajectories"]
    return Recording(
        source=source_of(path, "vicon"),
        bodies=bodies,
        markers={name: points for each in trajectories for name, points in each.points()},
        marker_times=trajectories[0].times if trajectories else np.empty(0),
        unit_m=UNITS.get(units.pop()) if units else None,
        parents=parents_by_names(bodies),
    )


class _Section:
    """One section of a file: a table with the columns of what has a position in it."""

    def __init__(self, path: Path, title: str, first_line: int, lines: Sequence[str]) -> None:
        """Read it: the rate, then names, columns and units, then rows up to a blank line."""
        self.path, self.title = path, title
        self.delimiter = max(",;\t", key=lines[2].count) if len(lines) > 2 else ","
        rate_hz = number_of(lines[0].strip(" ,;\t")) if lines else None
        if rate_hz is None or not rate_hz > 0.0 or len(lines) < 5:
            problem = f"has no rate and four rows of header under {title.capitalize()}."
            raise FileError(f"{path}:{first_line + 1}", problem, "Export it again.")
        self.axes = self._cells(lines[2])
        names, units = self._cells(lines[1]), self._cells(lines[3])
        blank = (n for n, each in enumerate(lines) if n > 3 and not each.strip(" ,;\t"))
        rows = lines[4 : next(blank, len(lines))]
        if self.delimiter != ",":
            rows = [each.replace(",", ".") for each in rows]
        self.table = read_rows(
            rows, path=path, first_line=first_line + 5, columns=len(self.axes),
            delimiter=self.delimiter,
        )  # fmt: skip
        self.times = self.table[:, 0] / rate_hz
        starts = [n for n, axis in enumerate(self.axes) if n > 1 and axis in {"X", "RX"}]
        self.columns: dict[str, dict[str, int]] = {}
        for start, end in zip(starts, [*starts[1:], len(self.axes)], strict=True):
            own = {self.axes[n]: n for n in reversed(range(start, end))}
            name = _plain(names[start]) if start < len(names) else ""
            name = name or f"{UNLABELED}_{len(self.columns) + 1}"
            if name in self.columns:
                raise FileError(f"{path}:{first_line + 2}", f"names {name!r} twice.", "Rename one.")
            if {*PLACES[title]} <= {*own}:
                self.columns[name] = own
        self.units = {units[own[axis]] for own in self.columns.values() for axis in PLACES[title]}
        self.degrees = "deg" in units

    def _cells(self, line: str) -> list[str]:
        cells = [each.strip().strip('"') for each in line.split(self.delimiter)]
        while cells and not cells[-1]:
            cells.pop()
        return cells

    def points(self) -> Iterator[tuple[str, Float[np.ndarray, "frames 3"]]]:
        """The positions of everything, in the section's unit."""
        for name, own in self.columns.items():
            yield name, self.table[:, [own[each] for each in PLACES[self.title]]]

    def bodies(self, rotations: str) -> Iterator[tuple[str, Stream]]:
        """The poses of everything; of quaternions RW is the real part."""
        for name, places in self.points():
            own = self.columns[name]
            turns = self.table[:, [own[each] for each in TURN]]
            if "RW" in own:
                turned = geometry.unit(np.column_stack([self.table[:, own["RW"]], turns]))
            else:
                turned = quaternions_of(turns, rotations, degrees=self.degrees)
            yield name, track(name, self.times, places, turned)


def _title(line: str) -> str:
    return line.strip().strip(',;\t" ').lower()


def _plain(name: str) -> str:
    """A name without the words of Tracker; a prop's, whose subject and segment are one, is one."""
    subject, _, own = name.removeprefix(TITLE).rpartition(":")
    return own if subject == own else name.removeprefix(TITLE)
