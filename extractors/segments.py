"""What is measured of a segment after naming: locations, kinds of motion, styles and tracks."""

from collections.abc import Iterator, Mapping

import numpy as np
from jaxtyping import Float, Int

from capar.model import geometry
from capar.model.capture import Capture, TagObject
from capar.model.geometry import Places, Quaternion, Series, Vector
from capar.model.locations import (
    ConstraintLocation,
    Nlt,
    SampledTrack,
    local_point,
    normalised,
    relative_orientation,
    sampled_track,
)
from capar.model.observation import Segment
from capar.model.par import Motion, PathPoint, Style
from extractors.bodies.bodies import Bodies, BodyGeometry
from extractors.bodies.poses import Poses
from extractors.contact.proximity import at_frame, nearest
from extractors.contact.surfaces import surface
from extractors.contact.touch_distances import touching_part
from extractors.measure import Measurements, Track
from extractors.motion.object_motion import motion_floor
from extractors.relations.attention import NOTHING, Attention
from extractors.signals.intervals import frame_rate
from extractors.thresholds import Thresholds


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

    ``attention``: what the attending sensors look at. ``dominant``: the object in the end-effector
    that makes the contact; empty if the end-effector does. ``goal``: the object that is touched.

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


def size(each: TagObject) -> Vector:
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


def _relative(base: BodyGeometry, other: BodyGeometry, frame: int) -> Quaternion:
    """The other's orientation in the base's frame."""
    return relative_orientation(
        base.poses.settled.orientations[frame], other.poses.settled.orientations[frame]
    )


def _points(moved: BodyGeometry, target: BodyGeometry, frame: int) -> tuple[Vector, Vector]:
    """The contact's place in the frame of what comes and in the target's [m]."""
    if moved.shape is None or target.shape is None:
        place = moved.poses.settled.positions[frame]
        at = target.poses.settled
        return np.zeros(3), local_point(at.positions[frame], at.orientations[frame], place)
    one = at_frame(surface(moved.shape), moved.poses.settled, frame)
    two = at_frame(surface(target.shape), target.poses.settled, frame)
    _, on_moved, on_target = nearest(one, two, 0)
    return on_moved, on_target


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
            at = body.poses.settled
            place, own = at.positions[frame], at.orientations[frame]
            point = local_point(place, own, look.points[frame])
            return name, normalised(point, turn, size(capture.tag_object(name)))
    return "", None


Place = tuple[float, float, float]
"""A place in the world [m]."""


def moved_path(
    capture: Capture, measurements: Measurements, segment: Segment, thresholds: Thresholds
) -> tuple[Motion, tuple[Place, ...]]:
    """How the object that a segment moves moves, and where it begins and ends [m].

    Where the segment moves none, the motion is none and the places are the end-effector's. A place
    at which the body was lost is left out.
    """
    moves, name = followed(segment)
    kind = Motion.NONE
    if moves:
        moved = capture.tag_object(name)
        poses = measurements.bodies.objects[moved.name].poses
        positions = poses.smooth.positions
        span = segment.first, segment.last
        kind = motion_kind(poses, *span, own_m=moved.motion_floor_m, thresholds=thresholds)
    else:
        positions = measurements.tracks[name].positions
    ends = (positions[segment.first], positions[segment.last])
    return kind, tuple(_point(each) for each in ends if not np.isnan(each).any())


def followed(segment: Segment) -> tuple[bool, str]:
    """The body whose way tells where a segment leads, after whether it is an object that is moved.

    It is the first object that the segment moves, or else the end-effector.
    """
    if "1" in segment.features.change_loc:
        return True, segment.objects[segment.features.change_loc.index("1")]
    return False, segment.ee


def motion_kind(
    poses: Poses, first: int, last: int, *, own_m: float | None, thresholds: Thresholds
) -> Motion:
    """How the body moves between two frames, against its pose at the first.

    ``last``: frame up to which motion counts. ``own_m``: the object's own floor of motion [m], if
    it has one.
    """
    span = slice(first, last + 1)
    places, turns = poses.smooth.positions[span], poses.smooth.orientations[span]
    rate_hz = frame_rate(poses.smooth.times)
    floor = motion_floor(poses.noise, rate_hz, own_m=own_m, thresholds=thresholds)
    known = ~np.isnan(places[:, 0])
    if not known.any():
        return Motion.NONE
    places, turns = places[known], turns[known]
    shifts = geometry.lengths(places - places[0]).max() > floor.position_m
    turned = geometry.angle_between(turns, turns[:1]).max() > floor.rotation_rad
    if shifts and turned:
        return Motion.BOTH
    if shifts:
        return Motion.TRANSLATION
    return Motion.ROTATION if turned else Motion.NONE


RATE_HZ = 50.0
"""Samples a second of a capture that has half as many frames again, or more [Hz]."""


def sampled_tracks(bodies: Bodies, times: Series) -> Iterator[SampledTrack]:
    """The track of each sensor and object, by name; an object that is a sensor stands once.

    No low-passed poses are kept: those of all bodies at once would be most of what a long recording
    takes.
    """
    for name, pose in sorted(bodies.poses.items()):
        places = pose.settled if pose.rests else pose.smooth
        yield track_of(name, places.positions, times, rests=pose.rests)
        pose.forget()


def track_of(name: str, places: Places, times: Series, *, rests: bool) -> SampledTrack:
    """The track of a body.

    ``places``: its low-passed places [m]; NaN where it was lost.
    """
    known = places[~np.isnan(places[:, 0])] if rests else places[:0]
    if len(known):
        return sampled_track(name, 0.0, known[:1])
    clock = _clock(times)
    columns = [np.interp(clock, times, places[:, axis]) for axis in range(3)]
    step = float(clock[1] - clock[0]) if len(clock) > 1 else 0.0
    return sampled_track(name, step, np.stack(columns, axis=1))


def _clock(times: Series) -> Float[np.ndarray, "samples"]:
    """Equal steps from the first to the last frame: the frames themselves if they are few."""
    duration = float(times[-1] - times[0])
    frames = len(times) - 1
    steps = frames if frames < 1.5 * RATE_HZ * duration else int(np.ceil(RATE_HZ * duration))
    return np.linspace(times[0], times[-1], steps + 1)


STEPS = 33
"""Samples of a VelStyle, at equal steps of time from the first to the last [1]."""


def style(segment: Segment, track: Track, times: Series, thresholds: Thresholds) -> Style:
    """How a segment was performed: its VelStyle and its PathStyle."""
    span = segment.first, segment.last
    return Style(
        action=segment.name,
        purpose=segment.purpose,
        ee=segment.ee,
        velocity=velocity_style(track.positions, times, *span, thresholds=thresholds),
        path=path_style(track.positions, times, track.crossings, *span),
    )


def velocity_style(
    positions: Places, times: Series, first: int, last: int, *, thresholds: Thresholds
) -> tuple[float, ...]:
    """VelStyle: the share of the way covered, at ``STEPS`` equal steps of a segment's time.

    Per axis it is the integral of the speed's size up to a time over that to the end; the axes
    that move are averaged (thesis 4.4.2.3, eq. 4.1). It never falls and goes from 0 to 1; for an
    end-effector that does not move it is the time itself.

    ``last``: frame where it ends.
    """
    steps = np.linspace(0.0, 1.0, STEPS)
    part, clock = positions[first : last + 1], times[first : last + 1]
    known = ~np.isnan(part[:, 0])
    if known.sum() < 2:
        return tuple(map(float, steps))
    ways = np.abs(np.diff(part[known], axis=0))
    lengths = ways.sum(axis=0)
    moves = (lengths >= thresholds.axis_share * lengths.max()) & (lengths > 0.0)
    if not moves.any():
        return tuple(map(float, steps))
    shares = np.cumsum(ways[:, moves], axis=0) / lengths[moves]
    covered = np.concatenate([[0.0], shares.mean(axis=1)])
    share_of_time = (clock[known] - clock[0]) / (clock[-1] - clock[0])
    style = np.clip(np.interp(steps, share_of_time, covered), 0.0, 1.0)
    style[0], style[-1] = 0.0, 1.0
    return tuple(map(float, np.maximum.accumulate(style)))


def path_style(
    positions: Places, times: Series, crossings: Int[np.ndarray, "crossings"], first: int, last: int
) -> tuple[PathPoint, ...]:
    """PathStyle: the end-effector's places at the zero crossings strictly inside a segment.

    ``crossings``: frames at which its acceleration crosses zero, ascending. ``last``: frame where
    it ends.
    """
    inside = [int(each) for each in crossings if first < each < last]
    whole = times[last] - times[first]
    return tuple(
        PathPoint(float((times[each] - times[first]) / whole), _point(positions[each]))
        for each in inside
        if not np.isnan(positions[each]).any()
    )


def _point(position: Vector) -> Place:
    x, y, z = map(float, position)
    return x, y, z
