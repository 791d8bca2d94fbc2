"""Where bodies are, how far they have gone and turned, at the frames that matter."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from itertools import compress

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.facts import Distance, Fact, Place, Posture, SweptAzimuth, Travelled, TrunkPlace
from extractors.bodies.body_geometry import BodyGeometry
from extractors.bodies.trunk import from_trunk
from extractors.motion.leaning import lean, spin_steps
from extractors.relations.arrangement import beyond_shadow
from extractors.relations.running_sums import FROM_THE_BEGINNING, Sums, summed

LEAST_SWEEP_RAD = 0.5 * np.pi
"""A body that never sweeps so large an angle about another [rad] goes about it nowhere: a quarter
of a turn. For every two bodies and frame there would be an azimuth else, half of all facts."""

_COMMON = tuple(range(1 << 13))
"""Numbers that all facts share: a long recording states hundreds of thousands of distances below
eight metres, and an integer of its own would take 32 bytes for each."""


def places(
    body: BodyGeometry,
    upright: Float[np.ndarray, "3"],
    frames: tuple[int, ...],
    since: Sums = FROM_THE_BEGINNING,
) -> Iterator[Fact]:
    """Place, way, turn and posture of a body at some frames; lost frames are left out.

    Args:
        body: The body.
        upright: The axis that points up while it stands, in its own frame.
        frames: Frames, ascending.
        since: How far it had gone and turned before.
    """
    if not frames:
        return
    way, turn, spin = turned_and_gone(body, since)
    at = np.asarray(frames)
    at = at[~np.isnan(body.middles[at]).any(axis=1)]
    middles = _thousandths(body.middles[at])
    ways = _thousandths(np.stack([way[at], turn[at]], axis=1))
    postures = np.stack([lean(body.orientations[at], upright), spin[at]], axis=1)
    rows = zip(at.tolist(), middles, ways, _thousandths(postures), strict=True)
    for frame, middle, travelled, posture in rows:
        yield Place(body.name, frame, *middle)
        yield Travelled(body.name, frame, *travelled)
        yield Posture(body.name, frame, *posture)


def trunk_places(
    body: BodyGeometry,
    trunk: BodyGeometry,
    upright: Float[np.ndarray, "3"],
    frames: tuple[int, ...],
) -> Iterator[Fact]:
    """Place of an end-effector from its agent's trunk at some frames; lost ones are left out.

    Args:
        body: The end-effector.
        trunk: The trunk.
        upright: The trunk's axis that points up while it stands, in its own frame.
        frames: Frames, ascending.
    """
    if not frames:
        return
    at = np.asarray(frames)
    places_m = from_trunk(body, trunk, upright)[at]
    known = ~np.isnan(places_m).any(axis=1)
    for frame, place in zip(at[known].tolist(), _thousandths(places_m[known]), strict=True):
        yield TrunkPlace(body.name, frame, *place)


def distances(
    body: BodyGeometry,
    other: BodyGeometry,
    frames: tuple[int, ...],
    since: Sums = FROM_THE_BEGINNING,
    *,
    whole: bool = False,
) -> Iterator[Fact]:
    """Distance of two bodies' middles, and the angle by which one has gone about the other.

    Args:
        body: The body.
        other: The other one.
        frames: Frames, ascending; those at which either is lost are left out.
        since: By how much it had gone about the other before.
        whole: Whether this is a whole recording: angles that stay small in it are left out.
    """
    if not frames:
        return
    gone_about = wound(body, other, since)
    at = np.asarray(frames)
    apart = np.linalg.norm((body.middles - other.middles)[at], axis=1)
    known = ~np.isnan(apart)
    values = _thousandths(np.stack([apart[known], gone_about[at[known]]], axis=1))
    swept = [milliradians for _, milliradians in values]
    sweeps = not whole or _sweeps(swept)
    # The frames themselves, not copies: a long recording has hundreds of thousands of these facts.
    kept = compress(frames, known.tolist())
    for frame, (millimetres, milliradians) in zip(kept, values, strict=True):
        yield Distance(body.name, other.name, frame, millimetres)
        if sweeps:
            yield SweptAzimuth(body.name, other.name, frame, milliradians)


def without_small_sweeps(facts: Iterable[SweptAzimuth]) -> list[SweptAzimuth]:
    """Angles of a whole recording without those of bodies that go about each other nowhere.

    Args:
        facts: The angles of every two bodies, in any order, which is kept.
    """
    known = list(facts)
    angles: dict[tuple[str, str], list[int]] = defaultdict(list)
    for fact in known:
        angles[fact.body, fact.other].append(fact.milliradians)
    large = {pair for pair, swept in angles.items() if _sweeps(swept)}
    return [fact for fact in known if (fact.body, fact.other) in large]


def _sweeps(milliradians: Sequence[int]) -> bool:
    """Whether angles of one body about another span a part of a turn that counts."""
    return max(milliradians, default=0) - min(milliradians, default=0) >= 1000.0 * LEAST_SWEEP_RAD


def turned_and_gone(
    body: BodyGeometry, since: Sums = FROM_THE_BEGINNING
) -> tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]]:
    """Path [m], rotation [rad] and turn about the vertical [rad] up to each frame."""
    steps = np.linalg.norm(np.diff(body.middles, axis=0), axis=1)
    angles = geometry.angle_between(body.orientations[1:], body.orientations[:-1])
    parts = (steps, angles, spin_steps(body.orientations))
    way, turn, spin = (
        summed(np.nan_to_num(part), since.anchor, known)
        for part, known in zip(parts, since.way(body.name), strict=True)
    )
    return way, turn, spin


def wound(
    body: BodyGeometry, other: BodyGeometry, since: Sums = FROM_THE_BEGINNING
) -> Float[np.ndarray, "frames"]:
    """Unwrapped azimuth of a body about another [rad].

    Nothing is added where it is lost, nor above or below the other, where it goes about nothing.
    """
    offset = body.middles - other.middles
    outside = beyond_shadow(body.middles, *other.boxes) > 0.0
    azimuth = np.arctan2(offset[:, 1], offset[:, 0])
    steps = np.nan_to_num(np.diff(azimuth))
    turns = (steps + np.pi) % (2.0 * np.pi) - np.pi
    known = since.wind(body.name, other.name)
    return summed(np.where(outside[1:] & outside[:-1], turns, 0.0), since.anchor, known)


def sums_at(
    bodies: Iterable[BodyGeometry], others: Iterable[BodyGeometry], frame: int, since: Sums
) -> Sums:
    """What is summed up to a later frame of a window, which becomes the anchor.

    Args:
        bodies: Whose ways count.
        others: What they may go about.
        frame: The frame.
        since: What is known.
    """
    own, about = list(bodies), list(others)
    ways, winds = {}, {}
    for one in own:
        way, turn, spin = turned_and_gone(one, since)
        ways[one.name] = float(way[frame]), float(turn[frame]), float(spin[frame])
        for other in about:
            if other.name != one.name:
                winds[one.name, other.name] = float(wound(one, other, since)[frame])
    return Sums(frame, ways, winds)


def _thousandths(values: Float[np.ndarray, "rows columns"]) -> list[list[int]]:
    """Metres as whole millimetres, radians as milliradians, row by row."""
    rounded: list[list[int]] = np.rint(1000.0 * values).astype(np.int64).tolist()
    return [[_COMMON[n] if 0 <= n < len(_COMMON) else n for n in row] for row in rounded]
