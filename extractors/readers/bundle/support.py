"""Supports that a recording lacks, placed under what rests on them (spec 5)."""

from collections.abc import Sequence
from fnmatch import fnmatchcase

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Shape, TagObject, TagType
from capar.model.errors import UnknownNameError
from extractors.readers.bundle.toml_table import Table

OF = {"median": None, "lowest": None}
"""Which height a support takes of those of several objects."""

Pose = tuple[Float[np.ndarray, "3"], Float[np.ndarray, "4"]]


def under_object(
    table: Table, shape: Shape | None, others: Sequence[TagObject]
) -> tuple[Pose, str]:
    """The pose of a support whose surface is where an object's lowest corner is at a time.

    ``top_at_bottom_of`` names the object, ``at_s`` the time, from the end where it is negative.
    A pattern with ``*`` stands for every mobile object that has a shape: the surface is then where
    the ``median`` of their lowest corners is, or the ``lowest`` of them, as ``of`` says.
    ``surface_m`` is the surface's height in the support's own frame, its highest corner where it
    is not given; ``position`` (x, y) places the support elsewhere than under the objects' middle,
    ``turn_deg`` turns it about the vertical.

    Returns:
        The pose, and how it was derived.

    Raises:
        CaparError: No such object, it has no shape, or it is not seen then.
    """
    resting = _resting(table, others)
    if shape is None or any(each.shape is None for each in resting):
        raise table.error("top_at_bottom_of", "both the support and what rests on it need a shape.")
    found = [_corners(table, each) for each in resting]
    bottoms = np.array([float(corners[:, 2].min()) for corners, _ in found])
    of = table.choice("of", OF, "median")
    top = float(bottoms.min() if of == "lowest" else np.median(bottoms))
    everything = np.concatenate([corners for corners, _ in found])
    middle = (everything.min(axis=0) + everything.max(axis=0)) / 2
    turn = Rotation.from_euler("z", table.number("turn_deg", 0.0), degrees=True)
    highest = float(turn.apply(np.array(shape.vertices))[:, 2].max())
    x, y = table.vector("position", 2, (float(middle[0]), float(middle[1])))
    height = top - table.number("surface_m", highest)
    what = resting[0].name
    if len(resting) > 1:
        which = "lowest" if of == "lowest" else "median of the lowest points"
        what = f"the {which} of {len(resting)} objects"
    point = "" if len(resting) > 1 and of == "median" else "the lowest point of "
    text = f"top at {top:.3f} m, {point}{what} at rest at {found[0][1]:.2f} s"
    return (np.array([x, y, height]), geometry.quaternions(turn)), text


def _corners(table: Table, rests: TagObject) -> tuple[Float[np.ndarray, "corners 3"], float]:
    """An object's corners in the world at the stated time [m], and the time it is seen at [s]."""
    at_s = table.number("at_s")
    if at_s < 0.0:
        at_s += float(rests.stream.times[-1])
    known = np.flatnonzero(~rests.stream.lost)
    if not known.size:
        raise table.error("at_s", f"{rests.name} is never seen.")
    frame = int(known[np.argmin(np.abs(rests.stream.times[known] - at_s))])
    seen_s = float(rests.stream.times[frame])
    if abs(seen_s - at_s) > 0.1:
        raise table.error(
            "at_s", f"{rests.name} is not seen near {at_s:g} s, but at {seen_s:.2f} s."
        )
    assert rests.shape is not None
    return rests.stream.pose(frame).apply(np.array(rests.shape.vertices)), seen_s


def _resting(table: Table, others: Sequence[TagObject]) -> list[TagObject]:
    """The object or, by a pattern, the objects that rest on the support."""
    pattern = table.text("top_at_bottom_of")
    if "*" not in pattern:
        return [_named(table, others)]
    fitting = [
        each
        for each in others
        if each.tag is TagType.MOBILE and each.shape and fnmatchcase(each.name, pattern)
    ]
    if not fitting:
        raise table.error("top_at_bottom_of", f"no mobile object with a shape fits {pattern!r}.")
    return fitting


def _named(table: Table, others: Sequence[TagObject]) -> TagObject:
    name = table.text("top_at_bottom_of")
    for each in others:
        if each.name == name:
            return each
    known = [each.name for each in others]
    raise UnknownNameError("object", name, known, where=table.where("top_at_bottom_of"))
