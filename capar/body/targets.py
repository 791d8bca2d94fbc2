"""Where sensors are to be followed to: short gaps filled, noise filtered, long gaps faded out."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from capar.model.capture import Stream
from capar.model.geometry import runs
from extractors.signals.filters import lowpass, lowpass_orientations
from extractors.signals.gaps import fill_gaps
from extractors.thresholds import Thresholds

CUTOFF_HZ = 8.0
"""Cutoff of the zero-phase filter [Hz]: above what hands do, below most of a tracker's noise."""

GAP_S = 0.1
"""Losses shorter than this are interpolated (spec 3) [s]."""

FADE_S = 0.1
"""How long a sensor takes to regain its full weight after a longer loss [s]."""


@dataclass(frozen=True, eq=False)
class Target:
    """The path of one sensor, and how far it is to be trusted."""

    positions: Float[np.ndarray, "frames 3"]
    """[m]; NaN where it was lost for long."""

    orientations: Float[np.ndarray, "frames 4"]
    """w x y z; NaN likewise."""

    weights: Float[np.ndarray, "frames"]
    """1 where it is known, 0 where it is lost, in between beside a loss [1]."""


def target(stream: Stream, *, cutoff_hz: float | None = CUTOFF_HZ) -> Target:
    """The target that a sensor's stream makes.

    Args:
        stream: As it was recorded.
        cutoff_hz: Of the filter [Hz]; None leaves the stream as it is.
    """
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
    """Weights that rise and fall smoothly beside a loss; the ends of a recording do not fade."""
    out = np.where(stream.lost, 0.0, 1.0)
    for first, last in runs(stream.lost):
        before = (stream.times[max(first - 1, 0)] - stream.times) / FADE_S
        after = (stream.times - stream.times[min(last + 1, len(out) - 1)]) / FADE_S
        near = np.where(np.arange(len(out)) < first, before, after)
        out = np.minimum(out, np.clip((near + 0.1) / 1.1, 0.0, 1.0))
    return np.asarray(out * out * (3.0 - 2.0 * out))
