"""How bodies went, by the places that are kept of them, asked for the wording of sentences."""

import math
from collections.abc import Collection

import numpy as np

from capar.model.observation import Observation
from kb.language.thresholds import (
    ASIDE_SHARE,
    LEVEL_M,
    RISEN_M,
    STEP_M,
    STILL_M,
    SWING_MPS,
    UNSEEN_S,
)

SIDES = ("left", "right")
HIP = "hip"
"""The kind of links by which a body faces ahead, one on each side."""

FOOT, HEAD = "foot", "head"
"""The kind of links that step, and the body above which a thing is held overhead."""


class Tracks:
    """The kept places of the bodies of an observation."""

    def __init__(self, observation: Observation) -> None:
        self._tracks = {track.body: track for track in observation.tracks}
        self._feet = [link.ee for link in observation.links if link.kind == FOOT]
        self._hips = [
            link.ee
            for side in SIDES
            for link in observation.links
            if (link.kind, link.side) == (HIP, side)
        ]

    def way_m(self, body: str, start_s: float, end_s: float) -> float | None:
        """How far a body is at the end from where it was [m]; None where that was not kept."""
        places = self._places(body, start_s, end_s)
        if places is None:
            return None
        return float(np.linalg.norm(places[-1] - places[0]))

    def strays_m(self, body: str, start_s: float, end_s: float) -> float | None:
        """How far a body gets from where it was at first [m]; None where that was not kept."""
        places = self._places(body, start_s, end_s)
        if places is None:
            return None
        return float(np.linalg.norm(places - places[0], axis=1).max())

    def over_ground_m(self, body: str, start_s: float, end_s: float) -> tuple[float, float]:
        """How far a body is at the end, and gets at most, from where it was over the ground [m].

        Endless where that was not kept: nobody can say that it stayed.
        """
        places = self._places(body, start_s, end_s)
        if places is None:
            return math.inf, math.inf
        ways = np.linalg.norm(places[:, :2] - places[0, :2], axis=1)
        return float(ways[-1]), float(ways.max())

    def strides(self, foot: str) -> tuple[tuple[float, float], ...]:
        """From when to when a foot goes a step's way over the ground, as it swings [s]."""
        track = self._tracks.get(foot)
        if track is None or track.step_s == 0.0 or len(track.positions) < 2:
            return ()
        level, brief = track.positions[:, :2], max(round(UNSEEN_S / track.step_s), 1)
        ends = np.arange(len(level))
        before, after = (
            np.maximum(ends - brief // 2, 0),
            np.minimum(ends + brief // 2 + 1, ends[-1]),
        )
        gone_m = np.linalg.norm(level[after] - level[before], axis=1)
        swings = gone_m > SWING_MPS * np.maximum(after - before, 1) * track.step_s
        edges = np.flatnonzero(np.diff(np.r_[False, swings, False].astype(int)))
        spans = ((int(edges[at]), int(edges[at + 1]) - 1) for at in range(0, len(edges), 2))
        return tuple(
            (first * track.step_s, last * track.step_s)
            for first, last in spans
            if float(np.linalg.norm(level[last] - level[first])) >= STEP_M
        )

    def steps(self, start_s: float, end_s: float) -> int:
        """How many steps the feet take mostly within a time."""
        strides = (stride for foot in self._feet for stride in self.strides(foot))
        middles = (0.5 * (first + last) for first, last in strides)
        return sum(start_s <= middle_s <= end_s for middle_s in middles)

    def overhead(self, body: str, ees: Collection[str], start_s: float, end_s: float) -> bool:
        """Whether a body's middle is above the head for most of a time, and the hands are as well.

        Hands whose ways were not kept are taken to be where the body is.
        """
        head = self._places(HEAD, start_s, end_s)
        places = self._places(body, start_s, end_s)
        if head is None or places is None:
            return False
        head_m = float(np.median(head[:, 2]))
        hands = [found for ee in ees if (found := self._places(ee, start_s, end_s)) is not None]
        above = all(float(np.median(hand[:, 2])) > head_m for hand in hands)
        return above and float(np.median(places[:, 2])) > head_m + RISEN_M

    def stays(self, body: str, start_s: float, end_s: float) -> bool:
        """Whether a body stays where it is for a time; not where that was not kept."""
        strays_m = self.strays_m(body, start_s, end_s)
        return strays_m is not None and strays_m < LEVEL_M

    def goes_up_s(self, thing: str, start_s: float, end_s: float) -> float:
        """When, within a time, a thing is first clear of where it stood at its start [s]."""
        places = self._places(thing, start_s, end_s)
        if places is None:
            return start_s
        above = places[:, 2] - places[0, 2]
        step_s = (end_s - start_s) / max(len(above) - 1, 1)
        up = above > 0.5 * min(RISEN_M, float(above.max()))
        return start_s + float(np.argmax(up)) * step_s

    def comes_down_s(self, thing: str, start_s: float, end_s: float) -> float:
        """Since when, within a time, a thing is on its way down to where it is at the end [s]."""
        places = self._places(thing, start_s, end_s)
        if places is None:
            return end_s
        above = places[:, 2] - places[-1, 2]
        high = np.flatnonzero(above > min(RISEN_M, 0.5 * float(above.max())))
        step_s = (end_s - start_s) / max(len(above) - 1, 1)
        return start_s + float(max(high, default=0)) * step_s

    def moves_s(self, thing: str, start_s: float, end_s: float) -> tuple[float, float]:
        """From when to when, within a time, a thing is on its way from its first to its last place.

        The whole time [s] where that was not kept, or it stays where it is.
        """
        places = self._places(thing, start_s, end_s)
        if places is None:
            return start_s, end_s
        left = np.linalg.norm(places - places[0], axis=1) > 0.5 * STILL_M
        there = np.linalg.norm(places - places[-1], axis=1) <= 0.5 * STILL_M
        if not left.any() or there.all():
            return start_s, end_s
        step_s = (end_s - start_s) / max(len(places) - 1, 1)
        first = max(int(np.argmax(left)) - 1, 0)
        last = len(places) - int(np.argmax(~there[::-1]))
        return start_s + first * step_s, min(start_s + last * step_s, end_s)

    def rises_s(self, thing: str, start_s: float, end_s: float) -> float:
        """Since when, within a time, a thing is off the height at which it was at first [s]."""
        places = self._places(thing, start_s, end_s)
        if places is None or float(places[-1, 2] - places[0, 2]) < STILL_M:
            return start_s
        low = np.flatnonzero(places[:, 2] - places[0, 2] < STILL_M)
        step_s = (end_s - start_s) / max(len(places) - 1, 1)
        return start_s + float(max(low)) * step_s

    def sinks_m(self, thing: str, start_s: float, end_s: float) -> float:
        """How far a thing comes down within a time from as high as it was [m]; 0 if unknown."""
        places = self._places(thing, start_s, end_s)
        if places is None:
            return 0.0
        return float((np.maximum.accumulate(places[:, 2]) - places[:, 2]).max())

    def nears_m(self, body: str, thing: str, start_s: float, end_s: float) -> float:
        """How much nearer a body gets, over the ground, to where a thing is at the end [m].

        Negative where it gets further away; 0 where that was not kept.
        """
        places, there = self._places(body, start_s, end_s), self._places(thing, end_s, end_s)
        if places is None or there is None:
            return 0.0
        ways = np.linalg.norm(places[[0, -1], :2] - there[-1, :2], axis=1)
        return float(ways[0] - ways[1])

    def goes_about_rad(self, body: str, thing: str, start_s: float, end_s: float) -> float:
        """By how much a body goes about where a thing is at the end, seen from above [rad].

        0 where that was not kept.
        """
        places, there = self._places(body, start_s, end_s), self._places(thing, end_s, end_s)
        if places is None or there is None:
            return 0.0
        offsets = (places - there[-1])[:, :2]
        azimuths = np.unwrap(np.arctan2(offsets[:, 1], offsets[:, 0]))
        return float(azimuths[-1] - azimuths[0])

    def goes_back(self, foot: str, start_s: float, end_s: float) -> bool:
        """Whether a foot goes mostly backwards over the ground, by how the hips face at the start.

        Not where one of these was not kept.
        """
        places = self._places(foot, start_s, end_s)
        hips = [self._places(hip, start_s, start_s) for hip in self._hips]
        if places is None or len(hips) != len(SIDES) or any(hip is None for hip in hips):
            return False
        left, right = (hip[-1] for hip in hips if hip is not None)
        ahead = np.cross(left - right, (0.0, 0.0, 1.0))[:2]
        way = (places[-1] - places[0])[:2]
        far = float(np.linalg.norm(ahead) * np.linalg.norm(way))
        return far > 0.0 and -float(ahead @ way) > ASIDE_SHARE * far

    def leads_m(self, body: str, thing: str, start_s: float, end_s: float) -> float:
        """How far a body is mostly ahead of a thing that goes over the ground, where it goes [m].

        Negative behind it; 0 where the thing goes nowhere, or that was not kept.
        """
        hands, places = self._places(body, start_s, end_s), self._places(thing, start_s, end_s)
        if hands is None or places is None or len(hands) != len(places):
            return 0.0
        way = (places[-1] - places[0])[:2]
        way_m = float(np.linalg.norm(way))
        if way_m < RISEN_M:
            return 0.0
        return float(np.median((hands - places)[:, :2] @ (way / way_m)))

    def _places(self, body: str, start_s: float, end_s: float) -> np.ndarray | None:
        """Where a body was from one time to another [m]; None where that was not kept."""
        track = self._tracks.get(body)
        if track is None or track.step_s == 0.0:
            return None
        first, last = round(start_s / track.step_s), round(end_s / track.step_s)
        first = min(first, len(track.positions) - 1)
        places = track.positions[first : last + 1]
        places = places[~np.isnan(places).any(axis=1)]
        return places if len(places) else None
