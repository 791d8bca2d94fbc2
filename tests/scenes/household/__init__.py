"""Scenes of a household: containers, furniture and tools, and what every hand did with them."""

from scenes.household import (  # noqa: F401
    scenes_blades,
    scenes_covers,
    scenes_exchanges,
    scenes_freight,
    scenes_handfuls,
    scenes_hinges,
    scenes_levels,
    scenes_obstacles,
    scenes_rails,
    scenes_stillness,
    scenes_strokes,
    scenes_tipping,
    scenes_vessels,
)
from scenes.household.builders import SCENES as SCENES
