"""What is to be evaluated: captures paired with their labels, by an evaluation file or patterns."""

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, TypeAlias

from capar.evaluation.labels import Contradictions, Kind
from capar.evaluation.mapping import LabelMapping, read_mapping
from capar.evaluation.plan_schema import (
    CarryOptions,
    ContactArrays,
    ContainerOptions,
    EvaluationFile,
)
from capar.model.errors import CaparError, FileError, UnknownNameError
from extractors.readers.bundle.location import FILE, find_place, take_words
from extractors.readers.schema.document import expanded, read_toml, substituted, validated

Progress: TypeAlias = Callable[[Sequence[Any]], Iterable[Any]]
"""Goes through a sequence in order, and may show how far it is: ``iter`` shows nothing."""


@dataclass(frozen=True)
class Pair:
    """A capture with its labels."""

    capture: str
    labels: Path | None
    """The label file; None where the recording itself has the labels."""

    take: str = ""
    words: Mapping[str, str] = field(default_factory=dict)
    """What ``{...}`` stands for in the take."""

    @property
    def name(self) -> str:
        """The take; where the bundle has none, its folder, or its file if that says more."""
        file = find_place(self.capture).file
        folder = file.resolve().parent.name
        return self.take or (folder if file.name == FILE else f"{folder}_{file.stem}")


@dataclass(frozen=True)
class Plan:
    """Captures, their labels, and how to compare them."""

    kind: Kind
    pairs: tuple[Pair, ...]
    mapping: LabelMapping | None = None
    """Of actions; None if the labels are our own names."""

    frames_of: str = ""
    contradictions: Contradictions = Contradictions.REFUSE
    events: tuple[str, ...] = ()
    names: Mapping[str, str] = field(default_factory=dict)
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Names of takes that are also scored on their own."""

    contacts: ContactArrays | None = None
    carries: CarryOptions = field(default_factory=CarryOptions)
    containers: ContainerOptions | None = None

    def __post_init__(self) -> None:
        """Prove that containers are named."""
        if self.kind is Kind.CONTAINERS and self.containers is None:
            raise CaparError(
                'containers are named in an evaluation file: [containers] names = ["box"]'
            )


def read_plan(path: Path, *, takes: Sequence[str] = ()) -> Plan:
    """The plan that an evaluation file states.

    Args:
        path: The file.
        takes: Patterns of takes; only these of its takes are evaluated. Empty means all.

    Raises:
        CaparError: A key or value is not as the schema says, or no take fits; it names the line.
    """
    table = validated(EvaluationFile, *read_toml(path))
    place = path.parent / table.capture
    words = take_words(place) or {"": {}}
    chosen = [each for each in words if not each or _fits(each, table.takes)]
    chosen = [each for each in chosen if not takes or _fits(each, takes)]
    if not chosen:
        raise table.unknown("take", ", ".join(takes or table.takes), words, "takes")
    groups = {
        name: tuple(each for each in chosen if _fits(each, patterns))
        for name, patterns in table.groups.items()
    }
    return Plan(
        kind=Kind(table.kind),
        pairs=tuple(_pair(table, place, take, words[take]) for take in chosen),
        mapping=read_mapping(path.parent / table.mapping) if table.mapping else None,
        frames_of=table.frames_of,
        contradictions=Contradictions(table.contradictions),
        events=tuple(table.events),
        names=table.names,
        groups={name: members for name, members in groups.items() if members},
        contacts=table.contacts,
        carries=table.carries or CarryOptions(),
        containers=table.containers,
    )


def read_pairs(places: Sequence[str]) -> tuple[Pair, ...]:
    """Pairs from arguments: a capture, or a pattern of its takes, then its label file.

    ``BUNDLE:PATTERN`` stands for each take whose name fits; ``{take}``, and the other words of the
    take, are filled in in the label file's name.

    Raises:
        CaparError: An argument has no partner, or no take fits a pattern.
    """
    if len(places) % 2:
        raise CaparError(
            f"{len(places)} argument{'s' * (len(places) > 1)}: each capture is followed by its "
            "label file, as in: capar evaluate TAKE0 LABELS0 TAKE1 LABELS1 --mapping MAPPING; or "
            "give one evaluation file: capar evaluate EVALUATION.toml"
        )
    couples = zip(places[::2], places[1::2], strict=True)
    return tuple(pair for place, labels in couples for pair in _couple(place, labels))


def _couple(place: str, labels: str) -> list[Pair]:
    stem, _, pattern = place.rpartition(":")
    if not stem or not any(each in pattern for each in "*?["):
        words = take_words(place)
        take = find_place(place).take
        own = words.get(take, {})
        return [Pair(place, _filled(labels, own), take, own)]
    words = take_words(stem)
    chosen = [each for each in words if fnmatchcase(each, pattern)]
    if not chosen:
        raise UnknownNameError("take", pattern, words, where=stem)
    if len(chosen) > 1 and substituted(labels, {"take": ""}) == labels:
        raise FileError(
            labels, f"is one label file for {len(chosen)} takes.",
            "Write {take} in its name where the take's name stands.",
        )  # fmt: skip
    return [Pair(f"{stem}:{take}", _filled(labels, words[take]), take, words[take])
            for take in chosen]  # fmt: skip


def _pair(table: EvaluationFile, place: Path, take: str, words: Mapping[str, str]) -> Pair:
    labels = _filled(os.fspath(expanded(table, "labels")), words) if table.labels else None
    unneeded = table.containers or (table.carries and table.carries.presence_of)
    if labels is None and not unneeded:
        raise table.error("labels", "names no labels.", 'Write labels = "FILE", with {take} in it.')
    return Pair(f"{place}:{take}" if take else str(place), labels, take, words)


def _filled(labels: str, words: Mapping[str, str]) -> Path:
    return Path(substituted(labels, words))


def _fits(take: str, patterns: Sequence[str]) -> bool:
    return any(fnmatchcase(take, each) for each in patterns)
