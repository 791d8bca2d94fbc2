"""Where a body was throughout a capture, sampled at equal steps of time and kept as one text."""

from base64 import b64decode, b64encode
from binascii import Error as Base64Error
from dataclasses import dataclass
from math import isfinite

import numpy as np
from jaxtyping import Float

from capar.model.errors import ParError

UNIT_M = 1e-4
"""Places are kept to this [m]."""

LOST = np.iinfo(np.int32).min
"""What a coordinate is while the body was lost."""


@dataclass(frozen=True, slots=True)
class SampledTrack:
    """The places of a body's origin in the world, from the first frame on."""

    body: str
    step_s: float
    """Time between two samples [s]; zero where one sample holds throughout."""

    samples: str
    """Base64 of x, y, z of each sample as little-endian 32-bit integers in units of ``UNIT_M``."""

    def __post_init__(self) -> None:
        """Check that the text can be read.

        Raises:
            ParError: It is no Base64 of samples, or the step is no time.
        """
        try:
            size = len(b64decode(self.samples, validate=True))
        except Base64Error:
            size = 1
        if size == 0 or size % 12:
            raise ParError(f"the samples of {self.body!r} are no Base64 of x, y, z in 32 bits each")
        if not isfinite(self.step_s) or self.step_s < 0.0 or (self.step_s == 0.0 and size > 12):
            raise ParError(
                f"the samples of {self.body!r} are {self.step_s} s apart, which is no step"
            )

    @property
    def positions(self) -> Float[np.ndarray, "samples 3"]:
        """World positions [m]; NaN where the body was lost."""
        counts = np.frombuffer(b64decode(self.samples), dtype="<i4").reshape(-1, 3)
        return np.where(counts == LOST, np.nan, counts * UNIT_M)

    def lost_around(self, time_s: float) -> tuple[float, float] | None:
        """From when to when the body was lost about a time [s]; none where it was seen.

        The ends are the samples beside, in which it was seen, or those of the track.
        """
        lost = np.isnan(self.positions).any(axis=1)
        at = time_s / self.step_s if self.step_s else 0.0
        before, after = (min(int(whole(at)), len(lost) - 1) for whole in (np.floor, np.ceil))
        if not (lost[before] or lost[after]):
            return None
        seen = np.flatnonzero(~lost)
        first = int(seen[seen < after].max(initial=0))
        last = int(seen[seen > before].min(initial=len(lost) - 1))
        return first * self.step_s, last * self.step_s


def sampled_track(
    body: str, step_s: float, positions: Float[np.ndarray, "samples 3"]
) -> SampledTrack:
    """The track of a body, by its places [m] at equal steps of time; NaN where it was lost."""
    lost = np.isnan(positions)
    counts = np.where(lost, LOST, np.rint(np.where(lost, 0.0, positions) / UNIT_M))
    return SampledTrack(body, step_s, b64encode(counts.astype("<i4").tobytes()).decode())
