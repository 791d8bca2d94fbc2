"""Which body or marker set of which file a sensor or object is, as a pose over time."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model import geometry
from capar.model.capture import Conventions, Notice, Stream, notice
from capar.model.errors import CaptureError
from extractors.readers.bundle.marker_fit import Cluster, arrangement, check_fit, fit_cluster
from extractors.readers.bundle.shapes import Frame, transform
from extractors.readers.bundle.world import WorldRecording

if TYPE_CHECKING:
    from extractors.readers.schema.bodies import Tracked

Files = Mapping[str, WorldRecording]


@dataclass(frozen=True)
class Body:
    """A pose over time on its file's clock, and what its shape may refer to."""

    stream: Stream
    frame: Frame
    notices: tuple[Notice, ...] = field(default=())
    conventions: Conventions = field(default=Conventions())
    """Those of its file."""


def find_body(entry: "Tracked", files: Files) -> Body:
    """The body that a sensor's or object's table names, moved by its ``offset``.

    Raises:
        UnknownNameError: No file has a body or marker of that name.
        CaparError: The markers are not rigid, or the name is in several files.
    """
    offset = transform(entry.offset)
    if entry.markers:
        return _from_markers(entry, files, entry.markers, offset)
    if not isinstance(entry.body, str):
        return _carried(entry, files, entry.body or [], offset)
    file = _file_of(entry, files, "body", entry.body)
    recording = files[file]
    stream = offset_by(recording.bodies[entry.body], offset)
    frame = skeleton_frame(recording, entry.body, stream)
    return Body(stream, frame, conventions=recording.conventions)


def _carried(entry: "Tracked", files: Files, patterns: list[str], offset: RigidTransform) -> Body:
    """What is recorded only through what it carries: the poses of several bodies, one at a time."""
    names = [name for pattern in patterns for name in _fitting(pattern, files)]
    sources = [files[_file_of(entry, files, "body", name)] for name in names]
    streams = [source.bodies[name] for source, name in zip(sources, names, strict=True)]
    order = np.argsort([stream.times[0] for stream in streams])
    for earlier, later in pairwise(order):
        if streams[later].times[0] <= streams[earlier].times[-1]:
            first, second = names[earlier], names[later]
            raise entry.error("body", f"{first!r} and {second!r} are recorded at the same time.")
    parts = [streams[each] for each in order]
    whole = Stream(
        np.concatenate([each.times for each in parts]),
        np.concatenate([each.positions for each in parts]),
        np.concatenate([each.orientations for each in parts]),
    )
    return Body(offset_by(whole, offset), Frame(), conventions=sources[0].conventions)


def _fitting(pattern: str, files: Files) -> list[str]:
    """The bodies that a pattern with ``*`` fits; what fits none stands for itself."""
    known = sorted({name for file in files.values() for name in file.bodies})
    return [each for each in known if fnmatchcase(each, pattern)] or [pattern]


def offset_by(stream: Stream, offset: RigidTransform) -> Stream:
    """``T_world_body * T_body_sensor`` in every frame."""
    known = ~stream.lost
    positions = np.full_like(stream.positions, np.nan)
    orientations = np.full_like(stream.orientations, np.nan)
    if known.any():
        poses = geometry.transforms(stream.positions[known], stream.orientations[known]) * offset
        positions[known] = poses.translation
        orientations[known] = geometry.quaternions(poses.rotation)
    return Stream(times=stream.times, positions=positions, orientations=orientations)


def _file_of(entry: "Tracked", files: Files, key: str, name: str) -> str:
    """The file that has a body or marker of that name."""
    if entry.file and entry.file not in files:
        raise entry.unknown("file", entry.file, files, "file")
    names = {
        file: files[file].bodies if key == "body" else files[file].markers
        for file in ([entry.file] if entry.file else files)
    }
    found = [file for file in names if name in names[file]]
    if not found:
        known = {each for group in names.values() for each in group}
        raise entry.unknown(key.removesuffix("s"), name, known, key)
    if len(found) > 1:
        raise entry.error(key, f"{name!r} is in files {found}.", "Say which: file = ...")
    return found[0]


def _from_markers(entry: "Tracked", files: Files, names: list[str], offset: RigidTransform) -> Body:
    recording = files[_file_of(entry, files, "markers", names[0])]
    for name in names:
        if name not in recording.markers:
            raise entry.unknown("marker", name, recording.markers, "markers")
    markers = {name: recording.markers[name] for name in names}
    label = str(entry.given()["name"])
    points = np.stack(list(markers.values()), axis=1)
    try:
        cluster = _stated(entry, names) or _own_frame(entry, arrangement(label, markers))
        fit = fit_cluster(cluster, points)
        check_fit(label, cluster, points, fit, limit_m=entry.residual_m)
    except CaptureError as error:
        raise CaptureError(f"{entry.where('markers')}: {error}") from error
    wild = fit.residuals > 3.0 * entry.residual_m
    positions = np.where(wild[:, None], np.nan, fit.positions)
    stream = offset_by(Stream(recording.marker_times, positions, fit.orientations), offset)
    places = offset.inv().apply(cluster.local)
    points_here = MeanPlaces(recording, stream, dict(zip(names, places, strict=True)))
    frame = Frame(points=points_here, markers=tuple(names), mirrored=recording.mirrored)
    wrong = notice("markers-not-rigid", label, frames=int(wild.sum()))
    return Body(stream, frame, (wrong,) if wild.any() else (), recording.conventions)


def _stated(entry: "Tracked", names: list[str]) -> Cluster | None:
    """The arrangement that capture.toml itself states."""
    if entry.arrangement is None:
        return None
    for name in names:
        if name not in entry.arrangement:
            raise entry.unknown("marker", name, entry.arrangement, "arrangement")
    return Cluster(tuple(names), np.array([entry.arrangement[name] for name in names]))


def _own_frame(entry: "Tracked", cluster: Cluster) -> Cluster:
    """The arrangement in the frame that ``origin`` and ``axes`` state."""
    places = dict(zip(cluster.names, cluster.local, strict=True))
    origin = [_place(entry, "origin", places, name) for name in entry.origin]
    centre = np.mean(origin, axis=0) if origin else np.zeros(3)
    turn = _axes(entry, places) if entry.axes else Rotation.identity()
    return Cluster(cluster.names, turn.inv().apply(cluster.local - centre))


def _axes(entry: "Tracked", places: Mapping[str, Float[np.ndarray, "3"]]) -> Rotation:
    """Axes from pairs of markers: the first is kept, the second is made square to it."""
    ways, units = [], []
    for axis, (start, end) in (entry.axes or {}).items():
        way = _place(entry, "axes", places, end) - _place(entry, "axes", places, start)
        ways.append(way / np.linalg.norm(way))
        units.append(np.eye(3)["xyz".index(axis)])
    turn, _ = Rotation.align_vectors(np.stack(ways), np.stack(units), weights=[np.inf, 1.0])
    return turn


def _place(
    entry: "Tracked", key: str, places: Mapping[str, Float[np.ndarray, "3"]], name: str
) -> Float[np.ndarray, "3"]:
    if name not in places:
        raise entry.unknown("marker", name, places, key)
    return places[name]


def skeleton_frame(recording: WorldRecording, name: str, stream: Stream) -> Frame:
    """Where the file's other bodies and markers lie in a body's frame, in the mean."""
    below = [each for each in recording.parents if _is_below(recording.parents, each, name)]
    bones = {
        "children": tuple(("", each) for each in below if recording.parents[each] == name),
        "descendants": tuple(
            ("" if recording.parents[each] == name else recording.parents[each], each)
            for each in below
        ),
    }
    return Frame(
        points=MeanPlaces(recording, stream),
        bones=bones,
        joint=name,
        lengths=lambda first, second: _lengths(recording, first or name, second or name),
        mirrored=recording.mirrored,
    )


def _lengths(recording: WorldRecording, first: str, second: str) -> tuple[float, float]:
    """The distance of two joints [m] that it has, or has not, in a twentieth of all frames."""
    one, two = recording.bodies[first], recording.bodies[second]
    if len(one.times) != len(two.times):
        return 0.0, 0.0
    lengths = np.linalg.norm(one.positions - two.positions, axis=1)
    known = lengths[~np.isnan(lengths)]
    shortest, longest = np.quantile(known, [0.05, 0.95]) if known.size else (0.0, 0.0)
    return float(shortest), float(longest)


def _is_below(parents: Mapping[str, str], name: str, root: str) -> bool:
    seen = set()
    while name in parents and name not in seen:
        seen.add(name)
        name = parents[name]
        if name == root:
            return True
    return False


class MeanPlaces(Mapping[str, Float[np.ndarray, "3"]]):
    """Where a file's bodies and markers lie in one body's frame, in the mean, when asked for."""

    def __init__(
        self,
        recording: WorldRecording,
        stream: Stream,
        own: Mapping[str, Float[np.ndarray, "3"]] | None = None,
    ) -> None:
        self._recording = recording
        self._stream = stream
        self._own = own or {}

    def __iter__(self) -> Iterator[str]:
        """Every body and marker of the file."""
        return iter([*self._recording.bodies, *self._recording.markers])

    def __len__(self) -> int:
        """How many there are."""
        return len(self._recording.bodies) + len(self._recording.markers)

    def __contains__(self, name: object) -> bool:
        """Whether the file has it; asked without computing."""
        return name in self._recording.bodies or name in self._recording.markers

    def __getitem__(self, name: str) -> Float[np.ndarray, "3"]:
        """The place of one of them [m].

        Raises:
            CaptureError: It is never seen together with the body.
        """
        if name in self._own:
            return self._own[name]
        own, points = self._stream, self._points(name)
        if len(points) != len(own.times):
            raise CaptureError(f"{name!r} is on another clock than the body it shapes")
        both = ~own.lost & ~np.isnan(points).any(axis=1)
        if not both.any():
            raise CaptureError(f"{name!r} is never seen together with the body it shapes")
        poses = geometry.transforms(own.positions[both], own.orientations[both])
        return np.asarray(poses.inv().apply(points[both]).mean(axis=0))

    def _points(self, name: str) -> Float[np.ndarray, "frames 3"]:
        if name in self._recording.bodies:
            return self._recording.bodies[name].positions
        return self._recording.markers[name]
