"""Rule files of users, checked by their text before any command loads them."""

from collections.abc import Sequence
from pathlib import Path

from capar.model.errors import RuleError
from capar_rules.engine.profiles import DEFAULT, Profile
from capar_rules.engine.profiles import profile as unchecked_profile
from capar_rules.lint.findings import Finding, errors

HARMLESS = {"no-primitive", "nothing-fits"}
"""Errors of `rules check` that do not keep a file from being loaded: it may only help others."""


def admitted_profile(
    name: str = DEFAULT, *, added: tuple[Path, ...] = (), steady: bool | None = None
) -> Profile:
    """The profile of that name with rule files of users added, each checked by its text first.

    Args:
        name: Of the profile.
        added: Rule files of the user.
        steady: Whether to resolve flicker; None for what is usual in the profile.

    Raises:
        UnknownNameError: There is none.
        RuleError: An added file has an error; nothing in it was executed.
    """
    chosen = unchecked_profile(name, added=added, steady=steady)
    if added:
        admit(added, profile=name)
    return chosen


def admit(files: Sequence[Path], *, profile: str) -> None:
    """Accept rule files that are to be loaded together, unless their text alone shows an error.

    That is syntax, predicates and names, what could run code or read other files, choices,
    negative cycles and unbounded growth. It takes well below a second, in one separate process
    for all files. Checks that ask the solver are left to `capar rules check`.

    Args:
        files: The rule files.
        profile: The rule base that they join.

    Raises:
        RuleError: There is an error; it gives each with file, line, column and remedy.
    """
    refuse(faults(files, profile=profile))


def refuse(wrong: Sequence[Finding]) -> None:
    """Say why rule files are not loaded.

    Raises:
        RuleError: There is an error among them; it gives each with file, line, column and remedy.
    """
    if wrong:
        lines = "\n".join(map(str, wrong))
        raise RuleError(
            f"rules that cannot count, so nothing was done:\n{lines}\n"
            "Mend them, or take them out of their folder; `capar rules check FILE` says more."
        )


def faults(files: Sequence[Path], *, profile: str) -> tuple[Finding, ...]:
    """The errors that keep rule files from being loaded together, by place."""
    return faults_of_each([files], profile=profile)[0] if files else ()


def faults_of_each(sets: Sequence[Sequence[Path]], *, profile: str) -> list[tuple[Finding, ...]]:
    """The same for several sets of files, each set by itself, in order."""
    from capar_rules.lint.checking import answers
    from capar_rules.lint.file_checks import Request

    requests = [Request(tuple(map(str, files)), profile) for files in sets]
    return [
        tuple(finding for finding in errors(found) if finding.code not in HARMLESS)
        for found in answers(requests)
    ]
