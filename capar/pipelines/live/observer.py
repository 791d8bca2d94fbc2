"""The live observer: frames in, announcements out, and at the end an observation."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from capar import __version__
from capar.model.calibration import BodyCalibration, Calibration
from capar.model.capture import Capture, TagType
from capar.model.errors import CaparError
from capar.model.facts import (
    Bears,
    ClosingSpeed,
    Displaced,
    Fact,
    Frames,
    Leans,
    Moving,
    Observed,
    OfAgent,
    RateMhz,
    Resting,
    Swings,
    Touching,
)
from capar.model.observation import Observation, ObservedLink, Segment
from capar.model.par import ComplexPar
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from capar.pipelines.live.frames import FrameBuffer, Poses, Window
from capar.pipelines.live.ledgers import (
    Contradictions,
    FactLedger,
    RuleMemory,
    SegmentEvent,
    SegmentLedger,
)
from capar.pipelines.live.result import CarriedPoses, CarriedSums, LiveResult
from capar.pipelines.live.rule_process import RuleProcess
from capar.pipelines.live.undecided import Handling, awaited, decided_at, nameless, undecided
from capar_rules.borders.ticks import in_frames, times
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.pars.inference import Inference
from extractors.bodies.bodies import observed_object
from extractors.calibration import thresholds_of
from extractors.contact.contacts import EarlierAnswers
from extractors.measure import Measurements, measured
from extractors.relations.places import seek_rooms
from extractors.relations.support import PART
from extractors.signals.filters import filter_settles_s
from kb.language.describe import describe


@dataclass(frozen=True, slots=True, eq=False)
class _Place:
    """Where a thing was when it was touched, and its row in a frame."""

    row: int
    position: Float[np.ndarray, "3"]
    orientation: Float[np.ndarray, "4"]
    known: BodyCalibration

    def is_left(self, poses: Poses) -> bool:
        """Whether the thing is beyond the floor of its motion; not where it is lost."""
        way_m = float(np.linalg.norm(poses.positions[self.row] - self.position))
        cosine = abs(float(poses.orientations[self.row] @ self.orientation))
        angle = 2.0 * float(np.arccos(min(cosine, 1.0)))
        return way_m > self.known.motion_floor_m or angle > self.known.motion_floor_rad


class FirstMotion:
    """Things whose first motion is awaited: once one moves, something is decided.

    It is asked of the poses as they are recorded, which costs next to nothing, so that the window
    is measured as soon as there is something new to see in it.

    Args:
        calibration: The floor of each thing's motion.
        rows: The row of each body in a frame, by ``object NAME``.
    """

    def __init__(self, calibration: Calibration, rows: Mapping[str, int]) -> None:
        self._calibration = calibration
        self._rows = rows
        self._places: list[_Place] = []
        limits = thresholds_of(calibration)
        self._least = 1 + round(limits.moving_minimum_s / calibration.step_s)
        self._away = 0

    def await_(self, window: Window, things: Mapping[str, int]) -> None:
        """Ask of these things from now on, and of no others.

        Args:
            window: The last frames.
            things: The frame at which each was touched first.
        """
        self._places = []
        for name, frame in things.items():
            stream = window.capture.bodies[name].stream
            at = max(frame - window.first, 0)
            self._places.append(
                _Place(
                    self._rows[f"object {name}"],
                    stream.positions[at],
                    stream.orientations[at],
                    self._calibration.tag_object(name),
                )
            )

    def is_seen(self, poses: Poses) -> bool:
        """Whether one of them has moved in a frame, and for as long as makes a motion."""
        self._away = self._away + 1 if any(place.is_left(poses) for place in self._places) else 0
        return self._away >= self._least


@dataclass(frozen=True, slots=True)
class LiveHorizons:
    """How far live observation looks back, and how long it waits before it settles anything.

    Two windows slide over the frames. A short one is measured often and names segments; a long
    one is measured seldom and gives the facts of the result, with the margin on both sides that
    ``extractors.calibration`` proves.
    """

    stride_s: float = 0.45
    """Between two measurements of the short window at most [s], in which segments are found; it is
    measured once more as soon as one that was found is to be settled."""

    grain_s: float = 1.0
    """Short windows begin at multiples of this [s]: what is measured at their first frame is then
    the same several times in a row, and is known."""

    watch_s: float = 0.05
    """Between two measurements at least [s], where a thing moves whose first motion is awaited."""

    announce_s: float = 0.4
    """After its end a segment is announced [s]: ends that are newer still move, as much of what the
    filter asks for has not been seen."""

    settle_s: float = 0.5
    """After its end a segment is settled [s]: what later frames change in a smoothed pose after
    0.4 s is less than a millionth of their way, and losses that are shorter than 0.1 s are filled.
    That is also longer than contacts that are dropped and gaps that are closed (0.1 s)."""

    edge_s: float = 0.75
    """After its end a segment is settled at whose end a thing starts or stops [s], and so late
    facts are kept: when it started is told by how its way grew until it was well beyond its
    floor."""

    lasts_s: float = 0.1
    """So much later than a rule asks for, what has to last for some time has lasted it [s]: by then
    the filter knows the end of that time as well as it knows a segment that is announced."""

    fresh_s: float = 0.2
    """So long a motion that has just begun may turn out to be none [s]: a glitch of the tracker, or
    what the filter makes of the last frames."""

    near_s: float = 0.9
    """So long it is awaited whether bodies touch again that have stayed near each other [s]: their
    contact lasts then."""

    window_s: float = 4.0
    """Least length of the short window [s]."""

    motion_s: float = 10.0
    """It reaches back to the beginning of every motion that goes on, to so long ago at most [s]:
    how a motion is parted is told from its beginning."""

    rest_s: float = 30.0
    """By how much of its rest the place of a resting body is told [s]: the median of a longer one
    is that of its last part."""

    handing_s: float = 2.0
    """While two end-effectors hold one thing, so long it is awaited who lets go of it [s]: whether
    the other one takes it over depends on that."""

    rules_s: float = 20.0
    """How far back rules see at most [s]; flicker is resolved in windows of 10 s."""

    segments: int = 5
    """So many settled segments of a link are told to the rules again, so that these know what a
    segment follows; fewer where they last longer than ``rules_s``."""

    block_s: float = 5.0
    """Between two measurements of the long window [s]."""

    margin_s: float = 9.0
    """What the long window holds on either side of the block that it settles [s]: the calibration's
    own margin. Nearly all of it is the horizon of extrema of speed, 4 s, twice."""

    def __post_init__(self) -> None:
        """Check that the windows hold what they are to settle.

        Raises:
            CaparError: A window is shorter than what it must hold.
        """
        if min(self.stride_s, self.grain_s, self.settle_s, self.block_s) <= 0.0:
            raise CaparError(
                "live horizons: expected stride, grain, settle and block longer than 0 s"
            )
        longest_s = max(self.settle_s, self.edge_s)
        if self.window_s < 2.0 * (longest_s + self.stride_s):
            raise CaparError(
                f"live horizons: a window of {self.window_s:g} s cannot settle what ended "
                f"{longest_s:g} s ago every {self.stride_s:g} s; expected at least "
                f"{2.0 * (longest_s + self.stride_s):g} s"
            )

    @property
    def whole_s(self) -> float:
        """Length of the long window [s]."""
        return 2.0 * self.margin_s + self.block_s


def horizons_of(calibration: Calibration, *, stride_s: float = 0.45) -> LiveHorizons:
    """The horizons that a calibration calls for: by its margin, its filter, and its rests."""
    known = calibration.horizons
    limits = thresholds_of(calibration)
    settles_s = filter_settles_s(calibration.step_s, limits)
    return LiveHorizons(
        stride_s=stride_s,
        settle_s=settles_s + known.gap_s,
        edge_s=max(limits.rest_begins_s, known.filter_s + known.gap_s),
        margin_s=known.margin_s,
    )


class Teller:
    """Says what segments say, one at a time.

    Args:
        rig: Bodies and agents.
        rules: The rule base, whose files say what primitives are called.
    """

    def __init__(self, rig: Capture, rules: Profile) -> None:
        self._rig = rig
        self._words = primitive_words(primitive_files(rules.added))
        self._objects = tuple(observed_object(each) for each in rig.objects)

    def sentence(self, segment: Segment, facts: Iterable[Fact]) -> str:
        """What was done in a segment; empty where nothing was touched.

        Args:
            segment: The segment.
            facts: Contacts and motions of some time before it.
        """
        if not segment.objects:
            return ""
        told = tuple(each for each in facts if isinstance(each, Touching | Moving | OfAgent))
        return describe(self._observation(segment, told), words=self._words)

    def _observation(self, segment: Segment, facts: Sequence[Fact]) -> Observation:
        sensor = self._rig.sensor(segment.ee)
        owner = self._rig.agent_of(sensor)
        agent = next(each for each in self._rig.agents if each.name == owner)
        own = replace(segment, index=0)
        return Observation(
            capture=self._rig.name,
            profile="",
            rules="",
            version=__version__,
            agent=agent,
            duration_s=segment.end_s,
            rate_hz=1.0,
            frames=segment.last + 1,
            objects=self._objects,
            links=(ObservedLink(segment.ee, sensor.end_effector, sensor.side, (own,)),),
            facts=tuple(facts),
            upars=(),
            ipars=(),
            complex_par=ComplexPar("", (), segment.end_s, (), None, ()),
            locations=(),
            styles=(),
            sources=(),
            notices=(),
        )


EDGES = ("starts_moving", "stops_moving")
"""The events at the end of a segment whose frames are known later than others."""

NO_SIDE = "none"
"""The side of an end-effector that is of no limb beside another."""


@dataclass(frozen=True, slots=True)
class Work:
    """What one measurement of the short window cost and held, for those who watch over it."""

    frames: int
    facts: int
    segments: int


class LiveObserver:
    """Observes frames as they come.

    Args:
        rig: Bodies, shapes, agents and purposes, as a capture; its poses are not read.
        calibration: What was decided before, from a lead-in or from an earlier take of the rig.
        rules: A rule profile or its name.
        name: What the whole action is called; the rig's name if empty.
        horizons: How far it looks back and how long it waits; None for what the calibration asks.
        keep_result: Whether facts, segments and places are kept for ``finish``; without, memory
            does not grow.
        sentences: Whether each announcement says in plain English what was done.

    Raises:
        CaparError: The rules have a fault, or the horizons do not fit.
    """

    def __init__(
        self,
        rig: Capture,
        calibration: Calibration,
        *,
        rules: Profile | str = DEFAULT,
        name: str = "",
        horizons: LiveHorizons | None = None,
        keep_result: bool = True,
        sentences: bool = False,
    ) -> None:
        self.horizons = horizons or horizons_of(calibration)
        self.calibration = calibration
        self.rules = profile(rules) if isinstance(rules, str) else rules
        self._step_s = calibration.step_s
        self._rate_mhz = round(1000.0 / self._step_s)
        self._buffer = FrameBuffer(rig, self._frames(self.horizons.whole_s) + 1)
        self._facts = FactLedger()
        self._sums = CarriedSums()
        self._poses = CarriedPoses(calibration, self._frames(self.horizons.rest_s))
        self._memory = RuleMemory()
        self._asked = RuleProcess(self.rules)
        self._asked.warm((Frames(0, 1), RateMhz(self._rate_mhz)))
        later = self._frames(self.horizons.edge_s) - self._frames(self.horizons.settle_s)
        self._segments = SegmentLedger(self.horizons.segments, dict.fromkeys(EDGES, later))
        self._result = (
            LiveResult(
                rig,
                calibration,
                self.rules,
                name or rig.name,
                rate_mhz=self._rate_mhz,
                rest_frames=self._frames(self.horizons.rest_s),
            )
            if keep_result
            else None
        )
        self._teller = Teller(rig, self.rules) if sentences else None
        shapes = (thing.shape for thing in rig.objects if thing.shape is not None)
        seek_rooms(shapes, thresholds_of(calibration))
        self._answers = EarlierAnswers()
        self._first_motion = FirstMotion(calibration, self._buffer.streams)
        self._stirs = False
        self._lasting: int | None = None
        self._measured = 0
        self._frontier = -1
        self._forgotten = 0
        self.work: Work = Work(0, 0, 0)

    @property
    def bodies(self) -> tuple[str, ...]:
        """The bodies of a frame's rows, in order."""
        return self._buffer.bodies

    @property
    def frames(self) -> int:
        """How many frames were pushed."""
        return self._buffer.count

    def held(self) -> int:
        """How many frames are held at most, however many were pushed."""
        return self._buffer.longest

    @property
    def rules_process(self) -> RuleProcess:
        """What asks the rules, in this process or in others."""
        return self._asked

    @property
    def contradictions(self) -> Contradictions:
        """How often a later answer of the rules differed from what was settled."""
        return self._segments.contradictions

    def push(self, frames: Iterable[Poses]) -> list[SegmentEvent]:
        """Take frames, oldest first, and say what they show; measured once for all of them.

        Raises:
            CaptureError: A frame is of other bodies, or not later than the one before.
        """
        events: list[SegmentEvent] = []
        for poses in frames:
            self._buffer.push(poses)
            self._settle_block()
            self._stirs = self._stirs or self._first_motion.is_seen(poses)
            if self.frames - self._measured >= self._frames(self.horizons.window_s) // 2:
                events += self._evaluate(last=False)
        if self._is_due():
            events += self._evaluate(last=False)
        return events

    def _is_due(self) -> bool:
        """Whether segments are to be sought again, or one that was found is to be settled."""
        since = self.frames - self._measured
        if since >= self._frames(self.horizons.watch_s if self._stirs else self.horizons.stride_s):
            return True
        waits = self._segments.next_due(self._frontier)
        if waits is not None and waits + self._frames(self.horizons.settle_s) < self.frames:
            return True
        return self._lasting is not None and self._lasting < self.frames

    def finish(self) -> tuple[list[SegmentEvent], Observation | None]:
        """Settle everything; no frame follows.

        Raises:
            CaptureError: Fewer than two frames were pushed.
        """
        events = self._evaluate(last=True)
        self._asked.close()
        if self._result is None:
            return events, None
        window = self._buffer.window(self._frames(self.horizons.whole_s) + 1)
        self._result.block(window, window.last)
        return events, self._result.observation(window)

    def _settle_block(self) -> None:
        """Measure the long window once a block, and take what lies in the middle of it."""
        if self._result is None or self.frames % self._frames(self.horizons.block_s):
            return
        window = self._buffer.window(self._frames(self.horizons.whole_s) + 1)
        frontier = window.last - self._frames(self.horizons.margin_s)
        if frontier > self._result.frontier:
            self._result.block(window, frontier)

    def _evaluate(self, *, last: bool) -> list[SegmentEvent]:
        """Measure the short window, and ask the rules over the last few segments."""
        self._measured, self._stirs = self.frames, False
        window = self._window()
        if len(window.capture.times) < 4:
            return []
        frontier = window.last - (0 if last else self._frames(self.horizons.settle_s))
        kept = window.last - (0 if last else self._frames(self.horizons.edge_s))
        bodies = self._poses.bodies(window)
        self._answers.begin(window.first)
        measurements = measured(
            window.capture,
            self.calibration,
            bodies,
            self._sums.since(window),
            answers=self._answers,
            notices=False,
        )
        if kept - self._sums.frame >= self._frames(self.horizons.grain_s):
            self._sums.advance(window, measurements, kept)
        self._poses.advance(window, bodies, kept)
        recent = self._facts.stitched(measurements.facts, window.first)
        inference, count = self._inferred(measurements, recent, window.last)
        handling = self._handling(measurements, recent, window)
        sure = kept if last else min(kept, handling.sure)
        self._memory.add(self._facts.settle(recent, max(sure, self._facts.frontier)))
        time_s = self._buffer.time_s(window.last)
        self._first_motion.await_(window, awaited(handling))
        events, done = self._segments.take(
            inference,
            now=window.last,
            ended=window.last - self._frames(self.horizons.announce_s),
            frontier=frontier,
            undecided=handling.with_margin(undecided(handling)),
            unseen=handling.with_margin(nameless(handling)),
            rate_hz=self._rate_mhz / 1000.0,
            time_s=time_s,
        )
        self._frontier = frontier
        self._lasting = self._next_lasting(recent, decided_at(handling), window.last)
        if self.frames - self._forgotten >= self._frames(self.horizons.grain_s):
            self._forgotten = self.frames
            self._memory.forget(self._rules_begin(window), self._segments.ends(), self._frames(1.0))
        self.work = Work(len(window.capture.times), count, len(done))
        if self._result is not None:
            self._result.segments(done)
        return self._told(events, recent)

    def _window(self) -> Window:
        """The short window: it begins at a multiple of the grain, before every motion that goes on.

        From the grain before it, so that the place that is left is known.
        """
        grain, newest = self._frames(self.horizons.grain_s), self.frames - 1
        begin = newest - self._frames(self.horizons.window_s)
        moves = self._facts.begin_of((Moving, Displaced))
        if moves is not None:
            begin = min(begin, max(moves - grain, newest - self._frames(self.horizons.motion_s)))
        begin = max(0, begin) // grain * grain
        return self._buffer.window(self.frames - begin)

    def _told(self, events: list[SegmentEvent], recent: list[Observed]) -> list[SegmentEvent]:
        """The announcements with their sentences, where they are asked for."""
        if self._teller is None or not events:
            return events
        facts = (*self._memory, *recent)
        return [
            replace(each, sentence=self._teller.sentence(each.segment, facts)) for each in events
        ]

    def _inferred(
        self, measurements: Measurements, recent: list[Observed], last: int
    ) -> tuple[Inference, int]:
        """What the rules say up to a frame, and over how many facts."""
        always = [
            each
            for each in measurements.facts
            if isinstance(each, Observed)
            and not each.ends()
            and not isinstance(each, Frames | RateMhz)
        ]
        facts: list[Fact] = [Frames(0, last), RateMhz(self._rate_mhz), *always]
        facts += self._memory
        facts += recent
        return self._asked.ask(facts), len(facts)

    def _handling(
        self, measurements: Measurements, recent: list[Observed], window: Window
    ) -> Handling:
        """What is touched, moves and is lost, where later frames may decide."""
        facts = (*self._memory, *recent)
        acting = {sensor.name for sensor in self._buffer.rig.acting}
        fixed = {thing.name for thing in self._buffer.rig.objects if thing.tag is TagType.FIXED}
        lost = {
            name: window.first + int(np.flatnonzero(~body.stream.lost)[-1])
            for name, body in window.capture.bodies.items()
            if body.stream.lost[-1] and not body.stream.lost.all()
        }
        return Handling(
            [fact for fact in facts if isinstance(fact, Touching) and fact.body in acting],
            [fact for fact in facts if isinstance(fact, Moving)],
            {thing.name for thing in self._buffer.rig.objects if thing.tag is TagType.MOBILE},
            last=window.last,
            margin=round(in_frames(times().merge_ms, self._rate_mhz / 1000.0)),
            longest=self._frames(self.horizons.handing_s),
            lost=lost,
            swings=[fact for fact in facts if isinstance(fact, Swings)],
            leans=[fact for fact in facts if isinstance(fact, Leans)],
            displaced=[fact for fact in facts if isinstance(fact, Displaced)],
            stroke=self._frames(thresholds_of(self.calibration).swing_s),
            fresh=self._frames(self.horizons.fresh_s),
            lingering=self._lingering(measurements, facts, lost, window),
            arriving={
                thing: replace(rest, first=window.first + rest.first)
                for thing, rest in measurements.arriving.items()
            },
            fast={
                (fact.body, fact.other, fact.first)
                for fact in facts
                if isinstance(fact, ClosingSpeed) and fact.speed >= times().blow_mm_s
            },
            laid=[fact for fact in facts if isinstance(fact, Touching) and fact.other in fixed],
            limbs={
                sensor.name: (self._buffer.rig.agent_of(sensor), sensor.side)
                for sensor in self._buffer.rig.acting
                if sensor.side != NO_SIDE
            },
        )

    def _lingering(
        self,
        measurements: Measurements,
        facts: Iterable[Observed],
        lost: Mapping[str, int],
        window: Window,
    ) -> dict[tuple[str, str], int]:
        """Bodies that may be said to have touched on, and when they were last seen to touch.

        Args:
            measurements: What was measured in the window.
            facts: Facts up to the newest frame.
            lost: Of each body that is not seen now, the last frame in which it was.
            window: The last frames.
        """
        oldest = window.last - self._frames(self.horizons.near_s)
        near = ((pair, window.first + at) for pair, at in measurements.lingering.items())
        out = {pair: at for pair, at in near if at >= oldest}
        unseen = window.last - self._frames(self.horizons.handing_s)
        for fact in facts:
            if isinstance(fact, Touching):
                since = max(lost.get(fact.body, -1), lost.get(fact.other, -1))
                if max(fact.first, unseen) <= since <= fact.last:
                    out[fact.body, fact.other] = since
        return out

    def _next_lasting(
        self, recent: Iterable[Observed], decided: Iterable[int], last: int
    ) -> int | None:
        """The next frame at which something has lasted long enough to be told; None without.

        Of rests only those count in which nothing is touched: only they are told.

        Args:
            recent: Facts up to the newest frame.
            decided: Frames at which more is known than by rests and stands.
            last: The newest frame.
        """
        rate_hz = self._rate_mhz / 1000.0
        least = {
            Resting: in_frames(times().rest_ms, rate_hz),
            Bears: in_frames(times().one_leg_ms, rate_hz),
        }
        late = self._frames(self.horizons.lasts_s)
        going = [fact for fact in recent if fact.ends()[-1:] == (last,) and not _in_part(fact)]
        touching = {fact.body for fact in going if isinstance(fact, Touching)}
        frames = (
            fact.ends()[0] + round(least[type(fact)]) + late
            for fact in going
            if type(fact) in least and not (isinstance(fact, Resting) and fact.ee in touching)
        )
        return min((frame for frame in (*frames, *decided) if frame > last), default=None)

    def _rules_begin(self, window: Window) -> int:
        oldest = window.last - self._frames(self.horizons.rules_s)
        return max(0, oldest, self._segments.first_needed(window.last))

    def _frames(self, duration_s: float) -> int:
        return max(1, round(duration_s / self._step_s))


def _in_part(fact: Observed) -> bool:
    """Whether it tells that a foot bears a part of the weight, which no rule asks to last."""
    return isinstance(fact, Bears) and fact.share == PART
