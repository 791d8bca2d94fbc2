"""The pipeline from a capture to an observation: measure, reason, represent."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from capar import __version__
from capar.model.capture import Capture, Notice, TagObject, notice
from capar.model.facts import Doubted, Fact
from capar.model.observation import Observation, ObservedObject, Segment
from capar.model.par import ConstraintLocation, Motion, Style
from capar_rules.borders.deflicker import steady
from capar_rules.borders.ranking import rank
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.pars.complex_pars import compose
from capar_rules.pars.inference import Inference, Key, infer
from capar_rules.pars.primitive_pars import Measured, ipars, upars
from extractors.measure import Measurements, extract
from extractors.readers.bundle.capture_toml import read_capture
from extractors.segments.locations import locate
from extractors.segments.motion_kinds import motion_kind
from extractors.segments.styles import path_style, velocity_style
from extractors.thresholds import Thresholds


def observe(
    capture: Capture | Path | str,
    *,
    rules: Profile | str = DEFAULT,
    name: str = "",
    thresholds: Thresholds | None = None,
) -> Observation:
    """Say what was done in a capture.

    Args:
        capture: A capture, or where to read it.
        rules: A rule profile or its name.
        name: What the whole action is called; the capture's name if empty.
        thresholds: What extraction decides by; None for the usual.

    Raises:
        CaparError: The capture or the rules have a fault.
    """
    trial = capture if isinstance(capture, Capture) else read_capture(capture)
    measurements = extract(trial, thresholds=thresholds)
    return observe_measured(trial, measurements, rules=rules, name=name, thresholds=thresholds)


def observe_measured(
    capture: Capture,
    measurements: Measurements,
    *,
    rules: Profile | str = DEFAULT,
    name: str = "",
    thresholds: Thresholds | None = None,
) -> Observation:
    """The same for a capture whose measurements are at hand."""
    base = profile(rules) if isinstance(rules, str) else rules
    limits = thresholds or Thresholds()
    action = name or capture.name
    facts = steady(measurements.facts) if base.steady else measurements.facts
    inference = infer(facts, profile=base)
    measured = dict(_measured(capture, measurements, inference, limits))
    frames = len(capture.times) - 1
    duration_s = float(capture.times[-1])
    agent = capture.agent.name
    return Observation(
        capture=capture.name,
        profile=base.name,
        rules=base.fingerprint,
        version=__version__,
        agent=capture.agent,
        duration_s=duration_s,
        rate_hz=capture.rate_hz,
        frames=frames + 1,
        objects=tuple(_observed(each) for each in capture.objects),
        links=inference.links,
        facts=facts,
        upars=upars(inference, measured, name=action),
        ipars=ipars(inference, measured, agent=agent, name=action),
        complex_par=compose(inference, name=action, frames=frames, duration_s=duration_s),
        locations=tuple(_locations(capture, measurements, inference)),
        styles=tuple(_styles(capture, measurements, inference, limits)),
        sources=capture.sources,
        notices=(
            *measurements.notices,
            *_doubts(facts, capture.rate_hz),
            *_violations(inference),
        ),
        joint=inference.joint,
        others=capture.others,
    )


def facts_program(
    capture: Capture, *, rules: Profile | str = DEFAULT, thresholds: Thresholds | None = None
) -> tuple[Measurements, tuple[Fact, ...]]:
    """What was measured, with its flicker resolved, and the borders that the rules read beside it.

    Flicker is resolved, and borders are numbered, as the profile has it.
    """
    base = profile(rules) if isinstance(rules, str) else rules
    measurements = extract(capture, thresholds=thresholds)
    facts = steady(measurements.facts) if base.steady else measurements.facts
    return replace(measurements, facts=facts), rank(facts, crossings_only=base.crossings_only)


def _segments(inference: Inference) -> Iterable[Segment]:
    return (segment for link in inference.links for segment in link.segments)


def _measured(
    capture: Capture, measurements: Measurements, inference: Inference, thresholds: Thresholds
) -> Iterable[tuple[Key, Measured]]:
    tags = {each.name: each for each in capture.objects}
    for segment in _segments(inference):
        track = measurements.tracks[segment.ee].positions
        kind = Motion.NONE
        if "1" in segment.features.change_loc:
            moved = segment.objects[segment.features.change_loc.index("1")]
            where = measurements.poses["object", moved]
            track = where.smooth.positions
            kind = motion_kind(
                where,
                segment.first,
                segment.last,
                own_m=tags[moved].motion_floor_m,
                thresholds=thresholds,
            )
        ends = [_point(track[frame]) for frame in (segment.first, segment.last)]
        yield (segment.ee, segment.index), Measured(kind, tuple(each for each in ends if each))


def _point(position: np.ndarray) -> tuple[float, float, float] | tuple[()]:
    if np.isnan(position).any():
        return ()
    x, y, z = map(float, position)
    return x, y, z


def _locations(
    capture: Capture, measurements: Measurements, inference: Inference
) -> Iterable[ConstraintLocation]:
    """The constraint that ends each segment, where it ends in a contact (spec 4)."""
    sides = {each.ee: each.side for each in inference.links}
    for segment in _segments(inference):
        first, second = inference.conditions[segment.ee, segment.index].colliding
        if second < 0 or "1" not in segment.features.rel_end:
            continue
        place = locate(
            capture,
            measurements.poses,
            measurements.attention,
            ee=segment.ee,
            dominant=segment.objects[first] if first >= 0 else "",
            goal=segment.objects[second],
            frame=segment.last,
        )
        yield ConstraintLocation(
            action=segment.name,
            purpose=segment.purpose,
            ee=segment.ee,
            side=sides[segment.ee],
            frame=place.frame,
            dominant=place.dominant,
            goal=place.goal,
            ee_nlt=place.ee_nlt,
            goal_nlt=place.goal_nlt,
            seen=place.seen,
            v_nlt=place.v_nlt,
        )


def _styles(
    capture: Capture, measurements: Measurements, inference: Inference, thresholds: Thresholds
) -> Iterable[Style]:
    for segment in _segments(inference):
        track = measurements.tracks[segment.ee]
        span = segment.first, segment.last
        yield Style(
            action=segment.name,
            purpose=segment.purpose,
            ee=segment.ee,
            velocity=velocity_style(track.positions, capture.times, *span, thresholds=thresholds),
            path=path_style(track.positions, capture.times, track.crossings, *span),
        )


def _observed(each: TagObject) -> ObservedObject:
    known = np.flatnonzero(~each.stream.lost)
    frame = int(known[0]) if known.size else 0
    position = each.stream.positions[frame] if known.size else np.zeros(3)
    turn = each.stream.orientations[frame] if known.size else np.array([1.0, 0.0, 0.0, 0.0])
    size = each.shape.size if each.shape else np.zeros(3)
    x, y, z = map(float, position)
    w, i, j, k = map(float, turn)
    length, width, height = map(float, size)
    return ObservedObject(
        name=each.name,
        kind=each.kind or each.name,
        tag=each.tag.value,
        size_m=(length, width, height),
        shape=each.shape.description if each.shape else "",
        assumed=each.assumed,
        position_m=(x, y, z),
        orientation=(w, i, j, k),
    )


def _violations(inference: Inference) -> Iterable[Notice]:
    return (notice("rule-violation", violation=each) for each in inference.violations)


def _doubts(facts: Iterable[Fact], rate_hz: float) -> Iterable[Notice]:
    for each in facts:
        if isinstance(each, Doubted):
            yield notice(
                "flicker",
                *dict.fromkeys((each.body, each.other)),
                start_s=each.first / rate_hz,
                end_s=each.last / rate_hz,
                length_s=(each.last - each.first + 1) / rate_hz,
                taken=each.taken,
            )
