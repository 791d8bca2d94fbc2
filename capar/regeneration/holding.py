"""When hands and things, and things and the head, are rigidly together."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from capar.model.capture import Capture, TagType
from capar.model.facts import Displaced, Touching
from capar.model.geometry import runs

SETTLED_M = 0.0025
"""While two bodies' relative pose is so near its median, they are rigidly together [m]."""

SETTLED_RAD = float(np.radians(2.0))
"""Likewise the angle [rad]."""

LOOSER = (1.0, 2.0)
"""Multiples of both that are tried: noisy sensors keep less still [1]."""

SETTLED_SHARE = 0.8
"""Noise may take so small a share of the frames in between out of that [1]."""

GRASP_M = 0.025
"""How far a living hand may wander on what it carries: skin, fingers and wrist give way [m]."""

GRASP_RAD = float(np.radians(20.0))
"""Likewise the angle [rad]."""

SLID = 2.0
"""Multiple of both by which a hand may slide before the thing leaves and after it arrived [1]."""

UNSEEN_S = 1.0
"""So long a hand that touches a thing from the first frame on may slide before it holds it [s]."""

STEP_S, TOUCHES_S = 0.15, 0.2
"""A hand that touches a thing at rest for the first of these before that moves, or after, is seen
to touch it; it is held for the second then, so that this is seen again [s]."""

INSTANTS = 5
"""At so many instants a thing that moves at the head meets it [1]."""

CARRIED_M = 0.02
"""A thing that is so far from where a contact begins and from where it ends is under way [m]."""


@dataclass(frozen=True)
class Hold:
    """A hand and a thing that are rigidly together."""

    side: str
    thing: str
    first: int
    last: int


@dataclass(frozen=True)
class Meeting:
    """A held thing that is rigidly together with the performer's head, if only for an instant."""

    thing: str
    part: str
    first: int
    last: int


Hands = Mapping[str, tuple[str, RigidTransform]]
"""By side: the sensor's name, and ``T_world_hand`` at every frame."""


def holds_of(
    hands: Hands, paths: Mapping[str, RigidTransform], touching: list[Touching]
) -> tuple[Hold, ...]:
    """The part of each contact in which hand and thing are together, in order of time.

    Rigidly where that is so; else, where the hand carries the thing, within what a living hand's
    grasp gives way.

    Args:
        hands: The hands.
        paths: ``T_world_thing`` by name at every frame.
        touching: The contacts that were observed.
    """
    out = []
    for side, (sensor, hand) in hands.items():
        for contact in touching:
            if contact.body == sensor and contact.other in paths:
                part = slice(contact.first, contact.last + 1)
                thing = paths[contact.other][part]
                span = _together(thing, hand[part])
                if span:
                    first, last = (contact.first + edge for edge in span)
                    out.append(Hold(side, contact.other, first, last))
    return tuple(sorted(out, key=lambda hold: (hold.first, hold.side)))


def with_unseen_ends(
    holds: tuple[Hold, ...],
    hands: Hands,
    touching: list[Touching],
    times: Float[np.ndarray, "frames"],
) -> tuple[Hold, ...]:
    """Holds from the first frame, or to the last one, where the hand touches the thing there.

    Nobody saw it come or leave: performed again, it would have to come from ease. Only if it slides
    no longer than ``UNSEEN_S`` meanwhile.

    Args:
        holds: As they were found.
        hands: The hands.
        touching: The contacts that were observed.
        times: Of the frames [s].
    """
    out = []
    for hold in holds:
        first, last = hold.first, hold.last
        for contact in touching:
            if (contact.body, contact.other) == (hands[hold.side][0], hold.thing):
                if contact.first == 0 and times[hold.first] - times[0] <= UNSEEN_S:
                    first = 0
                if contact.last == len(times) - 1 and times[-1] - times[hold.last] <= UNSEEN_S:
                    last = contact.last
        out.append(replace(hold, first=first, last=last))
    return tuple(sorted(out, key=lambda hold: (hold.first, hold.side)))


def with_touches(
    holds: tuple[Hold, ...],
    hands: Hands,
    touching: list[Touching],
    displaced: list[Displaced],
    times: Float[np.ndarray, "frames"],
) -> tuple[Hold, ...]:
    """Holds that begin before the thing moves, and end after it, where the hand touched it then.

    A living hand slides on a thing at rest until it has its grip: only the grip is held, which
    may begin so late that no touch would be seen before the thing moves.

    Args:
        holds: As they were found.
        hands: The hands.
        touching: The contacts that were observed.
        displaced: When things moved.
        times: Of the frames [s].
    """
    out = []
    for hold in holds:
        first, last = hold.first, hold.last
        for contact in touching:
            moved = [m for m in displaced if m.object == hold.thing and _within(m, contact)]
            if (contact.body, contact.other) == (hands[hold.side][0], hold.thing) and moved:
                start, end = min(m.first for m in moved), max(m.last for m in moved)
                if times[start] - times[contact.first] >= STEP_S and _within(hold, contact):
                    early = int(np.searchsorted(times, times[start] - TOUCHES_S + 1e-6)) - 1
                    first = min(first, max(contact.first, early))
                if times[contact.last] - times[end] >= STEP_S and _within(hold, contact):
                    late = int(np.searchsorted(times, times[end] + TOUCHES_S - 1e-6))
                    last = max(last, min(contact.last, late))
        out.append(replace(hold, first=first, last=last))
    return tuple(sorted(out, key=lambda hold: (hold.first, hold.side)))


def _within(span: Hold | Displaced, contact: Touching) -> bool:
    return contact.first <= span.first and span.last <= contact.last


def wanderings(
    hands: Hands, paths: Mapping[str, RigidTransform], holds: tuple[Hold, ...]
) -> list[str]:
    """What is told of holds that are not rigid: performed again, they are."""
    out = []
    for hold in holds:
        part = slice(hold.first, hold.last + 1)
        off, turned = _apart(paths[hold.thing][part].inv() * hands[hold.side][1][part])
        if off.max() > LOOSER[-1] * SETTLED_M or turned.max() > LOOSER[-1] * SETTLED_RAD:
            out.append(
                f"the recorded {hold.side} hand wanders by up to {1e3 * off.max():.0f} mm and "
                f"{np.degrees(turned.max()):.0f} degrees on {hold.thing!r} while it holds it; "
                "performed, it stays where it was in the median"
            )
    return out


def meetings_of(
    capture: Capture,
    eyes: RigidTransform,
    paths: Mapping[str, RigidTransform],
    touching: list[Touching],
) -> tuple[Meeting, ...]:
    """When things are rigidly together with the head, in order of time.

    What moves at the head as long as it is there, such as a mug that is tipped further, meets it
    at some instants, from when it comes to when it leaves.
    """
    own = {thing.name for thing in capture.objects if thing.tag is TagType.SELF}
    out = []
    for contact in touching:
        for thing, part in ((contact.body, contact.other), (contact.other, contact.body)):
            if thing in paths and part in own:
                span = slice(contact.first, contact.last + 1)
                found = settled(eyes[span].inv() * paths[thing][span])
                if found:
                    first, last = (contact.first + edge for edge in found)
                    out.append(Meeting(thing, part, first, last))
                else:
                    instants = np.linspace(contact.first, contact.last, INSTANTS).round()
                    frames = dict.fromkeys(int(frame) for frame in instants)
                    out += [Meeting(thing, part, frame, frame) for frame in frames]
    return tuple(sorted(out, key=lambda meeting: meeting.first))


def settled(relative: RigidTransform) -> tuple[int, int] | None:
    """First and last of the frames in which a relative pose is near its median, if most are."""
    off, turned = _apart(relative)
    for factor in LOOSER:
        steady = (off < factor * SETTLED_M) & (turned < factor * SETTLED_RAD)
        frames = np.flatnonzero(steady)
        if len(frames) > 1 and steady[frames[0] : frames[-1] + 1].mean() >= SETTLED_SHARE:
            return int(frames[0]), int(frames[-1])
    return None


def _together(thing: RigidTransform, hand: RigidTransform) -> tuple[int, int] | None:
    """When a hand and a thing that touch are together: rigidly, or while it is carried."""
    rigid = settled(thing.inv() * hand)
    under_way = np.flatnonzero(_under_way(thing))
    if rigid and (not len(under_way) or (rigid[0] <= under_way[0] and under_way[-1] <= rigid[1])):
        return rigid
    return _carried(thing, hand) or rigid


def _carried(thing: RigidTransform, hand: RigidTransform) -> tuple[int, int] | None:
    """When a hand grasps a thing that it carries; None if it carries it at no time.

    The grasp is compared with its median while the thing is under way, and has to stay near that
    all the way. Before and after, while the thing is about to leave and has arrived, it lasts as
    long as the hand has not slid much further.
    """
    under_way = np.flatnonzero(_under_way(thing))
    if len(under_way) < 2:
        return None
    first, last = int(under_way[0]), int(under_way[-1])
    relative = thing.inv() * hand
    off, turned = _apart(relative, relative[first : last + 1])
    grasped = (off < GRASP_M) & (turned < GRASP_RAD)
    if not grasped[first : last + 1].all():
        return None
    near = (off < SLID * GRASP_M) & (turned < SLID * GRASP_RAD)
    return next((int(b), int(e)) for b, e in runs(near) if b <= first and last <= e)


def wandering(thing: RigidTransform, hand: RigidTransform) -> tuple[float, float]:
    """How far a hand wanders on a thing while that is under way, at worst [m, rad]."""
    under_way = np.flatnonzero(_under_way(thing))
    if len(under_way) < 2:
        return 0.0, 0.0
    part = slice(int(under_way[0]), int(under_way[-1]) + 1)
    off, turned = _apart(thing[part].inv() * hand[part])
    return float(off.max()), float(turned.max())


def _under_way(thing: RigidTransform) -> Bool[np.ndarray, "frames"]:
    spots = thing.translation
    gone, left = (np.linalg.norm(spots - end, axis=1) for end in (spots[0], spots[-1]))
    return np.asarray((gone > CARRIED_M) & (left > CARRIED_M))


def _apart(
    relative: RigidTransform, usual: RigidTransform | None = None
) -> tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]]:
    """How far a relative pose is from the median of some frames [m, rad]; of all, unless stated."""
    usual = relative if usual is None else usual
    middle = np.median(usual.translation, axis=0)
    near = np.linalg.norm(usual.translation - middle, axis=1)
    turn = usual.rotation[near <= np.median(near)].mean()
    off = np.linalg.norm(relative.translation - middle, axis=1)
    return off, np.asarray((relative.rotation * turn.inv()).magnitude())
