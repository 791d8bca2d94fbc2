"""What every command that reads rules takes, and the rule base that follows from it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from capar_rules.profiles import Profile

Rules = Annotated[
    Path | None,
    typer.Option(
        "--rules",
        metavar="FOLDER",
        help="Folder of your project's rule files; else CAPAR_RULES, else ./rules. "
        "Rules in the Actionary's own folder count too.",
        show_default=False,
    ),
]

Beside = Annotated[
    str | None,
    typer.Option(
        "--actionary",
        metavar="PATH|URL",
        help="An Actionary whose rules count too: those in its folder rules. Else CAPAR_ACTIONARY.",
        show_default=False,
    ),
]
"""The Actionary of a command that opens none and only takes its rules."""

Steady = Annotated[
    bool | None,
    typer.Option(
        "--steady/--no-steady",
        help="Take contacts and motions that flicker as the fewest changes explain them, or as "
        "they were measured; the profile thesis does not, unless told to.",
        show_default=False,
    ),
]


def rule_base(
    profile: str,
    rules: Path | None,
    actionary: str | None = None,
    *,
    steady: bool | None = None,
) -> "Profile":
    """A profile with the rules that people wrote, each judged by its text before it counts.

    Args:
        profile: Its name.
        rules: The project's folder that was named.
        actionary: The Actionary that the command names or opens; None for CAPAR_ACTIONARY's.
        steady: Whether to resolve flicker; None for what is usual in the profile.

    Raises:
        CaparError: A folder is none, or a rule file has a fault.
    """
    from capar_rules.profiles import profile as named_profile
    from capar_rules.teaching import user_rules

    added = user_rules(rules, actionary=actionary)
    return named_profile(profile, added=added, steady=steady)


def opened(actionary: str | None) -> str:
    """The Actionary that a command opens: the one named, else CAPAR_ACTIONARY, else ./actionary."""
    from kb.store import place

    return place(actionary)
