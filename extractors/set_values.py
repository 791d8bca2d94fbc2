"""A calibration with single values replaced, as a user asks for one run."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from capar.model.calibration import BodyCalibration, Calibration, Found, PairCalibration
from capar.model.errors import CaparError, UnknownNameError

FORM = "--set takes KEY=VALUE, such as touch_m:right_hand,bowl=0.12"


def set_values(calibration: Calibration, settings: Iterable[str]) -> Calibration:
    """The same with some values replaced.

    Args:
        calibration: What was decided for a recording.
        settings: ``KEY=VALUE`` each, in metres, seconds and radians. Keys are those of ``KEYS``;
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
        calibration = KEYS[name](calibration, of.strip(), _number(setting, text))
    return calibration


def _number(setting: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise CaparError(f"--set {setting}: {text!r} is no number; {FORM}") from None
    if not 0.0 < value < float("inf"):
        raise CaparError(f"--set {setting}: expected a number above zero, found {text}")
    return value


def _tolerance(known: Calibration, of: str, value: float) -> Calibration:
    def wider(pair: PairCalibration) -> PairCalibration:
        if pair.found is not Found.TOLERANCE:
            return pair
        margin = min(pair.release_m - pair.touch_m, value)
        return replace(pair, touch_m=value, release_m=value + margin)

    pairs = tuple(map(wider, known.pairs))
    return replace(known, contact_tolerance_m=value, pairs=pairs)


def _touch(known: Calibration, of: str, value: float) -> Calibration:
    """A distance for a pair, in either order."""
    names = {name.strip() for name in of.split(",")}
    if not any({pair.first, pair.second} == names for pair in known.pairs):
        pairs = [f"{pair.first},{pair.second}" for pair in known.pairs]
        raise UnknownNameError("pair", of, pairs, where="--set touch_m")

    def stated(pair: PairCalibration) -> PairCalibration:
        if {pair.first, pair.second} != names:
            return pair
        pivots = pair.pivots or pair.found is Found.NEVER
        return PairCalibration(
            pair.first, pair.second, value, value, pivots=pivots, found=Found.STATED
        )

    return replace(known, pairs=tuple(map(stated, known.pairs)))


def _floor(field: str) -> "Callable[[Calibration, str, float], Calibration]":
    def changed(known: Calibration, of: str, value: float) -> Calibration:
        bodies = (*known.sensors, *known.objects)
        if of not in [each.name for each in bodies]:
            names = [each.name for each in bodies]
            raise UnknownNameError("body", of, names, where=f"--set {field}")

        def one(each: BodyCalibration) -> BodyCalibration:
            return replace(each, **_field(field, value)) if each.name == of else each

        sensors, objects = tuple(map(one, known.sensors)), tuple(map(one, known.objects))
        return replace(known, sensors=sensors, objects=objects)

    return changed


def _whole(field: str) -> "Callable[[Calibration, str, float], Calibration]":
    return lambda known, of, value: replace(known, **_field(field, value))


def _field(name: str, value: float) -> dict[str, Any]:
    return {name: value}


KEYS: "dict[str, Callable[[Calibration, str, float], Calibration]]" = {
    "touch_m": _touch,
    "contact_tolerance_m": _tolerance,
    "contact_dropout_s": _whole("contact_dropout_s"),
    "contact_minimum_s": _whole("contact_minimum_s"),
    "motion_floor_m": _floor("motion_floor_m"),
    "motion_floor_rad": _floor("motion_floor_rad"),
}
"""What can be set, by key: of the whole, of a ``:BODY``, or of a pair ``:FIRST,SECOND``."""

WHOLE = ("contact_tolerance_m", "contact_dropout_s", "contact_minimum_s")
"""Keys of the whole capture, which name no body."""
