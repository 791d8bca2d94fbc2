"""What end-effectors touch at the same time: contacts of others with what one touches."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence

from capar.model.facts import Fact, Touching
from capar_rules.borders.ticks import Meanwhile, Shares
from capar_rules.borders.times import in_frames, times

Contacts = Mapping[str, Sequence[Touching]]
"""Contacts of one end-effector by what it touches, each in order of time and disjoint."""


def by_object(touching: Iterable[Touching]) -> dict[str, list[Touching]]:
    """Contacts of one end-effector, in order of time, by what it touches."""
    out: dict[str, list[Touching]] = {}
    for touch in touching:
        out.setdefault(touch.other, []).append(touch)
    return out


def overlapping(
    own: Iterable[Touching], others: Sequence[Contacts]
) -> list[tuple[Touching, Touching]]:
    """Each contact of an end-effector with those of others that share a frame and the object."""
    return [
        (touch, each)
        for touch in own
        for contacts in others
        for each in _sharing(contacts.get(touch.other, ()), touch)
    ]


def _sharing(contacts: Sequence[Touching], touch: Touching) -> Sequence[Touching]:
    first = bisect_left(contacts, touch.first, key=lambda each: each.last)
    return contacts[first : bisect_right(contacts, touch.last, key=lambda each: each.first)]


def shared(
    ee: str, ticks: Sequence[int], pairs: Iterable[tuple[Touching, Touching]], *, rate_hz: float
) -> Iterator[Fact]:
    """Which contact of another end-effector came before or goes on after one's own, and when.

    Args:
        ee: The end-effector.
        ticks: Frames of its link's ticks, ascending.
        pairs: Its own contacts, each with one of another end-effector.
        rate_hz: Frames a second [Hz].
    """
    margin = in_frames(times().merge_ms, rate_hz)
    for touch, each in pairs:
        begins, ends = each.first - touch.first, each.last - touch.last
        if begins < -margin and ends < -margin:
            yield Shares(ee, touch.other, touch.first, each.body, "before")
        if begins > margin and ends > margin:
            yield Shares(ee, touch.other, touch.first, each.body, "after")
        latest = len(ticks) - 2
        if begins >= 0:
            tick = min(bisect_right(ticks, each.first) - 1, latest)
            yield Meanwhile(ee, tick, "begins", each.body, touch.other, each.first)
        if ends <= 0:
            tick = max(bisect_left(ticks, each.last) - 1, 0)
            yield Meanwhile(ee, tick, "ends", each.body, touch.other, each.first)
