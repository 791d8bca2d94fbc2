"""How far bodies of a stage are apart, or how deep in each other."""

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any

import fcl
import numpy as np
from jaxtyping import Float

from scenes.hands.performer import Hand
from scenes.hands.shapes import Form
from scenes.hands.stage import Finger
from scenes.hands.things import Thing

FAR_M = 0.06
"""Bodies whose boxes are further apart are not looked at more closely [m]."""

SURE_M = 0.0005
"""Gaps up to this are taken from the directions of faces alone [m]."""


@dataclass(frozen=True, eq=False)
class Part:
    """A convex part, prepared for distances."""

    vertices: Float[np.ndarray, "vertices 3"]
    normals: Float[np.ndarray, "faces 3"]
    model: Any


@dataclass(frozen=True, eq=False)
class Placed:
    """A body's form at one time."""

    form: Form
    pose: Float[np.ndarray, "4 4"]

    @classmethod
    def at(cls, body: Hand | Thing | Finger, time: float) -> "Placed":
        """A body at a time [s]."""
        return cls(body.form, body.body.at(time))

    def points(self, part: Part) -> Float[np.ndarray, "vertices 3"]:
        """A part's corners in the world."""
        return np.asarray(part.vertices @ self.pose[:3, :3].T + self.pose[:3, 3])


@lru_cache(maxsize=256)
def parts(form: Form) -> tuple[Part, ...]:
    """A form's parts, prepared once."""
    return tuple(_prepared(each) for each in form.parts)


def _prepared(mesh: Any) -> Part:
    model = fcl.BVHModel()
    model.beginModel(len(mesh.faces), len(mesh.vertices))
    model.addSubModel(np.asarray(mesh.vertices), np.asarray(mesh.faces))
    model.endModel()
    normals = np.unique(np.round(mesh.face_normals, 6), axis=0)
    return Part(np.asarray(mesh.vertices), normals, model)


def gap(first: Placed, second: Placed) -> float:
    """Distance of two bodies [m]; below zero at most how deep they overlap."""
    whole = [
        each.form.vertices @ each.pose[:3, :3].T + each.pose[:3, 3] for each in (first, second)
    ]
    if (coarse := _boxes_apart(*whole)) > FAR_M:
        return coarse
    return min(
        _apart(first, one, second, other)
        for one in parts(first.form)
        for other in parts(second.form)
    )


def _boxes_apart(mine: np.ndarray, theirs: np.ndarray) -> float:
    return float(np.maximum(mine.min(0) - theirs.max(0), theirs.min(0) - mine.max(0)).max())


def _apart(first: Placed, one: Part, second: Placed, other: Part) -> float:
    mine, theirs = first.points(one), second.points(other)
    if (coarse := _boxes_apart(mine, theirs)) > FAR_M:
        return coarse
    turned = [one.normals @ first.pose[:3, :3].T, other.normals @ second.pose[:3, :3].T]
    normals = np.concatenate(turned)
    bound = _boxes_apart(mine @ normals.T, theirs @ normals.T)
    if -SURE_M < bound < FAR_M or bound < -4 * SURE_M:
        exact = _distance(first, one, second, other)
        return exact if exact > 0.0 else min(bound, 0.0)
    return bound


def _distance(first: Placed, one: Part, second: Placed, other: Part) -> float:
    bodies = [
        fcl.CollisionObject(part.model, fcl.Transform(body.pose[:3, :3], body.pose[:3, 3]))
        for body, part in ((first, one), (second, other))
    ]
    return float(fcl.distance(*bodies, fcl.DistanceRequest(), fcl.DistanceResult()))


def moving(thing: Thing, times: Float[np.ndarray, "frames"]) -> Float[np.ndarray, "moments"]:
    """The times [s] at which a thing is not where it was a frame before."""
    poses = thing.body.poses(times)
    moved = [bool(np.abs(later - sooner).max() > 1e-6) for sooner, later in pairwise(poses)]
    return np.asarray(times[1:][np.array(moved, dtype=bool)])
