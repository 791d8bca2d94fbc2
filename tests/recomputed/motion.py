"""Sentences about motion and rest, recomputed from streams."""

from collections.abc import Sequence

import numpy as np
from motions.rolling import CAN

from capar.model.facts import Flies, Lengthwise, Rolls, Swings, Touching
from recomputed.known import NAME, ROUNDED, TIME, Known, name, near

GONE_M, GONE_RAD = 0.009, 0.07
"""What has left its place is further away than this [m], [rad]."""

CREEP_S = 0.6
"""A motion may begin so long before, and end so long after, the floor of motion tells of it [s]."""

SETTLED_M = 0.015
"""An end-effector that rests sways less than this [m]."""

SETTLED_RAD = 0.1
"""A head that turns to another thing turns by more [rad]."""

GRAVITY = np.array([0.0, 0.0, -9.81])


def moved(known: Known, what: str, distance: str, first: str, last: str) -> bool:
    """It is displaced by so much, or, where no distance is told, elsewhere meanwhile.

    A time that is told of motion may be that of an impact, of which smoothing blurs one step.
    """
    begin, end = known.frame(first), known.frame(last)
    place = known.track(what, begin, end)
    way = float(np.linalg.norm(place[-1] - place[0]))
    if distance:
        step = max(float(np.linalg.norm(place[at] - place[at - 1])) for at in (1, -1))
        return abs(way - float(distance)) < 0.02 + step
    far = _apart(known, what, range(begin, end + 1), begin)
    return way < 0.015 and float(far.max()) > 1.0


def went(known: Known, what: str, path: str, first: str, last: str, ended: str) -> bool:
    """Its steps sum to the path, and it is displaced by so much at the end."""
    place = known.stream(what).positions[known.frame(first) : known.frame(last) + 1]
    steps = float(np.linalg.norm(np.diff(place, axis=0), axis=1).sum())
    straight = float(np.linalg.norm(place[-1] - place[0]))
    return abs(steps - float(path)) < 0.03 and abs(straight - float(ended)) < 0.02


def drifted(known: Known, what: str, drift: str, first: str, last: str) -> bool:
    """It stays, and is displaced by so much, or, where nothing is told, by next to nothing."""
    place = known.stream(what).positions
    way = float(np.linalg.norm(place[known.frame(last)] - place[known.frame(first)]))
    told = abs(way - float(drift or 0) / 1000.0) < (0.003 if drift else 0.008)
    return told and stayed(known, what, first, last)


def went_further(known: Known, what: str) -> bool:
    """It ends half the width of a hand away, or its path is as long as a hand is wide."""
    track = known.track(what, known.segment.first, known.segment.last)
    path = float(np.linalg.norm(np.diff(track, axis=0), axis=1).sum())
    return float(np.linalg.norm(track[-1] - track[0])) > 0.045 or path > 0.09


def stayed(known: Known, what: str, first: str, last: str) -> bool:
    """It is where it is at the end all along, but for what moves in a merged border."""
    begin, end = known.frame(first), known.frame(last)
    inner = range(min(begin + round(known.reach), end), max(end - round(known.reach), begin) + 1)
    middle = (begin + end) // 2
    return bool((_apart(known, what, inner, middle) <= 1.2).all())


SIDE_S = 0.2
"""How long before and after it the direction of a path is taken [s]."""


def _apart(
    known: Known, what: str, frames: Sequence[int], others: int | Sequence[int]
) -> np.ndarray:
    """How far it is at some frames from where it is at others, by the least that counts [1]."""
    stream = known.stream(what)
    way = np.linalg.norm(stream.positions[list(frames)] - stream.positions[others], axis=1)
    turn = (known.turns(what, frames) * known.turns(what, others).inv()).magnitude()
    return np.maximum(way / GONE_M, turn / GONE_RAD)


def gone_at_once(known: Known, what: str) -> bool:
    """Soon after the segment's end it is not any more where it is then, and did not move before."""
    begin, end = known.segment.first, known.segment.last
    soon = min(end + round(0.3 * known.rate), len(known.capture.times) - 1)
    early = max(end - round(0.3 * known.rate), begin)
    before = _apart(known, what, [early], max(early - round(0.1 * known.rate), 0))
    return float(_apart(known, what, [soon], end)[0]) > 1.0 > float(before[0])


def level_from(known: Known, what: str, at: str, other: str) -> bool:
    """Its path becomes less steep than 45 degrees then, and steeper at the other time."""
    begins = _levelled(known, what, known.frame(at), begins=True)
    return begins and known.at(at) < known.at(other)


def level_until(known: Known, what: str, at: str, other: str) -> bool:
    """Its path becomes steeper than 45 degrees then."""
    ends = _levelled(known, what, known.frame(at), begins=False)
    return ends and (not other or known.at(other) < known.at(at))


def _levelled(known: Known, what: str, frame: int, *, begins: bool) -> bool:
    """Its path is steeper than 45 degrees before that frame and less after it, or reversed."""
    aside = round(SIDE_S * known.rate)
    place, last = known.stream(what).positions, len(known.capture.times) - 1
    ways = [
        place[min(max(end, 0), last)] - place[min(max(begin, 0), last)]
        for begin, end in ((frame - aside, frame), (frame, frame + aside))
    ]
    steep = [abs(float(way[2])) - float(np.linalg.norm(way[:2])) for way in ways]
    before, after = steep if begins else reversed(steep)
    return after < 0.0 < before


def measured(known: Known, what: str, first: str, last: str) -> bool:
    return any(
        near(each.first, known.at(first)) and near(each.last, known.at(last))
        for each in known.moving(what)
    )


def left_place(known: Known, what: str, at: str, counts: str) -> bool:
    """Where it rested shortly before it is not any more; what counts is that or a bit earlier."""
    early = known.at(at) - known.at(counts)
    return -ROUNDED <= early <= CREEP_S * known.rate + 1 and _parts(known, what, at, -1)


def came_to_place(known: Known, what: str, at: str, counts: str) -> bool:
    """The same backwards."""
    late = known.at(counts) - known.at(at)
    return -ROUNDED <= late <= CREEP_S * known.rate + 1 and _parts(known, what, at, 1)


def _parts(known: Known, what: str, at: str, sign: int) -> bool:
    """It is just out of the place where it is slowest within a third of a second."""
    frame, last = known.frame(at), len(known.capture.times) - 1
    frames = [frame + sign * each for each in range(round(0.35 * known.rate))]
    side = [each for each in frames if 0 <= each <= last]
    steps = _apart(known, what, side, [max(each - 1, 0) for each in side])
    rest = side[int(np.argmin(steps))]
    return 0.8 < float(_apart(known, what, [rest], frame)[0]) < 2.5 and float(steps.min()) < 0.1


def rested(known: Known, what: str, first: str, last: str) -> bool:
    begin, end = known.frame(first), known.frame(last)
    place = known.stream(what).positions[begin : end + 1]
    return bool(np.linalg.norm(place - np.median(place, axis=0), axis=1).max() < SETTLED_M)


def rested_free(known: Known, what: str, first: str, last: str) -> bool:
    begin, end = known.at(first), known.at(last)
    hand = [each for each in known.of(Touching) if each.body == what.replace(" ", "_")]
    free = all(each.last < begin + ROUNDED or each.first > end - ROUNDED for each in hand)
    return free and rested(known, what, first, last)


def measured_rest(known: Known, what: str, first: str, last: str) -> bool:
    return rested(known, what, first, last) and any(
        near(each.first, known.at(first)) and near(each.last, known.at(last))
        for each in known.resting(what)
    )


def came_back(known: Known, what: str) -> bool:
    """At the end it is within a hand's width of where it was first, or rested since."""
    place, border = known.stream(what).positions, known.segment.last
    before = [0, *(min(each.last, border) for each in known.resting(what))]
    stays = [frame for frame in before if frame < known.segment.first]
    return bool(any(np.linalg.norm(place[border] - place[frame]) < 0.12 for frame in stays))


def came_elsewhere(known: Known, what: str, far: str, unit: str, at: str) -> bool:
    """It ends so far from where it was then, and no place of rest before is nearer."""
    place, border = known.stream(what).positions, known.segment.last
    told = float(far) * {"mm": 0.001, "cm": 0.01, "m": 1.0}[unit]
    away = float(np.linalg.norm(place[border] - place[known.frame(at)]))
    return not came_back(known, what) and abs(away - told) <= 0.02 + 0.05 * (unit == "m")


def never_rested(known: Known, what: str, at: str) -> bool:
    """No rest before lasts so long while it touches nothing."""
    first = known.segment.first
    touched = [each for each in known.of(Touching) if each.body == name(what)]
    rests = [
        each
        for each in known.resting(what)
        if each.last <= first and each.last - each.first >= 0.4 * known.rate
    ]
    free = [
        each
        for each in rests
        if not any(met.first <= each.last and met.last >= each.first for met in touched)
    ]
    return near(first, known.at(at)) and not free


def came_to_rest(known: Known, what: str, at: str) -> bool:
    return _turned_from_rest(known, what, known.frame(at), 1)


def left_rest(known: Known, what: str, at: str) -> bool:
    return _turned_from_rest(known, what, known.frame(at), -1)


def _turned_from_rest(known: Known, what: str, frame: int, sign: int) -> bool:
    """On the one side of the instant it stays, on the other it was elsewhere."""
    place, last = known.stream(what).positions, len(known.capture.times) - 1
    after = [min(max(frame + sign * each, 0), last) for each in range(round(0.3 * known.rate))]
    before = min(max(frame - sign * round(0.5 * known.rate), 0), last)
    stays = np.linalg.norm(place[after] - place[frame], axis=1).max() < SETTLED_M
    came = np.linalg.norm(place[before] - place[frame]) > SETTLED_M
    turned = (known.turn(what, before) * known.turn(what, frame).inv()).magnitude() > SETTLED_RAD
    return bool(stays and (came or turned))


def turned_back(known: Known, what: str, at: str) -> bool:
    """Its height has an extremum there, and is well away from it before and after."""
    frame, height = known.frame(at), known.stream(what).positions[:, 2]
    within = round(0.7 * known.rate)
    sides = (height[max(frame - within, 0) : frame + 1], height[frame : frame + within])
    for sign in (1.0, -1.0):
        top = all((sign * (height[frame] - side)).min() > -0.003 for side in sides)
        if top and all((sign * (height[frame] - side)).max() > 0.02 for side in sides):
            return True
    return False


def turned_round(known: Known, what: str, at: str) -> bool:
    """It is slower than before and after."""
    speed = np.linalg.norm(np.gradient(known.stream(what).positions, axis=0), axis=1) * known.rate
    frame, side = known.frame(at), round(0.15 * known.rate)
    return bool(speed[frame] < 0.3 and speed[frame] < speed[frame - side] + 0.02
                and speed[frame] < speed[frame + side] + 0.02)  # fmt: skip


def stroked(known: Known, what: str, count: str) -> bool:
    """What the hand holds turns back so often along the line of most of its motion."""
    thing = known.segment.objects[0]
    place = known.stream(thing).positions[known.segment.first : known.segment.last + 1]
    offsets = place - place.mean(axis=0)
    along = offsets @ np.linalg.svd(offsets, full_matrices=False)[2][0]
    found = _turning_points(along)
    return what == known.segment.ee.replace("_", " ") and abs(found - int(count)) <= 2


def lasted(known: Known, at: str) -> bool:
    """The segment does, from its first frame to its last."""
    return abs((known.segment.last - known.segment.first) / known.rate - float(at)) < 0.011


def wrung(known: Known, what: str) -> bool:
    """Its turning adds up to half a turn, and its way to no more than 15 cm for each radian."""
    frames = range(known.segment.first, known.segment.last + 1)
    turns = known.turns(what, frames)
    turned = float((turns[1:] * turns[:-1].inv()).magnitude().sum())
    place = known.stream(what).positions[frames[0] : frames[-1] + 1]
    way = float(np.linalg.norm(np.diff(place, axis=0), axis=1).sum())
    return turned > 0.9 * np.pi and way < 0.17 * turned


def to_and_fro(known: Known, what: str, first: int, last: int) -> bool:
    """It turns back at least four times along an axis, a centimetre or more each time."""
    place = known.stream(what).positions[first : last + 1]
    return max(_turning_points(place[:, axis]) for axis in range(3)) >= 4


def _turning_points(values: np.ndarray) -> int:
    signs = np.sign(np.diff(values))
    extrema = [values[0], *values[1:-1][np.diff(signs) != 0], values[-1]]
    return int((np.abs(np.diff(extrema)) > 0.01).sum()) - 1


def swung(known: Known, what: str) -> bool:
    return to_and_fro(known, what, known.segment.first, known.segment.last)


def swung_within(known: Known, what: str) -> bool:
    """It is moved to and fro in the segment for longer than before, or long enough to turn back."""
    first, last = known.segment.first, known.segment.last
    return any(
        each.first >= first
        or min(each.last, last) - first >= min(first - each.first, 0.9 * known.rate)
        for each in known.of(Swings)
        if each.body == what.replace(" ", "_") and each.first < last and each.last >= first
    )


def swing_border(known: Known, what: str, sense: str, at: str) -> bool:
    """A stretch of motion to and fro begins then, or ends."""
    return any(
        each.body == what.replace(" ", "_")
        and near(each.first if sense == "began" else each.last, known.at(at))
        for each in known.of(Swings)
    )


def swung_on(known: Known, what: str, first: str, last: str, before_s: str, within_s: str) -> bool:
    """It is so moved then, from before the segment's start, and not only the rest of it is left."""
    start, end = known.segment.first, known.segment.last
    begin, ended = known.at(first), known.at(last)
    shares = (start - begin) / known.rate, (min(ended, end) - start) / known.rate
    told = float(before_s), float(within_s)
    alike = all(abs(one - other) <= 0.02 for one, other in zip(shares, told, strict=True))
    return alike and measured_swings(known, what, first, last) and swung_within(known, what)


def measured_swings(known: Known, what: str, first: str, last: str) -> bool:
    found = any(
        each.body == what.replace(" ", "_")
        and near(each.first, known.at(first))
        and near(each.last, known.at(last))
        for each in known.of(Swings)
    )
    return found and to_and_fro(known, what, known.frame(first), known.frame(last))


def went_lengthwise(known: Known, what: str) -> bool:
    """More of its path is along its longest side than the cosine of 45 degrees takes."""
    span = slice(known.segment.first, known.segment.last + 1)
    (thing,) = [each for each in known.capture.objects if each.name == what.replace(" ", "_")]
    assert thing.shape is not None
    sizes = np.sort(thing.shape.size)
    side = np.eye(3)[int(np.argmax(thing.shape.size))]
    steps = np.diff(known.stream(what).positions[span], axis=0)
    axes = np.array(known.turns(what, range(span.start, span.stop - 1)).apply(side))
    along = np.abs((steps * axes).sum(axis=1)).sum() / np.linalg.norm(steps, axis=1).sum()
    return bool(sizes[2] > 3.0 * sizes[1] and along > 0.7)


def measured_lengthwise(known: Known, what: str, first: str, last: str) -> bool:
    found = any(
        each.body == what.replace(" ", "_")
        and near(each.first, known.at(first))
        and near(each.last, known.at(last))
        for each in known.of(Lengthwise)
    )
    return found and went_lengthwise(known, what)


def rolled(known: Known, what: str) -> bool:
    """The can's turn about its axis is its way over its radius."""
    ends = [known.segment.first, known.segment.last]
    way = np.linalg.norm(np.diff(known.stream(what).positions[ends], axis=0))
    turns = known.turns(what, ends)
    return bool(abs((turns[1] * turns[0].inv()).magnitude() - way / CAN[0]) < 0.05 and way > 0.02)


def measured_rolling(known: Known, what: str, first: str, last: str) -> bool:
    return any(
        near(each.first, known.at(first)) and near(each.last, known.at(last))
        for each in known.of(Rolls)
        if each.object == what.replace(" ", "_")
    )


def falls(known: Known, what: str, first: float, last: float) -> bool:
    """Its acceleration between two frames is gravity's."""
    place = known.stream(what).positions[round(first) : round(last) + 1]
    found = np.diff(place, n=2, axis=0).mean(axis=0) * known.rate**2
    return bool(np.linalg.norm(found - GRAVITY) < 0.3 * 9.81)


def measured_fall(known: Known, what: str, first: str, last: str) -> bool:
    begin, end = known.at(first), known.at(last)
    measured = any(near(each.first, begin) and near(each.last, end) for each in known.of(Flies))
    return measured and falls(known, what, begin, end)


def flew_until_touched(known: Known) -> bool:
    """The contact that begins where the segment ends stops its fall."""
    what = known.segment.objects[0]
    begins = [
        each.first
        for each in known.touching(known.segment.ee, what)
        if abs(each.first - known.segment.last) <= known.reach
    ]
    return any(falls(known, what, each - 0.2 * known.rate, each - 2) for each in begins)


def flew_on(known: Known) -> bool:
    what = known.segment.objects[0]
    let_go = max(each.last for each in known.touching(known.segment.ee, what)
                 if each.first < known.segment.last)  # fmt: skip
    return falls(known, what, let_go + 2, let_go + 0.3 * known.rate)


FORMS = (
    (
        rf"the {NAME} ended 5 cm or more from where it began, or went along a path of 10 cm or "
        "more: a grip alone shifts a thing less",
        went_further,
    ),
    (rf"the {NAME} (began|ceased) to be moved to and fro at {TIME}", swing_border),
    (rf"the {NAME} was gone at once", gone_at_once),
    (
        rf"the path of the {NAME} led more to the side than up or down from {TIME} on "
        rf"\(until {TIME}\)",
        level_from,
    ),
    (
        rf"the path of the {NAME} led more to the side than up or down until {TIME}"
        rf"(?: \(from {TIME} on\))?",
        level_until,
    ),
    (rf"the {NAME} moved(?: (\d+\.\d\d) m)? between {TIME} and {TIME}", moved),
    (
        rf"the {NAME} moved along (\d+\.\d\d) m of path between {TIME} and {TIME}, and ended "
        r"(\d+\.\d\d) m from where it began",
        went,
    ),
    (
        rf"the {NAME} stayed where it was(?:, but for (\d+) mm, too little to count as motion,)? "
        rf"between {TIME} and {TIME}",
        drifted,
    ),
    (rf"motion of the {NAME} to and fro was measured from {TIME} to {TIME}", measured_swings),
    (rf"motion of the {NAME} was measured from {TIME} to {TIME}", measured),
    (rf"rolling of the {NAME} was measured from {TIME} to {TIME}", measured_rolling),
    (rf"free fall of the {NAME} was measured from {TIME} to {TIME}", measured_fall),
    (rf"rest of the {NAME} was measured from {TIME} to {TIME}", measured_rest),
    (rf"the {NAME} turned as it went, without slipping", rolled),
    (rf"the {NAME} was moved to and fro", swung),
    (
        rf"of the motion of the {NAME} to and fro from {TIME} to {TIME}, (\d+\.\d\d) s lie before "
        r"the segment and (\d+\.\d\d) s in it",
        swung_on,
    ),
    (rf"no motion of the {NAME} to and fro had begun before the segment", swung_within),
    (rf"the {NAME}, long and thin, went along its own length", went_lengthwise),
    (
        rf"lengthwise motion of the {NAME} was measured from {TIME} to {TIME}",
        measured_lengthwise,
    ),
    (
        rf"the {NAME} moved, from {TIME} on clearly; with its slow beginning from {TIME} on",
        left_place,
    ),
    (
        rf"the {NAME} moved, until {TIME} clearly; with its slow end until {TIME}",
        came_to_place,
    ),
    (
        rf"the {NAME} rested and touched no recorded or assumed object from {TIME} to {TIME}",
        rested_free,
    ),
    (rf"the {NAME} came to rest at {TIME}", came_to_rest),
    (rf"it ended where the {NAME} had rested before", came_back),
    (
        rf"the {NAME} ended (\d+(?:\.\d)?) (mm|cm|m) from where it (?:was|rested) at {TIME}"
        r"(?:, as the recording began)? \(a return is within 10 cm"
        r"(?:; it had no rest of 0\.40 s or more, touching nothing, since"
        r"|; other places where it rested are further)?\)",
        came_elsewhere,
    ),
    (
        rf"the {NAME} had no known posture to resume \(it was not tracked at {TIME}\)",
        lambda known, what, at: bool(known.stream(what).lost[known.frame(at)]),
    ),
    (
        rf"the {NAME} had no posture to resume \(no rest of 0\.40 s or more, touching nothing, "
        rf"before {TIME}\)",
        never_rested,
    ),
    (rf"the {NAME} began to move at {TIME}", left_rest),
    (rf"the {NAME} turned back at {TIME}", turned_back),
    (rf"the {NAME} reversed its direction at {TIME}", turned_round),
    (
        rf"what the {NAME} held turned back (\d+) times, in strokes of a finger's width and more",
        stroked,
    ),
    (r"it lasted (\d+\.\d\d) s", lasted),
    (
        rf"the {NAME} turned by more than half a turn in all, "
        r"and went no further than the wrist takes it",
        wrung,
    ),
    (r"the object flew until it was touched", flew_until_touched),
    (r"it flew on when it was let go", flew_on),
)
