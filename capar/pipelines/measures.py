"""The quantities of explanations over time, as extractors measured them, with their limits."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

from capar.model.body_names import body_names
from capar.model.calibration import Found, PairCalibration
from capar.model.facts import (
    ContactNormal,
    Leans,
    Lies,
    Moving,
    Observed,
    Opening,
    Resting,
    Swings,
    Touching,
)
from capar.model.geometry import from_mean, from_middle
from capar.model.observation import Observation
from capar_rules.explain.conditions import Condition, Measured
from capar_rules.explain.quantities import QUANTITIES
from extractors.bodies.bodies import BodyGeometry
from extractors.calibration import thresholds_of
from extractors.contact.contacts import points_apart
from extractors.contact.normals import contact_normal
from extractors.contact.proximity import separation
from extractors.contact.touch_distances import touchable
from extractors.measure import Measurements
from extractors.motion.impacts import closing_speed
from extractors.motion.object_motion import paces
from extractors.motion.phases import lean, most_turns, spin_steps
from extractors.relations.arrangement import Pair
from extractors.relations.places import turned_and_gone
from extractors.signals.intervals import frame_rate

MILLI = 1000.0

HALF_RIGHT_MRAD = 1000.0 * math.pi / 4.0
"""A body within this angle of a direction goes that way [1/1000 rad]: rules compare squares."""

Frames = Int[np.ndarray, "some"]
Values = Float[np.ndarray, "some"]
Displacement = Float[np.ndarray, "frames 3"]


@dataclass(frozen=True, eq=False)
class Series:
    """A quantity at frames of a recording, in the unit of rules.

    Attributes:
        values: NaN where a body was lost.
        limits: The limits that extractors compare it with.
        bars: First and last frames between which a fact about it holds.
        held: What holds there.
        most: Whether the greatest value of an interval counts, and not its last one.
    """

    frames: Frames
    values: Values
    limits: tuple[float, ...] = ()
    bars: tuple[tuple[int, int], ...] = ()
    held: str = ""
    most: bool = False

    def frame(self, first: int, last: int) -> int:
        """The frame of an interval whose value counts; the last one if none is known."""
        inside = (self.frames >= first) & (self.frames <= last) & ~np.isnan(self.values)
        if not inside.any():
            return last
        known = self.frames[inside]
        return int(known[np.argmax(self.values[inside])] if self.most else known[-1])

    def within(self, first: int, last: int) -> float | None:
        """The value that counts of an interval; None if it is not known."""
        values = self.values[self.frames == self.frame(first, last)]
        return float(values[0]) if len(values) and not np.isnan(values[0]) else None


@dataclass(frozen=True, eq=False)
class Measures:
    """What was measured of a capture, for each quantity of explanations."""

    observation: Observation
    measurements: Measurements

    @cached_property
    def names(self) -> dict[str, str]:
        """What bodies are called where that is not their name."""
        return body_names(self.observation)

    def completed(self, condition: Condition) -> Condition:
        """A condition with the values that extractors compared, and no rule."""
        known = tuple(filter(None, map(self._completed, condition.measures)))
        return replace(condition, measures=known)

    def _completed(self, asked: Measured) -> Measured | None:
        if asked.value is not None:
            return asked
        if "_" in asked.bodies:  # a rule asks for any body
            return None
        found = self._valued(asked)
        if found is not None and asked.quantity == "motion" and not found.holds:
            turning, (name,) = QUANTITIES["turning"], asked.bodies
            label = turning.label.format(self.names.get(name, name.replace("_", " ")))
            turned = replace(asked, quantity="turning", label=label, unit=turning.unit)
            other = self._valued(turned)
            return other if other is not None and other.holds else found
        return found

    def _valued(self, asked: Measured) -> Measured | None:
        frames = np.unique([asked.first, asked.last])
        series = self.series(asked, frames if asked.quantity == "distance" else None)
        value = None if series is None else series.within(asked.first, asked.last)
        if series is None or value is None or not math.isfinite(value):
            return None
        scale = QUANTITIES[asked.quantity].scale
        limits = series.limits
        limit = (min if asked.relation == ">" else max)(limits) * scale if limits else None
        return replace(asked, value=value * scale, limit=limit)

    def series(self, asked: Measured, frames: Frames | None = None) -> Series | None:
        """A quantity over time; None if it is none."""
        every = np.arange(self.observation.frames) if frames is None else frames
        make, of_path = SERIES.get(asked.quantity), OF_PATHS.get(asked.quantity)
        with np.errstate(invalid="ignore"):
            if of_path is None:
                return make and make(self, asked, every)
            middles = self.body(asked.bodies[0]).middles
            measured, unit = of_path
            return Series(every, unit * measured(middles - middles[asked.first])[every])

    def body(self, name: str) -> BodyGeometry:
        """The object of a name, or else the sensor."""
        return self.measurements.bodies.named(name)

    def bars(self, kind: type[Observed], **about: str) -> tuple[tuple[int, int], ...]:
        """First and last frames between which facts of a kind about certain bodies hold."""
        return tuple(
            (fact.ends()[0], fact.ends()[-1])
            for fact in self.observation.facts
            if isinstance(fact, kind)
            and all(getattr(fact, name) == value for name, value in about.items())
        )


def _sum(known: Measures, asked: Measured, frames: Frames) -> Series:
    """A quantity that adds up from frame to frame: path, rotation, or turn about the vertical."""
    body = known.body(asked.bodies[0])
    if asked.quantity == "turn":
        summed = np.cumsum([0.0, *np.nan_to_num(spin_steps(body.orientations))])
        return Series(frames, MILLI * np.abs(summed - summed[asked.first])[frames])
    summed = turned_and_gone(body)[asked.quantity == "turned"]
    return Series(frames, MILLI * (summed - summed[asked.first])[frames])


def _lean(known: Measures, asked: Measured, frames: Frames) -> Series:
    name = asked.bodies[0]
    calibration = known.measurements.calibration
    angle = lean(known.body(name).orientations, np.array(calibration.body(name).upright))
    if asked.quantity == "leaning":
        return Series(frames, MILLI * np.abs(angle - angle[asked.first])[frames])
    limit = MILLI * thresholds_of(calibration).lean_rad
    bars = known.bars(Leans, object=name)
    return Series(frames, MILLI * angle[frames], (limit,), bars, "leaning far over", most=True)


def _motion(known: Measures, asked: Measured, frames: Frames) -> Series:
    """How far a body is from its middle place or mean orientation, and the floor of its motion.

    The middle is that of the whole motion which an interval has a part of.
    """
    (name,) = asked.bodies
    body, ends = known.body(name), [asked.first, asked.last]
    floors = known.measurements.calibration.body(name)
    if name in known.measurements.bodies.objects:
        bars, held = known.bars(Moving, object=name), "moving"
        if asked.relation == ">":  # it moves
            ends += [end for bar in bars if bar[0] < ends[1] and bar[1] > ends[0] for end in bar]
    else:
        bars, held = known.bars(Resting, ee=name), "resting"
    interval = slice(min(ends), max(ends) + 1)
    if asked.quantity == "motion":
        away, floor = from_middle(body.middles, interval), floors.motion_floor_m
    else:
        away, floor = from_mean(body.orientations, interval), floors.motion_floor_rad
    return Series(frames, MILLI * away[frames], (MILLI * floor,), bars, held, most=True)


def _swing(known: Measures, asked: Measured, frames: Frames) -> Series:
    """The place on the axis of the world on which a body turns back most [mm]; how often counts."""
    name = asked.bodies[0]
    limits = thresholds_of(known.measurements.calibration)
    stream = known.body(name).poses.smooth
    _, turns = most_turns(stream, (asked.first, asked.last), limits)
    count = np.searchsorted(turns, frames, side="right").astype(float)
    bars = known.bars(Swings, body=name)
    return Series(frames, count, (float(limits.swing_turns),), bars, "to and fro", most=True)


def _speed(known: Measures, asked: Measured, frames: Frames) -> Series:
    poses = known.body(asked.bodies[0]).poses
    limits = thresholds_of(known.measurements.calibration)
    speed, _ = paces(poses.smooth, frame_rate(poses.smooth.times), limits)
    return Series(frames, MILLI * speed[frames])


def _closing(known: Measures, asked: Measured, frames: Frames) -> Series:
    one, other = map(known.body, asked.bodies)
    limits = thresholds_of(known.measurements.calibration)
    normal = contact_normal(one, other, asked.first, limits)
    speeds = MILLI * np.array([closing_speed(one, other, int(frame), normal) for frame in frames])
    bars = known.bars(Touching, body=asked.bodies[0], other=asked.bodies[1])
    return Series(frames, speeds, (), bars, "in contact")


def _opening(known: Measures, asked: Measured, frames: Frames) -> Series | None:
    facts = [fact for fact in known.observation.facts if isinstance(fact, Opening)]
    amounts = {fact.frame: float(fact.amount) for fact in facts if fact.object == asked.bodies[0]}
    if asked.first not in amounts:
        return None
    wanted = [frame for frame in sorted(amounts) if frames[0] <= frame <= frames[-1]]
    values = np.array([abs(amounts[frame] - amounts[asked.first]) for frame in wanted])
    return Series(np.array(wanted), values)


def _push(known: Measures, asked: Measured, frames: Frames) -> Series:
    """The vertical part of a contact's normal, as it began, for as long as the contact lasts."""
    one, other = asked.bodies
    values = np.full(known.observation.frames, np.nan)
    for fact in known.observation.facts:
        if isinstance(fact, ContactNormal) and {fact.body, fact.other} == {one, other}:
            for first, last in known.bars(Touching, body=fact.body, other=fact.other):
                if first == fact.first:
                    values[first : last + 1] = fact.permille * (1 if fact.body == one else -1)
    return Series(frames, values[frames])


def _placed(known: Measures, asked: Measured, frames: Frames) -> Series:
    """The share of a body that is inside another one, or how far it is above it."""
    limits = thresholds_of(known.measurements.calibration)
    pair = Pair(known.body(asked.bodies[0]), known.body(asked.bodies[1]), limits)
    how = asked.quantity
    bars = known.bars(Lies, body=asked.bodies[0], how=how, other=asked.bodies[1])
    if how == "inside":
        limit = MILLI * limits.inside_stays_share
        return Series(frames, MILLI * pair.shares(frames)[0], (limit,), bars, how)
    rise = MILLI * (pair.body.middles[:, 2] - pair.other.boxes[1][:, 2])
    return Series(frames, rise[frames], (), bars, how)


def _bearing(known: Measures, asked: Measured, frames: Frames) -> Series:
    """The level angle of a path so far to the line from the end-effector at the start."""
    hand, name = (np.rint(MILLI * known.body(each).middles) for each in asked.bodies)
    line = (name[asked.first] - hand[asked.first])[:2]
    path = (name - name[asked.first])[:, :2]
    angle = np.abs(np.arctan2(line[0] * path[:, 1] - line[1] * path[:, 0], path @ line))
    limit = HALF_RIGHT_MRAD if asked.relation == "<=" else 3.0 * HALF_RIGHT_MRAD
    return Series(frames, MILLI * angle[frames], (limit,))


def _distance(known: Measures, asked: Measured, frames: Frames) -> Series | None:
    one, other = asked.bodies
    calibration = known.measurements.calibration
    pair = calibration.sought(one, other) or calibration.sought(other, one)
    if pair is None or pair.found is Found.NEVER:
        return None
    apart = MILLI * np.min(list(_parts_apart(known.measurements, pair, frames)), axis=0)
    bars = known.bars(Touching, body=pair.first, other=pair.second)
    limits = tuple(sorted({MILLI * pair.touch_m, MILLI * pair.release_m}))
    return Series(frames, apart, limits, bars, "in contact")


def _parts_apart(
    measurements: Measurements, pair: PairCalibration, frames: Frames
) -> Iterator[Values]:
    """How far each part of the first body is from the second [m]; infinity if it cannot touch."""
    bodies, other = measurements.bodies, measurements.bodies.objects[pair.second]
    hand = pair.first in bodies.sensors
    for part in bodies.on_end_effector(pair.first) if hand else (bodies.objects[pair.first],):
        own = measurements.calibration.sought(part.name, other.name)
        if own is None or own.found is Found.NEVER:
            yield np.full(len(frames), np.inf)
        elif own.pivots:
            yield points_apart(own, part, other)[frames]
        else:
            yield separation(touchable(part), touchable(other), frames)


def _length(displaced: Displacement) -> Values:
    return np.asarray(np.linalg.norm(displaced, axis=1))


OF_PATHS: Mapping[str, tuple[Callable[[Displacement], Values], float]] = {
    "height": (lambda displaced: displaced[:, 2], MILLI),
    "depth": (lambda displaced: -displaced[:, 2], MILLI),
    "vertical": (lambda displaced: np.abs(displaced[:, 2]), MILLI),
    "far_height": (lambda displaced: np.abs(displaced[:, 2]), 1.0),
    "aside": (lambda displaced: _length(displaced[:, :2]), MILLI),
    "far_aside": (lambda displaced: _length(displaced[:, :2]), 1.0),
    "way": (_length, MILLI),
}
"""Quantities of a body's displacement since the start of the interval, and their units a metre."""

SERIES: Mapping[str, Callable[[Measures, Measured, Frames], Series | None]] = {
    "path": _sum,
    "turned": _sum,
    "turn": _sum,
    "lean": _lean,
    "leaning": _lean,
    "push": _push,
    "closing": _closing,
    "speed": _speed,
    "opening": _opening,
    "distance": _distance,
    "motion": _motion,
    "turning": _motion,
    "swing": _swing,
    "inside": _placed,
    "above": _placed,
    "bearing": _bearing,
}
"""How each other quantity is measured over time."""
