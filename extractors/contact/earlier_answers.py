"""Contacts at poses that were asked about before: windows of a live recording overlap."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Int

from extractors.contact.proximity import Body, near


@dataclass(frozen=True, eq=False)
class _Asked:
    """A question about two bodies, and its answer."""

    first: int
    one: Body
    two: Body
    answer: Bool[np.ndarray, "frames"]


class EarlierAnswers:
    """What was answered in the window before; asked anew is only where a pose differs.

    The same poses have the same answer, so that nothing has to be known about filters: frames near
    the end of a window, whose low-passed poses later frames change, are asked about again.
    """

    def __init__(self) -> None:
        self._first = 0
        self._asked: dict[tuple[str, str, float], _Asked] = {}

    def begin(self, first: int) -> None:
        """Begin a window.

        Args:
            first: The frame of the recording that is the window's first.
        """
        self._first = first

    def near(
        self, names: tuple[str, str], one: Body, two: Body, *, distance_m: float
    ) -> Bool[np.ndarray, "frames"]:
        """What ``extractors.contact.proximity.near`` answers.

        Args:
            names: The names of the two bodies.
            one: The first body through the window.
            two: The second one.
            distance_m: Distance up to which they are near [m].
        """
        known = self._asked.get((*names, distance_m))
        out = np.zeros(len(one.positions), dtype=bool)
        anew = np.ones(len(out), dtype=bool)
        if known and known.one.surface is one.surface and known.two.surface is two.surface:
            later = self._first - known.first
            here = slice(max(0, -later), max(0, min(len(out), len(known.answer) - later)))
            there = slice(here.start + later, here.stop + later)
            if here.start < here.stop:
                same = _same(one, here, known.one, there) & _same(two, here, known.two, there)
                out[here] = known.answer[there] & same
                anew[here] = ~same
        some = np.flatnonzero(anew)
        if some.size == len(out):
            out = near(one, two, distance_m=distance_m)
        elif some.size:
            out[some] = near(_at(one, some), _at(two, some), distance_m=distance_m)
        self._asked[*names, distance_m] = _Asked(self._first, one, two, out)
        return out


def _same(one: Body, here: slice, known: Body, there: slice) -> Bool[np.ndarray, "some"]:
    """At which frames a body has the pose that it had; never where it is lost."""
    places = (one.positions[here] == known.positions[there]).all(axis=1)
    return places & (one.orientations[here] == known.orientations[there]).all(axis=1)


def _at(each: Body, frames: Int[np.ndarray, "some"]) -> Body:
    return Body(
        each.surface,
        each.positions[frames],
        each.orientations[frames],
        each.centres[frames],
        each.rests,
    )
