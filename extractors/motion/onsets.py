"""When a displacement began to grow, estimated from all that is seen of how it grew."""

import numpy as np
from jaxtyping import Float

Ways = Float[np.ndarray, "frames"]

STROKES_S = tuple(0.15 * 40.0 ** (step / 11.0) for step in range(12))
"""Durations of smooth strokes (minimum jerk; Flash and Hogan 1985) that are tried [s]: from 0.15 s,
the least rest, to 6 s, beyond which all strokes begin alike."""

CANDIDATES = 24
"""How many beginnings are tried at once, evenly [1]; then as many about the likely ones."""

ROUNDS = 2
"""How often they are tried [1]."""

ABOUT = 3.0
"""How many deviations about the likely beginning the next ones are tried [1]."""

STRAY = 0.1
"""Share of itself by which a displacement strays from any profile [1]: people move less smoothly
than a formula. So what is small tells of the beginning, as far as noise lets it."""

QUIET = 0.1
"""No noise is taken for less than this share of a hair [1]: what is recorded without any drifts."""


def weights(smooth: Ways, noise: float) -> Ways:
    """How much each displacement tells of the beginning: its inverse variance [1].

    Args:
        smooth: The displacements, low-passed, in hairs [1].
        noise: Deviation of one that is not [hairs].
    """
    return np.asarray(1.0 / (max(noise, QUIET) ** 2 + (STRAY * smooth) ** 2))


def beginning_s(
    way: Ways, times: Ways, told: Ways, earliest_s: float, latest_s: float
) -> float:
    """When a displacement began to grow from nothing [s], in the mean over all that explains it.

    Each beginning is tried with each profile: at once, by a steady speed, or smoothly, by a stroke
    of some duration. The size of each profile is the one that fits best (least squares). By
    Gaussian noise its misfit tells how likely it is; all are as likely beforehand. The mean by
    these weights moves little where noise, or a frame more or less, changes which one is likeliest.

    Args:
        way: The displacement along one direction, from the place before on.
        times: When [s].
        told: How much each frame tells (``weights``).
        earliest_s: No earlier than this.
        latest_s: No later than this.
    """
    mean_s, low_s, high_s = latest_s, earliest_s, latest_s
    for _ in range(ROUNDS):
        tries = np.linspace(low_s, high_s, CANDIDATES)
        misfit = _misfit(way, times, told, tries)
        likely = np.exp(-0.5 * (misfit - misfit.min())).sum(axis=0)
        likely /= likely.sum()
        mean_s = float(likely @ tries)
        spread_s = float(np.sqrt(likely @ (tries - mean_s) ** 2))
        half_s = max(ABOUT * spread_s, 2.0 * float(tries[1] - tries[0]))
        low_s, high_s = max(low_s, mean_s - half_s), min(high_s, mean_s + half_s)
    return mean_s


def _misfit(
    way: Ways, times: Ways, told: Ways, tries: Float[np.ndarray, "tries"]
) -> Float[np.ndarray, "profiles tries"]:
    """The weighted sum of squares that each profile leaves, from each beginning."""
    since = times[None, :] - tries[:, None]
    profiles = np.stack([np.maximum(since, 0.0), *(_stroke(since / each) for each in STROKES_S)])
    power = (profiles**2) @ told
    shared = np.maximum(profiles @ (told * way), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        explained = np.where(power > 0.0, shared**2 / power, 0.0)
    return np.asarray(told @ way**2 - explained)


def _stroke(
    share: Float[np.ndarray, "tries frames"],
) -> Float[np.ndarray, "tries frames"]:
    """Way done of a stroke of least jerk, from 0 to 1, after a share of its time."""
    part = np.clip(share, 0.0, 1.0)
    return np.asarray(part * part * part * (10.0 + part * (6.0 * part - 15.0)))
