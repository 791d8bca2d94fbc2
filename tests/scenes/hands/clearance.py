"""How far bodies of a stage are apart, or how deep in each other."""

from itertools import pairwise
from typing import Any

import fcl
import numpy as np
from jaxtyping import Float
from trimesh import Trimesh

from scenes.hands.performer import Hand
from scenes.hands.shapes import Form
from scenes.hands.things import Thing

FAR_M = 0.06
"""Bodies whose boxes are further apart are not looked at more closely [m]."""


def gap(
    first: Form, at: Float[np.ndarray, "4 4"], second: Form, there: Float[np.ndarray, "4 4"]
) -> float:
    """Distance of two forms at two poses [m]; below zero at most how deep they overlap."""
    return min(_apart(one, at, other, there) for one in first.parts for other in second.parts)


def _apart(one: Trimesh, at: np.ndarray, other: Trimesh, there: np.ndarray) -> float:
    mine, theirs = _moved(one.vertices, at), _moved(other.vertices, there)
    boxes = np.maximum(mine.min(0) - theirs.max(0), theirs.min(0) - mine.max(0))
    if (coarse := float(boxes.max())) > FAR_M:
        return coarse
    normals = np.concatenate(
        [
            _distinct(one.face_normals) @ at[:3, :3].T,
            _distinct(other.face_normals) @ there[:3, :3].T,
        ]
    )
    along, across = mine @ normals.T, theirs @ normals.T
    between = np.maximum(along.min(0) - across.max(0), across.min(0) - along.max(0))
    bound = float(between.max())
    if -0.0005 < bound < FAR_M or bound < -0.002:
        exact = _distance(one, at, other, there)
        return exact if exact > 0.0 else min(bound, 0.0)
    return bound


def _moved(points: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def _distinct(normals: np.ndarray) -> np.ndarray:
    return np.unique(np.round(normals, 6), axis=0)


def _distance(one: Trimesh, at: np.ndarray, other: Trimesh, there: np.ndarray) -> float:
    bodies = [_solid(one, at), _solid(other, there)]
    result = fcl.DistanceResult()
    return float(fcl.distance(*bodies, fcl.DistanceRequest(), result))


def _solid(part: Trimesh, matrix: np.ndarray) -> Any:
    model = fcl.BVHModel()
    model.beginModel(len(part.faces), len(part.vertices))
    model.addSubModel(np.asarray(part.vertices), np.asarray(part.faces))
    model.endModel()
    return fcl.CollisionObject(model, fcl.Transform(matrix[:3, :3], matrix[:3, 3]))


def between(first: Hand | Thing, second: Hand | Thing, time: float) -> float:
    """Distance of two bodies at a time [m]."""
    return gap(first.form, first.body.at(time), second.form, second.body.at(time))


def moving(thing: Thing, times: Float[np.ndarray, "frames"]) -> Float[np.ndarray, "moments"]:
    """The times [s] at which a thing is not where it was a frame before."""
    poses = thing.body.poses(times)
    moved = [bool(np.abs(later - sooner).max() > 1e-6) for sooner, later in pairwise(poses)]
    return np.asarray(times[1:][np.array(moved, dtype=bool)])
