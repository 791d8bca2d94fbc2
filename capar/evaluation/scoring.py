"""Segments held against labels of actions: captures observed, link by link and pooled."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.evaluation.labels import Kind, Labels, check_known, check_span, in_seconds, read_labels
from capar.evaluation.metrics import Channel, Evaluation, Interval, Scored, summed, tally
from capar.evaluation.plan import (
    LabelMapping,
    Pair,
    Plan,
    Progress,
    check_names,
    labelled,
    own_names,
)
from capar.model.capture import Capture
from capar.model.errors import CaparError
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

    name: str = ""
    """What it is called; the capture's name if empty."""


def score_actions(plan: Plan, base: Profile, progress: Progress) -> Evaluation:
    """Observe captures and compare the names of their segments with labels.

    Raises:
        CaparError: A capture, a label file or the mapping has a fault.
    """
    mapping, strangers = (plan.mapping, []) if plan.mapping else _own_names(plan, base)
    read = [(pair, _prepared(pair, plan, mapping)) for pair in plan.pairs]
    cases = [
        Case(observe(capture, rules=base), labels, capture.times, pair.name)
        for pair, (labels, capture) in progress(read)
    ]
    notices = check_names(
        mapping,
        names=known_names([each.observation for each in cases], base),
        objects={thing.name for each in cases for thing in each.observation.objects},
        labels={name for each in cases for name in each.labels.names},
    )
    return compare(cases, mapping, groups=plan.groups, notices=[*strangers, *notices])


def _own_names(plan: Plan, base: Profile) -> tuple[LabelMapping, list[str]]:
    """The mapping of labels that are our own names, and a notice for each that is none.

    Raises:
        CaparError: None of the labels is one.
    """
    labels = {name for pair in plan.pairs for name in read_case_labels(pair, plan).names}
    names = known_names((), base)
    if not labels & names:
        raise CaparError(
            f"none of the labels is a name that our rules give ({', '.join(sorted(labels))}); "
            "other labels of actions need --mapping FILE: a TOML file from our names to the "
            'labels, as in: [[rule]] name = "Reach" label = "approach"'
        )
    strangers = [f"no rule gives the label {name!r}" for name in sorted(labels - names)]
    return own_names({*names, *labels}), strangers


def compare(
    cases: Sequence[Case],
    mapping: LabelMapping,
    *,
    groups: Mapping[str, tuple[str, ...]] | None = None,
    notices: Sequence[str] = (),
) -> Evaluation:
    """Compare observations with labels.

    Raises:
        UnknownNameError: Labels are of a link that was not observed, a label is one that no rule
            of the mapping gives, or no rule fits a segment.
    """
    captures = tuple(_scored(case, mapping) for case in cases)
    return Evaluation(Kind.ACTIONS, captures, dict(groups or {}), tuple(notices))


def known_names(observations: Sequence[Observation], base: Profile | None = None) -> set[str]:
    """Every name that a segment can bear: of the rules that ship, of a base's, and those seen."""
    names = {UNKNOWN}
    for rules in (profile(DEFAULT), *([base] if base else ())):
        found = solve(rules.files, "#show primitive/1.")
        names |= {str(name) for (name,) in found.of("primitive")}
    for segment in (each for one in observations for each in one.segments):
        names |= {segment.name, *segment.general, *segment.candidates}
    return names


def read_case_labels(pair: Pair, plan: Plan) -> Labels:
    """The labels of a capture, in seconds of its clock, with our names of bodies.

    Raises:
        CaparError: The label file has a fault.
    """
    assert pair.labels is not None, "a plan without label files reads none"
    labels = read_labels(pair.labels, plan.kind, contradictions=plan.contradictions)
    if labels.in_frames:
        labels = in_seconds(labels, frame_times(pair.capture, file=plan.frames_of))
    return labels.renamed(dict(plan.names))


def _prepared(pair: Pair, plan: Plan, mapping: LabelMapping) -> tuple[Labels, Capture]:
    """Labels and capture, with every fault of the labels found before anything is observed."""
    labels = read_case_labels(pair, plan)
    capture = read_capture(pair.capture)
    links = [mapping.links.get(each.name, each.name) for each in capture.acting]
    _check_labels(labels, links, mapping)
    check_span(labels, capture.times)
    return labels, capture


def _check_labels(labels: Labels, links: Iterable[str], mapping: LabelMapping) -> None:
    check_known(labels, "observed link", links, at="link")
    check_known(labels, "label in the mapping", mapping.labels, at="label")


def _scored(case: Case, mapping: LabelMapping) -> Scored:
    links = {mapping.links.get(each.ee, each.ee): each for each in case.observation.links}
    _check_labels(case.labels, links, mapping)
    channels = tuple(
        Channel(
            name,
            true=tuple(Interval(each.start, each.end, each.label) for each in case.labels.of(name)),
            found=labelled(links[name], mapping),
            segments=links[name].segments,
        )
        for name in case.labels.links
    )
    parts = {each.name: tally(each.true, each.found, case.times) for each in channels}
    return Scored(
        name=case.name or case.observation.capture,
        times=case.times,
        channels=channels,
        parts=parts,
        whole=summed(parts.values()),
        unlabelled=tuple(sorted(set(links) - set(parts))),
        notices=case.labels.notices,
    )
