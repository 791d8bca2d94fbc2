"""Eyes meet what they look at, and share the turn with head and trunk."""

import numpy as np
import pytest

from capar.body.anthropometry import ready_made
from capar.body.gaze import look_at, measured_gaze
from capar.body.human import Human


def _point(human: Human, azimuth: float, elevation: float, far_m: float) -> np.ndarray:
    """A point seen from between the standing body's eyes [degrees, m]."""
    eyes = human.sites(human.posture()[None], ["between_eyes"])["between_eyes"][0][0]
    a, e = np.radians([azimuth, elevation])
    return eyes + far_m * np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])


@pytest.mark.parametrize("who", ["man", "woman", "child"])
@pytest.mark.parametrize("azimuth", [-80.0, -45.0, 0.0, 20.0, 60.0, 90.0])
@pytest.mark.parametrize("elevation", [-50.0, 0.0, 30.0])
def test_both_lines_of_sight_meet_the_point_to_half_a_degree(
    who: str, azimuth: float, elevation: float
) -> None:
    human = Human.of(ready_made(who))
    gaze = look_at(human, human.posture(), _point(human, azimuth, elevation, 0.8))
    assert gaze.missed_rad.max() < np.radians(0.5)
    assert not human.outside(gaze.posture[None], margin=1e-4).any()


def test_eyes_and_head_share_the_turn_as_people_do() -> None:
    human = Human.of(ready_made("man"))
    gazes = [
        look_at(human, human.posture(), _point(human, turn, 0.0, 2.0))
        for turn in (15.0, 30.0, 60.0, 90.0)
    ]
    eyes = np.degrees([each.eyes_rad for each in gazes])
    heads = np.degrees([each.head_rad for each in gazes])
    assert (np.diff(eyes) > 0.0).all()
    assert (np.diff(heads) > 0.0).all()
    assert eyes.max() < 35.0, "eyes stay well within their range, as people keep them"
    assert (heads / (heads + eyes) > 0.5).all(), "the head does most of a turn"
    spine = [joint for joint in human.joints if joint.startswith(("lumbar", "thorax"))]
    turns = [joint for joint in spine if joint.endswith("turn")]
    trunk = [np.degrees(sum(each.posture[human.index(j)] for j in turns)) for each in gazes]
    assert max(np.abs(trunk)) < 10.0, "the trunk hardly takes part"


def test_what_a_posture_misses_is_measured() -> None:
    human = Human.of(ready_made("man"))
    seen = measured_gaze(human, human.posture(), _point(human, 30.0, 0.0, 100.0))
    np.testing.assert_allclose(seen.missed_rad, np.radians(30.0), atol=1e-3)
    assert seen.eyes_rad == pytest.approx(0.0, abs=1e-6)
