"""Scenes of hands that handle things: each gives a capture and what every hand did in it."""

from scenes.hands import (
    scenes_blows,
    scenes_motion,
    scenes_place,
    scenes_surface,
    scenes_touch,
    scenes_two_hands,
)
from scenes.hands.scene import battery

SCENES = battery(
    scenes_blows, scenes_motion, scenes_place, scenes_surface, scenes_touch, scenes_two_hands
)
