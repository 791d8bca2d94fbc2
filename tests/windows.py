"""Parts of captures, and what is measured in them beside what is measured in the whole."""

from dataclasses import fields, replace

import numpy as np

from capar.model.capture import Capture, Stream
from capar.model.facts import (
    Between,
    ClosingSpeed,
    ContactNormal,
    Fact,
    Flies,
    Gap,
    Leans,
    Lies,
    LookingAt,
    Passage,
    Pause,
    Rolls,
    Touching,
    ZeroCrossing,
)
from extractors.measure import SHIFTS, Measurements, measure

WINDOWED = (
    ZeroCrossing,
    Pause,
    Touching,
    Gap,
    LookingAt,
    ContactNormal,
    ClosingSpeed,
    Leans,
    Flies,
    Rolls,
    Lies,
    Between,
    Passage,
)
"""Every kind of fact that a window shows as the whole does."""

FRAMES = ("frame", "first", "last")


def repeated(capture: Capture, times_over: int, *, noise_m: float = 0.0003) -> Capture:
    """The capture forth and back so many times, with other noise each time, on an even clock."""
    count = len(capture.times)
    there_and_back = np.r_[0 : count - 1, count - 1 : 0 : -1]
    frames = np.tile(there_and_back, times_over)
    times = np.arange(len(frames)) / 100.0
    random = np.random.default_rng(0)
    streams: dict[int, Stream] = {}

    def longer(stream: Stream) -> Stream:
        if id(stream) not in streams:
            noise = random.normal(0.0, noise_m, (len(frames), 3))
            still = bool((stream.positions == stream.positions[0]).all())
            positions = stream.positions[frames] + (0.0 if still else noise)
            streams[id(stream)] = Stream(times, positions, stream.orientations[frames])
        return streams[id(stream)]

    sensors = tuple(replace(each, stream=longer(each.stream)) for each in capture.sensors)
    objects = tuple(replace(each, stream=longer(each.stream)) for each in capture.objects)
    return replace(capture, sensors=sensors, objects=objects)


def window(capture: Capture, first: int, last: int) -> Capture:
    """The part of a capture from one frame to another, on the same clock."""
    part = slice(first, last + 1)

    def cut(stream: Stream) -> Stream:
        return Stream(stream.times[part], stream.positions[part], stream.orientations[part])

    sensors = tuple(replace(each, stream=cut(each.stream)) for each in capture.sensors)
    objects = tuple(replace(each, stream=cut(each.stream)) for each in capture.objects)
    return replace(capture, sensors=sensors, objects=objects)


def compared(
    capture: Capture, whole: Measurements, first: int, last: int
) -> tuple[set[Fact], set[Fact]]:
    """Windowed facts in the inner part of a window: by the window, and by the whole.

    Only of bodies that are handled in the window: of others a window measures no arrangement.
    """
    calibration = whole.calibration
    margin = int(np.ceil(calibration.horizons.margin_s / calibration.step_s))
    inner = (first + margin, last - margin)
    part = measure(window(capture, first, last), calibration)
    acting = {each.name for each in capture.acting}
    handled = acting | {
        each.other for each in part.facts if isinstance(each, Touching) and each.body in acting
    }
    found = {_shifted(each, first) for each in part.facts if isinstance(each, WINDOWED)}
    return _inside(found, inner, handled), _inside(set(whole.facts), inner, handled)


def _inside(facts: set[Fact], inner: tuple[int, int], handled: set[str]) -> set[Fact]:
    return {
        each
        for each in facts
        if isinstance(each, WINDOWED)
        and not (isinstance(each, Lies) and SHIFTS in _values(each))
        and all(inner[0] <= frame <= inner[1] for frame in _frames(each).values())
        and (isinstance(each, LookingAt) or _values(each)[0] in handled)
    }


def _values(fact: Fact) -> list[object]:
    return [getattr(fact, each.name) for each in fields(fact)]


def _frames(fact: Fact) -> dict[str, int]:
    return {each.name: getattr(fact, each.name) for each in fields(fact) if each.name in FRAMES}


def _shifted(fact: Fact, by: int) -> Fact:
    return replace(fact, **{name: frame + by for name, frame in _frames(fact).items()})
