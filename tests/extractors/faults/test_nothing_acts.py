"""A recording in which nobody acts says so, instead of an empty table without a word."""

from dataclasses import replace

import motions

from capar.model.capture import Capture, Role
from extractors.calibration import calibrate
from extractors.measure import measure

TOLD = 'state role = "acts"'


def notices(capture: Capture) -> list[str]:
    found = measure(capture, calibrate(capture)).notices
    return [notice.message for notice in found if notice.code == "nothing-acts"]


def test_a_recording_without_an_acting_sensor_is_told_with_the_remedy() -> None:
    whole = motions.drink_from_mug(motions.TALL_MAN).capture
    idle = tuple(replace(sensor, role=Role.ATTENDS) for sensor in whole.sensors)
    (message,) = notices(replace(whole, sensors=idle))
    assert TOLD in message
    assert notices(whole) == []
