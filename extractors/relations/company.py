"""In whose company objects travel: steady in another body's frame, and how far from it."""

from collections.abc import Iterator, Sequence

import numpy as np
from jaxtyping import Bool, Float

from capar.model import geometry
from capar.model.calibration import Calibration, Found
from capar.model.capture import Capture, Stream, TagType
from capar.model.facts import MovesWith, Travels
from extractors.bodies.bodies import Bodies
from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.co_motion import in_either_frame, steady_in, travelling
from extractors.contact.proximity import distance
from extractors.contact.touch_distances import touchable_at
from extractors.contact.touch_points import TouchPoints
from extractors.relations.arrangement import boxes_apart
from extractors.signals.intervals import (
    FramePredicate,
    Interval,
    first_where,
    intervals,
    last_where,
)
from extractors.thresholds import Thresholds

SAMPLES = 5
"""In how many frames of a stretch the distance of surfaces is measured; the median counts."""


def company(
    capture: Capture, bodies: Bodies, calibration: Calibration, thresholds: Thresholds
) -> Iterator[Travels | MovesWith]:
    """When each mobile object travels, and in whose frame it is steady meanwhile.

    Asked are all sensors but those on parts of an end-effector, and all other mobile objects. A
    stretch is extended to the frames before and after it in which either is no farther from where
    it then was in the other's frame than fingers open about what they let go.
    """
    mobile = [body.name for body in capture.objects if body.tag is TagType.MOBILE]
    carriers = {*mobile, *(sensor.name for sensor in capture.acting)}
    for name in mobile:
        thing = bodies.objects[name]
        travels = travelling(thing.poses.settled, thresholds)
        if not travels.any():
            continue
        for span in _spans(travels, capture, thresholds):
            yield Travels(name, *span)
        wholes = [bodies.sensors[each.name] for each in capture.sensors if not each.part_of]
        others = [*wholes, *(bodies.objects[name] for name in mobile)]
        for other in others:
            if other.name == name or other.poses is thing.poses:
                continue
            parts = bodies.on_end_effector(other.name) if other.name in bodies.parts else (other,)
            reach_m = thresholds.company_reach_m if other.name in carriers else np.inf
            for one, span in _any_together(parts, thing, capture, thresholds):
                near = parts if one is other else (one,)
                gaps = [_gap(part, thing, span, calibration, reach_m) for part in near]
                gap = min(filter(np.isfinite, gaps), default=np.inf)
                if np.isfinite(gap):
                    yield MovesWith(name, other.name, *span, round(1000.0 * gap))


def _any_together(
    parts: Sequence[BodyGeometry], thing: BodyGeometry, capture: Capture, thresholds: Thresholds
) -> Iterator[tuple[BodyGeometry, Interval]]:
    """When a thing is steady in the frame of a hand or of a finger: one finger may carry it."""
    for one in parts:
        for span in _together(one.poses.settled, thing.poses.settled, capture, thresholds):
            yield one, span


def _together(
    carrier: Stream, thing: Stream, capture: Capture, thresholds: Thresholds
) -> list[Interval]:
    frames = steady_in(carrier, thing, thresholds)
    out = frames.copy()
    for first, last in geometry.runs(frames):
        before = last_where(_strays(carrier, thing, first, thresholds.touch_margin_m), first)
        strays = _strays(carrier, thing, last, thresholds.touch_margin_m)
        after = first_where(strays, last, len(out))
        out[0 if before is None else before + 1 : first] = True
        out[last:after] = True
    return _spans(out, capture, thresholds)


def _strays(carrier: Stream, thing: Stream, edge: int, margin_m: float) -> FramePredicate:
    """Whether both of two bodies have left their places at a frame, each in the other's frame."""
    then = in_either_frame(carrier, thing, slice(edge, edge + 1))

    def strays(some: slice) -> Bool[np.ndarray, "some"]:
        places = in_either_frame(carrier, thing, some)
        pairs = zip(places, then, strict=True)
        ways = [np.linalg.norm(place - at_edge, axis=1) for place, at_edge in pairs]
        return ~np.asarray(np.minimum(*ways) <= margin_m)

    return strays


def _spans(
    holds: Bool[np.ndarray, "frames"], capture: Capture, thresholds: Thresholds
) -> list[Interval]:
    dropout_s, minimum_s = thresholds.dropout_s, thresholds.contact_minimum_s
    return intervals(holds, capture.times, dropout_s=dropout_s, minimum_s=minimum_s)


def _gap(
    other: BodyGeometry,
    thing: BodyGeometry,
    span: Interval,
    calibration: Calibration,
    reach_m: float,
) -> float:
    """How much farther apart than where they touch two bodies are in a stretch [m].

    Where their boxes are farther apart than the reach, the distance of the boxes is told, which is
    no more than that of the surfaces.
    """
    some = np.unique(np.linspace(*span, SAMPLES).round().astype(int))
    points, touch_m, pivots = TouchPoints(), 0.0, other.shape is None or thing.shape is None
    for first, second in ((other.name, thing.name), (thing.name, other.name)):
        pair = calibration.sought(first, second)
        if pair is None:
            continue
        touch_m, pivots = pair.touch_m, pair.pivots
        if pair.found is Found.NEVER:
            pivots = True
        one, two = pair.first_point, pair.second_point
        points = TouchPoints(one, two) if first == other.name else TouchPoints(two, one)
        break
    apart: Float[np.ndarray, "frames"]
    if pivots:
        apart = points.apart(other.poses.settled, thing.poses.settled)[some]
    else:
        lost = other.poses.lost[some] | thing.poses.lost[some]
        known = some[~lost]
        apart = boxes_apart(other, thing, known)
        if not known.size or np.median(apart) <= reach_m:
            apart = np.array([_surfaces_apart(other, thing, int(frame)) for frame in known])
    known_m = apart[~np.isnan(apart)]
    return max(0.0, float(np.median(known_m)) - touch_m) if known_m.size else float("nan")


def _surfaces_apart(one: BodyGeometry, other: BodyGeometry, frame: int) -> float:
    """Distance of two bodies' surfaces at a frame [m]."""
    return distance(touchable_at(one, frame), touchable_at(other, frame), 0)
