"""The live observer: frames in, announcements out, and at the end an observation."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from capar import __version__
from capar.model.calibration import Calibration
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
from capar.pipelines.live.carried import Carried
from capar.pipelines.live.frames import FrameBuffer, Poses, Window, body_rows
from capar.pipelines.live.ledgers import FactLedger, RuleMemory, SegmentEvent, SegmentLedger
from capar.pipelines.live.rule_process import RuleProcess
from capar.pipelines.live.undecided import Handling, awaited, decided_at, nameless, undecided
from capar.pipelines.observation import observe_measured
from capar_rules.borders.ticks import in_frames, times
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from extractors.bodies.bodies import observed_object
from extractors.calibration import thresholds_of
from extractors.measure import Measurements, measure, measured
from extractors.relations.places import seek_rooms
from extractors.relations.support import PART
from extractors.signals.filters import filter_settles_s
from kb.language.describe import describe

EDGES = ("starts_moving", "stops_moving")
"""The events at the end of a segment whose frames are known later than others."""


@dataclass(frozen=True, slots=True)
class LiveHorizons:
    """How far live observation looks back, and how long it waits before it settles anything.

    Attributes:
        stride_s: Between two measurements of the window at most [s]; it is measured once more as
            soon as a segment that was found is to be settled.
        grain_s: Windows begin at multiples of this [s]: what is measured at their first frame is
            then the same several times in a row, and is known.
        watch_s: Between two measurements at least [s], where an object moves whose motion is
            awaited.
        announce_s: After its end a segment is announced [s]: ends that are newer still move, as
            much of what the filter asks for has not been seen.
        settle_s: After its end a segment is settled [s]: what later frames change in a smoothed
            pose after 0.4 s is less than a millionth of its path, and losses that are shorter than
            0.1 s are filled. That is also longer than contacts that are dropped and gaps that are
            closed (0.1 s).
        edge_s: After its end a segment is settled at whose end an object starts or stops [s]: when
            it started is found by how its path grew until it was well beyond its floor.
        lasts_s: How much later than a rule asks for something is taken to have lasted [s].
        fresh_s: How long a motion that has just begun may turn out to be none [s]: a glitch of the
            tracker, or what the filter makes of the last frames.
        near_s: How long it is awaited whether bodies touch again that have stayed near each other
            [s].
        window_s: Least length of the window [s].
        motion_s: It reaches back to the beginning of every motion that goes on, to so long ago at
            most [s]: how a motion is divided is known from its beginning.
        rest_s: The place of a resting body is the median of so much of its rest [s].
        handing_s: While two end-effectors hold one object, so long it is awaited who lets go of it
            [s].
        rules_s: How far back rules see at most [s]; flicker is resolved in windows of 10 s.
        segments: How many settled segments of a link rules are told again, so that they know what a
            segment follows; fewer where they last longer than ``rules_s``.
    """

    stride_s: float = 0.45
    grain_s: float = 1.0
    watch_s: float = 0.05
    announce_s: float = 0.4
    settle_s: float = 0.5
    edge_s: float = 0.75
    lasts_s: float = 0.1
    fresh_s: float = 0.2
    near_s: float = 0.9
    window_s: float = 4.0
    motion_s: float = 10.0
    rest_s: float = 30.0
    handing_s: float = 2.0
    rules_s: float = 20.0
    segments: int = 5

    def __post_init__(self) -> None:
        """Check that the window holds what it is to settle.

        Raises:
            CaparError: It is shorter than what it must hold.
        """
        if min(self.stride_s, self.grain_s, self.settle_s) <= 0.0:
            raise CaparError("live horizons: expected stride, grain and settle longer than 0 s")
        longest_s = max(self.settle_s, self.edge_s)
        if self.window_s < 2.0 * (longest_s + self.stride_s):
            raise CaparError(
                f"live horizons: a window of {self.window_s:g} s cannot settle what ended "
                f"{longest_s:g} s ago every {self.stride_s:g} s; expected at least "
                f"{2.0 * (longest_s + self.stride_s):g} s"
            )


def horizons_of(calibration: Calibration) -> LiveHorizons:
    """The horizons that a calibration calls for: by its filter and its rests."""
    known = calibration.horizons
    limits = thresholds_of(calibration)
    return LiveHorizons(
        settle_s=filter_settles_s(calibration.step_s, limits) + known.gap_s,
        edge_s=max(limits.rest_begins_s, known.filter_s + known.gap_s),
    )


class LiveObserver:
    """Observes frames as they come.

    Args:
        rig: Bodies, shapes, agents and purposes, as a capture; its poses are not read.
        calibration: What was decided before, from a lead-in or from an earlier take of the rig.
        rules: A rule profile or its name.
        name: What the whole action is called; the rig's name if empty.
        horizons: How far it looks back and how long it waits; None for what the calibration asks.
        keep_result: Whether frames are kept on disk for ``finish``.
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
        self._name = name or rig.name
        self._step_s = calibration.step_s
        self._rate_mhz = round(1000.0 / self._step_s)
        longest = self._frames(self.horizons.motion_s) + self._frames(self.horizons.grain_s) + 1
        self._buffer = FrameBuffer(rig, longest, kept=keep_result)
        self._facts = FactLedger()
        self._carried = Carried(calibration, self._frames(self.horizons.rest_s))
        self._memory = RuleMemory()
        self.rules_process = RuleProcess(self.rules)
        """What asks the rules, in this process or in others."""

        self.rules_process.warm((Frames(0, 1), RateMhz(self._rate_mhz)))
        later = self._frames(self.horizons.edge_s) - self._frames(self.horizons.settle_s)
        self._segments = SegmentLedger(self.horizons.segments, dict.fromkeys(EDGES, later))
        self._words = primitive_words(primitive_files(self.rules.added)) if sentences else None
        seek_rooms((each.shape for each in rig.objects if each.shape), thresholds_of(calibration))
        self._first_motion = FirstMotion(calibration, body_rows(rig))
        self._stirs = False
        self._lasting: int | None = None
        self._measured = 0
        self._frontier = -1
        self._forgotten = 0

    @property
    def frames(self) -> int:
        """How many frames were pushed."""
        return self._buffer.count

    def push(self, frames: Iterable[Poses]) -> list[SegmentEvent]:
        """Take frames, oldest first, and say what they show; measured once for all of them.

        Raises:
            CaptureError: A frame is of other bodies, or not later than the one before.
        """
        events: list[SegmentEvent] = []
        for poses in frames:
            self._buffer.push(poses)
            self._stirs = self._stirs or self._first_motion.is_seen(poses)
            if self.frames - self._measured >= self._frames(self.horizons.window_s) // 2:
                events += self._evaluate(last=False)
        if self._is_due():
            events += self._evaluate(last=False)
        return events

    def finish(self) -> tuple[list[SegmentEvent], Observation | None]:
        """Settle everything, and observe the whole recording; no frame follows.

        Raises:
            CaptureError: Fewer than two frames were pushed.
        """
        events = self._evaluate(last=True)
        self.rules_process.close()
        capture = self._buffer.recording()
        if capture is None:
            return events, None
        measurements = measure(capture, self.calibration)
        return events, observe_measured(capture, measurements, rules=self.rules, name=self._name)

    def _is_due(self) -> bool:
        """Whether segments are to be sought again, or one that was found is to be settled."""
        since = self.frames - self._measured
        if since >= self._frames(self.horizons.watch_s if self._stirs else self.horizons.stride_s):
            return True
        waits = self._segments.next_due(self._frontier)
        if waits is not None and waits + self._frames(self.horizons.settle_s) < self.frames:
            return True
        return self._lasting is not None and self._lasting < self.frames

    def _evaluate(self, *, last: bool) -> list[SegmentEvent]:
        """Measure the window, and ask the rules over the last few segments."""
        self._measured, self._stirs = self.frames, False
        window = self._window()
        if len(window.capture.times) < 4:
            return []
        frontier = window.last - (0 if last else self._frames(self.horizons.settle_s))
        kept = window.last - (0 if last else self._frames(self.horizons.edge_s))
        bodies = self._carried.bodies(window)
        measurements = measured(
            window.capture,
            self.calibration,
            bodies,
            self._carried.sums(window),
            notices=False,
        )
        grain = self._frames(self.horizons.grain_s)
        if kept - self._carried.sums_frame >= grain:
            self._carried.advance_sums(window, measurements, kept)
        self._carried.advance_poses(window, bodies, kept)
        recent = self._facts.stitched(measurements.facts, window.first)
        always = [
            fact
            for fact in measurements.facts
            if isinstance(fact, Observed)
            and not fact.ends()
            and not isinstance(fact, Frames | RateMhz)
        ]
        told = (*self._memory, *recent)
        facts: list[Fact] = [Frames(0, window.last), RateMhz(self._rate_mhz), *always, *told]
        inference = self.rules_process.ask(facts)
        handling = self._handling(measurements, told, window)
        sure = kept if last else min(kept, handling.sure)
        self._memory.add(self._facts.settle(recent, max(sure, self._facts.frontier)))
        self._first_motion.await_(window, awaited(handling))
        events = self._segments.take(
            inference,
            now=window.last,
            ended=window.last - self._frames(self.horizons.announce_s),
            frontier=frontier,
            undecided=handling.with_margin(undecided(handling)),
            unseen=handling.with_margin(nameless(handling)),
            rate_hz=self._rate_mhz / 1000.0,
            time_s=float(window.capture.times[-1]),
        )
        self._frontier = frontier
        self._lasting = self._next_lasting(recent, decided_at(handling), window.last)
        if self.frames - self._forgotten >= grain:
            self._forgotten = self.frames
            oldest = window.last - self._frames(self.horizons.rules_s)
            begin = max(0, oldest, self._segments.first_needed(window.last))
            self._memory.forget(begin, self._segments.ends(), self._frames(1.0))
        if self._words is None:
            return events
        return [replace(each, sentence=self._sentence(each.segment, told)) for each in events]

    def _window(self) -> Window:
        """The last frames, from a multiple of the grain and before every motion that goes on.

        From the grain before it, so that the place that is left is known.
        """
        grain, newest = self._frames(self.horizons.grain_s), self.frames - 1
        begin = newest - self._frames(self.horizons.window_s)
        moves = self._facts.begin_of((Moving, Displaced))
        if moves is not None:
            begin = min(begin, max(moves - grain, newest - self._frames(self.horizons.motion_s)))
        begin = max(0, begin) // grain * grain
        return self._buffer.window(self.frames - begin)

    def _handling(
        self, measurements: Measurements, facts: Sequence[Observed], window: Window
    ) -> Handling:
        """What is touched, moves and is lost, where later frames may decide."""
        rig = self._buffer.rig
        acting = {sensor.name for sensor in rig.acting}
        fixed = {each.name for each in rig.objects if each.tag is TagType.FIXED}
        lost = {
            name: window.first + int(np.flatnonzero(~body.stream.lost)[-1])
            for name, body in window.capture.bodies.items()
            if body.stream.lost[-1] and not body.stream.lost.all()
        }
        return Handling(
            [fact for fact in facts if isinstance(fact, Touching) and fact.body in acting],
            [fact for fact in facts if isinstance(fact, Moving)],
            {each.name for each in rig.objects if each.tag is TagType.MOBILE},
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
                name: replace(rest, first=window.first + rest.first)
                for name, rest in measurements.arriving.items()
            },
            fast={
                (fact.body, fact.other, fact.first)
                for fact in facts
                if isinstance(fact, ClosingSpeed) and fact.speed >= times().blow_mm_s
            },
            laid=[fact for fact in facts if isinstance(fact, Touching) and fact.other in fixed],
            limbs={
                sensor.name: (rig.agent_of(sensor), sensor.side)
                for sensor in rig.acting
                if sensor.side != "none"
            },
        )

    def _lingering(
        self,
        measurements: Measurements,
        facts: Iterable[Observed],
        lost: Mapping[str, int],
        window: Window,
    ) -> dict[tuple[str, str], int]:
        """Bodies whose contact may turn out to have gone on, and when they were last in contact."""
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
        """The next frame at which something has lasted as long as a rule asks for; None without.

        Of rests only those count in which nothing is touched: only they are named. A foot that
        bears a part of the weight is asked for no duration.

        Args:
            recent: Facts up to the newest frame.
            decided: Frames at which more is known for other reasons.
            last: The newest frame.
        """
        rate_hz = self._rate_mhz / 1000.0
        least = {
            Resting: in_frames(times().rest_ms, rate_hz),
            Bears: in_frames(times().one_leg_ms, rate_hz),
        }
        late = self._frames(self.horizons.lasts_s)
        going = [
            fact
            for fact in recent
            if fact.ends()[-1:] == (last,) and not (isinstance(fact, Bears) and fact.share == PART)
        ]
        touching = {fact.body for fact in going if isinstance(fact, Touching)}
        frames = (
            fact.ends()[0] + round(least[type(fact)]) + late
            for fact in going
            if type(fact) in least and not (isinstance(fact, Resting) and fact.ee in touching)
        )
        return min((frame for frame in (*frames, *decided) if frame > last), default=None)

    def _sentence(self, segment: Segment, facts: Sequence[Fact]) -> str:
        """What was done in a segment, in plain English; empty where nothing was touched."""
        if not segment.objects:
            return ""
        rig = self._buffer.rig
        sensor = rig.sensor(segment.ee)
        owner = rig.agent_of(sensor)
        own = replace(segment, index=0)
        alone = Observation(
            capture=rig.name,
            profile="",
            rules="",
            version=__version__,
            agent=next(each for each in rig.agents if each.name == owner),
            duration_s=segment.end_s,
            rate_hz=1.0,
            frames=segment.last + 1,
            objects=tuple(observed_object(each) for each in rig.objects),
            links=(ObservedLink(segment.ee, sensor.end_effector, sensor.side, (own,)),),
            facts=tuple(each for each in facts if isinstance(each, Touching | Moving | OfAgent)),
            upars=(),
            ipars=(),
            complex_par=ComplexPar("", (), segment.end_s, (), None, ()),
            locations=(),
            styles=(),
            sources=(),
            notices=(),
        )
        return describe(alone, words=self._words or ())

    def _frames(self, duration_s: float) -> int:
        return max(1, round(duration_s / self._step_s))


class FirstMotion:
    """Objects whose first motion is awaited: once one moves, something is decided.

    It is asked of the poses as they are recorded, so that the window is measured as soon as there
    is something new to see in it.

    Args:
        calibration: The floor of each object's motion.
        rows: The row of each body in a frame, by ``object NAME``.
    """

    def __init__(self, calibration: Calibration, rows: Mapping[str, int]) -> None:
        self._calibration = calibration
        self._rows = rows
        self._places: list[tuple[int, np.ndarray, np.ndarray, float, float]] = []
        """Row, position, orientation, and the floors [m, rad] of each."""

        limits = thresholds_of(calibration)
        self._least = 1 + round(limits.moving_minimum_s / calibration.step_s)
        self._away = 0

    def await_(self, window: Window, touched: Mapping[str, int]) -> None:
        """Ask of these objects from now on, by the frame at which each was touched first."""
        self._places = []
        for name, frame in touched.items():
            stream, known = window.capture.bodies[name].stream, self._calibration.tag_object(name)
            at = max(frame - window.first, 0)
            row, floors = (
                self._rows[f"object {name}"],
                (known.motion_floor_m, known.motion_floor_rad),
            )
            self._places.append((row, stream.positions[at], stream.orientations[at], *floors))

    def is_seen(self, poses: Poses) -> bool:
        """Whether one of them has moved in a frame, and for as long as makes a motion."""
        left = False
        for row, position, orientation, floor_m, floor_rad in self._places:
            cosine = abs(float(poses.orientations[row] @ orientation))
            left |= float(np.linalg.norm(poses.positions[row] - position)) > floor_m
            left |= 2.0 * float(np.arccos(min(cosine, 1.0))) > floor_rad
        self._away = self._away + 1 if left else 0
        return self._away >= self._least
