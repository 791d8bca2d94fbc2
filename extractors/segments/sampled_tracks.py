"""The places of every body through a capture, sampled at equal steps of time."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from capar.model.sampled_track import SampledTrack, sampled_track
from extractors.bodies.bodies import Bodies
from extractors.bodies.poses import Poses

RATE_HZ = 50.0
"""Samples a second of a capture that has half as many frames again, or more [Hz]."""


def sampled_tracks(bodies: Bodies, times: Float[np.ndarray, "frames"]) -> Iterator[SampledTrack]:
    """The track of each sensor and object, by name; an object that is a sensor stands once."""
    clock = _clock(times)
    for name, pose in sorted(bodies.poses.items()):
        yield _track(name, pose, times, clock)


def _clock(times: Float[np.ndarray, "frames"]) -> Float[np.ndarray, "samples"]:
    """Equal steps from the first to the last frame: the frames themselves if they are few."""
    duration = float(times[-1] - times[0])
    frames = len(times) - 1
    steps = frames if frames < 1.5 * RATE_HZ * duration else int(np.ceil(RATE_HZ * duration))
    return np.linspace(times[0], times[-1], steps + 1)


def _track(
    name: str,
    pose: Poses,
    times: Float[np.ndarray, "frames"],
    clock: Float[np.ndarray, "samples"],
) -> SampledTrack:
    if pose.rests and not pose.settled.lost.all():
        known = pose.settled.positions[~pose.settled.lost]
        return sampled_track(name, 0.0, known[:1])
    places = pose.smooth.positions
    columns = [np.interp(clock, times, places[:, axis]) for axis in range(3)]
    step = float(clock[1] - clock[0]) if len(clock) > 1 else 0.0
    return sampled_track(name, step, np.stack(columns, axis=1))
