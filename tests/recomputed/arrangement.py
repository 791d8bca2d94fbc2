"""Sentences about directions and arrangements, recomputed from positions, turns and shapes."""

import numpy as np

from capar.model.facts import Leans, Moving, Place
from recomputed.known import NAME, TIME, Known, name, near

HEIGHT_M, ASIDE_M, TURN_RAD = 0.05, 0.10, np.radians(20.0)
"""What words of direction ask for at least, by the rules' own definitions."""

SLACK_M, SLACK_RAD = 0.003, 0.02
"""What rounding to millimetres and filtering may make [m], [rad]."""

FAR_OVER_RAD = np.radians(30.0)


def rose(known: Known, what: str) -> bool:
    x, y, z = known.way(what)
    return bool(z >= HEIGHT_M - SLACK_M and z >= np.hypot(x, y) - SLACK_M)


def sank(known: Known, what: str) -> bool:
    return bool(-known.way(what)[2] >= HEIGHT_M - SLACK_M)


def went_aside(known: Known, what: str) -> bool:
    x, y, z = known.way(what)
    return bool(np.hypot(x, y) >= max(ASIDE_M, abs(z)) - SLACK_M)


def ended_near(known: Known, what: str) -> bool:
    return bool(np.linalg.norm(known.way(what)) < ASIDE_M + SLACK_M)


def high(known: Known, what: str, height: str, at: str) -> bool:
    """The middle of its box is that high, and the measured place agrees."""
    frame = known.frame(at)
    found = {each.z for each in known.of(Place)
             if each.body == name(what) and near(each.frame, known.at(at))}  # fmt: skip
    heights = [known.middle(what, each)[2] for each in (frame - 1, frame, frame + 1)
               if 0 <= each < len(known.capture.times)]  # fmt: skip
    slack = 0.004 + max(heights) - min(heights)
    return int(height) in found and abs(float(np.median(heights)) - int(height) / 1000.0) < slack


def lean(known: Known, what: str, frame: int) -> float:
    """How far the axis that was upright in the first frame is from the vertical [rad]."""
    upright = known.turn(what, 0).inv().apply((0.0, 0.0, 1.0))
    return float(np.arccos(np.clip(known.turn(what, frame).apply(upright)[2], -1.0, 1.0)))


def leant(known: Known, what: str) -> bool:
    first, last = known.segment.first, known.segment.last
    return abs(lean(known, what, last) - lean(known, what, first)) >= TURN_RAD - SLACK_RAD


def leant_far(known: Known, what: str) -> bool:
    frames = range(known.segment.first, known.segment.last + 1)
    return max(lean(known, what, each) for each in frames) >= FAR_OVER_RAD - SLACK_RAD


def lean_border(known: Known, what: str, sense: str, at: str) -> bool:
    """A stretch of leaning far over begins then, or ends."""
    return any(
        each.object == name(what)
        and near(each.first if sense == "began" else each.last, known.at(at))
        for each in known.of(Leans)
    )


def measured_leaning(known: Known, what: str, first: str, last: str) -> bool:
    found = any(
        each.object == name(what)
        and near(each.first, known.at(first))
        and near(each.last, known.at(last))
        for each in known.of(Leans)
    )
    middle = (known.frame(first) + known.frame(last)) // 2
    return found and lean(known, what, middle) >= FAR_OVER_RAD - SLACK_RAD


def spun(known: Known, what: str) -> bool:
    """The twist about the vertical, step by step."""
    frames = range(known.segment.first, known.segment.last + 1)
    turns = known.turns(what, frames)
    twist = (turns[1:] * turns[:-1].inv()).as_rotvec()[:, 2].sum()
    return bool(abs(twist) >= TURN_RAD - SLACK_RAD)


def lay_on(known: Known, what: str, other: str, side: str) -> bool:
    """They touch, and its lowest point is about as high as the other's highest below it."""
    frame = known.border(side)
    touches = any(
        each.first - known.reach <= frame <= each.last + known.reach
        for each in known.touching(what, other)
    )
    lowest = known.points(what, frame)[:, 2].min()
    return touches and bool(abs(lowest - known.points(other, frame)[:, 2].max()) < 0.02)


def borne(known: Known, what: str, other: str, side: str, at: str | None) -> bool:
    """It lies on the other then, and a contact of the two begins when they are told to meet."""
    met = (*known.touching(what, other), *known.touching(other, what))
    return lay_on(known, what, other, side) and (
        not at or any(near(each.first, known.at(at)) for each in met)
    )


def was_above(known: Known, what: str, other: str, side: str) -> bool:
    """Higher than its top, and no further beside it than higher."""
    frame = known.border(side)
    own, others = known.points(what, frame), known.points(other, frame)
    middle = known.middle(what, frame)
    top = others[:, 2].max()
    beyond = np.maximum(others.min(axis=0) - middle, middle - others.max(axis=0))[:2]
    aside = np.hypot(*np.maximum(beyond, 0.0))
    return bool(own[:, 2].min() >= top - 0.011 and aside <= middle[2] - top + SLACK_M)


def was_inside(known: Known, what: str, other: str, side: str) -> bool:
    """At least half of its box lies in the other's box."""
    low, high = known.shape(what).bounds
    axes = [np.linspace(low[axis], high[axis], 9) for axis in range(3)]
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
    return float(_within(known, what, grid, other, known.border(side)).mean()) >= 0.45


def dipped(known: Known, what: str, other: str, side: str) -> bool:
    """Some corner of it lies in the other's box."""
    return bool(
        _within(known, what, np.array(known.shape(what).vertices), other, known.border(side)).any()
    )


def _within(known: Known, what: str, points: np.ndarray, other: str, frame: int) -> np.ndarray:
    world = known.turn(what, frame).apply(points) + known.stream(what).positions[frame]
    local = known.turn(other, frame).inv().apply(world - known.stream(other).positions[frame])
    low, high = known.shape(other).bounds
    return ((local >= low) & (local <= high)).all(axis=1)


def went_ahead(known: Known, what: str, hand: str) -> bool:
    """Away from the end-effector's middle, or from where that is nearest to its surface."""
    return _about(known, what, hand) and (
        _cosine(known) > 0.65 or (_cosine(known) > 0.0 and _pressing(known) > 0.65)
    )


def went_after(known: Known, what: str, hand: str) -> bool:
    return _about(known, what, hand) and _cosine(known) < -0.65


def _about(known: Known, what: str, hand: str) -> bool:
    return (known.segment.objects[0], known.segment.ee) == (name(what), name(hand))


def _cosine(known: Known) -> float:
    """Between the level way from the end-effector to the object and the object's own way."""
    what, first = known.segment.objects[0], known.segment.first
    ahead = (known.middle(what, first) - known.middle(known.segment.ee, first))[:2]
    goes = known.way(what)[:2]
    lengths = np.linalg.norm(ahead) * np.linalg.norm(goes)
    return float(ahead @ goes / lengths) if lengths else 0.0


def _pressing(known: Known) -> float:
    """The same with the way from the end-effector to the nearest place of the object."""
    what, first = known.segment.objects[0], known.segment.first
    ahead = known.nearest_way(known.segment.ee, what, first)[:2]
    goes = known.way(what)[:2]
    lengths = np.linalg.norm(ahead) * np.linalg.norm(goes)
    return float(ahead @ goes / lengths) if lengths else 0.0


def came_to_lie(known: Known, what: str, stilled: str | None, hand: str, at: str) -> bool:
    """It came down, and where it is then it is when the hand leaves it; its motion ends before."""
    left = known.frame(at)
    ends = [move.last for move in known.of(Moving) if move.object == name(what)]
    if stilled and not any(near(end, known.at(stilled)) for end in ends):
        return False
    if not any(near(each.last, left) for each in known.touching(hand, what)):
        return False
    place = known.stream(what).positions
    way = np.linalg.norm(place[left] - place[known.segment.last])
    return sank(known, what) and bool(way < 0.012)


FORMS = (
    (rf"the {NAME} went up, more than aside", rose),
    (rf"the {NAME} came down", sank),
    (rf"the {NAME} went aside, more than up or down", went_aside),
    (rf"the {NAME} ended near where it began", ended_near),
    (rf"the middle of the {NAME} was (\d+) mm above the zero of heights at {TIME}", high),
    (rf"the {NAME} leant at another angle at the end than at the start", leant),
    (rf"the {NAME} leant far over", leant_far),
    (rf"the {NAME} (began|ceased) to lean far over at {TIME}", lean_border),
    (rf"leaning of the {NAME} far over was measured from {TIME} to {TIME}", measured_leaning),
    (rf"the {NAME} turned about the vertical", spun),
    (
        rf"the {NAME} bore the {NAME} from below at the segment's (start|end)"
        rf"(?: \(\d+° off straight up as their contact began, at {TIME}, which counts while it "
        r"lasts; 45° or less bears\))?",
        lambda known, below, what, side, at: borne(known, what, below, side, at),
    ),
    (rf"the {NAME} was above the {NAME} at the segment's (start|end)", was_above),
    (rf"the {NAME} was inside the {NAME} at the segment's (start|end)", was_inside),
    (rf"the {NAME} dipped into the {NAME} at the segment's (start|end)", dipped),
    (
        rf"the {NAME} went, on the whole, ahead of the {NAME} "
        r"\([^)]*; 45° or less is ahead\)",
        went_ahead,
    ),
    (
        rf"the {NAME} went, on the whole, after the {NAME} "
        r"\([^)]*; 135° or more is after\)",
        went_after,
    ),
    (
        rf"the {NAME} (?:did not move from the end until|came down to where|came down and did not "
        rf"count as moving from {TIME} until) the {NAME} (?:let go of it|was last tracked at it,) "
        rf"at {TIME}(?: \(taken for letting go\))?"
        r"(?:, in contact with no other recorded or assumed object)?",
        came_to_lie,
    ),
)
