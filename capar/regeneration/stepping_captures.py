"""Steps as a capture with sensors on hands, head and feet, so that they can be observed again."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import RigidTransform

from capar.body import scenes
from capar.body.performing import Performance
from capar.body.recording import Truth, record, write_bundle
from capar.body.scenes import Thing, box
from capar.body.scripts import SIDES
from capar.body.sensors import PERFECT
from capar.body.shapes import segment_surface
from capar.model.capture import Agent, Capture, Sensor, Shape, TagType
from capar.model.geometry import runs
from capar.regeneration.stepping import Stepping

FLOOR_M = (6.0, 6.0, 0.02)
"""How long, wide and thick the floor is of which a capture of steps consists besides [m]."""

AHEAD_M = 3.0
"""How far ahead it is looked at [m]."""


def capture_of_steps(made: Stepping, *, name: str, agent: str) -> Capture:
    """What a tracker would have recorded of steps; the floor is an object of it.

    Args:
        made: The steps.
        name: Of the capture.
        agent: Name of the performer.
    """
    human, scene, count = made.human, made.scene, len(made.times)
    ground = Thing(
        "floor", box(*FLOOR_M), (*scene.place, scene.floor_m - FLOOR_M[2]), tag=TagType.FIXED
    )
    there = scenes.Scene({**scene.things, ground.name: ground})
    paths = {n: RigidTransform.concatenate([t.pose] * count) for n, t in there.things.items()}
    ahead = AHEAD_M * np.array([np.cos(scene.heading), np.sin(scene.heading)])
    looks = np.column_stack([made.postures[:, :2] + ahead, np.full(count, scene.floor_m)])
    moved = Performance(
        human=human, scene=there, script=(), times=made.times, motion=made.postures, things=paths,
        phases=(), gazes=looks, looks=(), slip_m={},
    )  # fmt: skip
    measures = human.measures
    kind = "child" if measures.adult_share < 0.5 else measures.adult
    stated = {key: round(value, 4) for key, value in measures.values.items()}
    worn = tuple(f"{side}_{part}" for part in ("hand", "foot") for side in SIDES)
    capture = record(
        moved, name=name, seed=0, tracker=PERFECT, sensors=(*worn, "head"), eye_tracker=False,
        agent=Agent(agent, kind, {"age": measures.age, **stated}),
    )  # fmt: skip
    sensors = tuple(_shod(made, sensor) for sensor in capture.sensors)
    return replace(capture, sensors=sensors)


def write_steps(made: Stepping, capture: Capture, folder: Path) -> None:
    """Write a capture of steps as a bundle, with when feet stand as the truth beside it."""
    contacts = [
        (f"{side}_foot", "floor", float(made.times[first]), float(made.times[last]))
        for side, bears in made.bears.items()
        for first, last in runs(bears)
    ]
    write_bundle(capture, Truth(tuple(sorted(contacts)), (), (), ()), folder)


def _shod(made: Stepping, sensor: Sensor) -> Sensor:
    """A foot's sensor with the surface of the foot, in the sensor's frame."""
    if sensor.end_effector != "foot":
        return sensor
    names = (f"{sensor.side}_foot", f"{sensor.side}_toes")
    surface = segment_surface(made.human.measures, names, names[0])
    seat = made.human.model.site(f"sensor_{names[0]}").pos
    shape = Shape(np.array(surface.vertices) - seat, np.array(surface.faces), description="foot")
    return replace(sensor, shape=shape)
