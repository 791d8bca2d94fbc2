"""What keeps a thing on its way: the hinge or rail that was observed, or the top it slides on."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.geometry import rotations
from capar.model.locations import restored
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import MOVES_M, Source

HINGE, RAIL, PLANE = "hinge", "rail", "plane"

FLAT_M = 0.003
"""What never leaves its height by more than this while it is held slides on its support [m]."""

FLAT_RAD = float(np.radians(3.0))
"""Nor leans by more than this [rad]."""

NOISE_M = 0.0002
"""A recorded way that is no farther off the plane is kept as it is [m]."""


@dataclass(frozen=True, eq=False)
class Constraint:
    """The line or plane that a thing keeps to, in the frame of the thing at its start."""

    kind: str
    """``hinge``, ``rail`` or ``plane``."""

    thing: str
    other: str
    """What bears the hinge or the rail, or what it slides on."""

    point: Float[np.ndarray, "3"]
    """Of the line or plane [m]."""

    axis: Float[np.ndarray, "3"]
    """Unit direction of the line, or normal of the plane."""

    def scaled(self, ratio: Float[np.ndarray, "3"]) -> "Constraint":
        """On a thing of another size: the same place in its own measures.

        Args:
            ratio: The new size over the old one, axis by axis [1].
        """
        return replace(self, point=self.point * ratio)

    def strays(
        self,
        start: RigidTransform,
        at: Float[np.ndarray, "3"],
        spots: Float[np.ndarray, "frames 3"],
    ) -> Float[np.ndarray, "frames"]:
        """How far a point of the thing, or on it, is from the way that the constraint leaves [m].

        Args:
            start: Where the thing is at its start.
            at: The point in the thing's frame [m].
            spots: Where it was seen in the world [m].
        """
        point, axis = start.apply(self.point), start.rotation.apply(self.axis)
        usual, seen = start.apply(at) - point, spots - point
        heights, height = seen @ axis, float(usual @ axis)
        if self.kind == PLANE:
            return np.abs(heights - height)
        across = seen - np.outer(heights, axis)
        before = usual - height * axis
        if self.kind == RAIL:
            return np.linalg.norm(across - before, axis=1)
        radius = np.linalg.norm(across, axis=1) - np.linalg.norm(before)
        return np.asarray(np.hypot(radius, heights - height))


def constraints_of(source: Source) -> dict[str, Constraint]:
    """The hinge or rail of each thing that was observed on one, by the thing's name."""
    out = {}
    for guide in source.observation.guides:
        if guide.object in source.paths:
            shape = source.capture.tag_object(guide.object).shape
            assert shape is not None  # checked when the source was made
            place, turn = restored(guide.object_nlt, shape.size)
            upright = _upright(source, guide.object)
            axis = upright.apply(rotations(turn).apply([1.0, 0.0, 0.0]))
            out[guide.object] = Constraint(
                guide.kind, guide.object, guide.base, upright.apply(place), axis
            )
    return out


def planes_of(source: Source) -> dict[str, Constraint]:
    """The plane of each thing that stays level on what bears it while it is held and moves."""
    out, guided = {}, constraints_of(source)
    for name, path in source.paths.items():
        spans = [(hold.first, hold.last) for hold in source.holds if hold.thing == name]
        support = source.scene.support(name)
        launched = any(launch.thing == name for launch in source.launches)
        if not spans or not support or name in guided or launched:
            continue
        part = path[min(first for first, _ in spans) : max(last for _, last in spans) + 1]
        off = np.abs(part.translation[:, 2] - source.scene.thing(name).place[2])
        gone = np.linalg.norm(part.translation - part.translation[0], axis=1)
        up = part.rotation.apply([0.0, 0.0, 1.0])[:, 2]
        level = bool(np.arccos(np.clip(up, -1.0, 1.0)).max() <= FLAT_RAD)
        if off.max() <= FLAT_M and level and gone.max() >= MOVES_M:
            out[name] = Constraint(PLANE, name, support, np.zeros(3), np.array([0.0, 0.0, 1.0]))
    return out


def scene_constraints(source: Source, scene: Scene) -> dict[str, Constraint]:
    """Every constraint in the measures of the things of a scene.

    Args:
        source: What was recorded.
        scene: Where it is performed.
    """
    found = {**planes_of(source), **constraints_of(source)}
    return {
        name: constraint.scaled(_ratio(source, scene, name)) for name, constraint in found.items()
    }


def guided_poses(
    source: Source,
    scene: Scene,
    name: str,
    recorded: RigidTransform,
    spans: list[tuple[int, int]],
) -> RigidTransform:
    """``T_world_thing`` at every frame of a thing on a hinge or a rail, on its own line throughout.

    It turns by the recorded angles, or goes as far in its own measures; while nobody holds it, it
    stays.

    Args:
        source: What was recorded.
        scene: Where it is performed.
        name: The thing.
        recorded: Its recorded way, or the one of another style.
        spans: The frames from which to which it is held.
    """
    before = constraints_of(source)[name]
    ratio = _ratio(source, scene, name)
    course, far = np.zeros(len(recorded)), 0.0
    for first, last in spans:
        gone = _course(before, recorded[first : last + 1])
        course[first : last + 1] = far + gone
        far += float(gone[-1])
        course[last + 1 :] = far
    start, line = scene.thing(name).pose, before.scaled(ratio)
    if line.kind == RAIL:
        longer = float(np.linalg.norm(line.axis * ratio))
        return start * RigidTransform.from_translation(np.outer(longer * course, line.axis))
    there = RigidTransform.from_translation(line.point)
    turned = RigidTransform.from_rotation(Rotation.from_rotvec(np.outer(course, line.axis)))
    return start * there * turned * there.inv()


def flattened(path: RigidTransform) -> RigidTransform:
    """A way in the level plane of its first frame, turning only about the vertical."""
    spots = np.array(path.translation)
    if np.abs(spots[:, 2] - spots[0, 2]).max() <= NOISE_M:
        return path
    spots[:, 2] = spots[0, 2]
    about = (path.rotation * path.rotation[0].inv()).as_quat(scalar_first=True)
    yaw = 2.0 * np.arctan2(about[:, 3], about[:, 0])
    turns = Rotation.from_rotvec(np.outer(yaw, [0.0, 0.0, 1.0])) * path.rotation[0]
    return RigidTransform.from_components(spots, turns)


def _course(line: Constraint, path: RigidTransform) -> Float[np.ndarray, "frames"]:
    """How far a thing has turned [rad] or gone [m] along its line since the first frame."""
    moved = path[0].inv() * path
    if line.kind == RAIL:
        return np.asarray(moved.translation @ line.axis)
    return np.unwrap(moved.rotation.as_rotvec() @ line.axis)


def _upright(source: Source, name: str) -> Rotation:
    """What takes directions of the captured object's frame to the frame of the thing."""
    stream = source.capture.tag_object(name).stream
    known = ~np.isnan(stream.positions).any(axis=1)
    captured = rotations(stream.orientations[known])
    return (source.paths[name].rotation[np.flatnonzero(known)].inv() * captured).mean()


def _ratio(source: Source, scene: Scene, name: str) -> Float[np.ndarray, "3"]:
    old, new = source.scene.thing(name).size, scene.thing(name).size
    return np.asarray(new / np.maximum(old, 1e-9))


def told_of_constraints(constraints: Mapping[str, Constraint]) -> list[str]:
    """What is told of the lines that things are kept on."""
    return [
        f"{name!r} keeps to its {constraint.kind} on {constraint.other!r}"
        for name, constraint in constraints.items()
        if constraint.kind != PLANE
    ]
