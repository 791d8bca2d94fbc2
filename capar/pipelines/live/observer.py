"""The live observer: frames in, announcements out, and at the end an observation."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from capar import __version__
from capar.model.calibration import Calibration
from capar.model.capture import Capture, TagType
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
from capar.pipelines.live.decided_until import Handling, decided_at, nameless, undecided
from capar.pipelines.live.frames import FrameBuffer, Poses, Window
from capar.pipelines.live.ledgers import FactLedger, RuleMemory, SegmentEvent, SegmentLedger
from capar.pipelines.live.rule_process import RuleProcess
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


# How far live observation looks back, and how long it waits before it settles anything [s].
STRIDE_S = 0.45  # Between measurements at most; one more when a found segment is to be settled.
GRAIN_S = 1.0  # Windows begin at multiples: what their first frame shows is known several times.
ANNOUNCE_S = 0.4  # After its end a segment is announced: ends that are newer still move.
LASTS_S = 0.1  # How much later than a rule asks for something is taken to have lasted.
FRESH_S = 0.2  # A motion that has just begun may turn out to be none: a glitch, or the filter's.
NEAR_S = 0.9  # It is awaited whether bodies touch again that have stayed near each other.
WINDOW_S = 4.0  # Least length of the window.
DEPARTS_S = 1.5  # The true end of a rest is known by the motion after it: at most so much later,
OFF_M = 0.05  # ... or when the end-effector is this far from where it rested.
MOTION_S = 10.0  # It reaches back to the beginning of motions that go on, to so long ago at most.
REST_S = 30.0  # The place of a resting body is the median of so much of its rest.
HANDING_S = 2.0  # While two end-effectors hold one object, it is awaited who lets go of it.
RULES_S = 20.0  # How far back rules see at most; flicker is resolved in windows of 10 s.
SEGMENTS = 5  # Settled segments of a link that rules see again, to know what a segment follows.


class LiveObserver:
    """Observes frames as they come.

    Args:
        rig: Bodies, shapes, agents and purposes, as a capture; its poses are not read.
        calibration: What was decided before, from a lead-in or from an earlier take of the rig.
        rules: A rule profile or its name.
        name: What the whole action is called; the rig's name if empty.
        sentences: Whether each announcement says in plain English what was done.

    Raises:
        CaparError: The rules have a fault.
    """

    def __init__(
        self,
        rig: Capture,
        calibration: Calibration,
        *,
        rules: Profile | str = DEFAULT,
        name: str = "",
        sentences: bool = False,
    ) -> None:
        self.calibration = calibration
        known, limits = calibration.horizons, thresholds_of(calibration)
        self.rules = profile(rules) if isinstance(rules, str) else rules
        self._name = name or rig.name
        self._step_s = calibration.step_s
        self._rate_mhz = round(1000.0 / self._step_s)
        longest = self._frames(MOTION_S) + self._frames(GRAIN_S) + 1
        self._buffer = FrameBuffer(rig, longest)
        # Later frames change less than a millionth of a smoothed pose, and short losses are filled;
        # at whose end an object starts or stops, that is found by how its path grew.
        self._settle = self._frames(filter_settles_s(self._step_s, limits) + known.gap_s)
        self._edge = self._frames(max(limits.rest_begins_s, known.filter_s + known.gap_s))
        self._facts = FactLedger()
        self._carried = Carried(calibration, self._frames(REST_S))
        self._memory = RuleMemory()
        self.rules_process = RuleProcess(self.rules)
        """What asks the rules, in this process or in others."""

        self.rules_process.warm((Frames(0, 1), RateMhz(self._rate_mhz)))
        later = self._edge - self._settle
        self._segments = SegmentLedger(SEGMENTS, dict.fromkeys(EDGES, later))
        self._words = primitive_words(primitive_files(self.rules.added)) if sentences else None
        seek_rooms((each.shape for each in rig.objects if each.shape), limits)
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
            if self.frames - self._measured >= self._frames(WINDOW_S) // 2:
                events += self._evaluate(last=False)
        if self._is_due():
            events += self._evaluate(last=False)
        return events

    def finish(self) -> tuple[list[SegmentEvent], Observation]:
        """Settle everything, and observe the whole recording; no frame follows.

        Raises:
            CaptureError: Fewer than two frames were pushed.
        """
        events = self._evaluate(last=True)
        self.rules_process.close()
        capture = self.recording()
        measurements = measure(capture, self.calibration)
        return events, observe_measured(capture, measurements, rules=self.rules, name=self._name)

    def recording(self) -> Capture:
        """Every frame that was pushed, as a capture.

        Raises:
            CaptureError: There are fewer than two.
        """
        return self._buffer.recording()

    def _is_due(self) -> bool:
        """Whether segments are to be sought again, or one that was found is to be settled."""
        since = self.frames - self._measured
        if since >= self._frames(STRIDE_S):
            return True
        waits = self._segments.next_due(self._frontier)
        if waits is not None and waits + self._settle < self.frames:
            return True
        return self._lasting is not None and self._lasting < self.frames

    def _evaluate(self, *, last: bool) -> list[SegmentEvent]:
        """Measure the window, and ask the rules over the last few segments."""
        self._measured = self.frames
        window = self._window()
        if len(window.capture.times) < 4:
            return []
        frontier = window.last - (0 if last else self._settle)
        kept = window.last - (0 if last else self._edge)
        bodies = self._carried.bodies(window)
        measurements = measured(
            window.capture,
            self.calibration,
            bodies,
            self._carried.sums(window),
            notices=False,
        )
        grain = self._frames(GRAIN_S)
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
        events = self._segments.take(
            inference,
            now=window.last,
            ended=window.last - self._frames(ANNOUNCE_S),
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
            oldest = window.last - self._frames(RULES_S)
            begin = max(0, oldest, self._segments.first_needed(window.last))
            self._memory.forget(begin, self._segments.ends(), self._frames(1.0))
        if self._words is None:
            return events
        return [replace(each, sentence=self._sentence(each.segment, told)) for each in events]

    def _window(self) -> Window:
        """The last frames, from a multiple of the grain and before every motion that goes on.

        From the grain before it, so that the place that is left is known.
        """
        grain, newest = self._frames(GRAIN_S), self.frames - 1
        begin = newest - self._frames(WINDOW_S)
        moves = self._facts.begin_of((Moving, Displaced))
        if moves is not None:
            begin = min(begin, max(moves - grain, newest - self._frames(MOTION_S)))
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
            longest=self._frames(HANDING_S),
            lost=lost,
            swings=[fact for fact in facts if isinstance(fact, Swings)],
            leans=[fact for fact in facts if isinstance(fact, Leans)],
            displaced=[fact for fact in facts if isinstance(fact, Displaced)],
            stroke=self._frames(thresholds_of(self.calibration).swing_s),
            fresh=self._frames(FRESH_S),
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
            rested=[
                fact
                for fact in facts
                if isinstance(fact, Resting) and not _is_off(fact, measurements, window.first)
            ],
            departs=self._frames(DEPARTS_S),
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
        oldest = window.last - self._frames(NEAR_S)
        near = ((pair, window.first + at) for pair, at in measurements.lingering.items())
        out = {pair: at for pair, at in near if at >= oldest}
        unseen = window.last - self._frames(HANDING_S)
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
        """
        rate_hz = self._rate_mhz / 1000.0
        least = {
            Resting: in_frames(times().rest_ms, rate_hz),
            Bears: in_frames(times().one_leg_ms, rate_hz),
        }
        late = self._frames(LASTS_S)
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


def _is_off(rest: Resting, measurements: Measurements, begin: int) -> bool:
    """Whether an end-effector has gone so far since a rest that it is clear when that ended."""
    track = measurements.tracks.get(rest.ee)
    if track is None or rest.last < begin:
        return True
    since = track.positions[rest.last - begin :]
    return bool((np.linalg.norm(since - since[0], axis=1) > OFF_M).any())
