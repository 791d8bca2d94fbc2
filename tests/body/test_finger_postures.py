"""Hands are closed as far as the joints of their fingers were recorded."""

import numpy as np
import pytest

from capar.body.anthropometry import ready_made
from capar.body.fingers import closings, with_closings
from capar.body.fit_warnings import closed_hands
from capar.body.human import Human
from capar.body.sensor_fitting import Fit
from capar.model import geometry
from extractors.readers.names import BodyName

HUMAN = Human.of(ready_made("woman"))
FRAMES = 5
KNUCKLE, MIDDLE = 0.5, 0.9
BONES_M = (0.04, 0.025)


def recorded(side: str) -> tuple[np.ndarray, dict[str, np.ndarray], dict[str, BodyName]]:
    """A body with one arm raised, and the joints of two bent fingers of that hand."""
    angles = {f"{side}_shoulder_flexion": 1.0, f"{side}_forearm_pronation": 0.6}
    motion = np.tile(HUMAN.posture(angles), (FRAMES, 1))
    bent = {f"{side}_knuckle_flexion": KNUCKLE, f"{side}_finger_flexion": MIDDLE}
    closed = np.tile(HUMAN.posture(angles | bent), (FRAMES, 1))
    parts = [f"{side}_{part}" for part in ("hand", "fingers", "fingertips")]
    where = HUMAN.sites(closed, parts)
    wrist = where[parts[0]][0]
    points, names = {"wrist": wrist}, {}
    for finger, aside in (("index", 0.02), ("ring", -0.02)):
        turns = [geometry.rotations(where[part][1]) for part in parts]
        first = where[parts[1]][0] + turns[0].apply([aside, 0.0, 0.0])
        second = first + turns[1].apply([0.0, 0.0, -BONES_M[0]])
        chain = (first, second, second + turns[2].apply([0.0, 0.0, -BONES_M[1]]))
        points |= {f"{finger}_{number}": at for number, at in enumerate(chain)}
    for name in points:
        place = f"{side}_hand" if name == "wrist" else f"{side}_fingers"
        names[name] = BodyName(name, place, exact=False, by="its words")
    return motion, points, names


@pytest.mark.parametrize("side", ["right", "left"])
def test_fingers_are_bent_as_recorded_on_either_side(side: str) -> None:
    motion, points, names = recorded(side)
    points["ring_2"][2] = np.nan
    found = closings(HUMAN, motion, points, names)
    assert set(found) == {side}
    made = with_closings(HUMAN, motion, found)
    for hinge, expected in (("knuckle_flexion", KNUCKLE), ("finger_flexion", MIDDLE)):
        np.testing.assert_allclose(
            made[:, HUMAN.index(f"{side}_{hinge}")], expected, atol=1e-6, err_msg=hinge
        )
    changed = {int(number) for number in np.flatnonzero((made != motion).any(axis=0))}
    assert changed == {HUMAN.index(f"{side}_{n}_flexion") for n in ("knuckle", "finger")}


def test_points_that_do_not_begin_on_the_hand_close_nothing() -> None:
    motion, points, names = recorded("right")
    away = np.linspace(0.0, 0.4, FRAMES)[:, None] * [1.0, 0.0, 0.0]
    far = {name: at + away if name != "wrist" else at for name, at in points.items()}
    assert closings(HUMAN, motion, far, names) == {}


def test_a_thumb_that_begins_where_fingers_do_is_another_finger() -> None:
    motion, points, names = recorded("right")
    renamed = {
        **names,
        **{f"thumb_{n}": BodyName(f"thumb_{n}", "right_thumb", exact=False, by="") for n in (0, 1)},
    }
    points |= {f"thumb_{n}": points[f"index_{n}"] for n in (0, 1)}
    found = closings(HUMAN, motion, points, renamed)
    assert "right_thumb_opposition" not in found["right"].angles
    nearer = {f"thumb_{n}": 0.5 * (points["wrist"] + points[f"index_{n}"]) for n in (0, 1)}
    found = closings(HUMAN, motion, points | nearer, renamed)
    assert "right_thumb_opposition" in found["right"].angles


def test_it_is_said_how_far_hands_are_closed_and_of_which_no_fingers_are_recorded() -> None:
    motion, points, names = recorded("left")
    hands = closings(HUMAN, motion, points, names)
    segments = {"pelvis": "pelvis", "left": "left_hand", "right": "right_hand"}
    made = Fit(
        HUMAN, np.arange(FRAMES), with_closings(HUMAN, motion, hands), {}, {}, {}, 0.0, segments
    )
    bent, straight = closed_hands(made, hands)
    assert "of the left hand by 29 degrees at the knuckles and 52 beyond" in bent
    assert straight.startswith("no fingers are recorded of the right hand")
