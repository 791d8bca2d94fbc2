"""The captures that patterns mean: folders, globs, and takes by ``FOLDER:TAKE`` or ``FOLDER:*``."""

from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase
from glob import glob
from pathlib import Path

from capar.model.errors import FileError
from extractors.readers.bundle.capture_toml import FILE, find_place, takes
from extractors.readers.registry import says_itself

SUFFIX = ".motion.toml"
"""How files end that state claims about captures, which are no captures."""


def find_captures(
    patterns: Sequence[str], folder: Path = Path(), *, where: Path | None = None
) -> list[str]:
    """The captures that patterns mean, each once, those of a pattern sorted by folder.

    A pattern is a capture's folder or its capture.toml, either with ``*``; ``FOLDER:TAKE``, in
    which both may have ``*``; or a folder that is none, for all captures below it. A bundle of
    several takes is all of them.

    Args:
        patterns: What to look for; relative ones from ``folder`` on.
        folder: Where patterns start.
        where: The file that states them, for messages.

    Raises:
        FileError: A pattern means none.
        CaparError: A capture.toml cannot be read.
    """
    found: dict[str, None] = {}
    for pattern in patterns:
        own = [take for place in _places(folder, pattern) for take in _all_takes(place)]
        if not own and ":" in pattern:
            own = _takes(folder, pattern, where)
        if not own and where is not None:
            example = 'Write captures = ["drink_*"], or FOLDER:* for the takes of a bundle.'
            raise FileError(where, f"no capture matches {pattern!r}.", example)
        if not own:
            find_place(pattern)  # which says what is there
            raise FileError(pattern, "no capture here.", "Name a capture's folder, or FOLDER:*.")
        found |= dict.fromkeys(own)
    return list(found)


def _places(folder: Path, pattern: str) -> Iterator[Path]:
    """Bundles that a pattern means, from that folder on or, absolute, from the root."""
    found = [pattern]
    if not (folder / pattern).exists():  # Path.glob refuses absolute patterns.
        found = glob(pattern, root_dir=folder, recursive=True, include_hidden=True)  # noqa: PTH207
    for path in (folder / each for each in sorted(found)):
        if (path / FILE).is_file() or (
            path.is_file()
            and not path.name.endswith(SUFFIX)
            and (path.suffix == ".toml" or says_itself(path))
        ):
            yield path
        elif path.is_dir():
            yield from (each.parent for each in sorted(path.rglob(FILE)))


def _all_takes(place: Path) -> list[str]:
    return [f"{place}:{take}" for take in takes(place)] or [str(place)]


def _takes(folder: Path, pattern: str, where: Path | None) -> list[str]:
    """The takes that FOLDER:TAKE or FOLDER:* means, folders sorted, takes as they are declared.

    Raises:
        FileError: There are such folders, and none has such a take.
    """
    stem, _, wanted = pattern.rpartition(":")
    known = [(each, take) for each in _places(folder, stem) for take in takes(each)]
    found = [f"{each}:{take}" for each, take in known if fnmatchcase(take, wanted)]
    if not found and any(_places(folder, stem)):
        names = ", ".join(dict.fromkeys(take for _, take in known))
        there = f"Its takes are: {names}." if names else "It is one capture without takes."
        raise FileError(where or pattern, f"no take matches {pattern!r}.", there)
    return found
