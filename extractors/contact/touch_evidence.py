"""In which frames two bodies surely touch, for pairs of which one has no surface (spec 10).

Three kinds of evidence, each stated with the distance that it gives:

* *co-motion*: a thing travels and is steady in an end-effector's frame;
* *rest*: a thing rests on a support while nobody holds it;
* *settling*: a free hand rests by a thing, or a held thing dwells by one, nearer than both rest
  apart from each other. Of several things it is the nearest one.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import uniform_filter1d

from capar.model.capture import Capture, TagType
from extractors.bodies.bodies import Bodies
from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.co_motion import spread, steady_in, travelling
from extractors.contact.touch_points import touch_points
from extractors.motion.object_motion import motion_floor, rest_poses
from extractors.motion.rest import resting
from extractors.signals.clock import frame_rate
from extractors.signals.intervals import mask
from extractors.thresholds import Thresholds

HAND = "hand"
"""The end-effector that takes hold of things it does not move."""

Frames = Bool[np.ndarray, "frames"]


@dataclass(frozen=True, eq=False)
class Evidence:
    """What the bodies of a capture do to each other, as far as it tells who touches whom."""

    capture: Capture
    bodies: Bodies
    thresholds: Thresholds

    @cached_property
    def carried(self) -> dict[tuple[str, str], Frames]:
        """By end-effector and mobile object, where it surely carries the object."""
        out = {}
        for thing in self._mobile:
            ways = travelling(thing.poses.settled, self.thresholds)
            least = self.thresholds.co_motion_least * max(int(ways.sum()), 1)
            for sensor in self.capture.acting:
                carrier = self.bodies.sensors[sensor.name]
                if carrier.poses is thing.poses:
                    continue
                frames = steady_in(carrier.poses.settled, thing.poses.settled, self.thresholds)
                if frames.sum() > least and self._lasts(frames):
                    out[sensor.name, thing.name] = frames
        return out

    @cached_property
    def gripped(self) -> dict[tuple[str, str], Frames]:
        """The same, with the frames before and after in which their distance is no other."""
        return {
            (hand, thing): self._nearby(hand, thing, frames)
            for (hand, thing), frames in self.carried.items()
        }

    def held(self, thing: str) -> Frames:
        """Where some end-effector surely holds a thing."""
        return self._any(frames for (_, name), frames in self.gripped.items() if name == thing)

    def busy(self, hand: str) -> Frames:
        """Where an end-effector surely holds something."""
        return self._any(frames for (name, _), frames in self.gripped.items() if name == hand)

    def unheld_rest(self, thing: str) -> Frames:
        """Where a thing rests and nobody surely holds it."""
        return self._at_rest(thing) & ~self.held(thing)

    def settled(self, hand: str) -> dict[str, Frames]:
        """By object, where a hand without load rests by it and by no nearer one.

        The rests with which a recording begins and ends are the person's posture, not contact.
        """
        own = self.bodies.sensors[hand]
        last = len(self.capture.times) - 1
        spans = resting(own.poses, self.thresholds)
        home = mask([each for each in spans if each[0] == 0 or each[1] == last], last + 1)
        free = mask([each for each in spans if each[0] > 0 and each[1] < last], last + 1)
        known = {thing for name, thing in self.gripped if name == hand}
        others = [each for each in self._mobile if each.name not in known and each.name != hand]
        return self._nearest(own, free & ~self.busy(hand), home, others)

    def dwelling(self, thing: str) -> dict[str, Frames]:
        """By object, where a held thing dwells by it and by no nearer one."""
        own = self.bodies.objects[thing]
        apart = self.unheld_rest(thing)
        dwells = self._dwells(own) & self.held(thing) & ~self._laid_down(thing)
        others = [each for each in self._mobile if each.name != thing]
        return self._nearest(own, dwells, apart, others)

    def _nearest(
        self, own: BodyGeometry, frames: Frames, apart: Frames, others: list[BodyGeometry]
    ) -> dict[str, Frames]:
        """By object that rests by itself, where it is the nearest, if nearer than when apart."""
        gaps: dict[str, Float[np.ndarray, "frames"]] = {}
        for other in others:
            gap = _origins_apart(own, other)
            limit = self.thresholds.settle_reach_m
            if apart.any():
                usual = float(np.nanmedian(gap[apart]))
                limit = min(limit, usual - self.thresholds.settle_nearer_m)
            there = (
                frames & self.unheld_rest(other.name) & (np.nan_to_num(gap, nan=np.inf) <= limit)
            )
            gaps[other.name] = np.where(there, gap, np.inf)
        if not gaps:
            return {}
        least = np.min(list(gaps.values()), axis=0)
        found = {name: np.isfinite(gap) & (gap == least) for name, gap in gaps.items()}
        return {name: each for name, each in found.items() if self._lasts(each)}

    def _nearby(self, hand: str, thing: str, frames: Frames) -> Frames:
        one, two = self.bodies.sensors[hand].poses.settled, self.bodies.objects[thing].poses.settled
        apart = touch_points(one, two, frames, self.thresholds).apart(one, two)
        limit = float(np.quantile(apart[frames], self.thresholds.touch_quantile))
        with np.errstate(invalid="ignore"):
            return np.asarray(apart <= limit + self.thresholds.touch_margin_m)

    def _dwells(self, own: BodyGeometry) -> Frames:
        """Where the mean place over the time of dwelling hardly moves within that time."""
        stream = own.poses.settled
        size = max(1, round(self.thresholds.dwell_s * frame_rate(stream.times)))
        known = ~stream.lost[:, None]
        sums = uniform_filter1d(np.where(known, stream.positions, 0.0), size, axis=0)
        count = uniform_filter1d(known.astype(float), size, axis=0)
        means = np.where(known, sums / np.maximum(count, 1.0 / size), np.nan)
        way = spread(means, stream, self.thresholds)
        with np.errstate(invalid="ignore"):
            return np.asarray(way <= self.thresholds.dwell_m)

    def _laid_down(self, thing: str) -> Frames:
        """Where a thing is at a place at which it also rests while nobody holds it."""
        unheld = self.unheld_rest(thing)
        spans = [(a, z) for a, z in self._rests(thing) if unheld[a : z + 1].any()]
        return mask(spans, len(self.capture.times))

    def _at_rest(self, thing: str) -> Frames:
        return mask(self._rests(thing), len(self.capture.times))

    def _rests(self, thing: str) -> list[tuple[int, int]]:
        body, last = self.bodies.objects[thing], len(self.capture.times) - 1
        own = self.capture.tag_object(thing)
        if own.tag is TagType.FIXED or body.poses.still:
            return [(0, last)]
        floor = motion_floor(
            body.poses.noise,
            frame_rate(self.capture.times),
            own_m=own.motion_floor_m,
            thresholds=self.thresholds,
        )
        return [each.interval for each in rest_poses(body.poses, floor, self.thresholds)]

    @cached_property
    def _mobile(self) -> list[BodyGeometry]:
        return [each for each in self._things if self._tag(each.name) is TagType.MOBILE]

    @cached_property
    def _things(self) -> list[BodyGeometry]:
        things = (each for each in self.capture.objects if each.tag is not TagType.SELF)
        return [self.bodies.objects[each.name] for each in things]

    def _tag(self, thing: str) -> TagType:
        return self.capture.tag_object(thing).tag

    def _lasts(self, frames: Frames) -> bool:
        step_s = 1.0 / frame_rate(self.capture.times)
        return bool(frames.sum() * step_s >= self.thresholds.rest_minimum_s)

    def _any(self, masks: Iterable[Frames]) -> Frames:
        out = np.zeros(len(self.capture.times), dtype=bool)
        for frames in masks:
            out |= frames
        return out


def _origins_apart(one: BodyGeometry, other: BodyGeometry) -> Float[np.ndarray, "frames"]:
    offset = one.poses.settled.positions - other.poses.settled.positions
    return np.asarray(np.linalg.norm(offset, axis=1))
