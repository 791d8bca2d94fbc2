"""The pipeline from a capture to reasons: observe it, then say why, and why not."""

import re
from collections import defaultdict
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import numpy as np

from capar.model import geometry
from capar.model.body_names import body_names
from capar.model.capture import Capture
from capar.model.facts import Moving
from capar.model.observation import Observation, Segment, SegmentAddress, find_segment
from capar.pipelines.distances import apart_within, reaches
from capar.pipelines.observation import observe_measured
from capar.pipelines.trials import trial_of
from capar_rules.authoring.user_primitives import rules_of
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.explain.explanation import Explainer, Explanation
from capar_rules.explain.measured import (
    Heights,
    Leans,
    Measured,
    Places,
    TurnsBack,
    Ways,
    fewer_frames,
)
from capar_rules.explain.quantities import Over, Turns, Way
from capar_rules.explain.why_not import Alternative
from capar_rules.explain.why_not import why_not as alternatives
from extractors.calibration import thresholds_of
from extractors.measure import Measurements, measure
from extractors.motion.phases import lean, most_turns
from extractors.relations.arrangement import Pair

AXES = ("along the x axis", "along the y axis", "up and down")
"""The axes of the world, as sentences have them."""

GAP_S = 0.1
"""Shorter gaps in a track are not told of [s]."""

_SEGMENT = re.compile(r"seg\((\w+),(\d+)\)")


@dataclass(frozen=True, eq=False)
class Explained:
    """A capture that was observed, and what explains its segments."""

    observation: Observation
    explainer: Explainer
    measurements: Measurements

    @cached_property
    def definitions(self) -> dict[str, str]:
        """What each name is, in words, as the head of its rule file says it."""
        return {rule.name: rule.definition for rule in rules_of(self.explainer.profile)}


def explained(capture: Capture, *, rules: Profile) -> Explained:
    """Observe a capture and make ready to explain it.

    Raises:
        CaparError: The capture or the rules have a fault.
    """
    measurements = measure(capture)
    observation = observe_measured(capture, measurements, rules=rules)
    measured = measured_of(observation, measurements)
    explainer = Explainer(observation.facts, profile=rules, measured=measured)
    return Explained(observation, explainer, measurements)


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
    return seen.explainer.explain_all(chosen(seen.observation, segment))


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


def measured_of(observation: Observation, measurements: Measurements) -> Measured:
    """What explanations say of bodies beside the facts: ways, names and distances of touch."""
    calibration = measurements.calibration
    bodies = (*calibration.sensors, *calibration.objects)
    return Measured(
        ways(measurements),
        leans=_leans(measurements),
        far_over_rad=thresholds_of(calibration).lean_rad,
        turns=_turns(measurements),
        names=body_names(observation),
        reaches=reaches(measurements),
        floors={thing.name: thing.motion_floor_m for thing in bodies},
        turned=_turned(measurements),
        turn_floors={thing.name: thing.motion_floor_rad for thing in bodies},
        stand_ins={
            body: str(notice["shape"])
            for notice in observation.notices
            if notice.code == "stand-in-shape"
            for body in notice.bodies
        },
        heights=_heights(measurements),
        over=_over(measurements),
        apart=apart_within(measurements),
        gap_frames=fewer_frames(calibration.contact_dropout_s, observation.rate_hz),
        brief_frames=fewer_frames(calibration.contact_minimum_s, observation.rate_hz),
        lost=_lost(observation, measurements),
        unrested=_unrested(observation),
        rate_hz=observation.rate_hz,
    )


def _heights(measurements: Measurements) -> Heights:
    """How low and how high bodies were."""

    def extremes(name: str, first: int, last: int) -> tuple[float, float]:
        height = measurements.bodies.named(name).middles[first : last + 1, 2]
        return float(np.nanmin(height) - height[0]), float(np.nanmax(height) - height[0])

    return extremes


def _over(measurements: Measurements) -> Places:
    """Where bodies are to others at frames."""
    limits = thresholds_of(measurements.calibration)
    bodies = measurements.bodies

    @cache
    def pair(name: str, other: str) -> Pair:
        return Pair(bodies.named(name), bodies.named(other), limits)

    def at(name: str, other: str, frame: int) -> Over:
        known = pair(name, other)
        rise = known.body.middles[frame, 2] - known.other.boxes[1][frame, 2]
        share, deep = known.shares
        shaped = known.other.shape is not None
        aside = float(known.aside[frame])
        return Over(float(rise), aside, float(share[frame]), float(deep[frame]), shaped)

    return at


def _lost(observation: Observation, measurements: Measurements) -> dict[str, list[tuple[int, int]]]:
    """The gaps in the tracks of bodies, by body."""
    least = GAP_S * observation.rate_hz
    bodies = measurements.bodies
    return {
        name: [
            (first, last) for first, last in geometry.runs(body.poses.lost) if last - first >= least
        ]
        for name, body in {**bodies.objects, **bodies.sensors}.items()
    }


def _unrested(observation: Observation) -> frozenset[str]:
    """Objects that move in every frame."""
    count: dict[str, int] = defaultdict(int)
    for fact in observation.facts:
        if isinstance(fact, Moving):
            count[fact.object] += fact.last - fact.first + 1
    return frozenset(name for name, moving in count.items() if moving >= observation.frames)


def ways(measurements: Measurements) -> Ways:
    """How a body's middle moves between two frames; steps between lost frames are left out.

    The middle is that of its shape, as of the places by which rules decide; without a shape it is
    the origin.
    """

    def moved(name: str, first: int, last: int) -> Way:
        track = measurements.bodies.named(name).middles[first : last + 1]
        steps = np.linalg.norm(np.diff(track, axis=0), axis=1)
        away = geometry.from_middle(track)
        straight = float(np.linalg.norm(track[-1] - track[0]))
        return Way(straight, float(np.nansum(steps)), float(np.nanmax(away)))

    return moved


def _leans(measurements: Measurements) -> Leans:
    """How far bodies lean at most between two frames."""

    def most(name: str, first: int, last: int) -> float:
        orientations = measurements.bodies.named(name).orientations[first : last + 1]
        upright = np.array(measurements.calibration.body(name).upright)
        return float(np.nanmax(lean(orientations, upright)))

    return most


def _turned(measurements: Measurements) -> Leans:
    """By what angle bodies were turned at most from their mean orientation between two frames."""

    def most(name: str, first: int, last: int) -> float:
        orientations = measurements.bodies.named(name).orientations[first : last + 1]
        return float(np.nanmax(geometry.from_mean(orientations)))

    return most


def _turns(measurements: Measurements) -> TurnsBack:
    """How often bodies turn back between two frames."""
    limits = thresholds_of(measurements.calibration)

    def turned(name: str, first: int, last: int) -> Turns:
        stream = measurements.bodies.named(name).poses.smooth
        axis, turns = most_turns(stream, (first, last), limits)
        return Turns(len(turns), AXES[axis])

    return turned


def segment_named(observation: Observation, text: str) -> Segment:
    """The segment of an observation at an address such as ``right_hand/3``.

    Raises:
        AddressError: The text is no address.
        UnknownNameError: There is no segment at it.
    """
    address = SegmentAddress.parse(text)
    return find_segment(observation.links, address, capture=observation.capture)
