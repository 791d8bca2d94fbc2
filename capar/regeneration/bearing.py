"""What a held thing bears: when, where it goes, and whether it would slide or fall."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError
from scipy.spatial.transform import RigidTransform

from capar.body.scenes import Thing
from capar.model.facts import Touching
from capar.regeneration.errors import PlanError
from capar.regeneration.holding import LOOSER, SETTLED_M, SETTLED_RAD, Hold

MOVES_M = 0.02
"""What goes no further than this is not carried along [m]."""

RESTS_M = 0.006
"""Points of a borne thing that are no higher than this above its lowest are those it stands on
[m]."""

FRICTION = 0.3
"""Coefficient of friction between what bears and what is borne: ceramics on wood or plastic have
0.3 to 0.5 [1]."""

GRAVITY_MPS2 = 9.81

HALF_S = 0.1
"""Over so long before and after a frame its acceleration is measured [s]."""


@dataclass(frozen=True)
class Ride:
    """A thing that stands on another one while hands move that."""

    thing: str
    bearer: str
    first: int
    last: int


@dataclass(frozen=True)
class Steadiness:
    """Whether a borne thing would slide or fall, at the worst frame of its ride."""

    tilt_rad: float
    """Angle between what it weighs on its bearer, which accelerates, and that one's normal."""

    tilt_frame: int
    inside_m: float
    """How far inside what it stands on it weighs; negative outside, where it falls over [m]."""

    inside_frame: int


def rides_of(
    paths: Mapping[str, RigidTransform], holds: tuple[Hold, ...], touching: list[Touching]
) -> tuple[Ride, ...]:
    """What is borne by what hands move, in order of time; bearers before what they bear.

    Args:
        paths: ``T_world_thing`` by name at every frame.
        holds: Of all hands.
        touching: The contacts that were observed.

    Raises:
        PlanError: A thing is taken by a hand after it was borne.
    """
    out: list[Ride] = []
    carried = {hold.thing: [(hold.first, hold.last)] for hold in holds}
    for hold in holds:
        carried[hold.thing].append((hold.first, hold.last))
    while True:
        found = _next_ride(paths, holds, touching, carried, out)
        if found is None:
            return tuple(out)
        later = [h for h in holds if h.thing == found.thing and h.last > found.first]
        if later:
            raise PlanError(
                f"a hand takes {found.thing!r} after or while {found.bearer!r} bears it, which is "
                "not regenerated; a part of the recording before that would do: to_s with "
                "--assume FILE"
            )
        out.append(found)
        carried.setdefault(found.thing, []).append((found.first, found.last))


def _next_ride(
    paths: Mapping[str, RigidTransform],
    holds: tuple[Hold, ...],
    touching: list[Touching],
    carried: Mapping[str, list[tuple[int, int]]],
    known: list[Ride],
) -> Ride | None:
    """A ride that is not known yet on what is carried."""
    have = {(ride.thing, ride.first) for ride in known}
    for bearer, spans in carried.items():
        for contact in touching:
            pair = {contact.body, contact.other}
            if bearer not in pair or len(pair) < 2 or not pair <= set(paths):
                continue
            (thing,) = pair - {bearer}
            for start, end in spans:
                first, last = max(start, contact.first), min(end, contact.last)
                held = [h for h in holds if h.thing == thing and h.first < last and first < h.last]
                new = last > first and not held and (thing, first) not in have
                if new and _goes_along(paths[thing], paths[bearer], first, last):
                    return Ride(thing, bearer, first, last)
    return None


def _goes_along(thing: RigidTransform, bearer: RigidTransform, first: int, last: int) -> bool:
    """Whether a thing is carried along and rigidly together with what bears it."""
    part = slice(first, last + 1)
    gone = np.linalg.norm(thing[part].translation - thing[first].translation, axis=1)
    above = thing[first].translation[2] >= bearer[first].translation[2]
    relative = bearer[part].inv() * thing[part]
    off = np.linalg.norm(relative.translation - relative[0].translation, axis=1)
    turned = (relative.rotation * relative[0].rotation.inv()).magnitude()
    limit_m, limit_rad = LOOSER[-1] * SETTLED_M, LOOSER[-1] * SETTLED_RAD
    steady = off.max() < limit_m and turned.max() < limit_rad
    return bool(above and steady and gone.max() >= MOVES_M)


def with_riders(
    paths: Mapping[str, RigidTransform], rides: tuple[Ride, ...]
) -> dict[str, RigidTransform]:
    """The ways of all things, what is borne going along with its bearer.

    Args:
        paths: ``T_world_thing`` by name at every frame; of what is borne up to its ride.
        rides: Bearers before what they bear.
    """
    out = dict(paths)
    for ride in rides:
        own, bearer = out[ride.thing], out[ride.bearer]
        seat = bearer[ride.first].inv() * own[ride.first]
        there = bearer[ride.first : ride.last + 1] * seat
        after = [there[-1]] * (len(own) - 1 - ride.last)
        parts = [*own[: ride.first], *there, *after] if ride.first else [*there, *after]
        out[ride.thing] = RigidTransform.concatenate(parts)
    return out


def steadiness(
    thing: Thing, seat: RigidTransform, bearer: RigidTransform, rate_hz: float
) -> Steadiness:
    """Whether a thing would stay on its bearer.

    It weighs on it along the sum of gravity and of what its middle is accelerated; it slides where
    that leaves the cone of friction, and falls over where it leads past what it stands on.

    Args:
        thing: What is borne, of uniform density.
        seat: ``T_bearer_thing``.
        bearer: ``T_world_bearer`` at every frame of the ride.
        rate_hz: Frames a second.
    """
    mesh = trimesh.Trimesh(np.array(thing.shape.vertices), np.array(thing.shape.faces))
    middle = seat.apply(np.array(mesh.convex_hull.center_mass))
    corners = seat.apply(np.array(mesh.vertices))
    low = corners[:, 2].min()
    base = corners[corners[:, 2] < low + RESTS_M][:, :2]
    pulls = bearer.rotation.inv().apply(_pull(bearer, middle, rate_hz))
    tilts = np.arccos(np.clip(-pulls[:, 2] / np.linalg.norm(pulls, axis=1), -1.0, 1.0))
    down = np.minimum(pulls[:, 2], -1e-6)
    spots = middle[:2] - pulls[:, :2] * ((middle[2] - low) / down)[:, None]
    inside = _inside(base, spots)
    return Steadiness(
        float(tilts.max()), int(tilts.argmax()), float(inside.min()), int(inside.argmin())
    )


def _pull(
    bearer: RigidTransform, middle: Float[np.ndarray, "3"], rate_hz: float
) -> Float[np.ndarray, "frames 3"]:
    """Gravity less the acceleration of a point of the bearer [m/s^2]."""
    spots = bearer.apply(middle)
    half = max(round(HALF_S * rate_hz), 1)
    padded = np.pad(spots, ((half, half), (0, 0)), mode="edge")
    ahead, back = padded[2 * half :], padded[: -2 * half]
    speeding = (ahead - 2.0 * spots + back) / (half / rate_hz) ** 2
    return np.asarray(np.array([0.0, 0.0, -GRAVITY_MPS2]) - speeding)


def _inside(
    base: Float[np.ndarray, "points 2"], spots: Float[np.ndarray, "frames 2"]
) -> Float[np.ndarray, "frames"]:
    """How far spots are inside the convex hull of points, negative outside [m]."""
    try:
        sides = ConvexHull(base).equations
    except QhullError:  # it stands on an edge or a point
        return -np.linalg.norm(spots - base.mean(axis=0), axis=1)
    return np.asarray(-(spots @ sides[:, :2].T + sides[:, 2]).max(axis=1))
