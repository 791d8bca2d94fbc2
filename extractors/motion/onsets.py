"""When a displacement began to grow, estimated from all that is seen of how it grew."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

Ways = Float[np.ndarray, "frames"]

STROKES_S = tuple(0.15 * 40.0 ** (step / 11.0) for step in range(12))
"""Durations of smooth strokes (minimum jerk; Flash and Hogan 1985) that are tried [s]: from the
least duration of a rest to 6 s; longer ones begin alike."""

USUAL_S, RATIO = 1.0, 2.5
"""Most strokes of people's arms last for this [s], or up to so many times more or less [1]: a place
of rest is reached in half a second, a bowl is emptied in two."""

CANDIDATES = 24
"""How many beginnings are tried at once [1], then about the likely ones."""

_SPREAD = np.linspace(0.0, 1.0, CANDIDATES // 2) ** 2
"""Where they lie between when a motion is first seen and the limits [1]: the farther, the wider."""

ABOUT = 3.0
"""How many deviations about the likely beginning the next ones are tried [1]."""

STRAY = 0.1
"""Share of itself by which a displacement strays from any profile [1]: people move less smoothly
than a formula. So small displacements tell of the beginning, as far as noise lets them."""

QUIET = 0.05
"""Noise is taken for at least this share of the unit [1]: what is recorded without any drifts."""

UNEXPLAINED = 9.0
"""What no profile explains is taken for at most so many times the variance of noise [1]: then it is
followed back for a third of the longest time."""

_STROKE = np.exp(-0.5 * (np.log(np.array(STROKES_S) / USUAL_S) / np.log(RATIO)) ** 2)
_PRIOR = np.concatenate([[1.0], _STROKE * len(STROKES_S) / _STROKE.sum()])
"""How likely each profile is beforehand [1]: a steady speed is one among all strokes."""

FEWEST_FRAMES = 4
"""Fewer frames tell nothing of how a displacement grew [1]."""


def onset(
    way: Ways,
    smooth: Ways,
    seen: int,
    *,
    noise: Ways,
    place: float,
    most: int,
    rest: int,
    rate_hz: float,
) -> int:
    """The frame at which a displacement began to grow from nothing.

    Args:
        way: The displacement along one direction, from a place of rest to where it is well beyond,
            in units of what is seen of it [1]; NaN where it was lost.
        smooth: The same, low-passed.
        seen: The frame at which it is first seen to have left the place.
        noise: Deviation of each displacement that is not low-passed [1].
        place: Deviation of the place from where it was taken to be [1].
        most: How many frames before it is seen it began at most.
        rest: How many frames are looked at before that.
        rate_hz: Frames a second [Hz].
    """
    lost = np.isnan(way)
    before, after = np.flatnonzero(lost[:seen]), np.flatnonzero(lost[seen:])
    start = max(seen - most - rest, int(before[-1]) + 1 if before.size else 0)
    stop = seen + int(after[0]) if after.size else len(way)
    if stop <= seen or stop - start < FEWEST_FRAMES:
        return seen
    times = (np.arange(start, stop) - seen) / rate_hz
    told = weights(smooth[start:stop], noise[start:stop])
    earliest_s = max(float(times[0]), -most / rate_hz)
    track = Growth(way[start:stop], times, told, place)
    begin_s = beginning_s(track, earliest_s, float(times[-1]))
    return seen + round(begin_s * rate_hz)


def weights(smooth: Ways, noise: Ways) -> Ways:
    """How much each displacement tells of the beginning: its inverse variance [1]."""
    return np.asarray(1.0 / (np.maximum(noise, QUIET) ** 2 + (STRAY * smooth) ** 2))


@dataclass(frozen=True, slots=True, eq=False)
class Growth:
    """A displacement along one direction, from a place on, and how well it is known."""

    way: Ways
    """How far it is from the place [1]."""

    times: Ways
    """When [s]; it is first seen at 0."""

    told: Ways
    """How much each frame tells (``weights``)."""

    place: float
    """Deviation of the place from where it was taken to be [1]."""

    def product(
        self, one: Float[np.ndarray, "*some frames"], other: Float[np.ndarray, "*some frames"]
    ) -> Float[np.ndarray, "*some"]:
        """Inner product of displacements, weighted by what each frame tells.

        All are from one place: an error of it is common to all frames, so that the inverse of their
        covariance has a second term (Sherman and Morrison 1950).
        """
        common = self.place**2 / (1.0 + self.place**2 * self.told.sum())
        return np.asarray(
            (one * other) @ self.told - common * (one @ self.told) * (other @ self.told)
        )


def beginning_s(track: Growth, earliest_s: float, latest_s: float) -> float:
    """When a displacement began to grow from nothing [s]: the mean over all that may explain it.

    Each beginning is tried with each profile: at once, by a steady speed, or smoothly, by a stroke
    of some duration. The size of a profile is the one that fits best (weighted least squares). What
    it leaves tells how likely it is, if noise is normal; beforehand all beginnings are as likely,
    and strokes by how long they last (Bayesian model averaging; Hoeting, Madigan, Raftery and
    Volinsky 1999). The mean moves little when noise, or a frame more or less, changes which one is
    the likeliest. The farther the way is from every profile, as that of what wobbles is, the less
    far back it is followed: by as many times less as what is left is larger than noise (reduced
    chi-squared).

    Args:
        track: The displacement, from the place before on.
        earliest_s: No earlier than this, which is not after 0.
        latest_s: No later than this, which is not before 0.
    """
    if earliest_s >= latest_s:
        return latest_s
    tries = np.unique(np.concatenate([earliest_s * _SPREAD, latest_s * _SPREAD]))
    left = float(_misfit(track, tries).min()) / len(track.way)
    earliest_s /= float(np.sqrt(np.clip(left, 1.0, UNEXPLAINED)))
    tries = np.unique(np.concatenate([earliest_s * _SPREAD, latest_s * _SPREAD]))
    mean_s, spread_s = _mean(track, tries)
    half_s = ABOUT * spread_s + float(np.interp(mean_s, tries, np.gradient(tries)))
    tries = np.linspace(
        max(mean_s - half_s, earliest_s), min(mean_s + half_s, latest_s), CANDIDATES
    )
    return _mean(track, tries)[0]


def _mean(track: Growth, tries: Float[np.ndarray, "tries"]) -> tuple[float, float]:
    """The mean of some beginnings by how likely they are, and their deviation from it [s]."""
    misfit = _misfit(track, tries)
    likely = _PRIOR @ np.exp(-0.5 * (misfit - misfit.min())) * np.gradient(tries)
    likely /= likely.sum()
    mean_s = float(likely @ tries)
    return mean_s, float(np.sqrt(likely @ (tries - mean_s) ** 2))


def _misfit(
    track: Growth, tries: Float[np.ndarray, "tries"]
) -> Float[np.ndarray, "profiles tries"]:
    """The weighted sum of squares that each profile leaves, from each beginning."""
    since = np.maximum(track.times[None, :] - tries[:, None], 0.0)
    paces = np.array([1.0 / stroke_s for stroke_s in STROKES_S])
    profiles = np.concatenate([since[None], _stroke(since[None] * paces[:, None, None])])
    power = track.product(profiles, profiles)
    shared = np.maximum(track.product(profiles, track.way), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        explained = np.where(power > 0.0, shared**2 / power, 0.0)
    return np.asarray(track.product(track.way, track.way) - explained)


def _stroke(shares: Float[np.ndarray, "*some"]) -> Float[np.ndarray, "*some"]:
    """Way done of a stroke of least jerk, from 0 to 1, after a share of its time."""
    part = np.minimum(shares, 1.0)
    return np.asarray(part * part * part * (10.0 + part * (6.0 * part - 15.0)))
