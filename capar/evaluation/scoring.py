"""A plan carried out: captures observed and compared with their labels, and drawn beside them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar.evaluation import Kind
from capar.evaluation.contacts import score_contacts
from capar.evaluation.events import score_events
from capar.evaluation.labels import Labels, check_known, check_span
from capar.evaluation.metrics import (
    Channel,
    Evaluation,
    Interval,
    Scored,
    differences,
    merged,
    summed,
    tally,
)
from capar.evaluation.objects import score_carries, score_containers
from capar.evaluation.plan import (
    LabelMapping,
    Pair,
    Plan,
    Progress,
    check_names,
    known_names,
    labelled,
)
from capar.model.capture import Capture
from capar.model.errors import CaparError, FileError
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from capar.views.lettering import Span
from capar.views.picture import Lane, draw_comparison
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from extractors.readers.bundle.capture_toml import read_capture

SCORERS: Mapping[Kind, Callable[[Pair, Plan, Profile], Scored]] = {
    Kind.CONTACTS: score_contacts,
    Kind.CARRIES: score_carries,
    Kind.EVENTS: score_events,
    Kind.CONTAINERS: score_containers,
}
"""How one capture is scored; actions are scored together, by ``score_actions``."""

CAPTURE = "{capture}"
"""What stands in a picture's name for the capture."""


@dataclass(frozen=True)
class Case:
    """An observation with its labels, in seconds of one clock."""

    observation: Observation
    labels: Labels
    times: Float[np.ndarray, "frames"]
    """Time of each frame of the capture [s]."""

    name: str = ""
    """What it is called; the capture's name if empty."""


def evaluate(
    plan: Plan, *, rules: Profile | str = DEFAULT, progress: Progress = iter
) -> Evaluation:
    """Observe the captures of a plan and compare what is printed or stored with their labels.

    Args:
        plan: Captures, labels, and what the labels are about.
        rules: The rule profile to observe with, or its name.
        progress: Goes through the captures, one after the other, and may show how far it is.

    Raises:
        CaparError: A capture, a label file or the mapping has a fault.
    """
    base = profile(rules) if isinstance(rules, str) else rules
    if plan.kind is Kind.ACTIONS:
        return score_actions(plan, base, progress)
    captures = tuple(SCORERS[plan.kind](pair, plan, base) for pair in progress(plan.pairs))
    return Evaluation(plan.kind, captures, plan.groups)


def score_actions(plan: Plan, base: Profile, progress: Progress) -> Evaluation:
    """Observe captures and compare the names of their segments with labels.

    Every fault of the labels is found before anything is observed.

    Raises:
        CaparError: A capture, a label file or the mapping has a fault.
    """
    mapping, strangers = (plan.mapping, []) if plan.mapping else _own_names(plan, base)
    read: list[tuple[Pair, Labels, Capture]] = []
    for pair in plan.pairs:
        labels, capture = plan.labels_of(pair), read_capture(pair.capture)
        links = [mapping.links.get(each.name, each.name) for each in capture.acting]
        _check_labels(labels, links, mapping)
        check_span(labels, capture.times)
        read.append((pair, labels, capture))
    cases = [
        Case(observe(capture, rules=base), labels, capture.times, pair.name)
        for pair, labels, capture in progress(read)
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
    labels = {name for pair in plan.pairs for name in plan.labels_of(pair).names}
    names = known_names((), base)
    if not labels & names:
        raise CaparError(
            f"none of the labels is a name that our rules give ({', '.join(sorted(labels))}); "
            "other labels of actions need --mapping FILE: a TOML file from our names to the "
            'labels, as in: [[rule]] name = "Reach" label = "approach"'
        )
    strangers = [f"no rule gives the label {name!r}" for name in sorted(labels - names)]
    every = tuple({*names, *labels})
    return LabelMapping(Path(), (), {}, every, own_names=True), strangers


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
    captures = []
    for case in cases:
        links = {mapping.links.get(each.ee, each.ee): each for each in case.observation.links}
        _check_labels(case.labels, links, mapping)
        channels = tuple(
            Channel(
                name,
                tuple(Interval(each.start, each.end, each.label) for each in case.labels.of(name)),
                labelled(links[name], mapping),
                segments=links[name].segments,
            )
            for name in case.labels.links
        )
        parts = {each.name: tally(each.true, each.found, case.times) for each in channels}
        captures.append(
            Scored(
                name=case.name or case.observation.capture,
                times=case.times,
                channels=channels,
                parts=parts,
                whole=summed(parts.values()),
                unlabelled=tuple(sorted(set(links) - set(parts))),
                notices=case.labels.notices,
            )
        )
    return Evaluation(Kind.ACTIONS, tuple(captures), dict(groups or {}), tuple(notices))


def _check_labels(labels: Labels, links: Iterable[str], mapping: LabelMapping) -> None:
    check_known(labels, "observed link", links, at="link")
    check_known(labels, "label in the mapping", mapping.labels, at="label")


def picture_paths(path: Path, captures: Iterable[str]) -> dict[str, Path]:
    """The picture of each capture.

    Raises:
        FileError: There are several captures, and the name has no place for theirs.
    """
    names = list(captures)
    if CAPTURE in str(path):
        return {name: Path(str(path).replace(CAPTURE, name)) for name in names}
    if len(names) > 1:
        raise FileError(
            path,
            f"is one picture for {len(names)} captures.",
            f"Write {CAPTURE} in its name, or evaluate one take: --takes {names[0]}",
        )
    return dict.fromkeys(names, path)


def draw_evaluation(evaluation: Evaluation, capture: Scored, *, path: Path) -> None:
    """Draw one capture: for each channel its segments, what was found, labels and differences.

    Raises:
        FileError: The suffix is no picture's, or the file cannot be written.
    """
    last = float(capture.times[-1])

    def spans(intervals: Iterable[Interval]) -> tuple[Span, ...]:
        return tuple(Span(e.start_s, min(e.end_s, last), e.label) for e in merged(intervals))

    lanes = []
    for channel in capture.channels:
        wrong = differences(capture.name, [channel], capture.times)
        segments = (
            Span(each.start_s, each.end_s, each.name, (each.general or (each.name,))[-1])
            for each in channel.segments
        )
        lanes.append(
            Lane(
                name=channel.name,
                segments=tuple(segments),
                found=spans(channel.found),
                true=spans(channel.true),
                wrong=tuple(Span(each.start_s, each.end_s, "") for each in wrong),
            )
        )
    subtitle = f"{evaluation.kind} by labels · {last:.2f} s"
    draw_comparison(capture.name, subtitle, lanes, last - float(capture.times[0]), path=path)
