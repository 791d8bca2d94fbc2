"""The list of this battery's scenes."""

from collections.abc import Callable

from scenes.hands.scene import Scene, entered
from scenes.hands.stage import Stage

SCENES: dict[str, Scene] = {}
"""Every scene by its name."""


def scene(write: Callable[[Stage], None]) -> Scene:
    """Enter a function that writes a scene into the list; its docstring is the story."""
    return entered(write, SCENES)
