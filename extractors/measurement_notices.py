"""Notices of what was measured with reservations: tolerances, stand-ins, supports, losses."""

import math
from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from capar.model.calibration import Calibration, Found
from capar.model.capture import Capture, Sensor, ShapeSource, TagObject, TagType
from capar.model.notices import Notice, Value, notice
from extractors.signals.gaps import long_gaps
from extractors.thresholds import Thresholds

LOSS = "long-gap"
"""The notice of a body that was lost for long: one a body, in place of the reader's one a gap."""


def notices_of(
    capture: Capture, calibration: Calibration, thresholds: Thresholds
) -> Iterator[Notice]:
    """What a reader of facts should know: how bodies touch, what is assumed, and what was lost.

    Args:
        capture: The trial.
        calibration: What was decided for the whole recording.
        thresholds: How long a gap is that counts.
    """
    stated = capture.contact_tolerance_m is not None
    yield notice("contact-tolerance", tolerance_m=calibration.contact_tolerance_m, stated=stated)
    yield from _distance_notices(calibration)
    found = [pair for pair in calibration.pairs if pair.found is not Found.NEVER]
    known = {name for pair in found for name in (pair.first, pair.second)}
    touching: tuple[Sensor | TagObject, ...] = (*capture.acting, *capture.objects)
    for body in touching:
        if body.shape is None and body.name not in known:
            yield notice("no-shape", body.name)
        elif body.shape is not None and body.shape.source is ShapeSource.STAND_IN:
            yield notice("stand-in-shape", body.name, shape=body.shape.description)
    yield from _pose_notices(capture, thresholds)
    for belt in calibration.moving_grounds:
        pace = math.hypot(*belt.velocity_mps)
        yield notice("moving-ground", belt.ground, agent=belt.agent, speed_mps=pace)


def _distance_notices(calibration: Calibration) -> Iterator[Notice]:
    """How bodies without surfaces touch, and where the recording contradicts what is taken."""
    for pair in calibration.pairs:
        names, taken = (pair.first, pair.second), pair.touch_m
        if pair.found is Found.STATED:
            yield notice("pivot-distance", *names, distance_m=taken)
        elif pair.found not in (Found.TOLERANCE, Found.NEVER):
            how = pair.found.value
            yield notice("touch-estimated", *names, touch_m=taken, found=how, frames=pair.frames)
        if pair.shown_m is not None:
            code = "mount-gap" if pair.found is Found.TOLERANCE else "distance-contradicted"
            values = {"touch_m": taken, "shown_m": pair.shown_m, "frames": pair.frames}
            yield notice(code, *names, **values)


def _pose_notices(capture: Capture, thresholds: Thresholds) -> Iterator[Notice]:
    everything: tuple[Sensor | TagObject, ...] = (*capture.sensors, *capture.objects)
    for body in everything:
        if isinstance(body, TagObject) and body.assumed:
            yield notice("assumed-support", body.name, assumed=body.assumed)
        lost = [
            (first, last)
            for first, last in long_gaps(body.stream, gap_s=thresholds.gap_s)
            if last - first + 1 >= thresholds.gap_s * capture.rate_hz
        ]
        if lost:
            fixed = isinstance(body, TagObject) and body.tag is TagType.FIXED
            yield _loss(body, lost, capture.times, fixed=fixed)


def _loss(
    body: Sensor | TagObject,
    lost: list[tuple[int, int]],
    times: Float[np.ndarray, "frames"],
    *,
    fixed: bool,
) -> Notice:
    """How often a body was lost for long, and when at most; without times if it was throughout.

    With times, also for how long in all [s], of how much [s]; and how far it was then [m] from
    where it was before, where that is known.
    """
    first, last = max(lost, key=lambda gap: gap[1] - gap[0])
    if last - first + 1 == len(times):
        return notice(LOSS, body.name, times=len(lost), fixed=fixed)
    values: dict[str, Value] = {
        "times": len(lost),
        "fixed": fixed,
        "lost_s": float(sum(times[until] - times[since] for since, until in lost)),
        "of_s": float(times[-1] - times[0]),
    }
    if first > 0 and last < len(times) - 1:
        places = body.stream.positions[[first - 1, last + 1]]
        values["moved_m"] = float(np.linalg.norm(places[1] - places[0]))
    start_s, end_s = float(times[first]), float(times[last])
    return notice(LOSS, body.name, start_s=start_s, end_s=end_s, **values)
