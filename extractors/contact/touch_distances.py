"""At which distance bodies touch of which one has no surface, estimated from the recording."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np
import trimesh
from jaxtyping import Bool, Float

from capar.model.calibration import Found, PairCalibration
from capar.model.capture import Capture, Role, Shape, ShapeSource, TagType
from extractors.bodies.bodies import Bodies
from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.proximity import Body, at_frame, body, distance
from extractors.contact.surfaces import Surface, surface
from extractors.contact.touch_evidence import HAND, Evidence
from extractors.contact.touch_points import TouchPoints, touch_points
from extractors.thresholds import Thresholds

SAMPLES = 100
"""In how many frames at most distances to a surface are measured for an estimate."""

GAP_SAMPLES = 15
"""In how many frames at most a gap between surfaces is measured, of which the median counts."""

POINT_M = 0.0005
"""Radius of the ball that stands for a body's origin [m]: far less than any distance of touch."""


def estimated_pair(
    capture: Capture,
    first: BodyGeometry,
    second: BodyGeometry,
    evidence: Evidence,
    tolerance_m: float,
) -> PairCalibration:
    """At which distance two bodies touch, one of which has no surface.

    Args:
        capture: The trial.
        first: An end-effector, or a mobile object.
        second: An object.
        evidence: What the bodies do to each other.
        tolerance_m: What is added to where a thing rests on a support [m].
    """
    limits = evidence.thresholds
    for found, frames in _witnesses(capture, first.name, second.name, evidence):
        if frames.any():
            margin = tolerance_m if found is Found.REST else limits.touch_margin_m
            return _pair(first, second, found, frames, margin, limits)
    return PairCalibration(first.name, second.name, 0.0, 0.0, pivots=True, found=Found.NEVER)


def stated_pair(
    capture: Capture,
    first: BodyGeometry,
    second: BodyGeometry,
    evidence: Evidence,
    distance_m: float,
) -> PairCalibration:
    """A distance of origins that the capture states, and what the recording shows against it.

    It is contradicted where it is less than the distance in most frames of sure contact, or more
    than that by twice the margin of an estimate.
    """
    taken = PairCalibration(
        first.name, second.name, distance_m, distance_m, pivots=True, found=Found.STATED
    )
    limits = evidence.thresholds
    for _, frames in _witnesses(capture, first.name, second.name, evidence):
        if frames.any():
            apart = TouchPoints().apart(first.poses.settled, second.poses.settled)[frames]
            far_m = float(np.quantile(apart, limits.touch_quantile))
            fits = far_m <= distance_m <= far_m + 2.0 * limits.touch_margin_m
            shown_m = None if fits else far_m + limits.touch_margin_m
            return replace(taken, frames=int(frames.sum()), shown_m=shown_m)
    return taken


def with_gaps(
    pairs: Iterable[PairCalibration], bodies: Bodies, evidence: Evidence
) -> Iterator[PairCalibration]:
    """Pairs of surfaces with the gap at which one steadily carries the other, if it has one.

    Of all the end-effectors that move as one with an object it is the nearest that carries it;
    if it touches the object within the distance of release there is no gap.
    """
    known = list(pairs)
    gaps: dict[tuple[str, str], float] = {}
    for pair in known:
        frames = evidence.carried.get((pair.first, pair.second))
        if pair.found is Found.TOLERANCE and frames is not None:
            thing = bodies.objects[pair.second]
            apart = [
                _surface_distances(part, thing, frames, GAP_SAMPLES)
                for part in bodies.on_end_effector(pair.first)
                if part.shape is not None
            ]
            gaps[pair.first, pair.second] = float(np.median(np.min(apart, axis=0)))
    for pair in known:
        rivals = [gap for (_, thing), gap in gaps.items() if thing == pair.second]
        gap_m = gaps.get((pair.first, pair.second), 0.0)
        if pair.release_m < gap_m <= evidence.thresholds.settle_reach_m and gap_m == min(rivals):
            count = int(evidence.carried[pair.first, pair.second].sum())
            yield replace(pair, frames=count, shown_m=gap_m)
        else:
            yield pair


def _witnesses(
    capture: Capture, first: str, second: str, evidence: Evidence
) -> Iterator[tuple[Found, Bool[np.ndarray, "frames"]]]:
    """Kinds of evidence for a pair, the surest first."""
    nowhere = np.zeros(len(capture.times), dtype=bool)
    acting = {each.name: each.end_effector for each in capture.sensors if each.role is Role.ACTS}
    tags = {each.name: each.tag for each in capture.objects}
    if first in acting:
        yield Found.CO_MOTION, evidence.carried.get((first, second), nowhere)
        if acting[first] == HAND:
            yield Found.SETTLING, evidence.settled(first).get(second, nowhere)
        return
    for one, other in ((first, second), (second, first)):
        if tags[one] is TagType.MOBILE and tags[other] is TagType.FIXED:
            yield Found.REST, evidence.unheld_rest(one)
        elif tags[one] is TagType.MOBILE:
            yield Found.SETTLING, evidence.dwelling(one).get(other, nowhere)


def _pair(
    first: BodyGeometry,
    second: BodyGeometry,
    found: Found,
    frames: Bool[np.ndarray, "frames"],
    margin_m: float,
    thresholds: Thresholds,
) -> PairCalibration:
    points = TouchPoints()
    surfaces = first.shape is not None or second.shape is not None
    if not surfaces:
        points = touch_points(first.poses.settled, second.poses.settled, frames, thresholds)
        apart = points.apart(first.poses.settled, second.poses.settled)[frames]
    else:
        apart = _surface_distances(first, second, frames, SAMPLES)
    touch_m = float(np.quantile(apart, thresholds.touch_quantile)) + margin_m
    return PairCalibration(
        first.name,
        second.name,
        touch_m,
        touch_m,
        pivots=not surfaces,
        found=found,
        frames=int(frames.sum()),
        first_point=points.first,
        second_point=points.second,
    )


def _surface_distances(
    first: BodyGeometry, second: BodyGeometry, frames: Bool[np.ndarray, "frames"], most: int
) -> Float[np.ndarray, "some"]:
    """How far two bodies are apart in some of the frames [m]; a body without shape is a point."""
    every = np.flatnonzero(frames)
    some = every[np.linspace(0, len(every) - 1, min(most, len(every))).round().astype(int)]
    one, two = touchable(first), touchable(second)
    return np.array([distance(one, two, int(frame)) for frame in some])


def touchable(each: BodyGeometry) -> Body:
    """The surface of a body at its poses; of one without a shape, a speck at its origin."""
    if each not in _TOUCHABLE:
        _TOUCHABLE[each] = body(_surface(each), each.poses.settled, rests=each.poses.rests)
    return _TOUCHABLE[each]


def forget_touchable(bodies: Iterable[BodyGeometry]) -> None:
    """Keep the surfaces of some bodies at their poses no longer: they are made again when asked."""
    for body_geometry in bodies:
        _TOUCHABLE.pop(body_geometry, None)


def touchable_at(each: BodyGeometry, frame: int) -> Body:
    """The same at one frame, which is its frame 0."""
    return at_frame(_surface(each), each.poses.settled, frame)


def _surface(each: BodyGeometry) -> Surface:
    return surface(_SPECK if each.shape is None else each.shape)


def _speck() -> Shape:
    ball = trimesh.creation.icosphere(subdivisions=0, radius=POINT_M)
    return Shape(np.asarray(ball.vertices), np.asarray(ball.faces), ShapeSource.STAND_IN, "a point")


_SPECK = _speck()

_TOUCHABLE: WeakKeyDictionary[BodyGeometry, Body] = WeakKeyDictionary()
"""Of bodies that were asked for before: each is in many pairs."""
