"""Each quantity that a claim rests on as a panel over time, with its limits and its numbers."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from capar.model.calibration import Found, PairCalibration
from capar.model.facts import ClosingSpeed, Leans, Moving, Observed, Resting, Swings, Touching
from capar.pipelines.explanation import Explained
from capar.views.lettering import Span
from capar.views.panels import Curve, Limit, Mark, Panel
from capar_rules.borders.times import constants
from capar_rules.explain.claims import Measure, Quantity
from capar_rules.explain.quantities import LEAST_M, degrees, length, spread
from extractors.bodies.body_geometry import BodyGeometry
from extractors.calibration import thresholds_of
from extractors.contact.contacts import points_apart
from extractors.contact.proximity import separation
from extractors.contact.touch_distances import touchable
from extractors.motion.impacts import closing_speed
from extractors.motion.leaning import lean, spin_steps
from extractors.motion.object_motion import pace_at_rest, paces
from extractors.motion.turning_points import most_turns
from extractors.relations.places import turned_and_gone
from extractors.signals.clock import frame_rate

SAMPLES = 240
"""At so many frames at most distances of surfaces are measured [1]."""

CLOSE = 5.0
"""A distance is shown up to so many times what counts as contact: beyond, it only is far [1]."""

FAST = 10.0
"""A speed is shown up to so many times what may be rest [1]."""

MILLI, CENTI = 1000.0, 100.0


@dataclass(frozen=True)
class Recording:
    """What was measured, and which of its frames are shown."""

    seen: Explained
    span: tuple[int, int]
    """First and last frame."""

    @property
    def frames(self) -> Int[np.ndarray, "shown"]:
        """The numbers of the shown frames."""
        return np.arange(self.span[0], self.span[1] + 1)

    @property
    def times(self) -> Float[np.ndarray, "shown"]:
        """Their times [s]."""
        return self.frames / self.rate

    @property
    def rate(self) -> float:
        """Frames a second [Hz]."""
        return self.seen.explainer.windows.rate

    def at(self, frame: int) -> float:
        """The time of a frame [s]."""
        return frame / self.rate

    def body(self, name: str) -> BodyGeometry:
        """The object of a name, or else the sensor."""
        return self.seen.measurements.bodies.named(name)

    def called(self, name: str) -> str:
        """A body as sentences call it."""
        return self.seen.explainer.measured.names.get(name, name.replace("_", " "))

    def curve(self, values: Float[np.ndarray, "frames"], label: str = "") -> Curve:
        """The shown part of what is known at every frame."""
        return Curve(self.times, values[self.span[0] : self.span[1] + 1], label)

    def bars(self, kind: type[Observed], **about: str) -> tuple[Span, ...]:
        """When facts of a kind about certain bodies hold, within what is shown."""
        first, last = self.span
        ends = (
            (fact.ends()[0], fact.ends()[-1])
            for fact in self.seen.observation.facts
            if isinstance(fact, kind)
            and all(getattr(fact, name) == value for name, value in about.items())
        )
        return tuple(
            Span(self.at(max(begin, first)), self.at(min(end, last)), "")
            for begin, end in ends
            if begin <= last and end >= first
        )

    def is_object(self, name: str) -> bool:
        """Whether it is a thing, whose motion counts, and no end-effector."""
        return name in self.seen.measurements.bodies.objects

    def floor(self, body: str) -> Limit:
        """From where on a body counts as moved."""
        floor_m = self.seen.measurements.calibration.body(body).motion_floor_m
        return Limit(CENTI * floor_m, f"counts as moved from {length(floor_m)}")


def _way(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    middles = known.body(name).middles
    away = np.linalg.norm(middles - middles[told.first], axis=1)
    curves = [known.curve(CENTI * away, "straight")]
    moved = known.seen.explainer.measured.ways
    winding = moved is not None and "way" in forms and moved(name, told.first, told.last).winding
    end = float(away[told.last])
    short = end < LEAST_M and (winding or "way" not in forms)
    label = f"less than {length(LEAST_M)}" if short else length(end)
    marks = [Mark(known.at(told.last), CENTI * end, label)]
    if winding:
        steps = np.nan_to_num(np.linalg.norm(np.diff(middles, axis=0), axis=1))
        path = np.concatenate([[0.0], np.cumsum(steps)])
        path -= path[told.first]
        inside = np.where(np.arange(len(path)) < told.first, np.nan, path)
        curves.append(known.curve(CENTI * inside, "along its path"))
        marks.append(Mark(known.at(told.last), CENTI * path[told.last], length(path[told.last])))
    limits = [known.floor(name)] if "way" in forms and known.is_object(name) else []
    for form in sorted(forms & set(WAYS)):
        constant, label = WAYS[form]
        limits.append(_limit(constant, label))
    return Panel(
        f"{known.called(name)}: way from where it was at {known.at(told.first):.2f} s",
        "cm",
        tuple(curves),
        tuple(limits),
        tuple(marks),
        known.bars(Moving, object=name),
        "counts as moving",
    )


WAYS = {
    "place": ("aside_mm", "near is within {}"),
    "not_near": ("aside_mm", "near is within {}"),
    "not_slid": ("slide_mm", "a slide takes {}"),
    "away": ("aside_mm", "back there is within {}"),
    "back": ("aside_mm", "back there is within {}"),
}
"""By the format of a way: the constant of the rules that it is compared with, and how it reads."""


def _limit(constant: str, label: str, *, sign: float = 1.0) -> Limit:
    """A length of the rules, in centimetres."""
    metres = constants()[constant] / 1000.0
    return Limit(sign * CENTI * metres, label.format(length(metres)))


def _spread(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    middles = known.body(name).middles
    inside = middles[told.first : told.last + 1]
    away = np.linalg.norm(middles - np.nanmedian(inside, axis=0), axis=1)
    far = told.first + int(np.nanargmax(away[told.first : told.last + 1]))
    return Panel(
        f"{known.called(name)}: distance from its median place",
        "cm",
        (known.curve(CENTI * away),),
        (known.floor(name),) if known.is_object(name) else (),
        (Mark(known.at(far), CENTI * away[far], f"at most {spread(away[far])}"),),
        known.bars(Moving, object=name),
        "counts as moving",
    )


def _turn_in_all(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    turned = turned_and_gone(known.body(name))[1]
    turned = turned - turned[told.first]
    least, end = constants()["half_turn_mrad"] / 1000.0, float(turned[told.last])
    return Panel(
        f"{known.called(name)}: turned in all, about any axis, since {known.at(told.first):.2f} s",
        "°",
        (known.curve(np.degrees(turned)),),
        (Limit(math.degrees(least), f"half a turn: {math.degrees(least):.0f}°"),),
        (Mark(known.at(told.last), math.degrees(end), f"{math.degrees(end):.0f}°"),),
    )


def _path(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    gone, turned, _ = turned_and_gone(known.body(name))
    gone = gone - gone[told.first]
    angle, end = float(turned[told.last] - turned[told.first]), float(gone[told.last])
    about = constants()["wrist_mm"] / 1000.0 * angle
    return Panel(
        f"{known.called(name)}: length of its path since {known.at(told.first):.2f} s",
        "cm",
        (known.curve(CENTI * gone),),
        (Limit(CENTI * about, f"turned so far about the wrist: up to {length(about)}"),),
        (Mark(known.at(told.last), CENTI * end, length(end)),),
    )


def _height(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    height = known.body(name).middles[:, 2]
    up = height - height[told.first]
    end = float(up[told.last])
    rounded = np.diff(np.rint(MILLI * height[[told.first, told.last]]))[0] / MILLI
    return Panel(
        f"{known.called(name)}: height above where it was at {known.at(told.first):.2f} s",
        "cm",
        (known.curve(CENTI * up),),
        (_limit("height_mm", "up: {} or more"), _limit("height_mm", "down: {} or more", sign=-1.0)),
        (Mark(known.at(told.last), CENTI * end, length(abs(rounded))),),
    )


def _aside(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    level = known.body(name).middles[:, :2]
    away = np.linalg.norm(level - level[told.first], axis=1)
    end = float(away[told.last])
    rounded = np.diff(np.rint(MILLI * level[[told.first, told.last]]), axis=0)[0] / MILLI
    return Panel(
        f"{known.called(name)}: way to the side from where it was at {known.at(told.first):.2f} s",
        "cm",
        (known.curve(CENTI * away),),
        (_limit("aside_mm", "aside: {} or more"),),
        (Mark(known.at(told.last), CENTI * end, length(math.hypot(*rounded))),),
    )


def _lean(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    measurements = known.seen.measurements
    upright = np.array(measurements.calibration.body(name).upright)
    angle = np.degrees(lean(known.body(name).orientations, upright))
    limits, labels = [], [f"{angle[frame]:.0f}°" for frame in (told.first, told.last)]
    marks = [
        Mark(known.at(frame), float(angle[frame]), label)
        for frame, label in zip((told.first, told.last), labels, strict=True)
    ]
    if "far_over" in forms:
        far = math.degrees(thresholds_of(measurements.calibration).lean_rad)
        limits.append(Limit(far, f"far over is {far:.0f}° or more"))
        most = told.first + int(np.nanargmax(angle[told.first : told.last + 1]))
        marks.append(Mark(known.at(most), float(angle[most]), f"{angle[most]:.0f}° at most"))
    if forms & {"lean", "not_leant"}:
        change = math.degrees(constants()["turn_mrad"] / 1000.0)
        start, by = float(angle[told.first]), abs(float(np.diff(angle[[told.first, told.last]])[0]))
        marks[1] = replace(marks[1], label=f"{labels[1]} (a change of {by:.0f}°)")
        limits += [
            Limit(value, f"{change:.0f}° {sense} than at the start")
            for value, sense in ((start + change, "more"), (start - change, "less"))
            if value > 0.0
        ]
    return Panel(
        f"{known.called(name)}: lean from upright",
        "°",
        (known.curve(angle),),
        tuple(limits),
        tuple(marks),
        known.bars(Leans, object=name),
        "leans far over",
    )


def _turn(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    turned = np.concatenate([[0.0], np.cumsum(spin_steps(known.body(name).orientations))])
    turned -= turned[told.first]
    turned *= -1.0 if turned[told.last] < 0.0 else 1.0
    least = constants()["turn_mrad"]
    end = float(turned[told.last])
    return Panel(
        f"{known.called(name)}: turn about the vertical since {known.at(told.first):.2f} s",
        "°",
        (known.curve(np.degrees(turned)),),
        (Limit(math.degrees(least / 1000.0), f"a turn: {degrees(least)} or more"),),
        (Mark(known.at(told.last), math.degrees(end), degrees(round(1000.0 * end))),),
    )


def _distance(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel | None:
    one, other = told.bodies
    calibration = known.seen.measurements.calibration
    pair = calibration.sought(one, other)
    if pair is None:
        one, other = other, one
        pair = calibration.sought(one, other)
    if pair is None:
        return None
    touching = known.bars(Touching, body=one, other=other)
    every = known.frames
    some = every[:: max(1, math.ceil(len(every) / SAMPLES))]
    frames = np.unique([*some, every[-1], *(at for at in (told.first, told.last) if at in every)])
    apart = MILLI * np.min(list(_apart(known, pair, frames)), axis=0)
    limits = {MILLI * pair.touch_m: "contact begins within {:.0f} mm"}
    limits[MILLI * pair.release_m] = "contact ends beyond {:.0f} mm"
    if pair.touch_m >= pair.release_m:
        limits = {MILLI * pair.touch_m: "counts as contact within {:.0f} mm"}
    if pair.found is Found.NEVER:
        limits = {}
    return Panel(
        f"{known.called(one)} to {known.called(other)}: distance of {_between(pair)}",
        "mm",
        (Curve(frames / known.rate, apart),),
        tuple(Limit(value, label.format(value)) for value, label in limits.items()),
        bars=touching,
        bars_label="counts as contact",
        highest=CLOSE * max([*limits, 20.0]),
    )


def _between(pair: PairCalibration) -> str:
    if not pair.pivots:
        return "their surfaces"
    return "their origins" if pair.found is Found.STATED else "a point of each"


def _apart(
    known: Recording, pair: PairCalibration, frames: Int[np.ndarray, "some"]
) -> Iterator[Float[np.ndarray, "some"]]:
    """How far each part of an end-effector, or a thing, is from a thing [m]."""
    bodies, calibration = known.seen.measurements.bodies, known.seen.measurements.calibration
    other = bodies.objects[pair.second]
    hand = pair.first in bodies.sensors
    parts = bodies.on_end_effector(pair.first) if hand else (bodies.objects[pair.first],)
    nowhere = np.full(len(frames), np.inf)
    for part in parts:
        own = calibration.sought(part.name, other.name)
        if own is None or own.found is Found.NEVER:
            yield nowhere
        elif own.pivots:
            yield points_apart(own, part, other)[frames]
        else:
            yield separation(touchable(part), touchable(other), frames)


def _closing(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    one, other = told.bodies
    own, thing = known.body(one), known.body(other)
    speeds = MILLI * np.array([closing_speed(own, thing, int(frame)) for frame in known.frames])
    met = [
        fact
        for fact in known.seen.observation.facts
        if isinstance(fact, ClosingSpeed)
        and (fact.body, fact.other) == (one, other)
        and known.span[0] <= fact.first <= known.span[1]
    ]
    near = min(met, key=lambda fact: abs(fact.first - told.last), default=None)
    blow = constants()["blow_mm_s"]
    return Panel(
        f"{known.called(one)} and {known.called(other)}: how fast they come together",
        "mm/s",
        (Curve(known.times, speeds),),
        (Limit(float(blow), f"a blow: {blow} mm/s or more"),),
        (Mark(known.at(near.first), float(near.speed), f"{near.speed} mm/s"),) if near else (),
        known.bars(Touching, body=one, other=other),
        "counts as contact",
    )


def _speed(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    (name,) = told.bodies
    poses = known.body(name).poses
    limits = thresholds_of(known.seen.measurements.calibration)
    rate = frame_rate(poses.smooth.times)
    slow = MILLI * pace_at_rest(poses.noise, rate, limits)[0]
    return Panel(
        f"{known.called(name)}: speed",
        "mm/s",
        (known.curve(MILLI * paces(poses.smooth, rate, limits)[0]),),
        (Limit(slow, f"may be at rest below {slow:.0f} mm/s"),),
        bars=known.bars(Resting, ee=name),
        bars_label="counts as at rest",
        highest=FAST * slow,
    )


def _to_and_fro(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel | None:
    (name,) = told.bodies
    stream = known.body(name).poses.smooth
    limits = thresholds_of(known.seen.measurements.calibration)
    axis, turns = most_turns(stream, (told.first, told.last), limits)
    places = stream.positions[:, axis]
    places = CENTI * (places - np.nanmean(places[told.first : told.last + 1]))
    sense = ("along the x axis", "along the y axis", "up and down")[axis]
    least = length(limits.swing_m)
    return Panel(
        f"{known.called(name)}: place {sense}; red: turns back after {least} or more",
        "cm",
        (known.curve(places),),
        marks=tuple(Mark(known.at(int(at)), float(places[at])) for at in turns),
        bars=known.bars(Swings, body=name),
        bars_label="counts as to and fro",
    )


Series = Callable[[Recording, Quantity, frozenset[str]], Panel | None]

SERIES: Mapping[Measure, Series] = {
    Measure.DISTANCE: _distance,
    Measure.WAY: _way,
    Measure.SPREAD: _spread,
    Measure.HEIGHT: _height,
    Measure.ASIDE: _aside,
    Measure.LEAN: _lean,
    Measure.TURN: _turn,
    Measure.TURN_IN_ALL: _turn_in_all,
    Measure.PATH: _path,
    Measure.CLOSING: _closing,
    Measure.SPEED: _speed,
    Measure.TO_AND_FRO: _to_and_fro,
}
"""The panel of each quantity."""
