"""What touches only through a third body does not touch: a ball in a bowl and the table below."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from extractors.bodies.poses import rotation_matrices
from extractors.contact.proximity import Body, distance, nearest
from extractors.signals.intervals import Interval

ASKED_FRAMES = 5
"""At how many frames it is asked whether a body is in between [1]; most of them decide."""


Meeting = tuple[str, str, Interval]
"""The names of two bodies that touch, and the frames in which they do."""


def screened(
    meetings: Sequence[Meeting],
    bodies: Mapping[str, Body],
    screens: Iterable[str],
    *,
    reach_m: float,
) -> Iterator[tuple[Interval, ...]]:
    """For each meeting the intervals in which a third body is between the two.

    Bodies touch if their surfaces are within a tolerance, which reaches through a thin wall. A
    third body is between two if it touches both, and the line that joins their nearest points
    goes through it. The line is made longer at both ends, by as much as surfaces that touch may
    seem to cut each other. What cuts each other has nothing between, and what is between two is
    no further from either than they are from each other: of a ball in a bowl on a floor, the floor
    is not between the ball and the bowl, although the longer line reaches it.

    Args:
        meetings: Contacts.
        bodies: Surfaces with their poses, by name.
        screens: Names of bodies that may be in between.
        reach_m: By how much the line is made longer at either end [m].
    """
    touches: dict[str, dict[str, list[Interval]]] = defaultdict(lambda: defaultdict(list))
    for one, two, span in meetings:
        touches[one][two].append(span)
        touches[two][one].append(span)
    for one, two, span in meetings:
        common = set(touches[one]) & set(touches[two]) & set(screens) & set(bodies)
        yield tuple(
            sorted(
                part
                for third in common
                if one in bodies and two in bodies
                for part in _common(span, touches[one][third], touches[two][third])
                if _parted((bodies[one], bodies[two], bodies[third]), part, reach_m)
            )
        )


def _common(
    span: Interval, ones: Iterable[Interval], twos: Iterable[Interval]
) -> Iterator[Interval]:
    """The frames of an interval that lie in one of either kind as well."""
    then = [two for two in twos if two[0] <= span[1] and two[1] >= span[0]]
    for one in ones:
        for two in then if one[0] <= span[1] and one[1] >= span[0] else ():
            first, last = max(span[0], one[0], two[0]), min(span[1], one[1], two[1])
            if first <= last:
                yield first, last


def _parted(meeting: tuple[Body, Body, Body], span: Interval, reach_m: float) -> bool:
    """Whether the third of three bodies is between the others, at most of some frames."""
    frames = np.unique(np.linspace(*span, ASKED_FRAMES).round().astype(int))
    most, asked = len(frames) // 2 + 1, iter(frames)
    needed, spare = most, len(frames) - most
    while needed > 0 and spare >= 0:
        if _between(*meeting, int(next(asked)), reach_m):
            needed -= 1
        else:
            spare -= 1
    return needed == 0


def _between(one: Body, two: Body, third: Body, frame: int, reach_m: float) -> bool:
    """Whether the line that joins two bodies' nearest points goes through a third at a frame."""
    if any(np.isnan(each.positions[frame]).any() for each in (one, two, third)):
        return False
    apart_m, on_one, on_two = nearest(one, two, frame)
    if apart_m <= 0.0 or any(distance(each, third, frame) > apart_m for each in (one, two)):
        return False
    begin, end = _local(third, one, on_one, frame), _local(third, two, on_two, frame)
    middle = 0.5 * (begin + end)
    if third.surface.contains(middle[None])[0]:
        return True
    beyond = reach_m / apart_m * (end - begin)
    begin, end = begin - beyond, end + beyond
    way = (end - begin)[None]
    places, _, _ = third.surface.mesh.ray.intersects_location(begin[None], way)
    along = (places - begin) @ way[0] / float(way[0] @ way[0])
    return bool(((along >= 0.0) & (along <= 1.0)).any())


def _local(base: Body, other: Body, point: np.ndarray, frame: int) -> np.ndarray:
    """A point of the other's frame [m] in the base's."""
    turn = rotation_matrices(other.orientations[frame][None])[0]
    back = rotation_matrices(base.orientations[frame][None])[0].T
    world = turn @ point + other.positions[frame]
    return np.asarray(back @ (world - base.positions[frame]))
