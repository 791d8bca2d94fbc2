"""Triangles that cut each other do so at points of both."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from extractors.contact.surfaces import meeting_point, meeting_points


@given(seed=st.integers(0, 2**32 - 1), scale=st.floats(1e-3, 1e3))
def test_one_pair_of_triangles_meets_where_many_pairs_do(seed: int, scale: float) -> None:
    first, second = scale * np.random.default_rng(seed).normal(size=(2, 20, 3, 3))
    points = meeting_points(first, second)
    for one, other, expected in zip(first, second, points, strict=True):
        point = meeting_point(one.tolist(), other.tolist())
        if point is None:
            assert np.isnan(expected).all()
        else:
            assert np.array(point) == pytest.approx(expected, rel=1e-9, abs=1e-9 * scale)


@given(seed=st.integers(0, 2**32 - 1))
def test_a_meeting_point_lies_in_the_planes_of_both_triangles(seed: int) -> None:
    first, second = np.random.default_rng(seed).normal(size=(2, 3, 3))
    point = meeting_point(first.tolist(), second.tolist())
    if point is not None:
        for corners in (first, second):
            normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            height = (np.array(point) - corners[0]) @ normal / np.linalg.norm(normal)
            assert height == pytest.approx(0.0, abs=1e-6)


def test_triangles_apart_and_in_one_plane_meet_nowhere() -> None:
    flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    above = [[x, y, z + 1.0] for x, y, z in flat]
    assert meeting_point(flat, above) is None
    assert meeting_point(flat, flat) is None
