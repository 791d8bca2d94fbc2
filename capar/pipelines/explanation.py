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
from capar.model.observation import Observation, Segment, SegmentAddress, find_segment
from capar.pipelines.measures import Measures, Series
from capar.pipelines.observation import observe_measured
from capar.pipelines.trials import trial_of
from capar.views.explanation_plot import Panel, Plot
from capar_rules.authoring.user_primitives import rules_of
from capar_rules.borders.ticks import times
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.explain.conditions import Measured
from capar_rules.explain.explanation import Explainer, Explanation
from capar_rules.explain.nearest import NearRule
from capar_rules.explain.quantities import QUANTITIES
from capar_rules.explain.why_not import Alternative
from capar_rules.explain.why_not import why_not as alternatives
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
        return tuple(map(self._completed, self.explainer.explain_all(segments)))

    def nearest_rules(self, segment: Segment, name: str) -> list[NearRule]:
        """The rule that could give a segment another name, with the conditions that fail.

        Raises:
            RuleError: The segment does not follow from the facts and rules.
        """
        found = self.explainer.nearest_rules(segment, name)
        fill = self.measures.completed
        return [replace(one, failing=tuple(map(fill, one.failing))) for one in found]

    @cached_property
    def unshaped(self) -> set[str]:
        """The bodies without a shape."""
        bodies = self.measures.measurements.bodies
        every = {**bodies.objects, **bodies.sensors}
        return {name for name, body in every.items() if body.shape is None}

    def _completed(self, told: Explanation) -> Explanation:
        near, fill = told.nearest, self.measures.completed
        if near is not None:
            near = replace(near, failing=tuple(map(fill, near.failing)))
        return replace(told, conditions=tuple(map(fill, told.conditions)), nearest=near)

    @cached_property
    def _definitions(self) -> dict[str, str]:
        return {rule.name: rule.definition for rule in rules_of(self.explainer.profile)}

    def definitions(self, told: Explanation) -> dict[str, str]:
        """What the names are of which a summary speaks, as the heads of their rule files say it."""
        near = (told.nearest.name,) if told.nearest else ()
        names = dict.fromkeys((told.name, *told.general, *near))
        return {name: self._definitions[name] for name in names if name in self._definitions}


def explained(capture: Capture, *, rules: Profile) -> Explained:
    """Observe a capture and make ready to explain it.

    Raises:
        CaparError: The capture or the rules have a fault.
    """
    measurements = measure(capture)
    observation = observe_measured(capture, measurements, rules=rules)
    explainer = Explainer(observation.facts, rules, body_names(observation))
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
    seen = _explained(capture, rules)
    return seen.explain(chosen(seen.observation, segment))


def why_not(
    capture: Capture | Path | str,
    segment: str,
    name: str,
    *,
    rules: Profile | str = DEFAULT,
    limit: int = 1,
) -> tuple[Alternative, ...]:
    """The smallest changes that would have given a segment of a capture another name.

    Args:
        capture: A capture, or where to read it.
        segment: Such as ``right_hand/3``.
        name: The name that it has not.
        rules: A rule profile or its name.
        limit: How many equally small answers to give, at most.

    Raises:
        UnknownNameError: There is no such segment, or no rule gives that name.
        RuleError: The segment has that name.
    """
    seen = _explained(capture, rules)
    return alternatives(seen.explainer, segment_named(seen.observation, segment), name, limit=limit)


def _explained(capture: Capture | Path | str, rules: Profile | str) -> Explained:
    trial = trial_of(capture)
    return explained(trial, rules=profile(rules) if isinstance(rules, str) else rules)


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
    title = f"{SegmentAddress(told.ee, told.index)}  {told.name}  "
    return Plot(
        f"{title}{told.start_s:.2f} to {told.end_s:.2f} s",
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
    scale, unit = QUANTITIES[every[0].quantity].scale, every[0].unit
    limits = {(one.limit, one.limit_text) for one in every if one.limit is not None}
    marks = dict.fromkeys(
        (_frame(one, one.value, series, rate_hz) / rate_hz, one.value, one.value_text)
        for one in every
        if one.value is not None
    )
    bars = tuple((begin / rate_hz, end / rate_hz) for begin, end in series.bars)
    return Panel(
        f"{every[0].label} [{unit}]" if unit else every[0].label,
        series.frames / rate_hz,
        series.values * scale,
        unit,
        tuple(sorted(limits)),
        tuple(marks),
        bars,
        series.held,
    )


def _frame(one: Measured, value: float, series: Series, rate_hz: float) -> int:
    """The frame at which a value is marked: where the curve has it, near the one that counts.

    Rules compare some quantities at an event that is merged with the border.
    """
    counted = series.frame(one.first, one.last)
    near = np.abs(series.frames - counted) <= times().merge_ms / 1000.0 * rate_hz
    off = np.abs(series.values * QUANTITIES[one.quantity].scale - value)
    off[~near | np.isnan(off)] = np.inf
    return counted if np.isinf(off).all() else int(series.frames[np.argmin(off)])
