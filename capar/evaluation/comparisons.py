"""What was found beside what is labelled, channel by channel, and where they differ."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from capar.evaluation.metrics import NOTHING, SAME_S, Interval, frame_labels, within
from capar.model.geometry import runs
from capar.model.observation import Segment


@dataclass(frozen=True)
class Channel:
    """What one link does, one pair of bodies, or one object's carries: at most one at a time."""

    name: str
    true: tuple[Interval, ...]
    found: tuple[Interval, ...]
    silent: bool = False
    """Whether a time without a label says that there was nothing; else it is not counted."""

    open: tuple[Interval, ...] = ()
    """When it is not counted, whatever was found."""

    segments: tuple[Segment, ...] = ()
    """The segments that it was found in, as they are printed."""


@dataclass(frozen=True, slots=True)
class Difference:
    """A stretch of time in which something else was found than is labelled."""

    capture: str
    channel: str
    start_s: float
    end_s: float
    true: str
    found: str
    said: str
    """The segments there, as they are printed: number and name."""

    @property
    def length_s(self) -> float:
        """How long it lasts [s]."""
        return self.end_s - self.start_s


def differences(
    capture: str, channels: Iterable[Channel], times: Float[np.ndarray, "frames"]
) -> tuple[Difference, ...]:
    """Every stretch of a capture in which a channel differs from its labels, in order of time."""
    out: list[Difference] = []
    for channel in channels:
        true, found = (
            np.array([each or NOTHING for each in frame_labels(marks, times)], dtype=object)
            for marks in (channel.true, channel.found)
        )
        wrong = (true != found) & counted(channel, times)
        pairs = sorted(set(zip(true[wrong], found[wrong], strict=True)))
        for one, other in pairs:
            for first, last in runs(wrong & (true == one) & (found == other)):
                end_s = float(times[min(last + 1, len(times) - 1)])
                start_s = float(times[first])
                said = _said(channel.segments, start_s, end_s)
                out.append(Difference(capture, channel.name, start_s, end_s, one, other, said))
    return tuple(sorted(out, key=lambda each: (each.start_s, each.channel)))


def worst(found: Iterable[Difference], *, most: int) -> tuple[Difference, ...]:
    """The longest differences, longest first."""
    ranked = sorted(found, key=lambda each: (-each.length_s, each.capture, each.channel,
                                             each.start_s))  # fmt: skip
    return tuple(ranked[:most])


def counted(channel: Channel, times: Float[np.ndarray, "frames"]) -> Bool[np.ndarray, "frames"]:
    """Whether each frame counts."""
    out = np.full(len(times), channel.silent)
    if not channel.silent:
        out |= np.array([bool(each) for each in frame_labels(channel.true, times)], dtype=bool)
    return np.asarray(out & ~inside(channel.open, times))


def inside(
    intervals: Sequence[Interval], times: Float[np.ndarray, "frames"]
) -> Bool[np.ndarray, "frames"]:
    """Whether each frame lies in one of the intervals: [start, end)."""
    out = np.zeros(len(times), dtype=bool)
    for interval in intervals:
        out |= within(interval, times)
    return out


def _said(segments: Sequence[Segment], start_s: float, end_s: float) -> str:
    there = [
        each for each in segments if each.start_s < end_s - SAME_S and each.end_s > start_s + SAME_S
    ]
    return ", ".join(f"{each.index} {each.name}" for each in there)
