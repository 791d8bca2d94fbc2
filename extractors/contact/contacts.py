"""Which bodies touch, from which frame to which, at every frame of a capture (thesis 3.2)."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from capar.model import geometry
from capar.model.calibration import Calibration, Found, PairCalibration
from capar.model.capture import Capture, PivotContact, TagType
from extractors.bodies.bodies import Bodies
from extractors.bodies.body_geometry import BodyGeometry
from extractors.bodies.poses import Poses
from extractors.contact.earlier_answers import EarlierAnswers
from extractors.contact.footing import gliding, soles
from extractors.contact.own_hands import counted_meetings
from extractors.contact.passing import in_passing
from extractors.contact.proximity import Body, distance, near
from extractors.contact.screening import screened
from extractors.contact.touch_distances import (
    estimated_pair,
    stated_pair,
    touchable,
    with_gaps,
)
from extractors.contact.touch_evidence import Evidence
from extractors.contact.touch_points import TouchPoints
from extractors.signals.clock import frame_rate
from extractors.signals.filters import gains
from extractors.signals.intervals import Interval, intervals, mask
from extractors.thresholds import Thresholds


@dataclass(frozen=True, slots=True)
class Contact:
    """Two bodies that touch through a closed interval of frames; an end-effector is first."""

    first: str
    second: str
    interval: Interval
    gap_m: float
    """How far they are apart at its first frame [m]; zero where they cut each other."""

    lingers: bool = False
    """Whether they have stayed near each other since, up to the last frame: if they touch again
    before they part, the contact lasts."""


def contact_tolerance(capture: Capture, bodies: Bodies, thresholds: Thresholds) -> float:
    """Distance up to which bodies count as touching [m].

    The capture's own, else three deviations of the noisiest acting sensor, between 5 and 10 mm.
    """
    if capture.contact_tolerance_m is not None:
        return capture.contact_tolerance_m
    noises_m = [bodies.sensors[each.name].poses.noise.position_m for each in capture.acting]
    noise = max(noises_m, default=0.0)
    wide = thresholds.tolerance_sigmas * noise
    return min(max(wide, thresholds.tolerance_least_m), thresholds.tolerance_most_m)


def pair_distances(
    capture: Capture, bodies: Bodies, tolerance_m: float, thresholds: Thresholds
) -> Iterator[PairCalibration]:
    """At which distances each pair that is watched begins and ceases to touch.

    Where the capture states none and one of the two has no surface, the recording tells.

    Args:
        capture: The trial.
        bodies: Its bodies.
        tolerance_m: Distance up to which surfaces count as touching [m].
        thresholds: How much noise between two frames of contact is allowed for.
    """
    evidence = Evidence(capture, bodies, thresholds)
    found = _pair_distances(capture, bodies, tolerance_m, evidence)
    yield from with_gaps(found, bodies, evidence)


def _pair_distances(
    capture: Capture, bodies: Bodies, tolerance_m: float, evidence: Evidence
) -> Iterator[PairCalibration]:
    thresholds = evidence.thresholds
    for first, second in watched(capture, bodies):
        pivot = _pivot(capture, first.name, second.name)
        if pivot is not None:
            yield stated_pair(capture, first, second, evidence, pivot.distance_m)
        elif first.shape is None or second.shape is None:
            yield estimated_pair(capture, first, second, evidence, tolerance_m)
        elif first.shape is not None and second.shape is not None:
            margin = _margin(first.poses, second.poses, frame_rate(capture.times), thresholds)
            release = tolerance_m + min(margin, tolerance_m)
            yield PairCalibration(first.name, second.name, tolerance_m, release)


def contacts(
    capture: Capture,
    bodies: Bodies,
    calibration: Calibration,
    limits: Thresholds,
    answers: EarlierAnswers | None = None,
) -> tuple[Contact, ...]:
    """Every contact that is watched for: acting sensors and mobile objects with tag objects.

    What merely brushes past is none, nor is a foot that glides over the ground fast.

    A contact that is there before and after a body was lost is taken to last in between, however
    long; one that is there on one side alone ends, or begins, where the body was last, or first,
    seen (spec 3).

    Args:
        capture: The trial.
        bodies: Its bodies.
        calibration: Distances of contact, and least durations of contacts and interruptions.
        limits: What brushes past.
        answers: What was answered in the window before, where the capture is one of several.
    """
    surfaces = {each: touchable(each) for pair in watched(capture, bodies) for each in pair}
    found: list[Contact] = []
    feet = soles(capture)
    for first, second in watched(capture, bodies):
        one, two = surfaces[first], surfaces[second]
        pair = calibration.pair(first.name, second.name)
        if pair.found is Found.NEVER:
            continue
        near_by = np.zeros(len(capture.times), dtype=bool)
        if pair.pivots:
            apart = points_apart(pair, first, second)
            touching = np.nan_to_num(apart, nan=np.inf) <= pair.touch_m
        else:
            names = first.name, second.name
            touching = _near(names, one, two, pair.touch_m, answers)
            if pair.release_m > pair.touch_m and touching.any():
                near_by = _near(names, one, two, pair.release_m, answers)
                edge = round(calibration.contact_dropout_s * frame_rate(capture.times))
                touching = bridged(touching, near_by, edge=edge)
        # Where a body was lost nothing begins or ends: what touched before and after has touched.
        touching = bridged(touching, first.poses.lost | second.poses.lost)
        if first.name in feet and second.poses.fixed is not None and touching.any():
            ground_mps = calibration.ground_velocity(feet[first.name], second.name)
            touching &= ~gliding(first, second, limits, ground_mps)
        for interval in intervals(
            touching,
            capture.times,
            dropout_s=calibration.contact_dropout_s,
            minimum_s=calibration.contact_minimum_s,
        ):
            if in_passing(first, second, interval, limits):
                continue
            if pair.pivots:
                gap = float(points_apart(pair, first, second)[interval[0]])
            else:
                gap = distance(one, two, interval[0])
            lingers = interval[1] + 1 < len(near_by) and bool(near_by[interval[1] + 1 :].all())
            found.append(Contact(first.name, second.name, interval, gap, lingers=lingers))
    direct = tuple(_direct(capture, found, surfaces, calibration))
    whole = tuple(of_end_effectors(capture, direct, calibration))
    met = [(each.first, each.second, each.interval) for each in whole]
    counted = counted_meetings(capture, bodies, met, limits)
    return tuple(each for each, counts in zip(whole, counted, strict=True) if counts)


def _near(
    names: tuple[str, str],
    one: Body,
    two: Body,
    distance_m: float,
    answers: EarlierAnswers | None,
) -> Bool[np.ndarray, "frames"]:
    if answers is None:
        return near(one, two, distance_m=distance_m)
    return answers.near(names, one, two, distance_m=distance_m)


def of_end_effectors(
    capture: Capture, found: Iterable[Contact], calibration: Calibration
) -> Iterator[Contact]:
    """Contacts with those of the parts of an end-effector as its own: it touches where any does."""
    wholes = {each.name: each.part_of for each in capture.sensors if each.part_of}
    several: dict[tuple[str, str], list[Contact]] = {}
    for contact in found:
        whole = wholes.get(contact.first, contact.first)
        if whole in wholes.values():
            several.setdefault((whole, contact.second), []).append(contact)
        else:
            yield contact
    for (whole, other), parts in several.items():
        touching = mask([each.interval for each in parts], len(capture.times))
        dropout_s = calibration.contact_dropout_s
        for interval in intervals(touching, capture.times, dropout_s=dropout_s, minimum_s=0.0):
            gap_m = min(each.gap_m for each in parts if each.interval[0] == interval[0])
            yield Contact(whole, other, interval, gap_m)


def _direct(
    capture: Capture,
    found: list[Contact],
    surfaces: Mapping[BodyGeometry, Body | None],
    calibration: Calibration,
) -> Iterator[Contact]:
    """The contacts without the stretches in which a mobile object is between the two."""
    mobile = [each.name for each in capture.objects if each.tag is TagType.MOBILE]
    bodies = {each.name: shape for each, shape in surfaces.items() if shape is not None}
    met = [(each.first, each.second, each.interval) for each in found]
    reach_m = calibration.contact_tolerance_m
    hidden = screened(met, bodies, mobile, reach_m=reach_m)
    for contact, parts in zip(found, hidden, strict=True):
        if not parts:
            yield contact
            continue
        count = len(capture.times)
        holds = mask([contact.interval], count) & ~mask(list(parts), count)
        for interval in intervals(
            holds, capture.times, dropout_s=0.0, minimum_s=calibration.contact_minimum_s
        ):
            yield replace(contact, interval=interval)


def watched(capture: Capture, bodies: Bodies) -> Iterator[tuple[BodyGeometry, BodyGeometry]]:
    """Pairs of bodies whose contact matters, each once.

    Each acting sensor with each tag object but itself; each mobile object with each other tag
    object. Of an object that is also an acting sensor both are watched: it may be handled too. The
    parts of an end-effector are watched as it is, if they have shapes or a stated distance.
    """
    for sensor in capture.acting:
        own = capture.parts_of(sensor.name)
        for part in own:
            for each in capture.objects:
                if each.name in {one.name for one in own}:
                    continue
                if not part.part_of or part.shape or _pivot(capture, part.name, each.name):
                    yield bodies.sensors[part.name], bodies.objects[each.name]
    mobile = sorted(thing.name for thing in capture.objects if thing.tag is TagType.MOBILE)
    for name in mobile:
        for thing in sorted(capture.objects, key=lambda other: other.name):
            if thing.name != name and not (thing.tag is TagType.MOBILE and thing.name < name):
                yield bodies.objects[name], bodies.objects[thing.name]


def bridged(
    touching: Bool[np.ndarray, "frames"], near_by: Bool[np.ndarray, "frames"], *, edge: int = 0
) -> Bool[np.ndarray, "frames"]:
    """Contact that also lasts between two of its frames if the bodies stay near by throughout.

    Args:
        touching: Whether they touch, at each frame.
        near_by: Whether they are near by.
        edge: An interruption of fewer frames than so many that the recording's begin or end cuts
            off counts as one between two frames of contact: nobody sees that it lasts, and a
            filter takes least noise away there.
    """
    out = touching.copy()
    for first, last in geometry.runs(near_by | touching):
        inside = first + np.flatnonzero(touching[first : last + 1])
        if inside.size:
            begin = 0 if first == 0 and inside[0] < edge else inside[0]
            cut_off = last == len(out) - 1 and last - inside[-1] < edge
            out[begin : (last if cut_off else inside[-1]) + 1] = True
    return out


def _margin(first: Poses, second: Poses, rate_hz: float, thresholds: Thresholds) -> float:
    """Room for what noise is left in the distance of two bodies [m]; none for quiet ones."""
    noises = [each.noise.position_m for each in (first, second) if not each.rests]
    noisy = [each for each in noises if each > thresholds.smoothing_noise_m]
    left = thresholds.release_sigmas * gains(rate_hz, thresholds)[0]
    return left * float(np.linalg.norm(noisy)) if noisy else 0.0


def _pivot(capture: Capture, first: str, second: str) -> PivotContact | None:
    for pivot in capture.pivot_contacts:
        if {pivot.first, pivot.second} == {first, second}:
            return pivot
    return None


def points_apart(
    pair: PairCalibration, first: BodyGeometry, second: BodyGeometry
) -> Float[np.ndarray, "frames"]:
    """Distance of the points by which two bodies touch [m]; NaN where either is lost."""
    points = TouchPoints(pair.first_point, pair.second_point)
    return points.apart(first.poses.settled, second.poses.settled)
