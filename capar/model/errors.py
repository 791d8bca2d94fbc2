"""Mistakes that a user can make, each saying what, where, and what would have been right."""

from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path

MOST_LISTED = 20
"""So many names that exist are all listed; of more, the nearest and their number."""

NEAREST = 5


class CaparError(Exception):
    """A user's mistake; a command that meets one prints it and exits with 2."""


class UnknownNameError(CaparError):
    """A name that nothing here bears.

    Attributes:
        kind: What was named (``sensor``, ``object``, ``body`` ...).
        name: The name as it was given.
        known: The names that exist, sorted.
        where: File and line, or an empty string.

    All names that exist are in the message if they are few, or if ``listed`` is true.
    """

    def __init__(
        self, kind: str, name: str, known: Iterable[str], *, where: str = "", listed: bool = False
    ) -> None:
        self.kind = kind
        self.name = name
        self.known = sorted(known)
        self.where = where
        close = _nearest(name, self.known, n=1)
        hint = f" Did you mean {close[0]!r}?" if close else ""
        place = f"{where}: " if where else ""
        super().__init__(
            f"{place}no {kind} {name!r}; {_listed(name, self.known, whole=listed)}.{hint}"
        )


def _listed(name: str, known: list[str], *, whole: bool) -> str:
    """The names that exist: all of a few, of many the nearest five and how many there are."""
    if whole or len(known) <= MOST_LISTED:
        return f"there are: {', '.join(known) or 'none'}"
    nearest = _nearest(name, known, n=NEAREST, cutoff=0.0)
    return f"there are {len(known)}, the nearest: {', '.join(nearest)}"


def _nearest(name: str, known: list[str], *, n: int, cutoff: float = 0.6) -> list[str]:
    """The names that are most like a given one: as it is spelt, then in capitals or not."""
    spelt = get_close_matches(name, known, n=n, cutoff=cutoff)
    names = {one.lower(): one for one in reversed(known)}
    folded = [names[one] for one in get_close_matches(name.lower(), names, n=n, cutoff=cutoff)]
    return list(dict.fromkeys([*spelt, *folded]))[:n]


class FileError(CaparError):
    """A file that cannot be used.

    Attributes:
        path: The file.
        problem: What is wrong with it, and where in it.
        remedy: What would have been right.
    """

    def __init__(self, path: Path | str, problem: str, remedy: str = "") -> None:
        self.path = Path(path)
        self.problem = problem
        self.remedy = remedy
        super().__init__(f"{path}: {problem}" + (f" {remedy}" if remedy else ""))


class CaptureError(CaparError):
    """Motion data that no body could have produced, or that contradicts itself."""


class RuleError(CaparError):
    """A rule file that clingo refuses, or rules without exactly one answer."""


class FactError(CaparError):
    """A fact whose arguments are not of its kind."""


class ParError(CaparError, ValueError):
    """An action representation that contradicts itself."""


class DeviceError(CaparError):
    """A tracker that cannot be reached or refuses, or an address that no tracker can have."""
