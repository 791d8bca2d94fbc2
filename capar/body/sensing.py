"""What a tracker would record of a moving body: noise, sensors strapped askew, dropouts."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.body.mounting import Mount, places
from capar.model.capture import Stream
from capar.model.errors import CaparError, UnknownNameError


@dataclass(frozen=True)
class Tracker:
    """A tracker's faults; the defaults are those of a MotionStar in a good room."""

    noise_m: float = 0.0015
    """Deviation of a position about each axis [m]."""

    noise_rad: float = float(np.radians(0.4))
    """Deviation of an orientation about each axis [rad]."""

    placement_m: float = 0.005
    """Deviation of where a sensor is strapped from its nominal place, about each axis [m]."""

    placement_rad: float = float(np.radians(15.0))
    """Deviation of how it is turned there, about each axis [rad]."""

    dropouts_per_s: float = 0.0
    """Losses of one sensor a second."""

    dropout_s: float = 0.05
    """Mean length of a loss, exponentially distributed [s]."""

    def __post_init__(self) -> None:
        """Check the numbers."""
        for name in self.__dataclass_fields__:
            value = getattr(self, name)
            if not 0.0 <= value < np.inf:
                raise CaparError(f"{name} = {value}; a tracker's faults are not negative")


PERFECT = Tracker(0.0, 0.0, 0.0, 0.0)
"""A tracker without faults."""


def strap_on(
    human: Human, where: Iterable[str], tracker: Tracker, rng: np.random.Generator
) -> dict[str, Mount]:
    """Mount sensors near their nominal places.

    Raises:
        UnknownNameError: A place is none of the model's.
    """
    out = {}
    for place in where:
        if place not in places():
            raise UnknownNameError("place of a sensor", place, places())
        usual = human.model.site(f"sensor_{place}").pos
        moved = usual + rng.normal(0.0, 1.0, 3) * tracker.placement_m
        turn = Rotation.from_rotvec(rng.normal(0.0, 1.0, 3) * tracker.placement_rad)
        out[place] = Mount(place, places()[place], RigidTransform.from_components(moved, turn))
    return out


def sense(
    human: Human,
    times: Float[np.ndarray, "frames"],
    motion: Float[np.ndarray, "frames posture"],
    mounts: Mapping[str, Mount],
    tracker: Tracker,
    rng: np.random.Generator,
) -> dict[str, Stream]:
    """The streams of the mounted sensors, by place."""
    segments = human.sites(motion, {each.segment for each in mounts.values()})
    out = {}
    for place, mount in mounts.items():
        spots, turns = segments[mount.segment]
        frame = RigidTransform.from_components(spots, Rotation.from_quat(turns, scalar_first=True))
        out[place] = recorded(times, frame * mount.pose, tracker, rng)
    return out


def recorded(
    times: Float[np.ndarray, "frames"],
    poses: RigidTransform,
    tracker: Tracker,
    rng: np.random.Generator,
) -> Stream:
    """A pose over time as a tracker records it."""
    spots = poses.translation + rng.normal(0.0, 1.0, (len(times), 3)) * tracker.noise_m
    shake = Rotation.from_rotvec(rng.normal(0.0, 1.0, (len(times), 3)) * tracker.noise_rad)
    turns = (poses.rotation * shake).as_quat(scalar_first=True)
    lost = _dropouts(times, tracker, rng)
    spots[lost], turns[lost] = np.nan, np.nan
    return Stream(times, spots, turns)


def _dropouts(
    times: Float[np.ndarray, "frames"], tracker: Tracker, rng: np.random.Generator
) -> np.ndarray:
    """Frames that are lost; neither the first nor the last is."""
    lost = np.zeros(len(times), dtype=bool)
    span = times[-1] - times[0]
    for _ in range(int(rng.poisson(tracker.dropouts_per_s * span))):
        start = times[0] + rng.uniform(0.0, span)
        lost |= (times >= start) & (times < start + rng.exponential(tracker.dropout_s))
    lost[[0, -1]] = False
    return lost
