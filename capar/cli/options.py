"""The options that several commands take, declared once, and what follows from them."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Argument, Option

from capar.model.errors import FileError

if TYPE_CHECKING:
    from capar_rules.engine.profiles import Profile
    from kb.lexicon.links import PrimitiveWords
    from kb.store.stores import Store

Capture = Annotated[
    str, Argument(help="A capture's folder or capture.toml; FOLDER:TAKE for one of its takes.")
]
Json = Annotated[bool, Option("--json", help="Print JSON.")]
ProfileName = Annotated[
    str, Option("--profile", help="The rules: extended, or thesis to the letter.")
]
Rules = Annotated[
    Path | None,
    Option(
        "--rules",
        metavar="FOLDER",
        help="Your project's rule files; else CAPAR_RULES, else ./rules. "
        "Rules in the Actionary's own folder count too.",
    ),
]
Place = Annotated[
    str | None,
    Option(
        "--actionary",
        metavar="PATH|URL",
        help="The Actionary: a folder or a SPARQL server. Else CAPAR_ACTIONARY, else ./actionary.",
    ),
]
Beside = Annotated[
    str | None,
    Option(
        "--actionary",
        metavar="PATH|URL",
        help="An Actionary whose rules count too: those in its folder rules. Else CAPAR_ACTIONARY.",
    ),
]
"""The Actionary of a command that opens none and only takes its rules."""

Wait = Annotated[float, Option(metavar="SECONDS", help="How long to wait for another writer.")]
New = Annotated[bool, Option("--new", help="Make the Actionary if it is not there, unasked.")]
Corrected = Annotated[
    bool, Option("--corrected", help="Use what persons say of segments (`capar correct`).")
]
Steady = Annotated[
    bool | None,
    Option(
        "--steady/--no-steady",
        help="Smooth flicker of contacts and motions, or not (as the profile thesis).",
    ),
]
Set = Annotated[
    list[str] | None,
    Option(
        "--set",
        metavar="KEY=VALUE",
        help="Replace a value of the calibration for this run, in metres and seconds, such as "
        "touch_m:right_hand,bowl=0.12. May be repeated.",
    ),
]
Plot = Annotated[Path | None, Option(help="Draw it to a .png, .svg or .pdf file.")]
NewBundle = Annotated[
    Path | None, Option("--output", "-o", help="A new folder for the capture bundle.")
]
OutputFile = Annotated[
    Path | None, Option("--output", "-o", "--out", help="A file, instead of standard output.")
]
Assume = Annotated[
    Path | None,
    Option(
        metavar="FILE",
        help="A TOML file with what the recording does not say: from_s, to_s; [performer] "
        "kind, stature_m, place, heading_deg, floor_m; [mirrored] left_hand = 'OBJECT'; "
        "[hand.SIDE] fingers, palm = [X, Y, Z]; [assumed_size] OBJECT = [X, Y].",
    ),
]


def rule_base(
    profile: str, rules: Path | None, actionary: str | None = None, *, steady: bool | None = None
) -> "Profile":
    """A profile with the rules that people wrote, each checked by its text first.

    Raises:
        CaparError: A folder is missing, or a rule file has a fault.
    """
    from capar_rules.authoring.user_rules import user_rules
    from capar_rules.engine.profiles import profile as shipped

    added = user_rules(rules, actionary=actionary)
    if not added:
        return shipped(profile, steady=steady)
    from capar_rules.lint.checking import admitted_profile

    return admitted_profile(profile, added=added, steady=steady)


def rule_words(rules: Path | None, actionary: str | None = None) -> "tuple[PrimitiveWords, ...]":
    """The words of the shipped primitives and of those that people wrote."""
    from capar.pipelines.linguistic_report import primitive_files, primitive_words

    return primitive_words(primitive_files(rule_base("extended", rules, actionary).added))


def opened(actionary: str | None) -> str:
    """The Actionary that a command opens: the one named, else CAPAR_ACTIONARY, else ./actionary."""
    from kb.store.stores import place

    return place(actionary)


def has_actionary(place: str, *, named: str | None) -> bool:
    """Whether observations can be looked up there: in a folder, or at an address that was named."""
    from kb.store.stores import DATA_FOLDER, is_address

    return bool(named) if is_address(place) else (Path(place) / DATA_FOLDER).is_dir()


def require_actionary(actionary: str | None, *, observed: bool = False) -> None:
    """Refuse an Actionary that is not there, so that a typing mistake creates none.

    Raises:
        FileError: Nothing is there.
    """
    from capar_rules.authoring.user_rules import FOLDER

    place = opened(actionary)
    rules_only = not observed and (Path(place) / FOLDER).is_dir()
    if not rules_only and not has_actionary(place, named=place):
        raise FileError(
            place, "is no Actionary.",
            f"`capar observe CAPTURE --actionary {place}` makes one; --rules FOLDER keeps rules "
            "without one.",
        )  # fmt: skip


def confirm_new(actionary: str | None, *, new: bool) -> None:
    """Ask before an Actionary is made, so that a typing mistake makes none.

    Where nobody can be asked, one is made unless its name resembles one beside it, or its parent
    folder is missing.

    Raises:
        FileError: It is likely a typing mistake, a file, or the answer was no.
    """
    from difflib import get_close_matches

    from kb.store.stores import DATA_FOLDER, is_address

    place = opened(actionary)
    if Path(place).is_file():
        raise FileError(place, "is a file; an Actionary is a folder.", "Name a folder.")
    if new or is_address(place) or Path(place).exists():
        return
    folder = Path(place).absolute()
    beside = {each.parent.name for each in folder.parent.glob(f"*/{DATA_FOLDER}")}
    near = get_close_matches(folder.name, sorted(beside), n=1, cutoff=0.75)
    meant = f"Did you mean {folder.with_name(near[0])}? " if near else ""
    if can_ask():
        if typer.confirm(f"{place} is no Actionary. {meant}Make a new one?", err=True):
            return
    elif folder.parent.is_dir() and not near:
        return
    also = "" if folder.parent.is_dir() else " and its folder"
    raise FileError(place, "is no Actionary.", f"{meant}To make a new one there{also}, add --new.")


def can_ask() -> bool:
    """Whether somebody at a terminal can answer."""
    return sys.stdin.isatty() and sys.stderr.isatty()


@contextmanager
def open_words(where: str | None, *, corrected: bool = False) -> "Iterator[Store | None]":
    """The store of an Actionary to read; None where none is named and none stands here."""
    from kb.corrections import corrected as corrected_copy
    from kb.store.stores import is_address, open_store
    from kb.store.updates import check_current

    target = opened(where)
    # The folder of an Actionary may hold rules before it holds anything that was observed.
    if where is None and not has_actionary(target, named=target):
        yield None
        return
    store = open_store(target, read_only=not is_address(target))
    try:
        check_current(store)
        yield corrected_copy(store) if corrected else store
    finally:
        store.close()
