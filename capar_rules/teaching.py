"""Names that a user gives: a feature set becomes a rule file, which joins the feature table."""

import os
import re
from collections.abc import Iterable
from pathlib import Path

from capar.model.errors import FileError, RuleError
from capar.model.par import FeatureSet

ACTION_NAME = re.compile(r"[A-Z][A-Za-z0-9]*")
"""What a primitive may be called: ``MoveObjTo``."""

RULES_VARIABLE = "CAPAR_RULES"
"""Environment variable that names the folder of a user's rule files."""


def rules_folder(named: Path | None = None) -> Path:
    """Where the user's rule files are: the folder named, else ``CAPAR_RULES``, else ./rules."""
    return named or Path(os.environ.get(RULES_VARIABLE, "rules"))


def rule_files(folder: Path | None = None) -> tuple[Path, ...]:
    """The user's rule files, sorted by name.

    Raises:
        FileError: A folder was named that is none.
    """
    place = rules_folder(folder)
    if folder is not None and not place.is_dir():
        raise FileError(place, "is no folder of rule files.", "Name one that holds .lp files.")
    return tuple(sorted(place.glob("*.lp"))) if place.is_dir() else ()


def taught(name: str, features: FeatureSet, *, verb: str = "") -> str:
    """The rule file of a primitive that has just these features.

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
    """Write a rule file for each name; a file appears whole or not at all, and none is replaced.

    Raises:
        RuleError: A name is no name of a primitive.
        FileError: The name is taken already.
    """
    texts = [(_path(folder, name), taught(name, features)) for name, features in names]
    for path, _ in texts:
        if path.exists():
            raise FileError(path, "exists already.", "Choose another name, or remove that rule.")
    folder.mkdir(parents=True, exist_ok=True)
    for path, text in texts:
        draft = path.with_suffix(".tmp")
        draft.write_text(text)
        draft.replace(path)
    return tuple(path for path, _ in texts)


def _path(folder: Path, name: str) -> Path:
    stem = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
    return folder / f"{stem}.lp"
