"""From a capture to an observation: calibrate, measure, infer, represent; also by other rules."""

import ctypes
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from hashlib import sha256
from itertools import groupby
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar import __version__
from capar.model.calibration import Calibration
from capar.model.capture import Capture
from capar.model.errors import FileError
from capar.model.facts import Displaced, Fact, FlickerCorrection, MovedBy
from capar.model.locations import ConstraintLocation, GuideLocation
from capar.model.notices import Notice, notice
from capar.model.observation import Observation, Segment
from capar.pipelines.trials import trial_of
from capar_rules.borders.border_numbers import number_borders
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.movers.movers import movers
from capar_rules.pars.inference import Inference, Key, infer
from capar_rules.pars.pars import Measured, compose, ipars, naming_rules, upars
from extractors.bodies.bodies import Bodies, observed_object
from extractors.calibration import calibrate as calibration_of
from extractors.calibration import thresholds_of
from extractors.forces.forces import force_styles
from extractors.measure import Measurements, measure
from extractors.readers.bundle.capture_toml import read_capture, takes
from extractors.relations.guides import guide_location
from extractors.segments import constraint_location, followed, moved_path, sampled_tracks, style
from extractors.thresholds import Thresholds
from kb.lookup.pars import Stored


def flicker_notices(facts: Iterable[Fact], rate_hz: float) -> Iterator[Notice]:
    """A notice for each stretch that is not taken as it was measured.

    Args:
        facts: Measurements and corrections.
        rate_hz: Frames a second.
    """
    for fact in facts:
        if isinstance(fact, FlickerCorrection):
            yield notice(
                "flicker",
                *dict.fromkeys((fact.body, fact.other)),
                start_s=fact.first / rate_hz,
                end_s=fact.last / rate_hz,
                length_s=(fact.last - fact.first + 1) / rate_hz,
                taken=fact.taken,
            )


def return_freed_memory() -> None:
    """Give back what the allocator keeps of freed arrays; without effect where it is not glibc's.

    Arrays of a long capture lie among smaller things that live on, so that glibc keeps their pages
    when they are freed. What is allocated next, by the solver for instance, then adds to them.
    """
    trim = _malloc_trim()
    if trim is not None:
        trim(0)


@cache
def _malloc_trim() -> "ctypes._NamedFuncPointer | None":
    try:
        return ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):  # musl, macOS; Windows has no such handle
        return None


UNKNOWN = "unknown"


def unmoved_notices(facts: Iterable[Fact], times: Float[np.ndarray, "frames"]) -> Iterator[Notice]:
    """A notice for each object in whose motion there are frames without a mover.

    Args:
        facts: Measurements and movers.
        times: Clock of the capture [s].
    """
    moved: dict[str, int] = defaultdict(int)
    lacking: dict[str, list[MovedBy]] = defaultdict(list)
    for fact in facts:
        if isinstance(fact, Displaced):
            moved[fact.object] += fact.last - fact.first + 1
        elif isinstance(fact, MovedBy) and fact.how == UNKNOWN:
            lacking[fact.object].append(fact)
    for thing, parts in sorted(lacking.items()):
        worst = max(parts, key=lambda part: part.last - part.first)
        frames = sum(part.last - part.first + 1 for part in parts)
        yield notice(
            "no-mover",
            thing,
            start_s=float(times[worst.first]),
            end_s=float(times[worst.last]),
            share=frames / max(moved[thing], 1),
            times=len(parts),
            why=worst.mover,
        )


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


def observe_again(
    files: Sequence[tuple[str, str]],
    known: Stored,
    measured: tuple[Fact, ...],
    rules: Profile,
    places: Sequence[Path],
) -> Observation:
    """The observation of the same files by other rules.

    Args:
        files: Path and SHA-256 of each file that it was made from.
        known: The observation as it is stored.
        measured: What was measured then; its flicker is resolved again only if it was then.
        rules: The rules that are to name its segments.
        places: Folders below which the files are.

    Raises:
        FileError: The files are not there, or have changed.
    """
    digests = sorted(digest for _, digest in files)
    for place in places:
        for path in sorted(place.rglob("*.toml")):
            if path.is_file() and sha256(path.read_bytes()).hexdigest() in digests:
                for trial in _trials(path, known.name):
                    if sorted(each.sha256 for each in trial.sources) == digests:
                        return _again(trial, known, measured, rules)
    searched = ", ".join(map(str, places))
    raise FileError(
        files[0][0] if files else known.name,
        f"and the other files from which {known.name!r} was observed are not below {searched}, or "
        "have changed; nothing was renamed.",
        "Name the folder that holds them with --captures, or observe and add it again.",
    )


def _again(
    trial: Capture, known: Stored, measured: tuple[Fact, ...], rules: Profile
) -> Observation:
    """A capture observed again, its flicker resolved if it was in what was measured then."""
    found = measure(trial)
    steadied = rules.steady
    for other in (rules.steady, not rules.steady):
        facts_then = steady(found.facts) if other else found.facts
        if set(facts_then) == set(measured):
            steadied = other
            break
    return observe_measured(trial, found, rules=replace(rules, steady=steadied), name=known.action)


def _trials(path: Path, name: str) -> Iterator[Capture]:
    """The captures that a file describes and that may bear a name: of its takes, or the one."""
    known = takes(path)
    # A capture is called after its take, so that the others need not be read.
    named = sorted((each for each in known if each in name), key=lambda each: (-len(each), each))
    for place in [f"{path}:{each}" for each in named] if known else [path]:
        trial = read_capture(place)
        if trial.name == name:
            yield trial
