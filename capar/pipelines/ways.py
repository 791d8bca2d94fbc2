"""What recordings do with one hand and one thing: what a preparation can be made of."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property

from capar.export.plans import PlanExportError, PlanSource, PlanStep, plan_source
from capar.model.observation import Observation
from capar.model.par import Upar
from capar.pipelines.observation import observe
from capar.pipelines.recordings import Recording
from capar.pipelines.round_trips import by_hand, observed_source
from capar.regeneration.completing import Completion, completed
from capar.regeneration.contact_tables import HEAD, Asserted, contacts_of
from capar.regeneration.errors import PlanError
from capar.regeneration.sources import Source, source_of

MARGIN_S = 0.3
"""So long a contact is kept before a step that ends it, or after one that makes it [s]."""

Open = Callable[[Recording], Source]
"""Observes a recording, so that it can be performed."""


@dataclass(frozen=True, eq=False)
class Way:
    """A recording of one hand that handles one thing, and else at most what that stands on."""

    recording: Recording
    source: Source
    side: str
    part: str
    """The thing that the hand handles."""

    steps: tuple[PlanStep, ...]

    @cached_property
    def last(self) -> int:
        """The recording's last frame."""
        return len(self.source.times) - 1

    def relations(self, number: int) -> dict[str, tuple[str, str]]:
        """The bits of a step before and after it: of ``touch``, and of ``stand`` if it has any.

        Args:
            number: Of the step.
        """
        features = self.steps[number].ipar.core.constraint.features
        found = {"touch": (features.rel_start[0], features.rel_end[0])}
        if features.count > 1:
            place = features.count
            found["stand"] = (features.rel_start[place], features.rel_end[place])
        return found

    def moves(self, number: int) -> bool:
        """Whether a step moves the thing."""
        return self.steps[number].moves

    def frame(self, number: int) -> int:
        """The frame at which a step begins; of one past the last, the recording's last frame."""
        if number == len(self.steps):
            return self.last
        return round(self.steps[number].step.begin * self.last)

    def part_of(self, first: int, last: int, side: str) -> Source:
        """Some steps of it, one after the other, with a hand.

        Args:
            first: Number of the first step.
            last: Number of the last one.
            side: Of the hand.

        Raises:
            PlanError: What is cut out does not determine a performance.
        """
        source, margin = self.source, round(MARGIN_S * self.source.rate_hz)
        lead = margin if first and self.relations(first)["touch"] == ("1", "0") else 0
        tail = margin if self.relations(last)["touch"] == ("0", "1") else 0
        begin = self.frame(first) - lead if first else 0
        ends = max(begin, 0), min(self.frame(last + 1) + tail, self.last)
        if ends != (0, self.last):
            source = _cut(source, *(float(source.capture.times[frame]) for frame in ends))
        return by_hand(source, side) if any(h.side != side for h in source.holds) else source


def ways_of(recordings: Iterable[Recording], open_source: Open) -> tuple[Way, ...]:
    """The recordings among some in which one hand handles one thing and nothing else is done.

    Args:
        recordings: What can be performed.
        open_source: Observes one.
    """
    found = []
    for recording in recordings:
        acting = {s.ee for s in recording.steps if s.ee.endswith("_hand") and len(s.objects)}
        handled = {step.objects[0] for step in recording.steps}
        if len(acting) == 1 and len(handled) == 1:
            found += _way(recording, open_source)
    return tuple(found)


def _way(recording: Recording, open_source: Open) -> list[Way]:
    try:
        source = open_source(recording)
        plan = steps_of(source.observation)
    except (PlanError, PlanExportError):
        return []
    alone = source.launches or source.tosses
    if source.poises or source.meetings or alone or not source.holds:
        return []
    side = source.holds[0].side
    steps = tuple(step for step in plan.links[source.hands[side].sensor] if step.ipar.objects)
    things = {name for step in steps for name in step.ipar.objects}
    if not things <= set(source.scene.things):
        return []
    return [Way(recording, source, side, source.holds[0].thing, steps)]


def opened(recording: Recording) -> Source:
    """A recording, ready to be performed.

    Raises:
        PlanError: The capture does not determine a performance.
    """
    return observed_source(recording.capture)


def steps_of(observation: Observation) -> PlanSource:
    """The steps of an observed action with their PARs.

    Raises:
        PlanExportError: It has no steps.
    """
    par = observation.complex_par
    upars: tuple[Upar, ...] = observation.upars
    return plan_source(par, observation.ipars, upars, {}, name=par.name)


def asserted(source: Source) -> list[Asserted]:
    """What the steps of a performance assert at their ends, in order of time.

    Args:
        source: What is performed.
    """
    names = {name: name for name in source.paths} | {HEAD: HEAD}
    names |= {hand.sensor: side for side, hand in source.hands.items()}
    last = len(source.times) - 1
    found = []
    for steps in steps_of(source.observation).links.values():
        for one in steps:
            frame = round((one.step.begin + one.step.share) * last)
            contacts = contacts_of(one.ipar.post_assertions, names)
            found.append(Asserted(one.step.action, frame, contacts, one.ipar.core.moved))
    return sorted(found, key=lambda step: step.frame)


def _cut(source: Source, from_s: float, to_s: float) -> Source:
    """A part of what was recorded, by a performer who stands where the whole one did."""
    scene = source.scene
    capture = completed(source.capture, Completion(from_s=from_s, to_s=to_s))
    observation = observe(capture, rules=source.observation.profile)
    stance = (scene.place, scene.heading)
    made = source_of(capture, observation, stance=stance, floor_m=scene.floor_m)
    return replace(made, notes=source.notes)
