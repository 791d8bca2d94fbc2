"""The list of this battery's scenes."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

from scenes.hands.scene import Scene
from scenes.hands.stage import Stage
from scenes.people.stage import PeopleStage

SCENES: dict[str, Scene] = {}
"""Every scene by its name."""


@dataclass(frozen=True)
class PeopleScene(Scene):
    """A scene of whole bodies."""

    act: Callable[[PeopleStage], None] = lambda _: None

    def stage(self) -> Stage:
        """The scene as it is performed, before any tracker sees it; bodies are solved once."""
        return _performed(self)


@cache
def _performed(scene: PeopleScene) -> PeopleStage:
    stage = PeopleStage(scene.name)
    scene.act(stage)
    stage.close()
    return stage


def scene(write: Callable[[PeopleStage], None]) -> Scene:
    """Enter a function that writes a scene into the list; its docstring is the story.

    Raises:
        ValueError: The battery has a scene of that name already.
    """
    made = PeopleScene(write.__name__, write.__doc__ or "", lambda _: None, write)
    if made.name in SCENES:
        raise ValueError(f"two scenes are called {made.name}")
    SCENES[made.name] = made
    return made
