"""Scenes of people: whole bodies that walk, sit, carry, greet, and what every limb did."""

from scenes.people import (  # noqa: F401
    scenes_doors,
    scenes_joints,
    scenes_kicks,
    scenes_low,
    scenes_pairs,
    scenes_performers,
    scenes_selves,
    scenes_steps,
    scenes_walks,
)
from scenes.people.registry import SCENES as SCENES
