"""Where constraints are made, in the objects' own measures: normalised local transforms.

A normalised local transform (NLT) has a place in an object's frame over the object's size, axis
by axis, so that it holds for any object of its kind, and an orientation (thesis 4.4.2.2). An axis
along which the object has no extent keeps its metres.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Capture, Sensor, TagObject
from capar.model.par import Nlt
from extractors.bodies.bodies import Bodies
from extractors.bodies.poses import Poses
from extractors.contact.proximity import nearest, still
from extractors.contact.surfaces import surface
from extractors.relations.attention import NOTHING, Attention

NO_EXTENT_M = 1e-6
"""A size below this is none [m]."""


@dataclass(frozen=True, slots=True)
class Location:
    """The constraint that a contact makes at one frame."""

    frame: int
    dominant: str
    """The object of ``ee_nlt``; empty if the end-effector itself makes the contact."""

    goal: str
    ee_nlt: Nlt | None
    """Where on the dominant object the contact is, and how the end-effector holds that."""

    goal_nlt: Nlt | None
    """Where on the goal the contact is, and how the end-effector or the dominant object lies."""

    seen: str = ""
    """The object looked at; empty if none."""

    v_nlt: Nlt | None = None
    """Where on that object the line of sight meets it, and how the looking sensor lies."""


def locate(
    capture: Capture,
    bodies: Bodies,
    attention: Mapping[str, Attention],
    *,
    ee: str,
    dominant: str,
    goal: str,
    frame: int,
) -> Location:
    """The NLTs of the contact of an end-effector, or of what it possesses, with a goal.

    The contact's place is the middle of where the surfaces cut each other, or else the points
    at which they are nearest; where either has no shape, it is the origin of what comes.

    Args:
        capture: The trial.
        bodies: Its bodies.
        attention: What the attending sensors look at.
        ee: The end-effector's sensor.
        dominant: The object in it that makes the contact; empty if the end-effector does.
        goal: The object that is touched.
        frame: The frame of the contact.

    Raises:
        UnknownNameError: A sensor or object of that name is not in the capture.
    """
    hand, target = capture.sensor(ee), capture.tag_object(goal)
    comes = capture.tag_object(dominant) if dominant else hand
    hand_pose = bodies.sensors[ee].poses
    target_pose = bodies.objects[goal].poses
    comes_pose = bodies.objects[dominant].poses if dominant else hand_pose
    lost = [each.lost[frame] for each in (hand_pose, comes_pose, target_pose)]
    seen, v_nlt = _sight(capture, bodies, attention, frame)
    if any(lost):
        return Location(frame, dominant, goal, None, None, seen, v_nlt)
    on_comes, on_target = _points(comes, comes_pose, target, target_pose, frame)
    ee_nlt = None
    if isinstance(comes, TagObject):
        ee_nlt = normalised(on_comes, _relative(comes_pose, hand_pose, frame), size(comes))
    goal_nlt = normalised(on_target, _relative(target_pose, comes_pose, frame), size(target))
    return Location(frame, dominant, goal, ee_nlt, goal_nlt, seen, v_nlt)


def size(each: TagObject) -> Float[np.ndarray, "3"]:
    """Lengths of an object along its own axes [m]; zero without a shape."""
    return np.zeros(3) if each.shape is None else each.shape.size


def normalised(
    point: Float[np.ndarray, "3"],
    orientation: Float[np.ndarray, "4"],
    size_m: Float[np.ndarray, "3"],
) -> Nlt:
    """A place in an object's frame [m] over its size [m], with an orientation in that frame."""
    x, y, z = map(float, point / _divisors(size_m))
    w, i, j, k = map(float, orientation * (-1.0 if orientation[0] < 0.0 else 1.0))
    return Nlt((x, y, z), (w, i, j, k))


def restored(
    nlt: Nlt, size_m: Float[np.ndarray, "3"]
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "4"]]:
    """The place [m] and orientation that an NLT means in the frame of an object of a size [m]."""
    return np.asarray(nlt.position) * _divisors(size_m), np.asarray(nlt.orientation)


def mirrored(nlt: Nlt, axis: int) -> Nlt:
    """The NLT for the other side: reflected in the object's plane across an axis (0, 1 or 2)."""
    signs = [-1.0 if each == axis else 1.0 for each in range(3)]
    x, y, z = (sign * each for sign, each in zip(signs, nlt.position, strict=True))
    w, *vector = nlt.orientation
    i, j, k = (-sign * each for sign, each in zip(signs, vector, strict=True))
    return Nlt((x, y, z), (w, i, j, k))


def _divisors(size_m: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    return np.where(np.asarray(size_m) > NO_EXTENT_M, size_m, 1.0)


def _relative(base: Poses, other: Poses, frame: int) -> Float[np.ndarray, "4"]:
    """The other's orientation in the base's frame."""
    first = geometry.rotations(base.settled.orientations[frame])
    second = geometry.rotations(other.settled.orientations[frame])
    return geometry.quaternions(first.inv() * second)


def _points(
    comes: Sensor | TagObject, comes_pose: Poses, target: TagObject, target_pose: Poses, frame: int
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """The contact's place in the frame of what comes and in the target's [m]."""
    if comes.shape is None or target.shape is None:
        origin = comes_pose.settled.positions[frame]
        return np.zeros(3), _local(target_pose, origin, frame)
    one = still(surface(comes.shape), comes_pose.settled, frame)
    two = still(surface(target.shape), target_pose.settled, frame)
    _, on_comes, on_target = nearest(one, two, 0)
    return on_comes, on_target


def _local(base: Poses, point: Float[np.ndarray, "3"], frame: int) -> Float[np.ndarray, "3"]:
    """A point of the world [m] in a body's frame."""
    turn: Rotation = geometry.rotations(base.settled.orientations[frame])
    return turn.inv().apply(point - base.settled.positions[frame])


def _sight(
    capture: Capture,
    bodies: Bodies,
    attention: Mapping[str, Attention],
    frame: int,
) -> tuple[str, Nlt | None]:
    """What the first attending sensor that sees anything looks at, and where on it."""
    for sensor in sorted(attention):
        look = attention[sensor]
        if look.seen[frame] != NOTHING:
            name = look.objects[look.seen[frame]]
            pose = bodies.objects[name].poses
            point = _local(pose, look.points[frame], frame)
            turn = _relative(pose, bodies.sensors[sensor].poses, frame)
            return name, normalised(point, turn, size(capture.tag_object(name)))
    return "", None
