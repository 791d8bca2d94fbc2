"""What is said of hands at objects and of objects that cut the body, against known distances."""

from dataclasses import replace

import motions
import mujoco
import numpy as np
import pytest
from scipy.spatial import cKDTree

from capar.body.anthropometry import ready_made
from capar.body.fit_warnings import _apart, object_remarks
from capar.body.human import Human
from capar.body.scenes import box
from capar.body.sensor_fitting import Fit
from capar.model.capture import Capture, TagObject, TagType

CAPTURE = motions.drink_from_mug(motions.WOMAN).capture
HUMAN = Human.of(ready_made("woman"))
WHOLE = {
    "hips": "pelvis", "skull": "head",
    **{f"{side} {n}": f"{side}_{n}" for side in ("right", "left") for n in ("hand", "foot")},
}  # fmt: skip
HALF_M = 0.05


def standing() -> Fit:
    """A woman who stands with her arms down."""
    motion = np.tile(HUMAN.posture(), (len(CAPTURE.times), 1))
    return Fit(HUMAN, CAPTURE.times, motion, {}, {}, {}, 0.0, WHOLE)


def with_box(places: np.ndarray, tag: TagType = TagType.MOBILE) -> Capture:
    """The capture with nothing but a box of 10 cm, whose middle is at places [m]."""
    thing = next(one for one in CAPTURE.objects if one.shape is not None)
    shape = box(2 * HALF_M, 2 * HALF_M, 2 * HALF_M)
    frames = len(CAPTURE.times)
    at = np.broadcast_to(places, (frames, 3)) - np.array([0.0, 0.0, HALF_M])
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (frames, 1))
    stream = replace(thing.stream, positions=at, orientations=turns)
    made: TagObject = replace(thing, name="crate", tag=tag, shape=shape, stream=stream, assumed="")
    return replace(CAPTURE, objects=(made,), purposes=(), pivot_contacts=())


def beside_hand(gap_m: float | np.ndarray) -> np.ndarray:
    """Middles of boxes so far aside from the outside of the right hand [m]."""
    hand = HUMAN.sites(HUMAN.posture()[None], ["right_hand"])["right_hand"][0][0]
    numbers = [
        n
        for n in range(HUMAN.model.ngeom)
        if HUMAN.model.body(HUMAN.model.geom_bodyid[n]).name == "right_hand"
    ]
    thick = HUMAN.model.geom_size[numbers[0]][1]
    aside = np.atleast_1d(gap_m) + thick + HALF_M
    return hand + np.column_stack([0 * aside, -aside, 0 * aside - 0.05])


def test_a_hand_at_an_object_is_said_with_when_and_how_near() -> None:
    gaps = np.full(len(CAPTURE.times), 0.3)
    first, last = len(gaps) // 3, 2 * len(gaps) // 3
    gaps[first:last] = 0.008
    (line, *_) = object_remarks(standing(), with_box(beside_hand(gaps)))
    assert line.startswith("the right hand is at crate, within 20 mm of it, from ")
    begin, end = (float(word) for word in line.split(" from ")[1].split(" s (")[0].split(" to "))
    step = CAPTURE.times[-1] / 99
    assert begin == pytest.approx(CAPTURE.times[first], abs=1.5 * step)
    assert end == pytest.approx(CAPTURE.times[last - 1], abs=1.5 * step)
    assert "(8 mm apart in the median)" in line


def test_a_hand_that_comes_near_and_does_not_touch_is_said() -> None:
    lines = object_remarks(standing(), with_box(beside_hand(0.06)))
    (line,) = [line for line in lines if line.startswith("the right hand")]
    assert "is never at crate: it comes no nearer than 60 mm" in line or (
        "is never at crate: it comes no nearer than 61 mm" in line
    )


@pytest.mark.parametrize(("gap_m", "expected"), [(-0.03, "inside the head"), (0.015, "as near as")])
def test_an_object_in_the_head_or_near_it_is_said(gap_m: float, expected: str) -> None:
    top = HUMAN.sites(HUMAN.posture()[None], ["head_top"])["head_top"][0][0]
    (line,) = object_remarks(standing(), with_box(top + np.array([0.0, 0.0, gap_m + HALF_M])))
    assert expected in line
    told = float(line.split(" mm ")[0].split()[-1])
    assert told == pytest.approx(1e3 * abs(gap_m), abs=3.0)


def test_an_object_before_the_head_is_said_to_be_away_from_it() -> None:
    top = HUMAN.sites(HUMAN.posture()[None], ["head_top"])["head_top"][0][0]
    (line,) = object_remarks(standing(), with_box(top + np.array([0.4, 0.0, 0.0])))
    assert line.startswith("crate stays at least ")
    assert "from the head (0.00 s)" in line
    assert object_remarks(standing(), with_box(top + np.array([3.0, 0.0, 0.0]))) == []


def test_distances_from_ellipsoids_are_near_those_from_points_all_over_them() -> None:
    size = np.array([0.04, 0.05, 0.11])
    rng = np.random.default_rng(2)
    around = rng.normal(size=(60_000, 3))
    surface = size * around / np.linalg.norm(around, axis=1, keepdims=True)
    points = rng.uniform(-1.4, 1.4, (300, 3)) * size
    told = _apart(mujoco.mjtGeom.mjGEOM_ELLIPSOID, size, points)
    inside = np.linalg.norm(points / size, axis=1) < 1.0
    true = cKDTree(surface).query(points)[0] * np.where(inside, -1.0, 1.0)
    np.testing.assert_array_equal(told < 0.0, inside)
    assert np.abs(told - true)[np.abs(true) < 0.03].max() < 0.008
    assert (told - true)[~inside].max() < 1e-3  # "at least" holds
    middle = _apart(mujoco.mjtGeom.mjGEOM_ELLIPSOID, size, np.array([[0.0, 0.0, 1e-6]]))
    assert middle[0] == pytest.approx(-0.04, abs=1e-6)
