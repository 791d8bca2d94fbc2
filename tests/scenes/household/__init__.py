"""Scenes of a household: containers, furniture and tools, and what every hand did with them."""

from scenes.hands.scene import battery
from scenes.household import scenes_furniture, scenes_tools, scenes_vessels

SCENES = battery(scenes_furniture, scenes_tools, scenes_vessels)
