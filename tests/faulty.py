"""Sound captures made faulty: turned, scaled, mirrored, on another clock."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Capture, Conventions, Sensor, Stream, TagObject
from capar.model.notices import KINDS, Notice
from extractors.measure import measure

Change = Callable[[Stream], Stream]


def changed(capture: Capture, change: Change, how: Conventions | None = None) -> Capture:
    """The capture with every stream changed, as if its file had been read by those conventions."""

    def body(each: Sensor | TagObject) -> Sensor | TagObject:
        return replace(each, stream=change(each.stream))

    return replace(
        capture,
        sensors=tuple(body(each) for each in capture.sensors),
        objects=tuple(body(each) for each in capture.objects),
        conventions=dict.fromkeys(capture.bodies, how or Conventions()),
    )


def turned(rotation: Rotation) -> Change:
    """A change of the world's axes."""
    return lambda stream: Stream(
        stream.times,
        rotation.apply(np.array(stream.positions)),
        geometry.quaternions(rotation * geometry.rotations(np.array(stream.orientations))),
    )


def scaled(factor: float) -> Change:
    """A change of the unit of length."""
    return lambda stream: Stream(stream.times, stream.positions * factor, stream.orientations)


def slowed(factor: float) -> Change:
    """A change of the rate: every step of time is so many times as long."""
    return lambda stream: Stream(stream.times * factor, stream.positions, stream.orientations)


def mirrored(stream: Stream) -> Stream:
    """The mirror image in y, as a left-handed file that is read as a right-handed one has it."""
    return Stream(
        stream.times,
        stream.positions * np.array([1.0, -1.0, 1.0]),
        stream.orientations * np.array([1.0, -1.0, 1.0, -1.0]),
    )


def found(capture: Capture) -> list[Notice]:
    """The notices of faults that measuring finds; how well contact distances fit is no matter."""
    every = [each for each in measure(capture).notices if KINDS[each.code].fault]
    return [each for each in every if each.code not in ("mount-gap", "distance-contradicted")]
