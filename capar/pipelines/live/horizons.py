"""Every horizon of live observation in one place: which quantity, how many seconds, and why."""

from dataclasses import dataclass

from capar.model.calibration import Calibration
from capar.model.errors import CaparError
from extractors.calibration import thresholds_of
from extractors.signals.filters import filter_settles_s


@dataclass(frozen=True, slots=True)
class LiveHorizons:
    """How far live observation looks back, and how long it waits before it settles anything.

    Two windows slide over the frames. A short one is measured often and names segments; a long
    one is measured seldom and gives the facts of the result, with the margin on both sides that
    ``extractors.calibration`` proves.
    """

    stride_s: float = 0.45
    """Between two measurements of the short window at most [s], in which segments are found; it is
    measured once more as soon as one that was found is to be settled."""

    grain_s: float = 1.0
    """Short windows begin at multiples of this [s]: what is measured at their first frame is then
    the same several times in a row, and is known."""

    watch_s: float = 0.05
    """Between two measurements at least [s], where a thing moves whose first motion is awaited."""

    announce_s: float = 0.4
    """After its end a segment is announced [s]: ends that are newer still move, as much of what the
    filter asks for has not been seen."""

    settle_s: float = 0.5
    """After its end a segment is settled [s]: what later frames change in a smoothed pose after
    0.4 s is less than a millionth of their way, and losses that are shorter than 0.1 s are filled.
    That is also longer than contacts that are dropped and gaps that are closed (0.1 s)."""

    edge_s: float = 0.75
    """After its end a segment is settled at whose end a thing starts or stops [s], and so late
    facts are kept: when it started is told by how its way grew until it was well beyond its
    floor."""

    lasts_s: float = 0.1
    """So much later than a rule asks for, what has to last for some time has lasted it [s]: by then
    the filter knows the end of that time as well as it knows a segment that is announced."""

    fresh_s: float = 0.2
    """So long a motion that has just begun may turn out to be none [s]: a glitch of the tracker, or
    what the filter makes of the last frames."""

    near_s: float = 0.9
    """So long it is awaited whether bodies touch again that have stayed near each other [s]: their
    contact lasts then."""

    window_s: float = 4.0
    """Least length of the short window [s]."""

    motion_s: float = 10.0
    """It reaches back to the beginning of every motion that goes on, to so long ago at most [s]:
    how a motion is parted is told from its beginning."""

    rest_s: float = 30.0
    """By how much of its rest the place of a resting body is told [s]: the median of a longer one
    is that of its last part."""

    handing_s: float = 2.0
    """While two end-effectors hold one thing, so long it is awaited who lets go of it [s]: whether
    the other one takes it over depends on that."""

    rules_s: float = 20.0
    """How far back rules see at most [s]; flicker is resolved in windows of 10 s."""

    segments: int = 5
    """So many settled segments of a link are told to the rules again, so that these know what a
    segment follows; fewer where they last longer than ``rules_s``."""

    block_s: float = 5.0
    """Between two measurements of the long window [s]."""

    margin_s: float = 9.0
    """What the long window holds on either side of the block that it settles [s]: the calibration's
    own margin. Nearly all of it is the horizon of extrema of speed, 4 s, twice."""

    def __post_init__(self) -> None:
        """Check that the windows hold what they are to settle.

        Raises:
            CaparError: A window is shorter than what it must hold.
        """
        if min(self.stride_s, self.grain_s, self.settle_s, self.block_s) <= 0.0:
            raise CaparError(
                "live horizons: expected stride, grain, settle and block longer than 0 s"
            )
        longest_s = max(self.settle_s, self.edge_s)
        if self.window_s < 2.0 * (longest_s + self.stride_s):
            raise CaparError(
                f"live horizons: a window of {self.window_s:g} s cannot settle what ended "
                f"{longest_s:g} s ago every {self.stride_s:g} s; expected at least "
                f"{2.0 * (longest_s + self.stride_s):g} s"
            )

    @property
    def whole_s(self) -> float:
        """Length of the long window [s]."""
        return 2.0 * self.margin_s + self.block_s


def horizons_of(calibration: Calibration, *, stride_s: float = 0.45) -> LiveHorizons:
    """The horizons that a calibration calls for: by its margin, its filter, and its rests."""
    known = calibration.horizons
    limits = thresholds_of(calibration)
    settles_s = filter_settles_s(calibration.step_s, limits)
    return LiveHorizons(
        stride_s=stride_s,
        settle_s=settles_s + known.gap_s,
        edge_s=max(limits.rest_begins_s, known.filter_s + known.gap_s),
        margin_s=known.margin_s,
    )
