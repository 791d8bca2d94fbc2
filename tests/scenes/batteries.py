"""All batteries of scenes, and all their scenes."""

from scenes.hands import SCENES as HANDS
from scenes.hands.scene import Scene
from scenes.household import SCENES as HOUSEHOLD
from scenes.objects import SCENES as OBJECTS

BATTERIES: dict[str, dict[str, Scene]] = {
    "hands": HANDS,
    "objects": OBJECTS,
    "household": HOUSEHOLD,
}
"""Every battery by its name."""

SCENES = {
    f"{battery}-{name}": scene
    for battery, scenes in BATTERIES.items()
    for name, scene in scenes.items()
}
"""The scenes of all batteries, each under its battery's name and its own."""
