"""Contact directions are those of the patch where true surfaces meet, whatever the hulls are."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import ball, box, cup, still
from scipy.spatial.transform import Rotation

from capar.model.capture import Shape
from extractors.contact.normals import facing_normal
from extractors.contact.proximity import Body, body, screened
from extractors.contact.surfaces import surface

DEPTH_M = 0.005


def triangles(
    of: Shape, place: tuple[float, float, float] = (0.0, 0.0, 0.0), turn: Rotation | None = None
) -> np.ndarray:
    corners = surface(of).triangles
    turned = corners if turn is None else turn.apply(corners.reshape(-1, 3)).reshape(corners.shape)
    return np.asarray(turned + np.array(place))


@given(
    st.floats(0.0, 2.0 * np.pi),
    st.floats(0.3, 1.2),
    st.floats(-0.001, 0.004),
    st.floats(0.01, 0.03),
)
@settings(max_examples=25, deadline=None)
def test_a_ball_in_a_hollow_ball_is_pressed_along_the_radius_wherever_it_lies(
    azimuth: float, polar: float, gap_m: float, radius_m: float
) -> None:
    hollow = trimesh.creation.icosphere(4, 0.1)
    wall = np.asarray(hollow.triangles)[:, ::-1]
    out = np.array(
        [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), -np.cos(polar)]
    )
    place = (0.1 - radius_m - gap_m) * out
    inner = np.asarray(trimesh.creation.icosphere(4, radius_m).triangles) + place
    found = facing_normal(inner, wall, depth_m=DEPTH_M)
    assert found is not None
    assert np.degrees(np.arccos(np.clip(-found @ out, -1.0, 1.0))) < 6.0


@given(
    st.floats(-0.002, 0.004),
    st.floats(-0.15, 0.15),
    st.floats(0.0, np.pi),
    st.integers(0, 10_000),
)
@settings(max_examples=25, deadline=None)
def test_a_box_on_a_tilted_board_is_pressed_along_the_boards_normal_and_back_by_exactly_as_much(
    gap_m: float, aside_m: float, spin: float, seed: int
) -> None:
    tilt = Rotation.from_rotvec(np.random.default_rng(seed).uniform(-1.0, 1.0, 3))
    board = triangles(box(0.6, 0.6, 0.02), turn=tilt)
    place = tilt.apply([aside_m, 0.02, 0.01 + 0.05 + gap_m])
    thing = triangles(
        box(0.08, 0.12, 0.10), tuple(place), tilt * Rotation.from_rotvec([0, 0, spin])
    )
    found = facing_normal(thing, board, depth_m=DEPTH_M)
    back = facing_normal(board, thing, depth_m=DEPTH_M)
    assert found == pytest.approx(tilt.apply([0.0, 0.0, 1.0]), abs=0.02)
    assert back is not None
    assert np.array_equal(back, -np.asarray(found)), "to the last digit, so that either will do"


def test_what_stands_deep_in_a_cup_lies_on_its_bottom_though_the_rim_is_higher() -> None:
    """The two hulls cut each other least along the rim's way out, which is aside."""
    deep = cup(0.04, 0.10, 0.005)
    low = float(surface(deep).triangles[..., 2].min())
    found = facing_normal(
        triangles(ball(0.012), (0.01, 0.0, low + 0.005 + 0.012)), triangles(deep), depth_m=DEPTH_M
    )
    assert found is not None
    assert np.degrees(np.arccos(found[2])) < 6.0


def test_an_open_sheet_bears_from_the_side_that_it_is_met_at() -> None:
    sheet = np.array([[[-0.3, -0.3, 0.0], [0.3, -0.3, 0.0], [0.0, 0.4, 0.0]]])
    for side in (1.0, -1.0):
        thing = triangles(box(0.06, 0.06, 0.06), (0.0, 0.0, side * 0.031))
        for order in (sheet, sheet[:, ::-1]):
            found = facing_normal(thing, order, depth_m=DEPTH_M, solid=(True, False))
            assert found == pytest.approx((0.0, 0.0, side), abs=0.02)


def test_a_peg_pressed_from_all_sides_has_no_direction() -> None:
    ring = np.asarray(trimesh.creation.annulus(0.0105, 0.03, 0.04).triangles)
    peg = np.asarray(trimesh.creation.cylinder(0.01, 0.2).triangles)
    assert facing_normal(peg, ring, depth_m=0.001) is None


def stands(of: Shape, place: tuple[float, float, float]) -> Body:
    return body(surface(of), still(place, 20), rests=True)


@given(st.floats(-0.03, 0.03), st.floats(0.002, 0.006), st.floats(0.0, 0.3))
@settings(max_examples=20, deadline=None)
def test_a_plate_between_a_ball_and_a_table_keeps_them_apart_and_a_plate_beside_it_does_not(
    aside_m: float, thick_m: float, sunk: float
) -> None:
    """Though the plate's middle may be in the table, and the ball in the plate, by noise."""
    plate = box(0.2, 0.2, thick_m)
    for place_m, between in ((aside_m, True), (aside_m + 0.3, False)):
        bodies = {
            "ball": stands(ball(0.03), (0.0, 0.0, thick_m * (1.0 - 2.0 * sunk) + 0.03)),
            "plate": stands(plate, (place_m, 0.0, (0.5 - sunk) * thick_m)),
            "table": stands(box(2.0, 2.0, 0.1), (0.0, 0.0, -0.05)),
        }
        met = [
            (one, two, (0, 19))
            for one, two in (("ball", "plate"), ("ball", "table"), ("plate", "table"))
        ]
        through = list(screened(met, bodies, bodies, reach_m=0.005))
        assert through == [(), ((0, 19),) if between else (), ()]


@given(st.floats(0.0003, 0.0025), st.floats(0.003, 0.004))
@settings(max_examples=20, deadline=None)
def test_a_table_below_a_plate_is_not_between_the_plate_and_the_ball_on_it(
    gap_m: float, thick_m: float
) -> None:
    """Noise holds the ball off the plate; the longer line that joins them meets the table."""
    bodies = {
        "ball": stands(ball(0.03), (0.0, 0.0, thick_m + gap_m + 0.03)),
        "plate": stands(box(0.2, 0.2, thick_m), (0.0, 0.0, 0.5 * thick_m)),
        "table": stands(box(2.0, 2.0, 0.1), (0.0, 0.0, -0.05)),
    }
    pairs = (("ball", "plate"), ("ball", "table"), ("plate", "table"))
    met = [(one, two, (0, 19)) for one, two in pairs]
    assert list(screened(met, bodies, bodies, reach_m=0.005)) == [(), ((0, 19),), ()]
