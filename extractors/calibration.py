"""Calibration: everything that is decided once for a whole recording, and how a user sets it."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from capar.model.calibration import (
    BodyCalibration,
    Calibration,
    FootLevel,
    Found,
    Horizons,
    PairCalibration,
)
from capar.model.capture import Capture, Role, Sensor, TagObject, TagType
from capar.model.errors import CaparError, CaptureError, UnknownNameError
from extractors.bodies.bodies import Bodies, BodyGeometry, bodies_of
from extractors.contact.contacts import FOOT, contact_tolerance, moving_grounds, pair_distances
from extractors.motion.object_motion import first_rest, motion_floor
from extractors.motion.phases import upright_axis
from extractors.relations.support import foot_level
from extractors.signals.filters import cutoff, filter_support_s, speed
from extractors.signals.intervals import frame_rate, time_step
from extractors.thresholds import Thresholds

STEP_SHARE = 1e-3
"""How much the step of a capture's clock may differ from its calibration's [1]."""


def calibrate(capture: Capture, thresholds: Thresholds | None = None) -> Calibration:
    """Decide what holds for a whole recording."""
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
        horizons=Horizons(
            filter_s=filter_support_s(step_s, thresholds),
            gap_s=thresholds.gap_s,
            extremum_s=thresholds.extremum_horizon_s,
            interval_s=max(
                thresholds.dropout_s,
                thresholds.contact_minimum_s,
                thresholds.rest_minimum_s,
                thresholds.fall_minimum_s,
            ),
        ),
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
    # Where it first rests; fixed bodies are not asked for theirs.
    first = None
    if not isinstance(each, TagObject) or each.tag is TagType.MOBILE:
        rate_hz = frame_rate(poses.smooth.times)
        at = motion_floor(poses.noise, rate_hz, own_m=own_m, thresholds=thresholds)
        first = first_rest(poses, at, thresholds)
    x, y, z = map(float, upright_axis(poses, first))
    speeds = speed(poses.smooth.positions, capture.times)
    if isinstance(each, Sensor) and each.role is not Role.ACTS:
        poses.forget()  # Filtered poses of what handles nothing take as much memory as its own.
    return BodyCalibration(
        name=each.name,
        noise_m=poses.noise.position_m,
        noise_rad=poses.noise.orientation_rad,
        motion_floor_m=floor.position_m,
        motion_floor_rad=floor.rotation_rad,
        highest_speed_mps=float(np.max(speeds, where=~np.isnan(speeds), initial=0.0)),
        upright=(x, y, z),
        still=poses.still,
        fixed=poses.fixed,
    )


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


WHOLE = ("contact_tolerance_m", "contact_dropout_s", "contact_minimum_s")
"""Keys of the whole capture, which name no body."""

KEYS = ("touch_m", *WHOLE, "motion_floor_m", "motion_floor_rad")
"""What can be set: of the whole, of a ``:BODY``, or of a pair ``:FIRST,SECOND``."""

FORM = "--set takes KEY=VALUE, such as touch_m:right_hand,bowl=0.12"


def set_values(calibration: Calibration, settings: Iterable[str]) -> Calibration:
    """The same with some values replaced.

    ``settings``: ``KEY=VALUE`` each, in metres, seconds and radians. Keys are those of ``KEYS``;
    ``touch_m:FIRST,SECOND`` is a distance of surfaces where both have one, else of origins.

    Raises:
        CaparError: It is not of that form, or the value is no number above zero.
        UnknownNameError: There is no such key, body or pair.
    """
    for setting in settings:
        key, given, text = setting.partition("=")
        name, _, of = key.strip().partition(":")
        if not given:
            raise CaparError(f"{setting!r} has no value; {FORM}")
        if name not in KEYS:
            raise UnknownNameError("calibration value", name, KEYS, where=f"--set {setting}")
        if of and name in WHOLE:
            raise CaparError(f"--set {setting}: {name} is of the whole capture, not of {of!r}")
        try:
            value = float(text)
        except ValueError:
            raise CaparError(f"--set {setting}: {text!r} is no number; {FORM}") from None
        if not 0.0 < value < float("inf"):
            raise CaparError(f"--set {setting}: expected a number above zero, found {text}")
        calibration = _changed(calibration, name, of.strip(), value)
    return calibration


def _changed(known: Calibration, key: str, of: str, value: float) -> Calibration:
    """The same with one value replaced; a distance for a pair in either order."""
    change: dict[str, Any] = {key: value}
    if key == "touch_m":
        names = {name.strip() for name in of.split(",")}
        if not any({pair.first, pair.second} == names for pair in known.pairs):
            every = [f"{pair.first},{pair.second}" for pair in known.pairs]
            raise UnknownNameError("pair", of, every, where="--set touch_m")
        pairs = [
            PairCalibration(
                pair.first,
                pair.second,
                value,
                value,
                pivots=pair.pivots or pair.found is Found.NEVER,
                found=Found.STATED,
            )
            if {pair.first, pair.second} == names
            else pair
            for pair in known.pairs
        ]
        return replace(known, pairs=tuple(pairs))
    if key not in WHOLE:
        bodies = [each.name for each in (*known.sensors, *known.objects)]
        if of not in bodies:
            raise UnknownNameError("body", of, bodies, where=f"--set {key}")
        sensors, objects = (
            tuple(replace(each, **change) if each.name == of else each for each in group)
            for group in (known.sensors, known.objects)
        )
        return replace(known, sensors=sensors, objects=objects)
    if key == "contact_tolerance_m":
        change["pairs"] = tuple(
            replace(
                pair, touch_m=value, release_m=value + min(pair.release_m - pair.touch_m, value)
            )
            if pair.found is Found.TOLERANCE
            else pair
            for pair in known.pairs
        )
    return replace(known, **change)
