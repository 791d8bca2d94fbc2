"""Forces of segments and the velocities of blows, estimated from motion and mass."""

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.capture import Capture, TagType
from capar.model.facts import Touching
from capar.model.geometry import Places, Series, Vector
from capar.model.observation import ForceStyle
from extractors.bodies.bodies import Bodies, BodyGeometry
from extractors.forces.free_motion import (
    GRAVITY_MPS2,
    FreeMotion,
    Phase,
    Resistance,
    Surface,
    free_motion,
)
from extractors.motion.impacts import recorded_middles

VELOCITY_S = 0.2
"""Over so long the velocity of a hand is fitted beside a blow [s]."""

FEWEST = 6
"""A path needs so many places [1]."""

ALONG = 0.3
"""An axis with a smaller share of the speed takes the other's damping [1]."""

LATE_SHARE = 0.8
"""The thesis fits the first part of a slide: at its end, both quantities vanish [1]."""


def velocity_at(times: Series, places: Places, at_s: float, *, degree: int = 2) -> Vector:
    """The velocity at a time by a polynomial fitted to places [m/s].

    ``places``: recorded ones; lost ones are NaN [m]. ``at_s``: when [s]. ``degree``: of the
    polynomial [1].
    """
    known = ~np.isnan(places[:, 0])
    if known.sum() <= degree:
        return np.zeros(3)
    powers = np.stack([(times[known] - at_s) ** power for power in range(degree + 1)], axis=1)
    return np.asarray(np.linalg.lstsq(powers, places[known], rcond=None)[0][1])


def velocities_about(times: Series, places: Places, at_s: float) -> tuple[Vector, Vector]:
    """The velocities just before and just after a blow [m/s].

    Both ways are quadratic in time and meet in one place, which makes the fit less sensitive to
    noise than two fits would be.

    ``places``: recorded ones; lost ones are NaN [m]. ``at_s``: when the blow is [s].
    """
    near = (np.abs(times - at_s) <= VELOCITY_S) & ~np.isnan(places[:, 0])
    past = times[near] - at_s
    early, late = np.minimum(past, 0.0), np.maximum(past, 0.0)
    powers = np.stack([np.ones_like(past), early, early**2, late, late**2], axis=1)
    found = np.linalg.lstsq(powers, places[near], rcond=None)[0]
    return np.asarray(found[1]), np.asarray(found[3])


def restitution(before: Vector, after: Vector, thing: Vector) -> float | None:
    """Coefficient of restitution of a blow at a thing at rest (thesis eq. 3.5).

    The line of impact is the way that the thing takes: without friction there is no other force.

    ``before``: the striker's velocity before the impact [m/s]. ``after``: the striker's velocity
    after it [m/s].

    Returns:
        None where the striker does not go towards the thing.
    """
    line = thing / max(float(np.linalg.norm(thing)), 1e-9)
    closing = float(before @ line)
    return None if closing <= 0.0 else float((thing - after) @ line) / closing


def thesis_damping(times: Series, velocities: Places) -> tuple[float, float] | None:
    """The thesis's damping: the slope of acceleration over velocity against time (eq. 3.7-3.11).

    It is no physical coefficient, since it vanishes where the deceleration is proportional to the
    speed; ``Fit.damping`` is one. The end of the slide is left out, as the thesis does.

    ``velocities``: then [m/s].

    Returns:
        Along x and y [1/s^2]; None where the slide is too short.
    """
    last = int(LATE_SHARE * len(times))
    if last < FEWEST:
        return None
    rates = np.gradient(velocities, times, axis=0)[:last]
    part, clock = velocities[:last], times[:last]
    out = []
    for axis in range(2):
        moves = np.abs(part[:, axis]) > ALONG * np.abs(part[:, axis]).max()
        flat = np.abs(part[:, axis]).max() < ALONG * np.hypot(*part[:, :2].T).max()
        if flat or moves.sum() < FEWEST:
            out.append(0.0)
            continue
        ratio = rates[moves, axis] / part[moves, axis]
        out.append(float(np.polyfit(clock[moves], ratio, 1)[0]))
    return out[0], out[1]


MOST = 160
"""Of a longer path so many places are fitted [1]."""

SLIDES_S = 0.1
"""A slide that is shorter says nothing of damping [s]."""

NEAR_M = 0.015
"""A thing that is so near a surface slides on it or lands [m]."""

LANDS_MPS = 0.15
"""A landing at less than this is none [m/s]."""

EARLY_S = 0.04
"""How far from the frame of contact a blow may be in truth [s]."""

BEGINNINGS = (0.0, -0.5, 0.5)
"""Where the search for the time of a blow begins, as shares of how far that may be off [1]."""

DAMPING, BOUNCE = 2.0, 0.4
"""Where the fit begins [1/s], [1]."""

LATE_DAMPING = 40.0
"""The largest that is tried [1/s]."""

LEVEL, HEIGHT = slice(0, 2), slice(2, 3)
"""Axes of the world."""

GRID = 11
"""Values that are tried before the best is refined [1]."""


@dataclass(frozen=True, eq=False)
class Fit:
    """What a path says of a thing that moves on alone."""

    start_s: float
    position: Vector
    velocity: Vector
    damping: tuple[float, float] | None
    bounce: float | None
    residual_m: float
    motion: FreeMotion
    """At the fitted times."""


def fit_free_motion(
    times: Series,
    places: Places,
    *,
    rested: Vector | None,
    half: Vector,
    surfaces: Sequence[Surface],
) -> Fit | None:
    """The motion from rest or from the hand that fits a path best, by least squares.

    What is closed form is fitted first: the slide, or the flight to the first landing. How it
    bounces, and its damping where it slides only later, are fitted over the integrated motion.

    ``places``: of the thing's middle, as recorded [m]. ``rested``: where its middle rested until
    about the first time [m]; None of a thing that was let go in motion. ``half``: half of its
    lengths along the world's axes [m]. ``surfaces``: what may bear it.

    Returns:
        None where the path is too short.
    """
    known = ~np.isnan(places[:, 0])
    if known.sum() < FEWEST:
        return None
    step = max(1, -(-int(known.sum()) // MOST))
    clock, path = times[known][::step], places[known][::step]
    level = _level(clock, path, rested, half, surfaces)
    if level is None:
        begin, damping = _flight(clock, path, half, surfaces), None
    else:
        begin, damping = _slide(clock, path, rested, level)
    if begin is None:
        return None
    course = _Course(clock, path, begin, half, surfaces)
    late, bounce = course.resistance(damping)
    motion = course.motion(late, bounce)
    off = geometry.lengths(motion.positions - path)
    return Fit(
        start_s=float(begin.start_s),
        position=begin.place,
        velocity=begin.velocity,
        damping=late if _slid_s(motion, clock) >= SLIDES_S else None,
        bounce=bounce if _lands(motion) else None,
        residual_m=float(np.sqrt(np.mean(off**2))),
        motion=motion,
    )


@dataclass(frozen=True, eq=False)
class _Begin:
    """Where and how fast a thing is when it begins to move alone."""

    start_s: float
    place: Vector
    velocity: Vector


@dataclass(frozen=True, eq=False)
class _Course:
    """A recorded path and where it begins."""

    times: Series
    places: Places
    begin: _Begin
    half: Vector
    surfaces: Sequence[Surface]

    def motion(self, damping: tuple[float, float], bounce: float) -> FreeMotion:
        """The integrated motion at the recorded times."""
        begin = self.begin
        after = self.times > begin.start_s
        found = free_motion(
            begin.place,
            begin.velocity,
            np.concatenate([[begin.start_s], self.times[after]]),
            half=self.half,
            surfaces=self.surfaces,
            resistance=Resistance(damping, bounce),
        )
        before = np.tile(begin.place, (int((~after).sum()), 1))
        return FreeMotion(
            np.concatenate([before, found.positions[1:]]),
            np.concatenate([np.zeros_like(before), found.velocities[1:]]),
            found.phases,
        )

    def resistance(self, damping: tuple[float, float] | None) -> tuple[tuple[float, float], float]:
        """Damping, if that is not known, and bounce, each with the other as it was found."""
        late, bounce = damping or (DAMPING, DAMPING), BOUNCE
        for _ in range(1 if damping else 2):
            motion = self.motion(late, bounce)
            if _lands(motion):
                # By heights, which damping does not change.
                bounce = _least(partial(self._miss, HEIGHT, late), 0.0, 1.0)
            if damping is None and _slid_s(motion, self.times) >= SLIDES_S:
                value = _least(partial(self._miss_of_damping, bounce), 0.0, LATE_DAMPING)
                late = value, value
        return late, bounce

    def _miss_of_damping(self, bounce: float, damping: float) -> float:
        return self._miss(LEVEL, (damping, damping), bounce)

    def _miss(self, axes: slice, damping: tuple[float, float], bounce: float) -> float:
        """Mean square distance along some axes [m^2]."""
        off = self.motion(damping, bounce).positions[:, axes] - self.places[:, axes]
        return float(np.mean(off**2))


def _level(
    times: Series, places: Places, rested: Vector | None, half: Vector, surfaces: Sequence[Surface]
) -> float | None:
    """The height of the middle of a thing that begins on a surface and stays on it [m]."""
    early = times <= times[0] + SLIDES_S
    now = float(np.median(places[early, 2]))
    height = now if rested is None else float(rested[2])
    for surface in surfaces:
        middle = surface.top_m + float(half[2])
        if max(abs(height - middle), abs(now - middle)) < NEAR_M:
            return middle
    return None


def _slide(
    times: Series, places: Places, rested: Vector | None, level: float
) -> tuple[_Begin | None, tuple[float, float] | None]:
    """Start, velocity and damping of a slide: x = x0 + v (1 - exp(-k t)) / k along each axis."""
    from scipy.optimize import least_squares

    off = np.flatnonzero(np.abs(places[:, 2] - level) > NEAR_M)
    last = int(off[0]) if len(off) else len(times)
    if last < FEWEST:
        return None, None
    clock, path = times[:last], places[:last, :2]
    early = clock <= clock[0] + 2.0 * EARLY_S
    early[:FEWEST] = True
    pace = velocity_at(clock[early], places[:last][early], float(clock[0]), degree=1)[:2]
    apart = bool(np.abs(pace).min() >= ALONG * np.linalg.norm(pace))
    origin = path[0] if rested is None else rested[:2]

    def values(units: Float[np.ndarray, "7"]) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
        start, place, speed = 0.0, origin, pace + units[1:3]
        if rested is None:
            place = origin + 0.01 * units[5:7]
        else:
            start = 0.01 * units[0]
        damping = np.maximum(np.array([units[3], units[4] if apart else units[3]]), 1e-6)
        return start, place, speed, damping

    def residuals(units: Float[np.ndarray, "7"]) -> Float[np.ndarray, "rows"]:
        start, place, speed, damping = values(units)
        past = np.maximum(clock - clock[0] - start, 0.0)[:, None]
        return np.asarray((place + speed * -np.expm1(-damping * past) / damping - path).ravel())

    reach = EARLY_S / 0.01
    low = np.array([-reach, -3.0, -3.0, 1e-6, 1e-6, -5.0, -5.0])
    high = np.array([reach, 3.0, 3.0, LATE_DAMPING, LATE_DAMPING, 5.0, 5.0])
    # Before the blow nothing depends on its time, so that a search can stop short of the best one.
    guesses = [
        np.array([share * reach, 0.0, 0.0, DAMPING, DAMPING, 0.0, 0.0]) for share in BEGINNINGS
    ]
    scale = np.maximum(guesses[0], 0.1)
    fits = [least_squares(residuals, guess, bounds=(low, high), x_scale=scale) for guess in guesses]
    start, place, speed, damping = values(min(fits, key=lambda fit: float(fit.cost)).x)
    begin = _Begin(float(clock[0]) + start, np.array([*place, level]), np.array([*speed, 0.0]))
    long = clock[-1] - begin.start_s >= SLIDES_S
    return begin, (float(damping[0]), float(damping[1])) if long else None


def _flight(
    times: Series, places: Places, half: Vector, surfaces: Sequence[Surface]
) -> _Begin | None:
    """Place and velocity of a thing in the air, by the flight to its first landing."""
    last = len(times)
    for surface in surfaces:
        low = places[:, 2] - half[2] - surface.top_m
        near, far = places[:, :2] - half[:2], places[:, :2] + half[:2]
        inside = (far > surface.low) & (near < surface.high)
        lands = np.flatnonzero((np.abs(low) < NEAR_M) & inside.all(axis=1))
        last = min(last, int(lands[0])) if len(lands) else last
    if last < FEWEST:
        return None
    past = times[:last] - times[0]
    fallen = places[:last] + np.outer(0.5 * GRAVITY_MPS2 * past**2, [0.0, 0.0, 1.0])
    powers = np.stack([np.ones_like(past), past], axis=1)
    place, pace = np.linalg.lstsq(powers, fallen, rcond=None)[0]
    return _Begin(float(times[0]), np.asarray(place), np.asarray(pace))


def _least(miss: Callable[[float], float], low: float, high: float) -> float:
    """Where a function of one number is least: the best of a grid, refined."""
    from scipy.optimize import minimize_scalar

    grid = np.linspace(low, high, GRID)
    best = int(np.argmin([miss(float(value)) for value in grid]))
    step = grid[1] - grid[0]
    around = max(low, grid[best] - step), min(high, grid[best] + step)
    return float(minimize_scalar(miss, bounds=around, method="bounded", options={"xatol": 1e-4}).x)


def _lands(motion: FreeMotion) -> bool:
    """Whether it fell on something while it was followed."""
    down = motion.velocities[:, 2] < -LANDS_MPS
    return bool((down[:-1] & (motion.velocities[1:, 2] >= 0.0)).any())


def _slid_s(motion: FreeMotion, times: Series) -> float:
    """How long it slid [s]."""
    starts = [*(at for at, _ in motion.phases), float(times[-1])]
    spans = ((phase, starts[n + 1] - at) for n, (at, phase) in enumerate(motion.phases))
    return sum(span for phase, span in spans if phase is Phase.SLIDES)


GOES_MPS = 0.25
"""A thing that leaves a hand more slowly was put down [m/s]."""

GOES_M = 0.05
"""A thing that gets no further alone was put down [m]."""

SHORT_S = 0.2
"""A contact with a thing at rest that lasts longer is a push, not a blow [s]."""

RESTED_S = 0.15
"""Over so long before a contact a struck thing was at rest [s]."""

OFF_M, OFF_SHARE = 0.02, 0.1
"""A motion that is further off the fitted one, in metres and shares of its way, is no free one."""

BEFORE_S = 0.05
"""Beside a contact so much is left out, which the filter blurs [s]."""


def force_styles(
    capture: Capture,
    bodies: Bodies,
    facts: Iterable[object],
    guided: Collection[str] = (),
    *,
    times: Series | None = None,
) -> tuple[ForceStyle, ...]:
    """How end-effectors set things going that moved on alone, in order of time.

    A thing keeps its orientation in the model, and is borne by level tops of fixed objects and by
    the ground, which is the lowest of them or, if that is higher, z = 0.

    ``guided``: objects on hinges and rails, which do not move freely.
    """
    clock = capture.times if times is None else times
    touching = [fact for fact in facts if isinstance(fact, Touching)]
    acting = {sensor.name for sensor in capture.acting}
    mobile = {thing.name for thing in capture.objects if thing.tag is TagType.MOBILE}
    mobile -= set(guided)
    surfaces = _surfaces(capture, bodies)
    out = []
    for contact in touching:
        if contact.body in acting and contact.other in mobile:
            others = [c for c in touching if c.body in acting and c.other == contact.other]
            style = _style(capture, bodies, clock, contact, others, surfaces)
            if style is not None:
                out.append(style)
    return tuple(sorted(out, key=lambda style: (style.start_s, style.object, style.ee)))


def _style(
    capture: Capture,
    bodies: Bodies,
    times: Series,
    contact: Touching,
    others: list[Touching],
    surfaces: list[Surface],
) -> ForceStyle | None:
    """What one contact gave to a thing; None where it did not move on alone."""
    thing = bodies.objects[contact.other]
    rested = _rested(thing, contact, times)
    first = contact.first if rested is not None else contact.last
    # Until it is touched again; not where others touch it still.
    last = min((c.first for c in others if c.first > contact.last), default=len(times)) - 1
    still = any(c is not contact and c.first <= contact.last < c.last for c in others)
    if thing.shape is None or still or times[last] - times[first] < VELOCITY_S:
        return None
    span = slice(first, last + 1)
    places = recorded_middles(thing, span)
    far_m = _gone(times[span], places)
    if far_m is None:
        return None
    half = 0.5 * _extent(thing, first)
    found = fit_free_motion(times[span], places, rested=rested, half=half, surfaces=surfaces)
    if found is None or found.residual_m > OFF_M + OFF_SHARE * far_m:
        return None
    if np.linalg.norm(found.velocity) < GOES_MPS:
        return None
    return _stated(capture, bodies, times, contact, found, span, rested is not None)


def _gone(times: Series, places: Places) -> float | None:
    """How far a thing goes [m]; None where it does not go off at once, or was lost."""
    gone = geometry.lengths(places - places[0])
    soon = times <= times[0] + VELOCITY_S
    if np.isnan(gone[0]) or np.nanmax(gone[soon]) < 0.5 * GOES_MPS * VELOCITY_S:
        return None
    far_m = float(np.nanmax(gone))
    return far_m if far_m >= GOES_M else None


def _stated(
    capture: Capture,
    bodies: Bodies,
    times: Series,
    contact: Touching,
    found: Fit,
    span: slice,
    struck: bool,
) -> ForceStyle:
    thing = capture.tag_object(contact.other)
    # The striker's velocities just before and just after.
    about = [found.start_s - VELOCITY_S, found.start_s + VELOCITY_S]
    near = slice(*map(int, np.searchsorted(times, about)))
    middles = recorded_middles(bodies.sensors[contact.body], near)
    before, after = velocities_about(times[near], middles, found.start_s)
    mass, clock = thing.mass_kg, times[span]
    slides = _sliding(found, clock)
    return ForceStyle(
        object=contact.other,
        ee=contact.body,
        start_s=found.start_s,
        end_s=float(clock[-1]),
        struck=struck,
        position_m=_vector(found.position),
        velocity_mps=_vector(found.velocity),
        striker_mps=_vector(before),
        follow_mps=_vector(after),
        restitution=restitution(before, after, found.velocity) if struck else None,
        damping_per_s=found.damping,
        thesis_damping=_thesis(bodies.objects[contact.other], times, slides),
        bounce=found.bounce,
        impulse_ns=None if mass is None else _vector(mass * found.velocity),
        residual_m=found.residual_m,
    )


def _rested(thing: BodyGeometry, contact: Touching, times: Series) -> Vector | None:
    """Where a thing rested before a blow [m]; None where it moved, or was not struck."""
    if times[contact.last] - times[contact.first] > SHORT_S:
        return None
    low, high = times[contact.first] - BEFORE_S - RESTED_S, times[contact.first] - BEFORE_S
    first, last = (int(frame) for frame in np.searchsorted(times, [low, high]))
    if last - first < 2:
        return None
    places = recorded_middles(thing, slice(first, last))
    drift = np.linalg.norm(np.nanmean(places[-2:], axis=0) - np.nanmean(places[:2], axis=0))
    return None if drift > GOES_MPS * RESTED_S * 0.5 else np.nanmedian(places, axis=0)


def _sliding(found: Fit, clock: Series) -> tuple[float, float] | None:
    """When its first slide began and ended [s]."""
    starts = [*(at for at, _ in found.motion.phases), float(clock[-1])]
    for number, (at, phase) in enumerate(found.motion.phases):
        if phase is Phase.SLIDES:
            return at, starts[number + 1]
    return None


def _thesis(
    thing: BodyGeometry, times: Series, slides: tuple[float, float] | None
) -> tuple[float, float] | None:
    if slides is None:
        return None
    stream = thing.poses.smooth
    first, last = np.searchsorted(times, [slides[0] + BEFORE_S, slides[1]])
    clock, places = times[first:last], stream.positions[first:last]
    if len(clock) < 3 or np.isnan(places).any():
        return None
    return thesis_damping(clock, np.gradient(places, clock, axis=0))


def _surfaces(capture: Capture, bodies: Bodies) -> list[Surface]:
    out = []
    for thing in capture.objects:
        if thing.tag is TagType.FIXED and thing.shape is not None:
            body = bodies.objects[thing.name]
            middle, extent = np.nanmedian(body.middles, axis=0), _extent(body, 0)
            low, high = _vector(middle - 0.5 * extent), _vector(middle + 0.5 * extent)
            out.append(Surface(high[2], low[:2], high[:2]))
    ground = min([0.0, *(surface.top_m for surface in out)])
    return [*out, Surface(ground)]


def _extent(body: BodyGeometry, frame: int) -> Vector:
    """Lengths of a body's surface along the world's axes [m]."""
    assert body.shape is not None
    return np.asarray(np.ptp(np.array(body.shape.vertices) @ body.turn(frame).T, axis=0))


def _vector(values: Vector) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z
