"""Things that rest under or beside what should bear them: the sign of a wrong upward axis."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from capar.model import geometry
from capar.model.capture import Capture, Conventions, TagType
from capar.model.notices import Notice, notice
from extractors.bodies.bodies import Bodies, BodyGeometry
from extractors.contact.contacts import Contact
from extractors.signals.intervals import Interval, mask
from extractors.thresholds import Thresholds


@dataclass(frozen=True, eq=False)
class Rest:
    """A stay of a thing that nobody holds, against one other body."""

    thing: str
    other: str
    interval: Interval
    toward: Float[np.ndarray, "3"]
    """From the other body to the thing, along an axis of the world."""

    height_m: float


def rest_notices(
    capture: Capture,
    bodies: Bodies,
    touches: Sequence[Contact],
    motions: Mapping[str, list[Interval]],
    thresholds: Thresholds,
) -> Iterator[Notice]:
    """A notice if things that are moved by hand rest against other bodies, and none on one.

    Under another body one rest is enough, of a thing that is moved; a lamp or a picture is not.
    Beside another body it takes several rests against one side at different heights: what leans
    on a wall stands on one floor.
    """
    rests = [
        rest
        for thing in capture.objects
        if thing.tag is TagType.MOBILE and motions.get(thing.name)
        for rest in _rests(capture, bodies, thing.name, touches, motions[thing.name], thresholds)
    ]
    if not rests or any(rest.toward[2] > 0.0 for rest in rests):
        return
    counts = Counter(tuple(map(float, rest.toward)) for rest in rests)
    common, count = counts.most_common(1)[0]
    rests = [rest for rest in rests if tuple(map(float, rest.toward)) == common]
    if count < thresholds.rest_share * counts.total():
        return
    under = common[2] < 0.0
    heights = [rest.height_m for rest in rests]
    if not under and (len(rests) < 2 or np.ptp(heights) < thresholds.level_apart_m):
        return
    rest = max(rests, key=lambda each: each.interval[1] - each.interval[0])
    how = capture.conventions.get(rest.thing, Conventions())
    yield notice(
        "up-contradicted",
        rest.thing,
        rest.other,
        start_s=float(capture.times[rest.interval[0]]),
        end_s=float(capture.times[rest.interval[1]]),
        shown="rest",
        where="under" if under else "at the side of",
        up=how.axis(rest.toward) or "",
        declared=how.up,
    )


def _rests(
    capture: Capture,
    bodies: Bodies,
    name: str,
    touches: Sequence[Contact],
    motions: list[Interval],
    thresholds: Thresholds,
) -> Iterator[Rest]:
    """Each long stay of a thing against each body that it touches meanwhile; none if it is held."""
    thing = bodies.objects[name]
    if thing.shape is None:
        return
    met = _met(capture, name, touches)
    known = ~mask(motions, len(capture.times)) & ~thing.poses.lost
    for first, last in geometry.runs(known & ~met.pop("")):
        if capture.times[last] - capture.times[first] < thresholds.long_rest_s:
            continue
        middle = (first + last) // 2
        for other, meeting in met.items():
            toward = _toward(thing, bodies.named(other), middle, thresholds)
            through = bool(meeting[first : last + 1].all())
            if toward is not None and (through or (toward[2] > 0.0 and meeting[middle])):
                height_m = float(thing.middles[middle, 2])
                yield Rest(name, other, (first, last), toward, height_m)


def _met(
    capture: Capture, name: str, touches: Sequence[Contact]
) -> dict[str, Bool[np.ndarray, "frames"]]:
    """In which frames a thing touches each other one; under no name, the body of a person."""
    persons = {each.name for each in capture.sensors}
    persons |= {each.name for each in capture.objects if each.tag is TagType.SELF}
    met = {"": np.zeros(len(capture.times), dtype=bool)}
    for touch in touches:
        if name in (touch.first, touch.second):
            other = touch.second if touch.first == name else touch.first
            key = "" if other in persons else other
            first, last = touch.interval
            met.setdefault(key, np.zeros(len(capture.times), dtype=bool))[first : last + 1] = True
    return met


def _toward(
    thing: BodyGeometry, other: BodyGeometry, frame: int, thresholds: Thresholds
) -> Float[np.ndarray, "3"] | None:
    """The axis along which a thing is beyond another's box; upward where it is inside of it."""
    (low, high), (floor, top) = thing.boxes, other.boxes
    gaps = np.concatenate([low[frame] - top[frame], floor[frame] - high[frame]])
    if np.isnan(gaps).any():
        return None
    best = int(np.argmax(gaps))
    if gaps[best] < -thresholds.box_overlap_m:
        return np.array([0.0, 0.0, 1.0])
    return np.eye(3)[best % 3] * (1.0 if best < 3 else -1.0)
