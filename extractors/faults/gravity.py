"""Free flight of bodies, and what gravity contradicts: the upward axis, the unit, the rate."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import correlate1d, maximum_filter1d

from capar.model import geometry
from capar.model.capture import Capture, Conventions
from capar.model.notices import Notice, notice
from extractors.bodies.bodies import Bodies, BodyGeometry
from extractors.motion.impacts import GRAVITY_MPS2, recorded_middles
from extractors.signals.filters import JITTER
from extractors.signals.intervals import Interval, time_step
from extractors.thresholds import Thresholds

WINDOWS = (9, 13, 17, 25, 33, 49, 65)
"""Lengths of the windows in which a parabola is fitted [frames]: a flight of a third of a second
at 30 to 240 Hz."""

Places = Float[np.ndarray, "frames 3"]


@dataclass(frozen=True, eq=False)
class Flight:
    """A body at constant acceleration that no sensor goes along with."""

    body: str
    first: int
    last: int
    acceleration: Float[np.ndarray, "3"]
    """In the world [m/s^2]."""

    curved: bool
    """Whether it also went across its acceleration, or turned back: no straight descent."""


def flights(
    body: BodyGeometry, others: Iterable[BodyGeometry], thresholds: Thresholds
) -> Iterator[Flight]:
    """Where a body flies freely, by its recorded path alone.

    A frame belongs to a flight if a parabola fits the path about it, neither noise nor a change
    of acceleration being more than a share of its bend. The acceleration stays the same through
    the flight, the body gains speed along it in the end, and no sensor goes along.

    """
    times = body.poses.filled.times
    if body.poses.still or body.poses.fixed is not None:
        return
    places = recorded_middles(body, slice(None))
    carriers = [each.poses.filled.positions for each in others if each.name != body.name]
    noise_m = max(body.poses.noise.position_m, thresholds.flight_noise_m)
    for first, last in geometry.runs(~np.isnan(places[:, 0])):
        known = slice(first, last + 1)
        if last - first + 1 < WINDOWS[0]:
            continue
        if np.abs(np.diff(times[known]) / time_step(times[known]) - 1.0).max() > JITTER:
            continue
        for begin, end in _parabolic(places[known], noise_m, thresholds):
            span = first + begin, first + end
            found = _flight(body.name, places, times, span, noise_m, thresholds)
            if found and not any(
                goes_along(places, carrier, slice(found.first, found.last + 1), thresholds)
                for carrier in carriers
            ):
                yield found


def goes_along(places: Places, carrier: Places, frames: slice, thresholds: Thresholds) -> bool:
    """Whether a carrier keeps its distance from a body, compared with how far the body goes."""
    way = geometry.lengths(places[frames] - places[frames.start])
    apart = geometry.lengths(places[frames] - carrier[frames])
    return not np.isnan(apart).all() and bool(
        np.nanmax(apart) - np.nanmin(apart) < thresholds.flight_along_share * way.max()
    )


def _flight(
    name: str,
    places: Places,
    times: Float[np.ndarray, "frames"],
    span: Interval,
    noise_m: float,
    thresholds: Thresholds,
) -> Flight | None:
    """The flight of a stretch; None if its acceleration changes, or it gains no speed along it."""
    first, last = span
    rim = round(thresholds.flight_rim_share * (last - first))
    frames = slice(first + rim, last - rim + 1)
    clock = times[frames] - times[frames.start]
    # Acceleration is even throughout: there is no cubic and no quartic term.
    basis, _ = np.linalg.qr(np.vander(clock / clock[-1], 5, increasing=True))
    terms = geometry.lengths(basis.T @ places[frames])
    allowed_m = thresholds.flight_even_share * terms[2] + thresholds.flight_even_sigmas * noise_m
    if not max(terms[3], terms[4]) <= allowed_m:
        return None
    (bend, begin, _), *_ = np.linalg.lstsq(
        np.stack([0.5 * clock**2, clock, np.ones_like(clock)], axis=1), places[frames], rcond=None
    )
    pull = float(np.linalg.norm(bend))
    along = bend / pull
    gained = pull * float(clock[-1])
    before = float(begin @ along)
    if before + gained < thresholds.flight_gain_share * gained:
        return None
    across = float(np.linalg.norm(begin - before * along))
    turned = before < -thresholds.flight_across_share * gained
    curved = across >= thresholds.flight_across_share * gained
    return Flight(name, first, last, bend, turned or curved)


def _parabolic(places: Places, noise_m: float, thresholds: Thresholds) -> Iterator[Interval]:
    """Stretches of a path through which its acceleration is the same."""
    taken = np.zeros(len(places), dtype=bool)
    # A window bends by no more than its places are off the middle of all, squared and summed up.
    off_m = 1.001 * float(geometry.lengths(places - places.mean(axis=0)).max())
    least = (thresholds.flight_bend_sigmas * noise_m / off_m) ** 2 if off_m else np.inf
    for width in reversed([each for each in WINDOWS if least <= each <= len(places)]):
        bend, fits = _bends(places, width, noise_m, thresholds)
        found = sorted(_steady(bend, fits, width, thresholds), key=lambda run: run[0] - run[1])
        for first, last in found:
            reach = slice(first - width // 2, last + width // 2 + 1)
            if not taken[reach].any():
                taken[reach] = True
                yield reach.start, reach.stop - 1


def _bends(
    places: Places, width: int, noise_m: float, thresholds: Thresholds
) -> tuple[Places, Bool[np.ndarray, "frames"]]:
    """The square term of a cubic fitted about each frame, and where it is all that there is."""
    basis, half = _polynomials(width), width // 2
    centred = places - places.mean(axis=0)
    square = np.asarray(correlate1d(centred, basis[2], axis=0, mode="nearest"))
    bend = geometry.lengths(square)
    fits = bend >= thresholds.flight_bend_sigmas * noise_m
    fits[:half] = fits[len(fits) - half :] = False
    allowed_m = thresholds.flight_noise_sigmas * noise_m * np.sqrt(3.0 * (width - len(basis)))
    # Elsewhere other terms need not be known: one window about each such frame is enough.
    about = np.flatnonzero(maximum_filter1d(fits.view(np.uint8), width))
    own, near = fits[about], centred[about]
    terms = [correlate1d(near, each, axis=0)[own] for each in (basis[0], basis[1], basis[3])]
    energy = width * correlate1d(near**2, np.full(width, 1.0 / width), axis=0)[own]
    terms.insert(2, square[fits])
    left = geometry.totals(energy - sum(each**2 for each in terms))
    misfit, most = np.sqrt(np.maximum(left, 0.0)), thresholds.flight_change_share * bend[fits]
    fits[fits] = (geometry.lengths(terms[3]) <= most) & (misfit <= most + allowed_m)
    return square, fits


def _steady(
    bend: Places, fits: Bool[np.ndarray, "frames"], width: int, thresholds: Thresholds
) -> Iterator[Interval]:
    """The runs of fitting frames in which the bend is the same."""
    for first, last in geometry.runs(fits):
        middle = np.median(bend[first : last + 1], axis=0)
        off = geometry.lengths(bend[first : last + 1] - middle)
        same = off <= thresholds.flight_change_share * float(np.linalg.norm(middle))
        for begin, end in geometry.runs(same):
            if end - begin + 1 >= max(3, round(thresholds.flight_steady_share * width)):
                yield first + begin, first + end


@lru_cache
def _polynomials(width: int) -> Sequence[Float[np.ndarray, "width"]]:
    """Polynomials of degree 0 to 3 over a window, orthonormal."""
    index = np.arange(width) - width // 2
    square, _ = np.linalg.qr(np.stack([index.astype(float) ** power for power in range(4)], axis=1))
    return tuple(square.T)


DOWN = np.array([0.0, 0.0, -1.0])


SOUND, ASIDE, SCALED, BOTH = "sound", "aside", "scaled", "both"
"""How the acceleration of a flight compares with gravity: as large along another direction, down
of another size, or both."""


def gravity_notices(
    capture: Capture, bodies: Bodies, thresholds: Thresholds, *, sized: bool
) -> Iterator[Notice]:
    """Notices of falls that cannot be, with what would make them falls.

    Straight descents may be other than free: it takes two of them that are as fast as falls, and
    what is slower or faster than a fall has to be curved. Where as many flights are sound as are
    not, nothing is said.

    ``sized``: whether the size of people shows that the unit is right; then the rate is wrong.
    """
    found = [
        flight
        for thing in bodies.objects.values()
        for flight in flights(thing, bodies.sensors.values(), thresholds)
    ]
    groups: dict[str, list[Flight]] = {each: [] for each in (SOUND, ASIDE, SCALED, BOTH)}
    for flight in found:
        groups[_verdict(flight, thresholds)].append(flight)
    sound = len(groups.pop(SOUND))
    for verdict, group in groups.items():
        curved = [flight for flight in group if flight.curved]
        sure = group if verdict == ASIDE and len(group) > 1 else curved
        if sure and len(group) > sound:
            longest = max(sure, key=lambda flight: flight.last - flight.first)
            how = capture.conventions.get(longest.body, Conventions())
            yield from _notices(capture, longest, verdict, how, thresholds, sized=sized)


def _verdict(flight: Flight, thresholds: Thresholds) -> str:
    size = float(np.linalg.norm(flight.acceleration))
    down = float(flight.acceleration @ DOWN) >= thresholds.gravity_cosine * size
    off = abs(size / GRAVITY_MPS2 - 1.0)
    if down:
        return SCALED if off > thresholds.gravity_off_share else SOUND
    return ASIDE if off <= thresholds.gravity_share else BOTH


def _notices(
    capture: Capture,
    flight: Flight,
    verdict: str,
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
    if verdict == ASIDE or (verdict == BOTH and up and unit):
        angle = np.degrees(np.arccos(np.clip(flight.acceleration @ DOWN / size, -1.0, 1.0)))
        yield notice(
            "up-contradicted", flight.body, **span, shown="fall",
            angle_deg=round(float(angle), 1), up=up or "", declared=how.up,
        )  # fmt: skip
    if unit and verdict != ASIDE and (verdict == SCALED or up):
        yield notice(
            "unit-contradicted", flight.body, **span, shown="fall",
            acceleration_mps2=float(f"{size:.3g}"), unit=unit, declared=unit_name(how),
        )  # fmt: skip
    elif verdict == SCALED:
        rate_hz = capture.rate_hz * float(np.sqrt(GRAVITY_MPS2 / size))
        yield notice(
            "fall-rate", flight.body, **span,
            acceleration_mps2=float(f"{size:.3g}"), rate_hz=float(f"{rate_hz:.3g}"),
            declared_hz=float(f"{capture.rate_hz:.6g}"),
        )  # fmt: skip


def unit_name(how: Conventions) -> str:
    """The name of the unit that a file was read in."""
    return how.unit(1.0, 1e-6) or f"{how.unit_m:g} m"
