"""The pipeline from a capture to an observation: measure, reason, represent."""

from collections.abc import Iterable
from dataclasses import replace
from itertools import groupby
from pathlib import Path

from capar import __version__
from capar.model.calibration import Calibration
from capar.model.capture import Capture, Notice, notice
from capar.model.facts import Fact
from capar.model.locations import ConstraintLocation, GuideLocation
from capar.model.observation import Observation, Segment
from capar.pipelines.flicker import flicker_notices
from capar.pipelines.freed_memory import return_freed_memory
from capar.pipelines.movers import unmoved_notices
from capar.pipelines.trials import trial_of
from capar_rules.borders.border_numbers import number_borders
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.movers.movers import movers
from capar_rules.pars.complex_pars import compose
from capar_rules.pars.inference import Inference, Key, infer
from capar_rules.pars.naming_rules import naming_rules
from capar_rules.pars.primitive_pars import Measured, ipars, upars
from extractors.bodies.bodies import Bodies
from extractors.bodies.observed_objects import observed_object
from extractors.calibration import calibrate as calibration_of
from extractors.calibration import thresholds_of
from extractors.forces.force_styles import force_styles
from extractors.measure import Measurements, measure
from extractors.relations.guide_locations import guide_location
from extractors.segments.locations import constraint_location
from extractors.segments.motion_kinds import followed, moved_path
from extractors.segments.sampled_tracks import sampled_tracks
from extractors.segments.styles import style
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
    trial = trial_of(capture)
    return observe_measured(trial, _measurements(trial, thresholds), rules=rules, name=name)


def calibrate(
    capture: Capture | Path | str, *, thresholds: Thresholds | None = None
) -> Calibration:
    """Decide what holds for a whole recording: noise, floors, contact distances, horizons.

    Args:
        capture: A capture, or where to read it.
        thresholds: What extraction decides by; None for the usual.

    Raises:
        CaparError: The capture has a fault.
    """
    return calibration_of(trial_of(capture), thresholds)


def observe_measured(
    capture: Capture,
    measurements: Measurements,
    *,
    rules: Profile | str = DEFAULT,
    name: str = "",
) -> Observation:
    """The same for a capture whose measurements are at hand."""
    base = profile(rules) if isinstance(rules, str) else rules
    limits = thresholds_of(measurements.calibration)
    action = name or capture.name
    facts = steady(measurements.facts) if base.steady else measurements.facts
    # The solver needs no poses; styles and places, which do, come later.
    measurements.bodies.forget_smooth_poses()
    return_freed_memory()
    inference = infer(facts, profile=base)
    return_freed_memory()
    moved = () if base.crossings_only else movers(facts)
    return_freed_memory()
    measured = dict(_measured(capture, measurements, inference, limits))
    return_freed_memory()
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
        objects=tuple(observed_object(each) for each in capture.objects),
        links=inference.links,
        facts=(*facts, *moved),
        upars=upars(inference, measured, name=action),
        ipars=ipars(inference, measured, agent=agent, name=action),
        complex_par=compose(inference, name=action, frames=frames, duration_s=duration_s),
        locations=tuple(_locations(capture, measurements, inference)),
        styles=tuple(
            style(segment, measurements.tracks[segment.ee], capture.times, limits)
            for segment in _link_by_link(inference, measurements.bodies)
        ),
        sources=capture.sources,
        notices=(
            *measurements.notices,
            *flicker_notices(facts, capture.rate_hz),
            *unmoved_notices((*facts, *moved), capture.times),
            *_violations(inference),
        ),
        joint=inference.joint,
        relations=inference.relations,
        others=capture.others,
        calibration=measurements.calibration,
        guides=() if base.crossings_only else tuple(_guides(measurements)),
        forces=force_styles(capture, measurements.bodies, facts, measurements.guides),
        naming=naming_rules(base, (segment.name for segment in _segments(inference))),
        tracks=tuple(sampled_tracks(measurements.bodies, capture.times)),
    )


def facts_program(
    capture: Capture, *, rules: Profile | str = DEFAULT, thresholds: Thresholds | None = None
) -> tuple[Measurements, tuple[Fact, ...]]:
    """What was measured, with its flicker resolved, and the borders that the rules read beside it.

    Flicker is resolved, and borders are numbered, as the profile has it.
    """
    base = profile(rules) if isinstance(rules, str) else rules
    measurements = _measurements(capture, thresholds)
    facts = steady(measurements.facts) if base.steady else measurements.facts
    return replace(measurements, facts=facts), number_borders(
        facts, crossings_only=base.crossings_only
    )


def _measurements(capture: Capture, thresholds: Thresholds | None) -> Measurements:
    return measure(capture, calibration_of(capture, thresholds) if thresholds else None)


def _segments(inference: Inference) -> Iterable[Segment]:
    return (segment for link in inference.links for segment in link.segments)


def _link_by_link(inference: Inference, bodies: Bodies) -> Iterable[Segment]:
    """All segments; after those of a link the poses that were filtered for them are forgotten."""
    for link in inference.links:
        yield from link.segments
        bodies.forget_smooth_poses()


def _body_by_body(inference: Inference, bodies: Bodies) -> Iterable[Segment]:
    """All segments, by the body that goes the way; its filtered poses are forgotten after them."""
    for _, segments in groupby(sorted(_segments(inference), key=followed), key=followed):
        yield from segments
        bodies.forget_smooth_poses()


def _measured(
    capture: Capture, measurements: Measurements, inference: Inference, thresholds: Thresholds
) -> Iterable[tuple[Key, Measured]]:
    for segment in _body_by_body(inference, measurements.bodies):
        motion, path = moved_path(capture, measurements, segment, thresholds)
        yield (segment.ee, segment.index), Measured(motion, path)


def _locations(
    capture: Capture, measurements: Measurements, inference: Inference
) -> Iterable[ConstraintLocation]:
    """The constraint that ends each segment, where it ends in a contact (spec 4)."""
    for segment in _link_by_link(inference, measurements.bodies):
        first, second = inference.conditions[segment.ee, segment.index].colliding
        if second >= 0 and "1" in segment.features.rel_end:
            yield constraint_location(
                capture,
                measurements.bodies,
                measurements.attention,
                segment,
                dominant=segment.objects[first] if first >= 0 else "",
                goal=segment.objects[second],
            )


def _guides(measurements: Measurements) -> Iterable[GuideLocation]:
    """The hinge or the rail of each object that moves on one (spec 10)."""
    objects = measurements.bodies.objects
    for name, guide in sorted(measurements.guides.items()):
        yield guide_location(objects[name], objects[guide.base], guide)


def _violations(inference: Inference) -> Iterable[Notice]:
    return (notice("rule-violation", violation=each) for each in inference.violations)
