"""What the performer looks at: the nearest tag object on the line of sight (thesis 3.5).

The line of sight is that of the eyes where an eye tracker knows them, else that of the face: it is
``gaze`` of the head's sensor. In looks at what lies on a table the eyes turn up to 19 degrees from
the face, whose line then passes above small things (figures in ``docs/body.md``).
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from capar.model.capture import Capture, Sensor
from capar.model.geometry import Places, Series
from extractors.bodies.bodies import Bodies
from extractors.bodies.poses import Poses, rotation_matrices
from extractors.contact.surfaces import Surface, surface
from extractors.signals.intervals import Interval, intervals
from extractors.thresholds import Thresholds

HEAD = "head"
"""The general type of an end-effector that carries the eyes, whether it attends or acts."""

EYES = "eyes"
"""The general type of an eye tracker: its line of sight is that of its agent's head."""

NOTHING = -1
"""Stands for an object where none is looked at."""

BEHIND_M = 1e-6
"""A ray begins this far from the eye [m], so that it does not meet what it starts on."""


def seeing(capture: Capture) -> tuple[Sensor, ...]:
    """Every sensor with a line of sight: heads and eyes, not what attends elsewhere on the body.

    Eyes are left out beside a head of the same agent, which then looks with them.
    """
    lent = {eyes.name for head in capture.sensors for eyes in _eyes_of(capture, head)}
    return tuple(
        sensor
        for sensor in capture.sensors
        if sensor.end_effector in (HEAD, EYES) and sensor.name not in lent
    )


def _eyes_of(capture: Capture, head: Sensor) -> tuple[Sensor, ...]:
    """The eye trackers that a head's agent wears; none for what is no head."""
    if head.end_effector != HEAD:
        return ()
    agent = capture.agent_of(head)
    return tuple(
        sensor
        for sensor in capture.sensors
        if sensor.end_effector == EYES and capture.agent_of(sensor) == agent
    )


@dataclass(frozen=True, eq=False)
class Attention:
    """What one attending sensor looks at."""

    objects: tuple[str, ...]
    """The names that ``seen`` counts."""

    seen: Int[np.ndarray, "frames"]
    """Index of the object met first at each frame, or ``NOTHING``."""

    points: Places
    """Where it is met, in the world [m]; NaN where nothing is."""

    looks: tuple[tuple[str, Interval], ...]
    """Objects looked at and how long, in time."""


def attention(
    capture: Capture, sensor: Sensor, bodies: Bodies, thresholds: Thresholds
) -> Attention:
    """The line of sight of an attending sensor, against boxes first and then surfaces.

    A head looks with its agent's eyes at every frame at which an eye tracker sees them.

    ``sensor``: the sensor, with the eye [m] and the gaze in its own frame. It does not see the
    object of its own name, in which its eye may lie.
    """
    origins, rays = sight(sensor, bodies.sensors[sensor.name].poses)
    for eyes in _eyes_of(capture, sensor):
        poses = bodies.sensors[eyes.name].poses
        known = ~poses.lost
        spots, ways = sight(eyes, poses)
        origins[known], rays[known] = spots[known], ways[known]
    names = sorted(body.name for body in capture.objects if body.shape and body.name != sensor.name)
    seen = np.full(len(origins), NOTHING)
    nearest = np.full(len(origins), np.inf)
    for index, name in enumerate(names):
        shape = capture.tag_object(name).shape
        if shape is None:
            continue
        reach = _distances(surface(shape), bodies.objects[name].poses, origins, rays, nearest)
        closer = reach < nearest
        seen[closer], nearest[closer] = index, reach[closer]
    hit = seen != NOTHING
    points = np.full(origins.shape, np.nan)
    points[hit] = origins[hit] + nearest[hit, None] * rays[hit]
    looks = [
        (name, interval)
        for index, name in enumerate(names)
        for interval in intervals(
            seen == index,
            capture.times,
            dropout_s=thresholds.dropout_s,
            minimum_s=thresholds.contact_minimum_s,
        )
    ]
    looks.sort(key=lambda look: (look[1], look[0]))
    return Attention(tuple(names), seen, points, tuple(looks))


def sight(sensor: Sensor, poses: Poses) -> tuple[Places, Places]:
    """The eye's place [m] and the direction of sight [1] at each frame, in the world."""
    turns = rotation_matrices(poses.settled.orientations)
    gaze = np.asarray(sensor.gaze, float)
    rays = turns @ (gaze / np.linalg.norm(gaze))
    return poses.settled.positions + turns @ np.asarray(sensor.eye, float), rays


def _distances(seen: Surface, poses: Poses, origins: Places, rays: Places, limit: Series) -> Series:
    """How far along each ray it meets a surface [m]; infinite where it does not, or not sooner."""
    out = np.full(len(origins), np.inf)
    offset = seen.centre
    back = np.swapaxes(rotation_matrices(poses.settled.orientations), 1, 2)
    centres = poses.settled.positions + np.swapaxes(back, 1, 2) @ offset
    aside = np.cross(centres - origins, rays)
    with np.errstate(invalid="ignore"):
        may = np.flatnonzero(np.einsum("ij,ij->i", aside, aside) <= seen.radius**2)
    if not may.size:
        return out
    start = (back[may] @ (origins[may] - poses.settled.positions[may])[..., None])[..., 0]
    ray = (back[may] @ rays[may][..., None])[..., 0]
    enters = _box(seen, start, ray)
    keep = enters < limit[may]
    may, start, ray = may[keep], start[keep], ray[keep]
    if may.size:
        points, index = seen.hits(start + BEHIND_M * ray, ray, first=True)
        if len(index):
            out[may[index]] = np.einsum("ij,ij->i", points - start[index], ray[index])
    return out


def _box(
    seen: Surface, start: Float[np.ndarray, "rays 3"], ray: Float[np.ndarray, "rays 3"]
) -> Float[np.ndarray, "rays"]:
    """Where rays enter the object's box [m]; infinite if they miss it."""
    low, high = seen.shape.bounds
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        one, two = (low - start) / ray, (high - start) / ray
    one, two = np.where(np.isnan(one), -np.inf, one), np.where(np.isnan(two), np.inf, two)
    enters = np.minimum(one, two).max(axis=1)
    leaves = np.maximum(one, two).min(axis=1)
    return np.where((enters <= leaves) & (leaves >= 0.0), np.maximum(enters, 0.0), np.inf)
