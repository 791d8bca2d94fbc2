"""What virtual performers look at is told right wherever they are recorded, by their eyes."""

import numpy as np
import pytest
from virtual_bodies.looking import fixations, share_told

from capar.body.recording import record
from capar.body.scripted_actions import action_capture, performed
from capar.body.sensors import PERFECT

pytestmark = pytest.mark.long

PERFORMED = (("touch", "child"), ("carry", "woman"), ("pour", "man"))
"""Each action by another body; how it looks depends on the two apart."""


@pytest.mark.parametrize(("action", "who"), PERFORMED)
def test_what_is_looked_at_is_told_while_the_gaze_stays_on_it(action: str, who: str) -> None:
    found = fixations(performed(action, who), action_capture(action, who))
    things = [fixation for fixation in found if fixation.thing]
    assert things
    assert all(fixation.told == 1.0 for fixation in things)
    assert share_told(found, of_things=False) > 0.9
    assert max(fixation.missed_rad for fixation in found) < np.radians(0.5)


def test_a_face_alone_passes_above_a_mug_that_the_eyes_look_at() -> None:
    made = performed("sip")
    capture = record(made, name="sip", seed=3, tracker=PERFECT, eye_tracker=False)
    face = fixations(made, capture)
    eyes = fixations(made, action_capture("sip"))
    assert [fixation.thing for fixation in face] == [fixation.thing for fixation in eyes]
    assert share_told(face, of_things=True) < 0.5 < share_told(eyes, of_things=True)
    assert [sensor.name for sensor in capture.sensors] == ["right_hand", "left_hand", "head"]
