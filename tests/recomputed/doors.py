"""Sentences about hinges and rails, recomputed from streams."""

import numpy as np

from recomputed.known import NAME, TIME, Known

NUMBER = r"(\d+\.\d\d)"
SLACK = 0.03
"""How far what is told may be off [m] or [rad]: a border is within a few frames of its truth."""

SHUT_M, SHUT_RAD = 0.01, 0.09
"""By less than this nothing is more or less open than it was [m], [rad]."""

STRAIGHT_M, TURNED_RAD = 0.001, 0.01
"""How far streams without noise are off a line [m] or an orientation [rad] at most."""


def gone(known: Known, what: str, frame: int) -> float:
    """How far it is from where it is in the first frame, in which the story has it closed [m]."""
    place = known.stream(what).positions
    return float(np.linalg.norm(place[frame] - place[0]))


def turned(known: Known, what: str, frame: int) -> float:
    """By which angle it is turned from there [rad]."""
    return float((known.turn(what, frame) * known.turn(what, 0).inv()).magnitude())


def slid(known: Known, what: str, first: str, last: str) -> bool:
    ends = gone(known, what, known.segment.first), gone(known, what, known.segment.last)
    still = turned(known, what, known.segment.last) < TURNED_RAD
    return still and np.allclose(ends, (float(first), float(last)), atol=SLACK)


def swung(known: Known, what: str, first: str, last: str) -> bool:
    ends = turned(known, what, known.segment.first), turned(known, what, known.segment.last)
    return bool(np.allclose(ends, (float(first), float(last)), atol=SLACK))


def opened(known: Known, what: str) -> bool:
    first, last = known.segment.first, known.segment.last
    farther = gone(known, what, last) - gone(known, what, first) >= SHUT_M
    return farther or turned(known, what, last) - turned(known, what, first) >= SHUT_RAD


def closed(known: Known, what: str) -> bool:
    first, last = known.segment.first, known.segment.last
    nearer = gone(known, what, first) - gone(known, what, last) >= SHUT_M
    return nearer or turned(known, what, first) - turned(known, what, last) >= SHUT_RAD


def on_a_rail(known: Known, what: str, base: str) -> bool:
    """Its places lie on one line, and it never turns."""
    place = known.stream(what).positions - known.stream(what).positions.mean(axis=0)
    across = np.linalg.svd(place, full_matrices=False)[1][1:] / np.sqrt(len(place))
    frames = range(0, len(place), 10)
    level = max(turned(known, what, each) for each in frames) < TURNED_RAD
    return bool(level and across.max() < STRAIGHT_M and known.stream(base) is not None)


def on_a_hinge(known: Known, what: str, base: str) -> bool:
    """A point stays where it is as it turns: some place in its frame is fixed in the world."""
    place = known.stream(what).positions
    frames = range(0, len(place), 10)
    turns = known.turns(what, frames).as_matrix()
    # R(t) q + p(t) = c at each frame: linear in q and c.
    terms = np.concatenate([np.hstack([each, -np.eye(3)]) for each in turns])
    goal = -np.concatenate([place[each] for each in frames])
    solved = np.linalg.lstsq(terms, goal, rcond=None)[0]
    left = (terms @ solved - goal).reshape(-1, 3)
    return bool(np.linalg.norm(left, axis=1).max() < STRAIGHT_M and known.stream(base) is not None)


def turned_back_on_guide(known: Known, what: str, at: str) -> bool:
    """It is nowhere as far from where it began as at that time, within a second about it."""
    frame, within = known.frame(at), round(1.0 * known.rate)
    around = range(max(frame - within, 0), min(frame + within, len(known.capture.times) - 1))
    ways = [gone(known, what, each) for each in around]
    return gone(known, what, frame) >= max(ways) - SHUT_M and min(ways) < max(ways) - SLACK


FORMS = (
    (rf"the {NAME} slid on its rail from {NUMBER} m to {NUMBER} m open", slid),
    (rf"the {NAME} turned on its hinge from {NUMBER} rad to {NUMBER} rad open", swung),
    (rf"the {NAME} was more open at the end", opened),
    (rf"the {NAME} was less open at the end", closed),
    (rf"the {NAME} went along one rail in the {NAME} throughout the recording", on_a_rail),
    (rf"the {NAME} turned about one hinge on the {NAME} throughout the recording", on_a_hinge),
    (rf"the ({'|'.join(('drawer', 'door', 'lid'))}) turned back at {TIME}", turned_back_on_guide),
)
