"""Quality: the gates that a motion has to pass, each with what was measured and its limit."""

import itertools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import ROOT_SIZE, Human
from capar.body.recording import HAND_SEGMENTS
from capar.model.par import Condition
from capar.regeneration.collisions import NEAR_M, Pair, Surroundings, inner_gap
from capar.regeneration.forces import ForceKind, end_velocity, flight_faults
from capar.regeneration.goals import scene_constraints
from capar.regeneration.holds import FRICTION, SETTLED_M, Hold, Load
from capar.regeneration.motion import Motion
from capar.regeneration.paths import borne_steadily
from capar.regeneration.planning import Plan
from capar.regeneration.solving import vectors
from capar.regeneration.styles import Kind, way

LEAVING_S = 0.3
"""So long before and after a hold a hand may be near what it holds and what stands beside [s]."""

MOVING_M = 0.05
"""A shorter path has no profile of speed [m]."""


@dataclass(frozen=True)
class Gate:
    """One object that is demanded of a motion."""

    name: str
    value: float
    limit: float
    unit: str
    at_least: bool = False
    """Whether the value has to reach the limit; else it has to stay within."""

    frame: int = -1
    """Where it was worst; -1 where no frame stands out."""

    bodies: str = ""
    """What it was worst of."""

    @property
    def passed(self) -> bool:
        """Whether the value is as demanded; a value that is no number is not."""
        return self.value >= self.limit if self.at_least else self.value <= self.limit


@dataclass(frozen=True)
class Measure:
    """Something that is told of a motion and not demanded."""

    name: str
    value: float
    unit: str
    frame: int = -1
    bodies: str = ""


@dataclass(frozen=True)
class Quality:
    """Every gate of one motion."""

    gates: tuple[Gate, ...]
    told: tuple[Measure, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether every gate is."""
        return all(gate.passed for gate in self.gates)

    @property
    def failed(self) -> tuple[str, ...]:
        """Names of the gates that are not."""
        return tuple(gate.name for gate in self.gates if not gate.passed)

    def gate(self, name: str) -> Gate:
        """The gate of that name."""
        return next(gate for gate in self.gates if gate.name == name)


def failures(quality: Quality) -> str:
    """The gates that fail, in words."""
    rows = (gate for gate in quality.gates if not gate.passed)
    return ", ".join(f"{gate.name} {gate.value:.1f} {gate.unit} ({gate.bodies})" for gate in rows)


def quality(motion: Motion) -> Quality:
    """Verify a motion at every frame."""
    hands = performed_hands(motion)
    errors = _errors(motion, hands)
    contacts, thumb = _contact_gates(motion)
    gates = (
        *_constraint_gates(motion, errors),
        *_guide_gates(motion, hands),
        *_throw_gates(motion, hands),
        *contacts,
        *_body_gates(motion),
        _still_gate(motion),
        _profile_gate(motion, hands),
        *_borne_gates(motion.plan),
        *_together_gates(motion, hands),
    )
    return Quality(gates, (thumb,))


def performed_hands(motion: Motion) -> dict[str, RigidTransform]:
    """``T_world_hand`` of the body as it moved."""
    plan = motion.plan
    names = [f"{side}_palm" for side in plan.hands]
    sites = plan.human.sites(motion.postures, names)
    out = {}
    for side in plan.hands:
        spots, turns = sites[f"{side}_palm"]
        turn = Rotation.from_quat(turns, scalar_first=True)
        out[side] = RigidTransform.from_components(spots, turn) * plan.frames.palms[side].inv()
    return out


@dataclass(frozen=True, eq=False)
class _Error:
    """How far a hand is from its place on what it holds."""

    hold: Hold
    metres: Float[np.ndarray, "frames"]
    radians: Float[np.ndarray, "frames"]


def _errors(motion: Motion, hands: dict[str, RigidTransform]) -> list[_Error]:
    out = []
    for grip in motion.plan.grips:
        hold = grip.hold
        part = slice(hold.first, hold.last + 1)
        off = grip.pose.inv() * motion.plan.things[hold.thing][part].inv() * hands[hold.side][part]
        out.append(_Error(hold, np.linalg.norm(off.translation, axis=1), off.rotation.magnitude()))
    return out


def _constraint_gates(motion: Motion, errors: list[_Error]) -> Iterator[Gate]:
    plan = motion.plan
    frames = {f for e in errors for f in (e.hold.first, e.hold.last)}
    frames |= {goal.frame for goals in plan.goals.values() for goal in goals}
    at, way_m, turned = (0.0, -1, ""), (0.0, -1, ""), (0.0, -1, "")
    for error in errors:
        names = f"{error.hold.side} hand, {error.hold.thing}"
        for row in range(len(error.metres)):
            frame = error.hold.first + row
            way_m = max(way_m, (error.metres[row], frame, names))
            if frame in frames:
                at = max(at, (error.metres[row], frame, names))
                turned = max(turned, (error.radians[row], frame, names))
    head = _head_error(motion)
    at = max(at, head)
    yield Gate("event position", 1e3 * at[0], 1.0, "mm", False, at[1], at[2])
    yield Gate("event rotation", float(np.degrees(turned[0])), 1.0, "deg", False, *turned[1:])
    yield Gate("on the way", 1e3 * way_m[0], 2.0, "mm", False, way_m[1], way_m[2])


def _guide_gates(motion: Motion, hands: dict[str, RigidTransform]) -> Iterator[Gate]:
    """How far objects, and hands on them, are off the hinge, rail or plane that they keep to."""
    plan = motion.plan
    found = scene_constraints(plan.source, plan.scene)
    worst = (0.0, -1, "")
    for name, constraint in found.items():
        start, path = plan.scene.thing(name).pose, plan.things[name]
        middle = plan.scene.thing(name).shape.bounds.mean(axis=0)
        tracks = [(f"{name}, {constraint.kind}", 0, middle, path.apply(middle))]
        for grip in plan.grips:
            if grip.hold.thing == name:
                part = slice(grip.hold.first, grip.hold.last + 1)
                spots = hands[grip.hold.side][part].translation
                named = f"{grip.hold.side} hand, {constraint.kind}"
                tracks.append((named, grip.hold.first, grip.pose.translation, spots))
        for bodies, first, at, spots in tracks:
            off = constraint.strays(start, at, spots)
            worst = max(worst, (float(off.max()), first + int(off.argmax()), bodies))
    if found:
        yield Gate("constraint way", 1e3 * worst[0], 2.0, "mm", False, *worst[1:])


def _throw_gates(motion: Motion, hands: dict[str, RigidTransform]) -> Iterator[Gate]:
    """Objects fly by gravity alone, with the velocities of the hands that throw and catch them."""
    plan, times = motion.plan, motion.plan.source.times
    off, gain, jump = (0.0, -1, ""), (0.0, -1, ""), (0.0, -1, "")
    for toss in plan.source.throws:
        name, part = toss.thing, slice(toss.first, toss.last + 1)
        middle = plan.scene.thing(name).shape.bounds.mean(axis=0)
        spots = plan.things[name].apply(middle)
        faults = flight_faults(times[part], spots[part])
        off = max(off, (faults.off_m[0], toss.first + faults.off_m[1], name))
        gain = max(gain, (faults.gain[0], toss.first + faults.gain[1], name))
        for grip in plan.grips:
            hold = grip.hold
            held = hands[hold.side] * grip.pose.inv()
            for frame, sign in ((toss.first, 1), (toss.last, -1)):
                if hold.thing == name and (hold.last, hold.first)[sign < 0] == frame:
                    within, free = _around(times, frame, sign), _around(times, frame, -sign)
                    hand_mps = end_velocity(sign * times[within], held[within].apply(middle))
                    thing_mps = end_velocity(-sign * times[free], spots[free])
                    apart = float(np.linalg.norm(hand_mps + thing_mps))
                    jump = max(jump, (apart, frame, f"{hold.side} hand, {name}"))
    if plan.source.throws:
        yield Gate("flight by gravity", 1e3 * off[0], 1.0, "mm", False, *off[1:])
        yield Gate("flight energy", gain[0], 0.01, "J/kg", False, *gain[1:])
        yield Gate("flight speed", jump[0], 0.3, "m/s", False, *jump[1:])


def _around(times: Float[np.ndarray, "frames"], frame: int, sign: int) -> list[int]:
    """Three frames that come to one, from before it, or from after it backwards."""
    return [f for f in (frame - 2 * sign, frame - sign, frame) if 0 <= f < len(times)]


def _head_error(motion: Motion) -> tuple[float, int, str]:
    """How far the head is from where an object meets it, at worst [m]."""
    plan, worst = motion.plan, (0.0, -1, "")
    spots, _ = plan.human.sites(motion.postures, ["between_eyes"])["between_eyes"]
    for meeting in plan.source.meetings:
        frame = (meeting.first + meeting.last) // 2
        for at in (meeting.first, frame, meeting.last):
            off = float(np.linalg.norm(spots[at] - plan.head.translation[frame]))
            worst = max(worst, (off, at, f"{meeting.thing}, {meeting.part}"))
    return worst


def _contact_gates(motion: Motion) -> tuple[list[Gate], Measure]:
    """Penetration of anything, and how far free hands keep from what they do not touch.

    A thumb is not posed, and its mannequin's base stands out from the palm: what it cuts of the
    object that its hand takes is told apart.
    """
    plan = motion.plan
    around = Surroundings(plan.human, plan.scene)
    far = (Pair(np.inf, "", ""), -1)
    deepest, nearest, thumb = far, far, far
    inner = _inner_gaps(plan)
    for ride, gap_m in inner.values():
        deepest = min(deepest, (Pair(gap_m, ride.thing, ride.bearer), ride.first))
    things = {name: vectors(path) for name, path in plan.things.items()}
    for frame in range(len(motion.postures)):
        around.place(motion.postures[frame], {n: rows[frame] for n, rows in things.items()})
        for pair in around.near():
            side = pair.part.partition("_")[0]
            if pair.part.endswith("_thumb") and _takes(motion, side, pair.thing, frame):
                thumb = min(thumb, (pair, frame))
                continue
            deepest = min(deepest, (pair, frame))
            if side in plan.hands and is_hand(pair.part) and _is_free(motion, pair, frame):
                nearest = min(nearest, (pair, frame))
        for pair in around.things_near():
            if frozenset((pair.part, pair.thing)) not in inner:
                deepest = min(deepest, (pair, frame))
    gates = [
        _distance_gate("penetration", -1.0, *deepest),
        _distance_gate("free hand clear", 10.0, *nearest),
    ]
    pair, frame = thumb
    bodies = f"{pair.part}, {pair.thing}"
    return gates, Measure("thumb and what it holds", 1e3 * pair.distance_m, "mm", frame, bodies)


def _inner_gaps(plan: Plan) -> dict[frozenset[str], tuple[Load, float]]:
    """What is carried in a hollow object, and how far it is from its surface all the way [m]."""
    out = {}
    for ride in plan.source.loads:
        bearer, thing = plan.scene.thing(ride.bearer), plan.scene.thing(ride.thing)
        seat = plan.things[ride.bearer][ride.first].inv() * plan.things[ride.thing][ride.first]
        gap_m = inner_gap(bearer.shape, thing.shape, seat)
        if gap_m is not None:
            out[frozenset((ride.thing, ride.bearer))] = ride, gap_m
    return out


def _distance_gate(name: str, limit_mm: float, pair: Pair, frame: int) -> Gate:
    bodies = f"{pair.part}, {pair.thing}" if pair.part else ""
    return Gate(name, 1e3 * pair.distance_m, limit_mm, "mm", True, frame, bodies)


def is_hand(part: str) -> bool:
    """Whether a part of the body is of a hand, the thumb left out."""
    return part.endswith(("_hand", "_fingers", "_fingertips"))


def _is_free(motion: Motion, pair: Pair, frame: int) -> bool:
    """Whether a hand holds nothing, nor just did nor is about to, least of all that object."""
    side = pair.part.partition("_")[0]
    holds = _holds(motion, side)
    if _takes(motion, side, pair.thing, frame):
        return False
    return not any(_near_hold(motion, hold, frame, LEAVING_S) for hold in holds)


def _takes(motion: Motion, side: str, thing: str, frame: int) -> bool:
    """Whether a hand holds that object, or is about to, or has just let it go."""
    own = (hold for hold in _holds(motion, side) if hold.thing == thing)
    return any(_near_hold(motion, hold, frame, LEAVING_S) for hold in own)


def _holds(motion: Motion, side: str) -> list[Hold]:
    return [hold for hold in motion.plan.source.holds if hold.side == side]


def _near_hold(motion: Motion, hold: Hold, frame: int, span_s: float) -> bool:
    span = span_s * motion.plan.source.rate_hz
    return hold.first - span <= frame <= hold.last + span


def _body_gates(motion: Motion) -> Iterator[Gate]:
    plan, postures = motion.plan, motion.postures
    feet = plan.human.sites(postures, ["right_foot", "left_foot"])
    slid = {n: np.linalg.norm(spots - spots[0], axis=1) for n, (spots, _) in feet.items()}
    foot = max(slid, key=lambda name: float(slid[name].max()))
    yield Gate(
        "feet", 1e3 * float(slid[foot].max()), 3.0, "mm", False, int(slid[foot].argmax()), foot
    )
    yield from joint_gates(plan.human, postures, plan.source.rate_hz)


def joint_gates(
    human: Human, postures: Float[np.ndarray, "frames posture"], rate_hz: float
) -> Iterator[Gate]:
    """Limits and speeds of hinges, and the speed of the pelvis."""
    low, high = human.ranges.T
    angles = postures[:, ROOT_SIZE:]
    out = np.maximum(np.maximum(low - angles, angles - high), 0.0)
    frame, hinge = np.unravel_index(int(out.argmax()), out.shape)
    yield Gate(
        "joint limits", float(np.degrees(out.max())), 0.01, "deg", False,
        int(frame), human.joints[int(hinge)],
    )  # fmt: skip
    speeds = np.abs(np.diff(angles, axis=0)) * rate_hz
    frame, hinge = np.unravel_index(int(speeds.argmax()), speeds.shape)
    yield Gate(
        "joint speed", float(speeds.max()), 15.0, "rad/s", False,
        int(frame), human.joints[int(hinge)],
    )  # fmt: skip
    hips = np.linalg.norm(np.diff(postures[:, :3], axis=0), axis=1) * rate_hz
    yield Gate("pelvis speed", float(hips.max()), 1.5, "m/s", False, int(hips.argmax()))


def _still_gate(motion: Motion) -> Gate:
    """What no hand holds stays where it is."""
    plan, worst = motion.plan, (0.0, -1, "")
    for name, path in plan.things.items():
        steps = np.linalg.norm(np.diff(path.translation, axis=0), axis=1)
        for span in plan.source.carried:
            if span.thing == name:
                steps[span.first : span.last] = 0.0
        for launch in plan.source.releases:
            if launch.thing == name:
                steps[launch.frame :] = 0.0
        worst = max(worst, (float(steps.max()), int(steps.argmax()), name))
    return Gate("things not held", 1e3 * worst[0], 0.5, "mm a frame", False, *worst[1:])


def _borne_gates(plan: Plan) -> Iterator[Gate]:
    """What is carried neither slides nor falls; none where nothing is."""
    found = [
        (borne_steadily(plan.source, plan.scene, plan.things, r), r) for r in plan.source.loads
    ]
    if not found:
        return
    tilted, one = max(found, key=lambda pair: pair[0].tilt_rad)
    narrow, other = min(found, key=lambda pair: pair[0].inside_m)
    slides = float(np.degrees(np.arctan(FRICTION)))
    yield Gate(
        "borne: not to slide", float(np.degrees(tilted.tilt_rad)), slides, "deg", False,
        one.first + tilted.tilt_frame, f"{one.thing} on {one.bearer}",
    )  # fmt: skip
    yield Gate(
        "borne: not to fall", 1e3 * narrow.inside_m, 0.0, "mm", True,
        other.first + narrow.inside_frame, f"{other.thing} on {other.bearer}",
    )  # fmt: skip


def _together_gates(motion: Motion, hands: dict[str, RigidTransform]) -> Iterator[Gate]:
    """What one hand holds together does not slide in it; none where there is nothing."""
    worst = (-1.0, -1, "")
    for companion in motion.plan.source.co_held:
        ride, hand = companion.ride, hands[companion.hold.side]
        part = slice(ride.first, ride.last + 1)
        for name in (ride.thing, ride.bearer):
            local = hand[part].inv() * motion.plan.things[name][part]
            off = np.linalg.norm(local.translation - local.translation[0], axis=1)
            found = (float(off.max()), ride.first + int(off.argmax()), name)
            worst = max(worst, found)
    if worst[1] >= 0:
        yield Gate("in one hand: not to slide", 1e3 * worst[0], 2.0, "mm", False, *worst[1:])


def _profile_gate(motion: Motion, hands: dict[str, RigidTransform]) -> Gate:
    """Correlation of the speeds of hands along their paths with those of the style, at worst."""
    plan, worst = motion.plan, (1.0, -1, "")
    for side, hand in hands.items():
        new, old = hand.translation, _model(plan, side).translation
        if min(way(new)[-1], way(old)[-1]) < MOVING_M + 2.0 * SETTLED_M:
            continue
        for first, last in _pieces(motion, side):
            held = _with_thing(plan, side, first, last)
            model = (old if held is None else held)[first : last + 1]
            one, two = np.diff(way(new[first : last + 1])), np.diff(way(model))
            if min(one.sum(), two.sum()) >= MOVING_M and len(one) > 3:
                value = float(np.corrcoef(one, two)[0, 1])
                worst = min(worst, (value, first, f"{side} hand"))
    return Gate("speed profile", worst[0], 0.98, "r", True, worst[1], worst[2])


def _model(plan: Plan, side: str) -> RigidTransform:
    """The path of a hand whose timing is to be kept: the planned one where none is recorded.

    Nor is there one where a hand strikes faster or slower so that the object moves as it did.
    """
    led = {launch.side for launch in plan.source.releases if plan.style.force is ForceKind.SAME}
    planned = plan.style.kind is Kind.EVEN or side in led
    return plan.hands[side] if planned else plan.style.hands[side]


def _with_thing(
    plan: Plan, side: str, first: int, last: int
) -> Float[np.ndarray, "frames 3"] | None:
    """The path of a hand that had been rigidly on what it holds throughout some frames.

    A living hand slides a little on what it carries, and performed it does not; its speed is
    compared with the object's.
    """
    for grip in plan.grips:
        hold = grip.hold
        if hold.side == side and hold.first <= first and last <= hold.last:
            carried = plan.style.kind is not Kind.EVEN and hold.thing in plan.style.things
            return (plan.style.things[hold.thing] * grip.pose).translation if carried else None
    return None


def _pieces(motion: Motion, side: str) -> list[tuple[int, int]]:
    """Intervals between events of a hand."""
    plan = motion.plan
    edges = {0, len(motion.postures) - 1}
    for hold in plan.source.holds:
        if hold.side == side:
            edges |= {hold.first, hold.last}
            inner = {g.frame for g in plan.goals.get(hold.thing, [])}
            edges |= {f for f in inner if hold.first <= f <= hold.last}
    ordered = sorted(edges)
    return list(itertools.pairwise(ordered))


TOUCHES_M = 0.005
"""Bodies that are no further apart touch, half of what a free hand keeps clear [m]."""

SIDES = ("right", "left")
"""Hands are called by their side."""

HEAD = "head"
"""The performer's own part that objects meet."""

Contact = tuple[str, str]
"""A hand, by its side, or an object; and what it touches."""


@dataclass(frozen=True)
class Asserted:
    """What a step asserts at its end."""

    action: str
    frame: int
    contacts: tuple[tuple[Contact, bool], ...]
    moved: str
    """The object that it moves; empty if none."""


def contact_distances(around: Surroundings, motion: Motion, frame: int) -> dict[Contact, float]:
    """How far hands, the head and objects near each other are apart, in both orders [m]."""
    poses = {name: path[frame] for name, path in motion.plan.things.items()}
    around.pose(motion.postures[frame], poses)
    found: dict[Contact, float] = {}
    for pair in [*around.near(), *around.things_near()]:
        side, _, part = pair.part.partition("_")
        first = side if part in HAND_SEGMENTS else pair.part
        for contact in ((first, pair.thing), (pair.thing, first)):
            found[contact] = min(found.get(contact, NEAR_M), pair.distance_m)
    return found


def contact_gate(motion: Motion, steps: Iterable[Asserted]) -> Gate:
    """That the contacts that steps assert are those that geometry has, at the end of each step.

    A table of contacts begins with what is measured at the first frame. A step that moves an
    object leaves open which other objects that one touches, unless it asserts it. An event lies
    between two frames, so that contacts may be as they are a frame before or after.
    """
    scene, last = motion.plan.scene, len(motion.postures) - 1
    around = Surroundings(motion.plan.human, scene)
    known: dict[int, dict[Contact, float]] = {}

    def apart_m(contact: Contact, frame: int) -> float:
        if frame not in known:
            known[frame] = contact_distances(around, motion, frame)
        return known[frame].get(contact, NEAR_M)

    pairs = [(side, name) for side in SIDES for name in scene.things]
    pairs += [(name, beneath) for name in scene.things if (beneath := scene.support(name))]
    begins = {0, min(1, last)}
    table = {p: True for p in pairs if min(apart_m(p, at) for at in begins) <= TOUCHES_M}
    wrong: list[tuple[int, str]] = []
    for frame, ending in groupby(sorted(steps, key=_frame), key=_frame):
        for step in (ended := list(ending)):
            table = {
                pair: holds
                for pair, holds in table.items()
                if step.moved not in pair or pair[0] in SIDES
            }
            table.update(step.contacts)
        near = sorted({max(frame - 1, 0), frame, min(frame + 1, last)})
        for pair, holds in table.items():
            if all((apart_m(pair, at) <= TOUCHES_M) != holds for at in near):
                actions = " and ".join(dict.fromkeys(step.action for step in ended))
                verb = "touch" if holds else "do not touch"
                far = f"{1e3 * apart_m(pair, frame):.0f} mm apart by geometry"
                who = " and ".join(pair)
                wrong.append((frame, f"after {actions} {who} {verb} by the table, and are {far}"))
    frame, said = wrong[0] if wrong else (-1, "")
    return Gate("contacts asserted", float(len(wrong)), 0.0, "wrong", False, frame, said)


def _frame(step: Asserted) -> int:
    return step.frame


def contacts_of(
    conditions: Iterable[Condition], names: Mapping[str, str]
) -> tuple[tuple[Contact, bool], ...]:
    """The contacts among conditions, bodies by the names that they have here."""
    found = []
    for condition in conditions:
        if condition.kind == "contact" and set(condition.arguments) <= set(names):
            first, second = (names[argument] for argument in condition.arguments)
            found.append(((first, second), condition.holds))
    return tuple(found)
