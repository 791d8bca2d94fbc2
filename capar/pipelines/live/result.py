"""The observation of a live recording, put together block by block as it is settled."""

import pickle
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from tempfile import TemporaryFile
from typing import IO, Any, cast

import numpy as np
from jaxtyping import Float

from capar import __version__
from capar.model.calibration import Calibration
from capar.model.capture import Capture, Notice, Stream, TagType, notice
from capar.model.errors import CaptureError
from capar.model.facts import MEASURED, Fact, Frames, Observed, RateMhz, SweptAzimuth
from capar.model.locations import ConstraintLocation, SampledTrack
from capar.model.observation import Observation, ObservedObject, Segment
from capar.model.par import Style
from capar.pipelines.live.frames import Window
from capar.pipelines.live.ledgers import FactLedger, SettledSegment
from capar.pipelines.observation import flicker_notices, unmoved_notices
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import Profile
from capar_rules.movers.movers import movers
from capar_rules.pars.inference import Key, infer
from capar_rules.pars.pars import Measured, compose, ipars, naming_rules, upars
from extractors.bodies.bodies import Bodies, BodyGeometry, bodies_of, observed_object
from extractors.bodies.poses import Poses
from extractors.calibration import check_clock, thresholds_of
from extractors.contact.contacts import EarlierAnswers
from extractors.forces.forces import force_styles
from extractors.measure import Measurements, measured
from extractors.relations.guides import guide_location
from extractors.relations.places import FROM_THE_BEGINNING, Sums, sums_at, without_small_sweeps
from extractors.segments import constraint_location, moved_path, style, track_of


@dataclass(frozen=True, eq=False)
class _Past:
    """The settled poses of a body, up to the frontier."""

    positions: Float[np.ndarray, "frames 3"]
    orientations: Float[np.ndarray, "frames 4"]


class CarriedPoses:
    """The low-passed poses of the last seconds up to the last settled frame.

    Args:
        calibration: What was decided before.
        frames: How many frames are kept: a longer rest is told by its last ones.
    """

    def __init__(self, calibration: Calibration, frames: int) -> None:
        self._calibration = calibration
        self._limits = thresholds_of(calibration)
        self._frames = frames
        self._past: dict[str, _Past] = {}
        self._frontier = -1

    def bodies(self, window: Window) -> Bodies:
        """The bodies of a window, each with its poses from longer ago.

        Raises:
            CaptureError: The calibration is for another rate.
        """
        check_clock(window.capture, self._calibration)
        plain = bodies_of(window.capture, self._limits, self._calibration)
        longer: dict[int, Poses] = {}

        def extended(kind: str, body: BodyGeometry) -> BodyGeometry:
            key = id(body.poses)
            if key not in longer:
                longer[key] = self._extended(f"{kind} {body.name}", body.poses, window)
            return replace(body, poses=longer[key])

        return Bodies(
            {name: extended("sensor", body) for name, body in plain.sensors.items()},
            {name: extended("object", body) for name, body in plain.objects.items()},
            plain.parts,
        )

    def advance(self, window: Window, bodies: Bodies, frontier: int) -> None:
        """Keep the poses up to a later frame of the recording."""
        if frontier <= self._frontier:
            return
        part = slice(self._frontier + 1 - window.first, frontier + 1 - window.first)
        groups = (("sensor", bodies.sensors), ("object", bodies.objects))
        for kind, group in groups:
            for name, body in group.items():
                if not body.poses.rests:
                    self._keep(f"{kind} {name}", body.poses.smooth, part)
        self._frontier = frontier

    def _keep(self, name: str, stream: Stream, part: slice) -> None:
        new = _Past(stream.positions[part], stream.orientations[part])
        past = self._past.get(name)
        if past is not None:
            new = _Past(
                np.concatenate((past.positions, new.positions))[-self._frames :],
                np.concatenate((past.orientations, new.orientations))[-self._frames :],
            )
        self._past[name] = new

    def _extended(self, name: str, poses: Poses, window: Window) -> Poses:
        past = self._past.get(name)
        begin = window.first
        if past is None or self._frontier + 1 - len(past.positions) >= begin:
            return poses
        older = len(past.positions) - (self._frontier + 1 - begin)
        stream = poses.smooth
        step_s = self._calibration.step_s
        times = stream.times[0] - step_s * np.arange(older, 0, -1)
        longer = Stream(
            np.concatenate((times, stream.times)),
            np.concatenate((past.positions[:older], stream.positions)),
            np.concatenate((past.orientations[:older], stream.orientations)),
        )
        known = _smooth_before(longer, past, older)
        inside = slice(older, None)
        smooth = Stream(stream.times, known.positions[inside], known.orientations[inside])
        settled = smooth if poses.settled is stream else poses.settled
        return replace(poses, smooth=smooth, settled=settled, longer=known)


def _smooth_before(longer: Stream, past: _Past, older: int) -> Stream:
    """The same, with settled poses also where a window begins: its filter has no past there."""
    count = min(len(past.positions) - older, len(longer.times) - older)
    positions, orientations = longer.positions.copy(), longer.orientations.copy()
    part = slice(older, older + count)
    positions[part] = past.positions[older : older + count]
    orientations[part] = past.orientations[older : older + count]
    return Stream(longer.times, positions, orientations)


class CarriedSums:
    """The sums at the last frame that is settled, for the window that comes next."""

    def __init__(self) -> None:
        self._known = FROM_THE_BEGINNING
        self.frame = 0
        """The frame of the recording at which they are known."""

    def since(self, window: Window) -> Sums:
        """The sums for a window that holds the frame at which they are known."""
        return replace(self._known, anchor=self.frame - window.first)

    def advance(self, window: Window, measurements: Measurements, frame: int) -> None:
        """Take from a measured window the sums at a later frame of the recording."""
        if frame <= self.frame:
            return
        capture: Capture = window.capture
        bodies = measurements.bodies
        hands = {each.name: bodies.sensors[each.name] for each in capture.acting}
        mobile = {
            each.name: bodies.objects[each.name]
            for each in capture.objects
            if each.tag is TagType.MOBILE
        }
        self._known = sums_at(
            (mobile | hands).values(),
            bodies.objects.values(),
            frame - window.first,
            self.since(window),
        )
        self.frame = frame


PLACE, TURN = 3, 4
"""Numbers of a position and of an orientation [1]."""

POSE = PLACE + TURN


class PosesFile:
    """Settled poses of every body that moves, frame by frame, in a file without a name.

    A frame holds its time, and of each body its pose as recorded, gaps filled, and low-passed. Of a
    body that rests throughout one place is kept, in memory.
    """

    def __init__(self) -> None:
        self._file = _file()
        self._moving: tuple[str, ...] | None = None
        self._resting: dict[str, Float[np.ndarray, "3"]] = {}
        self._frames = 0

    def add(self, window: Window, bodies: Bodies, first: int, last: int) -> None:
        """Keep some frames of a measured window.

        Args:
            window: The window.
            bodies: Its bodies.
            first: The first of the frames, in the recording.
            last: The last one.
        """
        part = slice(first - window.first, last - window.first + 1)
        poses = bodies.poses
        if self._moving is None:
            self._moving = tuple(name for name, pose in sorted(poses.items()) if not pose.rests)
        rows = [window.capture.times[part][:, None]]
        for name in self._moving:
            for stream in (poses[name].filled, poses[name].smooth):
                rows += [stream.positions[part], stream.orientations[part]]
        for name, pose in poses.items():
            known = pose.settled.positions[part]
            known = known[~np.isnan(known[:, 0])]
            if pose.rests and len(known):
                self._resting.setdefault(name, known[0].copy())
        table = np.concatenate(rows, axis=1)
        self._file.write(table.tobytes())
        self._frames += len(table)

    @property
    def times(self) -> Float[np.ndarray, "frames"]:
        """The time of every frame [s]."""
        return np.array(self._table()[:, 0])

    def bodies(self, last: Bodies) -> Bodies:
        """The bodies through all kept frames; their poses are read from disk as they are asked for.

        Args:
            last: The bodies of the last window, for all else; of fixed ones also their poses.
        """
        table = self._table()
        times = np.array(table[:, 0])
        columns = {name: 1 + 2 * POSE * at for at, name in enumerate(self._moving or ())}

        def whole(pose: Poses) -> Poses:
            if pose.still:
                held = _held(pose.filled, times)
                return replace(pose, filled=held, smooth=held, settled=held, longer=None)
            at = columns[pose.name]
            filled, smooth = _stream(table, times, at), _stream(table, times, at + POSE)
            settled = smooth if pose.settled is pose.smooth else filled
            return replace(pose, filled=filled, smooth=smooth, settled=settled, longer=None)

        def longer(known: Mapping[str, BodyGeometry]) -> dict[str, BodyGeometry]:
            return {
                name: replace(body, poses=whole(body.poses)) if body.poses.fixed is None else body
                for name, body in known.items()
            }

        return Bodies(longer(last.sensors), longer(last.objects), last.parts)

    def place(self, name: str) -> Float[np.ndarray, "3"]:
        """Where a body that rests is [m]; NaN if it was never seen."""
        return self._resting.get(name, np.full(PLACE, np.nan))

    def _table(self) -> Float[np.ndarray, "frames numbers"]:
        self._file.flush()
        width = 1 + 2 * POSE * len(self._moving or ())
        return np.memmap(self._file, dtype=np.float64, mode="r", shape=(self._frames, width))


def _stream(
    table: Float[np.ndarray, "frames numbers"], times: Float[np.ndarray, "frames"], at: int
) -> Stream:
    turn = at + PLACE
    return Stream.of_checked(times, table[:, at:turn], table[:, turn : turn + TURN])


def _file() -> IO[bytes]:
    """A file that is gone as soon as nothing reads it."""
    return TemporaryFile()


def _held(stream: Stream, times: Float[np.ndarray, "frames"]) -> Stream:
    """The one pose of a stream through a whole recording."""
    seen = int(np.argmin(stream.lost))
    positions = np.broadcast_to(stream.positions[seen], (len(times), PLACE))
    orientations = np.broadcast_to(stream.orientations[seen], (len(times), TURN))
    return Stream.of_checked(times, positions, orientations)


class ValuesFile:
    """Values in a file without a name, in the order in which they were added."""

    def __init__(self) -> None:
        self._file = _file()

    def add(self, values: Sequence[Any]) -> int:
        """Keep some values.

        Returns:
            Where they are, for ``at``.
        """
        place = self._file.seek(0, 2)
        pickle.dump(values, self._file, protocol=pickle.HIGHEST_PROTOCOL)
        return place

    def at(self, place: int) -> Sequence[Any]:
        """The values that were kept at a place."""
        self._file.seek(place)
        return list(pickle.load(self._file))

    def __iter__(self) -> Iterator[Any]:
        """All values."""
        end = self._file.seek(0, 2)
        self._file.seek(0)
        while self._file.tell() < end:
            here = pickle.load(self._file)
            place = self._file.tell()
            yield from here
            self._file.seek(place)


@dataclass(frozen=True, slots=True)
class SegmentDetails:
    """What is measured of a settled segment, once its zero crossings are settled too."""

    measured: Measured
    location: ConstraintLocation | None
    style: Style

    def for_purpose(self, purpose: str) -> "SegmentDetails":
        """The same with the segment's purpose, which may be known later."""
        location = replace(self.location, purpose=purpose) if self.location else None
        return SegmentDetails(self.measured, location, replace(self.style, purpose=purpose))


def segment_details(
    window: Window, measurements: Measurements, settled: SettledSegment
) -> SegmentDetails:
    """Motion, place and style of a settled segment, from a window in which it lies.

    Args:
        window: The last frames; what began before them is measured from their first.
        measurements: What was measured in them.
        settled: The segment, by frames of the recording.
    """
    segment, limits = settled.segment, thresholds_of(measurements.calibration)
    first = max(segment.first - window.first, 0)
    part = replace(segment, first=first, last=segment.last - window.first)
    motion, path = moved_path(window.capture, measurements, part, limits)
    first_object, second = settled.conditions.colliding
    location = None
    if second >= 0 and "1" in segment.features.rel_end:
        location = constraint_location(
            window.capture,
            measurements.bodies,
            measurements.attention,
            part,
            dominant=segment.objects[first_object] if first_object >= 0 else "",
            goal=segment.objects[second],
        )
        location = replace(location, frame=segment.last)
    track = measurements.tracks[segment.ee]
    shown = style(part, track, window.capture.times, limits)
    return SegmentDetails(Measured(motion, path), location, shown)


@dataclass(frozen=True, slots=True)
class _Kept:
    """What is remembered of a settled segment."""

    index: int
    first: int
    last: int


@dataclass
class Inexact:
    """How much of the result is known to be taken from less than the offline run has."""

    clipped_segments: int = 0
    """Segments longer than the long window: path and style are those of their last part."""

    settled_otherwise: int = 0
    """Segments that are not among the settled ones: path and style are those of the settled segment
    that shares most with each."""


class LiveResult:
    """Facts, segments and places as they are settled; no frame is read a second time.

    Args:
        rig: Bodies, agents and purposes.
        calibration: What was decided before.
        rules: The rule base.
        name: What the whole action is called.
        rate_mhz: Frames in a thousand seconds.
        rest_frames: By how many frames of its rest the place of a body is told.
    """

    def __init__(
        self,
        rig: Capture,
        calibration: Calibration,
        rules: Profile,
        name: str,
        *,
        rate_mhz: int,
        rest_frames: int,
    ) -> None:
        self._rig, self._calibration, self._rules, self._name = rig, calibration, rules, name
        self._rate_mhz = rate_mhz
        self._ledger = FactLedger()
        self._facts = ValuesFile()
        self._always: dict[Fact, None] = {}
        self._settled: dict[str, list[_Kept]] = defaultdict(list)
        self._waiting: list[SettledSegment] = []
        self._details = ValuesFile()
        self._detailed: dict[Key, int] = {}
        self._objects: dict[str, ObservedObject] = {}
        self._notices: dict[object, Notice] = {}
        self._recorded = PosesFile()
        self._sums = CarriedSums()
        self._poses = CarriedPoses(calibration, rest_frames)
        self._answers = EarlierAnswers()
        self._last: Measurements | None = None
        self.inexact = Inexact()

    @property
    def frontier(self) -> int:
        """The last frame whose facts are settled."""
        return self._ledger.frontier

    def block(self, window: Window, frontier: int) -> None:
        """Measure a window, and take from it what is settled up to a frame.

        Args:
            window: The last frames.
            frontier: The frame; beyond it nothing is taken.
        """
        bodies = self._poses.bodies(window)
        since = self._sums.since(window)
        self._answers.begin(window.first)
        measurements = measured(
            window.capture, self._calibration, bodies, since, answers=self._answers
        )
        self._poses.advance(window, bodies, frontier)
        self._sums.advance(window, measurements, frontier)
        before = self._ledger.frontier
        found = self._ledger.stitched(measurements.facts, window.first)
        self._facts.add(self._ledger.settle(found, frontier))
        for fact in measurements.facts:
            if isinstance(fact, Observed) and not fact.ends():
                self._always.setdefault(fact)
        for thing in window.capture.objects:
            if thing.name not in self._objects and not thing.stream.lost.all():
                self._objects[thing.name] = observed_object(thing)
        for told in measurements.notices:
            self._notices[told.code, told.bodies] = told
        self._recorded.add(window, measurements.bodies, before + 1, frontier)
        self._last = measurements
        ready = [each for each in self._waiting if each.segment.last <= frontier]
        self._waiting = [each for each in self._waiting if each.segment.last > frontier]
        for settled in ready:
            key = settled.segment.ee, settled.segment.index
            self.inexact.clipped_segments += int(settled.segment.first < window.first)
            self._detailed[key] = self._details.add(
                [segment_details(window, measurements, settled)]
            )

    def segments(self, done: Sequence[SettledSegment]) -> None:
        """Take the segments that an answer of the rules settles."""
        for settled in done:
            segment = settled.segment
            own = self._settled[segment.ee]
            if segment.index == len(own):
                self._waiting.append(settled)
                own.append(_Kept(segment.index, segment.first, segment.last))

    def observation(self, window: Window) -> Observation:
        """The whole, once everything is settled.

        Args:
            window: The last frames: the last of them ends the recording.

        Raises:
            CaptureError: Fewer than two frames.
        """
        assert self._last is not None
        if window.last < 1:
            raise CaptureError("a live recording of fewer than two frames: nothing can be observed")
        times = self._recorded.times
        bodies = self._recorded.bodies(self._last.bodies)
        duration_s = float(times[-1])
        facts = self._all_facts(window.last)
        steadied = steady(facts) if self._rules.steady else tuple(facts)
        inference = infer(steadied, profile=self._rules)
        moved = () if self._rules.crossings_only else movers(steadied)
        ordered = [segment for link in inference.links for segment in link.segments]
        details = [self._details_of(each).for_purpose(each.purpose) for each in ordered]
        measured = {
            (each.ee, each.index): own.measured for each, own in zip(ordered, details, strict=True)
        }
        rate_hz = 1.0 / float(np.median(np.diff(times)))
        guides = {} if self._rules.crossings_only else self._last.guides
        objects = self._last.bodies.objects
        return Observation(
            capture=self._rig.name,
            profile=self._rules.name,
            rules=self._rules.fingerprint,
            version=__version__,
            agent=self._rig.agent,
            duration_s=duration_s,
            rate_hz=rate_hz,
            frames=len(times),
            objects=tuple(
                self._objects.get(each.name) or observed_object(each)
                for each in window.capture.objects
            ),
            links=inference.links,
            facts=(*steadied, *moved),
            upars=upars(inference, measured, name=self._name),
            ipars=ipars(inference, measured, agent=self._rig.agent.name, name=self._name),
            complex_par=compose(
                inference, name=self._name, frames=window.last, duration_s=duration_s
            ),
            locations=tuple(each.location for each in details if each.location is not None),
            styles=tuple(each.style for each in details),
            sources=self._rig.sources,
            notices=(
                *self._notices.values(),
                *flicker_notices(steadied, rate_hz),
                *unmoved_notices((*steadied, *moved), times),
                *(notice("rule-violation", violation=each) for each in inference.violations),
            ),
            joint=inference.joint,
            relations=inference.relations,
            others=self._rig.others,
            calibration=self._calibration,
            forces=force_styles(self._rig, bodies, steadied, self._last.guides, times=times),
            guides=tuple(
                guide_location(objects[name], objects[guide.base], guide)
                for name, guide in sorted(guides.items())
            ),
            naming=naming_rules(self._rules, (each.name for each in ordered)),
            tracks=tuple(self._sampled(bodies, times)),
        )

    def _details_of(self, segment: Segment) -> SegmentDetails:
        """What was measured of a segment; of one that was settled otherwise, of most of it."""
        nearest = max(
            self._settled[segment.ee],
            key=lambda known: min(known.last, segment.last) - max(known.first, segment.first),
        )
        same = nearest.first == segment.first and nearest.last == segment.last
        self.inexact.settled_otherwise += int(not same)
        (found,) = self._details.at(self._detailed[segment.ee, nearest.index])
        return cast(SegmentDetails, found)

    def _all_facts(self, last: int) -> list[Fact]:
        """Every settled fact, in the order in which facts are written."""
        always: list[Fact] = [Frames(0, last), RateMhz(self._rate_mhz)]
        always += (each for each in self._always if not isinstance(each, Frames | RateMhz))
        groups: dict[type[Fact], set[Fact]] = {}
        for fact in (*always, *self._facts):
            groups.setdefault(type(fact), set()).add(fact)
        sweeps = (fact for fact in groups.get(SweptAzimuth, ()) if isinstance(fact, SweptAzimuth))
        groups[SweptAzimuth] = set(without_small_sweeps(sweeps))
        return [each for kind in MEASURED for each in sorted(groups.get(kind, ()))]

    def _sampled(
        self, bodies: Bodies, times: Float[np.ndarray, "frames"]
    ) -> Iterator[SampledTrack]:
        """The track of each body, from the smoothed places that were kept."""
        for name, pose in sorted(bodies.poses.items()):
            places = pose.smooth.positions
            if pose.rests:
                places = np.broadcast_to(self._recorded.place(name), (len(times), 3))
            yield track_of(name, places, times, rests=pose.rests)
