"""Centres of joints are found from how clusters of markers move on both sides."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from capar.body.marker_fitting import cluster_of, joint_centre, joint_centres

FRAMES = 80
RNG = np.random.default_rng(4)
LOCAL = RNG.uniform(-0.05, 0.05, (3, 3))


def jointed(
    swing_rad: float, noise_m: float, *, hinge: bool = False
) -> tuple[list[np.ndarray], list[np.ndarray], np.ndarray]:
    """Markers on two bodies that turn about a common point, and where this is [m].

    A hinge turns about an axis across its upper body only, which then turns about the same axis.
    """
    rng = np.random.default_rng(5)
    share = np.linspace(0.0, 2.0 * np.pi, FRAMES)
    centre = np.column_stack([0.8 * share, 0.1 * np.sin(share), 0.9 + 0.02 * np.cos(share)])
    upper = Rotation.from_rotvec(np.column_stack([0 * share, swing_rad * np.sin(share), 0 * share]))
    others = 0.0 if hinge else 0.8
    bend = np.column_stack(
        [others * np.cos(2.0 * share), np.cos(share), others * np.sin(2.0 * share)]
    )
    lower = upper * Rotation.from_rotvec(swing_rad * bend)
    above = [upper.apply(each + np.array([0.02, 0.03, 0.2])) + centre for each in LOCAL]
    below = [lower.apply(each + np.array([-0.03, 0.01, -0.2])) + centre for each in LOCAL]
    noisy = [
        [each + rng.normal(0.0, noise_m, each.shape) for each in one] for one in (above, below)
    ]
    return noisy[0], noisy[1], centre


@pytest.mark.parametrize(("noise_m", "most_m"), [(0.0, 0.005), (0.001, 0.008)])
def test_a_guess_that_is_five_centimetres_off_is_corrected(noise_m: float, most_m: float) -> None:
    above, below, centre = jointed(0.5, noise_m)
    first, second = cluster_of(above), cluster_of(below)
    assert first is not None
    assert second is not None
    found = joint_centre(first, second, centre + np.array([0.03, -0.03, 0.03]))
    assert found is not None
    assert np.median(np.linalg.norm(found - centre, axis=1)) < most_m


def test_a_hinge_is_corrected_across_its_axis_and_stays_as_guessed_along_it() -> None:
    above, below, centre = jointed(0.5, 0.0, hinge=True)
    first, second = cluster_of(above), cluster_of(below)
    assert first is not None
    assert second is not None
    found = joint_centre(first, second, centre + np.array([0.03, -0.03, 0.03]))
    assert found is not None
    off = np.abs(found - centre)
    assert off[:, [0, 2]].max() < 0.03 / 5.0  # a fifth of what the guess is off
    np.testing.assert_allclose(off[:, 1], 0.03, atol=1e-3)


def test_a_joint_that_does_not_turn_stays_where_it_was_guessed() -> None:
    above, below, centre = jointed(0.0, 0.0)
    first, second = cluster_of(above), cluster_of(below)
    assert first is not None
    assert second is not None
    guess = centre + np.array([0.0, 0.0, 0.04])
    found = joint_centre(first, second, guess)
    assert found is not None
    np.testing.assert_allclose(found, guess, atol=1e-6)


def test_joints_are_told_by_the_segment_below_and_only_where_both_clusters_are() -> None:
    above, below, centre = jointed(0.5, 0.0)
    points = {f"T{n}": each for n, each in enumerate(above)}
    points |= {f"S{n}": each for n, each in enumerate(below)} | {"F0": below[0]}
    points["S1"] = points["S1"].copy()
    points["S1"][:20] = np.nan
    segments = {n: {"T": "thigh", "S": "shank", "F": "foot"}[n[0]] for n in points}
    parents, guesses = {"shank": "thigh", "foot": "shank"}, {"shank": centre, "foot": centre}
    found = joint_centres(points, segments, parents, guesses)
    assert set(found) == {"shank"}
    assert np.isnan(found["shank"][:20]).all()
    assert np.linalg.norm(found["shank"][20:] - centre[20:], axis=1).max() < 0.005


def test_two_markers_are_no_cluster() -> None:
    above, _, _ = jointed(0.5, 0.0)
    assert cluster_of(above[:2]) is None
    lost = [np.full_like(each, np.nan) for each in above]
    assert cluster_of(lost) is None
