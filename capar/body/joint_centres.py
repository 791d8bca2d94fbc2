"""Centres of joints between segments on which clusters of markers ride, from how these move.

Two rigid clusters on both sides of a joint have one point in common that keeps its place in both:
the joint's centre (symmetrical centre of rotation estimation; Ehrig et al. 2006, J Biomech
39:2798). Where a joint hardly turns, or only about one axis, the motion leaves it open along that;
there the centre stays where a first fit of the body had it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform, Rotation

from extractors.readers.drafting.stance import Points

LEAST_MARKERS = 3
"""So many markers tell how a cluster is placed and turned."""

LEAST_FRAMES = 10
"""Frames in which both clusters are seen, at least."""

TRUST = 0.1
"""Weight of the first fit's centre against one frame's motion [1]: skin moves by half a centimetre
or so, while first fits miss joints by about five."""


@dataclass(frozen=True, eq=False)
class Cluster:
    """Markers that ride on one segment, as a rigid body."""

    seen: Bool[np.ndarray, "frames"]
    poses: RigidTransform
    """``T_world_cluster`` of the frames in which all its markers are seen."""


def cluster_of(points: Sequence[Float[np.ndarray, "frames 3"]]) -> Cluster | None:
    """Markers as a rigid body; None if they are too few, or never seen at once.

    Args:
        points: Of markers on one segment, in the world [m]; NaN where lost.
    """
    if len(points) < LEAST_MARKERS:
        return None
    stack = np.stack(points, axis=1)
    seen = np.isfinite(stack).all(axis=(1, 2))
    if not seen.any():
        return None
    known = stack[seen]
    shape = known[len(known) // 2] - known[len(known) // 2].mean(axis=0)
    turns = [Rotation.align_vectors(one - one.mean(axis=0), shape)[0] for one in known]
    poses = RigidTransform.from_components(known.mean(axis=1), Rotation.concatenate(turns))
    return Cluster(seen, poses)


def joint_centre(
    first: Cluster, second: Cluster, guess: Float[np.ndarray, "frames 3"]
) -> Float[np.ndarray, "frames 3"] | None:
    """Where the joint between two clusters is in the world [m]; NaN where one of them is not seen.

    None if both are hardly ever seen at once.

    Args:
        first: On one side of the joint.
        second: On the other.
        guess: Where a first fit has it [m].
    """
    both = first.seen & second.seen & np.isfinite(guess).all(axis=1)
    if both.sum() < LEAST_FRAMES:
        return None
    poses = [shape.poses[both[shape.seen]] for shape in (first, second)]
    usual = [np.median(pose.inv().apply(guess[both]), axis=0) for pose in poses]
    frames = int(both.sum())
    turns = [pose.rotation.as_matrix() for pose in poses]
    matrix = np.concatenate([turns[0], -turns[1]], axis=2).reshape(3 * frames, 6)
    rest = (poses[1].translation - poses[0].translation).reshape(-1)
    weight = TRUST * np.sqrt(frames)
    matrix = np.concatenate([matrix, weight * np.eye(6)])
    rest = np.concatenate([rest, weight * np.concatenate(usual)])
    places = np.linalg.lstsq(matrix, rest, rcond=None)[0].reshape(2, 3)
    out = np.full_like(guess, np.nan)
    out[both] = (poses[0].apply(places[0]) + poses[1].apply(places[1])) / 2.0
    return out


def joint_centres(
    points: Points,
    segments: Mapping[str, str],
    parents: Mapping[str, str],
    guesses: Mapping[str, Float[np.ndarray, "frames 3"]],
) -> dict[str, Float[np.ndarray, "frames 3"]]:
    """By segment, where its joint with its parent is in the world [m].

    Args:
        points: Markers in the world [m]; NaN where lost.
        segments: The segment of each marker.
        parents: By segment, the one towards the pelvis.
        guesses: By segment, where a first fit has its joint [m].
    """
    clusters: dict[str, Cluster] = {}
    for segment in {*segments.values()}:
        found = cluster_of([points[name] for name, on in segments.items() if on == segment])
        if found is not None:
            clusters[segment] = found
    out = {}
    for segment, own in clusters.items():
        parent = parents.get(segment, "")
        if parent in clusters and segment in guesses:
            centre = joint_centre(clusters[parent], own, guesses[segment])
            if centre is not None:
                out[segment] = centre
    return out
