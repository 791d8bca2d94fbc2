"""Sensors on the body: where they sit, what a tracker records of them, and their filtered paths."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures
from capar.body.human import Human, site_rows
from capar.model import geometry
from capar.model.capture import Stream
from capar.model.errors import CaparError, UnknownNameError
from extractors.signals.filters import fill_gaps, lowpass, lowpass_orientations
from extractors.thresholds import Thresholds

REFERENCE_S = 0.4  # how long the reference posture is held at the start [s] (thesis 3.1)

#: Deviation of where a sensor is strapped from its nominal place, an axis [m] (estimate)
PLACEMENT_M = 0.010
#: The measures that decide where a segment is relative to the pelvis, for the right side
CHAINS = {
    "thorax_upper": ("cervicale_height",),
    "head": ("stature",),
    "right_upper_arm": ("acromial_height", "upper_arm"),
    "right_hand": ("acromial_height", "upper_arm", "forearm"),
    "right_thigh": ("thigh",),
    "right_foot": ("thigh", "shank"),
}
#: Cutoff of the zero-phase filter [Hz]: above what hands do, below most of a tracker's noise
CUTOFF_HZ = 8.0
#: Losses that are interpolated (spec 3), and how long longer ones take to fade out or in [s]
GAP_S, FADE_S = 0.1, 0.1


class CalibrationError(CaparError):
    """A recording from which sensors cannot be placed on the body."""


@dataclass(frozen=True, eq=False)
class Mount:
    """A sensor on a segment."""

    place: str  #: ``l5``, ``right_hand`` ...: the site ``sensor_<place>`` of the model
    segment: str
    pose: RigidTransform  #: ``T_segment_sensor``


@dataclass(frozen=True, eq=False)
class Calibration:
    """The sensors on the body by place, and the reference posture where the recording has it."""

    mounts: Mapping[str, Mount]
    posture: Float[np.ndarray, "posture"]


@cache
def places() -> dict[str, str]:
    """The segment of every place of a sensor."""
    rows = (row for row in site_rows() if row.get("sensor"))
    return {row["name"].removeprefix("sensor_"): row["body"] for row in rows}


def calibrate(
    human: Human,
    streams: Mapping[str, Stream],
    *,
    angles: Mapping[str, float] | None = None,
    placed: tuple[Float[np.ndarray, "3"], float] | None = None,
) -> Calibration:
    """Find where each sensor sits, from its pose while the body holds a posture for 0.4 s.

    A sensor is turned as seen. Its distance from its nominal place is shared, by their variances,
    between where it was strapped and measures that are not the person's. The posture [rad] is arms
    down, palms inwards where not given; the body is fitted into the sensors unless ``placed``:
    where the feet are [m] and the heading [rad].

    Raises:
        CalibrationError: A sensor is lost throughout, or too few are there to place the body.
    """
    for place in streams:
        if place not in places():
            raise UnknownNameError("place of a sensor", place, places())
    seen = {place: _still(place, stream) for place, stream in streams.items()}
    posture = _placed(human, seen, angles, placed)
    nominal = human.sites(posture[None], [f"sensor_{each}" for each in seen])
    segments = human.sites(posture[None], {places()[each] for each in seen})
    mounts = {}
    for place, pose in seen.items():
        segment = places()[place]
        frame = geometry.transforms(segments[segment][0][0], segments[segment][1][0])
        usual = frame.inv().apply(nominal[f"sensor_{place}"][0][0])
        own = frame.inv() * pose
        share = PLACEMENT_M**2 / (PLACEMENT_M**2 + _chain_variance(segment, human.measures))
        spot = usual + share * (own.translation - usual)
        mounts[place] = Mount(place, segment, RigidTransform.from_components(spot, own.rotation))
    return Calibration(mounts, posture)


def mounted(human: Human, mounts: Mapping[str, Mount]) -> Human:
    """The same body with its sensors' sites at these mounts."""
    model = human.model.__copy__()
    for place, mount in mounts.items():
        number = model.site(f"sensor_{place}").id
        model.site_pos[number] = mount.pose.translation
        model.site_quat[number] = mount.pose.rotation.as_quat(scalar_first=True)
        model.site_sameframe[number] = 0
    return Human(human.measures, model)


def _still(place: str, stream: Stream) -> RigidTransform:
    """The mean pose during the reference posture."""
    known = (stream.times - stream.times[0] <= REFERENCE_S) & ~stream.lost
    if not known.any():
        raise CalibrationError(
            f"sensor {place!r} is lost throughout the first {REFERENCE_S:g} s; "
            "the reference posture is to be held there"
        )
    turn = Rotation.from_quat(stream.orientations[known], scalar_first=True).mean()
    return RigidTransform.from_components(stream.positions[known].mean(axis=0), turn)


def _placed(
    human: Human,
    seen: Mapping[str, RigidTransform],
    angles: Mapping[str, float] | None,
    placed: tuple[Float[np.ndarray, "3"], float] | None,
) -> Float[np.ndarray, "posture"]:
    """The reference posture turned and moved to the sensors by weighted least squares."""
    if placed is not None:
        return human.posture(angles, place=placed[0], heading=placed[1])
    if len(seen) < 2:
        raise CalibrationError(
            f"{len(seen)} sensor; two or more place the body, or give where it stands"
        )
    sites = human.sites(human.posture(angles)[None], [f"sensor_{each}" for each in seen])
    body = np.array([sites[f"sensor_{each}"][0][0] for each in seen])
    world = np.array([each.translation for each in seen.values()])
    spread = [PLACEMENT_M**2 + _chain_variance(places()[each], human.measures) for each in seen]
    weights = 1.0 / np.array(spread)
    share = weights / weights.sum()
    middle, goal = share @ body, share @ world
    (a, b), (c, d) = (body - middle)[:, :2].T, (world - goal)[:, :2].T
    heading = float(np.arctan2(share @ (a * d - b * c), share @ (a * c + b * d)))
    moved = goal - Rotation.from_euler("z", heading).apply(middle)
    return human.posture(angles, place=moved, heading=heading)


def _chain_variance(segment: str, measures: Measures) -> float:
    """Variance of where a segment is relative to the pelvis, from that of the measures [m2]."""
    names = CHAINS.get(segment.replace("left_", "right_"), ())
    return sum(measures.deviations[each] ** 2 for each in names)


@dataclass(frozen=True)
class Tracker:
    """A tracker's faults; the defaults are those of a MotionStar in a good room."""

    noise_m: float = 0.0015  #: Deviation of a position about each axis [m]
    noise_rad: float = float(np.radians(0.4))  #: Deviation of an orientation about each axis [rad]
    #: Deviation of where a sensor is strapped from its nominal place, about each axis [m]
    placement_m: float = 0.005
    #: Deviation of how it is turned there, about each axis [rad]
    placement_rad: float = float(np.radians(15.0))
    dropouts_per_s: float = 0.0  #: Losses of one sensor a second
    dropout_s: float = 0.05  #: Mean length of a loss, exponentially distributed [s]

    def __post_init__(self) -> None:
        """Check the numbers."""
        for name in self.__dataclass_fields__:
            value = getattr(self, name)
            if not 0.0 <= value < np.inf:
                raise CaparError(f"{name} = {value}; a tracker's faults are not negative")


PERFECT = Tracker(0.0, 0.0, 0.0, 0.0)  # a tracker without faults


def strap_on(
    human: Human, where: Iterable[str], tracker: Tracker, rng: np.random.Generator
) -> dict[str, Mount]:
    """Mount sensors near their nominal places."""
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
    """A pose over time as a tracker records it; neither the first nor the last frame is lost."""
    spots = poses.translation + rng.normal(0.0, 1.0, (len(times), 3)) * tracker.noise_m
    shake = Rotation.from_rotvec(rng.normal(0.0, 1.0, (len(times), 3)) * tracker.noise_rad)
    turns = (poses.rotation * shake).as_quat(scalar_first=True)
    lost, span = np.zeros(len(times), dtype=bool), times[-1] - times[0]
    for _ in range(int(rng.poisson(tracker.dropouts_per_s * span))):
        start = times[0] + rng.uniform(0.0, span)
        lost |= (times >= start) & (times < start + rng.exponential(tracker.dropout_s))
    lost[[0, -1]] = False
    spots[lost], turns[lost] = np.nan, np.nan
    return Stream(times, spots, turns)


@dataclass(frozen=True, eq=False)
class Target:
    """The path of one sensor, and how far it is to be trusted."""

    positions: Float[np.ndarray, "frames 3"]  #: [m]; NaN where it was lost for long
    orientations: Float[np.ndarray, "frames 4"]  #: w x y z; NaN likewise
    #: 1 where it is known, 0 where it is lost, in between next to a loss [1]
    weights: Float[np.ndarray, "frames"]


def target(stream: Stream, *, cutoff_hz: float | None = CUTOFF_HZ) -> Target:
    """The target that a sensor's stream makes: gaps filled, noise above a cutoff filtered."""
    filled = fill_gaps(stream, gap_s=GAP_S)
    weights = _weights(filled)
    if cutoff_hz is None or filled.lost.all():
        return Target(filled.positions, filled.orientations, weights)
    settings = replace(Thresholds(), cutoff_hz=cutoff_hz)
    return Target(
        lowpass(filled.positions, filled.times, settings),
        lowpass_orientations(filled.orientations, filled.times, settings),
        weights,
    )


def _weights(stream: Stream) -> Float[np.ndarray, "frames"]:
    """Weights that rise and fall smoothly next to a loss; the ends of a recording do not fade."""
    out = np.where(stream.lost, 0.0, 1.0)
    for first, last in geometry.runs(stream.lost):
        before = (stream.times[max(first - 1, 0)] - stream.times) / FADE_S
        after = (stream.times - stream.times[min(last + 1, len(out) - 1)]) / FADE_S
        near = np.where(np.arange(len(out)) < first, before, after)
        out = np.minimum(out, np.clip((near + 0.1) / 1.1, 0.0, 1.0))
    return np.asarray(out * out * (3.0 - 2.0 * out))
