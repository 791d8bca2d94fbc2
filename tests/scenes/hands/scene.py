"""The list of scenes: each a function of rate, noise and seed."""

from collections.abc import Callable
from dataclasses import dataclass

from capar.model.capture import Capture
from scenes.hands.expectation import Expectation
from scenes.hands.stage import Noise, Stage


@dataclass(frozen=True)
class Scene:
    """A scene that can be recorded at any rate, with any noise."""

    name: str
    story: str
    write: Callable[[Stage], None]

    def stage(self) -> Stage:
        """The scene as it is performed, before any tracker sees it."""
        stage = Stage(self.name)
        self.write(stage)
        return stage

    def __call__(
        self, rate_hz: float, noise_m: float, noise_rad: float, seed: int
    ) -> tuple[Capture, Expectation]:
        """What a tracker records, and what each hand did."""
        stage = self.stage()
        capture = stage.capture(rate_hz, Noise(noise_m, noise_rad), seed)
        return capture, stage.expectation(rate_hz)


SCENES: dict[str, Scene] = {}
"""Every scene by its name."""


def scene(write: Callable[[Stage], None]) -> Scene:
    """Enter a function that writes a scene into the list; its docstring is the story."""
    return entered(write, SCENES)


def entered(write: Callable[[Stage], None], scenes: dict[str, Scene]) -> Scene:
    """Enter a function that writes a scene into a battery's list.

    Raises:
        ValueError: The battery has a scene of that name already.
    """
    made = Scene(write.__name__, write.__doc__ or "", write)
    if made.name in scenes:
        raise ValueError(f"two scenes are called {made.name}")
    scenes[made.name] = made
    return made


def performer(
    stage: Stage,
    *,
    height: float = 0.74,
    yaw_deg: float = 0.0,
    offset: tuple[float, float] = (0.0, 0.0),
    size: float = 1.0,
    agent: str = "agent",
) -> None:
    """Say who performs, at which table, and how they stand in the world."""
    stage.height, stage.yaw_deg, stage.offset = height, yaw_deg, offset
    stage.size, stage.agent = size, agent
