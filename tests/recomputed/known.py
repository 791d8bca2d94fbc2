"""What a sentence is compared with: the capture, and what was measured in it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from scipy.spatial.transform import Rotation
from trimesh.triangles import closest_point

from capar.model.capture import Capture, Sensor, Shape, Stream, TagObject
from capar.model.facts import Fact, LookingAt, Moving, Resting, Touching, ZeroCrossing
from capar.model.observation import Segment
from capar.pipelines.explanation import Explained

TIME = r"(\d+\.\d\d) s"
NAME = r"([\w ]+?)"

Measured = TypeVar("Measured", bound=Fact)

MERGE_S = 0.15
"""Events nearer to each other than this are one border [s] (spec 5.1)."""

ROUNDED = 0.8
"""How far a frame may be from the time told of it, which has two decimals [frames]."""


@dataclass(frozen=True)
class Known:
    """One segment, its capture and what was measured; nothing that a rule says of it."""

    seen: Explained
    facts: tuple[Fact, ...]
    """As they were measured, before flicker was resolved."""

    segment: Segment
    capture: Capture
    steps: Mapping[str, Sequence[str]]
    """What each end-effector does, as the motion's author wrote it beforehand."""

    @property
    def thesis(self) -> bool:
        return self.seen.observation.profile == "thesis"

    @property
    def rate(self) -> float:
        return self.capture.rate_hz

    @property
    def reach(self) -> float:
        """Frames within which events are one border; thesis borders stand at crossings."""
        crossing = 0.0
        if self.thesis:
            frames = sorted(each.frame for each in self.of(ZeroCrossing))
            crossing = float(max(np.diff(frames), default=0))
        return MERGE_S * self.rate + crossing

    def at(self, text: str) -> float:
        return float(text) * self.rate

    def frame(self, text: str) -> int:
        return min(round(self.at(text)), len(self.capture.times) - 1)

    def of(self, kind: type[Measured]) -> Iterator[Measured]:
        return (each for each in self.facts if isinstance(each, kind))

    def touching(self, one: str, other: str) -> list[Touching]:
        pair = (name(one), name(other))
        return [each for each in self.of(Touching) if (each.body, each.other) == pair]

    def moving(self, what: str) -> list[Moving]:
        return [each for each in self.of(Moving) if each.object == name(what)]

    def resting(self, what: str) -> list[Resting]:
        return [each for each in self.of(Resting) if each.ee == name(what)]

    def looking(self, what: str) -> list[LookingAt]:
        return [each for each in self.of(LookingAt) if each.object == name(what)]

    def stream(self, what: str) -> Stream:
        return self._body(what).stream

    def shape(self, what: str) -> Shape:
        shape = self._body(what).shape
        assert shape is not None
        return shape

    def shape_of(self, what: str) -> Shape | None:
        """The shape of a body, if it has one."""
        return self._body(what).shape

    def _body(self, what: str) -> Sensor | TagObject:
        for group in (self.capture.objects, self.capture.sensors):
            for each in group:
                if each.name == name(what):
                    return each
        raise AssertionError(f"the capture has no {what!r}")

    def turn(self, what: str, frame: int) -> Rotation:
        return self.turns(what, frame)

    def turns(self, what: str, frames: int | Sequence[int]) -> Rotation:
        """How it is turned at a frame, or at several in one value."""
        at = frames if isinstance(frames, int | np.integer) else list(frames)
        return Rotation.from_quat(self.stream(what).orientations[at], scalar_first=True)

    def middle(self, what: str, frame: int) -> np.ndarray:
        """Where the middle of the body's box is in the world [m]."""
        centre = self.shape(what).bounds.mean(axis=0)
        return self.stream(what).positions[frame] + self.turn(what, frame).apply(centre)

    def track(self, what: str, first: int, last: int) -> np.ndarray:
        """Where the middle of a body is at each frame, or its origin if it has no shape [m]."""
        if self.shape_of(what) is None:
            return np.asarray(self.stream(what).positions[first : last + 1])
        return np.array([self.middle(what, frame) for frame in range(first, last + 1)])

    def points(self, what: str, frame: int) -> np.ndarray:
        """Where the corners of its surface are in the world [m]."""
        corners = self.turn(what, frame).apply(np.array(self.shape(what).vertices))
        return corners + self.stream(what).positions[frame]

    def nearest_way(self, one: str, other: str, frame: int) -> np.ndarray:
        """From a body's middle to the nearest place of another's surface, in the world [m]."""
        shape, middle = self.shape(other), self.middle(one, frame)
        turn, place = self.turn(other, frame), self.stream(other).positions[frame]
        triangles = np.array(shape.vertices)[np.array(shape.faces)]
        own = np.tile(turn.inv().apply(middle - place), (len(triangles), 1))
        ways = closest_point(triangles, own) - own
        return np.asarray(turn.apply(min(ways, key=lambda way: float(way @ way))))

    def way(self, what: str) -> np.ndarray:
        """How far its middle is displaced from border to border [m]."""
        return self.middle(what, self.segment.last) - self.middle(what, self.segment.first)

    def border(self, side: str) -> int:
        return self.segment.first if side == "start" else self.segment.last


def name(text: str) -> str:
    return text.replace(" ", "_")


def near(frame: float, other: float) -> bool:
    return abs(frame - other) <= ROUNDED


def covers(span: Touching | Moving | Resting | LookingAt, frame: float) -> bool:
    return span.first - ROUNDED <= frame <= span.last + ROUNDED
