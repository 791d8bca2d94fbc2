"""The settled facts that rules are still told of: few, however long a recording lasts."""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence

from capar.model.facts import Observed, Place, Resting, Touching, TrunkPlace

SAME_PLACE_MM = 10
"""Postures at rest nearer to each other than this along every axis are one [mm]."""


class RuleMemory:
    """Facts of the last few segments, and of the places where an end-effector rested before.

    Rules ask whether a hand is back where it was before it acted, however long ago: the first
    frame, and rests at other places than those that are known, stay.
    """

    def __init__(self) -> None:
        self._facts: list[Observed] = []
        self._postures: dict[tuple[object, ...], tuple[Observed, ...]] = {}

    def __iter__(self) -> Iterator[Observed]:
        """The facts, each once."""
        remembered = (each for facts in self._postures.values() for each in facts)
        return iter(dict.fromkeys((*remembered, *self._facts)))

    def add(self, facts: Iterable[Observed]) -> None:
        """Take facts that were settled."""
        self._facts += facts

    def forget(self, begin: int, borders: Sequence[int], margin: int) -> None:
        """Drop what rules do not need again.

        Args:
            begin: The frame from which on everything is kept.
            borders: Frames at which segments begin that go on; what ends near them is kept.
            margin: How many frames away is near.
        """
        at = sorted(borders)
        kept: list[Observed] = []
        gone: list[Observed] = []
        for fact in self._facts:
            ends = fact.ends()
            needed = ends[-1] >= begin - margin or any(_is_near(end, at, margin) for end in ends)
            (kept if needed else gone).append(fact)
        self._facts = kept
        if gone:
            self._remember(gone)

    def _remember(self, gone: Sequence[Observed]) -> None:
        """Keep the places of an end-effector at rest, with what it touched meanwhile."""
        places = {(fact.body, fact.frame): fact for fact in gone if isinstance(fact, Place)}
        by_trunk = {(fact.body, fact.frame): fact for fact in gone if isinstance(fact, TrunkPlace)}
        touching: dict[str, list[Touching]] = defaultdict(list)
        for fact in gone:
            if isinstance(fact, Touching):
                touching[fact.body].append(fact)
        postures = {
            at: (place, *((by_trunk[at],) if at in by_trunk else ()))
            for at, place in places.items()
        }
        for (body, frame), posture in postures.items():
            if frame == 0:
                self._postures.setdefault((body, "first"), posture)
        for fact in gone:
            if isinstance(fact, Resting) and (fact.ee, fact.last) in postures:
                posture = postures[fact.ee, fact.last]
                met = (
                    touch
                    for touch in touching[fact.ee]
                    if touch.first <= fact.last and fact.first <= touch.last
                )
                axes = (axis for place in posture for axis in (place.x, place.y, place.z))
                cell = tuple(round(axis / SAME_PLACE_MM) for axis in axes)
                self._postures.setdefault((fact.ee, *cell), (fact, *posture, *met))


def _is_near(frame: int, borders: Sequence[int], margin: int) -> bool:
    """Whether one of some frames in order is so near to a frame."""
    following = bisect_left(borders, frame - margin)
    return following < len(borders) and borders[following] <= frame + margin
