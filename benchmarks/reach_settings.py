"""What performers reach for: a box on a table, or a target in free air on a thin stand."""

from dataclasses import replace
from enum import StrEnum
from functools import cache

import numpy as np
import trimesh

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import perform
from capar.body.recording import record
from capar.body.scenes import Scene as Things
from capar.body.scenes import Thing, scene
from capar.body.scripted_actions import action_scene
from capar.body.scripts import touch
from capar.body.sensors import PERFECT
from capar.model.capture import Shape, TagType
from capar.pipelines.round_trips import body, observed_source
from capar.regeneration.drafts import Draft
from capar.regeneration.planning import reachable
from capar.regeneration.scene_files import USUAL, drawn_scene
from capar.regeneration.scenes import Scene, resized
from capar.regeneration.sources import Source

RATE_HZ = 20.0
SIDE = "right"
SCENES_SEED = 54

AHEAD, ASIDE = 0.28, -0.10
"""Where a target in free air is, in statures of whoever reaches [1]."""

DRAWN_ASIDE = 0.05
"""How far from there it is drawn along each axis, in statures [1]."""

HEIGHTS = (0.48, 0.82)
"""From which its height is drawn, in statures: from the hip to the shoulder [1]."""

TARGET_M = (0.035, 0.15)
"""Radius and height of the cylinder, whose size is drawn, too [m]."""

ROD_M = 0.008
"""Radius of the stand [m]."""


class Setting(StrEnum):
    """Where performers reach."""

    TABLE = "table"
    """The top of a box on a table, in scenes that `capar roundtrip` draws, too."""

    FREE = "free"
    """The side of an upright cylinder on a thin stand."""


@cache
def source(setting: Setting) -> Source:
    """A man's reach, of which performers have their own ways; it ends with the touch."""
    human = Human.of(ready_made("man"))
    tall = human.measures["stature"]
    if setting is Setting.TABLE:
        things, script = action_scene(human, "touch"), touch("crate")
    else:
        height = 0.5 * sum(HEIGHTS) * tall
        things = _on_stand((AHEAD * tall, ASIDE * tall, height))
        script = touch("target", grip="side")
    made = perform(human, things, script[:3], rate_hz=RATE_HZ)
    return observed_source(record(made, name="reach", seed=3, tracker=PERFECT))


@cache
def draft(setting: Setting, agent: str, number: int) -> Draft:
    """What is decided of a body's reach in a drawn scene, whatever the style is."""
    own = source(setting)
    human = body(agent, own)
    rng = np.random.default_rng([SCENES_SEED, number])
    if setting is Setting.TABLE:
        return reachable(own, drawn_scene(own.scene, rng), human)
    return reachable(own, _free_scene(own, human, rng), human)


def _free_scene(own: Source, human: Human, rng: np.random.Generator) -> Scene:
    """A target of another size elsewhere, as far from whoever reaches as their stature has it."""
    tall = human.measures["stature"]
    size = float(rng.uniform(*USUAL.sizes))
    height = float(rng.uniform(*HEIGHTS))
    dx, dy = (float(d) for d in rng.uniform(-DRAWN_ASIDE, DRAWN_ASIDE, 2))
    place = ((AHEAD + dx) * tall, (ASIDE + dy) * tall, height * tall)
    target = resized(own.scene, "target", size).thing("target")
    things = {**own.scene.things, "target": replace(target, place=place)}
    return replace(own.scene, things=things | {"stand": _on_stand(place).thing("stand")})


def _on_stand(place: tuple[float, float, float]) -> Things:
    x, y, z = place
    stand = Thing("stand", _cylinder(ROD_M, z), (x, y, 0.0), tag=TagType.FIXED, kind="stand")
    return scene(stand, Thing("target", _cylinder(*TARGET_M), place, round=True))


def _cylinder(radius_m: float, height_m: float) -> Shape:
    made = trimesh.creation.cylinder(radius_m, height_m, sections=48)
    made.apply_translation((0.0, 0.0, 0.5 * height_m))
    what = f"cylinder {2 * radius_m:g} m wide, {height_m:g} m high"
    return Shape(np.array(made.vertices), np.array(made.faces), description=what)
