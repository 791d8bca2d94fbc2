"""Rest that nothing disturbs: an end-effector rests and touches nothing, or nothing any more."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence
from itertools import accumulate

from capar.model.facts import Resting, Touching
from capar_rules.borders.ticks import Undisturbed


def undisturbed(
    ee: str, ticks: Sequence[int], rests: Iterable[Resting], own: Sequence[Touching]
) -> Iterator[Undisturbed]:
    """The rests of an end-effector in which no contact of its own has a tick, or none any more.

    Of a rest in which it is relieved of all that it touches, what follows from there on counts: a
    palm from which the last thing is taken rests on. Each costs two searches, however many ticks or
    contacts it holds.

    Args:
        ee: The end-effector.
        ticks: The frames of its link's ticks, in order.
        rests: When it rests.
        own: Its contacts, by their first frames.
    """
    begins = [each.first for each in own]
    latest = list(accumulate((each.last for each in own), max))
    for rest in rests:
        first, last = bisect_left(ticks, rest.first), bisect_right(ticks, rest.last) - 1
        if first > last:
            continue
        before = bisect_right(begins, ticks[last])
        if before == 0 or latest[before - 1] < ticks[first]:
            yield Undisturbed(ee, first, last)
        elif ticks[first] < latest[before - 1] < ticks[last]:
            yield Undisturbed(ee, bisect_left(ticks, latest[before - 1]), last)
