"""When hands and objects are together: holds, meetings with the head, throws and loads."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import trimesh
from jaxtyping import Bool, Float
from scipy.spatial import ConvexHull, QhullError
from scipy.spatial.transform import RigidTransform

from capar.body.scenes import Thing
from capar.model.capture import Capture, TagType
from capar.model.facts import Displaced, Leans, Lies, Touching
from capar.model.geometry import runs
from capar.model.observation import ForceStyle, Observation
from capar.regeneration.scenes import PlanError
from extractors.forces.free_motion import GRAVITY_MPS2

SETTLED_M = 0.0025
"""While two bodies' relative pose is so near its median, they are rigidly together [m]."""

SETTLED_RAD = float(np.radians(2.0))
"""Likewise the angle [rad]."""

LOOSER = (1.0, 2.0)
"""Multiples of both that are tried: noisy sensors keep less still [1]."""

SETTLED_SHARE = 0.8
"""Noise may take so small a share of the frames in between out of that [1]."""

GRASP_M = 0.025
"""How far a living hand may wander on what it carries: skin, fingers and wrist give path [m]."""

GRASP_RAD = float(np.radians(20.0))
"""Likewise the angle [rad]."""

SLID = 2.0
"""Multiple of both by which a hand may slide before the object leaves and after it arrived [1]."""

UNSEEN_S = 1.0
"""A hand that touches an object at the first frame may slide so long before it holds it [s]."""

STEP_S, TOUCHES_S = 0.15, 0.2
"""A hand that touches an object at rest for the first of these before that moves, or after, is seen
to touch it; it is held for the second then, so that this is seen again [s]."""

INSTANTS = 5
"""At so many instants an object that moves at the head meets it [1]."""

CARRIED_M = 0.02
"""An object that is so far from where a contact begins and from where it ends is under path [m]."""


@dataclass(frozen=True)
class Hold:
    """A hand and an object that are rigidly together."""

    side: str
    thing: str
    first: int
    last: int


@dataclass(frozen=True)
class Meeting:
    """A held object that is rigidly together with the performer's head, if only for an instant."""

    thing: str
    part: str
    first: int
    last: int


Hands = Mapping[str, tuple[str, RigidTransform]]
"""By side: the sensor's name, and ``T_world_hand`` at every frame."""


def holds_of(
    hands: Hands, paths: Mapping[str, RigidTransform], touching: list[Touching]
) -> tuple[Hold, ...]:
    """The part of each contact in which hand and object are together, in order of time.

    Rigidly where that is so; else, where the hand carries the object, within what a living hand's
    grasp gives path.
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
    """Holds from the first frame, or to the last one, where the hand touches the object there.

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
    """Holds that begin before the object moves, and end after it, where the hand touched it then.

    A living hand slides on an object at rest until it has its grip: only the grip is held, which
    may begin so late that no touch would be seen before the object moves.

    Args:
        holds: As they were found.
        hands: The hands.
        touching: The contacts that were observed.
        displaced: When objects moved.
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


def meetings_of(
    capture: Capture,
    eyes: RigidTransform,
    paths: Mapping[str, RigidTransform],
    touching: list[Touching],
) -> tuple[Meeting, ...]:
    """When objects are rigidly together with the head, in order of time.

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
    """When a hand and an object that touch are together: rigidly, or while it is carried."""
    rigid = settled(thing.inv() * hand)
    under_way = np.flatnonzero(_under_way(thing))
    if rigid and (not len(under_way) or (rigid[0] <= under_way[0] and under_way[-1] <= rigid[1])):
        return rigid
    return _carried(thing, hand) or rigid


def _carried(thing: RigidTransform, hand: RigidTransform) -> tuple[int, int] | None:
    """When a hand grasps an object that it carries; None if it carries it at no time.

    The grasp is compared with its median while the object is under path, and has to stay near that
    all the way. Before and after, while the object is about to leave and has arrived, it lasts as
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


NEAR_S = 0.25
"""A hold may end so long before an object is seen to move on alone [s]."""

FLIES_M = 0.025
"""What is nowhere farther than this from the parabola of gravity between two holds flew [m]."""


@dataclass(frozen=True)
class Release:
    """An object that a hand sets going, after which it moves on alone."""

    side: str
    thing: str
    frame: int
    """Of the blow, or the last of the hold."""

    force: ForceStyle


@dataclass(frozen=True)
class Throw:
    """An object that a hand lets go, and that is taken again after nothing but gravity moved it."""

    side: str
    """Of the hand that lets it go."""

    thing: str
    first: int
    """Last frame of the hold before."""

    last: int
    """First frame of the hold after."""

    catcher: str
    """Side of the hand that takes it."""


def releases_of(
    forces: tuple[ForceStyle, ...],
    sides: Mapping[str, str],
    holds: tuple[Hold, ...],
    times: Float[np.ndarray, "frames"],
    paths: Mapping[str, RigidTransform],
) -> tuple[tuple[Release, ...], tuple[Throw, ...]]:
    """The releases of a recording after which an object is left alone, and the flights to a hand.

    Args:
        forces: As they were observed.
        sides: Of the hands, by sensor.
        holds: As they were recorded.
        times: The clock [s].
        paths: ``T_world_thing`` by name at every frame.

    Returns:
        Both in order of time.

    Raises:
        PlanError: Something else than a hand sets an object going; or the object is taken again
            after it was struck, slid or met something.
    """
    out, throws = [], []
    for force in forces:
        if force.ee not in sides:
            raise PlanError(
                f"{force.ee!r} sets {force.object!r} going at {force.start_s:.2f} s; only hands "
                "do so when an action is performed again, since feet keep their place"
            )
        side = sides[force.ee]
        own = [hold for hold in holds if hold.side == side and hold.thing == force.object]
        frame = int(np.argmin(np.abs(times - force.start_s)))
        if not force.struck:
            ends = [h.last for h in own if abs(times[h.last] - force.start_s) < NEAR_S]
            if not ends:
                continue
            frame = min(ends, key=lambda last: abs(float(times[last]) - force.start_s))
        later = [h for h in holds if h.thing == force.object and h.first > frame]
        if later:
            toss = Throw(side, force.object, frame, later[0].first, later[0].side)
            if force.struck or not _flies(toss, times, paths[force.object]):
                raise PlanError(
                    f"{force.object!r} is taken again at {times[later[0].first]:.2f} s after it "
                    "moved on alone otherwise than in free flight from a hand that let it go, "
                    "where another body's may not come; end the recording before, with to_s in a "
                    "file given with --assume"
                )
            throws.append(toss)
            continue
        out.append(Release(side, force.object, frame, force))
    return tuple(out), tuple(throws)


def _flies(toss: Throw, times: Float[np.ndarray, "frames"], path: RigidTransform) -> bool:
    """Whether an object is near the parabola of gravity from its release to its catch.

    Any such object is for a moment: with two frames between, it is not known.
    """
    spots = path.translation[toss.first : toss.last + 1]
    past = times[toss.first : toss.last + 1] - times[toss.first]
    straight = spots[0] + np.outer(past / past[-1], spots[-1] - spots[0])
    straight[:, 2] += 0.5 * GRAVITY_MPS2 * past * (past[-1] - past)
    return len(past) > 2 and bool(np.linalg.norm(spots - straight, axis=1).max() < FLIES_M)


def with_blows(holds: tuple[Hold, ...], releases: tuple[Release, ...]) -> tuple[Hold, ...]:
    """The holds, and a momentary one for each blow: hand and object meet in that frame alone."""
    blows = [Hold(one.side, one.thing, *[one.frame] * 2) for one in releases if one.force.struck]
    kept = [
        hold
        for hold in holds
        if not any(
            (blow.side, blow.thing) == (hold.side, hold.thing)
            and hold.first - 1 <= blow.first <= hold.last + 1
            for blow in blows
        )
    ]
    return tuple(sorted([*kept, *blows], key=lambda hold: (hold.first, hold.side)))


@dataclass(frozen=True)
class Leaning:
    """A held object that leans over above or in another one that can be moved."""

    thing: str
    other: str
    lowest: int
    """The frame in the middle of its leaning over."""

    frames: tuple[int, ...]
    """Borders of the hand's steps meanwhile."""


def leanings_of(
    observation: Observation,
    sensors: Mapping[str, str],
    things: Mapping[str, Thing],
    holds: tuple[Hold, ...],
) -> tuple[Leaning, ...]:
    """When held objects lean over others that can be moved, in order of time."""
    leans = [fact for fact in observation.facts if isinstance(fact, Leans)]
    out = []
    for fact in observation.facts:
        if not isinstance(fact, Lies) or fact.how not in {"above", "inside"}:
            continue
        tilts = [
            lean
            for lean in leans
            if lean.object == fact.body and fact.first <= lean.first and lean.last <= fact.last
        ]
        held = [
            hold
            for hold in holds
            if hold.thing == fact.body
            and any(hold.first <= tilt.first and tilt.last <= hold.last for tilt in tilts)
        ]
        if held and fact.other in things and things[fact.other].tag is TagType.MOBILE:
            first = max(fact.first, min(hold.first for hold in held))
            last = min(fact.last, max(hold.last for hold in held))
            acting = {sensors[hold.side] for hold in held}
            ends = {part.last for part in observation.segments if part.ee in acting}
            frames = tuple(sorted(frame for frame in ends if first <= frame <= last))
            lowest = (tilts[0].first + tilts[0].last) // 2
            if frames:
                out.append(Leaning(fact.body, fact.other, lowest, frames))
    return tuple(sorted(out, key=lambda poise: poise.frames))


MOVES_M = 0.02
"""What goes no further than this is not carried along [m]."""

RESTS_M = 0.006
"""Points of a carried object that are no higher than this above its lowest are those it stands on
[m]."""

FRICTION = 0.3
"""Coefficient of friction between what bears and what is carried: ceramics on wood or plastic have
0.3 to 0.5 [1]."""

HALF_S = 0.1
"""Over so long before and after a frame its acceleration is measured [s]."""


@dataclass(frozen=True)
class Load:
    """An object that stands on another one while hands move that."""

    thing: str
    bearer: str
    first: int
    last: int


@dataclass(frozen=True)
class Steadiness:
    """Whether a carried object would slide or fall, at the worst frame of its ride."""

    tilt_rad: float
    """Angle between what it weighs on its bearer, which accelerates, and that one's normal."""

    tilt_frame: int
    inside_m: float
    """How far inside what it stands on it weighs; negative outside, where it falls over [m]."""

    inside_frame: int


def loads_of(
    paths: Mapping[str, RigidTransform], holds: tuple[Hold, ...], touching: list[Touching]
) -> tuple[Load, ...]:
    """What is carried by what hands move, in order of time; bearers before what they bear.

    Raises:
        PlanError: An object is taken by a hand after it was carried.
    """
    out: list[Load] = []
    carried = {hold.thing: [(hold.first, hold.last)] for hold in holds}
    for hold in holds:
        carried[hold.thing].append((hold.first, hold.last))
    while True:
        found = _next_load(paths, holds, touching, carried, out)
        if found is None:
            return tuple(out)
        later = [h for h in holds if h.thing == found.thing and h.last > found.first]
        if later:
            raise PlanError(
                f"a hand takes {found.thing!r} after or while {found.bearer!r} bears it, which is "
                "not regenerated; a part of the recording before that would do: to_s with "
                "--assume FILE"
            )
        out.append(found)
        carried.setdefault(found.thing, []).append((found.first, found.last))


def _next_load(
    paths: Mapping[str, RigidTransform],
    holds: tuple[Hold, ...],
    touching: list[Touching],
    carried: Mapping[str, list[tuple[int, int]]],
    known: list[Load],
) -> Load | None:
    """A ride that is not known yet on what is carried."""
    have = {(ride.thing, ride.first) for ride in known}
    for bearer, spans in carried.items():
        for contact in touching:
            pair = {contact.body, contact.other}
            if bearer not in pair or len(pair) < 2 or not pair <= set(paths):
                continue
            (thing,) = pair - {bearer}
            for start, end in spans:
                ride = Load(thing, bearer, max(start, contact.first), min(end, contact.last))
                first, last = ride.first, ride.last
                held = any(h.thing == thing and h.first < last and first < h.last for h in holds)
                heights = [paths[name].translation[first, 2] for name in (thing, bearer)]
                new = not held and (thing, first) not in have and heights[0] >= heights[1]
                if new and _goes_along(ride, paths):
                    return ride
    return None


def _goes_along(ride: Load, paths: Mapping[str, RigidTransform]) -> bool:
    """Whether two objects are moved and rigidly together meanwhile."""
    if ride.last <= ride.first:
        return False
    part = slice(ride.first, ride.last + 1)
    thing, lead = paths[ride.thing][part], paths[ride.bearer][part]
    gone = np.linalg.norm(thing.translation - thing.translation[0], axis=1)
    relative = lead.inv() * thing
    off = np.linalg.norm(relative.translation - relative.translation[0], axis=1)
    turned = (relative.rotation * relative.rotation[0].inv()).magnitude()
    steady = off.max() < LOOSER[-1] * SETTLED_M and turned.max() < LOOSER[-1] * SETTLED_RAD
    return bool(steady and gone.max() >= MOVES_M)


def with_loads(
    paths: Mapping[str, RigidTransform], loads: tuple[Load, ...]
) -> dict[str, RigidTransform]:
    """The paths of all objects, what is carried going along with its bearer."""
    out = dict(paths)
    for ride in loads:
        own, bearer = out[ride.thing], out[ride.bearer]
        seat = bearer[ride.first].inv() * own[ride.first]
        there = bearer[ride.first : ride.last + 1] * seat
        after = [there[-1]] * (len(own) - 1 - ride.last)
        parts = [*own[: ride.first], *there, *after] if ride.first else [*there, *after]
        out[ride.thing] = RigidTransform.concatenate(parts)
    return out


def steadiness(
    thing: Thing, seat: RigidTransform, bearer: RigidTransform, rate_hz: float
) -> Steadiness:
    """Whether an object would stay on its bearer.

    It weighs on it along the sum of gravity and of what its middle is accelerated; it slides where
    that leaves the cone of friction, and falls over where it leads past what it stands on.
    """
    mesh = trimesh.Trimesh(np.array(thing.shape.vertices), np.array(thing.shape.faces))
    middle = seat.apply(np.array(mesh.convex_hull.center_mass))
    corners = seat.apply(np.array(mesh.vertices))
    low = corners[:, 2].min()
    base = corners[corners[:, 2] < low + RESTS_M][:, :2]
    pulls = bearer.rotation.inv().apply(_pull(bearer, middle, rate_hz))
    tilts = np.arccos(np.clip(-pulls[:, 2] / np.linalg.norm(pulls, axis=1), -1.0, 1.0))
    down = np.minimum(pulls[:, 2], -1e-6)
    spots = middle[:2] - pulls[:, :2] * ((middle[2] - low) / down)[:, None]
    inside = _inside(base, spots)
    return Steadiness(
        float(tilts.max()), int(tilts.argmax()), float(inside.min()), int(inside.argmin())
    )


def _pull(
    bearer: RigidTransform, middle: Float[np.ndarray, "3"], rate_hz: float
) -> Float[np.ndarray, "frames 3"]:
    """Gravity less the acceleration of a point of the bearer [m/s^2]."""
    spots = bearer.apply(middle)
    half = max(round(HALF_S * rate_hz), 1)
    padded = np.pad(spots, ((half, half), (0, 0)), mode="edge")
    ahead, back = padded[2 * half :], padded[: -2 * half]
    speeding = (ahead - 2.0 * spots + back) / (half / rate_hz) ** 2
    return np.asarray(np.array([0.0, 0.0, -GRAVITY_MPS2]) - speeding)


def _inside(
    base: Float[np.ndarray, "points 2"], spots: Float[np.ndarray, "frames 2"]
) -> Float[np.ndarray, "frames"]:
    """How far spots are inside the convex hull of points, negative outside [m]."""
    try:
        sides = ConvexHull(base).equations
    except QhullError:  # it stands on an edge or a point
        return -np.linalg.norm(spots - base.mean(axis=0), axis=1)
    return np.asarray(-(spots @ sides[:, :2].T + sides[:, 2]).max(axis=1))


@dataclass(frozen=True)
class CoHeld:
    """An object that lies in a hand beside another one, by which the hand is led."""

    hold: Hold
    lead: Hold

    @property
    def ride(self) -> Load:
        """From when to when it goes along with the other one."""
        first, last = max(self.hold.first, self.lead.first), min(self.hold.last, self.lead.last)
        return Load(self.hold.thing, self.lead.thing, first, last)


def co_held_of(holds: tuple[Hold, ...], paths: Mapping[str, RigidTransform]) -> tuple[CoHeld, ...]:
    """What is taken and moved in one hand together with another object.

    The hand is led by the object that it takes first; of several by the one that it holds longest,
    then by name.

    Raises:
        PlanError: One of two objects that a hand moves together is moved without the other, too.
    """
    out: list[CoHeld] = []
    for hold in sorted(holds, key=lambda one: (one.first, one.first - one.last, one.thing)):
        known = {companion.hold for companion in out}
        for lead in holds:
            before = (lead.first, lead.first - lead.last, lead.thing)
            same = lead.side == hold.side and lead.thing != hold.thing and lead not in known
            if same and before < (hold.first, hold.first - hold.last, hold.thing):
                found = CoHeld(hold, lead)
                if _goes_along(found.ride, paths):
                    _check_together(found, paths)
                    out.append(found)
                    break
    return tuple(out)


def _check_together(found: CoHeld, paths: Mapping[str, RigidTransform]) -> None:
    ride = found.ride
    for hold in (found.hold, found.lead):
        path = paths[hold.thing].translation
        for first, last in ((hold.first, ride.first), (ride.last, hold.last)):
            gone = np.linalg.norm(path[first : last + 1] - path[first], axis=1).max(initial=0.0)
            if gone >= MOVES_M:
                raise PlanError(
                    f"the {hold.side} hand moves {hold.thing!r} by {1e3 * gone:.0f} mm without the "
                    f"other of {found.hold.thing!r} and {found.lead.thing!r}, and both together; "
                    "a part in which both are moved would do: from_s and to_s with --assume FILE"
                )


def led_holds(holds: tuple[Hold, ...], co_held: tuple[CoHeld, ...]) -> tuple[Hold, ...]:
    """The holds by which hands are led."""
    beside = {companion.hold for companion in co_held}
    return tuple(hold for hold in holds if hold not in beside)


def hand_spans(
    holds: list[Hold], co_held: tuple[CoHeld, ...]
) -> Iterator[tuple[Hold, frozenset[str]]]:
    """From when to when a hand has objects, and which ones."""
    for lead in led_holds(tuple(holds), co_held):
        own = [lead, *(companion.hold for companion in co_held if companion.lead == lead)]
        first, last = min(hold.first for hold in own), max(hold.last for hold in own)
        things = frozenset(hold.thing for hold in own)
        yield Hold(lead.side, lead.thing, first, last), things
