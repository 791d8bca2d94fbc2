"""Each quantity that a claim rests on as a panel over time, with its limits and its numbers."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from capar.model.calibration import Found, PairCalibration
from capar.model.facts import (
    ClosingSpeed,
    Leans,
    Lies,
    Moving,
    Observed,
    Opening,
    Resting,
    Swings,
    Touching,
)
from capar.pipelines.explanation import Explained
from capar.views.lettering import Span
from capar.views.panels import Curve, Limit, Mark, Panel
from capar_rules.borders.times import constants, in_frames, times
from capar_rules.explain.arrangements import AFTER_DEG, AHEAD_DEG, steepest_deg
from capar_rules.explain.claims import ANY, Measure, Quantity
from capar_rules.explain.quantities import LEAST_M, degrees, length, percent, spread, upward
from capar_rules.explain.quantities import change as change_of
from extractors.bodies.body_geometry import BodyGeometry
from extractors.calibration import thresholds_of
from extractors.contact.contacts import points_apart
from extractors.contact.proximity import separation
from extractors.contact.touch_distances import touchable
from extractors.motion.impacts import closing_speed
from extractors.motion.leaning import lean, spin_steps
from extractors.motion.object_motion import pace_at_rest, paces
from extractors.motion.turning_points import most_turns
from extractors.relations.arrangement import Pair
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

    @property
    def merged(self) -> float:
        """How many frames apart events are one."""
        return in_frames(times().merge_ms, self.rate)

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

    def lost(self, *names: str) -> tuple[Span, ...]:
        """When a body of those was not tracked, within what is shown."""
        first, last = self.span
        gaps = (gap for name in names for gap in self.seen.explainer.measured.lost.get(name, ()))
        return tuple(
            Span(self.at(max(begin, first)), self.at(min(end, last)), "")
            for begin, end in gaps
            if begin <= last and end >= first
        )

    def inside(self, frame: int) -> bool:
        """Whether a frame is shown."""
        return self.span[0] <= frame <= self.span[1]

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
        bound = upward(float(angle[most]))
        marks.append(Mark(known.at(most), float(angle[most]), f"{bound:.0f}° at most"))
    if forms & {"lean", "not_leant"}:
        change = math.degrees(constants()["turn_mrad"] / 1000.0)
        start = float(angle[told.first])
        ends = (round(MILLI * math.radians(angle[frame])) for frame in (told.first, told.last))
        marks[1] = replace(marks[1], label=f"{labels[1]} (a change of {change_of(*ends)})")
        limits += [
            Limit(value, f"{change:.0f}° {sense} than at the start")
            for value, sense in ((start + change, "more"), (start - change, "less"))
            if value > 0.0
        ]
    return Panel(
        f"{known.called(name)}: lean from {known.seen.explainer.measured.upright(name)}",
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
    highest = CLOSE * max([*limits, 20.0])
    at_borders = dict(zip(frames.tolist(), apart.tolist(), strict=True))
    marks = [
        Mark(known.at(frame), min(at_borders[frame], highest), _gap(at_borders[frame]))
        for frame in (told.first, told.last)
        if math.isfinite(at_borders.get(frame, math.nan))
    ]
    rough = [name for name in (one, other) if name in known.seen.explainer.measured.stand_ins]
    about = f" (shape of the {known.called(rough[0])}: a stand-in)" if rough else ""
    return Panel(
        f"{known.called(one)} to {known.called(other)}: distance of {_between(pair)}{about}",
        "mm",
        (Curve(frames / known.rate, apart),),
        tuple(Limit(value, label.format(upward(value))) for value, label in limits.items()),
        tuple(marks),
        bars=touching,
        bars_label="counts as contact",
        highest=highest,
        lost=known.lost(one, other),
    )


def _gap(millimetres: float) -> str:
    """A distance of two bodies, as a mark has it."""
    return f"{millimetres:.0f} mm" if millimetres < 100.0 else length(millimetres / MILLI)


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
    since, least = "", constants()["rest_ms"] / 1000.0
    if forms & SINCE_BEGIN:
        known = replace(known, span=(0, known.span[1]))
        since = " since the recording began"
    return Panel(
        f"{known.called(name)}: speed{since}",
        "mm/s",
        (known.curve(MILLI * paces(poses.smooth, rate, limits)[0]),),
        (Limit(slow, f"may be at rest below {slow:.0f} mm/s"),),
        bars=_free_rests(known, name) if since else known.bars(Resting, ee=name),
        bars_label=f"at rest for {least:.2f} s or more, touching nothing"
        if since
        else f"counts as at rest; a rest lasts {least:.2f} s or more",
        highest=FAST * slow,
        lost=known.lost(name),
        span_s=(known.at(known.span[0]), known.at(known.span[1])) if since else None,
    )


def _free_rests(known: Recording, name: str) -> tuple[Span, ...]:
    """Rests of an end-effector that are long enough and in which it touches nothing."""
    least = constants()["rest_ms"] / MILLI
    met = known.bars(Touching, body=name)
    return tuple(
        rest
        for rest in known.bars(Resting, ee=name)
        if rest.end_s - rest.start_s >= least
        and not any(one.start_s <= rest.end_s and one.end_s >= rest.start_s for one in met)
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


def _bearing(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    """The level angle of the way so far to the line from the end-effector at the start."""
    hand, name = told.bodies
    middles, first = np.rint(MILLI * known.body(name).middles), told.first
    line = (middles[first] - np.rint(MILLI * known.body(hand).middles[first]))[:2]
    way = (middles - middles[first])[:, :2]
    far = np.linalg.norm(way, axis=1) >= MILLI * LEAST_M
    shown = far & (np.arange(len(way)) >= first)
    shown[told.last] = True
    directions = [(line, "to the line from the end-effector to it")]
    contacts = known.seen.explainer.measured
    met = contacts.contact(hand, name, first, known.merged)
    press = contacts.presses.get((hand, name), {}).get(met[0]) if met else None
    if press is not None and np.hypot(*press) >= constants()["steep_permille"]:
        directions.append((np.array(press, dtype=float), "to where it is pressed"))
    curves, ends = [], []
    for direction, label in directions:
        across = direction[0] * way[:, 1] - direction[1] * way[:, 0]
        angle = np.degrees(np.abs(np.arctan2(across, way @ direction)))
        angle[~shown] = np.nan
        curves.append(known.curve(angle, label))
        ends.append(float(angle[told.last]))
    return Panel(
        f"{known.called(name)}: level angle of its way since {known.at(first):.2f} s to the line "
        f"from the {known.called(hand)} to its middle",
        "°",
        tuple(curves),
        (
            Limit(AHEAD_DEG, f"ahead: {AHEAD_DEG:.0f}° or less"),
            Limit(AFTER_DEG, f"after: {AFTER_DEG:.0f}° or more"),
        ),
        tuple(Mark(known.at(told.last), end, f"{end:.0f}°") for end in ends if math.isfinite(end)),
    )


def _pair(known: Recording, told: Quantity) -> Pair:
    name, other = told.bodies
    limits = thresholds_of(known.seen.measurements.calibration)
    return Pair(known.body(name), known.body(other), limits)


def _above(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    name, other = told.bodies
    pair = _pair(known, told)
    rise = pair.body.middles[:, 2] - pair.other.boxes[1][:, 2]
    frames = [frame for frame in (told.first, told.last) if np.isfinite(rise[frame])]
    top = "top" if pair.other.shape is not None else "origin"
    marks = [
        Mark(known.at(frame), CENTI * float(value[frame]), length(abs(float(value[frame]))))
        for value in (rise, pair.aside)
        for frame in frames
    ]
    return Panel(
        f"{known.called(name)}: its middle over the {top} of the {known.called(other)}; above it "
        "is no further aside than over it",
        "cm",
        (known.curve(CENTI * rise), known.curve(CENTI * pair.aside, "aside of it")),
        (),
        tuple(marks),
        known.bars(Lies, body=name, how="above", other=other),
        "counts as above",
    )


def _inside(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    name, other = told.bodies
    pair = _pair(known, told)
    share, deep = (CENTI * value for value in pair.shares)
    limits = pair.thresholds
    merge = known.merged
    spans = known.seen.explainer.measured.lies.get(("inside", name, other), ())
    starts = [
        max(first, border)
        for border in (told.first, told.last)
        for first, last in spans
        if first <= border + merge and last >= border
    ]
    at = dict.fromkeys([told.first, told.last, *starts])
    known_at = [frame for frame in at if frame < len(share)]
    return Panel(
        f"{known.called(name)}: share of it inside the {known.called(other)}",
        "%",
        (known.curve(share), known.curve(deep, "share of its ends well inside")),
        (
            Limit(
                CENTI * limits.inside_share,
                f"inside from {percent(limits.inside_share)} on, while no less than "
                f"{percent(limits.inside_stays_share)}",
            ),
        ),
        tuple(Mark(known.at(one), float(share[one]), f"{share[one]:.0f} %") for one in known_at),
        known.bars(Lies, body=name, how="inside", other=other),
        "counts as inside",
    )


def _borne(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel | None:
    """From how far off straight up each contact of a body pushes it, while it lasts."""
    name, wanted = told.bodies
    found = known.seen.explainer.measured
    times, values, marks = [], [], []
    for (one, two), contacts in sorted(found.contacts.items()):
        other = two if one == name else one
        if name not in (one, two) or wanted not in (ANY, other):
            continue
        for first, last in contacts:
            permille = found.upward(name, other, first)
            if permille is None or last < known.span[0] or first > known.span[1]:
                continue
            angle = math.degrees(math.acos(max(-1.0, min(1.0, permille / MILLI))))
            ends = known.at(max(first, known.span[0])), known.at(min(last, known.span[1]))
            times += [*ends, ends[1]]
            values += [angle, angle, math.nan]
            label = f"{angle:.0f}°" + f" ({known.called(other)})" * (wanted == ANY)
            inside = first <= told.last and last >= told.first
            at = max(ends[0], known.at(told.first)) if inside else ends[0]
            marks.append(Mark(at, angle, label))
    if not values:
        return None
    most = steepest_deg()
    of = "what touches it pushes it" if wanted == ANY else f"the {known.called(wanted)} pushes it"
    return Panel(
        f"{known.called(name)}: how far off straight up {of}, as their contact began",
        "°",
        (Curve(np.array(times), np.array(values)),),
        (Limit(most, f"bears it from below up to {most:.0f}°"),),
        tuple(marks),
    )


def _opening(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel | None:
    (name,) = told.bodies
    facts = [
        fact
        for fact in known.seen.observation.facts
        if isinstance(fact, Opening) and fact.object == name and known.inside(fact.frame)
    ]
    if not facts:
        return None
    guide = known.seen.measurements.guides[name]
    unit = "m" if guide.fit.kind == "rail" else "rad"
    facts.sort(key=lambda fact: fact.frame)
    values = {fact.frame: fact.amount / MILLI for fact in facts}
    return Panel(
        f"{known.called(name)}: how far it is open",
        unit,
        (Curve(np.array([known.at(frame) for frame in values]), np.array(list(values.values()))),),
        (),
        tuple(
            Mark(known.at(frame), values[frame], f"{values[frame]:.2f} {unit}")
            for frame in (told.first, told.last)
            if frame in values
        ),
    )


SINCE_BEGIN = frozenset({"away", "back"})
"""Formats that tell of earlier rests: what is shown for them begins with the recording."""

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
    Measure.BEARING: _bearing,
    Measure.ABOVE: _above,
    Measure.INSIDE: _inside,
    Measure.BORNE: _borne,
    Measure.OPENING: _opening,
}
"""The panel of each quantity."""
