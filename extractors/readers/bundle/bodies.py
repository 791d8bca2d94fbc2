"""Which body or marker set of which file a sensor or object is, as a pose over time."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from itertools import pairwise

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model import geometry
from capar.model.capture import Notice, Stream, notice
from capar.model.errors import CaptureError, UnknownNameError
from extractors.readers.bundle.rigid import Cluster, arrangement, check_fit, fit_cluster
from extractors.readers.bundle.shapes import Frame, read_pose
from extractors.readers.bundle.toml_table import Table
from extractors.readers.bundle.world import WorldRecording

RESIDUAL_M = 0.010
"""How far markers may lie from their rigid places in the median [m]."""

Files = Mapping[str, WorldRecording]


@dataclass(frozen=True)
class Body:
    """A pose over time on its file's clock, and what its shape may refer to."""

    stream: Stream
    frame: Frame
    notices: tuple[Notice, ...] = field(default=())


def find_body(table: Table, files: Files) -> Body:
    """The body that a sensor's or object's table names, moved by its ``offset``.

    Raises:
        UnknownNameError: No file has a body or marker of that name.
        CaparError: The markers are not rigid, or the name is in several files.
    """
    offset_table = table.table("offset")
    offset = read_pose(offset_table) if offset_table else RigidTransform.identity()
    if offset_table:
        offset_table.close()
    markers = table.texts("markers")
    if markers:
        return _from_markers(table, files, markers, offset)
    if isinstance(table.raw("body"), list):
        return _carried(table, files, offset)
    name = table.text("body")
    file = _file_of(table, files, "body", name)
    recording = files[file]
    stream = offset_by(recording.bodies[name], offset)
    return Body(stream, skeleton_frame(recording, name, stream, offset))


def _carried(table: Table, files: Files, offset: RigidTransform) -> Body:
    """What is recorded only through what it carries: the poses of several bodies, one at a time."""
    names = [name for each in table.texts("body") for name in _fitting(each, files)]
    streams = [files[_file_of(table, files, "body", each)].bodies[each] for each in names]
    order = np.argsort([each.times[0] for each in streams])
    for earlier, later in pairwise(order):
        if streams[later].times[0] <= streams[earlier].times[-1]:
            first, second = names[earlier], names[later]
            raise table.error("body", f"{first!r} and {second!r} are recorded at the same time.")
    parts = [streams[each] for each in order]
    whole = Stream(
        np.concatenate([each.times for each in parts]),
        np.concatenate([each.positions for each in parts]),
        np.concatenate([each.orientations for each in parts]),
    )
    return Body(offset_by(whole, offset), Frame())


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


def _file_of(table: Table, files: Files, key: str, name: str) -> str:
    """The file that has a body or marker of that name."""
    group = "bodies" if key == "body" else "markers"
    wanted = table.text("file", "")
    if wanted and wanted not in files:
        raise UnknownNameError("file", wanted, files, where=table.where("file"))
    choice = [wanted] if wanted else list(files)
    found = [each for each in choice if name in getattr(files[each], group)]
    if not found:
        known = {each for file in choice for each in getattr(files[file], group)}
        raise UnknownNameError(key.removesuffix("s"), name, known, where=table.where(key))
    if len(found) > 1:
        raise table.error(key, f"{name!r} is in files {found}.", "Say which: file = ...")
    return found[0]


def _from_markers(table: Table, files: Files, names: list[str], offset: RigidTransform) -> Body:
    recording = files[_file_of(table, files, "markers", names[0])]
    for name in names:
        if name not in recording.markers:
            where = table.where("markers")
            raise UnknownNameError("marker", name, recording.markers, where=where)
    markers = {name: recording.markers[name] for name in names}
    label = table.text("name")
    points = np.stack(list(markers.values()), axis=1)
    limit = table.number("residual_m", RESIDUAL_M)
    try:
        cluster = _given(table, names) or _own_frame(table, arrangement(label, markers))
        fit = fit_cluster(cluster, points)
        check_fit(label, cluster, points, fit, limit_m=limit)
    except CaptureError as error:
        raise CaptureError(f"{table.where('markers')}: {error}") from error
    wild = fit.residuals > 3.0 * limit
    positions = np.where(wild[:, None], np.nan, fit.positions)
    stream = offset_by(Stream(recording.marker_times, positions, fit.orientations), offset)
    places = offset.inv().apply(cluster.local)
    points_here = MeanPlaces(recording, stream, dict(zip(names, places, strict=True)))
    frame = Frame(points=points_here, markers=tuple(names), mirrored=recording.mirrored)
    wrong = notice("markers-not-rigid", label, frames=int(wild.sum()))
    return Body(stream, frame, (wrong,) if wild.any() else ())


def _given(table: Table, names: list[str]) -> Cluster | None:
    """The arrangement that capture.toml itself states."""
    places = table.table("arrangement")
    if places is None:
        return None
    local = np.array([places.vector(name, 3) for name in names])
    places.close()
    return Cluster(tuple(names), local)


def _own_frame(table: Table, cluster: Cluster) -> Cluster:
    """The arrangement in the frame that ``origin`` and ``axes`` state."""
    places = dict(zip(cluster.names, cluster.local, strict=True))
    origin = [_place(table, "origin", places, each) for each in table.texts("origin")]
    centre = np.mean(origin, axis=0) if origin else np.zeros(3)
    axes = table.table("axes")
    turn = _axes(axes, places) if axes else Rotation.identity()
    return Cluster(cluster.names, turn.inv().apply(cluster.local - centre))


def _axes(table: Table, places: Mapping[str, Float[np.ndarray, "3"]]) -> Rotation:
    """Axes from pairs of markers: the first stands as it is, the second is made square to it."""
    keys = [each for each in table.given() if each in ("x", "y", "z")]
    if len(keys) != 2:
        raise table.error("", "axes takes two of x, y, z, each from one marker to another.")
    ways = {}
    for key in keys:
        ends = table.texts(key)
        if len(ends) != 2:
            raise table.error(key, f"{key} takes two markers, from and to.")
        ways[key] = _place(table, key, places, ends[1]) - _place(table, key, places, ends[0])
    table.close()
    first, second = (np.eye(3)["xyz".index(key)] for key in keys)
    turn, _ = Rotation.align_vectors(
        np.stack([ways[each] / np.linalg.norm(ways[each]) for each in keys]),
        np.stack([first, second]),
        weights=[np.inf, 1.0],
    )
    return turn


def _place(
    table: Table, key: str, places: Mapping[str, Float[np.ndarray, "3"]], name: str
) -> Float[np.ndarray, "3"]:
    if name not in places:
        raise UnknownNameError("marker", name, places, where=table.where(key))
    return places[name]


def skeleton_frame(
    recording: WorldRecording, name: str, stream: Stream, offset: RigidTransform
) -> Frame:
    """Where the file's other bodies and markers lie in a body's frame, in the mean."""
    below = [each for each in recording.parents if _is_below(recording.parents, each, name)]
    bones = {
        "children": tuple(("", each) for each in below if recording.parents[each] == name),
        "descendants": tuple(
            ("" if recording.parents[each] == name else recording.parents[each], each)
            for each in below
        ),
    }
    return Frame(points=MeanPlaces(recording, stream), bones=bones, mirrored=recording.mirrored)


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
