"""When a body bends down or crouches beside what its hands do, and straightens up again."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from capar.model.locations import SampledTrack
from capar.model.observation import ObservedLink
from kb.language.clause import Clause, in_time
from kb.language.lexicalisation import (
    BEGIN_UP,
    BEND,
    CROUCH,
    STAND_UP,
    STEP,
    STEP_AWAY,
    STEP_BACK,
    STEP_UP,
    STRAIGHTEN,
    TWO_STEPS,
    WALKING,
)
from kb.language.thresholds import (
    BENT_M,
    CROUCHED_M,
    CROUCHED_SHARE,
    NOTICED_SHARE,
    REST_S,
    SCRAP_S,
    STANDING_M,
    STILL_M,
    UNSEEN_S,
    UP_SHARE,
)

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
    bends = list(_changes(head, manual[0], BEND, BENT_M))
    crouches = [
        _with_head(change, bends)
        for change in _changes(_track(PELVIS, links, tracks), manual[0], CROUCH, CROUCHED_M)
        if _by_the_knees(change, head, _track(PELVIS, links, tracks))
    ]
    own = [_after_bending(crouch, bends, head) for crouch in crouches]
    own = [_after_walking(change, steps) for change in own]
    own += [bend for bend in bends if not any(map(bend.overlaps, own))]
    own = [change for change in own if not any(_goes_with(change, step) for step in manual)]
    rest = [step for step in steps if not _steadies(step, own)]
    return tuple(sorted((*rest, *own), key=in_time))


def _by_the_knees(change: Clause, head: SampledTrack | None, pelvis: SampledTrack | None) -> bool:
    """Whether the pelvis goes down or up by as much as makes crouching of bending."""
    if head is None or pelvis is None:
        return True
    head_m, pelvis_m = (
        float(np.ptp(each.positions[_frames(each, change), 2])) for each in (head, pelvis)
    )
    return pelvis_m > CROUCHED_SHARE * head_m


def _frames(track: SampledTrack, change: Clause) -> slice:
    return slice(round(change.start_s / track.step_s), round(change.end_s / track.step_s) + 1)


def _with_head(change: Clause, bends: Sequence[Clause]) -> Clause:
    """Standing up until the head is up, too."""
    rises = [bend.end_s for bend in bends if bend.pattern == STRAIGHTEN and bend.overlaps(change)]
    late = change.pattern == STAND_UP
    return replace(change, end_s=max(change.end_s, *rises)) if late and rises else change


def _after_bending(crouch: Clause, bends: Sequence[Clause], head: SampledTrack | None) -> Clause:
    """Crouching by one who has bent down before, since then."""
    first = next((bend for bend in bends if bend.pattern == BEND and bend.overlaps(crouch)), None)
    if crouch.pattern != CROUCH or first is None or head is None:
        return crouch
    heights = head.positions[:, 2]
    lower_m = float(heights.max() - heights[round(crouch.start_s / head.step_s)])
    if lower_m < BENT_M or crouch.start_s - first.start_s < REST_S:
        return crouch
    return replace(crouch, start_s=first.start_s)


def _after_walking(change: Clause, steps: Sequence[Clause]) -> Clause:
    """Going down by one who still walks for a noticed time, since the walk is over."""
    ends = [
        step.end_s for step in steps if step.pattern in WALKING and step.start_s <= change.start_s
    ]
    late = change.start_s + SCRAP_S < max(ends, default=0.0) < change.end_s
    return replace(change, start_s=max(ends)) if late and change.pattern == CROUCH else change


def _goes_with(change: Clause, step: Clause) -> bool:
    """Whether the body mostly goes down or comes up while a thing is moved."""
    return change.overlap_s(step) > 0.5 * (change.end_s - change.start_s)


def _steadies(step: Clause, changes: Sequence[Clause]) -> bool:
    """Whether it is a step or two that the body takes as it goes down or comes up.

    Who steps back for longer than a step lasts goes somewhere.
    """
    leaves = step.pattern == STEP_BACK and step.end_s - step.start_s > SCRAP_S
    single = step.pattern in {STEP, TWO_STEPS, STEP_UP, STEP_BACK, STEP_AWAY} and not leaves
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

    A recording that begins or ends on the way down or up tells that part of it.

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
    again = STAND_UP if down == CROUCH else STRAIGHTEN
    for before, after in pairwise([0, *up, len(heights)]):
        low = before + np.flatnonzero(heights[before:after] < standing_m - least_m)
        if not len(low):
            continue
        lowest_m = float(heights[low].min())
        depth_m = standing_m - lowest_m
        lowest = low[heights[low] < standing_m - (1.0 - NOTICED_SHARE) * depth_m]
        if heights[before] - heights[lowest[0]] > least_m - STANDING_M:
            stood = np.flatnonzero(
                heights[before : lowest[0]] > standing_m - NOTICED_SHARE * depth_m
            )
            first = int(before + max(stood, default=0))
            yield _clause(deed, down, track, first, int(lowest[0]))
        leaves = int(max(low[heights[low] < lowest_m + STANDING_M]))
        if after < len(heights):
            yield _clause(deed, again, track, leaves, _upright(track, int(after)))
        elif heights[-1] - heights[leaves] > least_m - STANDING_M:
            rises = heights[-1] - heights[max(len(heights) - 1 - _brief(track), 0)] > STILL_M
            nearly = heights[-1] > standing_m - UP_SHARE * depth_m
            if rises or nearly:
                pattern = again if nearly else BEGIN_UP
                yield _clause(deed, pattern, track, leaves, len(heights) - 1)


def _upright(track: SampledTrack, frame: int) -> int:
    """The frame, from one in which a body is nearly up, in which it is as high as it then gets."""
    heights, brief = track.positions[:, 2], _brief(track)
    last = frame
    while last + brief < len(heights) and heights[last + brief] - heights[last] > 0.5 * STILL_M:
        last += 1
    done = heights[frame : last + 1] > heights[last] - STILL_M
    return frame + int(np.argmax(done))


def _brief(track: SampledTrack) -> int:
    """How many frames last as long as an onlooker takes to react."""
    return max(round(UNSEEN_S / track.step_s), 1)


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
