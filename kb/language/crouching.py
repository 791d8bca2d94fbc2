"""When a body crouches and stands up beside what its hands do, by the height of the pelvis."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from capar.model.observation import ObservedLink
from capar.model.sampled_track import SampledTrack
from kb.language.clause import Clause, in_time
from kb.language.lexicalisation import CROUCH, STAND_UP
from kb.language.thresholds import CROUCHED_M, STANDING_M

PELVIS = "pelvis"
"""The kind of the link that goes down in crouching; the head does in stooping, too."""


def with_crouching(
    steps: Sequence[Clause], links: Sequence[ObservedLink], tracks: Sequence[SampledTrack]
) -> tuple[Clause, ...]:
    """The clauses, with crouching and standing up where that is no part of moving a thing.

    Who lifts a thing from the ground stands up with it: that is told by the lifting.

    Args:
        steps: What was done, in order of time.
        links: The links.
        tracks: Where bodies were.
    """
    pelvis = next((link.ee for link in links if link.kind == PELVIS), PELVIS)
    track = next((each for each in tracks if each.body == pelvis and each.step_s > 0.0), None)
    manual = [step for step in steps if step.objects and step.changes]
    if track is None or not manual:
        return tuple(steps)
    own = [each for each in _changes(track, manual[0]) if not any(map(each.overlaps, manual))]
    return tuple(sorted((*steps, *own), key=in_time))


def _changes(track: SampledTrack, deed: Clause) -> Iterator[Clause]:
    """Each time that the body crouches, or stands up, as a clause of who does the deed."""
    heights = track.positions[:, 2]
    if np.isnan(heights).any():
        return
    standing_m = float(heights.max())
    up = np.flatnonzero(heights > standing_m - STANDING_M)
    for before, after in pairwise(up):
        low = before + np.flatnonzero(heights[before:after] < standing_m - CROUCHED_M)
        if len(low):
            lowest = low[heights[low] < heights[low].min() + STANDING_M]
            yield _clause(deed, CROUCH, track, int(before), int(lowest[0]))
            yield _clause(deed, STAND_UP, track, int(lowest[-1]), int(after))


def _clause(deed: Clause, pattern: str, track: SampledTrack, first: int, last: int) -> Clause:
    return Clause(
        pattern=pattern,
        objects=(),
        ees=deed.ees,
        start_s=first * track.step_s,
        end_s=last * track.step_s,
        changes=False,
        name="PostureChange",
    )
