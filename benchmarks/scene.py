"""What benchmarks measure: a capture of any length, of hands that handle objects of many triangles.

And the recordings of others, where they are.
"""

import os
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import trimesh

from capar.model.capture import Capture, Role, Sensor, Shape, Stream, TagObject, TagType

PERIOD_S = 12.0
"""One round: reach, carry, put down, reach the next, return."""

ADDITIONS = "total = 0\nfor each in range(10_000_000):\n    total += each"
REFERENCE_S = 0.7
"""What this script takes on the machine to which figures of others are scaled [s]."""

os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # commands are timed with bytecode, as installed


def recordings() -> bool:
    """Whether the recordings of others are there; without, it is said that they are not.

    They are in the folder that ``CAPAR_DATA`` names, or in ``../shared/data`` beside the checkout;
    the examples then find them.
    """
    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("CAPAR_DATA") or beside)
    if not folder.is_dir():
        print("no recordings of others: set CAPAR_DATA to their folder")
        return False
    os.environ["CAPAR_DATA"] = str(folder)
    return True


def shape(mesh: trimesh.Trimesh) -> Shape:
    return Shape(np.array(mesh.vertices, float), np.array(mesh.faces))


def hand() -> Shape:
    """A palm with four fingers and a thumb, 1.3k triangles, not convex."""
    parts = [trimesh.creation.box((0.10, 0.03, 0.08))]
    for index in range(5):
        finger = trimesh.creation.capsule(height=0.06, radius=0.008, count=(12, 12))
        finger.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (0, 1, 0)))
        finger.apply_translation((0.05, 0.0, -0.04 + 0.02 * index))
        parts.append(finger)
    return shape(trimesh.boolean.union(parts, engine="manifold"))


def mug(faces: int) -> Shape:
    """A hollow cup with a handle, as many triangles as asked for or somewhat more."""
    # The cut of the handle takes or adds some triangles, so that a few more sections are asked for.
    sections = int(np.ceil(faces / 390.0)) * 2
    profile = [(0.0, 0.0), (0.04, 0.0), (0.04, 0.1), (0.036, 0.1), (0.036, 0.004), (0.0, 0.004)]
    cup = trimesh.creation.revolve(np.array(profile), sections=sections)
    ring = trimesh.creation.torus(0.025, 0.005, major_sections=sections, minor_sections=24)
    ring.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    ring.apply_translation((0.058, 0.0, 0.05))
    outer = trimesh.creation.cylinder(0.038, 0.09)
    outer.apply_translation((0.0, 0.0, 0.05))
    ring = trimesh.boolean.difference([ring, outer], engine="manifold")
    whole = trimesh.boolean.union([cup, ring], engine="manifold")
    while len(whole.faces) < faces:
        whole = whole.subdivide()
    whole.apply_translation((0.0, 0.0, -0.05))
    return shape(whole)


def blob(faces: int, size: tuple[float, float, float], seed: int) -> Shape:
    """A lumpy closed body like a scan, at least as many triangles as asked for."""
    rows = int(np.ceil(np.sqrt(faces / 4.0))) + 1
    ball = trimesh.creation.uv_sphere(count=(rows, rows + 1))
    points = np.asarray(ball.vertices)
    waves = np.random.default_rng(seed).normal(size=(6, 3)) * 3.0
    lumps = 1.0 + 0.05 * np.sin(points @ waves.T).sum(axis=1, keepdims=True) / 2.0
    ball.vertices = points * lumps * np.array(size) / 2.0
    return shape(ball)


def _ease(share: np.ndarray) -> np.ndarray:
    share = np.clip(share, 0.0, 1.0)
    return share**3 * (10.0 - 15.0 * share + 6.0 * share**2)


def _between(clock: np.ndarray, keys: list[tuple[float, np.ndarray]]) -> np.ndarray:
    """Minimum-jerk motion through places at times [s] within each round."""
    out = keys[0][1]
    for (begin, one), (end, two) in pairwise(keys):
        inside = (clock >= begin)[:, None]
        move = one + (two - one) * _ease((clock - begin) / (end - begin))[:, None]
        out = np.where(inside, move, out)
    return out


def _turned(frames: int, angle: np.ndarray) -> np.ndarray:
    zero = np.zeros(frames)
    return np.stack([np.cos(angle / 2), zero, zero, np.sin(angle / 2)], axis=1)


def capture(
    minutes: float, *, rate_hz: float = 100.0, faces: int = 10_000, noise_m: float = 0.0002
) -> Capture:
    """Two hands and two feet among a table, a shelf, five things to handle and a head."""
    frames = round(minutes * 60.0 * rate_hz)
    times = np.arange(frames) / rate_hz
    random = np.random.default_rng(0)
    clock = np.mod(times, PERIOD_S)

    def stream(positions: np.ndarray, angle: np.ndarray | float = 0.0) -> Stream:
        noisy = positions + random.normal(0.0, noise_m, positions.shape)
        turn = np.broadcast_to(angle, frames) + random.normal(0.0, 0.001, frames)
        return Stream(times, noisy, _turned(frames, turn))

    def fixed(place: tuple[float, float, float]) -> Stream:
        return Stream(times, np.tile(place, (frames, 1)), np.tile([1.0, 0, 0, 0], (frames, 1)))

    sensors, objects = [], []
    table = trimesh.creation.box((1.6, 0.8, 0.04))
    objects.append(TagObject("table", TagType.FIXED, fixed((0.5, 0.0, 0.70)), shape(table)))
    rack = blob(faces, (0.3, 0.3, 0.5), 7)
    objects.append(TagObject("rack", TagType.FIXED, fixed((0.5, 0.6, 0.97)), rack))
    for side, sign in (("right", -1.0), ("left", 1.0)):
        rest, grip = np.array([0.0, 0.5 * sign, 0.9]), np.array([-0.124, 0.0, 0.0])
        back = (np.mod(times, 2.0 * PERIOD_S) >= PERIOD_S)[:, None]
        ends = np.array([[0.4, 0.2 * sign, 0.771], [0.7, 0.2 * sign, 0.771]])
        one, two = np.where(back, ends[1], ends[0]), np.where(back, ends[0], ends[1])
        up = np.tile([0.5, 0.25 * sign, 1.1], (frames, 1))
        thing = _between(clock, [(2.5, one), (4.0, up), (6.0, up), (7.5, two)])
        keys = [(0.5, rest + 0.0 * one), (2.0, one + grip), (2.5, one + grip), (4.0, up + grip)]
        keys += [(6.0, up + grip), (7.5, two + grip), (9.0, two + grip), (11.0, rest + 0.0 * one)]
        ee = _between(clock, keys)
        tilt = 0.3 * _ease((clock - 4.0) / 1.0) - 0.3 * _ease((clock - 5.0) / 1.0)
        sensors.append(
            Sensor(f"{side}_hand", "hand", side, f"{side}_arm", stream(ee, tilt), hand())
        )
        held = mug(faces) if side == "right" else blob(faces, (0.08, 0.08, 0.1), 3)
        objects.append(TagObject(f"held_{side}", TagType.MOBILE, stream(thing, tilt), held))
        foot = np.tile([0.1, 0.15 * sign, 0.05], (frames, 1))
        foot[:, 0] += 0.1 * np.sin(0.7 * times + sign)
        shoe = shape(trimesh.creation.capsule(height=0.15, radius=0.045, count=(24, 24)))
        sensors.append(Sensor(f"{side}_foot", "foot", side, f"{side}_leg", stream(foot), shoe))
    for index in range(3):
        place = np.array([0.2 + 0.35 * index, 0.0, 0.771])
        still = stream(np.tile(place, (frames, 1)))
        objects.append(
            TagObject(f"thing{index}", TagType.MOBILE, still, blob(faces, (0.1,) * 3, index))
        )
    head = np.array([0.0, 0.0, 1.3]) + 0.02 * np.sin(np.outer(times, [0.5, 0.7, 0.3]))
    gaze = stream(head, 0.4 * np.sin(0.8 * times))
    skull = blob(faces, (0.18, 0.15, 0.22), 9)
    sensors.append(
        Sensor("head", "head", "none", "neck", gaze, skull, Role.ATTENDS, gaze=(0.7, 0.0, -0.55))
    )
    objects.append(TagObject("head", TagType.SELF, gaze, skull))
    return Capture("benchmark", tuple(sensors), tuple(objects), contact_tolerance_m=0.005)


def with_trunk(capture: Capture, sensors: int = 12) -> Capture:
    """The same with so many sensors: the others are on the trunk and the limbs, and act not."""
    times = capture.times
    random = np.random.default_rng(1)
    more = []
    for index in range(sensors - len(capture.sensors)):
        places = np.array([0.0, 0.05 * index, 1.0]) + 0.02 * np.sin(
            np.outer(times, [0.3 + 0.1 * index, 0.5, 0.2])
        )
        places += random.normal(0.0, 0.0002, places.shape)
        turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
        stream = Stream(times, places, turns)
        more.append(Sensor(f"trunk{index}", "spine", "none", "trunk", stream, role=Role.ATTENDS))
    return replace(capture, sensors=(*capture.sensors, *more))
