"""Scenes of containers, furniture and tools: each gives a capture and what every hand did in it."""

from scenes.hands.scene import battery
from scenes.objects import scenes_containers, scenes_furniture, scenes_tools

SCENES = battery(scenes_containers, scenes_furniture, scenes_tools)
