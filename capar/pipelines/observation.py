"""From a capture to an observation: calibrate, measure, infer, represent; also by other rules."""

import ctypes
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from hashlib import sha256
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from capar import __version__
from capar.model.calibration import Calibration
from capar.model.capture import Capture
from capar.model.errors import FileError
from capar.model.facts import Displaced, Fact, FlickerCorrection, MovedBy
from capar.model.locations import ConstraintLocation
from capar.model.notices import Notice, notice
from capar.model.observation import Observation, Segment
from capar.pipelines.trials import trial_of
from capar_rules.borders.deflicker import steady
from capar_rules.borders.numbering import number_borders
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.movers.movers import movers
from capar_rules.pars.inference import Inference, infer
from capar_rules.pars.pars import Measured, compose, ipars, naming_rules, upars
from extractors.bodies.bodies import Bodies, observed_object
from extractors.calibration import calibrate as calibration_of
from extractors.calibration import thresholds_of
from extractors.forces.forces import force_styles
from extractors.measure import Measurements, measure
from extractors.readers.bundle.capture_toml import place_of, read_capture
from extractors.segments import constraint_location, followed, moved_path, sampled_tracks, style
from extractors.thresholds import Thresholds

if TYPE_CHECKING:
    from kb.lookup.pars import Stored


def return_freed_memory() -> None:
    """Give back what the allocator keeps of freed arrays; without effect where it is not glibc's.

    Arrays of a long capture lie among smaller things that live on, so that glibc keeps their pages
    when they are freed. What is allocated next, by the solver for instance, then adds to them.
    """
    with suppress(AttributeError, OSError, TypeError):  # musl, macOS; Windows has no such handle
        ctypes.CDLL(None).malloc_trim(0)


def flicker_notices(facts: Iterable[Fact], rate_hz: float) -> Iterator[Notice]:
    """A notice for each interval that is not taken as it was measured, at so many frames/s."""
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


def unmoved_notices(facts: Iterable[Fact], times: Float[np.ndarray, "frames"]) -> Iterator[Notice]:
    """A notice for each object in whose motion there are frames without a mover."""
    moved: dict[str, int] = defaultdict(int)
    lacking: dict[str, list[MovedBy]] = defaultdict(list)
    for fact in facts:
        if isinstance(fact, Displaced):
            moved[fact.object] += fact.last - fact.first + 1
        elif isinstance(fact, MovedBy) and fact.how == "unknown":
            lacking[fact.object].append(fact)
    for name, parts in sorted(lacking.items()):
        worst = max(parts, key=lambda part: part.last - part.first)
        frames = sum(part.last - part.first + 1 for part in parts)
        yield notice(
            "no-mover", name, start_s=float(times[worst.first]), end_s=float(times[worst.last]),
            share=frames / max(moved[name], 1), times=len(parts), why=worst.mover,
        )  # fmt: skip


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
    known = calibration_of(trial, thresholds) if thresholds else None
    return observe_measured(trial, measure(trial, known), rules=rules, name=name)


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
    limits, bodies = thresholds_of(measurements.calibration), measurements.bodies
    action, agent = name or capture.name, capture.agent.name
    facts = steady(measurements.facts) if base.steady else measurements.facts
    # The solver needs no poses; styles and places, which do, come later.
    bodies.forget_smooth_poses()
    return_freed_memory()
    inference = infer(facts, profile=base)
    return_freed_memory()
    moved = () if base.crossings_only else movers(facts)
    return_freed_memory()
    segments = [segment for link in inference.links for segment in link.segments]
    paths = {
        (segment.ee, segment.index): Measured(*moved_path(capture, measurements, segment, limits))
        for segment in _grouped(sorted(segments, key=followed), bodies, followed)
    }
    return_freed_memory()
    by_link = _grouped(segments, bodies, lambda segment: segment.ee)
    places = (_location(capture, measurements, inference, segment) for segment in by_link)
    frames, duration_s = len(capture.times), float(capture.times[-1])
    return Observation(
        capture=capture.name,
        profile=base.name,
        rules=base.fingerprint,
        version=__version__,
        agent=capture.agent,
        duration_s=duration_s,
        rate_hz=capture.rate_hz,
        frames=frames,
        objects=tuple(observed_object(each) for each in capture.objects),
        links=inference.links,
        facts=(*facts, *moved),
        upars=upars(inference, paths, name=action),
        ipars=ipars(inference, paths, agent=agent, name=action),
        complex_par=compose(inference, name=action, frames=frames - 1, duration_s=duration_s),
        locations=tuple(place for place in places if place),
        styles=tuple(
            style(segment, measurements.tracks[segment.ee], capture.times, limits)
            for segment in _grouped(segments, bodies, lambda segment: segment.ee)
        ),
        sources=capture.sources,
        notices=(
            *measurements.notices,
            *flicker_notices(facts, capture.rate_hz),
            *unmoved_notices((*facts, *moved), capture.times),
            *(notice("rule-violation", violation=each) for each in inference.violations),
        ),
        joint=inference.joint,
        relations=inference.relations,
        others=capture.others,
        calibration=measurements.calibration,
        guides=() if base.crossings_only else measurements.guides,
        forces=force_styles(
            capture, bodies, facts, {guide.object for guide in measurements.guides}
        ),
        naming=naming_rules(base, (segment.name for segment in segments)),
        tracks=tuple(sampled_tracks(bodies, capture.times)),
    )


def _grouped(
    segments: Iterable[Segment], bodies: Bodies, key: Callable[[Segment], object]
) -> Iterator[Segment]:
    """The segments; after those of a key the poses that were filtered for them are forgotten."""
    for _, group in groupby(segments, key):
        yield from group
        bodies.forget_smooth_poses()


def _location(
    capture: Capture, measurements: Measurements, inference: Inference, segment: Segment
) -> ConstraintLocation | None:
    """The constraint that ends a segment, where it ends in a contact (spec 4)."""
    first, second = inference.conditions[segment.ee, segment.index].colliding
    if second < 0 or "1" not in segment.features.rel_end:
        return None
    return constraint_location(
        capture, measurements.bodies, measurements.attention, segment,
        dominant=segment.objects[first] if first >= 0 else "", goal=segment.objects[second],
    )  # fmt: skip


def facts_program(
    capture: Capture, *, rules: Profile | str = DEFAULT, thresholds: Thresholds | None = None
) -> tuple[Measurements, tuple[Fact, ...]]:
    """What was measured, with its flicker resolved, and the borders that the rules read beside it.

    Flicker is resolved, and borders are numbered, as the profile has it.
    """
    base = profile(rules) if isinstance(rules, str) else rules
    measurements = measure(capture, calibration_of(capture, thresholds) if thresholds else None)
    facts = steady(measurements.facts) if base.steady else measurements.facts
    borders = number_borders(facts, crossings_only=base.crossings_only)
    return replace(measurements, facts=facts), borders


def observe_again(
    files: Sequence[tuple[str, str]],
    known: "Stored",
    measured: tuple[Fact, ...],
    rules: Profile,
    places: Sequence[Path],
) -> Observation:
    """The observation of the same files by other rules.

    Raises:
        FileError: The files are not there, or have changed.
    """
    digests = sorted(digest for _, digest in files)
    for place in places:
        for path in sorted(place.rglob("*.toml")):
            if path.is_file() and sha256(path.read_bytes()).hexdigest() in digests:
                trial = replace(read_capture(place_of(path, known.name)), name=known.name)
                if sorted(source.sha256 for source in trial.sources) == digests:
                    found = measure(trial)
                    # Flicker is resolved if it was in what was measured then.
                    resolved = next(
                        (
                            on
                            for on in (rules.steady, not rules.steady)
                            if set(steady(found.facts) if on else found.facts) == set(measured)
                        ),
                        rules.steady,
                    )
                    again = replace(rules, steady=resolved)
                    return observe_measured(trial, found, rules=again, name=known.action)
    searched = ", ".join(map(str, places))
    raise FileError(
        files[0][0] if files else known.name,
        f"and the other files from which {known.name!r} was observed are not below {searched}, or "
        "have changed; nothing was renamed.",
        "Name the folder that holds them with --captures, or observe and add it again.",
    )
