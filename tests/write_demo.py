"""Writes the bundle that ships: a virtual tall man drinks from a mug, with a good tracker's noise.

Run as ``python tests/write_demo.py`` to rewrite it.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from motions import TALL_MAN, shapes
from motions.drink import PURPOSES
from scipy.spatial.transform import Rotation

from capar.body.anthropometry import measures_of
from capar.body.gaze import lines_of_sight
from capar.body.human import Human
from capar.body.performing import RATE_HZ, Performance, perform
from capar.body.recording import record
from capar.body.scripts import sip
from capar.body.sensing import Tracker
from capar.body.things import Thing, scene
from capar.model.capture import Capture, Sensor, Shape, TagObject, TagType

BUNDLE = Path(__file__).parents[1] / "capar" / "demo" / "drink_from_mug"
NOISE_M = 0.0003
NOISE_RAD = float(np.radians(0.1))
TABLE = (0.70, 0.0, 1.05)
"""The middle of its upper face [m]."""

MUG = (0.45, -0.08, 1.05)
"""Where it stands [m]."""

MUG_SIZE = 0.8
"""Of the mug of the test motions, which is 12 cm high [1]."""

LOOKS_S = (1.0, 1.5)
"""While the hand reaches, the mug is looked at: when the line of sight is calibrated [s]."""

PARTS = ("x", "y", "z", "qx", "qy", "qz", "qw", "valid")


def demo_performance() -> Performance:
    """What is done: six steps of drinking, by a body of the tall man's stature and mass."""
    usual = shapes.mug()
    away = np.array([-MUG_SIZE, -MUG_SIZE, MUG_SIZE])
    mug = Shape(usual.vertices * away, usual.faces, description="mug, its handle to the left")
    where = scene(
        Thing("mug", mug, MUG, round=True, mass_kg=0.35),
        Thing("table", shapes.table(0.8, 1.6), TABLE, tag=TagType.FIXED),
    )
    human = Human.of(measures_of(TALL_MAN.agent))
    return perform(human, where, sip("mug"), rate_hz=RATE_HZ)


def demo_capture() -> Capture:
    """The trial that the bundle holds; its line of sight is the usual one to the mug."""
    made = demo_performance()
    capture = record(
        made,
        name="drink_from_mug_tall_man",
        seed=5,
        tracker=Tracker(NOISE_M, NOISE_RAD, placement_m=0.0, placement_rad=0.0),
        sensors=("right_hand", "head"),
        agent=TALL_MAN.agent,
    )
    gaze = calibrated_gaze(made)
    sensors = (
        replace(sensor, gaze=gaze) if sensor.name == "head" else sensor
        for sensor in capture.sensors
    )
    things = tuple(replace(thing, kind="") for thing in capture.objects)
    return replace(capture, sensors=tuple(sensors), objects=things, purposes=PURPOSES)


def calibrated_gaze(made: Performance) -> tuple[float, float, float]:
    """The direction of sight in the head's frame: the eyes turn further to the mug than it does."""
    start, end = LOOKS_S
    motion = made.motion[(made.times >= start) & (made.times < end)]
    _, turns = made.human.sites(motion, ["head"])["head"]
    _, ways = lines_of_sight(made.human, motion)
    own = Rotation.from_quat(turns, scalar_first=True).inv().apply(ways)
    x, y, z = np.median(own, axis=0).round(3)
    return float(x), float(y), float(z)


def write_tables(capture: Capture, folder: Path) -> None:
    """The poses of what was tracked as ``motion.csv``, and each body's mesh as an OBJ file."""
    folder.mkdir(parents=True, exist_ok=True)
    tracked = [each for name, each in sorted(capture.bodies.items()) if name != "table"]
    header = ["t_s", *(f"{each.name}_{part}" for each in tracked for part in PARTS)]
    rows = [_row(capture, tracked, frame) for frame in range(len(capture.times))]
    _write(folder / "motion.csv", [",".join(header), *rows])
    for name, body in sorted(capture.bodies.items()):
        if body.shape is not None:
            _write(folder / f"{name}.obj", _obj(body.shape))


def _row(capture: Capture, bodies: list[Sensor | TagObject], frame: int) -> str:
    cells = [f"{capture.times[frame]:.9f}"]
    for body in bodies:
        cells += [f"{value:.7f}" for value in body.stream.positions[frame]]
        cells += [f"{value:.8f}" for value in np.roll(body.stream.orientations[frame], -1)]
        cells.append("0" if body.stream.lost[frame] else "1")
    return ",".join(cells)


def _obj(shape: Shape) -> list[str]:
    corners = [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in shape.vertices]
    faces = [f"f {a} {b} {c}" for a, b, c in shape.faces + 1]
    return [f"# {shape.description} [m]", *corners, *faces]


def _write(path: Path, lines: list[str]) -> None:
    path.write_bytes(("\n".join(lines) + "\n").encode())


if __name__ == "__main__":
    write_tables(demo_capture(), BUNDLE)
