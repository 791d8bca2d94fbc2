"""What a change of rules does to what was observed: names compared, and segments renamed."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from capar.model.facts import Fact
from capar.model.observation import Observation
from capar.pipelines.observation import facts_program, observe_again
from capar_rules.authoring.user_primitives import checked_draft
from capar_rules.authoring.user_rules import unbroken
from capar_rules.engine.profiles import Profile
from capar_rules.lint.checking import admitted_profile
from capar_rules.pars.inference import infer
from extractors.readers.bundle.capture_toml import read_capture
from kb.actionary import Actionary
from kb.encode.observation import stored_facts
from kb.lookup.observations import NamedSegment, named_segments, replace_all, source_files

NOTHING = "none"
"""Stands for the name of a segment that is not there before, or not after."""


@dataclass(frozen=True, slots=True)
class Trial:
    """What a capture's segments are named by."""

    facts: tuple[Fact, ...]
    names: tuple[NamedSegment, ...] | None = None
    """The segments as they are stored; None where the rules before are to name them."""


Seen = Mapping[str, Trial]
"""Trials by the capture's name."""


@dataclass(frozen=True, slots=True)
class Kept:
    """The observations of an Actionary that a change of rules concerns, and the others."""

    seen: Seen
    others: tuple[str, ...]
    """Those that were made with another profile, which are left alone; sorted."""


@dataclass(frozen=True, slots=True, order=True)
class Renamed:
    """A segment that two rule bases name differently; ``none`` where one of them has none."""

    capture: str
    ee: str
    index: int
    start_s: float
    end_s: float
    before: str
    after: str
    before_others: tuple[str, ...] = ()
    """Names that shared the segment with the one before."""

    after_others: tuple[str, ...] = ()
    """Names that share it with the one after, until one of them precedes the other."""


@dataclass(frozen=True, slots=True)
class Effect:
    """What was renamed in an Actionary, and the observations that were left alone."""

    changes: tuple[Renamed, ...]
    others: tuple[str, ...]
    """Those that were made with another profile; sorted."""


def stored(actionary: str | None, *, profile: str) -> Kept:
    """The observations in an Actionary that were made with a profile, as they are stored.

    Raises:
        StoreError: There is nothing to read.
    """
    with Actionary.open(actionary, read_only=True) as store:
        return _kept(store, profile)


def captured(captures: Iterable[str], *, rules: Profile) -> Seen:
    """Captures that are read and measured now, flicker resolved as the rules have it.

    Raises:
        CaparError: A capture cannot be read.
    """
    trials = [read_capture(each) for each in captures]
    return {each.name: Trial(facts_program(each, rules=rules)[0].facts) for each in trials}


def renamed(seen: Seen, *, before: Profile, after: Profile) -> tuple[Renamed, ...]:
    """The segments that have another name, or share theirs with others, by capture and time.

    Args:
        seen: Trials; what is stored of one is what its segments are named before.
        before: The rules that name the segments of the other trials.
        after: Those that are to name them.

    Raises:
        RuleError: A rule base has a fault.
    """
    changes = []
    for capture, trial in sorted(seen.items()):
        names = _names(trial.facts, before) if trial.names is None else trial.names
        old, new = (
            {(row.ee, row.first, row.last): row for row in rows}
            for rows in (names, _names(trial.facts, after))
        )
        for key in sorted(old.keys() | new.keys()):
            was, now = old.get(key), new.get(key)
            segment = now or old[key]
            old_name, new_name = (each.name if each else NOTHING for each in (was, now))
            old_others, new_others = (each.others if each else () for each in (was, now))
            if (old_name, old_others) != (new_name, new_others):
                place = segment.ee, segment.index, segment.start_s, segment.end_s
                told = old_name, new_name, old_others, new_others
                changes.append(Renamed(capture, *place, *told))
    return tuple(changes)


def add_reclassifying(
    path: Path,
    *,
    folder: Path,
    actionary: str | None,
    base: str,
    over: Sequence[str] = (),
    kind_of: Sequence[str] = (),
    beside: Sequence[Path],
    captures: Sequence[Path],
) -> tuple[Path, Effect]:
    """Take a rule file among the user's rules and rename what it changes: both, or neither.

    Args:
        path: The file.
        folder: The folder of rules that it goes to.
        actionary: The Actionary's place; None for the usual one.
        base: The profile that it joins.
        over: Primitives that it is to precede; ``all`` stands for each that may name a segment
            with it.
        kind_of: Primitives that it is to specialise.
        beside: Every rule file that counts already.
        captures: Folders below which the captures are.

    Returns:
        Where the file now is, and the segments that have another name.

    Raises:
        CaparError: The rule does not count, or the observations cannot be made again.
    """
    with checked_draft(
        path, folder=folder, base=base, over=over, kind_of=kind_of, beside=beside
    ) as draft:
        after = admitted_profile(base, added=(*beside, draft))
        with Actionary.open(actionary) as store:
            effect, renewed = _planned(store, after, captures)
            target = folder / path.name
            with unbroken():
                draft.replace(target)
                try:
                    replace_all(store.store, renewed)
                except BaseException:
                    target.unlink()
                    raise
    return target, effect


def remove_reclassifying(
    path: Path, *, actionary: str | None, after: Profile, captures: Sequence[Path]
) -> Effect:
    """Take a rule file away and rename what it named: both, or neither.

    Raises:
        CaparError: The observations cannot be made again.
    """
    with Actionary.open(actionary) as store:
        effect, renewed = _planned(store, after, captures)
        with unbroken():
            aside = path.replace(path.with_suffix(".removed"))
            try:
                replace_all(store.store, renewed)
            except BaseException:
                aside.replace(path)
                raise
            aside.unlink()
    return effect


def bearing(actionary: str | None, names: Iterable[str]) -> int:
    """How many stored segments, of whatever profile, bear one of some names.

    Raises:
        StoreError: There is nothing to read.
    """
    wanted = set(names)
    with Actionary.open(actionary, read_only=True) as store:
        return sum(
            segment.name in wanted
            for each in store.observations()
            for segment in named_segments(store.store, each.name)
        )


def _planned(
    store: Actionary, after: Profile, captures: Sequence[Path]
) -> tuple[Effect, list[tuple[Observation, str]]]:
    """What would be renamed, and the observations that would take the places of others."""
    kept = _kept(store, after.name)
    seen = kept.seen
    changes = renamed(seen, before=after, after=after)
    there = {each.name: each for each in store.observations()}
    changed = sorted({change.capture for change in changes})
    return Effect(changes, kept.others), [
        (
            observe_again(
                source_files(store.store, each), there[each], seen[each].facts, after, captures
            ),
            there[each].action,
        )
        for each in changed
    ]  # fmt: skip


def _kept(store: Actionary, profile: str) -> Kept:
    every = store.observations()
    seen = {
        each.name: Trial(
            stored_facts(store.store, each.name), named_segments(store.store, each.name)
        )
        for each in every
        if each.profile == profile
    }
    return Kept(seen, tuple(sorted(each.name for each in every if each.profile != profile)))


def _names(measured: tuple[Fact, ...], rules: Profile) -> tuple[NamedSegment, ...]:
    return tuple(
        NamedSegment(
            each.ee,
            each.index,
            each.first,
            each.last,
            each.start_s,
            each.end_s,
            each.name,
            tuple(sorted(each.candidates)) if each.known else (),
        )
        for link in infer(measured, profile=rules).links
        for each in link.segments
    )
