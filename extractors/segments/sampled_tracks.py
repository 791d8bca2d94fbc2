"""The places of every body through a capture, sampled at equal steps of time."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from capar.model.locations import SampledTrack, sampled_track
from extractors.bodies.bodies import Bodies

RATE_HZ = 50.0
"""Samples a second of a capture that has half as many frames again, or more [Hz]."""


def sampled_tracks(bodies: Bodies, times: Float[np.ndarray, "frames"]) -> Iterator[SampledTrack]:
    """The track of each sensor and object, by name; an object that is a sensor stands once.

    No low-passed poses are kept: those of all bodies at once would be most of what a long recording
    takes.
    """
    for name, pose in sorted(bodies.poses.items()):
        places = pose.settled if pose.rests else pose.smooth
        yield track_of(name, places.positions, times, rests=pose.rests)
        pose.forget()


def track_of(
    name: str,
    places: Float[np.ndarray, "frames 3"],
    times: Float[np.ndarray, "frames"],
    *,
    rests: bool,
) -> SampledTrack:
    """The track of a body.

    Args:
        name: The body.
        places: Its low-passed places [m]; NaN where it was lost.
        times: Clock [s].
        rests: Whether it is at one place throughout: one sample tells it.
    """
    known = places[~np.isnan(places[:, 0])] if rests else places[:0]
    if len(known):
        return sampled_track(name, 0.0, known[:1])
    clock = _clock(times)
    columns = [np.interp(clock, times, places[:, axis]) for axis in range(3)]
    step = float(clock[1] - clock[0]) if len(clock) > 1 else 0.0
    return sampled_track(name, step, np.stack(columns, axis=1))


def _clock(times: Float[np.ndarray, "frames"]) -> Float[np.ndarray, "samples"]:
    """Equal steps from the first to the last frame: the frames themselves if they are few."""
    duration = float(times[-1] - times[0])
    frames = len(times) - 1
    steps = frames if frames < 1.5 * RATE_HZ * duration else int(np.ceil(RATE_HZ * duration))
    return np.linspace(times[0], times[-1], steps + 1)
