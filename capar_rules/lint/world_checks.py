"""What a file's rules do over every possible segment: whether they fire, clash or shadow."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from capar_rules.engine.search import Atom
from capar_rules.engine.slicing import FITS
from capar_rules.engine.syntax import Statement, split_arguments
from capar_rules.lint.audit import chosen_in_audit
from capar_rules.lint.candidates import primitive_in, worlds_of
from capar_rules.lint.extents import Worlds, every_world
from capar_rules.lint.findings import NOTE, Finding
from capar_rules.lint.name_checks import clashes, shadows
from capar_rules.lint.probes import (
    ASKED,
    FIRED,
    HELD,
    firing_probes,
    holding_probes,
    naming_probes,
    plain_conditions,
)
from capar_rules.lint.siblings import overlaps
from capar_rules.lint.text_checks import Known
from capar_rules.lint.trials import Trial

FEW_OF = 20
"""One world in so many is asked first whether rules fire: most do in some of them, and the search
through all worlds takes longer for each rule that is asked."""

Rules = Mapping[int, Statement]
"""Rules by their index in the file."""


def world_findings(
    own: Sequence[Statement], base: Known, beside: Sequence[Statement] = ()
) -> Iterator[Finding]:
    """Rules that can never fire or always do, and names that clash with others or shadow them.

    Args:
        own: The rules of the file.
        base: The shipped rule base.
        beside: The rules of the user's other files.
    """
    trial = Trial(own, base, beside)
    rules = {at: each for at, each in enumerate(own) if each.kind == "rule" and each.heads}
    beyond = {at: trial.beyond(rule) for at, rule in rules.items()}
    judged = {at: rule for at, rule in rules.items() if not beyond[at]}
    for at, words in beyond.items():
        if words:
            yield _not_judged(rules[at], ", ".join(f"{name}/{arity}" for name, arity in words))
    watched = {*trial.names, *(over for each in trial.generals.values() for over in each)}
    naming = naming_probes(sorted(watched), sorted(watched))
    always = _always(trial, judged)
    others = {at: rule for at, rule in judged.items() if at not in always}
    if always:
        # Such a rule clashes with nearly every other: with which ones in a few worlds is enough.
        atoms = trial.ask(firing_probes(others), ASKED, trial.worlds)
        atoms |= trial.ask(naming, ASKED, _few(every_world()))
    else:
        atoms = trial.ask([*firing_probes(others), *naming], ASKED, trial.worlds)
    unfired = _unfired(trial, others, atoms)
    missing = _missing(trial, unfired) if unfired else {}
    yield from _firing(others, atoms, {at: missing.get(at, "") for at in unfired})
    for rule in always.values():
        yield Finding(
            rule.place, "always-fires", "this rule always fires: every segment fits it.",
            "Add a condition, such as features(Segment, Start, End, Change, Force).",
        )  # fmt: skip
    yield from clashes(trial, atoms)
    if not always:
        yield from shadows(trial, atoms)
    yield from overlaps(trial, set(missing.values()))


def _not_judged(rule: Statement, what: str) -> Finding:
    return Finding(
        rule.place, "not-judged", f"whether it can fire was not checked: it depends on {what}, "
        "which the worlds of the audit do not contain.",
        "Give the file examples that it must and must not match.", NOTE,
    )  # fmt: skip


def _always(trial: Trial, rules: Rules) -> Rules:
    """The rules by which every segment fits; asked of a few worlds before all of them."""
    found = {
        at: rule
        for at, rule in rules.items()
        if rule.body and _is_fits(rule) and _everywhere(trial, rule)
    }
    few = _few(every_world())
    for worlds in (few, every_world() - few):
        idle = _numbers(trial.ask(firing_probes(found), ASKED, worlds), "_idle")
        found = {at: rule for at, rule in found.items() if at not in idle}
    return found


def _few(worlds: Worlds) -> Worlds:
    """One world in so many."""
    return frozenset(sorted(worlds)[::FEW_OF])


def _firing(rules: Rules, atoms: frozenset[Atom], unfired: Mapping[int, str]) -> Iterator[Finding]:
    for at, rule in rules.items():
        if unfired.get(at):
            yield _not_judged(rule, unfired[at])
        elif at in unfired or _impossible_row(at, rule, atoms):
            arguments = [each.strip('"') for each in split_arguments(rule.heads[0].text)]
            what = "what it asks for" if rule.body else f"the features {', '.join(arguments[2:])}"
            yield Finding(
                rule.place, "never-fires",
                f"this rule can never fire: no segment has {what}.",
                "`capar rules audit` lists the feature sets that segments can have.",
            )  # fmt: skip


def _unfired(trial: Trial, rules: Rules, atoms: frozenset[Atom]) -> dict[int, Statement]:
    """The rules that fire in no world; one that no primitive needs may fire in any."""
    fired = _numbers(atoms, "_fired")
    unfired = {at: rule for at, rule in rules.items() if rule.body and at not in fired}
    rest = every_world() - trial.worlds
    few = _few(rest)
    for worlds in (few, rest - few):
        helpers = {
            at: rule for at, rule in unfired.items() if at not in fired and not _is_fits(rule)
        }
        fired |= _numbers(trial.ask(firing_probes(helpers), (FIRED,), worlds), "_fired")
    return {at: rule for at, rule in unfired.items() if at not in fired}


def _missing(trial: Trial, rules: Rules) -> dict[int, str]:
    """For rules that never fire, a condition that no world fulfils though a real segment may.

    No world has such a relation, or the relation depends on one chosen over few arguments only.
    """
    conditions = {(at, place): atom for at in rules for place, atom in plain_conditions(rules[at])}
    held: set[tuple[object, ...]] = {
        (*key, "so")
        for key, atom in conditions.items()
        if atom.signature == FITS and trial.extents.fits.get(primitive_in(atom))
    }
    for worlds in (trial.worlds, every_world() - trial.worlds):
        unheld = {key: atom for key, atom in conditions.items() if (*key, "so") not in held}
        held |= {row for _, row in trial.ask(holding_probes(unheld), (HELD,), worlds)}
    found: dict[int, str] = {}
    for key, atom in conditions.items():
        chosen = trial.below([atom.signature]) & chosen_in_audit()
        if (*key, "so") not in held and (chosen or (*key, "any") not in held):
            found.setdefault(key[0], atom.text)
    return found


def _impossible_row(at: int, rule: Statement, atoms: frozenset[Atom]) -> bool:
    """Whether it is a row of the feature table that no segment has."""
    row = rule.heads[0].signature == ("feature_row", 6)
    return row and not rule.body and at not in _numbers(atoms, "_row")


def _everywhere(trial: Trial, rule: Statement) -> bool:
    return worlds_of(rule, trial.candidates, trial.extents) == every_world()


def _is_fits(rule: Statement) -> bool:
    return rule.heads[0].signature == FITS


def _numbers(atoms: Iterable[Atom], predicate: str) -> set[object]:
    return {row[0] for name, row in atoms if name == predicate and len(row) == 1}
