"""Bodies and marker sets of files as poses over time in one world and on one clock."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from functools import partial
from itertools import pairwise

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model import geometry
from capar.model.capture import Conventions, Notice, Shape, Source, Stream, notice, upward
from capar.model.errors import CaptureError
from extractors.faults.quaternion_order import order_notices
from extractors.readers.bundle.shapes import Frame, mirrored, transform
from extractors.readers.recording import UNITS, Recording
from extractors.readers.schema.capture import Tracked
from extractors.thresholds import Thresholds

FLAT_M = 1e-4  # Markers whose second principal spread is below this lie on a line [m].


@dataclass(frozen=True, eq=False)
class Cluster:
    """A named marker set as one rigid body."""

    names: tuple[str, ...]
    local: Float[np.ndarray, "markers 3"]
    """Places of the markers in the body's frame [m]."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A cluster's pose over time."""

    positions: Float[np.ndarray, "frames 3"]
    orientations: Float[np.ndarray, "frames 4"]
    residuals: Float[np.ndarray, "frames"]
    """Root mean square distance of seen markers from their places [m]; NaN where lost."""


def arrangement(body: str, markers: Mapping[str, Float[np.ndarray, "frames 3"]]) -> Cluster:
    """The mean arrangement over the frames in which most markers are seen.

    Its origin is the markers' centre; its axes are the world's in the first such frame. A single
    marker is a body whose axes stay the world's.

    Raises:
        CaptureError: No or two markers, some on one line, or never three seen at once.
    """
    names = tuple(markers)
    if len(names) == 1:
        return Cluster(names, np.zeros((1, 3)))
    if len(names) < 3:
        raise CaptureError(
            f"body {body!r} has markers {list(names)}; a rigid body needs three, and a point one"
        )
    points = np.stack([markers[each] for each in names], axis=1)
    seen = ~np.isnan(points).any(axis=2)
    whole = np.flatnonzero(seen.all(axis=1))
    if not whole.size:
        unseen = [name for name, each in zip(names, seen.T, strict=True) if not each.any()]
        raise CaptureError(
            f"body {body!r}: its markers are never all seen at once"
            + (f"; never seen at all: {unseen}" if unseen else "; use fewer of them")
        )
    local = points[whole[0]] - points[whole[0]].mean(axis=0)
    if np.linalg.svd(local, compute_uv=False)[1] < FLAT_M:
        raise CaptureError(f"body {body!r}: markers {list(names)} lie on one line")
    for _ in range(3):
        fit = fit_cluster(Cluster(names, local), points[whole])
        turned = geometry.rotations(fit.orientations).inv().as_matrix()
        local = np.einsum("fij,fmj->mi", turned, points[whole] - fit.positions[:, None]) / len(
            whole
        )
        local = local - local.mean(axis=0)
    return Cluster(names, local)


def fit_cluster(cluster: Cluster, points: Float[np.ndarray, "frames markers 3"]) -> Fit:
    """The pose of a cluster in every frame in which three of its markers, or its only, are seen.

    They are least squares over many frames at once (Kabsch).
    """
    frames = len(points)
    fit = Fit(np.full((frames, 3), np.nan), np.full((frames, 4), np.nan), np.full(frames, np.nan))
    if len(cluster.names) == 1:
        seen = ~np.isnan(points[:, 0]).any(axis=1)
        fit.positions[seen] = points[seen, 0] - cluster.local[0]
        fit.orientations[seen], fit.residuals[seen] = [1.0, 0.0, 0.0, 0.0], 0.0
        return fit
    patterns, which = np.unique(~np.isnan(points).any(axis=2), axis=0, return_inverse=True)
    for index, seen in enumerate(patterns):
        rows, local = np.flatnonzero(which.reshape(-1) == index), cluster.local[seen]
        if len(local) < 3:
            continue
        world, centre = points[rows][:, seen], local.mean(axis=0)
        if np.linalg.svd(local - centre, compute_uv=False)[1] < FLAT_M:
            continue  # a rotation is left open
        middle = world.mean(axis=1)
        u, _, vt = np.linalg.svd(np.einsum("fmi,mj->fij", world - middle[:, None], local - centre))
        u[:, :, 2] *= np.where(np.linalg.det(u @ vt) < 0.0, -1.0, 1.0)[:, None]
        matrices = u @ vt
        placed = np.einsum("fij,mj->fmi", matrices, local - centre) + middle[:, None]
        fit.positions[rows] = middle - matrices @ centre
        fit.orientations[rows] = geometry.quaternions(Rotation.from_matrix(matrices))
        fit.residuals[rows] = np.sqrt(((placed - world) ** 2).sum(axis=2).mean(axis=1))
    return fit


def _check_fit(
    body: str,
    cluster: Cluster,
    points: Float[np.ndarray, "frames markers 3"],
    fit: Fit,
    limit_m: float,
) -> None:
    """Check that the markers keep their arrangement, and not only in a mirror."""
    if np.isnan(fit.residuals).all():
        raise CaptureError(f"body {body!r}: three of its markers are never seen at once")
    rest = float(np.nanmedian(fit.residuals))
    if rest <= limit_m:
        return
    other = fit_cluster(Cluster(cluster.names, cluster.local * [-1.0, 1.0, 1.0]), points)
    if float(np.nanmedian(other.residuals)) < 0.5 * rest:
        raise CaptureError(
            f"body {body!r}: its markers fit their arrangement only in a mirror; the world is "
            'left-handed (state handedness = "left") or two markers have changed names'
        )
    raise CaptureError(
        f"body {body!r}: markers {list(cluster.names)} leave {rest * 1e3:.1f} mm of their rigid "
        f"arrangement, more than {limit_m * 1e3:.1f} mm; leave out those that move against the "
        "others, or state residual_m"
    )


LARGEST_M = 100.0  # No room for motion capture spans more [m].
SMALLEST_M = 0.005  # Nor do sensors and objects together span less [m].


@dataclass(frozen=True, eq=False)
class WorldRecording:
    """A recording in metres, right-handed, z up."""

    source: Source
    bodies: Mapping[str, Stream]
    markers: Mapping[str, Float[np.ndarray, "frames 3"]]
    marker_times: Float[np.ndarray, "frames"]
    parents: Mapping[str, str]
    notices: tuple[Notice, ...]
    conventions: Conventions
    """By which it was brought there."""

    shapes: Mapping[str, Shape] = field(default_factory=dict)
    """Surfaces of bodies in their own frames, where the file holds them."""

    places: Mapping[str, str] = field(default_factory=dict)
    """Place on the body of joints and markers, where the capture states it."""

    @property
    def times(self) -> Float[np.ndarray, "frames"]:
        """The clock of the file's frames [s]: the markers', else that of the first body."""
        return self.marker_times if self.markers else next(iter(self.bodies.values())).times


def to_world(recording: Recording, *, unit_m: float, up: str, left_handed: bool) -> WorldRecording:
    """A recording brought to the world; a left-handed one is mirrored in x.

    Raises:
        CaptureError: The recording then spans what no room spans: a wrong unit.
    """
    turn = upward(up)

    def placed(points: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames 3"]:
        return turn.apply(mirrored(points * unit_m) if left_handed else points * unit_m)

    bodies = {}
    for name, stream in recording.bodies.items():
        known, turned = ~stream.lost, np.full_like(stream.orientations, np.nan)
        if known.any():
            own = stream.orientations[known] * ([1.0, 1.0, -1.0, -1.0] if left_handed else 1.0)
            turned[known] = geometry.quaternions(turn * geometry.rotations(own))
        bodies[name] = Stream(stream.times, placed(stream.positions), turned)
    markers = {name: placed(each) for name, each in recording.markers.items()}
    every = [each.positions for each in bodies.values()] + list(markers.values())
    _check_span(recording.source.path, every, unit_m)
    order = order_notices(recording.bodies, recording.orders, unit_m, Thresholds())
    return WorldRecording(
        source=recording.source,
        bodies=bodies,
        markers=markers,
        marker_times=recording.marker_times,
        parents=recording.parents,
        notices=(*recording.notices, *order),
        conventions=Conventions(unit_m, up, left_handed),
        shapes=recording.shapes,
    )


def _check_span(path: str, every: list[Float[np.ndarray, "frames 3"]], unit_m: float) -> None:
    """Check that a recording is of the size of people; else name the unit that would make it so."""
    points = np.concatenate(every)
    points = points[~np.isnan(points).any(axis=1)]
    if not len(points):
        raise CaptureError(f"{path}: no body or marker is seen in any frame")
    # the middle nine tenths: a few wild samples do not decide about the unit
    low, high = np.quantile(points, [0.05, 0.95], axis=0)
    span = float(np.linalg.norm(high - low))
    if span > LARGEST_M or (span < SMALLEST_M and len(every) > 1):
        units = ("m", "mm", *UNITS)  # the usual ones first
        fitting = (name for name in units if 0.1 <= span / unit_m * UNITS[name] <= 20.0)
        likely = next(fitting, "m")
        raise CaptureError(
            f"{path}: in this unit ({unit_m:g} m) the recording spans {span:.4g} m; people move "
            f'in a few metres. The unit is likely {likely!r}: state unit = "{likely}"'
        )


Files = Mapping[str, WorldRecording]
Points = Mapping[str, Float[np.ndarray, "frames 3"]]


@dataclass(frozen=True)
class Body:
    """A pose over time on its file's clock, and what its shape may refer to."""

    stream: Stream
    frame: Frame
    notices: tuple[Notice, ...] = ()
    conventions: Conventions = field(default=Conventions())
    """Those of its file."""


def find_body(entry: Tracked, files: Files) -> Body:
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
    stream = _offset_by(recording.bodies[entry.body], offset)
    frame = _skeleton_frame(recording, entry.body, stream)
    if shape := recording.shapes.get(entry.body):
        frame.recorded = replace(shape, vertices=offset.inv().apply(shape.vertices))
    return Body(stream, frame, conventions=recording.conventions)


def _carried(entry: Tracked, files: Files, patterns: list[str], offset: RigidTransform) -> Body:
    """What is recorded only through what it carries: the poses of several bodies, one at a time."""
    known = sorted({name for file in files.values() for name in file.bodies})
    names = [
        name
        for pattern in patterns
        for name in [each for each in known if fnmatchcase(each, pattern)] or [pattern]
    ]
    sources = [files[_file_of(entry, files, "body", name)] for name in names]
    streams = [source.bodies[name] for source, name in zip(sources, names, strict=True)]
    order = np.argsort([stream.times[0] for stream in streams])
    for earlier, later in pairwise(order):
        if streams[later].times[0] <= streams[earlier].times[-1]:
            first, second = names[earlier], names[later]
            raise entry.error("body", f"{first!r} and {second!r} are recorded at the same time.")
    parts = [streams[each] for each in order]
    whole = Stream(
        *(
            np.concatenate([getattr(each, name) for each in parts])
            for name in ("times", "positions", "orientations")
        )
    )
    return Body(_offset_by(whole, offset), Frame(), conventions=sources[0].conventions)


def _offset_by(stream: Stream, offset: RigidTransform) -> Stream:
    """``T_world_body * T_body_sensor`` in every frame."""
    known = ~stream.lost
    positions = np.full_like(stream.positions, np.nan)
    orientations = np.full_like(stream.orientations, np.nan)
    if known.any():
        poses = geometry.composed(stream.positions[known], stream.orientations[known], offset)
        positions[known], orientations[known] = poses
    return Stream(times=stream.times, positions=positions, orientations=orientations)


def _file_of(entry: Tracked, files: Files, key: str, name: str) -> str:
    """The file that has a body or marker of that name."""
    if entry.file and entry.file not in files:
        raise entry.unknown("file", entry.file, files, "file")
    names = {
        file: files[file].bodies if key == "body" else files[file].markers
        for file in ([entry.file] if entry.file else files)
    }
    found = [file for file in names if name in names[file]]
    if not found:
        if key == "body" and any(name in file.markers for file in files.values()):
            problem = f"{name!r} is a point, which does not turn."
            raise entry.error(key, problem, f'Write markers = ["{name}"] in place of body.')
        known = {each for group in names.values() for each in group}
        raise entry.unknown(key.removesuffix("s"), name, known, key)
    if len(found) > 1:
        raise entry.error(key, f"{name!r} is in files {found}.", "Say which: file = ...")
    return found[0]


def _from_markers(entry: Tracked, files: Files, names: list[str], offset: RigidTransform) -> Body:
    recording = files[_file_of(entry, files, "markers", names[0])]
    for name in names:
        if name not in recording.markers:
            raise entry.unknown("marker", name, recording.markers, "markers")
    markers = {name: recording.markers[name] for name in names}
    label = str(entry.given()["name"])
    points = np.stack(list(markers.values()), axis=1)
    try:
        cluster = _cluster(entry, markers, label)
        fit = fit_cluster(cluster, points)
        _check_fit(label, cluster, points, fit, entry.residual_m)
    except CaptureError as error:
        raise CaptureError(f"{entry.where('markers')}: {error}") from error
    wild = fit.residuals > 3.0 * entry.residual_m
    positions = np.where(wild[:, None], np.nan, fit.positions)
    stream = _offset_by(Stream(recording.marker_times, positions, fit.orientations), offset)
    places = offset.inv().apply(cluster.local)
    own = dict(zip(names, places, strict=True))
    frame = Frame(
        names=(*recording.bodies, *recording.markers),
        place=partial(_mean_place, recording, stream, own),
        markers=tuple(names),
        mirrored=recording.conventions.left_handed,
    )
    wrong = notice("markers-not-rigid", label, frames=int(wild.sum()))
    return Body(stream, frame, (wrong,) if wild.any() else (), recording.conventions)


def _cluster(entry: Tracked, markers: Points, label: str) -> Cluster:
    """The arrangement that is stated, or one in the frame that ``origin`` and ``axes`` state.

    Of two axes from pairs of markers the first is kept, the second is made square to it.
    """
    if entry.arrangement is not None:
        for name in markers:
            if name not in entry.arrangement:
                raise entry.unknown("marker", name, entry.arrangement, "arrangement")
        return Cluster(tuple(markers), np.array([entry.arrangement[name] for name in markers]))
    cluster = arrangement(label, markers)
    places = dict(zip(cluster.names, cluster.local, strict=True))
    ends = [name for pair in (entry.axes or {}).values() for name in pair]
    for key, names in (("origin", entry.origin), ("axes", ends)):
        for name in names:
            if name not in places:
                raise entry.unknown("marker", name, places, key)
    centre = np.mean([places[name] for name in entry.origin] or [np.zeros(3)], axis=0)
    turn = Rotation.identity()
    if entry.axes:
        along = np.stack([places[end] - places[start] for start, end in entry.axes.values()])
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        units = np.eye(3)[["xyz".index(axis) for axis in entry.axes]]
        turn, _ = Rotation.align_vectors(along, units, weights=[np.inf, 1.0])
    return Cluster(cluster.names, turn.inv().apply(cluster.local - centre))


def _skeleton_frame(recording: WorldRecording, name: str, stream: Stream) -> Frame:
    """Where the file's other bodies and markers lie in a body's frame, in the mean."""
    parents, below = recording.parents, {name}
    while more := {each for each, above in parents.items() if above in below} - below:
        below |= more
    bones = [("" if above == name else above, n) for n, above in parents.items() if above in below]

    def lengths(first: str, second: str) -> tuple[float, float]:
        one, two = recording.bodies[first or name], recording.bodies[second or name]
        if len(one.times) != len(two.times):
            return 0.0, 0.0
        found = np.linalg.norm(one.positions - two.positions, axis=1)
        known = found[~np.isnan(found)]
        shortest, longest = np.quantile(known, [0.05, 0.95]) if known.size else (0.0, 0.0)
        return float(shortest), float(longest)

    return Frame(
        names=(*recording.bodies, *recording.markers),
        place=partial(_mean_place, recording, stream, {}),
        bones={"children": [bone for bone in bones if not bone[0]], "descendants": bones},
        joint=name,
        lengths=lengths,
        mirrored=recording.conventions.left_handed,
    )


def _mean_place(
    recording: WorldRecording, stream: Stream, own: Mapping[str, Float[np.ndarray, "3"]], name: str
) -> Float[np.ndarray, "3"]:
    """Where one of a file's bodies or markers lies in a body's frame, in the mean [m]."""
    if name in own:
        return own[name]
    points = recording.markers.get(name)
    if name in recording.bodies:
        points = recording.bodies[name].positions
    if points is None or len(points) != len(stream.times):
        raise CaptureError(f"{name!r} is on another clock than the body it shapes")
    both = ~stream.lost & ~np.isnan(points).any(axis=1)
    if not both.any():
        raise CaptureError(f"{name!r} is never seen together with the body it shapes")
    poses = geometry.transforms(stream.positions[both], stream.orientations[both])
    return np.asarray(poses.inv().apply(points[both]).mean(axis=0))


GAP_S = Thresholds().gap_s  # Nothing is interpolated between samples further apart than this [s].
GAP_STEPS = 1.5  # Or than so many steps of a source that is slower.
SAME_S = 1e-6  # Time stamps that differ by less are one [s].
FAR_RATE = 4.0  # A rate that differs from the recorded ones by more than this factor is doubtful.
LARGEST_FRAMES = 1e7  # Frames that a capture may have: more than a day at 100 Hz.


def resampled(
    stream: Stream, times: Float[np.ndarray, "frames"], *, extend: str = "none"
) -> Stream:
    """A stream at other times: positions by cubic, orientations by slerp.

    Args:
        stream: The source, on a clock of its own with the same zero.
        times: The wanted clock [s].
        extend: ``rest`` holds the first pose before it and the last after it; ``none`` does not.
    """
    known = np.flatnonzero(~stream.lost)
    if not known.size:
        lost = np.full((len(times), 7), np.nan)
        return Stream(times, lost[:, :3], lost[:, 3:])
    same = len(times) == len(stream.times) and np.abs(times - stream.times).max() < SAME_S
    if extend == "none" and same:
        return Stream(times, stream.positions, stream.orientations)  # what is lost stays so
    source = stream.times[known]
    wanted = np.clip(times, source[0], source[-1]) if extend == "rest" else times
    # near is a wanted time at a known sample, or between two that are near each other
    reach = max(GAP_S, GAP_STEPS * float(np.median(np.diff(stream.times))))
    after = np.clip(np.searchsorted(source, wanted), 0, len(source) - 1)
    before = np.clip(after - 1, 0, len(source) - 1)
    exact = np.minimum(np.abs(wanted - source[before]), np.abs(source[after] - wanted)) < SAME_S
    within = (wanted >= source[0]) & (wanted <= source[-1])
    near = exact | (within & (source[after] - source[before] <= reach + SAME_S))
    positions = np.full((len(times), 3), np.nan)
    orientations = np.full((len(times), 4), np.nan)
    inside = np.clip(wanted[near], source[0], source[-1])
    positions[near] = _positions(source, stream.positions[known], inside)
    orientations[near] = geometry.slerp(source, stream.orientations[known], inside)
    return Stream(times=times, positions=positions, orientations=orientations)


def _positions(
    source: Float[np.ndarray, "known"],
    positions: Float[np.ndarray, "known 3"],
    wanted: Float[np.ndarray, "frames"],
) -> Float[np.ndarray, "frames 3"]:
    """Cubic inside runs of steady sampling, linear in short ones."""
    from scipy.interpolate import CubicSpline

    if len(source) == 1:
        return np.repeat(positions, len(wanted), axis=0)
    out = np.stack([np.interp(wanted, source, each) for each in positions.T], axis=1)
    step = max(GAP_S, GAP_STEPS * float(np.median(np.diff(source))))
    breaks = np.flatnonzero(np.diff(source) > step) + 1
    for run in np.split(np.arange(len(source)), breaks):
        if len(run) >= 4:
            within = (wanted >= source[run[0]]) & (wanted <= source[run[-1]])
            out[within] = CubicSpline(source[run], positions[run])(wanted[within])
    return out


def shared_clock(
    streams: Sequence[Stream],
    *,
    rate_hz: float | None,
    span_s: tuple[float | None, float | None],
    where: str,
) -> tuple[Float[np.ndarray, "frames"], float]:
    """The clock that every stream is put on, from zero, and the files' time of its zero.

    Args:
        streams: The streams on their files' clocks.
        rate_hz: Frames a second; None keeps the clock that all streams share.
        span_s: What is kept, in seconds after the earliest frame.
        where: The capture.toml, for messages.

    Raises:
        CaptureError: The streams have different clocks and no rate is stated.
    """
    if not streams:
        raise CaptureError(f"{where}: no sensor or object has a body or markers")
    first = min(float(each.times[0]) for each in streams)
    last = max(float(each.times[-1]) for each in streams)
    begin = first + (span_s[0] or 0.0)
    end = last if span_s[1] is None else min(last, first + span_s[1])
    if rate_hz is not None:
        frames = (end - begin) * rate_hz
        if not 1.0 <= frames <= LARGEST_FRAMES:
            raise CaptureError(
                f"{where}: {end - begin:g} s at rate_hz = {rate_hz:g} make {frames:.0f} frames; "
                f"between 2 and {LARGEST_FRAMES:.0e} are possible"
            )
        return np.arange(int(np.floor(frames + 1e-6)) + 1) / rate_hz, begin
    clock = streams[0].times
    for stream in streams:
        if len(stream.times) != len(clock) or np.abs(stream.times - clock).max() > SAME_S:
            raise CaptureError(
                f"{where}: the streams are on different clocks ({len(clock)} and "
                f"{len(stream.times)} frames); state the rate to bring them to, like rate_hz = 100"
            )
    kept = clock[(clock >= begin - SAME_S) & (clock <= end + SAME_S)]
    if len(kept) < 2:
        raise CaptureError(f"{where}: no frames between from_s and to_s")
    return kept - kept[0], float(kept[0])


def rate_notices(streams: Sequence[Stream], rate_hz: float | None) -> list[Notice]:
    """A notice if the stated rate is far from every rate at which bodies were recorded."""
    rates = [1.0 / float(np.median(np.diff(each.times))) for each in streams]
    if rate_hz is None or min(rates) / FAR_RATE <= rate_hz <= max(rates) * FAR_RATE:
        return []
    recorded = f"{min(rates):.4g}" + (f" to {max(rates):.4g}" if max(rates) > min(rates) else "")
    return [notice("rate-mistyped", stated_hz=rate_hz, recorded_hz=recorded)]
