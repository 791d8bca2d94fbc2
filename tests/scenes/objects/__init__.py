"""Scenes of containers, furniture and tools: each gives a capture and what every hand did in it."""

from scenes.objects import (  # noqa: F401
    scenes_containers,
    scenes_doors,
    scenes_drawers,
    scenes_heights,
    scenes_instruments,
    scenes_lids,
    scenes_loads,
    scenes_passing,
    scenes_pouring,
    scenes_quiet,
    scenes_several,
    scenes_surface,
)
from scenes.objects.builders import SCENES as SCENES
