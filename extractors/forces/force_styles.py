"""The force styles of a capture: what set things going that then moved on alone."""

from collections.abc import Collection, Iterable

import numpy as np
from jaxtyping import Float

from capar.model.capture import Capture, TagType
from capar.model.facts import Touching
from capar.model.observation import ForceStyle, Vector
from extractors.bodies.bodies import Bodies
from extractors.bodies.body_geometry import BodyGeometry
from extractors.forces.blow_velocities import (
    VELOCITY_S,
    restitution,
    thesis_damping,
    velocities_about,
)
from extractors.forces.estimating import Fit, fit_free_motion
from extractors.forces.free_motion import Phase, Surface
from extractors.motion.impacts import recorded_middles

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
    times: Float[np.ndarray, "frames"] | None = None,
) -> tuple[ForceStyle, ...]:
    """How end-effectors set things going that moved on alone, in order of time.

    A thing keeps its orientation in the model, and is borne by level tops of fixed objects and by
    the ground, which is the lowest of them or, if that is higher, z = 0.

    Args:
        capture: The trial.
        bodies: Its bodies.
        facts: What was measured of it.
        guided: Objects on hinges and rails, which do not move freely.
        times: The clock of the bodies [s]; None where they are of the capture itself.
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
    times: Float[np.ndarray, "frames"],
    contact: Touching,
    others: list[Touching],
    surfaces: list[Surface],
) -> ForceStyle | None:
    """What one contact gave to a thing; None where it did not move on alone."""
    thing = bodies.objects[contact.other]
    rested = _rested(thing, contact, times)
    first = contact.first if rested is not None else contact.last
    last = _last_alone(contact, others, len(times))
    if thing.shape is None or last is None or times[last] - times[first] < VELOCITY_S:
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


def _last_alone(contact: Touching, others: list[Touching], frames: int) -> int | None:
    """The last frame before a thing is touched again; None where others touch it still."""
    if any(c is not contact and c.first <= contact.last < c.last for c in others):
        return None
    return min((c.first for c in others if c.first > contact.last), default=frames) - 1


def _gone(
    times: Float[np.ndarray, "frames"], places: Float[np.ndarray, "frames 3"]
) -> float | None:
    """How far a thing goes [m]; None where it does not go off at once, or was lost."""
    gone = np.linalg.norm(places - places[0], axis=1)
    soon = times <= times[0] + VELOCITY_S
    if np.isnan(gone[0]) or np.nanmax(gone[soon]) < 0.5 * GOES_MPS * VELOCITY_S:
        return None
    far_m = float(np.nanmax(gone))
    return far_m if far_m >= GOES_M else None


def _stated(
    capture: Capture,
    bodies: Bodies,
    times: Float[np.ndarray, "frames"],
    contact: Touching,
    found: Fit,
    span: slice,
    struck: bool,
) -> ForceStyle:
    thing = capture.tag_object(contact.other)
    before, after = _striker(bodies.sensors[contact.body], times, found.start_s)
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


def _striker(
    body: BodyGeometry, times: Float[np.ndarray, "frames"], at_s: float
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """The velocities of an end-effector just before and just after a time [m/s]."""
    first, last = np.searchsorted(times, [at_s - VELOCITY_S, at_s + VELOCITY_S])
    span = slice(int(first), int(last))
    return velocities_about(times[span], recorded_middles(body, span), at_s)


def _rested(
    thing: BodyGeometry, contact: Touching, times: Float[np.ndarray, "frames"]
) -> Float[np.ndarray, "3"] | None:
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


def _sliding(found: Fit, clock: Float[np.ndarray, "frames"]) -> tuple[float, float] | None:
    """When its first slide began and ended [s]."""
    starts = [*(at for at, _ in found.motion.phases), float(clock[-1])]
    for number, (at, phase) in enumerate(found.motion.phases):
        if phase is Phase.SLIDES:
            return at, starts[number + 1]
    return None


def _thesis(
    thing: BodyGeometry, times: Float[np.ndarray, "frames"], slides: tuple[float, float] | None
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
            low, high = middle - 0.5 * extent, middle + 0.5 * extent
            out.append(
                Surface(
                    float(high[2]), (float(low[0]), float(low[1])), (float(high[0]), float(high[1]))
                )
            )
    ground = min([0.0, *(surface.top_m for surface in out)])
    return [*out, Surface(ground)]


def _extent(body: BodyGeometry, frame: int) -> Float[np.ndarray, "3"]:
    """Lengths of a body's surface along the world's axes [m]."""
    assert body.shape is not None
    return np.asarray(np.ptp(np.array(body.shape.vertices) @ body.turn(frame).T, axis=0))


def _vector(values: Float[np.ndarray, "3"]) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
