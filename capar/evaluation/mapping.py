"""From the names that rules give to the names that people used in their labels.

A mapping is a TOML file of rules (see ``mapping_schema``); the first that fits a segment gives
its label.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from capar.evaluation.metrics import Interval
from capar.model.errors import FileError, UnknownNameError
from capar.model.observation import ObservedLink, Segment
from extractors.readers.schema.document import read_toml, validated

ANY = "*"


@dataclass(frozen=True, slots=True)
class Rule:
    """Which segments bear a label; an empty or missing condition fits all."""

    name: str
    label: str
    object: str = ""
    dominant: str = ""
    position: str = ""
    previous: str | None = None
    next: str | None = None
    where: str = ""
    """File and line."""


@dataclass(frozen=True, slots=True)
class LabelMapping:
    """Rules in order, and names of links."""

    path: Path
    rules: tuple[Rule, ...]
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
    from capar.evaluation.mapping_schema import MappingFile

    table = validated(MappingFile, *read_toml(path))
    if not table.rule:
        raise FileError(path, "has no rule.", 'Write [[rule]], name = "Reach", label = "approach".')
    rules = tuple(Rule(**dict(each), where=each.where("name")) for each in table.rule)
    return LabelMapping(path, rules, table.links, tuple(table.others))


def own_names(names: Iterable[str]) -> LabelMapping:
    """The mapping of labels that are our own names, as those of ``capar correct --labels``.

    Args:
        names: What segments can be called, and what else the labels may say.
    """
    return LabelMapping(Path(), (), {}, tuple(names), own_names=True)


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
            text = f"{rule.where}: the label {rule.label!r} is in no label file"
            notices.setdefault(rule.label, text)
        wanted = [("action", rule.name)]
        wanted += [("action", each) for each in (rule.previous, rule.next) if each]
        wanted += [("object", each) for each in (rule.object, rule.dominant) if each]
        for kind, name in wanted:
            if name not in known[kind]:
                raise UnknownNameError(kind, name, known[kind], where=rule.where)
    return tuple(notices.values())


def labelled(link: ObservedLink, mapping: LabelMapping) -> tuple[Interval, ...]:
    """The segments of a link, with the times that are printed, under the labels of the rules.

    Args:
        link: The segments.
        mapping: The rules.

    Raises:
        UnknownNameError: No rule fits a segment; it lists the names that have rules.
    """
    return tuple(
        Interval(each.start_s, each.end_s, _label(link.segments, index, mapping))
        for index, each in enumerate(link.segments)
    )


def _label(segments: Sequence[Segment], index: int, mapping: LabelMapping) -> str:
    if mapping.own_names:
        return segments[index].name
    for rule in mapping.rules:
        if _fits(rule, segments, index):
            return rule.label
    segment = segments[index]
    place = f"{mapping.path}: {segment.ee} from {segment.start_s:.2f} s"
    ruled = {each.name for each in mapping.rules}
    raise UnknownNameError("fitting rule for", segment.name, ruled, where=place)


def _fits(rule: Rule, segments: Sequence[Segment], index: int) -> bool:
    segment = segments[index]
    return (
        rule.name in {ANY, segment.name, *segment.general}
        and (not rule.object or rule.object in segment.objects)
        and (not rule.dominant or segment.objects[:1] == (rule.dominant,))
        and (not rule.position or POSITIONS[rule.position](segments, index))
        and (rule.previous is None or _is(rule.previous, segments[:index][-1:]))
        and (rule.next is None or _is(rule.next, segments[index + 1 : index + 2]))
    )


def _is(name: str, neighbour: Sequence[Segment]) -> bool:
    """Whether the neighbour bears the name; an empty name means that there is none."""
    if not neighbour or not name:
        return not neighbour and not name
    return name in {ANY, neighbour[0].name, *neighbour[0].general}


def _before_first(segments: Sequence[Segment], index: int) -> bool:
    return not any("1" in each.features.rel_start for each in segments[: index + 1])


def _after_last(segments: Sequence[Segment], index: int) -> bool:
    return not any("1" in each.features.rel_end for each in segments[index:])


POSITIONS: dict[str, Callable[[Sequence[Segment], int], bool]] = {
    "before first": _before_first,
    "after last": _after_last,
}
"""Places in the sequence: before the first contact begins, and after the last one ends."""
