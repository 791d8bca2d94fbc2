"""Captures observed and compared with their labels, link by link and pooled."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.evaluation.labels import Labels, in_seconds, read_labels
from capar.evaluation.mapping import LabelMapping, check_names, labelled
from capar.evaluation.metrics import (
    MATCH_AT,
    THRESHOLDS,
    Interval,
    Tally,
    accuracy,
    frame_f1,
    pooled,
    segment_f1,
    tally,
)
from capar.model.errors import UnknownNameError
from capar.model.observation import Observation
from capar.model.par import UNKNOWN
from capar.pipelines.observation import observe
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.engine.solver import solve
from extractors.readers.bundle.capture_toml import frame_times, read_capture


@dataclass(frozen=True)
class Case:
    """An observation with its labels, in seconds of one clock."""

    observation: Observation
    labels: Labels
    times: Float[np.ndarray, "frames"]
    """Time of each frame of the capture [s]."""


@dataclass(frozen=True)
class Evaluation:
    """What was counted, by link and over all links."""

    cases: tuple[str, ...]
    """Names of the captures."""

    links: Mapping[str, Tally]
    whole: Tally
    unlabelled: tuple[str, ...]
    """Links that were observed and bear no labels in any of the files: not counted."""

    notices: tuple[str, ...] = ()
    """What is odd about the labels."""


def evaluate(
    pairs: Sequence[tuple[str, Path]],
    mapping: LabelMapping,
    *,
    rules: Profile | str = DEFAULT,
    frames_of: str = "",
) -> Evaluation:
    """Observe captures and compare them with their label files.

    Args:
        pairs: Captures, each with its label file.
        mapping: From names of segments to labels.
        rules: The rule profile to observe with, or its name.
        frames_of: The capture's file whose frames the labels count, where it has several.

    Raises:
        CaparError: A capture, a label file or the mapping has a fault.
    """
    base = profile(rules) if isinstance(rules, str) else rules
    cases = [_case(place, path, base, frames_of) for place, path in pairs]
    check_names(
        mapping,
        names=known_names([each.observation for each in cases], base),
        objects={thing.name for each in cases for thing in each.observation.objects},
        labels={name for each in cases for name in each.labels.names},
    )
    return compare(cases, mapping)


def compare(cases: Sequence[Case], mapping: LabelMapping) -> Evaluation:
    """Compare observations with labels.

    Raises:
        UnknownNameError: Labels are of a link that was not observed, or no rule fits a segment.
    """
    found: dict[str, list[Tally]] = {}
    observed: set[str] = set()
    for case in cases:
        links = {mapping.links.get(each.ee, each.ee): each for each in case.observation.links}
        observed |= set(links)
        for name in case.labels.links:
            if name not in links:
                raise UnknownNameError("observed link", name, links, where=str(case.labels.path))
            marks = [Interval(each.start, each.end, each.label) for each in case.labels.of(name)]
            counts = tally(marks, labelled(links[name], mapping, case.times), case.times)
            found.setdefault(name, []).append(counts)
    by_link = {name: pooled(found[name]) for name in sorted(found)}
    return Evaluation(
        cases=tuple(each.observation.capture for each in cases),
        links=by_link,
        whole=pooled(by_link.values()),
        unlabelled=tuple(sorted(observed - set(found))),
        notices=tuple(each for case in cases for each in case.labels.notices),
    )


def known_names(observations: Sequence[Observation], base: Profile | None = None) -> set[str]:
    """Every name that a segment can bear: of the rules that ship, of a base's, and those seen."""
    names = {UNKNOWN}
    for rules in (profile(DEFAULT), *([base] if base else ())):
        found = solve(rules.files, "#show primitive/1.")
        names |= {str(name) for (name,) in found.of("primitive")}
    for segment in (each for one in observations for each in one.segments):
        names |= {segment.name, *segment.general, *segment.candidates}
    return names


def scores(counts: Tally) -> dict[str, Any]:
    """The scores that follow from counts: percentages, and errors in milliseconds."""
    classes = frame_f1(counts.confusion)
    return {
        "frames": counts.confusion.total(),
        "segments": {"true": counts.true, "predicted": counts.predicted},
        "accuracy": _rounded(accuracy(counts.confusion)),
        "macro_f1": _rounded(float(np.mean(list(classes.values()))) if classes else float("nan")),
        "f1_by_class": {name: _rounded(value) for name, value in classes.items()},
        **{f"f1@{each}": _rounded(segment_f1(counts, each)) for each in THRESHOLDS},
        "edit": _rounded(float(np.mean(counts.edits)) if counts.edits else float("nan")),
        "onset_ms": _errors(counts.onsets_s),
        "offset_ms": _errors(counts.offsets_s),
        "missed": dict(sorted(counts.missed.items())),
        "inserted": dict(sorted(counts.inserted.items())),
        "confusion": [
            {"true": one, "predicted": other, "frames": frames}
            for (one, other), frames in sorted(
                counts.confusion.items(), key=lambda each: (-each[1], each[0])
            )
        ],
    }


def report(evaluation: Evaluation) -> dict[str, Any]:
    """An evaluation as plain values, for JSON."""
    return {
        "captures": list(evaluation.cases),
        "matched_at_percent": MATCH_AT,
        "links": {name: scores(counts) for name, counts in evaluation.links.items()},
        "all": scores(evaluation.whole),
        "unlabelled_links": list(evaluation.unlabelled),
        "notices": list(evaluation.notices),
    }


def _case(place: str, path: Path, rules: Profile, frames_of: str) -> Case:
    labels = read_labels(path)
    if labels.in_frames:
        labels = in_seconds(labels, frame_times(place, file=frames_of))
    capture = read_capture(place)
    return Case(observe(capture, rules=rules), labels, capture.times)


def _errors(errors_s: Sequence[float]) -> dict[str, Any]:
    """Median and 95th percentile of the size of errors, and their median with its sign [ms]."""
    if not errors_s:
        return {"matched": 0, "median": None, "p95": None, "bias": None}
    errors = 1000.0 * np.asarray(errors_s)
    return {
        "matched": len(errors),
        "median": _rounded(float(np.median(np.abs(errors)))),
        "p95": _rounded(float(np.percentile(np.abs(errors), 95))),
        "bias": _rounded(float(np.median(errors))),
    }


def _rounded(value: float) -> float | None:
    return None if np.isnan(value) else round(value, 2)
