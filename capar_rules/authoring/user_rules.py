"""Folders of users' rule files, and new files for feature sets that users name."""

import os
import re
import signal
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from capar.model.errors import FileError, RuleError
from capar.model.par import ACTION_NAME, FeatureSet
from capar_rules.engine.syntax import LARGEST_BYTES

RULES_VARIABLE = "CAPAR_RULES"
"""Environment variable that names the folder of a project's rule files."""

ACTIONARY_VARIABLE = "CAPAR_ACTIONARY"
"""Environment variable that names an Actionary, with the user's rule files beside it."""

FOLDER = "rules"
"""What the folder of rule files is called: in a project's folder, and in an Actionary's."""


def rules_folder(named: Path | None = None) -> Path:
    """The folder of the project's rules: the given one, else ``CAPAR_RULES``, else ./rules."""
    return named or Path(os.environ.get(RULES_VARIABLE) or FOLDER)


def actionary_rules(actionary: str | Path | None = None) -> Path | None:
    """The folder of the user's rules beside an Actionary.

    Returns:
        None where no Actionary is named, or a server keeps it: then there is no such folder.
    """
    place = str(actionary or os.environ.get(ACTIONARY_VARIABLE) or "")
    return None if not place or "://" in place else Path(place) / FOLDER


def new_rules_folder(named: Path | None = None, *, actionary: str | Path | None = None) -> Path:
    """The folder for a new rule of the user.

    That is the given folder, else ``CAPAR_RULES``, else beside the Actionary that is named or that
    ``CAPAR_ACTIONARY`` names, else ./rules.
    """
    if named is None and not os.environ.get(RULES_VARIABLE):
        return actionary_rules(actionary) or Path(FOLDER)
    return rules_folder(named)


def rule_files(folder: Path | None = None) -> tuple[Path, ...]:
    """The project's rule files, sorted by name.

    Raises:
        FileError: A folder was named that is none, or it cannot be read.
    """
    place = rules_folder(folder)
    if folder is not None and not place.is_dir():
        raise FileError(place, "is no folder of rule files.", "Name one that holds .lp files.")
    if not place.is_dir():
        return ()
    try:
        return tuple(sorted(each for each in place.iterdir() if each.match("*.lp")))
    except OSError as error:
        message = f"cannot be read: {error.strerror}."
        raise FileError(
            place, message, "Get write permission for it, or name another folder."
        ) from None


def user_rules(
    project: Path | None = None, *, actionary: str | Path | None = None
) -> tuple[Path, ...]:
    """The rule files that people wrote: the project's, then those beside the Actionary.

    Their order does not matter. A file that is in both folders with the same content is loaded
    once; two that introduce one primitive differently are refused by the check.

    Args:
        project: Their folder; None for ``CAPAR_RULES``, else ``./rules``.
        actionary: The Actionary; None for the one that ``CAPAR_ACTIONARY`` names, if any.

    Raises:
        FileError: A folder was named that is none.
    """
    beside = actionary_rules(actionary)
    mine = rule_files(beside) if beside and beside.is_dir() else ()
    found: dict[object, Path] = {}
    for each in (*rule_files(project), *mine):
        found.setdefault(_content(each), each)
    return tuple(found.values())


def _content(path: Path) -> object:
    """Files with equal values are one: they have the same name and content."""
    if not path.is_file() or path.stat().st_size > LARGEST_BYTES:
        return path
    try:
        return path.name, path.read_bytes()
    except OSError:  # the check reports it
        return path


def taught(name: str, features: FeatureSet, *, verb: str = "") -> str:
    """The text of a rule file for a primitive with exactly these features.

    Raises:
        RuleError: The name is no name of a primitive.
    """
    if not ACTION_NAME.fullmatch(name):
        raise RuleError(f"{name!r} is no name of a primitive; names read like MoveObjTo")
    bits = (features.rel_start, features.rel_end, features.change_loc, features.force)
    strings = ", ".join(f'"{each}"' for each in bits)
    return (
        f"%* {name}: named by a user for this feature set. *%\n"
        f'primitive("{name}").\n'
        f'feature_row("{name}", {features.end_effector}, {strings}).\n'
        f'verb("{name}", "{verb or name.lower()}").\n'
    )


def teach(names: Iterable[tuple[str, FeatureSet]], *, folder: Path) -> tuple[Path, ...]:
    """Write a rule file for each name, each atomically; no file is replaced.

    Raises:
        RuleError: A name is no name of a primitive.
        FileError: The name is taken already.
    """
    texts = []
    for name, features in names:
        stem = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
        texts.append((folder / f"{stem}.lp", taught(name, features)))
    for path, _ in texts:
        if path.exists():
            raise FileError(path, "exists already.", "Choose another name, or remove that rule.")
    make_folder(folder)
    for path, text in texts:
        draft = path.with_suffix(".tmp")
        draft.write_text(text)
        draft.replace(path)
    return tuple(path for path, _ in texts)


def make_folder(folder: Path) -> Path:
    """A folder for rule files, created if missing.

    Raises:
        FileError: It cannot be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        message = f"cannot hold rule files: {error.strerror}."
        raise FileError(folder, message, "Name another folder with --rules.") from None
    return folder


HELD = (signal.SIGINT, signal.SIGTERM)
"""Signals that ask a process to end, which are delayed during a transaction."""


@contextmanager
def unbroken() -> Iterator[None]:
    """Delay signals that would interrupt this block until its end."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread receives signals and may set handlers
        return
    asked: list[int] = []

    def wait(number: int, frame: FrameType | None) -> None:
        asked.append(number)

    before = {each: signal.signal(each, wait) for each in HELD}
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)
    for number in dict.fromkeys(asked):
        signal.raise_signal(number)
