"""What gravity contradicts: the declared upward axis, the unit of length, the rate."""

from collections.abc import Iterator
from enum import Enum, auto

import numpy as np

from capar.model.capture import Capture, Conventions
from capar.model.notices import Notice, notice
from extractors.bodies.bodies import Bodies
from extractors.faults.free_flight import Flight, flights
from extractors.faults.person_size import unit_name
from extractors.motion.impacts import GRAVITY_MPS2
from extractors.thresholds import Thresholds

DOWN = np.array([0.0, 0.0, -1.0])


class Verdict(Enum):
    """How the acceleration of a flight compares with gravity."""

    SOUND = auto()
    ASIDE = auto()
    """As large, along another direction."""

    SCALED = auto()
    """Down, of another size."""

    BOTH = auto()
    """Along another direction and of another size."""


def gravity_notices(
    capture: Capture, bodies: Bodies, thresholds: Thresholds, *, sized: bool
) -> Iterator[Notice]:
    """Notices of falls that cannot be, with what would make them falls.

    Straight descents may be other than free: it takes two of them that are as fast as falls, and
    what is slower or faster than a fall has to be curved. Where as many flights are sound as are
    not, nothing is said.

    Args:
        capture: The trial.
        bodies: Its bodies.
        thresholds: What separates gravity from other accelerations.
        sized: Whether the size of people shows that the unit is right; then the rate is wrong.
    """
    found = [
        flight
        for thing in bodies.objects.values()
        for flight in flights(thing, bodies.sensors.values(), thresholds)
    ]
    groups: dict[Verdict, list[Flight]] = {each: [] for each in Verdict}
    for flight in found:
        groups[_verdict(flight, thresholds)].append(flight)
    sound = len(groups.pop(Verdict.SOUND))
    for verdict, group in groups.items():
        curved = [flight for flight in group if flight.curved]
        sure = group if verdict is Verdict.ASIDE and len(group) > 1 else curved
        if sure and len(group) > sound:
            longest = max(sure, key=lambda flight: flight.last - flight.first)
            how = capture.conventions.get(longest.body, Conventions())
            yield from _notices(capture, longest, verdict, how, thresholds, sized=sized)


def _verdict(flight: Flight, thresholds: Thresholds) -> Verdict:
    size = float(np.linalg.norm(flight.acceleration))
    down = float(flight.acceleration @ DOWN) >= thresholds.gravity_cosine * size
    off = abs(size / GRAVITY_MPS2 - 1.0)
    if down:
        return Verdict.SCALED if off > thresholds.gravity_off_share else Verdict.SOUND
    return Verdict.ASIDE if off <= thresholds.gravity_share else Verdict.BOTH


def _notices(
    capture: Capture,
    flight: Flight,
    verdict: Verdict,
    how: Conventions,
    thresholds: Thresholds,
    *,
    sized: bool,
) -> Iterator[Notice]:
    """The notices of a flight that cannot be; none of one that no axis and unit would explain."""
    size = float(np.linalg.norm(flight.acceleration))
    up = how.axis(-flight.acceleration)
    unit = None if sized else how.unit(GRAVITY_MPS2 / size, thresholds.unit_share)
    span = {
        "start_s": float(capture.times[flight.first]),
        "end_s": float(capture.times[flight.last]),
    }
    if verdict is Verdict.ASIDE or (verdict is Verdict.BOTH and up and unit):
        angle = np.degrees(np.arccos(np.clip(flight.acceleration @ DOWN / size, -1.0, 1.0)))
        yield notice(
            "up-contradicted", flight.body, **span, shown="fall",
            angle_deg=round(float(angle), 1), up=up or "", declared=how.up,
        )  # fmt: skip
    if unit and verdict is not Verdict.ASIDE and (verdict is Verdict.SCALED or up):
        yield notice(
            "unit-contradicted", flight.body, **span, shown="fall",
            acceleration_mps2=float(f"{size:.3g}"), unit=unit, declared=unit_name(how),
        )  # fmt: skip
    elif verdict is Verdict.SCALED:
        rate_hz = capture.rate_hz * float(np.sqrt(GRAVITY_MPS2 / size))
        yield notice(
            "fall-rate", flight.body, **span,
            acceleration_mps2=float(f"{size:.3g}"), rate_hz=float(f"{rate_hz:.3g}"),
            declared_hz=float(f"{capture.rate_hz:.6g}"),
        )  # fmt: skip
