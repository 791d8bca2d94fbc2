"""When hands and objects are together: holds, meetings with the head, throws and loads."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import trimesh
from jaxtyping import Bool, Float
from scipy.spatial import ConvexHull, QhullError
from scipy.spatial.transform import RigidTransform

from capar.body.virtual_scenes import Thing
from capar.model.capture import Capture, TagType
from capar.model.facts import Displaced, Leans, Lies, Touching
from capar.model.geometry import runs
from capar.model.observation import ForceStyle, Observation
from capar.regeneration.scenes import PlanError
from extractors.forces.free_motion import GRAVITY_MPS2

SETTLED_M, SETTLED_RAD = 0.0025, float(np.radians(2.0))
"""While a relative pose is so near its median, two bodies are rigidly together [m, rad]."""

LOOSER = (1.0, 2.0)  # Multiples of both that are tried: noisy sensors keep less still [1].
SETTLED_SHARE = 0.8  # Noise may take so small a share of the frames in between out of that [1].

GRASP_M, GRASP_RAD = 0.025, float(np.radians(20.0))
"""How far a living hand may wander on what it carries: skin, fingers and wrist yield [m, rad]."""

SLID = 2.0
"""Multiple of both by which a hand may slide before the object leaves and after it arrived [1]."""

UNSEEN_S = 1.0
"""A hand that touches an object at the first frame may slide so long before it holds it [s]."""

STEP_S, TOUCHES_S = 0.15, 0.2
"""A hand that touches an object at rest for the first of these before that moves, or after, is seen
to touch it; it is held for the second then, so that this is seen again [s]."""

STEADY_SHARE = 0.5  # Two that meet are rigidly together for this share of their contact [1].
INSTANTS = 5  # At so many instants it is tried to reach an object that moves at the head [1].
CARRIED_M = 0.02  # An object that is so far from both ends of a contact is being carried [m].


@dataclass(frozen=True)
class Hold:
    """A hand and an object that are rigidly together."""

    side: str
    thing: str
    first: int
    last: int


@dataclass(frozen=True)
class Meeting:
    """A held object that meets the performer's head."""

    thing: str
    part: str
    first: int
    last: int
    steady: bool = True
    """Whether they are rigidly together; else it moves at the head as long as it is there."""

    @property
    def instants(self) -> list[int]:
        """Frames at which it is known where it meets the head, from when it comes."""
        number = 2 if self.steady else INSTANTS
        return sorted({*np.linspace(self.first, self.last, number).round().astype(int).tolist()})


Hands = Mapping[str, tuple[str, RigidTransform]]
"""By side: the sensor's name, and ``T_world_hand`` at every frame."""


def in_order(holds: Iterable[Hold]) -> tuple[Hold, ...]:
    """Holds in order of time."""
    return tuple(sorted(holds, key=lambda hold: (hold.first, hold.side)))


def holds_of(
    hands: Hands, paths: Mapping[str, RigidTransform], touching: list[Touching]
) -> tuple[Hold, ...]:
    """The part of each contact in which hand and object are together, in order of time.

    Rigidly where that is so; else, where the hand carries the object, within what a living hand's
    grasp yields.
    """
    out = []
    for side, (sensor, hand) in hands.items():
        for contact in touching:
            if contact.body == sensor and contact.other in paths:
                part = slice(contact.first, contact.last + 1)
                span = _together(paths[contact.other][part], hand[part])
                if span:
                    first, last = (contact.first + edge for edge in span)
                    out.append(Hold(side, contact.other, first, last))
    return in_order(out)


def with_touches(
    holds: tuple[Hold, ...],
    hands: Hands,
    touching: list[Touching],
    displaced: list[Displaced],
    times: Float[np.ndarray, "frames"],
) -> tuple[Hold, ...]:
    """Holds with as much of the touches before and after them as has to be seen again.

    A living hand slides on an object at rest until it has its grip, and only the grip is a hold.
    A touch at the first or the last frame, which nobody saw come or leave, is held from or to
    there, unless the hand slides for longer than ``UNSEEN_S``. Where the object moves later than
    the hand touches it, or stops earlier, it is held for ``TOUCHES_S`` at rest.
    """
    out = []
    for hold in holds:
        own = [c for c in touching if (c.body, c.other) == (hands[hold.side][0], hold.thing)]
        first, last = hold.first, hold.last
        for contact in own:
            if contact.first == 0 and times[hold.first] - times[0] <= UNSEEN_S:
                first = 0
            if contact.last == len(times) - 1 and times[-1] - times[hold.last] <= UNSEEN_S:
                last = contact.last
        seen = replace(hold, first=first, last=last)
        for contact in own:
            moved = [m for m in displaced if m.object == hold.thing and _within(m, contact)]
            if not moved or not _within(seen, contact):
                continue
            start, end = min(m.first for m in moved), max(m.last for m in moved)
            if times[start] - times[contact.first] >= STEP_S:
                early = int(np.searchsorted(times, times[start] - TOUCHES_S + 1e-6)) - 1
                first = min(first, max(contact.first, early))
            if times[contact.last] - times[end] >= STEP_S:
                late = int(np.searchsorted(times, times[end] + TOUCHES_S - 1e-6))
                last = max(last, min(contact.last, late))
        out.append(replace(hold, first=first, last=last))
    return in_order(out)


def _within(span: Hold | Displaced, contact: Touching) -> bool:
    return contact.first <= span.first and span.last <= contact.last


def meetings_of(
    capture: Capture,
    eyes: RigidTransform,
    paths: Mapping[str, RigidTransform],
    touching: list[Touching],
) -> tuple[Meeting, ...]:
    """When objects meet the head, in order of time."""
    own = {thing.name for thing in capture.objects if thing.tag is TagType.SELF}
    out = []
    for contact in touching:
        for thing, part in ((contact.body, contact.other), (contact.other, contact.body)):
            if thing in paths and part in own:
                span = slice(contact.first, contact.last + 1)
                found = settled(eyes[span].inv() * paths[thing][span])
                whole = contact.last - contact.first
                if found and found[1] - found[0] >= STEADY_SHARE * whole:
                    met = contact.first + found[0], contact.first + found[1]
                    out.append(Meeting(thing, part, *met))
                else:
                    out.append(Meeting(thing, part, contact.first, contact.last, steady=False))
    return tuple(sorted(out, key=lambda meeting: meeting.first))


def settled(relative: RigidTransform) -> tuple[int, int] | None:
    """First and last of the frames in which a relative pose is near its median, if most are."""
    off, turned = apart(relative, usual_pose(relative))
    for factor in LOOSER:
        steady = (off < factor * SETTLED_M) & (turned < factor * SETTLED_RAD)
        frames = np.flatnonzero(steady)
        if len(frames) > 1 and steady[frames[0] : frames[-1] + 1].mean() >= SETTLED_SHARE:
            return int(frames[0]), int(frames[-1])
    return None


def _together(thing: RigidTransform, hand: RigidTransform) -> tuple[int, int] | None:
    """When a hand and an object that touch are together: rigidly, or while it is carried.

    A grasp that is not rigid is compared with its median while the object is carried, and has to
    stay near that all the way. Before and after, it lasts until the hand has slid much further.
    """
    rigid = settled(thing.inv() * hand)
    carried = np.flatnonzero(_away(thing.translation))
    if rigid and (not len(carried) or (rigid[0] <= carried[0] and carried[-1] <= rigid[1])):
        return rigid
    if len(carried) < 2:
        return rigid
    first, last = int(carried[0]), int(carried[-1])
    relative = thing.inv() * hand
    off, turned = apart(relative, usual_pose(relative[first : last + 1]))
    if not ((off < GRASP_M) & (turned < GRASP_RAD))[first : last + 1].all():
        return rigid
    near = (off < SLID * GRASP_M) & (turned < SLID * GRASP_RAD)
    return next((int(b), int(e)) for b, e in runs(near) if b <= first and last <= e)


def _away(spots: Float[np.ndarray, "frames 3"]) -> Bool[np.ndarray, "frames"]:
    """Where an object is far from where it is first and from where it is last."""
    gone, left = (np.linalg.norm(spots - end, axis=1) for end in (spots[0], spots[-1]))
    return np.asarray((gone > CARRIED_M) & (left > CARRIED_M))


def usual_pose(poses: RigidTransform) -> RigidTransform:
    """The median of places, and the mean turn of those that are not farther from it than most."""
    middle = np.median(poses.translation, axis=0)
    off = np.linalg.norm(poses.translation - middle, axis=1)
    return RigidTransform.from_components(middle, poses.rotation[off <= np.median(off)].mean())


def apart(
    poses: RigidTransform, usual: RigidTransform
) -> tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]]:
    """How far poses are from a usual one [m, rad]."""
    off = np.linalg.norm(poses.translation - usual.translation, axis=1)
    return off, np.asarray((poses.rotation * usual.rotation.inv()).magnitude())


NEAR_S = 0.25  # A hold may end so long before an object is seen to move on alone [s].

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
    """The releases after which an object is left alone, and the flights to a hand, in order.

    Args:
        forces: As they were observed.
        sides: Of the hands, by sensor.
        holds: As they were recorded.
        times: The clock [s].
        paths: ``T_world_thing`` by name at every frame.

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
        if not later:
            out.append(Release(side, force.object, frame, force))
            continue
        throw = Throw(side, force.object, frame, later[0].first, later[0].side)
        if force.struck or not _flies(throw, times, paths[force.object].translation):
            raise PlanError(
                f"{force.object!r} is taken again at {times[later[0].first]:.2f} s after it moved "
                "on alone otherwise than in free flight from a hand that let it go, where another "
                "body's may not come; end the recording before, with to_s in a file given with "
                "--assume"
            )
        throws.append(throw)
    return tuple(out), tuple(throws)


def _flies(
    throw: Throw, times: Float[np.ndarray, "frames"], spots: Float[np.ndarray, "frames 3"]
) -> bool:
    """Whether an object is near the parabola of gravity; not known of two frames."""
    part = slice(throw.first, throw.last + 1)
    spots, past = spots[part], times[part] - times[throw.first]
    parabola = spots[0] + np.outer(past / past[-1], spots[-1] - spots[0])
    parabola[:, 2] += 0.5 * GRAVITY_MPS2 * past * (past[-1] - past)
    return len(past) > 2 and bool(np.linalg.norm(spots - parabola, axis=1).max() < FLIES_M)


def with_blows(holds: tuple[Hold, ...], releases: tuple[Release, ...]) -> tuple[Hold, ...]:
    """The holds, and a momentary one for each blow: hand and object meet in that frame alone."""
    blows = [Hold(one.side, one.thing, *[one.frame] * 2) for one in releases if one.force.struck]
    struck = {(blow.side, blow.thing, blow.first) for blow in blows}
    kept = [
        hold
        for hold in holds
        if not any(
            (hold.side, hold.thing, frame) in struck
            for frame in range(hold.first - 1, hold.last + 2)
        )
    ]
    return in_order([*kept, *blows])


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
        if fact.other not in things or things[fact.other].tag is not TagType.MOBILE:
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
        if held:
            first = max(fact.first, min(hold.first for hold in held))
            last = min(fact.last, max(hold.last for hold in held))
            acting = {sensors[hold.side] for hold in held}
            ends = {part.last for part in observation.segments if part.ee in acting}
            frames = tuple(sorted(frame for frame in ends if first <= frame <= last))
            lowest = (tilts[0].first + tilts[0].last) // 2
            if frames:
                out.append(Leaning(fact.body, fact.other, lowest, frames))
    return tuple(sorted(out, key=lambda leaning: leaning.frames))


MOVES_M = 0.02  # What goes no further than this is not carried along [m].

RESTS_M = 0.006
"""Points of a carried object that are no higher than this above its lowest are those it stands on
[m]."""

FRICTION = 0.3
"""Coefficient of friction between what bears and what is carried: ceramics on wood or plastic have
0.3 to 0.5 [1]."""

HALF_S = 0.1  # Over so long before and after a frame its acceleration is measured [s].


@dataclass(frozen=True)
class Load:
    """An object that stands on another one while hands move that."""

    thing: str
    bearer: str
    first: int
    last: int


@dataclass(frozen=True)
class Steadiness:
    """Whether a carried object would slide or fall, at the worst frame."""

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
    carried = [(hold.thing, hold.first, hold.last) for hold in holds]
    while found := next(_new_loads(paths, holds, touching, carried, out), None):
        if any(hold.thing == found.thing and hold.last > found.first for hold in holds):
            raise PlanError(
                f"a hand takes {found.thing!r} after or while {found.bearer!r} bears it, which is "
                "not regenerated; a part of the recording before that would do: to_s with "
                "--assume FILE"
            )
        out.append(found)
        carried.append((found.thing, found.first, found.last))
    return tuple(out)


def _new_loads(
    paths: Mapping[str, RigidTransform],
    holds: tuple[Hold, ...],
    touching: list[Touching],
    carried: list[tuple[str, int, int]],
    known: list[Load],
) -> Iterator[Load]:
    """Loads that are not known yet on what is carried."""
    have = {(load.thing, load.first) for load in known}
    for bearer in dict.fromkeys(name for name, _, _ in carried):
        for contact in touching:
            pair = {contact.body, contact.other}
            if bearer not in pair or len(pair) < 2 or not pair <= set(paths):
                continue
            (thing,) = pair - {bearer}
            for start, end in ((start, end) for name, start, end in carried if name == bearer):
                first, last = max(start, contact.first), min(end, contact.last)
                held = any(h.thing == thing and h.first < last and first < h.last for h in holds)
                heights = [paths[name].translation[first, 2] for name in (thing, bearer)]
                load = Load(thing, bearer, first, last)
                new = not held and (thing, first) not in have and heights[0] >= heights[1]
                if new and _goes_along(load, paths):
                    yield load


def _goes_along(load: Load, paths: Mapping[str, RigidTransform]) -> bool:
    """Whether two objects are moved and rigidly together meanwhile."""
    if load.last <= load.first:
        return False
    part = slice(load.first, load.last + 1)
    thing, lead = paths[load.thing][part], paths[load.bearer][part]
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
    for load in loads:
        own, bearer = out[load.thing], out[load.bearer]
        there = bearer[load.first : load.last + 1] * (bearer[load.first].inv() * own[load.first])
        after = [there[-1]] * (len(own) - 1 - load.last)
        out[load.thing] = RigidTransform.concatenate([*list(own)[: load.first], *there, *after])
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
    spots, half = bearer.apply(middle), max(round(HALF_S * rate_hz), 1)
    padded = np.pad(spots, ((half, half), (0, 0)), mode="edge")
    speeding = (padded[2 * half :] + padded[: -2 * half] - 2.0 * spots) / (half / rate_hz) ** 2
    pulls = bearer.rotation.inv().apply(np.array([0.0, 0.0, -GRAVITY_MPS2]) - speeding)
    tilts = np.arccos(np.clip(-pulls[:, 2] / np.linalg.norm(pulls, axis=1), -1.0, 1.0))
    down = np.minimum(pulls[:, 2], -1e-6)
    marks = middle[:2] - pulls[:, :2] * ((middle[2] - low) / down)[:, None]
    base = corners[corners[:, 2] < low + RESTS_M][:, :2]
    try:
        sides = ConvexHull(base).equations
        inside = -(marks @ sides[:, :2].T + sides[:, 2]).max(axis=1)
    except QhullError:  # it stands on an edge or a point
        inside = -np.linalg.norm(marks - base.mean(axis=0), axis=1)
    return Steadiness(
        float(tilts.max()), int(tilts.argmax()), float(inside.min()), int(inside.argmin())
    )


@dataclass(frozen=True)
class CoHeld:
    """An object that lies in a hand beside another one, by which the hand is led."""

    hold: Hold
    lead: Hold

    @property
    def load(self) -> Load:
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
    ordered = sorted(holds, key=lambda one: (one.first, one.first - one.last, one.thing))
    for number, hold in enumerate(ordered):
        beside = {found.hold for found in out}
        leads = {one for one in ordered[:number] if one.side == hold.side} - beside
        for lead in (one for one in holds if one in leads and one.thing != hold.thing):
            found = CoHeld(hold, lead)
            if _goes_along(found.load, paths):
                _check_together(found, paths)
                out.append(found)
                break
    return tuple(out)


def _check_together(found: CoHeld, paths: Mapping[str, RigidTransform]) -> None:
    for hold in (found.hold, found.lead):
        path = paths[hold.thing].translation
        for first, last in ((hold.first, found.load.first), (found.load.last, hold.last)):
            gone = np.linalg.norm(path[first : last + 1] - path[first], axis=1).max(initial=0.0)
            if gone >= MOVES_M:
                raise PlanError(
                    f"the {hold.side} hand moves {hold.thing!r} by {1e3 * gone:.0f} mm without the "
                    f"other of {found.hold.thing!r} and {found.lead.thing!r}, and both together; "
                    "a part in which both are moved would do: from_s and to_s with --assume FILE"
                )


def led_holds(holds: Iterable[Hold], co_held: tuple[CoHeld, ...]) -> tuple[Hold, ...]:
    """The holds by which hands are led."""
    beside = {companion.hold for companion in co_held}
    return tuple(hold for hold in holds if hold not in beside)


def hand_spans(
    holds: list[Hold], co_held: tuple[CoHeld, ...]
) -> Iterator[tuple[Hold, frozenset[str]]]:
    """From when to when a hand has objects, and which ones."""
    for lead in led_holds(holds, co_held):
        own = [lead, *(companion.hold for companion in co_held if companion.lead == lead)]
        first, last = min(hold.first for hold in own), max(hold.last for hold in own)
        yield replace(lead, first=first, last=last), frozenset(hold.thing for hold in own)
