"""All batteries of scenes, and all their scenes."""

from combinations import EVERY as ALL

from scenes.hands import SCENES as HANDS
from scenes.hands.scene import Scene
from scenes.household import SCENES as HOUSEHOLD
from scenes.objects import SCENES as OBJECTS
from scenes.parts import SCENES as PARTS
from scenes.people import SCENES as PEOPLE

BATTERIES: dict[str, dict[str, Scene]] = {
    "hands": HANDS,
    "objects": OBJECTS,
    "household": HOUSEHOLD,
    "people": PEOPLE,
    "parts": PARTS,
}
"""Every battery by its name."""

SCENES = {
    f"{battery}-{name}": scene
    for battery, scenes in BATTERIES.items()
    for name, scene in scenes.items()
}
"""The scenes of all batteries, each under its battery's name and its own."""

EVERY = 1 if ALL else 32
"""Of the scenes, which do not change any more, tests of their soundness take one in so many.

`CAPAR_SCENES=all pytest tests/scenes` takes each, as whoever writes a scene or a builder does.
"""

SOME = dict(list(SCENES.items())[::EVERY])
"""The scenes that are looked at for soundness."""
