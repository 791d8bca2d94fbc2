"""Fingers close onto what a hand holds: they touch it, are not inside of it, and open before."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import ready_made
from capar.body.grasping import (
    CLOSE_S,
    FINGERS,
    OPPOSE_S,
    Grasp,
    Near,
    closed_grasp,
    fingered,
    fingers_of,
    flexions,
    hand_grasps,
    hinge_names,
)
from capar.body.human import Human
from capar.body.scripts import SIDES
from capar.body.virtual_scenes import Thing, box, cup, grips
from capar.model.capture import Shape

RATE_HZ = 100.0
THERE = RigidTransform.identity()


def rod(radius_m: float, height_m: float) -> Shape:
    made = trimesh.creation.cylinder(radius_m, height_m, sections=48)
    made.apply_translation((0.0, 0.0, 0.5 * height_m))
    return Shape(np.array(made.vertices), np.array(made.faces))


THINGS = {
    "mug": (cup(0.035, 0.09), "side", True),
    "crate": (box(0.15, 0.20, 0.15), "side", False),
    "edge": (box(0.035, 0.05, 0.12), "side", False),
    "pole": (rod(0.014, 0.3), "side", True),
    "lid": (box(0.12, 0.08, 0.05), "top", False),
}
SHORT_ROD = (rod(0.014, 0.05), "side", True)


def taken(
    what: tuple[Shape, str, bool],
    who: str,
    side: str,
    off: RigidTransform = THERE,
) -> tuple[Grasp, RigidTransform]:
    """How a hand closes on an object at the easiest grip, and ``T_hand_object``."""
    shape, kind, is_round = what
    human = Human.of(ready_made(who))
    site = human.model.site(f"{side}_palm")
    turn = Rotation.from_quat(site.quat, scalar_first=True)
    palm = RigidTransform.from_components(site.pos, turn)
    thing = Thing("thing", shape, (0.0, 0.0, 0.0), round=is_round)
    seat = off * palm * grips(thing, side, kind, human.measures)[0].inv()
    near = Near.of(
        shape, RigidTransform.concatenate([seat]), human.measures["hand_length"], held=True
    )
    return closed_grasp(human.measures, side, (0, 1), ["thing"], [near]), seat


def gaps(grasp: Grasp, shape: Shape, seat: RigidTransform, who: str, side: str) -> dict[str, float]:
    """By finger how far its flesh is from the object's triangles, negative inside [m]."""
    mesh = trimesh.Trimesh(np.array(shape.vertices), np.array(shape.faces), process=False)
    out, at = {}, 0
    for finger in fingers_of(ready_made(who), side):
        own = grasp.closed[at : at + len(finger.axes)]
        at += len(finger.axes)
        points = seat.inv().apply(finger.points(own).reshape(-1, 3))
        count = len(mesh.triangles)
        pairs = np.tile(mesh.triangles, (len(points), 1, 1)), np.repeat(points, count, axis=0)
        nearest = trimesh.triangles.closest_point(*pairs)
        apart = np.linalg.norm(nearest - pairs[1], axis=1).reshape(-1, count).min(axis=1)
        if mesh.volume > 0.99 * mesh.convex_hull.volume:
            ahead = points @ mesh.face_normals.T
            off = ahead - (mesh.face_normals * mesh.triangles[:, 0]).sum(axis=1)
            apart *= np.sign(off.max(axis=1))
        out[finger.name] = float((apart - np.repeat(finger.radii, len(points) // 3)).min())
    return out


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("who", ["man", "child"])
@pytest.mark.parametrize("name", THINGS)
def test_fingers_that_close_touch_the_surface_and_are_not_inside(
    name: str, who: str, side: str
) -> None:
    grasp, seat = taken(THINGS[name], who, side)
    found = gaps(grasp, THINGS[name][0], seat, who, side)
    assert len(grasp.reaching) >= 4
    assert set(grasp.reaching) | set(grasp.short) == {f"{side}_{each}" for each in FINGERS}
    assert min(found.values()) > -0.001
    assert max(found[finger] for finger in grasp.reaching) < 0.002


def test_hands_are_mirror_images_of_each_other() -> None:
    for name in ("mug", "crate"):
        right, left = (taken(THINGS[name], "woman", side)[0] for side in SIDES)
        np.testing.assert_allclose(right.closed, left.closed, atol=0.05)


def test_a_finger_beside_a_short_rod_stays_open_and_is_reported() -> None:
    grasp, _ = taken(SHORT_ROD, "man", "right")
    assert "right_index" in grasp.short
    index = [name.startswith("right_index") for name in hinge_names("right")]
    assert not grasp.closed[index].any()
    assert {"right_ring", "right_little"} <= set(grasp.reaching)


def test_a_thumb_is_opposed_to_the_fingers_around_a_mug_and_flat_on_a_crate() -> None:
    opposed = hinge_names("right").index("right_thumb_opposition")
    around, flat = (taken(THINGS[name], "man", "right")[0].closed for name in ("mug", "crate"))
    assert around[opposed] > np.radians(40.0)
    assert flat[opposed] < np.radians(15.0)


def _coming(far_m: float) -> tuple[RigidTransform, Grasp]:
    """``T_hand_mug`` of a hand that comes along its fingers, takes a mug for a second, and goes."""
    _, seat = taken(THINGS["mug"], "man", "right")
    frames = np.arange(300)
    away = np.maximum(np.maximum(100 - frames, frames - 200), 0) / RATE_HZ / CLOSE_S
    seats = RigidTransform.from_translation(np.outer(far_m * away, [0.0, 0.0, -1.0])) * seat
    hand, mug = RigidTransform.concatenate([RigidTransform.identity()] * 300), THINGS["mug"][0]
    spans = [(100, 200, {"mug"})]
    measures = ready_made("man")
    (grasp,) = hand_grasps(measures, "right", hand, {"mug": (mug, seats)}, spans, RATE_HZ)
    return seats, grasp


def test_fingers_are_open_before_and_after_and_closed_meanwhile() -> None:
    _, grasp = _coming(0.0)
    angles = flexions(300, [grasp])
    np.testing.assert_allclose(angles[100:201], np.tile(grasp.closed, (101, 1)))
    away = round((CLOSE_S + OPPOSE_S) * RATE_HZ) + 1
    assert not angles[: 100 - away].any()
    assert not angles[201 + away :].any()
    straight = [not name.startswith("right_thumb") for name in hinge_names("right")]
    assert not angles[: 100 - round(CLOSE_S * RATE_HZ), straight].any()


def test_fingers_wait_for_the_hand_to_be_there_before_they_close_around_a_mug() -> None:
    seats, grasp = _coming(0.04)
    found = {}
    for name, own in (("waits", grasp), ("does not", _coming(0.0)[1])):
        angles = flexions(300, [own])
        found[name] = min(
            min(
                gaps(
                    replace(grasp, closed=angles[at]), THINGS["mug"][0], seats[at], "man", "right"
                ).values()
            )
            for at in range(80, 221, 4)
        )
    assert found["waits"] > -0.001
    assert found["does not"] < -0.002
    assert grasp.shares[100:201].min() == 2.0


@pytest.mark.parametrize("who", ["man", "child"])
def test_a_thumb_that_lies_inside_a_crate_is_bent_out_of_it(who: str) -> None:
    """The palm is 3 mm too deep, and turned by 3 degrees about the hand's edge."""
    turn = Rotation.from_rotvec([-0.05, 0.0, 0.0])
    off = RigidTransform.from_components([0.0, -0.003, 0.0], turn)
    grasp, seat = taken(THINGS["crate"], who, "right", off)
    assert min(gaps(grasp, THINGS["crate"][0], seat, who, "right").values()) > -0.001


@pytest.mark.parametrize("who", ["man", "child"])
def test_the_thumb_of_a_free_hand_keeps_out_of_what_is_beside_it(who: str) -> None:
    measures = ready_made(who)
    thumb = fingers_of(measures, "right")[0]
    tip = thumb.points(np.zeros(4))[2, -1]
    ahead = float(tip[0] + thumb.radii[2]) - 0.003
    seat = RigidTransform.from_translation([ahead + 0.075, tip[1], tip[2] - 0.075])
    crate, seats = THINGS["crate"][0], RigidTransform.concatenate([seat])
    near = Near.of(crate, seats, measures["hand_length"], held=False)
    grasp = closed_grasp(measures, "right", (0, 1), [], [near])
    straight = replace(grasp, closed=np.zeros_like(grasp.closed))
    assert gaps(straight, crate, seat, who, "right")["right_thumb"] < -0.002
    assert min(gaps(grasp, crate, seat, who, "right").values()) > 0.0
    assert not grasp.reaching


@pytest.mark.parametrize("side", SIDES)
def test_bones_are_where_the_model_of_the_body_has_them(side: str) -> None:
    human, rng = Human.of(ready_made("woman")), np.random.default_rng(3)
    fingers = fingers_of(human.measures, side)
    angles = np.concatenate([rng.uniform(*each.ranges.T) for each in fingers])
    body, posture = fingered(human, human.posture()[None], {side: angles[None]})
    assert not body.outside(posture).any()
    wrist = body.sites(posture, [f"{side}_hand"])[f"{side}_hand"][0][0]
    at = 0
    for finger in fingers:
        places, turns = finger.bones(angles[at : at + len(finger.axes)])
        at += len(finger.axes)
        for bone in range(3):
            name = f"{finger.name}_{bone + 1}"
            spots, quats = body.sites(posture, [name])[name]
            np.testing.assert_allclose(places[bone], spots[0] - wrist, atol=1e-9)
            own = Rotation.from_quat(quats[0], scalar_first=True).as_matrix()
            np.testing.assert_allclose(turns[bone], own, atol=1e-9)


def test_five_fingers_weigh_what_fingers_that_bend_as_one_weigh() -> None:
    measures = ready_made("man")
    one, five = (Human.of(measures, fingers=fingers) for fingers in (False, True))
    assert five.model.body_subtreemass[0] == pytest.approx(one.model.body_subtreemass[0])
    np.testing.assert_allclose(
        five.centre_of_mass(five.posture()), one.centre_of_mass(one.posture()), atol=1e-3
    )


def test_fingers_that_bent_as_one_bend_likewise() -> None:
    human = Human.of(ready_made("man"))
    posture = human.posture({"left_knuckle_flexion": 0.4, "left_finger_flexion": 0.6})
    body, motion = fingered(human, posture[None], {})
    for finger in ("index", "little"):
        assert motion[0, body.index(f"left_{finger}_flexion_1")] == 0.4
        assert motion[0, body.index(f"left_{finger}_flexion_2")] == 0.6
