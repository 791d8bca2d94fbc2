"""Bodies of simple form and captures of them, for tests of the extractors."""

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model.capture import Capture, Sensor, Shape, Stream, TagObject, TagType

UP = np.array([1.0, 0.0, 0.0, 0.0])


def shape(mesh: trimesh.Trimesh) -> Shape:
    return Shape(np.array(mesh.vertices, float), np.array(mesh.faces))


def ball(radius_m: float) -> Shape:
    return shape(trimesh.creation.icosphere(subdivisions=3, radius=radius_m))


def box(*sizes_m: float) -> Shape:
    return shape(trimesh.creation.box(sizes_m))


def cup(radius_m: float = 0.04, height_m: float = 0.1, wall_m: float = 0.004) -> Shape:
    """A hollow cup, open above, its origin in the middle of its bottom's underside."""
    inner = radius_m - wall_m
    profile = [(0, 0), (radius_m, 0), (radius_m, height_m), (inner, height_m), (inner, wall_m)]
    return shape(trimesh.creation.revolve(np.array([*profile, (0, wall_m)]), sections=48))


def handle() -> Shape:
    """A ring of 25 mm about the z axis, 5 mm thick."""
    return shape(trimesh.creation.torus(0.025, 0.005))


def stream(
    positions: Float[np.ndarray, "frames 3"],
    *,
    rate_hz: float = 100.0,
    orientations: Float[np.ndarray, "frames 4"] | None = None,
) -> Stream:
    frames = len(positions)
    turns = np.tile(UP, (frames, 1)) if orientations is None else orientations
    return Stream(np.arange(frames) / rate_hz, np.array(positions, float), turns)


def still(place: tuple[float, float, float], frames: int, *, rate_hz: float = 100.0) -> Stream:
    return stream(np.tile(np.array(place, float), (frames, 1)), rate_hz=rate_hz)


def eased(times: Float[np.ndarray, "frames"], start_s: float, end_s: float) -> np.ndarray:
    """Minimum-jerk share of a way, 0 to 1."""
    share = np.clip((times - start_s) / (end_s - start_s), 0.0, 1.0)
    return np.asarray(share**3 * (10.0 - 15.0 * share + 6.0 * share**2))


def hand(positions: Float[np.ndarray, "frames 3"], of: Shape | None, *, rate_hz: float = 100.0):
    return Sensor(
        "right_hand", "hand", "right", "right_arm", stream(positions, rate_hz=rate_hz), of
    )


def pick_and_place(
    *,
    rate_hz: float = 100.0,
    noise_m: float = 0.0,
    noise_rad: float = 0.0,
    world: Rotation | None = None,
    names: tuple[str, str, str] = ("right_hand", "thing", "table"),
    seed: int = 0,
) -> Capture:
    """A hand reaches a box on a table at 1.1 s, carries it from 1.4 to 2.4 s, leaves at 2.8 s."""
    world = world or Rotation.identity()
    random = np.random.default_rng(seed)
    times = np.arange(round(4.0 * rate_hz)) / rate_hz
    lift = np.sin(np.pi * np.clip((times - 1.4) / 1.0, 0.0, 1.0)) ** 2
    thing = np.array([0.4, 0.0, 0.07]) + np.outer(eased(times, 1.4, 2.4), [0.0, 0.3, 0.0])
    thing[:, 2] += 0.2 * lift
    rest, grip = np.array([0.0, -0.4, 0.35]), np.array([-0.082, 0.0, 0.0])
    out, back = eased(times, 0.3, 1.1)[:, None], eased(times, 2.8, 3.6)[:, None]
    way = rest + (thing[0] + grip - rest) * out
    way = np.where(times[:, None] < 1.4, way, thing + grip)
    way = way + (rest - way) * back

    def seen(positions: np.ndarray) -> Stream:
        turns = Rotation.from_rotvec(random.normal(0.0, noise_rad, positions.shape))
        noisy = positions + random.normal(0.0, noise_m, positions.shape)
        quaternions = (world * turns).as_quat(scalar_first=True)
        return stream(world.apply(noisy), rate_hz=rate_hz, orientations=quaternions)

    table = np.tile([0.5, 0.0, 0.0], (len(times), 1))
    ee, mobile, fixed = names
    return Capture(
        "pick and place",
        (Sensor(ee, "hand", "right", "right_arm", seen(way), ball(0.04)),),
        (
            TagObject(mobile, TagType.MOBILE, seen(thing), box(0.08, 0.08, 0.1)),
            TagObject(fixed, TagType.FIXED, seen(table), box(1.0, 1.2, 0.04)),
        ),
    )
