"""Adding and removing rule files as one transaction with something else: both, or neither."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

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


def take_away(path: Path) -> Path:
    """Rename a rule file so that it is no longer loaded, until its removal is certain.

    Returns:
        Its new path.
    """
    return path.replace(path.with_suffix(".removed"))


def put_back(aside: Path, path: Path) -> None:
    """Undo the renaming."""
    aside.replace(path)
