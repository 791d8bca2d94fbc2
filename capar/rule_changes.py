"""What a change of rules does to what was observed: names compared, and segments renamed."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from capar.model.capture import Capture
from capar.model.errors import FileError, RuleError, UnknownNameError
from capar.model.facts import Fact
from capar.model.observation import Observation, ObservedLink, Segment
from capar.model.par import FeatureSet
from capar.observe import observe
from capar_rules.authoring import new_rule, telling
from capar_rules.examples import Example, try_examples
from capar_rules.profiles import Profile
from capar_rules.reasoning import infer
from extractors.facts import extract
from extractors.readers.bundle import read_capture, takes
from kb.actionary import Actionary
from kb.lookup.changes import facts, replace_all, source_files

Seen = Mapping[str, tuple[Fact, ...]]
"""The facts of captures, by the capture's name."""


@dataclass(frozen=True, slots=True, order=True)
class Renamed:
    """A segment that two rule bases name differently."""

    capture: str
    ee: str
    index: int
    start_s: float
    end_s: float
    before: str
    after: str


def stored_facts(actionary: str | None) -> Seen:
    """The facts of every observation in an Actionary.

    Raises:
        StoreError: There is nothing to read.
    """
    with Actionary.open(actionary, read_only=True) as store:
        return dict(_stored(store))


def captured_facts(captures: Iterable[str]) -> Seen:
    """The facts of captures that are read and measured now.

    Raises:
        CaparError: A capture cannot be read.
    """
    trials = [read_capture(each) for each in captures]
    return {each.name: extract(each).facts for each in trials}


def renamed(seen: Seen, *, before: Profile, after: Profile) -> tuple[Renamed, ...]:
    """The segments that have another name by another rule base, by capture and time.

    Raises:
        RuleError: A rule base has a fault.
    """
    changes = []
    for capture in sorted(seen):
        old, new = (_names(seen[capture], each) for each in (before, after))
        for key, segment in sorted(new.items()):
            was = old[key].name if key in old else "none"
            if was != segment.name:
                changes.append(
                    Renamed(
                        capture, segment.ee, segment.index, segment.start_s, segment.end_s,
                        was, segment.name,
                    )
                )  # fmt: skip
    return tuple(changes)


def reclassified(
    actionary: str | None, *, before: Profile, after: Profile, captures: Sequence[Path]
) -> tuple[Renamed, ...]:
    """Rename what rules change in an Actionary, all of it in one transaction.

    Args:
        actionary: Its place; None for the usual one.
        before: The rules that named the segments.
        after: Those that are to name them.
        captures: Folders below which the captures are, as they were when they were observed.

    Each observation that changes is made anew from its capture's files, which must be those that
    it was made from; it then says which rules it rests on.

    Raises:
        FileError: The files of a capture are gone or have changed; nothing is renamed then.
        StoreError: The Actionary cannot be used.
    """
    with Actionary.open(actionary) as store:
        changes = renamed(dict(_stored(store)), before=before, after=after)
        names = {each.name: each.action for each in store.observations()}
        anew = [
            (
                _anew(source_files(store.store, each), each, names[each], after, captures),
                names[each],
            )
            for each in sorted({each.capture for each in changes})
        ]
        replace_all(store.store, anew)
    return changes


def rule_from_features(
    name: str, features: str, *, definition: str = "", general: str = "", verb: str = ""
) -> str:
    """A rule file for the feature set that a user writes: ``100,101,10,00``.

    Raises:
        RuleError: It is no feature set.
        ParError: Its strings do not belong together.
    """
    parts = [each.strip() for each in features.split(",")]
    if len(parts) != 4:
        raise RuleError(f"{features!r} is no feature set; write START,END,CHANGE,FORCE")
    start, end, change, force = parts
    found = FeatureSet(start, end, change, "any", force)
    return new_rule(name, found, definition=definition, general=general, verb=verb)


def rule_from_segment(
    name: str,
    source: str,
    *,
    rules: Profile,
    definition: str = "",
    general: str = "",
    verb: str = "",
) -> str:
    """A rule file for the features of an observed segment, with its capture as an example.

    Args:
        name: What the primitive is called.
        source: CAPTURE:SEGMENT, the segment as END_EFFECTOR/INDEX.
        rules: The rules by which the capture is cut into segments.
        definition: What it is, in words.
        general: The primitive that it specialises.
        verb: The verb for it.

    Raises:
        RuleError: The source names no segment.
        CaparError: The capture cannot be read.
    """
    capture, colon, place = source.rpartition(":")
    if not colon:
        raise RuleError(f"{source!r} names no segment; write CAPTURE:END_EFFECTOR/INDEX")
    trial = read_capture(capture)
    measured = extract(trial).facts
    segment = _segment(infer(measured, profile=rules).links, place, trial)
    told = telling(measured)
    (outcome,) = try_examples([Example("", True, told, (), 0)], profile=rules)
    names = tuple(
        (ee, tuple(
            name if (ee, at) == (segment.ee, segment.index) else each
            for at, each in enumerate(found)
        ))
        for ee, found in outcome.found
    )  # fmt: skip
    example = Example(f"{trial.name}, segment {place}.", True, told, names, 0)
    return new_rule(
        name, segment.features, definition=definition, general=general, verb=verb,
        examples=[example],
    )  # fmt: skip


def _segment(links: Sequence[ObservedLink], place: str, trial: Capture) -> Segment:
    segments = [each for link in links for each in link.segments]
    known = {f"{each.ee}/{each.index}": each for each in segments}
    if len(links) == 1:
        known |= {str(each.index): each for each in segments}
    if place not in known:
        raise UnknownNameError("segment", place, known, where=trial.name)
    return known[place]


def _names(measured: tuple[Fact, ...], rules: Profile) -> dict[tuple[str, int, int], Segment]:
    links = infer(measured, profile=rules).links
    return {(each.ee, each.first, each.last): each for link in links for each in link.segments}


def _stored(store: Actionary) -> Iterator[tuple[str, tuple[Fact, ...]]]:
    for each in store.observations():
        yield each.name, facts(store.store, each.name)


def _trials(path: Path, name: str) -> Iterator[Capture]:
    """The captures that a file describes and that may bear a name: of its takes, or the one."""
    known = takes(path)
    # A capture is called after its take, so that the others need not be read.
    named = sorted((each for each in known if each in name), key=lambda each: (-len(each), each))
    for place in [f"{path}:{each}" for each in named] if known else [path]:
        trial = read_capture(place)
        if trial.name == name:
            yield trial


def _anew(
    files: Sequence[tuple[str, str]],
    capture: str,
    action: str,
    rules: Profile,
    places: Iterable[Path],
) -> Observation:
    """The observation of the same files by other rules."""
    digests = sorted(digest for _, digest in files)
    for place in places:
        for path in sorted(place.rglob("*.toml")):
            if path.is_file() and sha256(path.read_bytes()).hexdigest() in digests:
                for trial in _trials(path, capture):
                    if sorted(each.sha256 for each in trial.sources) == digests:
                        return observe(trial, rules=rules, name=action)
    searched = ", ".join(map(str, places))
    raise FileError(
        files[0][0] if files else capture,
        f"and the other files from which {capture!r} was observed are not below {searched}, or "
        "have changed; nothing was renamed.",
        "Name the folder that holds them with --captures, or observe and add it anew.",
    )
