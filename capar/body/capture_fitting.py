"""A capture's sensors as places on the body, and the body fitted to them."""

from collections.abc import Mapping

from capar.body.anthropometry import measures_of
from capar.body.fitting import Fit, FitError, fit
from capar.body.human import Human
from capar.body.mounting import calibrate, places
from capar.model.capture import Capture, Stream

OTHER_NAMES = {"pelvis": "l5", "sacrum": "l5", "neck_base": "neck"}
"""What sensors are called besides the names of their places."""


def worn(capture: Capture) -> dict[str, Stream]:
    """The streams of the sensors that the capture's first agent wears, by place on the body."""
    out = {}
    for sensor in capture.sensors:
        if capture.agent_of(sensor) == capture.agent.name:
            sided = (
                sensor.end_effector
                if sensor.side == "none"
                else f"{sensor.side}_{sensor.end_effector}"
            )
            for name in (sensor.name, OTHER_NAMES.get(sensor.name, ""), sided):
                if name in places() and name not in out:
                    out[name] = sensor.stream
                    break
    return out


def fit_capture(capture: Capture, *, angles: Mapping[str, float] | None = None) -> Fit:
    """The body of a capture's performer, fitted to the sensors it wears.

    Args:
        capture: Its first 0.4 s are the reference posture.
        angles: That posture [rad]; standing with straight arms down, palms inwards, where None.

    Raises:
        FitError: No sensor is on a place of the body.
        CalibrationError: Too few sensors are there to place the body.
        MeasuresError: The stated measures are of no body.
    """
    streams = worn(capture)
    if not streams:
        names = ", ".join(each.name for each in capture.sensors)
        raise FitError(f"none of the sensors ({names}) is on a known place: {', '.join(places())}")
    human = Human.of(measures_of(capture.agent))
    return fit(human, streams, calibrate(human, streams, angles=angles))
