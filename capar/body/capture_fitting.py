"""A capture's sensors as places on the body, and the body fitted to them."""

import time
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from capar.body.anthropometry import measures_of
from capar.body.fitting import Fit, FitError, fit
from capar.body.human import Human
from capar.body.mounting import Calibration, calibrate, places
from capar.body.refinement import NOISE_M, RefinementError, refine
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

    Where some sensor stays farther from its place than noise explains, limb lengths and the places
    of the sensors are estimated from the motion, and the better of both fits is kept.

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
    return fit_refined(human, streams, calibrate(human, streams, angles=angles))


def fit_refined(human: Human, streams: Mapping[str, Stream], calibration: Calibration) -> Fit:
    """Fit the body to its sensors; once more, with refined measures, if residuals ask for it.

    They ask for it where some sensor's distance from its place exceeds ``NOISE_M``, the noise that
    a filtered sensor has. The second fit is kept if its worst sensor fits better.

    Args:
        human: The body.
        streams: By place, as recorded, on one clock.
        calibration: Where they sit on it.

    Raises:
        FitError: No sensor is calibrated, or the clocks differ.
    """
    began = time.perf_counter()
    made = fit(human, streams, calibration)
    if worst_m(made) <= NOISE_M:
        return made
    try:
        better = refine(made, streams, calibration)
    except RefinementError:
        return made
    again = fit(Human.of(better.measures), streams, better.calibration)
    kept = again if worst_m(again) < worst_m(made) else made
    return replace(kept, seconds=time.perf_counter() - began)


def worst_m(made: Fit) -> float:
    """Root mean square of the distance of that sensor from its place which fits worst [m]."""
    squares = (np.nanmean(np.square(metres)) for metres in made.residuals_m.values())
    return float(np.sqrt(max(squares)))
