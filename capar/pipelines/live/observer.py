"""The live observer: frames in, announcements out, and at the end an observation."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

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
    RateMhz,
    Resting,
    Swings,
    Touching,
)
from capar.model.observation import Observation
from capar.pipelines.live.carried_poses import CarriedPoses
from capar.pipelines.live.carried_sums import CarriedSums
from capar.pipelines.live.events import SegmentEvent
from capar.pipelines.live.fact_ledger import FactLedger
from capar.pipelines.live.first_motion import FirstMotion
from capar.pipelines.live.frames import FrameBuffer, Poses, Window
from capar.pipelines.live.horizons import LiveHorizons, horizons_of
from capar.pipelines.live.result import LiveResult
from capar.pipelines.live.rule_memory import RuleMemory
from capar.pipelines.live.rule_process import RuleProcess
from capar.pipelines.live.segment_ledger import Contradictions, SegmentLedger
from capar.pipelines.live.sentences import Teller
from capar.pipelines.live.undecided import Handling, awaited, decided_at, nameless, undecided
from capar_rules.borders.ticks import in_frames, times
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.pars.inference import Inference
from extractors.calibration import thresholds_of
from extractors.contact.contacts import EarlierAnswers
from extractors.measure import Measurements, measured
from extractors.relations.places import seek_rooms
from extractors.relations.support import PART

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
