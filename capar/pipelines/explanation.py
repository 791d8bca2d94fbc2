"""The pipeline from a capture to reasons: observe it, then say why, and why not."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from capar.model.body_names import body_names
from capar.model.capture import Capture
from capar.model.errors import RuleError, UnknownNameError
from capar.model.observation import Observation, Segment, SegmentAddress, find_segment
from capar.pipelines.measures import Measures, Series
from capar.pipelines.observation import observe_measured
from capar.pipelines.trials import trial_of
from capar.views.explanation_plot import Panel, Plot
from capar_rules.authoring.user_primitives import rules_of
from capar_rules.borders.ticks import times
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.explain.conditions import Condition, Measured
from capar_rules.explain.explanation import Explainer, Explanation
from capar_rules.explain.nearest import NearRule
from capar_rules.explain.quantities import QUANTITIES
from extractors.measure import measure

AROUND_S = 1.0
"""So long before and after the segment is drawn [s]."""

SAMPLES = 120
"""Distances of surfaces are drawn at so many frames at most, and at those that decide [1]."""

_SEGMENT = re.compile(r"seg\((\w+),(\d+)\)")


@dataclass(frozen=True, eq=False)
class Explained:
    """A capture that was observed, and what explains its segments."""

    observation: Observation
    explainer: Explainer
    measures: Measures

    def explain(self, segments: Sequence[Segment]) -> tuple[Explanation, ...]:
        """Why segments have their names, with what was measured for each condition.

        Raises:
            RuleError: A segment does not follow from the facts and rules.
        """
        return tuple(
            replace(
                told,
                conditions=self._filled(told.conditions),
                nearest=told.nearest
                and replace(told.nearest, failing=self._filled(told.nearest.failing)),
            )
            for told in self.explainer.explain_all(segments)
        )

    def why_not(self, segment: Segment, name: str) -> list[NearRule]:
        """The rule that comes nearest to giving a segment another name, with what it lacks.

        Nothing where every rule for the name lacks more than ``MOST_ASKED`` conditions.

        Raises:
            UnknownNameError: No rule gives that name.
            RuleError: The segment has that name, or does not follow from the facts and rules.
        """
        names = {rule.name for rule in rules_of(self.explainer.profile)}
        if name not in names:
            raise UnknownNameError("primitive", name, names)
        if name == segment.name:
            raise RuleError(f"segment {segment.index} of {segment.ee!r} is {name} already")
        found = self.explainer.nearest_rules(segment, name)
        return [replace(one, failing=self._filled(one.failing)) for one in found]

    def _filled(self, conditions: Sequence[Condition]) -> tuple[Condition, ...]:
        return tuple(map(self.measures.completed, conditions))

    @cached_property
    def unshaped(self) -> set[str]:
        """The bodies without a shape."""
        bodies = self.measures.measurements.bodies
        every = {**bodies.objects, **bodies.sensors}
        return {name for name, body in every.items() if body.shape is None}

    @cached_property
    def _definitions(self) -> dict[str, str]:
        return {rule.name: rule.definition for rule in rules_of(self.explainer.profile)}

    def definitions(self, told: Explanation) -> dict[str, str]:
        """What the names are of which a summary speaks, as the heads of their rule files say it."""
        near = (told.nearest.name,) if told.nearest else ()
        names = dict.fromkeys((told.name, *told.general, *near))
        return {name: self._definitions[name] for name in names if name in self._definitions}


def explained(capture: Capture, *, rules: Profile | str) -> Explained:
    """Observe a capture and make ready to explain it.

    Raises:
        CaparError: The capture or the rules have a fault.
    """
    measurements = measure(capture)
    base = profile(rules) if isinstance(rules, str) else rules
    observation = observe_measured(capture, measurements, rules=base)
    explainer = Explainer(observation.facts, base, body_names(observation))
    return Explained(observation, explainer, Measures(observation, measurements))


def explain(
    capture: Capture | Path | str, segment: str = "", *, rules: Profile | str = DEFAULT
) -> tuple[Explanation, ...]:
    """Say why segments of a capture have their names: the rules and facts behind each.

    Args:
        capture: A capture, or where to read it.
        segment: ``right_hand/3`` for one, ``right_hand`` for all of an end-effector; all if empty.
        rules: A rule profile or its name.

    Raises:
        UnknownNameError: There is no such segment.
        CaparError: The capture or the rules have a fault.
    """
    seen = explained(trial_of(capture), rules=rules)
    return seen.explain(chosen(seen.observation, segment))


def why_not(
    capture: Capture | Path | str, segment: str, name: str, *, rules: Profile | str = DEFAULT
) -> list[NearRule]:
    """The rule that comes nearest to giving a segment of a capture another name.

    Args:
        capture: A capture, or where to read it.
        segment: Such as ``right_hand/3``.
        name: The name that it has not.
        rules: A rule profile or its name.

    Raises:
        UnknownNameError: There is no such segment, or no rule gives that name.
        RuleError: The segment has that name.
    """
    seen = explained(trial_of(capture), rules=rules)
    return seen.why_not(segment_named(seen.observation, segment), name)


def chosen(observation: Observation, text: str) -> tuple[Segment, ...]:
    """The segments that a user names: one, all of an end-effector, or all if the text is empty.

    Raises:
        UnknownNameError: There is no such segment.
    """
    own = tuple(each for each in observation.segments if not text or each.ee == text)
    return own or (segment_named(observation, text),)


def segments_in(seen: Explained, atom: str) -> tuple[str, ...]:
    """The segments that an atom refers to, as a user names them: ``right_hand/3``.

    Rules name a segment by the tick where it begins, which is no index.
    """
    known = {
        (each.ee, each.first): str(SegmentAddress(each.ee, each.index))
        for each in seen.observation.segments
    }
    found = []
    for ee, tick in _SEGMENT.findall(atom):
        frames = seen.explainer.windows.frames.get(ee, [])
        name = known.get((ee, frames[int(tick)])) if int(tick) < len(frames) else None
        found += [name] if name else []
    return tuple(dict.fromkeys(found))


def segment_named(observation: Observation, text: str) -> Segment:
    """The segment of an observation at an address such as ``right_hand/3``.

    Raises:
        AddressError: The text is no address.
        UnknownNameError: There is no segment at it.
    """
    address = SegmentAddress.parse(text)
    return find_segment(observation.links, address, capture=observation.capture)


def explanation_plot(seen: Explained, told: Explanation) -> Plot:
    """The quantities of an explanation's conditions, and of the nearest other name, over time."""
    observation, measures = seen.observation, seen.measures
    segment = segment_named(observation, str(SegmentAddress(told.ee, told.index)))
    rate = observation.rate_hz
    around = round(AROUND_S * rate)
    first, last = max(segment.first - around, 0), min(segment.last + around, observation.frames - 1)
    near = told.nearest.failing if told.nearest else ()
    groups: dict[tuple[object, ...], list[Measured]] = {}
    for one in dict.fromkeys(each for row in (*told.conditions, *near) for each in row.measures):
        start = one.first if one.quantity not in ("distance", "closing", "push") else segment.first
        groups.setdefault((one.quantity, one.bodies, start), []).append(one)
    panels = []
    for every in groups.values():
        frames = np.arange(first, last + 1)
        if every[0].quantity == "distance":
            ends = [frame for one in every for frame in (one.first, one.last)]
            frames = np.unique([*frames[:: math.ceil(len(frames) / SAMPLES)], *ends, last])
        series = measures.series(every[0], frames)
        if series is not None:
            panels.append(_panel(every, series, rate))
    return Plot(
        f"{SegmentAddress(told.ee, told.index)}  {told.name}  "
        f"{told.start_s:.2f} to {told.end_s:.2f} s",
        told.summary,
        (first / rate, last / rate),
        (segment.first / rate, segment.last / rate),
        tuple(
            (one.first / rate, one.last / rate, one.name)
            for one in observation.segments
            if one.ee == told.ee
        ),
        tuple(panels),
    )


def _panel(every: Sequence[Measured], series: Series, rate_hz: float) -> Panel:
    """The panel of what conditions measure of one quantity of certain bodies."""
    first = every[0]
    scale, unit = QUANTITIES[first.quantity].scale, first.unit
    marks: dict[tuple[float, float, str], None] = {}
    for one in every:
        if one.value is not None:
            # Where the curve has the value, near the frame that counts: rules compare some
            # quantities at an event that is merged with the border.
            frame = series.frame(one.first, one.last)
            away = np.abs(series.frames - frame)
            off = np.abs(series.values * scale - one.value)
            off[(away > times().merge_ms / 1000.0 * rate_hz) | np.isnan(off)] = np.inf
            if np.isfinite(off).any():
                frame = int(series.frames[np.lexsort((away, off))[0]])
            marks[frame / rate_hz, one.value, one.value_text] = None
    return Panel(
        f"{first.label} [{unit}]" if unit else first.label,
        series.frames / rate_hz,
        series.values * scale,
        unit,
        tuple(sorted({(o.limit, o.limit_text) for o in every if o.limit is not None})),
        tuple(marks),
        tuple((begin / rate_hz, end / rate_hz) for begin, end in series.bars),
        series.held,
    )
