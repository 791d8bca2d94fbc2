"""Supports that a recording lacks, placed under what rests on them (spec 5)."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Shape, TagObject
from capar.model.errors import UnknownNameError
from extractors.readers.toml_table import Table

Pose = tuple[Float[np.ndarray, "3"], Float[np.ndarray, "4"]]


def under_object(
    table: Table, shape: Shape | None, others: Sequence[TagObject]
) -> tuple[Pose, str]:
    """The pose of a support whose top is where an object's lowest corner is at a time.

    ``top_at_bottom_of`` names the object, ``at_s`` the time; ``position`` (x, y) places it
    elsewhere than under the object's middle, ``turn_deg`` turns it about the vertical.

    Returns:
        The pose, and how it was derived.

    Raises:
        CaparError: No such object, it has no shape, or it is not seen then.
    """
    rests = _named(table, others)
    if shape is None or rests.shape is None:
        raise table.error("top_at_bottom_of", "both the support and what rests on it need a shape.")
    at_s = table.number("at_s")
    known = np.flatnonzero(~rests.stream.lost)
    if not known.size:
        raise table.error("at_s", f"{rests.name} is never seen.")
    frame = int(known[np.argmin(np.abs(rests.stream.times[known] - at_s))])
    seen_s = float(rests.stream.times[frame])
    if abs(seen_s - at_s) > 0.1:
        raise table.error(
            "at_s", f"{rests.name} is not seen near {at_s:g} s, but at {seen_s:.2f} s."
        )
    corners = rests.stream.pose(frame).apply(np.array(rests.shape.vertices))
    top = float(corners[:, 2].min())
    turn = Rotation.from_euler("z", table.number("turn_deg", 0.0), degrees=True)
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    x, y = table.vector("position", 2, (float(middle[0]), float(middle[1])))
    height = top - float(turn.apply(np.array(shape.vertices))[:, 2].max())
    text = f"top at {top:.3f} m, the lowest point of {rests.name} at rest at {seen_s:.2f} s"
    return (np.array([x, y, height]), geometry.quaternions(turn)), text


def _named(table: Table, others: Sequence[TagObject]) -> TagObject:
    name = table.text("top_at_bottom_of")
    for each in others:
        if each.name == name:
            return each
    known = [each.name for each in others]
    raise UnknownNameError("object", name, known, where=table.where("top_at_bottom_of"))
