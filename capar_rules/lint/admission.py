"""Rule files of users, read with care by every command before any of them counts."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from capar.model.errors import RuleError
from capar_rules.engine.profiles import DEFAULT, Profile
from capar_rules.engine.profiles import profile as unchecked_profile
from capar_rules.lint.findings import Finding, errors
from capar_rules.lint.judging import base_of, judge
from capar_rules.lint.sandbox import guarded

HARMLESS = {"no-primitive"}
"""What keeps a file from being added, and yet may stand among rules: it only helps others."""


def admitted_profile(
    name: str = DEFAULT, *, added: tuple[Path, ...] = (), steady: bool | None = None
) -> Profile:
    """The profile of that name with rule files of users added, each checked by its text first.

    Args:
        name: Of the profile.
        added: Rule files of the user's.
        steady: Whether to resolve flicker; None for what is usual in the profile.

    Raises:
        UnknownNameError: There is none.
        RuleError: An added file has a fault; nothing of it was run.
    """
    chosen = unchecked_profile(name, added=added, steady=steady)
    if added:
        admit(added, profile=name)
    return chosen


def admit(files: Sequence[Path], *, profile: str) -> None:
    """Let rule files count, unless their text alone tells of a fault; nothing of them is run.

    That is syntax, words and names, what could run code or reach elsewhere, choices, circles and
    growth without end. It takes milliseconds a file, in a process of its own that can come to no
    harm. What the solver has to say of them is for the full check.

    Args:
        files: Rule files that are to count together.
        profile: The rule base that they join.

    Raises:
        RuleError: There is a fault; it tells each with file, line, column, and what would be right.
    """
    wrong = faults(files, profile=profile)
    if wrong:
        lines = "\n".join(map(str, wrong))
        raise RuleError(
            f"rules that cannot count, so nothing was done:\n{lines}\n"
            "Mend them, or take them out of their folder; `capar rules check FILE` says more."
        )


def faults(files: Sequence[Path], *, profile: str) -> tuple[Finding, ...]:
    """What keeps rule files from counting, by place."""
    if not files:
        return ()
    found = guarded(files[0], partial(judge, files, base_of(profile)))
    return tuple(sorted({each for each in errors(tuple(found)) if each.code not in HARMLESS}))
