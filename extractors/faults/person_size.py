"""Sizes that no person and no thing in a hand has: the sign of a wrong unit of length."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from capar.model.capture import UNITS, Capture, Conventions, Sensor, TagType
from capar.model.notices import Notice, notice
from extractors.thresholds import Thresholds

TRUNK = ("head", "neck", "chest", "torso", "spine", "pelvis")
"""End-effectors of the trunk, in which a person's size shows with a hand or a foot."""

LIMBS = ("hand", "foot")


@dataclass(frozen=True, slots=True)
class Reach:
    """How far two sensors of one person come apart."""

    first: str
    second: str
    largest_m: float
    at_s: float
    least_m: float
    """A person of any size has more; zero where nothing is known."""


def reaches(capture: Capture, thresholds: Thresholds) -> list[Reach]:
    """The largest distance of each two sensors of a person through a recording, by name."""
    found = []
    for first, second in combinations(capture.sensors, 2):
        if capture.agent_of(first) != capture.agent_of(second):
            continue
        apart = np.linalg.norm(first.stream.positions - second.stream.positions, axis=1)
        if np.isnan(apart).all():
            continue
        frame = int(np.nanargmax(apart))
        least = _least(first, second, thresholds)
        at_s = float(capture.times[frame])
        found.append(Reach(first.name, second.name, float(apart[frame]), at_s, least))
    return found


def _least(first: Sensor, second: Sensor, thresholds: Thresholds) -> float:
    kinds = {first.end_effector, second.end_effector}
    if not (kinds & set(TRUNK) and kinds & set(LIMBS)):
        return 0.0
    standing = "head" in kinds and "foot" in kinds
    return thresholds.head_to_foot_m if standing else thresholds.trunk_to_limb_m


def is_sized(capture: Capture, thresholds: Thresholds) -> bool:
    """Whether sensors on trunk and limbs show that people have the size of people."""
    found = [each for each in reaches(capture, thresholds) if each.least_m]
    most = thresholds.person_most_m
    return bool(found) and all(each.least_m <= each.largest_m <= most for each in found)


def size_notices(capture: Capture, thresholds: Thresholds) -> Iterator[Notice]:
    """A notice if people are too small or too large, or each sensor alone is too fast."""
    found = reaches(capture, thresholds)
    wrong = [
        each
        for each in found
        if each.largest_m > thresholds.person_most_m or each.largest_m < each.least_m
    ]
    if wrong:
        worst = max(wrong, key=lambda each: each.largest_m)
        yield notice(
            "unit-contradicted", worst.first, worst.second, start_s=worst.at_s, end_s=worst.at_s,
            shown="person", size_m=float(f"{worst.largest_m:.3g}"),
            **_remedy(capture, worst, thresholds),
        )  # fmt: skip
    yield from _fast_notices(capture, found, thresholds)


def _remedy(capture: Capture, reach: Reach, thresholds: Thresholds) -> dict[str, str]:
    how = capture.conventions.get(reach.first, Conventions())
    usual = thresholds.head_to_foot_usual_m
    if reach.least_m != thresholds.head_to_foot_m:
        usual = thresholds.trunk_to_limb_usual_m
    return {"unit": likely_unit(reach.largest_m / how.unit_m, usual), "declared": unit_name(how)}


def unit_name(how: Conventions) -> str:
    """The name of the unit that a file was read in."""
    return how.unit(1.0, 1e-6) or f"{how.unit_m:g} m"


def likely_unit(length: float, usual_m: float) -> str:
    """The unit in which a length is nearest to a usual one; m, cm and mm before others.

    Args:
        length: In the unknown unit.
        usual_m: What it usually is [m].
    """
    off = {name: abs(np.log(length * metres / usual_m)) for name, metres in UNITS.items()}
    common = min(("m", "cm", "mm"), key=off.__getitem__)
    return common if off[common] < np.log(NEAR) else min(off, key=off.__getitem__)


NEAR = 2.5
"""A length is one of a person's if it is nearer to the usual one than by this factor [1]."""


def _fast_notices(capture: Capture, found: list[Reach], thresholds: Thresholds) -> Iterator[Notice]:
    """A sensor alone that is faster than any hand for a good part of the time."""
    if found:
        return
    for sensor in capture.sensors:
        steps = np.linalg.norm(np.diff(sensor.stream.positions, axis=0), axis=1)
        speeds = steps / np.diff(capture.times)
        if np.isnan(speeds).all():
            continue
        usual = float(np.nanquantile(speeds, thresholds.speed_quantile))
        if usual > thresholds.hand_most_mps:
            how = capture.conventions.get(sensor.name, Conventions())
            unit = likely_unit(usual / how.unit_m, thresholds.hand_usual_mps)
            yield notice(
                "unit-contradicted", sensor.name, shown="speed", unit=unit,
                declared=unit_name(how), speed_mps=float(f"{usual:.3g}"),
            )  # fmt: skip


def shape_notices(capture: Capture, thresholds: Thresholds) -> Iterator[Notice]:
    """Mobile objects whose shapes nobody could handle or see."""
    for thing in capture.objects:
        if thing.tag is not TagType.MOBILE or thing.shape is None:
            continue
        size = float(thing.shape.size.max())
        if not thresholds.thing_least_m <= size <= thresholds.thing_most_m:
            yield notice(
                "shape-size", thing.name, size_m=float(f"{size:.3g}"),
                unit=likely_unit(size, thresholds.thing_usual_m),
                shape=thing.shape.description,
            )  # fmt: skip
