"""What a file's rules do over every possible segment: whether they fire, clash or shadow."""

from collections.abc import Iterator, Sequence

from capar_rules.engine.syntax import Statement, split_arguments
from capar_rules.lint.candidates import worlds_of
from capar_rules.lint.extents import every_world
from capar_rules.lint.findings import NOTE, Finding
from capar_rules.lint.firing import Firing, is_fits, numbers
from capar_rules.lint.name_checks import clashes, shadows
from capar_rules.lint.relaxation import anonymous
from capar_rules.lint.text_checks import Known
from capar_rules.lint.trials import Trial


def world_findings(
    own: Sequence[Statement], base: Known, beside: Sequence[Statement] = ()
) -> Iterator[Finding]:
    """Rules that can never fire or always do, and names that clash with others or shadow them.

    Args:
        own: The rules of the file.
        base: The shipped rule base.
        beside: The rules of the user's other files.
    """
    firing = Firing(Trial(own, base, beside))
    mine = range(len(own))
    for at, words in firing.beyond.items():
        if words and at in mine:
            what = ", ".join(f"{name}/{arity}" for name, arity in words)
            yield _not_judged(firing.rules[at], f"it depends on {what}")
    for at, rule in firing.rules.items():
        if at in mine and not firing.beyond[at]:
            yield from _fired(firing, at, rule)
    yield from clashes(firing)
    yield from shadows(firing)


def _not_judged(rule: Statement, why: str) -> Finding:
    return Finding(
        rule.place, "not-judged", f"whether it can fire was not checked: {why}, "
        "which the worlds of the audit do not contain.",
        "Give the file examples that it must and must not match.", NOTE,
    )  # fmt: skip


def _fired(firing: Firing, at: int, rule: Statement) -> Iterator[Finding]:
    if firing.joined(rule):
        yield _not_judged(rule, "it joins more than one segment")
    elif at in firing.missing:
        yield _not_judged(rule, f"it depends on {anonymous(firing.missing[at])}")
    elif at in firing.unfired and firing.relaxation.rests_on_open(rule):
        yield _not_judged(rule, f"it depends on {firing.relaxation.words_below(rule)}")
    elif at in firing.unfired or _impossible_row(firing, at, rule):
        arguments = [each.strip('"') for each in split_arguments(rule.heads[0].text)]
        what = "what it asks for" if rule.body else f"the features {', '.join(arguments[2:])}"
        yield Finding(
            rule.place, "never-fires",
            f"this rule can never fire: no segment has {what}.",
            "`capar rules audit` lists the feature sets that segments can have.",
        )  # fmt: skip
    elif rule.body and is_fits(rule) and _always(firing, at, rule):
        yield Finding(
            rule.place, "always-fires", "this rule always fires: every segment fits it.",
            "Add a condition, such as features(Segment, Start, End, Change, Force).",
        )  # fmt: skip


def _impossible_row(firing: Firing, at: int, rule: Statement) -> bool:
    """Whether it is a row of the feature table that no segment has."""
    row = rule.heads[0].signature == ("feature_row", 6)
    return row and not rule.body and at not in numbers(firing.atoms, "_row")


def _always(firing: Firing, at: int, rule: Statement) -> bool:
    """Whether a rule of fits fires in every world."""
    everywhere = worlds_of(rule, firing.trial.candidates, firing.trial.extents) == every_world()
    return everywhere and at not in numbers(firing.atoms, "_idle")
