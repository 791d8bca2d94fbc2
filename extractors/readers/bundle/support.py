"""Supports that a recording lacks, placed under what rests on them (spec 5)."""

from collections.abc import Sequence
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Shape, TagObject, TagType

if TYPE_CHECKING:
    from extractors.readers.schema.bodies import ObjectEntry

NEAR_S = 0.1
"""An object must be seen this near the stated time [s]."""

Pose = tuple[Float[np.ndarray, "3"], Float[np.ndarray, "4"]]


def under_object(
    entry: "ObjectEntry", shape: Shape | None, others: Sequence[TagObject]
) -> tuple[Pose, str]:
    """The pose of a support whose surface is where an object's lowest corner is at a time.

    A pattern in ``top_at_bottom_of`` stands for every mobile object that has a shape, or for all
    if none has: the surface is then at the median or the lowest of their lowest corners. What has
    no shape is a point, its origin. Without a ``position`` the support
    is under the middle of the objects.

    Returns:
        The pose, and how it was derived.

    Raises:
        CaparError: No such object, the support has no shape, or the object is not seen then.
    """
    resting = _resting(entry, others)
    if shape is None:
        raise entry.error("top_at_bottom_of", "the support needs a shape.")
    found = [_corners(entry, thing) for thing in resting]
    bottoms = np.array([float(corners[:, 2].min()) for corners, _ in found])
    top = float(bottoms.min() if entry.of == "lowest" else np.median(bottoms))
    corners = np.concatenate([corners for corners, _ in found])
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    turn = Rotation.from_euler("z", entry.turn_deg, degrees=True)
    highest = float(turn.apply(np.array(shape.vertices))[:, 2].max())
    x, y = _place(entry, middle)
    height = top - (highest if entry.surface_m is None else entry.surface_m)
    text = f"top at {top:.3f} m, {_which(entry, resting)} at rest at {found[0][1]:.2f} s"
    return (np.array([x, y, height]), geometry.quaternions(turn)), text


def _place(entry: "ObjectEntry", middle: Float[np.ndarray, "3"]) -> tuple[float, float]:
    """Where the support stands [m]: as stated, or under the middle of what rests on it."""
    if entry.position is None:
        return float(middle[0]), float(middle[1])
    if len(entry.position) != 2:
        raise entry.error(
            "position",
            f"position = {entry.position} has a height, which top_at_bottom_of gives.",
            "Give x and y only.",
        )
    return entry.position[0], entry.position[1]


def _which(entry: "ObjectEntry", resting: Sequence[TagObject]) -> str:
    """In words: the point that gives the height."""
    if len(resting) == 1:
        return f"the lowest point of {resting[0].name}"
    if entry.of == "lowest":
        return f"the lowest point of the lowest of {len(resting)} objects"
    return f"the median of the lowest points of {len(resting)} objects"


def _corners(
    entry: "ObjectEntry", thing: TagObject
) -> tuple[Float[np.ndarray, "corners 3"], float]:
    """An object's corners in the world at the stated time [m], and the time it is seen at [s]."""
    if entry.at_s is None:
        raise entry.error("top_at_bottom_of", f"'at_s' is missing: when {thing.name} rests there.")
    at_s = entry.at_s + (float(thing.stream.times[-1]) if entry.at_s < 0.0 else 0.0)
    known = np.flatnonzero(~thing.stream.lost)
    if not known.size:
        raise entry.error("at_s", f"{thing.name} is never seen.")
    frame = int(known[np.argmin(np.abs(thing.stream.times[known] - at_s))])
    seen_s = float(thing.stream.times[frame])
    if abs(seen_s - at_s) > NEAR_S:
        raise entry.error(
            "at_s", f"{thing.name} is not seen near {at_s:g} s, but at {seen_s:.2f} s."
        )
    corners = np.zeros((1, 3)) if thing.shape is None else np.array(thing.shape.vertices)
    return thing.stream.pose(frame).apply(corners), seen_s


def _resting(entry: "ObjectEntry", others: Sequence[TagObject]) -> list[TagObject]:
    """The object or, by a pattern, the objects that rest on the support."""
    pattern = entry.top_at_bottom_of or ""
    named = [thing for thing in others if thing.name == pattern]
    if "*" not in pattern and not named:
        raise entry.unknown("object", pattern, [o.name for o in others], "top_at_bottom_of")
    fitting = named or [
        thing
        for thing in others
        if thing.tag is TagType.MOBILE and fnmatchcase(thing.name, pattern)
    ]
    if not fitting:
        raise entry.error("top_at_bottom_of", f"no mobile object fits {pattern!r}.")
    return [thing for thing in fitting if thing.shape] or fitting
