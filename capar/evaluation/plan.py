"""What is to be evaluated: captures paired with their labels, by an evaluation file or patterns."""

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

from capar.evaluation import Contradictions, Kind
from capar.evaluation.labels import Labels, in_seconds, read_labels
from capar.evaluation.metrics import Interval
from capar.model.errors import CaparError, FileError, UnknownNameError
from capar.model.observation import Observation, ObservedLink, Segment
from capar.model.par import UNKNOWN
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.engine.solver import solve
from extractors.readers.bundle.capture_toml import FILE, find_place, frame_times, take_words
from extractors.readers.schema.capture import Positive
from extractors.readers.schema.entry import Entry, expanded, key, read_toml, substituted, validated

# ruff: noqa: RUF012  (pydantic copies the defaults of fields)


class MappingRule(Entry):
    """A label, and the segments that have it."""

    name: Annotated[str, key("The segment's name, or one that it specialises; * fits all.")]
    label: Annotated[str, key("The label.")]
    object: Annotated[str, key("Among the segment's objects.")] = ""
    dominant: Annotated[str, key("The segment's dominant object.")] = ""
    position: Annotated[
        Literal["before first", "after last", ""], key("Relative to the link's contacts.")
    ] = ""
    previous: Annotated[
        str | None, key("Name of the segment before; empty if there must be none.")
    ] = None
    next: Annotated[str | None, key("Name of the segment after; empty if there must be none.")] = (
        None
    )


class MappingFile(Entry):
    """Rules in order, and names of links."""

    links: Annotated[dict[str, str], key("Our link = the label file's, where they differ.")] = {}
    rule: Annotated[list[MappingRule], key("Rules; the first that fits counts.")] = []
    others: Annotated[
        list[str], key("Labels that no rule gives and that may occur: those segments are missed.")
    ] = []


ANY = "*"


@dataclass(frozen=True, slots=True)
class LabelMapping:
    """Rules in order, and names of links."""

    path: Path
    rules: tuple[MappingRule, ...]
    links: Mapping[str, str]
    """Of the label file, by ours, where they differ."""

    others: tuple[str, ...] = ()
    """Labels that no rule gives and that may nevertheless occur."""

    own_names: bool = False
    """Whether the labels are our own names, so that a segment's label is its name."""

    @property
    def labels(self) -> set[str]:
        """Every label that may occur."""
        return {*(each.label for each in self.rules), *self.others}


def read_mapping(path: Path) -> LabelMapping:
    """Read a mapping file.

    Raises:
        CaparError: A key or a value is not as above; it names the line.
    """
    table = validated(MappingFile, *read_toml(path))
    if not table.rule:
        raise FileError(path, "has no rule.", 'Write [[rule]], name = "Reach", label = "approach".')
    return LabelMapping(path, tuple(table.rule), table.links, tuple(table.others))


def known_names(observations: Sequence[Observation], base: Profile | None = None) -> set[str]:
    """Every name that a segment can bear: of the rules that ship, of a base's, and those seen."""
    names = {UNKNOWN}
    for rules in (profile(DEFAULT), *([base] if base else ())):
        found = solve(rules.files, "#show primitive/1.")
        names |= {str(name) for (name,) in found.of("primitive")}
    for segment in (each for one in observations for each in one.segments):
        names |= {segment.name, *segment.general, *segment.candidates}
    return names


def check_names(
    mapping: LabelMapping, *, names: Iterable[str], objects: Iterable[str], labels: Iterable[str]
) -> tuple[str, ...]:
    """Prove that every name in the rules is one that exists.

    Args:
        mapping: The rules.
        names: What segments can be called.
        objects: What objects are called.
        labels: The labels that occur in the label files.

    Returns:
        A notice for each label that a rule gives and that is in no label file, as where the labels
        are of one hand only.

    Raises:
        UnknownNameError: One does not; it lists those that do.
    """
    known = {"action": {*names, ANY}, "object": set(objects)}
    occur = set(labels)
    notices: dict[str, str] = {}
    for rule in mapping.rules:
        if rule.label not in occur:
            text = f"{rule.where('name')}: the label {rule.label!r} is in no label file"
            notices.setdefault(rule.label, text)
        wanted = [("action", rule.name)]
        wanted += [("action", each) for each in (rule.previous, rule.next) if each]
        wanted += [("object", each) for each in (rule.object, rule.dominant) if each]
        for kind, name in wanted:
            if name not in known[kind]:
                raise UnknownNameError(kind, name, known[kind], where=rule.where("name"))
    return tuple(notices.values())


def labelled(link: ObservedLink, mapping: LabelMapping) -> tuple[Interval, ...]:
    """The segments of a link, with the times that are printed, under the labels of the rules.

    Raises:
        UnknownNameError: No rule fits a segment; it lists the names that have rules.
    """
    found = []
    for index, each in enumerate(link.segments):
        fitting = (rule.label for rule in mapping.rules if _fits(rule, link.segments, index))
        label = each.name if mapping.own_names else next(fitting, None)
        if label is None:
            place = f"{mapping.path}: {each.ee} from {each.start_s:.2f} s"
            names = {rule.name for rule in mapping.rules}
            raise UnknownNameError("fitting rule for", each.name, names, where=place)
        found.append(Interval(each.start_s, each.end_s, label))
    return tuple(found)


def _fits(rule: MappingRule, segments: Sequence[Segment], index: int) -> bool:
    segment = segments[index]
    contacts = ["1" in each.features.rel_start for each in segments]
    ends = ["1" in each.features.rel_end for each in segments]

    def neighbour(name: str | None, beside: Sequence[Segment]) -> bool:
        """Whether a neighbour bears a name; an empty name means that there is none."""
        if name is None or not name or not beside:
            return name is None or (not name and not beside)
        return name in {ANY, beside[0].name, *beside[0].general}

    return (
        rule.name in {ANY, segment.name, *segment.general}
        and (not rule.object or rule.object in segment.objects)
        and (not rule.dominant or segment.objects[:1] == (rule.dominant,))
        and (rule.position != "before first" or not any(contacts[: index + 1]))
        and (rule.position != "after last" or not any(ends[index:]))
        and neighbour(rule.previous, segments[:index][-1:])
        and neighbour(rule.next, segments[index + 1 : index + 2])
    )


class ContactArrays(Entry):
    """Labels of contact as an array of an NPZ file: a value for each frame and body."""

    labels: Annotated[str, key("Array of labels: (frames, bodies).")]
    bodies: Annotated[str, key("Array of the bodies' names.")]
    other: Annotated[str, key("What they touch; {...} stands for the take's words.")]
    touching: Annotated[int, key("The value of a frame in which a body touches it.")] = 1
    open: Annotated[int | None, key("The value of a frame that is not to be counted.")] = None


class CarryOptions(Entry):
    """How carries are found in what was observed, and what they are held against."""

    names: Annotated[
        list[str], key("Names of segments in which an object is carried, or what they specialise.")
    ] = ["MoveObj", "MoveObjTo"]
    within_s: Annotated[Positive, key("An end this near to the label is found.", unit="s")] = 0.1
    moves_m: Annotated[
        Positive, key("What moves less than this in its carry is excluded.", unit="m")
    ] = 0.001
    presence_of: Annotated[
        str,
        key(
            "Name under ``[files]`` of a recording that has each object while it is carried, and "
            "at no other time: its first and last pose are the labels."
        ),
    ] = ""
    hand: Annotated[
        str,
        key("The sensor that carries, where ``presence_of`` is given: it goes with the object."),
    ] = ""
    extend_s: Annotated[
        Positive,
        key("How long the object rests before its first and after its last pose.", unit="s"),
    ] = 2.0


class ContainerOptions(Entry):
    """Containers, into which objects are told to go or not."""

    names: Annotated[list[str], key("Objects that are containers.")]
    halves: Annotated[
        bool, key("Whether each is parted across its middle into two containers.")
    ] = False


class EvaluationFile(Entry):
    """Captures, labels, and what the labels are about."""

    kind: Annotated[
        Literal["actions", "contacts", "carries", "events", "containers"],
        key("What the labels are about."),
    ]
    capture: Annotated[str, key("A bundle, relative to this file.")] = "capture.toml"
    takes: Annotated[list[str], key("Patterns of the takes' names.")] = ["*"]
    labels: Annotated[
        str | None,
        key(
            "The label file, relative to this one; {take} and other words of the take are filled "
            "in, ${NAME} is an environment variable."
        ),
    ] = None
    mapping: Annotated[str | None, key("Actions: the mapping file, relative to this one.")] = None
    frames_of: Annotated[str, key("File of the capture whose frames the labels count.")] = ""
    contradictions: Annotated[
        Literal["refuse", "leave-out"],
        key("What to do about marks that end before they start or overlap."),
    ] = "refuse"
    events: Annotated[
        list[str], key("Events: what counts if found and not labelled; else what is labelled.")
    ] = []
    names: Annotated[dict[str, str], key("The label files' name of a body = ours.")] = {}
    groups: Annotated[
        dict[str, list[str]], key("Patterns of takes that are also scored on their own, by name.")
    ] = {}
    contacts: Annotated[
        ContactArrays | None, key("Contacts: labels that are arrays of an NPZ file.")
    ] = None
    carries: Annotated[CarryOptions | None, key("Carries: how they are found.")] = None
    containers: Annotated[
        ContainerOptions | None, key("Containers: which; the poses of objects are the labels.")
    ] = None


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
        file = find_place(self.capture)[0]
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

    def labels_of(self, pair: Pair) -> Labels:
        """The labels of a capture, in seconds of its clock, with our names of bodies.

        Raises:
            CaparError: The label file has a fault.
        """
        assert pair.labels is not None, "a plan without label files reads none"
        labels = read_labels(pair.labels, self.kind, contradictions=self.contradictions)
        if labels.in_frames:
            labels = in_seconds(labels, frame_times(pair.capture, file=self.frames_of))
        return labels.renamed(dict(self.names))


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
    chosen = [each for each in words if not each or _is_among(each, table.takes)]
    chosen = [each for each in chosen if not takes or _is_among(each, takes)]
    if not chosen:
        raise table.unknown("take", ", ".join(takes or table.takes), words, "takes")
    groups = {
        name: tuple(each for each in chosen if _is_among(each, patterns))
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
        take = find_place(place)[1]
        own = words.get(take, {})
        return [Pair(place, Path(substituted(labels, own)), take, own)]
    words = take_words(stem)
    chosen = [each for each in words if fnmatchcase(each, pattern)]
    if not chosen:
        raise UnknownNameError("take", pattern, words, where=stem)
    if len(chosen) > 1 and substituted(labels, {"take": ""}) == labels:
        raise FileError(
            labels, f"is one label file for {len(chosen)} takes.",
            "Write {take} in its name where the take's name stands.",
        )  # fmt: skip
    return [Pair(f"{stem}:{take}", Path(substituted(labels, words[take])), take, words[take])
            for take in chosen]  # fmt: skip


def _pair(table: EvaluationFile, place: Path, take: str, words: Mapping[str, str]) -> Pair:
    labels = None
    if table.labels:
        labels = Path(substituted(os.fspath(expanded(table, "labels")), words))
    unneeded = table.containers or (table.carries and table.carries.presence_of)
    if labels is None and not unneeded:
        raise table.error("labels", "names no labels.", 'Write labels = "FILE", with {take} in it.')
    return Pair(f"{place}:{take}" if take else str(place), labels, take, words)


def _is_among(take: str, patterns: Sequence[str]) -> bool:
    return any(fnmatchcase(take, each) for each in patterns)
