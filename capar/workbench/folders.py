"""The folders that were named when the window was opened: nothing else is read or written."""

import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from capar.model.errors import FileError


class Folders:
    """Where files may be read and written.

    Args:
        named: Folders that exist; new files go to the first.
    """

    def __init__(self, named: Iterable[Path]) -> None:
        self.roots = tuple(dict.fromkeys(each.resolve() for each in named))

    @property
    def first(self) -> Path:
        """Where new files go."""
        return self.roots[0]

    def holds(self, path: Path) -> bool:
        """Whether a path, links followed, is in one of them."""
        return any(path.is_relative_to(root) for root in self.roots)

    def inside(self, text: str | Path, *, beside: Path | None = None) -> Path:
        """The path that a text names, every link followed.

        Args:
            text: A path, absolute or relative to ``beside``.
            beside: A folder; None for the first.

        Raises:
            FileError: It is empty, no path at all, or outside of the folders.
        """
        try:
            if not str(text).strip():
                raise ValueError("empty")
            path = ((beside or self.first) / Path(text).expanduser()).resolve()
        except (ValueError, OSError, RuntimeError):  # a zero byte, a loop of links, ~nobody
            raise FileError(
                str(text).strip() or "nothing", "is no path.", "Name a file or a folder."
            ) from None
        if not self.holds(path):
            known = ", ".join(map(str, self.roots))
            raise FileError(
                path, "is outside of the folders that this window may use.",
                f"They are: {known}. To use another one, open the window with --folder.",
            )  # fmt: skip
        return path

    def new(self, text: str | Path) -> Path:
        """The same for something that is to be made.

        Raises:
            FileError: It is there already, or outside of the folders.
        """
        path = self.inside(text)
        if path.exists():
            raise FileError(path, "exists already.", "Choose another name.")
        return path

    def files(self, suffixes: Iterable[str]) -> list[str]:
        """The files of some suffixes in the folders, two levels deep, relative to the first."""
        wanted = set(suffixes)
        found = (
            path
            for root in self.roots
            for pattern in ("*", "*/*", "*/*/*")
            for path in root.glob(pattern)
            if path.suffix.lower() in wanted and path.is_file() and self.holds(path.resolve())
        )
        return sorted({self.named(path) for path in found})

    def named(self, path: Path) -> str:
        """A path as it is shown: relative to the first folder where it is in it."""
        full = path.resolve()
        return str(full.relative_to(self.first) if full.is_relative_to(self.first) else full)

    def check_bundle(self, text: str, folder: Path) -> None:
        """Check that a capture.toml names no file outside, before anything of it is read.

        Raises:
            FileError: It names one, or a variable of the environment.
        """
        try:
            data = tomllib.loads(text)
        except (tomllib.TOMLDecodeError, RecursionError):
            return  # whoever reads it says so
        for value in _texts(data):
            if "${" in value:
                raise FileError(
                    folder / "capture.toml", f"{value!r} names a variable of the environment.",
                    "In this window, write the path itself.",
                )  # fmt: skip
            try:
                path = Path(value)
                there = path.is_absolute() or ".." in path.parts or (folder / path).exists()
            except (ValueError, OSError):
                continue  # no path
            if there:
                self.inside(value, beside=folder)


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _texts(each)
