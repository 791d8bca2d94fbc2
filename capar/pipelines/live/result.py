"""The observation of a live recording, put together block by block as it is settled.

What grows with the recording lies on disk until it ends: poses, facts, and what is measured of
segments. In memory there remain, of each settled segment, its ends.
"""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from jaxtyping import Float

from capar import __version__
from capar.model.calibration import Calibration
from capar.model.capture import Capture, Notice, notice
from capar.model.errors import CaptureError
from capar.model.facts import MEASURED, Fact, Frames, Observed, RateMhz, SweptAzimuth
from capar.model.locations import SampledTrack
from capar.model.observation import Observation, ObservedObject, Segment
from capar.pipelines.live.carried_poses import CarriedPoses
from capar.pipelines.live.carried_sums import CarriedSums
from capar.pipelines.live.fact_ledger import FactLedger
from capar.pipelines.live.frames import Window
from capar.pipelines.live.recording_file import PosesFile, ValuesFile
from capar.pipelines.live.segment_details import SegmentDetails, segment_details
from capar.pipelines.live.segment_ledger import SettledSegment
from capar.pipelines.observation import flicker_notices, unmoved_notices
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import Profile
from capar_rules.movers.movers import movers
from capar_rules.pars.inference import Key, infer
from capar_rules.pars.pars import compose, ipars, naming_rules, upars
from extractors.bodies.bodies import Bodies, observed_object
from extractors.contact.contacts import EarlierAnswers
from extractors.forces.forces import force_styles
from extractors.measure import Measurements, measured
from extractors.relations.guides import guide_location
from extractors.relations.places import without_small_sweeps
from extractors.segments import track_of


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
