"""All faults that a recording shows by itself, as notices with the likely remedy."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.capture import UNITS, Capture, Conventions, Sensor, TagType
from capar.model.notices import Notice, notice
from extractors.bodies.bodies import Bodies, BodyGeometry
from extractors.bodies.poses import rotation_matrices
from extractors.contact.contacts import Contact
from extractors.faults.gravity import gravity_notices, unit_name
from extractors.signals.intervals import Interval, mask
from extractors.thresholds import Thresholds

TRUNK = ("head", "neck", "chest", "torso", "spine", "pelvis")
"""End-effectors of the trunk, in which a person's size shows with a hand or a foot."""

LIMBS = ("hand", "foot")

NEAR = 2.5
"""A length is one of a person's if it is nearer to the usual one than by this factor [1]."""

UP = np.array([0.0, 0.0, 1.0])


def faults(
    capture: Capture,
    bodies: Bodies,
    touches: Sequence[Contact],
    motions: Mapping[str, list[Interval]],
    thresholds: Thresholds,
) -> Iterator[Notice]:
    """Notices of what cannot be: falls, rests, sizes and sides that contradict what was declared.

    A fall shows axis and unit exactly; rests and sizes are asked only where no fall does.

    ``touches``: who touches whom, and when. ``motions``: when each object moves.
    """
    if not capture.acting:
        yield Notice("nothing-acts")
    # Whether sensors on trunk and limbs show that people have the size of people.
    shown = [each for each in reaches(capture, thresholds) if each.least_m]
    most = thresholds.person_most_m
    sized = bool(shown) and all(each.least_m <= each.largest_m <= most for each in shown)
    falls = list(gravity_notices(capture, bodies, thresholds, sized=sized))
    yield from falls
    if not any(each.code == "up-contradicted" for each in falls):
        yield from rest_notices(capture, bodies, touches, motions, thresholds)
    if not any(each.code == "unit-contradicted" for each in falls):
        yield from size_notices(capture, thresholds)
    yield from shape_notices(capture, thresholds)
    yield from side_notices(capture, thresholds)


@dataclass(frozen=True, slots=True)
class Reach:
    """How far two sensors of one person come apart."""

    first: str
    second: str
    largest_m: float
    at_s: float
    least_m: float
    """A person of any size has more; zero where nothing is known."""


def reaches(capture: Capture, thresholds: Thresholds) -> list[Reach]:
    """The largest distance of each two sensors of a person through a recording, by name."""
    found = []
    for first, second in combinations(capture.sensors, 2):
        apart = geometry.lengths(first.stream.positions - second.stream.positions)
        if capture.agent_of(first) != capture.agent_of(second) or np.isnan(apart).all():
            continue
        kinds, least = {first.end_effector, second.end_effector}, 0.0
        if kinds & set(TRUNK) and kinds & set(LIMBS):
            standing = "head" in kinds and "foot" in kinds
            least = thresholds.head_to_foot_m if standing else thresholds.trunk_to_limb_m
        frame = int(np.nanargmax(apart))
        at_s = float(capture.times[frame])
        found.append(Reach(first.name, second.name, float(apart[frame]), at_s, least))
    return found


def size_notices(capture: Capture, thresholds: Thresholds) -> Iterator[Notice]:
    """A notice if people are too small or too large, or each sensor alone is too fast."""
    found = reaches(capture, thresholds)
    wrong = [
        each
        for each in found
        if each.largest_m > thresholds.person_most_m or each.largest_m < each.least_m
    ]
    if wrong:
        worst = max(wrong, key=lambda each: each.largest_m)
        how = capture.conventions.get(worst.first, Conventions())
        usual = thresholds.head_to_foot_usual_m
        if worst.least_m != thresholds.head_to_foot_m:
            usual = thresholds.trunk_to_limb_usual_m
        yield notice(
            "unit-contradicted", worst.first, worst.second, start_s=worst.at_s, end_s=worst.at_s,
            shown="person", size_m=float(f"{worst.largest_m:.3g}"),
            unit=likely_unit(worst.largest_m / how.unit_m, usual), declared=unit_name(how),
        )  # fmt: skip
    for sensor in () if found else capture.sensors:
        # A sensor alone that is faster than any hand for a good part of the time.
        steps = geometry.lengths(np.diff(sensor.stream.positions, axis=0))
        speeds = steps / np.diff(capture.times)
        fast = (
            np.nan if np.isnan(speeds).all() else np.nanquantile(speeds, thresholds.speed_quantile)
        )
        if fast > thresholds.hand_most_mps:
            how = capture.conventions.get(sensor.name, Conventions())
            unit = likely_unit(float(fast) / how.unit_m, thresholds.hand_usual_mps)
            yield notice(
                "unit-contradicted", sensor.name, shown="speed", unit=unit,
                declared=unit_name(how), speed_mps=float(f"{fast:.3g}"),
            )  # fmt: skip


def likely_unit(length: float, usual_m: float) -> str:
    """The unit in which a length is nearest to a usual one; m, cm and mm before others.

    ``length``: in the unknown unit. ``usual_m``: what it usually is [m].
    """
    off = {name: abs(np.log(length * metres / usual_m)) for name, metres in UNITS.items()}
    common = min(("m", "cm", "mm"), key=off.__getitem__)
    return common if off[common] < np.log(NEAR) else min(off, key=off.__getitem__)


def shape_notices(capture: Capture, thresholds: Thresholds) -> Iterator[Notice]:
    """Mobile objects whose shapes nobody could handle or see."""
    for thing in capture.objects:
        if thing.tag is not TagType.MOBILE or thing.shape is None:
            continue
        size = float(thing.shape.size.max())
        if not thresholds.thing_least_m <= size <= thresholds.thing_most_m:
            yield notice(
                "shape-size", thing.name, size_m=float(f"{size:.3g}"),
                unit=likely_unit(size, thresholds.thing_usual_m),
                shape=thing.shape.description,
            )  # fmt: skip


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
    persons = {each.name for each in capture.sensors}
    persons |= {each.name for each in capture.objects if each.tag is TagType.SELF}
    # In which frames it touches each other thing; under no name, the body of a person.
    spans: dict[str, list[Interval]] = {"": []}
    for touch in touches:
        if name in (touch.first, touch.second):
            other = touch.second if touch.first == name else touch.first
            spans.setdefault("" if other in persons else other, []).append(touch.interval)
    met = {other: mask(found, len(capture.times)) for other, found in spans.items()}
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


def side_notices(capture: Capture, thresholds: Thresholds) -> Iterator[Notice]:
    """A notice for each person whose pairs of right and left are exchanged nearly always.

    It may be the names, the declared direction of sight, or a world that is a mirror image.
    """
    for head in capture.sensors:
        if head.end_effector != "head":
            continue
        own = [each for each in capture.sensors if capture.agent_of(each) == capture.agent_of(head)]
        left_of = {each.end_effector: each for each in reversed(own) if each.side == "left"}
        votes = [
            (right, left, _sides(head, right, left, thresholds))
            for right in own
            if right.side == "right" and (left := left_of.get(right.end_effector))
        ]
        exchanged = sum(int((sides < 0.0).sum()) for *_, sides in votes)
        shown = sum(len(sides) for *_, sides in votes)
        least = thresholds.shown_share * len(capture.times)
        if shown and shown >= least and exchanged >= thresholds.exchanged_share * shown:
            right, left, _ = max(votes, key=lambda vote: len(vote[2]))
            share = round(exchanged / shown, 3)
            yield notice("sides-exchanged", right.name, left.name, head.name, share=share)


def _sides(
    head: Sensor, right: Sensor, left: Sensor, thresholds: Thresholds
) -> Float[np.ndarray, "some"]:
    """How far the right one is on the right of the left one in the frames that show it [m]."""
    ahead = rotation_matrices(head.stream.orientations) @ np.asarray(head.gaze)
    rightward = np.cross(ahead / np.linalg.norm(head.gaze), UP)
    level = geometry.lengths(rightward)
    apart = right.stream.positions - left.stream.positions
    with np.errstate(invalid="ignore", divide="ignore"):
        aside = np.einsum("ij,ij->i", apart, rightward) / level
        wide = np.abs(aside) > thresholds.apart_share * geometry.lengths(apart)
        return np.asarray(aside[wide & (level > thresholds.level_gaze)])
