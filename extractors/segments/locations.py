"""Where the constraint that ends a segment is made: NLTs of the contact and of what is seen."""

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
from jaxtyping import Float

from capar.model.capture import Capture, TagObject
from capar.model.locations import (
    ConstraintLocation,
    Nlt,
    local_point,
    normalised,
    relative_orientation,
)
from capar.model.observation import Segment
from extractors.bodies.bodies import Bodies
from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.proximity import at_frame, nearest
from extractors.contact.surfaces import surface
from extractors.contact.touching_part import touching_part
from extractors.relations.attention import NOTHING, Attention

_Point: TypeAlias = Float[np.ndarray, "3"]


def constraint_location(
    capture: Capture,
    bodies: Bodies,
    attention: Mapping[str, Attention],
    segment: Segment,
    *,
    dominant: str,
    goal: str,
) -> ConstraintLocation:
    """The NLTs of the contact that ends a segment, and of what is looked at then.

    The contact's place is the middle of where the surfaces cut each other, or else the points
    at which they are nearest; where either has no shape, it is the origin of what comes.

    Args:
        capture: The trial.
        bodies: Its bodies.
        attention: What the attending sensors look at.
        segment: The segment; its last frame is that of the contact.
        dominant: The object in the end-effector that makes the contact; empty if the
            end-effector does.
        goal: The object that is touched.

    Raises:
        UnknownNameError: A sensor or object of that name is not in the capture.
    """
    ee_nlt, goal_nlt = _contact(capture, bodies, segment.ee, dominant, goal, segment.last)
    seen, v_nlt = _seen(capture, bodies, attention, segment.last)
    return ConstraintLocation(
        action=segment.name,
        purpose=segment.purpose,
        ee=segment.ee,
        side=capture.sensor(segment.ee).side,
        frame=segment.last,
        dominant=dominant,
        goal=goal,
        ee_nlt=ee_nlt,
        goal_nlt=goal_nlt,
        seen=seen,
        v_nlt=v_nlt,
    )


def size(each: TagObject) -> Float[np.ndarray, "3"]:
    """Lengths of an object along its own axes [m]; zero without a shape."""
    return np.zeros(3) if each.shape is None else each.shape.size


def _contact(
    capture: Capture, bodies: Bodies, ee: str, dominant: str, goal: str, frame: int
) -> tuple[Nlt | None, Nlt | None]:
    """The contact on the dominant object, if there is one, and on the goal; None where lost."""
    hand, target = capture.sensor(ee), capture.tag_object(goal)
    comes = capture.tag_object(dominant) if dominant else None
    holder, at = bodies.sensors[hand.name], bodies.objects[target.name]
    moved = bodies.objects[dominant] if dominant else holder
    if any(each.poses.lost[frame] for each in (holder, moved, at)):
        return None, None
    nearest_part = moved if dominant else touching_part(bodies, ee, at, frame)
    on_moved, on_target = _points(nearest_part, at, frame)
    ee_nlt = None
    if comes is not None:
        ee_nlt = normalised(on_moved, _relative(moved, holder, frame), size(comes))
    return ee_nlt, normalised(on_target, _relative(at, moved, frame), size(target))


def _relative(base: BodyGeometry, other: BodyGeometry, frame: int) -> Float[np.ndarray, "4"]:
    """The other's orientation in the base's frame."""
    return relative_orientation(
        base.poses.settled.orientations[frame], other.poses.settled.orientations[frame]
    )


def _points(moved: BodyGeometry, target: BodyGeometry, frame: int) -> tuple[_Point, _Point]:
    """The contact's place in the frame of what comes and in the target's [m]."""
    if moved.shape is None or target.shape is None:
        return np.zeros(3), _local(target, moved.poses.settled.positions[frame], frame)
    one = at_frame(surface(moved.shape), moved.poses.settled, frame)
    two = at_frame(surface(target.shape), target.poses.settled, frame)
    _, on_moved, on_target = nearest(one, two, 0)
    return on_moved, on_target


def _local(base: BodyGeometry, point: _Point, frame: int) -> _Point:
    """A point of the world [m] in a body's frame."""
    stream = base.poses.settled
    return local_point(stream.positions[frame], stream.orientations[frame], point)


def _seen(
    capture: Capture, bodies: Bodies, attention: Mapping[str, Attention], frame: int
) -> tuple[str, Nlt | None]:
    """What the first attending sensor that sees anything looks at, and where on it."""
    for sensor in sorted(attention):
        look = attention[sensor]
        if look.seen[frame] != NOTHING:
            name = look.objects[look.seen[frame]]
            body = bodies.objects[name]
            turn = _relative(body, bodies.sensors[sensor], frame)
            point = _local(body, look.points[frame], frame)
            return name, normalised(point, turn, size(capture.tag_object(name)))
    return "", None
