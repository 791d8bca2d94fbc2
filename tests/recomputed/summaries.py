"""What a summary says with a number, recomputed from streams and measured facts."""

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from capar.model.body_names import body_names
from capar.model.facts import (
    ClosingSpeed,
    ContactNormal,
    Displaced,
    FlickerCorrection,
    Leans,
    Posture,
    PressDirection,
    Resting,
    Touching,
)
from capar_rules.engine.solver import rule_file
from recomputed.contacts import let_go, moved_before, took
from recomputed.doors import NUMBER, slid, swung
from recomputed.known import NAME, TIME, Known, covers, name, near
from recomputed.motion import lasted, stroked

LENGTH = r"(\d+(?:\.\d)? mm|\d+(?:\.\d)? cm|\d+\.\d\d? m)"
POSTURE = r"from how it (?:first rested|was first seen)"
DEGREES = r"(\d+(?:\.\d)?)°"
UNITS = {"mm": (0.001, 0.0005), "cm": (0.01, 0.005), "m": (1.0, 0.05)}
"""Of each unit: metres, and half of the last place that is told [m]."""

SMOOTHED_M = 0.006
"""By so much a smoothed place differs from the recorded one [m]."""

LINES = ("along the x axis", "along the y axis", "up and down")
"""The axes of the world, as summaries have them."""

SHORT_M = 0.01
"""A body that ends nearer than this to where it began is told to end there [m]."""

VERBS = (
    "bore|counted|met|reached|rose|sank|took|counts|bore|touched|moved|ended|leant|turned|stayed|kept|did|was|had|came|went|"
    "then|lay|dipped|started|slid|left|rested|were|pressed"
)


@dataclass(frozen=True)
class Fragment:
    """A part of a summary that tells numbers of one body."""

    body: str
    text: str
    check: Callable[..., bool]
    told: tuple[str, ...]

    def holds(self, known: Known) -> bool:
        return self.check(known, self.body, *self.told)


def fragments(known: Known, text: str) -> Iterator[Fragment]:
    """The parts of a text that tell numbers; what is left of it has none.

    Raises:
        AssertionError: A number is told in a form that nothing recomputes.
    """
    called = {each: each for each in (known.segment.ee, *_bodies(known))}
    called |= body_names(known.seen.observation)
    names = {words.replace("_", " "): each for each, words in called.items()}
    every = "|".join(sorted(map(re.escape, names), key=len, reverse=True))
    subjects = [
        (found.start(), names[found[1]])
        for found in re.finditer(rf"\bthe ({every}) (?:{VERBS})\b", text)
    ]
    for pattern, check in FORMS:
        for found in re.finditer(pattern, text):
            body = next((one for at, one in reversed(subjects) if at < found.start()), "")
            yield Fragment(body, found[0], check, found.groups(default=""))
        text = re.sub(pattern, lambda found: "#" * len(found[0]), text)
    assert not re.search(r"\d", text), f"nothing recomputes a number of {text!r}"


def _bodies(known: Known) -> list[str]:
    return [each.name for each in (*known.capture.objects, *known.capture.sensors)]


def _is(metres: float, told: str, *, slack_m: float = SMOOTHED_M) -> bool:
    number, unit = told.split(" ")
    scale, half = UNITS[unit]
    return abs(metres - float(number) * scale) <= half + slack_m


def _motion(known: Known, body: str) -> tuple[int, int]:
    """From when to when it truly moved in the segment; the segment if it never did."""
    first, last = known.segment.first, known.segment.last
    spans = [
        (max(each.first, first), min(each.last, last))
        for each in known.seen.observation.facts
        if isinstance(each, Displaced) and each.object == body
    ]
    inside = [each for each in spans if each[0] < each[1]]
    ends = (min(start for start, _ in inside), max(end for _, end in inside)) if inside else None
    return ends or (first, last)


def _displaced(known: Known, body: str, span: tuple[int, int]) -> np.ndarray:
    """The way of the body's middle."""
    track = known.track(body, *span)
    return np.asarray(track[-1] - track[0])


def _shifted(known: Known, body: str) -> np.ndarray:
    """The way of the body's middle from the start of the segment to its end."""
    first, last = known.segment.first, known.segment.last
    return known.middle(body, last) - known.middle(body, first)


def _length(way: np.ndarray) -> float:
    return float(np.linalg.norm(way))


def moved(known: Known, body: str, far: str) -> bool:
    """It ends so far from where its motion began, a step of a blow apart."""
    span = _motion(known, body)
    track = known.track(body, *span)
    blur = max(_length(track[1] - track[0]), _length(track[-1] - track[-2]))
    return _is(_length(_displaced(known, body, span)), far, slack_m=SMOOTHED_M + blur)


def wound(known: Known, body: str, path: str, at: str | None, less: str | None, far: str) -> bool:
    """Its steps sum to the path, and it ends so far from where its motion began."""
    if at and not until(known, body, at):
        return False
    span = _motion(known, body)
    track = known.track(body, *span)
    steps = float(np.linalg.norm(np.diff(track, axis=0), axis=1).sum())
    way = _length(_displaced(known, body, span))
    ended = way < _metres(far) + SMOOTHED_M if less else _is(way, far)
    return ended and _is(steps, path, slack_m=0.03)


def _metres(told: str) -> float:
    number, unit = told.split(" ")
    return float(number) * UNITS[unit][0]


def ended_there(known: Known, body: str, far: str) -> bool:
    """It ends nearer than that to where it began, which is as near as is told in metres."""
    return _metres(far) == SHORT_M and _length(_shifted(known, body)) < SHORT_M + SMOOTHED_M


def rest_lasts(known: Known, _: str, told: str) -> bool:
    return _asked("rest_ms", told)


def rests_longer(known: Known, body: str, told: str) -> bool:
    """A rest as long as a rest takes at least."""
    return rest_lasts(known, body, told) and any(
        each.ee == body and (each.last - each.first) / known.rate > float(told)
        for each in known.of(Resting)
    )


def ended_away(known: Known, body: str, far: str) -> bool:
    return _is(_length(_shifted(known, body)), far)


def ended(known: Known, body: str, rise: str, sense: str, aside: str) -> bool:
    """At the segment's end it is so much higher and so far aside."""
    way = _shifted(known, body)
    height = float(way[2]) * (-1.0 if sense == "lower" else 1.0)
    level = _is(height, rise) if rise else abs(height) <= 2 * SMOOTHED_M
    beside = math.hypot(way[0], way[1])
    return level and (_is(beside, aside) if aside else beside <= 2 * SMOOTHED_M)


def been_beyond(known: Known, body: str, up: str, high: str, _: str, low: str, deep: str) -> bool:
    """At some frame it is so much higher, or lower, than at the start, and never more."""
    height = known.track(body, known.segment.first, known.segment.last)[:, 2]
    rise, fall = float(height.max() - height[0]), float(height[0] - height.min())
    above = not up or _is(rise, high)
    return above and all(_is(fall, told) for told in (low, deep) if told)


def _asked(name: str, told: str) -> bool:
    """Whether a length or an angle is the threshold of that name, as the rules have it."""
    text = rule_file("thresholds.lp").read_text(encoding="utf-8")
    (asked,) = re.findall(rf"#const {name} = (\d+)\.", text)
    if name.endswith("mrad"):
        return abs(math.degrees(int(asked) / 1000.0) - float(told)) <= 0.6
    if name.endswith("_ms"):
        return math.isclose(int(asked) / 1000.0, float(told))
    return _is(int(asked) / 1000.0, told, slack_m=0.0)


def counts_from(known: Known, body: str, far: str, angle: str) -> bool:
    """The body moves from there on, and stayed nearer to where it was."""
    calibration = known.seen.observation.calibration
    assert calibration is not None
    (own,) = [each for each in calibration.objects if each.name == body]
    turns = not angle or abs(math.degrees(own.motion_floor_rad) - float(angle)) <= 0.6
    return turns and _is(own.motion_floor_m, far, slack_m=0.0)


def too_low(known: Known, body: str, far: str, sense: str, asked: str) -> bool:
    """It went so far up or down, which is less than the rules ask for."""
    height = float(_shifted(known, body)[2]) * (1.0 if sense == "higher" else -1.0)
    return _is(height, far) and 0.0 < height < 0.05 + SMOOTHED_M and _asked("height_mm", asked)


def too_little(
    known: Known, body: str, rise: str, sense: str, aside: str, least: str, far: str
) -> bool:
    """It ended so little higher, and so little aside, that neither counts."""
    way = _shifted(known, body)
    short = abs(way[2]) < 0.05 + SMOOTHED_M and math.hypot(way[0], way[1]) < 0.1 + SMOOTHED_M
    asked = _asked("height_mm", least) and _asked("aside_mm", far)
    return short and asked and ended(known, body, rise, sense, aside)


def not_steep(known: Known, body: str, far: str, sense: str, asked: str, wanted: str) -> bool:
    """It ended no higher, or no lower, than can be seen, and so far from that height."""
    height = float(_shifted(known, body)[2]) * (1.0 if wanted == "higher" else -1.0)
    is_so = _is(height * (1.0 if sense == wanted else -1.0), far) if far else abs(height) < 0.01
    return is_so and height < 0.005 + SMOOTHED_M and _asked("height_mm", asked)


def too_far_aside(known: Known, body: str, aside: str, sense: str, rise: str) -> bool:
    """It went further to the side than up or down."""
    way = _shifted(known, body)
    height, beside = float(way[2]) * (1.0 if sense == "up" else -1.0), math.hypot(way[0], way[1])
    return _is(beside, aside) and _is(height, rise) and beside + SMOOTHED_M > height > 0.0


def too_steep(known: Known, body: str, sense: str, rise: str, aside: str) -> bool:
    """It went further up or down than to the side."""
    way = _shifted(known, body)
    height, beside = float(way[2]) * (1.0 if sense == "up" else -1.0), math.hypot(way[0], way[1])
    return _is(beside, aside) and _is(height, rise) and height + SMOOTHED_M > beside


def too_little_aside(known: Known, body: str, aside: str, asked: str) -> bool:
    way = _shifted(known, body)
    beside = math.hypot(way[0], way[1])
    return _is(beside, aside) and beside < 0.1 + SMOOTHED_M and _asked("aside_mm", asked)


def too_short_for_a_direction(known: Known, body: str, aside: str, asked: str) -> bool:
    way = _shifted(known, body)
    beside = math.hypot(way[0], way[1])
    return _is(beside, aside) and beside < 0.05 + SMOOTHED_M and _asked("slide_mm", asked)


def too_far(known: Known, body: str, far: str, asked: str) -> bool:
    return (
        ended_away(known, body, far)
        and _length(_shifted(known, body)) > 0.1 - SMOOTHED_M
        and _asked("aside_mm", asked)
    )


def too_short_to_slide(known: Known, body: str, far: str, asked: str) -> bool:
    way = _length(_shifted(known, body))
    return _is(way, far) and way < 0.05 + SMOOTHED_M and _asked("slide_mm", asked)


def turned_too_little(known: Known, body: str, told: str, asked: str) -> bool:
    return spun(known, body, told) and _asked("turn_mrad", asked) and float(told) <= float(asked)


def leant_too_little(
    known: Known, body: str, before: str, after: str, most: str, asked: str
) -> bool:
    change = abs(float(before) - float(after))
    if most and not far_over(known, body, before, after, most, "30"):
        return False
    return (
        leant(known, body, before, after)
        and _asked("turn_mrad", asked)
        and change <= float(asked) + 1.0
    )


def met_first(known: Known, body: str, other: str, at: str) -> bool:
    """A contact of the two begins then, while the end-effector touches the thing."""
    holds = known.touching(known.segment.ee, body)
    began = any(near(each.first, known.at(at)) for each in known.touching(body, other))
    return began and any(covers(each, known.at(at)) for each in holds)


def met_gently(known: Known, body: str, other: str, speed: str) -> bool:
    """They come together so fast, and slower than a blow."""
    return int(speed) < 1000 and _met(known, body, other, speed)


def met_hard(known: Known, body: str, other: str, speed: str) -> bool:
    return int(speed) >= 1000 and _met(known, body, other, speed)


def _met(known: Known, body: str, other: str, speed: str) -> bool:
    found = [each for each in known.of(ClosingSpeed) if each.speed == int(speed)]
    return (body, name(other)) in [(each.body, each.other) for each in found]


def until(known: Known, body: str, at: str) -> bool:
    """Its motion ends then, before the segment does."""
    last = _motion(known, body)[1]
    return near(last, known.at(at)) and last < known.segment.last


def _postures(known: Known, body: str) -> list[Posture]:
    found = {each.frame: each for each in known.of(Posture) if each.body == body}
    return [found[at] for at in (known.segment.first, known.segment.last)]


def leant(known: Known, body: str, *told: str) -> bool:
    angles = [math.degrees(each.lean / 1000.0) for each in _postures(known, body)]
    return all(abs(one - float(other)) <= 0.6 for one, other in zip(angles, told, strict=True))


def spun(known: Known, body: str, told: str) -> bool:
    before, after = (each.spin for each in _postures(known, body))
    return abs(abs(math.degrees((after - before) / 1000.0)) - float(told)) <= 0.6


def leant_by(known: Known, body: str, before: str, after: str, change: str, asked: str) -> bool:
    return (
        leant(known, body, before, after)
        and abs(abs(float(before) - float(after)) - float(change)) <= 1.0
        and _asked("turn_mrad", asked)
    )


def spun_enough(known: Known, body: str, told: str, asked: str) -> bool:
    return spun(known, body, told) and _asked("turn_mrad", asked)


def kept_within(known: Known, body: str, far: str, first: str = "", last: str = "") -> bool:
    """It is never further from the middle of where it is."""
    begin = known.frame(first) if first else known.segment.first
    end = known.frame(last) if last else known.segment.last
    track = known.track(body, begin, end)
    away = np.linalg.norm(track - 0.5 * (track.min(axis=0) + track.max(axis=0)), axis=1)
    return _is(float(away.max()), far)


def starts(known: Known, _: str, at: str) -> bool:
    return near(known.segment.first, known.at(at))


def ends(known: Known, _: str, at: str) -> bool:
    return near(known.segment.last, known.at(at))


def earlier(known: Known, _: str, at: str) -> bool:
    """It is before the segment's end."""
    return known.at(at) < known.segment.last


def parted(known: Known, body: str, first: str, last: str) -> bool:
    """A stretch that is taken for contact, though it was measured as none, lies there."""
    return any(
        near(each.first, known.at(first)) and near(each.last, known.at(last))
        for each in known.of(FlickerCorrection)
    )


def precedes(known: Known, _: str, at: str) -> bool:
    """It is before the segment, by no more than a border that events share."""
    return 0 < known.segment.first - known.at(at) <= 2 * known.reach


def touched_at(known: Known, body: str, other: str, at: str) -> bool:
    """A contact of the two holds then."""
    return any(covers(each, known.at(at)) for each in known.touching(body, other))


def counts_within(known: Known, _: str, told: str) -> bool:
    """Some pair that the end-effector or an object of the segment is in touches within that."""
    calibration = known.seen.observation.calibration
    assert calibration is not None
    about = {known.segment.ee, *known.segment.objects}
    return any(
        0.0 <= float(told.removesuffix(" mm")) - 1000.0 * max(pair.touch_m, pair.release_m) < 0.1
        for pair in calibration.pairs
        if about & {pair.first, pair.second}
    )


def apart_at_most(known: Known, body: str, far: str) -> bool:
    """Some other body that the segment is about is at most so far from it while they touch."""
    measured = known.seen.explainer.measured
    about = {known.segment.ee, *known.segment.objects}
    pairs = [(one, other) for one in about for other in about if one != other]
    assert measured.apart is not None
    found = (measured.apart(*pair, known.segment.first, known.segment.last) for pair in pairs)
    return any(one is not None and _is(one[1], far, slack_m=0.001) for one in found)


def apart_at_least(known: Known, body: str, far: str, other: str) -> bool:
    """They are never nearer than that, to a millimetre."""
    measured, span = known.seen.explainer.measured, known.segment
    assert measured.apart is not None
    found = measured.apart(body, name(other), span.first, span.last)
    return found is not None and _is(found[0], far, slack_m=0.001)


def far_over(known: Known, body: str, before: str, after: str, most: str, least: str) -> bool:
    """It leant so far over at most; from thirty degrees on that is far."""
    first, last = known.segment.first, known.segment.last
    calibration = known.seen.observation.calibration
    assert calibration is not None
    turns = known.turns(body, range(first, last + 1))
    up = turns.apply(np.array(calibration.body(body).upright))[:, 2]
    angles = np.degrees(np.arccos(np.clip(up, -1.0, 1.0)))
    return (
        leant(known, body, before, after)
        and abs(float(angles.max()) - float(most)) <= 1.0
        and float(least) == 30.0
    )


def moved_to_and_fro(known: Known, body: str, line: str, since: str, until_: str) -> bool:
    """On that coordinate most extrema lie at least a centimetre from those before and after."""
    first = known.frame(since) if since else known.segment.first
    last = known.frame(until_) if until_ else known.segment.last
    places = known.stream(body).positions[first:last].T
    found = dict(zip(LINES, (extrema(place, SHORT_M) for place in places), strict=True))
    return found[line] == max(found.values()) > 0


def extrema(values: np.ndarray, least: float) -> int:
    """How many extrema lie so far from the extremum before and the one after."""
    count, rising, best = 0, 0, float(values[0])
    low = high = best
    for value in map(float, values):
        low, high = min(low, value), max(high, value)
        if not rising:
            rising = 1 if value - low >= least else -1 if high - value >= least else 0
            best = value
        elif (value - best) * rising > 0.0:
            best = value
        elif (best - value) * rising >= least:
            count, rising, best = count + 1, -rising, value
    return count


def turned_in_all(
    known: Known, body: str, angle: str, half: str, path: str, wide: str, wrist: str
) -> bool:
    """The angles from frame to frame sum to it; so far from a wrist is 15 cm times the angle."""
    first, last = known.segment.first, known.segment.last
    turns = known.turns(body, range(first, last + 1))
    turned = float((turns[1:] * turns[:-1].inv()).magnitude().sum())
    steps = np.linalg.norm(np.diff(known.track(body, first, last), axis=0), axis=1).sum()
    return (
        abs(math.degrees(turned) - float(angle)) <= 0.02 * float(angle) + 1.0
        and _asked("half_turn_mrad", half)
        and _is(float(steps), path, slack_m=0.03)
        and _is(0.15 * turned, wide, slack_m=0.05)
        and _asked("wrist_mm", wrist)
    )


def too_brief(known: Known, _: str, took: str, asked: str) -> bool:
    return lasted(known, took) and _asked("rest_ms", asked) and float(took) < float(asked)


def rested_near(known: Known, body: str, far: str, at: str, asked: str) -> bool:
    """It ends so far from the nearest place of rest before, which it was at then."""
    away, frame = min(_from_rests(known, body))
    return _asked("aside_mm", asked) and _is(away, far) and near(frame, known.at(at))


def rested_there(known: Known, body: str, far: str, at: str, asked: str) -> bool:
    """The same, nearer than is told in centimetres."""
    away, frame = min(_from_rests(known, body))
    close = away < _metres(far) + SMOOTHED_M
    return _asked("aside_mm", asked) and close and near(frame, known.at(at))


def never_rested(known: Known, body: str, asked: str, at: str) -> bool:
    begun = not list(_from_rests(known, body)) and near(known.segment.first, known.at(at))
    return begun and _asked("rest_ms", asked)


def untracked(known: Known, body: str, at: str) -> bool:
    return bool(known.stream(body).lost[known.frame(at)])


def _from_rests(known: Known, body: str) -> Iterator[tuple[float, int]]:
    """How far it ends from each place where it was at rest before, or at first [m], and when."""
    rests = [
        (each.first, each.last)
        for each in known.of(Resting)
        if each.ee == body and (each.last - each.first) / known.rate >= 0.4
    ]
    touched = [each for each in known.of(Touching) if each.body == body]
    end = known.track(body, known.segment.last, known.segment.last)[0]
    for first, last in ((0, 0), *rests):
        if last <= known.segment.first and not any(
            each.first <= last and each.last >= first for each in touched
        ):
            yield _length(end - known.track(body, last, last)[0]), last


def goes_at(known: Known, _: str, angle: str, hand: str, thing: str) -> bool:
    """The level angle of its way to the line from the end-effector's middle to its own."""
    first = known.segment.first
    line = known.track(thing, first, first)[0] - known.track(hand, first, first)[0]
    return _at_angle(known, thing, line[:2], angle)


def pressed_at(known: Known, body: str, angle: str, hand: str) -> bool:
    """The level angle of its way to the direction in which a contact of the two presses."""
    ways = [
        np.array([each.x, each.y], dtype=float)
        for each in known.of(PressDirection)
        if (each.body, each.other) == (name(hand), body)
    ]
    return any(_at_angle(known, body, way, angle) for way in ways)


def _at_angle(known: Known, thing: str, line: np.ndarray, angle: str) -> bool:
    way = _shifted(known, thing)[:2]
    cosine = float(line @ way) / (_length(line) * _length(way))
    return abs(math.degrees(math.acos(min(max(cosine, -1.0), 1.0))) - float(angle)) <= 5.0


def pushed_at(known: Known, _: str, angle: str, asked: str = "45") -> bool:
    """Some contact of a body of the segment was measured to push so far off straight up."""
    about = {known.segment.ee, *known.segment.objects}
    angles = (
        math.degrees(math.acos(sign * each.permille / 1000.0))
        for each in known.of(ContactNormal)
        if about & {each.body, each.other}
        for sign in (1.0, -1.0)
    )
    return float(asked) == 45.0 and any(abs(found - float(angle)) <= 0.6 for found in angles)


def above(known: Known, body: str, rise: str, other: str, aside: str) -> bool:
    """So high above the top of the other thing, and so far aside of its box."""
    for frame in (known.segment.first, known.segment.last):
        points, middle = known.points(other, frame), known.middle(body, frame)
        beyond = np.maximum(points.min(axis=0) - middle, middle - points.max(axis=0))[:2]
        away = float(np.hypot(*np.maximum(beyond, 0.0)))
        if _is(float(middle[2] - points[:, 2].max()), rise) and (
            _is(away, aside) if aside else away < SMOOTHED_M
        ):
            return True
    return False


def moved_on(known: Known, body: str, at: str) -> bool:
    """It moves then, at the segment's end or later."""
    later = known.at(at) >= known.segment.last - 1
    return later and any(covers(each, known.at(at)) for each in known.moving(body))


def again(known: Known, body: str, other: str, until_: str, since: str) -> bool:
    """A contact of the two ends then, and a later one begins then."""
    met = known.touching(body, other) or known.touching(other, body)
    return any(near(each.last, known.at(until_)) for each in met) and any(
        near(each.first, known.at(since)) for each in met
    )


def touched_until(known: Known, body: str, other: str, at: str, until_: str) -> bool:
    """A contact of the two at the start lasts until then."""
    met = known.touching(body, other) or known.touching(other, body)
    lasts = any(near(each.last, known.at(until_)) for each in met)
    return lasts and starts(known, body, at)


def shared(known: Known, body: str, share: str) -> bool:
    """About that share of its box lies in the box of another thing of the capture."""
    low, high = known.shape(body).bounds
    axes = [np.linspace(low[axis], high[axis], 9) for axis in range(3)]
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
    frames = (known.segment.first, known.segment.last)
    return any(
        abs(100.0 * _boxed(known, body, grid, other, frame) - float(share)) <= 25.0
        for other in _bodies(known)
        if other != body and known.shape_of(other) is not None
        for frame in frames
    )


def _boxed(known: Known, body: str, points: np.ndarray, other: str, frame: int) -> float:
    world = known.turn(body, frame).apply(points) + known.stream(body).positions[frame]
    local = known.turn(other, frame).inv().apply(world - known.stream(other).positions[frame])
    low, high = known.shape(other).bounds
    return float(((local >= low) & (local <= high)).all(axis=1).mean())


def rests_from(known: Known, body: str, at: str) -> bool:
    return any(each.ee == body and covers(each, known.at(at)) for each in known.of(Resting))


def held_until(known: Known, thing: str, hand: str, at: str) -> bool:
    """The end-effector's contact with the thing ends then."""
    return any(near(each.last, known.at(at)) for each in known.touching(hand, thing))


def steep_enough(known: Known, body: str, rise: str, sense: str, asked: str, aside: str) -> bool:
    """It went so far up or down, and aside, to where it ended."""
    height = float(_shifted(known, body)[2]) * (1.0 if sense == "higher" else -1.0)
    counts = height > 0.05 - SMOOTHED_M and _asked("height_mm", asked)
    return counts and ended(known, body, rise, sense, aside)


def level_enough(known: Known, body: str, rise: str, sense: str, aside: str, asked: str) -> bool:
    """It went so far to the side, and up or down, to where it ended."""
    counts = _length(_shifted(known, body)[:2]) > 0.1 - SMOOTHED_M and _asked("aside_mm", asked)
    return counts and ended(known, body, rise, sense, aside)


def part_of_motion(known: Known, body: str, first: str, last: str) -> bool:
    """Motions of it truly begin and end then, beyond the segment."""
    moves = [each for each in known.of(Displaced) if each.object == body]
    begins = any(near(each.first, known.at(first)) for each in moves)
    return begins and any(near(each.last, known.at(last)) for each in moves)


def seen_from(known: Known, _: str, at: str) -> bool:
    """A contact begins then."""
    return any(near(each.first, known.at(at)) for each in known.of(Touching))


def kept_as_it_was(known: Known, body: str, far: str, angle: str) -> bool:
    """It is never further from the middle of where it is, nor turned further from its mean."""
    return kept_within(known, body, far) and turned_within(known, body, angle)


def turned_within(known: Known, body: str, angle: str, first: str = "", last: str = "") -> bool:
    """It is turned by no more from its mean orientation, if that is told."""
    begin = known.frame(first) if first else known.segment.first
    end = known.frame(last) if last else known.segment.last
    turns = known.turns(body, range(begin, end + 1))
    most = math.degrees(float((turns.mean().inv() * turns).magnitude().max()))
    return not angle or abs(most - float(angle)) <= 1.0


def leant_enough(known: Known, body: str, told: str, asked: str) -> bool:
    before, after = (each.lean for each in _postures(known, body))
    change = abs(math.degrees((after - before) / 1000.0))
    return abs(change - float(told)) <= 1.0 and _asked("turn_mrad", asked)


def leant_far(known: Known, _: str, thing: str, told: str) -> bool:
    """Thirty degrees are far over, and a lean of it begins or ends at a border of the segment."""
    borders = (known.segment.first, known.segment.last)
    leans = [each for each in known.of(Leans) if each.object == name(thing)]
    at = [frame for each in leans for frame in (each.first, each.last)]
    slack = 2 * known.reach
    return told == "30" and any(abs(one - other) <= slack for one in at for other in borders)


def held_alike(known: Known, body: str, other: str, at: str, hand: str) -> bool:
    """Contacts of both end-effectors with the thing begin then."""
    met = (known.touching(one, body) for one in (other, hand))
    return all(any(near(each.first, known.at(at)) for each in contacts) for contacts in met)


def held_since(known: Known, body: str, other: str, at: str, hand: str, met: str) -> bool:
    """The other one touches the thing from then, before the own one does, until its end."""
    own = any(near(each.first, known.at(met)) for each in known.touching(hand, body))
    return own and any(
        near(each.first, known.at(at))
        and each.first < known.at(met)
        and each.last >= known.segment.last
        for each in known.touching(other, body)
    )


def turned_back_so_often(known: Known, _: str, count: str) -> bool:
    return stroked(known, known.segment.ee.replace("_", " "), count)


def moved_before_contact(known: Known, body: str, hand: str, at: str) -> bool:
    """Its motion begins before their contact does then."""
    met = any(near(touch.first, known.at(at)) for touch in known.touching(hand, body))
    return met and any(
        each.object == body and each.first < known.at(at) for each in known.of(Displaced)
    )


FORMS: tuple[tuple[str, Callable[..., bool]], ...] = (
    (
        rf"ended only {LENGTH} (higher|lower)(?: and {LENGTH} to the side)? \(up and down "
        rf"count from {LENGTH} on, to the side from {LENGTH} on\)",
        too_little,
    ),
    (
        rf"ended at the same height and only ()(){LENGTH} to the side \(up and down count from "
        rf"{LENGTH} on, to the side from {LENGTH} on\)",
        too_little,
    ),
    (rf"ended {LENGTH} (higher|lower), less than the {LENGTH} that count", too_low),
    (
        rf"ended (?:{LENGTH} (higher|lower)|at the same height), not {LENGTH} or more "
        r"(higher|lower)",
        not_steep,
    ),
    (rf"ended further to the side \({LENGTH}\) than (up|down) \({LENGTH}\)", too_far_aside),
    (rf"ended further (up|down) \({LENGTH}\) than to the side \({LENGTH}\)", too_steep),
    (
        rf"(?:only|less than) {LENGTH} to the side, less than the {LENGTH} from which on a "
        "direction counts",
        too_short_for_a_direction,
    ),
    (rf"ended {LENGTH} to the side, less than the {LENGTH} that count", too_little_aside),
    (rf"ended {LENGTH} from where it began, not within {LENGTH}", too_far),
    (
        rf"ended only {LENGTH} from where it began, less than the {LENGTH} of a slide",
        too_short_to_slide,
    ),
    (rf"turned by {DEGREES} about the vertical, less than {DEGREES}", turned_too_little),
    (
        rf"leant {DEGREES} at the start and {DEGREES} at the end {POSTURE}(?: \({DEGREES} at most "
        rf"in between\))?, a change of (?:\d+(?:\.\d)?)°, less than {DEGREES}",
        leant_too_little,
    ),
    (
        rf"reached the {NAME} at a relative speed of (\d+) mm/s, less than the 1000 mm/s of a blow",
        met_gently,
    ),
    (
        rf"reached the {NAME} at a relative speed of (\d+) mm/s \(the greatest of their middles "
        r"just before they met, in any direction; a blow has 1000 mm/s or more\)",
        met_hard,
    ),
    (
        rf"had moved before this in the contact with the {NAME} that began at {TIME}",
        moved_before,
    ),
    (
        rf"had moved before in the contact with the {NAME} that began at {TIME}",
        moved_before,
    ),
    (
        rf"had moved before the contact with the {NAME} began, at {TIME}",
        moved_before_contact,
    ),
    (rf"had come to touch the {NAME} (?:before this, )?at {TIME}", met_first),
    (
        rf"was in contact with the {NAME} when the {NAME} came into contact with (?:it|them) "
        rf"\({TIME}\), and parted from (?:it|them) \(after {TIME}\)",
        let_go,
    ),
    (
        rf"came into contact with the {NAME} at {TIME}, while the {NAME} was in contact with "
        rf"(?:it|them) \(from {TIME}\), and stayed so when the [\w ]+ parted from (?:it|them) "
        rf"\(after {TIME}\)",
        took,
    ),
    (
        rf"moved along a path of {LENGTH}(?: until {TIME})? and ended (less than )?{LENGTH} from "
        "where it began",
        wound,
    ),
    (rf"ended less than {LENGTH} from where it began", ended_there),
    (rf"moved {LENGTH}", moved),
    (
        rf"ended {LENGTH} from where it (?:was|rested) at {TIME}(?:, as the recording began)? \(a "
        rf"return is within {LENGTH}"
        r"(?:; it had no rest of 0\.40 s or more, touching nothing, since"
        r"|; other places where it rested are further)?\)",
        rested_near,
    ),
    (
        rf"ended less than {LENGTH} from where it (?:was|rested) at {TIME}"
        rf"(?:, as the recording began)? \(a return is within {LENGTH}\)",
        rested_there,
    ),
    (rf"no rest of {TIME} or more, touching nothing, before {TIME}", never_rested),
    (rf"it was not tracked at {TIME}", untracked),
    (rf"came to rest at {TIME}", rests_from),
    (
        rf"after parting from it at {TIME}",
        lambda known, body, at: any(
            near(each.last, known.at(at)) for each in known.of(Touching) if each.body == body
        ),
    ),
    (
        rf"(?:before|until|when|where) the {NAME} (?:let go of|was last tracked at) (?:it|them),? "
        rf"at {TIME}",
        lambda known, _, hand, at: held_until(known, known.segment.objects[0], hand, at),
    ),
    (rf"was moved again from {TIME} on", moved_on),
    (rf"was still moving at the end \({TIME}\)", moved_on),
    (
        rf"(?:with|touched) the {NAME} at the start, but not from {TIME} to {TIME}, and again "
        r"at the end",
        again,
    ),
    (rf"the {NAME} at the start \({TIME}\) and until {TIME}", touched_until),
    (rf"met it {DEGREES} off straight up", pushed_at),
    (rf"meets it within {DEGREES} of straight up", lambda _, __, told: told == "45"),
    (rf"{DEGREES} off straight up; {DEGREES} or less bears", pushed_at),
    (
        rf"{DEGREES} off straight up as their contact began, at {TIME}, which counts while it "
        rf"lasts; {DEGREES} or less bears",
        lambda known, body, angle, at, asked: pushed_at(known, body, angle, asked)
        and any(near(each.first, known.at(at)) for each in known.of(Touching)),
    ),
    (
        rf"\(its middle {LENGTH} above the top of the {NAME} and (?:{LENGTH} aside of it|over it)"
        r"\)",
        above,
    ),
    (r"\((\d+) % of it(?: at \d+\.\d\d s)?\)", shared),
    (rf"ended {LENGTH} from where it began", ended_away),
    (
        rf"ended {LENGTH} (higher|lower) \({LENGTH} or more count(?:\)|(?=;))"
        rf"(?: and {LENGTH} to the side)?",
        steep_enough,
    ),
    (
        rf"ended (?:{LENGTH} (higher|lower) and |at the same height and |){LENGTH} to the side "
        rf"\({LENGTH} or more count(?:\)|(?=;))",
        level_enough,
    ),
    (rf"(?:\(|; )(?:(up) to {LENGTH} higher|(down) to {LENGTH} lower)"
     rf"(?: and down to {LENGTH} lower)? in between", been_beyond),
    (rf"ended {LENGTH} (higher|lower)(?: and {LENGTH} to the side)?", ended),
    (rf"ended (at the same height)() and {LENGTH} to the side",
     lambda known, body, _, sense, aside: ended(known, body, "", sense, aside)),
    (rf"ended ()(){LENGTH} to the side", ended),
    (rf"until {TIME}", until),
    (rf"slid on its rail from {NUMBER} m to {NUMBER} m open", slid),
    (rf"turned on its hinge from {NUMBER} rad to {NUMBER} rad open", swung),
    (r"turned back (\d+) times, in strokes of a finger's width and more", turned_back_so_often),
    (
        rf"moved to and fro (along the x axis|along the y axis|up and down)(?: from {TIME} to "
        rf"{TIME})?",
        moved_to_and_fro,
    ),
    (
        rf"turned by {DEGREES} in all \({DEGREES} or more count\) on a path of {LENGTH} \(up to "
        rf"{LENGTH}, {LENGTH} times that angle, count as turning in the hand\)",
        turned_in_all,
    ),
    (
        rf"at {DEGREES} to the level line from the {NAME} to the middle of the {NAME} at the start"
        r"(?:; | \()"
        r"(?:135° or more is after)?(?:, )?(?:45° or less is ahead)?",
        goes_at,
    ),
    (
        rf"at {DEGREES} to the direction in which the {NAME} pressed it; 45° or less is ahead",
        pressed_at,
    ),
    (
        rf"no rest of the {NAME} of {TIME} or more, touching nothing,",
        lambda known, _, __, told: rest_lasts(known, _, told),
    ),
    (rf"up to {LENGTH} apart", apart_at_most),
    (rf"was {LENGTH} from the {NAME} at the nearest", apart_at_least),
    (rf"the lean of the {NAME} (?:reaches|falls below) {DEGREES}", leant_far),
    (rf"the tipping of the {NAME} to {DEGREES} or more is taken to begin", leant_far),
    (rf"the righting of the {NAME} from {DEGREES} or more is taken to end", leant_far),
    (rf"as part of a motion from {TIME} to {TIME}", part_of_motion),
    (rf"from {TIME} on, and was not tracked at the start", seen_from),
    (rf"it lasted {TIME}, and a rest lasts {TIME} or more", too_brief),
    (
        rf"had been in contact with the {NAME} since {TIME}, before the {NAME} touched (?:it|them) "
        rf"at {TIME}",
        held_since,
    ),
    (rf"was in contact with the {NAME} from {TIME} on, as with the {NAME}(?=[.,;])", held_alike),
    (
        rf"leant {DEGREES} at the start and {DEGREES} at the end {POSTURE} \({DEGREES} at most; "
        rf"far over is {DEGREES} or more\)",
        far_over,
    ),
    (rf"it lasted {TIME}", lambda known, _, told: lasted(known, told)),
    (
        rf"leant {DEGREES} at the start and {DEGREES} at the end {POSTURE}, a change of "
        rf"{DEGREES} \({DEGREES} or more count\)",
        leant_by,
    ),
    (rf"leant over or was set upright by {DEGREES} \({DEGREES} or more count\)", leant_enough),
    (rf"turned by {DEGREES} about the vertical \({DEGREES} or more count\)", spun_enough),
    (rf"stayed in place \(within {LENGTH} of one place in the segment(?:; it counts as "
        rf"moved from [\d.]+ c?m on)?\)", kept_within),
    (
        rf"counted as at rest from {TIME} to {TIME}, (?:longer than|just) the 0\.40 s of a rest "
        rf"\(it stayed within {LENGTH} of one place(?: and {DEGREES} of its mean "
        r"orientation)? meanwhile(?:, and a rest is within 1 cm(?: and \d+°)?|; rests within 1 cm"
        r"(?: and \d+°)? of one place, from its first to its last slow moment, and then of "
        r"another, count as one)?\)",
        lambda known, body, first, last, far, angle: kept_within(known, body, far, first, last)
        and turned_within(known, body, angle, first, last),
    ),
    (r"longer than the (\d\.\d\d) s of a rest", rests_longer),
    (rf"(?:had no rest of|at rest for) {TIME} or more", rest_lasts),
    (rf"touched the {NAME} at {TIME}", touched_at),
    (
        rf"stayed within {LENGTH} of one place(?: and {DEGREES} of its mean orientation)? "
        r"in the segment",
        kept_as_it_was,
    ),
    (rf"less than the {LENGTH}(?: or {DEGREES})? from which on it counts as moved", counts_from),
    (rf"(?:no longer|any more) when last tracked \({TIME}\)", earlier),
    (rf"throughout but for {TIME} to {TIME}", parted),
    (rf"at the start \({TIME}\)", starts),
    (rf"at the end \({TIME}\)", ends),
    (rf"until just before \({TIME}\)", precedes),
    (r"(\d+(?:\.\d)? mm)(?= \(|\.|, | and | until beyond| on)", counts_within),
)  # fmt: skip
"""Each form in which a summary tells numbers, and how it is recomputed; the first precede."""
