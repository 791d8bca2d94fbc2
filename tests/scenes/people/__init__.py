"""Scenes of people: whole bodies that walk, sit, carry, greet, and what every limb did."""

from scenes.hands.scene import battery
from scenes.people import scenes_performers, scenes_walks

SCENES = battery(scenes_performers, scenes_walks)
