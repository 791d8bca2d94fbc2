"""Mistakes that a user can make, each saying what, where, and what would have been right."""

from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Protocol, TypeVar

MOST_LISTED = 20  # so many names that exist are all listed; of more, the nearest and their number

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
        self.kind, self.name, self.known, self.where = kind, name, sorted(known), where
        close = _nearest(name, self.known, n=1)
        hint = f" Did you mean {close[0]!r}?" if close else ""
        place = f"{where}: " if where else ""
        if listed or len(self.known) <= MOST_LISTED:
            exist = f"there are: {', '.join(self.known) or 'none'}"
        else:
            nearest = _nearest(name, self.known, n=NEAREST, cutoff=0.0)
            exist = f"there are {len(self.known)}, the nearest: {', '.join(nearest)}"
        super().__init__(f"{place}no {kind} {name!r}; {exist}.{hint}")


def _nearest(name: str, known: list[str], *, n: int, cutoff: float = 0.6) -> list[str]:
    """The names that are most like a given one: as it is spelt, then in capitals or not."""
    spelt = get_close_matches(name, known, n=n, cutoff=cutoff)
    names = {one.lower(): one for one in reversed(known)}
    folded = [names[one] for one in get_close_matches(name.lower(), names, n=n, cutoff=cutoff)]
    return list(dict.fromkeys([*spelt, *folded]))[:n]


class _Named(Protocol):
    @property
    def name(self) -> str: ...


_Member = TypeVar("_Member", bound=_Named)


def named(kind: str, name: str, members: Sequence[_Member], *, where: str = "") -> _Member:
    """The member of a name; UnknownNameError where there is none."""
    for member in members:
        if member.name == name:
            return member
    raise UnknownNameError(kind, name, [member.name for member in members], where=where)


class FileError(CaparError):
    """A file that cannot be used.

    Attributes:
        path: The file.
        problem: What is wrong with it, and where in it.
        remedy: What would have been right.
    """

    def __init__(self, path: Path | str, problem: str, remedy: str = "") -> None:
        self.path, self.problem, self.remedy = Path(path), problem, remedy
        super().__init__(f"{path}: {problem}" + (f" {remedy}" if remedy else ""))


class CaptureError(CaparError):
    """Motion data that no body could have produced, or that contradicts itself."""


class RuleError(CaparError):
    """A rule file that clingo refuses, or rules without exactly one answer."""


class NoAnswerError(RuleError):
    """Rules that contradict each other over some facts.

    Attributes:
        files: The rule files.
        facts: Those over which the solver found no answer.
        measured: What was measured, from which they were made.
        ask: Asks the same about other measurements.
    """

    def __init__(self, files: Sequence[Path], facts: Any) -> None:
        self.files, self.facts = tuple(files), facts
        self.measured: Sequence[Any] = ()
        self.ask: Callable[[Any], object] = lambda facts: None
        super().__init__("the rules contradict each other over these facts: they have no answer")


class FactError(CaparError):
    """A fact whose arguments are not of its kind."""


class ParError(CaparError, ValueError):
    """An action representation that contradicts itself."""


class DeviceError(CaparError):
    """A tracker that cannot be reached or refuses, or an address that no tracker can have."""
