"""Reading a folder's database while its writer may be merging its files, or after damage."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from pyoxigraph import Store as Oxigraph

from kb.errors import DamagedError, StoreError

TRIES = 60
"""How often a reader tries again when files are replaced while it reads."""

PAUSE_S = 0.02
"""How long it waits between [s]."""

LASTING = "block checksum mismatch"
"""What the database reports of damage that no other try mends; finished files never change."""

_T = TypeVar("_T")


def open_reader(data: Path) -> Oxigraph:
    """The database as it is now.

    The writer merges its files now and then and removes the old ones; a reader that opens at
    that instant finds a file missing, and tries again.

    Raises:
        StoreError: It cannot be opened even so.
    """
    return _again(lambda: Oxigraph.read_only(str(data)), data)


def read(data: Path, reading: Callable[[Oxigraph], _T]) -> tuple[_T, Oxigraph]:
    """What a reading of the database gives, and the database; read again if files go meanwhile.

    Raises:
        StoreError: It cannot be read even so.
    """

    def both() -> tuple[_T, Oxigraph]:
        store = Oxigraph.read_only(str(data))
        return reading(store), store

    return _again(both, data)


def check_whole(data: Path) -> None:
    """Check that a database's files have their table of contents, before it is written.

    Without it the database would start empty, and overwrite what is there.

    Raises:
        DamagedError: They have none.
    """
    if any(data.glob("*.sst")) and not (data / "CURRENT").is_file():
        raise DamagedError(str(data.parent), f"{data / 'CURRENT'} is missing")


def _again(action: Callable[[], _T], data: Path) -> _T:
    problem: Exception | None = None
    for _ in range(TRIES):
        try:
            return action()
        except SyntaxError:
            raise
        except (OSError, RuntimeError) as error:
            if LASTING in str(error):
                raise unusable(data.parent, error) from None
            problem = error
            time.sleep(PAUSE_S)
    raise unusable(data.parent, problem)


def unusable(folder: Path, problem: Exception | None) -> StoreError:
    """The error for a database that fails: damage, where that is what the database reports."""
    reason = " ".join(str(problem).split())
    if "Corruption" in reason or "No such file" in reason:
        return DamagedError(str(folder), reason)
    return StoreError(f"{folder}: its database cannot be read or written ({reason})")
