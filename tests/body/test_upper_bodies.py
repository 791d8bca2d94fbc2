"""A body of which only the upper part is tracked stands, whatever it bends to."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.sensor_fitting import fit
from capar.body.sensors import PERFECT, calibrate, sense, strap_on

RATE_HZ = 60.0
SIDES = ("right", "left")
TILTED = float(np.radians(12.0))


@pytest.mark.parametrize("who", ["man", "child"])
def test_who_bends_over_a_table_is_not_tilted_like_a_board(who: str) -> None:
    human = Human.of(ready_made(who))
    times = np.arange(0.0, 2.0, 1.0 / RATE_HZ)
    share = np.clip((times - 0.6) / 1.0, 0.0, 1.0) ** 2
    motion = np.tile(human.posture(), (len(times), 1))
    for joint in human.joints:
        if joint.startswith(("lumbar", "thorax")) and joint.endswith("flexion"):
            motion[:, human.index(joint)] = share * 0.6 * human.ranges[human.joints.index(joint), 1]
    for side in SIDES:
        motion[:, human.index(f"{side}_elbow_flexion")] = share * 1.2
    rng = np.random.default_rng(3)
    mounts = strap_on(human, ("right_hand", "left_hand", "head"), PERFECT, rng)
    streams = sense(human, times, motion, mounts, PERFECT, rng)
    made = fit(human, streams, calibrate(human, streams))
    places = made.human.sites(made.motion, ["pelvis", "right_sole", "left_sole"])
    up = Rotation.from_quat(places["pelvis"][1], scalar_first=True).apply([0.0, 0.0, 1.0])
    assert np.arccos(np.clip(up[:, 2], -1.0, 1.0)).max() < TILTED
    for side in SIDES:
        assert np.abs(places[f"{side}_sole"][0][:, 2]).max() < 0.03
    for metres in made.residuals_m.values():
        assert np.median(metres) < 0.005
