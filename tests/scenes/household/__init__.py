"""Scenes of a household: containers, furniture and tools, and what every hand did with them."""

from scenes.household import (  # noqa: F401
    scenes_blades,
    scenes_covers,
    scenes_freight,
    scenes_hinges,
    scenes_rails,
    scenes_strokes,
    scenes_vessels,
)
from scenes.household.registry import SCENES as SCENES
