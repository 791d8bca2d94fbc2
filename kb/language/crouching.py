"""When a body bends down or crouches beside what its hands do, and straightens up again."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from capar.model.observation import ObservedLink
from capar.model.sampled_track import SampledTrack
from kb.language.clause import Clause, in_time
from kb.language.lexicalisation import BEND, CROUCH, STAND_UP, STEP, STEP_AWAY, STEP_UP
from kb.language.thresholds import BENT_M, CROUCHED_M, STANDING_M, STILL_M, UNSEEN_S

PELVIS, HEAD = "pelvis", "head"
"""The kinds of the links that go down: both in crouching, the head alone in bending."""


def with_crouching(
    steps: Sequence[Clause], links: Sequence[ObservedLink], tracks: Sequence[SampledTrack]
) -> tuple[Clause, ...]:
    """The clauses, with going down and straightening up where that is no part of moving a thing.

    Who lifts a thing from the ground straightens up with it: that is told by the lifting.

    Args:
        steps: What was done, in order of time.
        links: The links.
        tracks: Where bodies were.
    """
    manual = [step for step in steps if step.objects and step.changes]
    if not manual:
        return tuple(steps)
    head = _track(HEAD, links, tracks)
    crouches = [
        _until_upright(each, head)
        for each in _changes(_track(PELVIS, links, tracks), manual[0], CROUCH, CROUCHED_M)
    ]
    bends = [_until_upright(each, head) for each in _changes(head, manual[0], BEND, BENT_M)]
    own = [*crouches, *(each for each in bends if not any(map(each.overlaps, crouches)))]
    own = [each for each in own if not any(_goes_with(each, step) for step in manual)]
    rest = [step for step in steps if not _steadies(step, own)]
    return tuple(sorted((*rest, *own), key=in_time))


def _until_upright(change: Clause, head: SampledTrack | None) -> Clause:
    """Straightening up until the head rises no more."""
    if change.pattern != STAND_UP or head is None:
        return change
    heights, brief = head.positions[:, 2], max(round(UNSEEN_S / head.step_s), 1)
    at = round(change.end_s / head.step_s)
    while at + brief < len(heights) and heights[at + brief] - heights[at] > 0.5 * STILL_M:
        at += 1
    return replace(change, end_s=max(change.end_s, at * head.step_s))


def _goes_with(change: Clause, step: Clause) -> bool:
    """Whether the body mostly goes down or comes up while a thing is moved."""
    return change.overlap_s(step) > 0.5 * (change.end_s - change.start_s)


def _steadies(step: Clause, changes: Sequence[Clause]) -> bool:
    """Whether it is a single step that the body takes as it goes down or comes up."""
    single = step.pattern in {STEP, STEP_UP, STEP_AWAY}
    return single and any(
        each.start_s <= step.start_s and step.end_s <= each.end_s for each in changes
    )


def _track(
    kind: str, links: Sequence[ObservedLink], tracks: Sequence[SampledTrack]
) -> SampledTrack | None:
    """Where the link of that kind was, or a body of that name; None where that was not kept."""
    name = next((link.ee for link in links if link.kind == kind), kind)
    return next((each for each in tracks if each.body == name and each.step_s > 0.0), None)


def _changes(
    track: SampledTrack | None, deed: Clause, down: str, least_m: float
) -> Iterator[Clause]:
    """Each time that the body goes down, or comes up again, as a clause of who does the deed.

    Args:
        track: Where the link was that goes down.
        deed: A deed of the same person.
        down: How it is said.
        least_m: How far it goes down at least [m].
    """
    if track is None or np.isnan(track.positions).any():
        return
    heights = track.positions[:, 2]
    standing_m = float(heights.max())
    up = np.flatnonzero(heights > standing_m - STANDING_M)
    for before, after in pairwise([*up, len(heights)]):
        low = before + np.flatnonzero(heights[before:after] < standing_m - least_m)
        if len(low):
            lowest = low[heights[low] < heights[low].min() + STANDING_M]
            yield _clause(deed, down, track, int(before), int(lowest[0]))
            if after < len(heights):
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
