"""Calibration: everything that is decided once for a whole recording.

With the calibration of a recording, any part of it is measured as the whole is: facts of a window
that lie farther from its ends than ``Horizons.margin_s`` are those of the whole. This holds for
zero crossings and pauses, contacts and their gaps, normals and closing speeds, looks, leaning,
falls, rolling, and how bodies are arranged. It does not hold for these:

* ``Moving``, ``Displaced``, ``Resting`` and ``Bears``: a place of rest that is left is the median
  pose of a whole standstill, and holds for as long as the body is within the floor of it; the place
  that a body comes to is that of its beginning (``rest_begins_s``). A window that is
  given the poses from longer ago (``Poses.longer``) tells it by them, as live observation does;
  a rest that goes on after a window has no end yet.
* ``Reverses``, ``DrawsBack``, ``Swings`` and ``Lengthwise``: all are sought within a motion from
  its beginning, so they need what ``Moving`` needs.
* ``Guided``, ``Opening`` and what turns back on a guide: a hinge or rail is fitted to every motion
  of the recording. It would take the guide as part of the calibration.
* ``Place``, ``TrunkPlace``, ``Posture``, ``Distance``, ``Travelled`` and ``SweptAzimuth``: their
  frames are those of the facts above; and ways and angles are summed up from the first frame:
  they agree where a window is given the sums before it (``extractors.relations.running_sums``).
  A window has every ``SweptAzimuth``, the whole only those of pairs that go about each other.
* Which mobile objects are measured at all: those that an end-effector touches in the window.
* ``Lies`` of a shifted grip: it compares all pauses of one contact, however long.
* Contacts across a loss or a stay within the release distance that is longer than the margin: the
  contact before and after is taken to last.
* Clocks with uneven steps, which are filtered on an even clock that begins with each stretch.
"""

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from capar.model.calibration import (
    BodyCalibration,
    Calibration,
    FootLevel,
    Horizons,
)
from capar.model.capture import Capture, Sensor, TagObject, TagType
from capar.model.errors import CaptureError
from extractors.bodies.bodies import Bodies, bodies_of
from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.contacts import contact_tolerance, pair_distances
from extractors.contact.footing import FOOT, moving_grounds
from extractors.motion.leaning import upright_axis
from extractors.motion.object_motion import motion_floor, rest_poses
from extractors.relations.weight_bearing import foot_level
from extractors.signals.clock import frame_rate, time_step
from extractors.signals.filters import cutoff, filter_support_s, speed
from extractors.thresholds import Thresholds

STEP_SHARE = 1e-3
"""How much the step of a capture's clock may differ from its calibration's [1]."""


def calibrate(capture: Capture, thresholds: Thresholds | None = None) -> Calibration:
    """Decide what holds for a whole recording.

    Args:
        capture: The recording, or its beginning.
        thresholds: What extraction decides by; None for the usual.
    """
    return calibrated(capture, thresholds or Thresholds())[0]


def calibrated(capture: Capture, thresholds: Thresholds) -> tuple[Calibration, Bodies]:
    """The same, and the bodies by which it was decided, which measuring needs too."""
    bodies = bodies_of(capture, thresholds)
    step_s = time_step(capture.times)
    tolerance_m = contact_tolerance(capture, bodies, thresholds)
    dropout, minimum = capture.contact_dropout_s, capture.contact_minimum_s
    pairs = tuple(pair_distances(capture, bodies, tolerance_m, thresholds))
    touch_m = {(pair.first, pair.second): pair.touch_m for pair in pairs}
    known = Calibration(
        step_s=step_s,
        cutoff_hz=cutoff(1.0 / step_s, thresholds),
        contact_tolerance_m=tolerance_m,
        contact_dropout_s=thresholds.dropout_s if dropout is None else dropout,
        contact_minimum_s=thresholds.contact_minimum_s if minimum is None else minimum,
        sensors=tuple(_body(capture, each, bodies.sensors, thresholds) for each in capture.sensors),
        objects=tuple(_body(capture, each, bodies.objects, thresholds) for each in capture.objects),
        pairs=pairs,
        foot_levels=tuple(_foot_levels(capture, bodies, thresholds)),
        horizons=_horizons(step_s, thresholds),
        thresholds=asdict(thresholds),
        moving_grounds=tuple(moving_grounds(capture, bodies, touch_m, thresholds)),
    )
    return known, bodies


def thresholds_of(calibration: Calibration) -> Thresholds:
    """The thresholds that a calibration was made with, and that it is measured with."""
    values: dict[str, Any] = dict(calibration.thresholds)
    return Thresholds(**values)


def check_clock(capture: Capture, calibration: Calibration) -> None:
    """Check that a calibration fits a capture's clock.

    Raises:
        CaptureError: It was made for another rate.
    """
    step_s = time_step(capture.times)
    if abs(step_s - calibration.step_s) > STEP_SHARE * calibration.step_s:
        raise CaptureError(
            f"capture {capture.name!r} has {1.0 / step_s:.6g} frames a second, and its calibration "
            f"is for {1.0 / calibration.step_s:.6g}; calibrate with a recording of the same rate"
        )


def _body(
    capture: Capture,
    each: Sensor | TagObject,
    bodies: Mapping[str, BodyGeometry],
    thresholds: Thresholds,
) -> BodyCalibration:
    poses = bodies[each.name].poses
    own = capture.bodies[each.name]
    own_m = own.motion_floor_m if isinstance(own, TagObject) else None
    floor = motion_floor(
        poses.noise,
        frame_rate(capture.times),
        own_m=own_m if isinstance(each, TagObject) else None,
        thresholds=thresholds,
    )
    speeds = speed(poses.smooth.positions, capture.times)
    return BodyCalibration(
        name=each.name,
        noise_m=poses.noise.position_m,
        noise_rad=poses.noise.orientation_rad,
        motion_floor_m=floor.position_m,
        motion_floor_rad=floor.rotation_rad,
        highest_speed_mps=float(np.max(speeds, where=~np.isnan(speeds), initial=0.0)),
        upright=_upright(each, bodies[each.name], own_m, thresholds),
        still=poses.still,
        fixed=poses.fixed,
    )


def _upright(
    each: Sensor | TagObject, body: BodyGeometry, own_m: float | None, thresholds: Thresholds
) -> tuple[float, float, float]:
    """The axis that points up where a body first rests; fixed bodies are not asked for theirs."""
    first = None
    if not (isinstance(each, TagObject) and each.tag is not TagType.MOBILE):
        rate_hz = frame_rate(body.poses.smooth.times)
        floor = motion_floor(body.poses.noise, rate_hz, own_m=own_m, thresholds=thresholds)
        first = next(iter(rest_poses(body.poses, floor, thresholds)), None)
    x, y, z = map(float, upright_axis(body.poses, first))
    return x, y, z


def _foot_levels(capture: Capture, bodies: Bodies, thresholds: Thresholds) -> Iterator[FootLevel]:
    for agent in capture.agents:
        feet = [
            bodies.sensors[each.name]
            for each in capture.sensors
            if capture.agent_of(each) == agent.name
            and each.end_effector == FOOT
            and not each.part_of
        ]
        height_m = foot_level(feet, thresholds)
        if height_m is not None:
            yield FootLevel(agent.name, height_m)


def _horizons(step_s: float, thresholds: Thresholds) -> Horizons:
    return Horizons(
        filter_s=filter_support_s(step_s, thresholds),
        gap_s=thresholds.gap_s,
        extremum_s=thresholds.extremum_horizon_s,
        interval_s=max(
            thresholds.dropout_s,
            thresholds.contact_minimum_s,
            thresholds.rest_minimum_s,
            thresholds.fall_minimum_s,
        ),
    )
