"""Rule files put in place and taken away as one step with something else: both, or neither."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

HELD = (signal.SIGINT, signal.SIGTERM)
"""What asks a process to end, and can wait for a moment."""


@contextmanager
def unbroken() -> Iterator[None]:
    """Let nobody interrupt what is done here; who asked for it meanwhile is heard afterwards."""
    if threading.current_thread() is not threading.main_thread():
        yield  # Only the main thread is interrupted, and only it may say how.
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
    """Take a rule file from among the rules, and keep it beside them until it is certain.

    Returns:
        Where it is kept.
    """
    return path.replace(path.with_suffix(".removed"))


def put_back(aside: Path, path: Path) -> None:
    """Put back what was taken away."""
    aside.replace(path)
