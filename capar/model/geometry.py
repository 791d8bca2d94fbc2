"""Rigid motion in a right-handed world whose z axis points up: metres, and quaternions w x y z."""

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from jaxtyping import Bool, Float

from capar.model.errors import CaptureError

if TYPE_CHECKING:  # it takes half a second to import, and who asks an Actionary turns nothing
    from scipy.spatial.transform import RigidTransform, Rotation

Series: TypeAlias = Float[np.ndarray, "frames"]
Holds: TypeAlias = Bool[np.ndarray, "frames"]
Vector: TypeAlias = Float[np.ndarray, "3"]
Quaternion: TypeAlias = Float[np.ndarray, "4"]
#: World positions [m] at every frame; NaN where lost
Places: TypeAlias = Float[np.ndarray, "frames 3"]
#: Unit quaternions w x y z, body to world, at every frame; NaN where lost
Turns: TypeAlias = Float[np.ndarray, "frames 4"]
UNIT_TOLERANCE = 0.01  # how far a quaternion's norm may lie from one before it is an error [1]
ROUNDING = 1e-15  # how far from one rounding leaves the norm of a quaternion that was scaled [1]


def rotations(quaternions: Float[np.ndarray, "*frames 4"]) -> "Rotation":
    """The rotations that unit quaternions (w x y z) stand for."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_quat(quaternions, scalar_first=True)


def quaternions(rotation: "Rotation") -> Float[np.ndarray, "*frames 4"]:
    """Unit quaternions (w x y z) of rotations."""
    return rotation.as_quat(scalar_first=True)


def products(
    first: Float[np.ndarray, "#frames 4"], second: Float[np.ndarray, "#frames 4"]
) -> Float[np.ndarray, "frames 4"]:
    """Unit quaternions (w x y z) of the second rotation followed by the first, frame by frame.

    SciPy 1.17 takes twenty times as long for many frames.
    """
    a, b, c, d = first.T
    w, x, y, z = second.T
    return np.stack(
        [
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ],
        axis=-1,
    )


def transforms(
    positions: Float[np.ndarray, "*frames 3"], orientations: Float[np.ndarray, "*frames 4"]
) -> "RigidTransform":
    """Poses as transforms that compose with ``*`` and act on points: ``T_world_body.apply(p)``."""
    from scipy.spatial.transform import RigidTransform

    return RigidTransform.from_components(positions, rotations(orientations))


def composed(
    positions: Float[np.ndarray, "frames 3"],
    orientations: Float[np.ndarray, "frames 4"],
    offset: "RigidTransform",
) -> tuple[Float[np.ndarray, "frames 3"], Float[np.ndarray, "frames 4"]]:
    """``T_world_body * T_body_offset``: its positions [m] and its unit quaternions w x y z.

    ``transforms(...) * offset`` gives the same to the last bit; most of its time it looks for
    matrices that are no rotations.
    """
    from scipy.spatial.transform import Rotation

    def through_matrix(rotation: "Rotation") -> "Rotation":
        return Rotation.from_matrix(rotation.as_matrix(), assume_valid=True)

    poses = np.zeros((len(positions), 4, 4))
    poses[:, :3, :3] = through_matrix(rotations(orientations)).as_matrix()
    poses[:, :3, 3], poses[:, 3, 3] = positions, 1.0
    poses = poses @ offset.as_matrix()
    turned = Rotation.from_matrix(poses[:, :3, :3], assume_valid=True)
    return poses[:, :3, 3], quaternions(through_matrix(turned))


def continuous(orientations: Float[np.ndarray, "frames 4"]) -> Float[np.ndarray, "frames 4"]:
    """The same orientations with signs chosen so that neighbours are near; NaN frames stay."""
    out = np.array(orientations, dtype=float)
    known = np.flatnonzero(is_known(out))
    if known.size < 2:
        return out
    turns = out if known.size == len(out) else out[known]
    turned_over = np.einsum("ij,ij->i", turns[1:], turns[:-1]) < 0.0
    if turned_over.any():
        out[known[1:]] *= np.cumprod(np.where(turned_over, -1.0, 1.0))[:, None]
    return out


def unit(orientations: Float[np.ndarray, "frames 4"]) -> Float[np.ndarray, "frames 4"]:
    """The orientations scaled to norm one; NaN frames stay, and so do those that rounding left.

    Raises:
        CaptureError: A norm is further from one than ``UNIT_TOLERANCE``.
    """
    norms = lengths(orientations)
    bad = np.flatnonzero(np.abs(norms - 1.0) > UNIT_TOLERANCE)
    if bad.size:
        raise CaptureError(
            f"quaternion of norm {norms[bad[0]]:.4g} at frame {bad[0]} ({bad.size} in all); "
            "orientations are unit quaternions in the order w x y z"
        )
    # So that what was scaled once is the same to the last bit when it is scaled again.
    norms = np.where(np.abs(norms - 1.0) <= ROUNDING, 1.0, norms)
    return np.asarray(orientations / norms[:, None])


def lengths(vectors: Float[np.ndarray, "*some axes"]) -> Float[np.ndarray, "*some"]:
    """The length of each of many vectors of few axes, in their own unit.

    ``numpy.linalg.norm`` gives the same to the last bit in eight times the time.
    """
    return np.asarray(np.sqrt(totals(vectors * vectors)))


def totals(values: Float[np.ndarray, "*some axes"]) -> Float[np.ndarray, "*some"]:
    """The sum of a few values along the last axis, as quickly."""
    total = values[..., 0].copy()
    for axis in range(1, values.shape[-1]):
        total += values[..., axis]
    return np.asarray(total)


def every(holds: Bool[np.ndarray, "*some axes"]) -> Bool[np.ndarray, "*some"]:
    """Whether all of a few conditions hold: ``holds.all(axis=-1)`` in a twentieth of the time."""
    out = holds[..., 0].copy()
    for axis in range(1, holds.shape[-1]):
        out &= holds[..., axis]
    return np.asarray(out)


def is_known(vectors: Float[np.ndarray, "*some axes"]) -> Bool[np.ndarray, "*some"]:
    """Whether no coordinate of each vector is NaN."""
    return every(~np.isnan(vectors))


def angle_between(
    first: Float[np.ndarray, "frames 4"], second: Float[np.ndarray, "#frames 4"]
) -> Float[np.ndarray, "frames"]:
    """The angle of the rotation that takes one orientation to the other [rad], in [0, pi].

    The second may be a single orientation for all frames.
    """
    dots = np.abs(np.einsum("...j,...j->...", first, second))
    return 2.0 * np.arccos(np.clip(dots, 0.0, 1.0))


def mean_orientation(orientations: Float[np.ndarray, "frames 4"]) -> Quaternion:
    """The mean of known orientations: the chordal one, as SciPy's ``Rotation.mean`` computes it.

    It is the eigenvector of the largest eigenvalue of the sum of the quaternions' outer products
    (Markley, Cheng, Crassidis and Oshman 2007).
    """
    turns = np.empty(orientations.shape)
    turns[:, :3], turns[:, 3] = orientations[:, 1:], orientations[:, 0]
    turns /= lengths(turns)[:, None]
    outer = np.dot(np.ones(len(turns)) * turns.T, turns)
    return np.asarray(np.linalg.eigh(outer)[1][[3, 0, 1, 2], -1])


def from_middle(
    places: Float[np.ndarray, "frames 3"], of: slice = slice(None)
) -> Float[np.ndarray, "frames"]:
    """How far each place is from the middle of the box around some of them [m]; NaN where lost.

    Of places along a line the middle is that from which the furthest is nearest.
    """
    low, high = np.nanmin(places[of], axis=0), np.nanmax(places[of], axis=0)
    return lengths(places - 0.5 * (low + high))


def from_mean(
    orientations: Float[np.ndarray, "frames 4"], of: slice = slice(None)
) -> Float[np.ndarray, "frames"]:
    """The angle of each orientation to the mean of some of them [rad]; NaN where it is lost."""
    known = orientations[of][is_known(orientations[of])]
    if not len(known):
        return np.full(len(orientations), np.nan)
    return angle_between(orientations, mean_orientation(known)[None])


def fit_rigid(
    local: Float[np.ndarray, "markers 3"], world: Float[np.ndarray, "markers 3"]
) -> tuple["RigidTransform", float]:
    """``T_world_body`` by least squares from places of markers, and what is left (RMS) [m]."""
    from scipy.spatial.transform import RigidTransform, Rotation

    centre_local, centre_world = local.mean(axis=0), world.mean(axis=0)
    rotation, _ = Rotation.align_vectors(world - centre_world, local - centre_local)
    transform = RigidTransform.from_components(
        centre_world - rotation.apply(centre_local), rotation
    )
    rest = transform.apply(local) - world
    return transform, float(np.sqrt((rest**2).sum(axis=1).mean()))


def runs(holds: Bool[np.ndarray, "frames"]) -> list[tuple[int, int]]:
    """Runs of true values, as closed intervals of frames [first, last]."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], holds.astype(np.int8), [0]))))
    return [(int(first), int(last) - 1) for first, last in edges.reshape(-1, 2)]


def slerp(
    times: Float[np.ndarray, "known"],
    orientations: Float[np.ndarray, "known 4"],
    wanted: Float[np.ndarray, "frames"],
) -> Float[np.ndarray, "frames 4"]:
    """Orientations at other times [s], along great arcs; times outside are held at the ends."""
    from scipy.spatial.transform import Slerp

    if times.size == 1:
        return np.repeat(orientations, wanted.size, axis=0)
    inside = np.clip(wanted, times[0], times[-1])
    return quaternions(Slerp(times, rotations(orientations))(inside))
