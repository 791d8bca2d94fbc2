"""Markers to rigid bodies: their mean arrangement, and its pose in every frame by least squares."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.errors import CaptureError

FLAT_M = 1e-4
"""Markers whose second principal spread is below this lie on a line [m]."""


@dataclass(frozen=True, eq=False)
class Cluster:
    """A named marker set as one rigid body."""

    names: tuple[str, ...]
    local: Float[np.ndarray, "markers 3"]
    """Places of the markers in the body's frame [m]."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A cluster's pose over time."""

    positions: Float[np.ndarray, "frames 3"]
    orientations: Float[np.ndarray, "frames 4"]
    residuals: Float[np.ndarray, "frames"]
    """Root mean square distance of seen markers from their places [m]; NaN where lost."""


def arrangement(body: str, markers: Mapping[str, Float[np.ndarray, "frames 3"]]) -> Cluster:
    """The mean arrangement over the frames in which most markers are seen.

    Its origin is the markers' centre; its axes are the world's in the first such frame.

    Raises:
        CaptureError: Fewer than three markers, on one line, or never three seen at once.
    """
    names = tuple(markers)
    if len(names) < 3:
        raise CaptureError(f"body {body!r} has markers {list(names)}; a rigid body needs three")
    points = np.stack([markers[each] for each in names], axis=1)
    seen = ~np.isnan(points).any(axis=2)
    whole = np.flatnonzero(seen.all(axis=1))
    if not whole.size:
        unseen = [name for name, each in zip(names, seen.T, strict=True) if not each.any()]
        raise CaptureError(
            f"body {body!r}: its markers are never all seen at once"
            + (f"; never seen at all: {unseen}" if unseen else "; use fewer of them")
        )
    local = points[whole[0]] - points[whole[0]].mean(axis=0)
    if np.linalg.svd(local, compute_uv=False)[1] < FLAT_M:
        raise CaptureError(f"body {body!r}: markers {list(names)} lie on one line")
    for _ in range(3):
        fit = fit_cluster(Cluster(names, local), points[whole])
        turned = geometry.rotations(fit.orientations).inv().as_matrix()
        local = np.einsum("fij,fmj->mi", turned, points[whole] - fit.positions[:, None]) / len(
            whole
        )
        local = local - local.mean(axis=0)
    return Cluster(names, local)


def fit_cluster(cluster: Cluster, points: Float[np.ndarray, "frames markers 3"]) -> Fit:
    """The pose of a cluster in every frame in which three of its markers are seen."""
    frames = len(points)
    fit = Fit(np.full((frames, 3), np.nan), np.full((frames, 4), np.nan), np.full(frames, np.nan))
    seen = ~np.isnan(points).any(axis=2)
    patterns, which = np.unique(seen, axis=0, return_inverse=True)
    for index, pattern in enumerate(patterns):
        rows = np.flatnonzero(which.reshape(-1) == index)
        if _fixes(cluster.local, pattern):
            _fit_rows(cluster.local[pattern], points[rows][:, pattern], rows, fit)
    return fit


def _fixes(local: Float[np.ndarray, "markers 3"], seen: Bool[np.ndarray, "markers"]) -> bool:
    """Whether the seen markers leave no rotation open."""
    if seen.sum() < 3:
        return False
    spread = local[seen] - local[seen].mean(axis=0)
    return bool(np.linalg.svd(spread, compute_uv=False)[1] >= FLAT_M)


def _fit_rows(
    local: Float[np.ndarray, "markers 3"],
    world: Float[np.ndarray, "frames markers 3"],
    rows: np.ndarray,
    fit: Fit,
) -> None:
    """Least squares over many frames at once (Kabsch), written into the fit."""
    centre, middle = local.mean(axis=0), world.mean(axis=1)
    u, _, vt = np.linalg.svd(np.einsum("fmi,mj->fij", world - middle[:, None], local - centre))
    sign = np.linalg.det(u @ vt)
    u[:, :, 2] *= np.where(sign < 0.0, -1.0, 1.0)[:, None]
    matrices = u @ vt
    placed = np.einsum("fij,mj->fmi", matrices, local - centre) + middle[:, None]
    fit.positions[rows] = middle - matrices @ centre
    fit.orientations[rows] = geometry.quaternions(Rotation.from_matrix(matrices))
    fit.residuals[rows] = np.sqrt(((placed - world) ** 2).sum(axis=2).mean(axis=1))


def check_fit(
    body: str,
    cluster: Cluster,
    points: Float[np.ndarray, "frames markers 3"],
    fit: Fit,
    *,
    limit_m: float,
) -> None:
    """Check that the markers keep their arrangement.

    Raises:
        CaptureError: They do not, or only in a mirror.
    """
    rest = float(np.nanmedian(fit.residuals)) if (~np.isnan(fit.residuals)).any() else np.nan
    if np.isnan(rest):
        raise CaptureError(f"body {body!r}: three of its markers are never seen at once")
    if rest <= limit_m:
        return
    other = fit_cluster(Cluster(cluster.names, cluster.local * [-1.0, 1.0, 1.0]), points)
    if float(np.nanmedian(other.residuals)) < 0.5 * rest:
        raise CaptureError(
            f"body {body!r}: its markers fit their arrangement only in a mirror; the world is "
            'left-handed (state handedness = "left") or two markers have changed names'
        )
    raise CaptureError(
        f"body {body!r}: markers {list(cluster.names)} leave {rest * 1e3:.1f} mm of their rigid "
        f"arrangement, more than {limit_m * 1e3:.1f} mm; leave out those that move against the "
        "others, or state residual_m"
    )
