"""Scenes of things with parts, and what every hand did with them."""

from scenes.hands.scene import battery
from scenes.parts import scenes_hinges, scenes_rails, scenes_tools

SCENES = battery(scenes_hinges, scenes_rails, scenes_tools)
