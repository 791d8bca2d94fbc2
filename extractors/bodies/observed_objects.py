"""What an observation says of the objects of a scene."""

import numpy as np

from capar.model.capture import TagObject
from capar.model.observation import ObservedObject


def observed_object(each: TagObject) -> ObservedObject:
    """A tag object with its size and its pose in the first frame in which it is known."""
    known = np.flatnonzero(~each.stream.lost)
    frame = int(known[0]) if known.size else 0
    position = each.stream.positions[frame] if known.size else np.zeros(3)
    turn = each.stream.orientations[frame] if known.size else np.array([1.0, 0.0, 0.0, 0.0])
    size = each.shape.size if each.shape else np.zeros(3)
    x, y, z = map(float, position)
    w, i, j, k = map(float, turn)
    length, width, height = map(float, size)
    return ObservedObject(
        name=each.name,
        kind=each.kind or each.name,
        tag=each.tag.value,
        size_m=(length, width, height),
        shape=each.shape.description if each.shape else "",
        assumed=each.assumed,
        position_m=(x, y, z),
        orientation=(w, i, j, k),
    )
