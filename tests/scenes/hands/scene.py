"""The list of scenes: each a function of rate, noise and seed."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from inspect import signature
from types import ModuleType
from typing import Any

from capar.model.capture import Capture
from scenes.hands.stage import Noise, Stage
from scenes.hands.things import Expectation, Thing


@dataclass(frozen=True)
class Scene:
    """A scene that can be recorded at any rate, with any noise."""

    name: str
    story: str
    write: Callable[[Any], None]
    kind: type[Stage]

    @cached_property
    def stage(self) -> Stage:
        """The scene as it is performed, before any tracker sees it; it is performed once."""
        stage = self.kind(self.name)
        self.write(stage)
        stage.close()
        return stage

    def __call__(
        self, rate_hz: float, noise_m: float, noise_rad: float, seed: int
    ) -> tuple[Capture, Expectation]:
        """What a tracker records, and what each hand did."""
        stage = self.stage
        capture = stage.capture(rate_hz, Noise(noise_m, noise_rad), seed)
        return capture, stage.expectation(rate_hz)


def battery(*modules: ModuleType) -> dict[str, Scene]:
    """The scenes of modules by their names: each public function of a stage and nothing else.

    Raises:
        ValueError: Two scenes have the same name.
    """
    scenes: dict[str, Scene] = {}
    for module in modules:
        for name, write in vars(module).items():
            if name.startswith("_") or getattr(write, "__module__", "") != module.__name__:
                continue
            kinds = [each.annotation for each in signature(write).parameters.values()]
            if len(kinds) == 1 and isinstance(kinds[0], type) and issubclass(kinds[0], Stage):
                if name in scenes:
                    raise ValueError(f"two scenes are called {name}")
                scenes[name] = Scene(name, write.__doc__ or "", write, kinds[0])
    return scenes


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


def at_table(s: Stage, *, depth: float = 0.7, width: float = 1.4, **who: Any) -> Thing:
    """Say who performs, as above, and put the table before them."""
    performer(s, **who)
    return s.table(depth, width)
