"""A calibration as tables for people."""

from math import hypot
from typing import TYPE_CHECKING

from capar.model.calibration import BodyCalibration, Calibration, Found, PairCalibration

if TYPE_CHECKING:
    from rich.table import Table

BODY_COLUMNS = ("body", "noise mm", "noise deg", "floor mm", "floor deg", "highest m/s", "held")
PAIR_COLUMNS = ("pair", "touch mm", "release mm", "of", "found by", "frames", "contradicts")
_DEGREES = 57.29577951308232


def calibration_tables(calibration: Calibration) -> tuple["Table", ...]:
    """What was decided for the whole, for each body and for each pair."""
    from rich.table import Table

    whole = Table("calibration", "")
    for name, value in whole_rows(calibration):
        whole.add_row(name, value)
    bodies = Table(*BODY_COLUMNS)
    for body in (*calibration.sensors, *calibration.objects):
        bodies.add_row(*_body_row(body))
    pairs = Table(*PAIR_COLUMNS)
    for pair in calibration.pairs:
        pairs.add_row(*_pair_row(pair))
    return whole, bodies, pairs


def whole_rows(calibration: Calibration) -> tuple[tuple[str, str], ...]:
    """Names and values of what holds for the whole recording."""
    horizons = calibration.horizons
    return (
        ("step of the clock", f"{1e3 * calibration.step_s:.3f} ms"),
        ("cutoff of the low-pass", f"{calibration.cutoff_hz:.2f} Hz"),
        ("contact up to", f"{_mm(calibration.contact_tolerance_m)} mm"),
        ("interruption closed below", f"{calibration.contact_dropout_s:.3f} s"),
        ("contact dropped below", f"{calibration.contact_minimum_s:.3f} s"),
        *(
            (f"feet of {level.agent} stand at", f"{level.height_m:.3f} m")
            for level in calibration.foot_levels
        ),
        *(
            (f"{each.ground} under {each.agent} moves at", f"{hypot(*each.velocity_mps):.2f} m/s")
            for each in calibration.moving_grounds
        ),
        ("half length of the low-pass", f"{horizons.filter_s:.3f} s"),
        ("extrema of speed compared within", f"{horizons.extremum_s:.3f} s"),
        ("margin of a window", f"{horizons.margin_s:.3f} s"),
    )


def _pair_row(pair: PairCalibration) -> tuple[str, ...]:
    """How two bodies touch, how that was found, and what the recording shows against it."""
    names = f"{pair.first} {pair.second}"
    if pair.found is Found.NEVER:
        return names, "-", "-", "-", pair.found.value, "", ""
    estimated = pair.found not in (Found.STATED, Found.TOLERANCE)
    kind = ("points" if estimated else "origins") if pair.pivots else "surfaces"
    shown = "" if pair.shown_m is None else f"{_mm(pair.shown_m)} mm"
    frames = str(pair.frames) if pair.frames else ""
    return names, _mm(pair.touch_m), _mm(pair.release_m), kind, pair.found.value, frames, shown


def _body_row(body: BodyCalibration) -> tuple[str, ...]:
    held = "at its median" if body.fixed else ("recorded still" if body.still else "")
    return (
        body.name,
        _mm(body.noise_m),
        f"{_DEGREES * body.noise_rad:.3f}",
        _mm(body.motion_floor_m),
        f"{_DEGREES * body.motion_floor_rad:.2f}",
        f"{body.highest_speed_mps:.2f}",
        held,
    )


def _mm(length_m: float) -> str:
    return f"{1e3 * length_m:.2f}"
