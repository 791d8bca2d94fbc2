"""Scenes of hands that handle things: each gives a capture and what every hand did in it."""

from scenes.hands import (  # noqa: F401
    scenes_blows,
    scenes_motion,
    scenes_place,
    scenes_surface,
    scenes_touch,
    scenes_two_hands,
)
from scenes.hands.scene import SCENES as SCENES
from scenes.hands.scene import Scene as Scene
