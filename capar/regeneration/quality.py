"""Quality: the gates that a motion has to pass, each with what was measured and its limit."""

import itertools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import ROOT_SIZE, Human
from capar.body.recording import HAND_SEGMENTS
from capar.model.par import Condition
from capar.regeneration.collisions import NEAR_M, Pair, Surroundings
from capar.regeneration.forces import ForceKind, end_velocity, flight_faults
from capar.regeneration.goals import scene_constraints
from capar.regeneration.holds import FRICTION, SETTLED_M
from capar.regeneration.motion import Motion
from capar.regeneration.paths import SUNK_M, borne_steadily
from capar.regeneration.planning import Plan
from capar.regeneration.solving import vectors
from capar.regeneration.styles import Kind, way

LEAVING_S = 0.3
"""So long before and after a hold a hand may be near what it holds and what stands beside [s]."""

TOLD_M = 0.0005  # Objects that are deeper inside each other at first are reported [m].
OFF_M = 0.01  # Larger distances of fingers from objects are not measured [m].
MOVING_M = 0.05  # A shorter path has no profile of speed [m].


@dataclass(frozen=True)
class Gate:
    """A measured value that is demanded of a motion."""

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
    """A measured value that is reported of a motion and not demanded."""

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
        return not self.failed

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


Worst = tuple[float, int, str]
"""A value, the frame in which it is worst, and what it is of."""

NONE: Worst = (0.0, -1, "")


def worst_of(values: Float[np.ndarray, "frames"], bodies: str, first: int = 0) -> Worst:
    """The largest of some values, which begin at a frame."""
    row = int(values.argmax())
    return float(values[row]), first + row, bodies


def within(name: str, worst: Worst, limit: float, unit: str = "mm") -> Gate:
    """A gate that a value has to stay within; a value in metres is stated in millimetres."""
    value = 1e3 * worst[0] if unit.startswith("mm") else worst[0]
    return Gate(name, value, limit, unit, False, worst[1], worst[2])


def distance_gate(name: str, limit_mm: float, nearest: tuple[Pair, int]) -> Gate:
    """A gate that the distance of a pair has to reach."""
    pair, frame = nearest
    bodies = f"{pair.part}, {pair.thing}" if pair.part else ""
    return Gate(name, 1e3 * pair.distance_m, limit_mm, "mm", True, frame, bodies)


def quality(motion: Motion) -> Quality:
    """Verify a motion at every frame."""
    plan, hands = motion.plan, performed_hands(motion)
    contacts, told = _contact_gates(motion)
    inside, closing = _fingers(motion)
    feet = plan.human.sites(motion.postures, ["right_foot", "left_foot"])
    slid = (worst_of(_gone(spots), name) for name, (spots, _) in feet.items())
    gates = (
        *_event_gates(motion, hands),
        *_guide_gates(plan, hands),
        *_throw_gates(plan, hands),
        *contacts,
        *inside,
        within("feet", max(slid, key=lambda worst: worst[0]), 3.0),
        *joint_gates(plan.human, motion.postures, plan.source.rate_hz),
        _still_gate(plan),
        _profile_gate(plan, hands),
        *_borne_gates(plan),
        *_together_gates(plan, hands),
    )
    return Quality(gates, (*told, *closing))


def _gone(spots: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames"]:
    """Distances from the first of some places [m]."""
    return np.linalg.norm(spots - spots[0], axis=1)


def performed_hands(motion: Motion) -> dict[str, RigidTransform]:
    """``T_world_hand`` of the body as it moved."""
    plan = motion.plan
    sites = plan.human.sites(motion.postures, [f"{side}_palm" for side in plan.hands])
    out = {}
    for side in plan.hands:
        spots, turns = sites[f"{side}_palm"]
        turn = Rotation.from_quat(turns, scalar_first=True)
        out[side] = RigidTransform.from_components(spots, turn) * plan.frames.palms[side].inv()
    return out


def _event_gates(motion: Motion, hands: Mapping[str, RigidTransform]) -> Iterator[Gate]:
    """How far hands are from their places on what they hold, and the head from what meets it."""
    plan = motion.plan
    events = {goal.frame for goals in plan.goals.values() for goal in goals}
    events |= {frame for grip in plan.grips for frame in (grip.hold.first, grip.hold.last)}
    at, turned, along = [NONE], [NONE], [NONE]
    for grip in plan.grips:
        hold, names = grip.hold, f"{grip.hold.side} hand, {grip.hold.thing}"
        part = slice(hold.first, hold.last + 1)
        off = grip.pose.inv() * plan.things[hold.thing][part].inv() * hands[hold.side][part]
        metres, radians = np.linalg.norm(off.translation, axis=1), off.rotation.magnitude()
        along.append(worst_of(metres, names, hold.first))
        for frame in events.intersection(range(hold.first, hold.last + 1)):
            at.append((float(metres[frame - hold.first]), frame, names))
            turned.append((float(np.degrees(radians[frame - hold.first])), frame, names))
    eyes, _ = plan.human.sites(motion.postures, ["between_eyes"])["between_eyes"]
    for meeting in plan.source.meetings:
        middle = (meeting.first + meeting.last) // 2
        for frame in (*meeting.instants, middle):
            there = plan.head.translation[middle if meeting.steady else frame]
            off_m = float(np.linalg.norm(eyes[frame] - there))
            at.append((off_m, frame, f"{meeting.thing}, {meeting.part}"))
    yield within("event position", max(at), 1.0)
    yield within("event rotation", max(turned), 1.0, "deg")
    yield within("on the way", max(along), 2.0)


def _guide_gates(plan: Plan, hands: Mapping[str, RigidTransform]) -> Iterator[Gate]:
    """How far objects, and hands on them, are off the hinge, rail or plane that they keep to."""
    found = scene_constraints(plan.source, plan.scene)
    worst = [NONE]
    for name, line in found.items():
        thing, path = plan.scene.thing(name), plan.things[name]
        middle = thing.shape.bounds.mean(axis=0)
        strays = line.strays(thing.pose, middle, path.apply(middle))
        worst.append(worst_of(strays, f"{name}, {line.kind}"))
        for grip in plan.grips:
            hold = grip.hold
            if hold.thing == name:
                spots = hands[hold.side][hold.first : hold.last + 1].translation
                strays = line.strays(thing.pose, grip.pose.translation, spots)
                worst.append(worst_of(strays, f"{hold.side} hand, {line.kind}", hold.first))
    if found:
        yield within("constraint way", max(worst), 2.0)


def _throw_gates(plan: Plan, hands: Mapping[str, RigidTransform]) -> Iterator[Gate]:
    """Objects fly by gravity alone, with the velocities of the hands that throw and catch them."""
    times, off, gain, jump = plan.source.times, [NONE], [NONE], [NONE]
    for throw in plan.source.throws:
        name, part = throw.thing, slice(throw.first, throw.last + 1)
        middle = plan.scene.thing(name).shape.bounds.mean(axis=0)
        spots = plan.things[name].apply(middle)
        faults = flight_faults(times[part], spots[part])
        for worst, (value, row) in zip((off, gain), faults, strict=True):
            worst.append((value, throw.first + row, name))
        for grip, (frame, sign) in itertools.product(
            plan.grips, ((throw.first, 1), (throw.last, -1))
        ):
            hold = grip.hold
            if hold.thing == name and (hold.last if sign > 0 else hold.first) == frame:
                held, free = (
                    [f for f in (frame - 2 * by, frame - by, frame) if 0 <= f < len(times)]
                    for by in (sign, -sign)
                )
                in_hand = (hands[hold.side] * grip.pose.inv())[held].apply(middle)
                hand_mps = end_velocity(sign * times[held], in_hand)
                thing_mps = end_velocity(-sign * times[free], spots[free])
                apart = float(np.linalg.norm(hand_mps + thing_mps))
                jump.append((apart, frame, f"{hold.side} hand, {name}"))
    if plan.source.throws:
        yield within("flight by gravity", max(off), 1.0)
        yield within("flight energy", max(gain), 0.01, "J/kg")
        yield within("flight speed", max(jump), 0.3, "m/s")


def _contact_gates(motion: Motion) -> tuple[list[Gate], tuple[Measure, ...]]:
    """Penetration of anything, and how far free hands keep from what they do not touch.

    Here hands have fingers that bend as one: those that close, and the thumb, have a gate of their
    own. What objects cut of each other as they stand at first is reported apart and counted from
    there.
    """
    plan, deepest = motion.plan, list[tuple[Pair, int]]()
    around = Surroundings(plan.human, plan.scene)
    around.pose(motion.postures[0], {name: path[0] for name, path in plan.things.items()})
    sunk = [pair for pair in around.things_near() if -SUNK_M <= pair.distance_m < 0.0]
    first_m = {frozenset((pair.part, pair.thing)): pair.distance_m for pair in sunk}
    things = {name: vectors(path) for name, path in plan.things.items()}
    span = LEAVING_S * plan.source.rate_hz
    nearest = list[tuple[Pair, int]]()
    for frame, posture in enumerate(motion.postures):
        around.place(posture, {n: rows[frame] for n, rows in things.items()})
        taken = {
            (hold.side, hold.thing)
            for hold in plan.source.holds
            if hold.first - span <= frame <= hold.last + span
        }
        busy = {side for side, _ in taken}
        for pair in around.near():
            side = pair.part.partition("_")[0]
            if pair.part.endswith("_thumb") and (side, pair.thing) in taken:
                continue
            deepest.append((pair, frame))
            if is_hand(pair.part) and side in plan.hands and side not in busy:
                nearest.append((pair, frame))
        for pair in around.things_near():
            both = frozenset((pair.part, pair.thing))
            by_m = pair.distance_m - first_m.get(both, 0.0)
            deepest.append((replace(pair, distance_m=by_m), frame))
    far = (Pair(np.inf, "", ""), -1)
    gates = [
        distance_gate("penetration", -1.0, min(deepest, default=far)),
        distance_gate("free hand clear", 10.0, min(nearest, default=far)),
    ]
    told = list[Measure]()
    for pair in sunk:
        if pair.distance_m < -TOLD_M:
            names = f"{pair.part}, {pair.thing}"
            told.append(
                Measure("inside each other at first", 1e3 * pair.distance_m, "mm", 0, names)
            )
    return gates, tuple(told)


def _fingers(motion: Motion) -> tuple[list[Gate], list[Measure]]:
    """No bone of the five fingers is inside anything; how many close, and how far they are off.

    Fingers that do not reach what the hand holds stay open.
    """
    grasps, plan = [grasp for own in motion.grasps.values() for grasp in own], motion.plan
    grasps = [grasp for grasp in grasps if grasp.things]
    human, postures = motion.fingered
    around, inside, off = Surroundings(human, plan.scene), [NONE], [NONE]
    things = {name: vectors(path) for name, path in plan.things.items()}
    bones = [part for part in set(around.parts.values()) if part[-1].isdigit()]
    for frame, posture in enumerate(postures):
        around.place(posture, {n: rows[frame] for n, rows in things.items()})
        now = (grasp for grasp in grasps if grasp.first <= frame <= grasp.last)
        held = {finger: grasp.things for grasp in now for finger in grasp.reaching}
        gaps = dict.fromkeys(held, OFF_M)
        for pair in around.near(bones, OFF_M):
            inside.append((-pair.distance_m, frame, f"{pair.part}, {pair.thing}"))
            finger = pair.part[:-2]
            if pair.thing in held.get(finger, ()):
                gaps[finger] = min(gaps[finger], pair.distance_m)
        off += [(gap_m, frame, f"{one}, {' '.join(held[one])}") for one, gap_m in gaps.items()]
    reaching, short = (
        [name for grasp in grasps for name in getattr(grasp, which)]
        for which in ("reaching", "short")
    )
    unit, away = f"of {len(reaching + short)}", ", ".join(sorted(set(short)))
    off_m, frame, bodies = max(off)
    return [within("fingers inside", max(inside), 2.0)], [
        Measure("fingers that close", float(len(reaching)), unit, -1, away and f"not {away}"),
        Measure("fingers off", 1e3 * off_m, "mm", frame, bodies),
    ]


def is_hand(part: str) -> bool:
    """Whether a part of the body is of a hand, the thumb left out."""
    return part.endswith(("_hand", "_fingers", "_fingertips"))


def joint_gates(
    human: Human, postures: Float[np.ndarray, "frames posture"], rate_hz: float
) -> Iterator[Gate]:
    """Limits and speeds of hinges, and the speed of the pelvis."""
    low, high = human.ranges.T
    angles = postures[:, ROOT_SIZE:]
    out = np.maximum(np.maximum(low - angles, angles - high), 0.0)
    speeds = np.abs(np.diff(angles, axis=0)) * rate_hz
    for name, values, limit, unit in (
        ("joint limits", np.degrees(out), 0.01, "deg"), ("joint speed", speeds, 15.0, "rad/s"),
    ):  # fmt: skip
        frame, hinge = np.unravel_index(int(values.argmax()), values.shape)
        yield within(name, (float(values.max()), int(frame), human.joints[int(hinge)]), limit, unit)
    hips = np.linalg.norm(np.diff(postures[:, :3], axis=0), axis=1) * rate_hz
    yield within("pelvis speed", worst_of(hips, ""), 1.5, "m/s")


def _still_gate(plan: Plan) -> Gate:
    """What no hand holds stays where it is."""
    worst = [NONE]
    for name, path in plan.things.items():
        steps = np.linalg.norm(np.diff(path.translation, axis=0), axis=1)
        for span in plan.source.carried:
            if span.thing == name:
                steps[span.first : span.last] = 0.0
        for release in plan.source.releases:
            if release.thing == name:
                steps[release.frame :] = 0.0
        worst.append(worst_of(steps, name))
    return within("things not held", max(worst), 0.5, "mm a frame")


def _borne_gates(plan: Plan) -> Iterator[Gate]:
    """What is carried neither slides nor falls; none where nothing is."""
    loads = plan.source.loads
    if not loads:
        return
    found = [(borne_steadily(plan.source, plan.scene, plan.things, load), load) for load in loads]
    tilted, one = max(found, key=lambda pair: pair[0].tilt_rad)
    narrow, other = min(found, key=lambda pair: pair[0].inside_m)
    tilt = float(np.degrees(tilted.tilt_rad)), one.first + tilted.tilt_frame
    slides = float(np.degrees(np.arctan(FRICTION)))
    yield within("borne: not to slide", (*tilt, f"{one.thing} on {one.bearer}"), slides, "deg")
    pair = Pair(narrow.inside_m, "", ""), other.first + narrow.inside_frame
    fall = distance_gate("borne: not to fall", 0.0, pair)
    yield replace(fall, bodies=f"{other.thing} on {other.bearer}")


def _together_gates(plan: Plan, hands: Mapping[str, RigidTransform]) -> Iterator[Gate]:
    """What one hand holds together does not slide in it; none where there is nothing."""
    worst: list[Worst] = []
    for pair in plan.source.co_held:
        load, hand = pair.load, hands[pair.hold.side]
        part = slice(load.first, load.last + 1)
        for name in (load.thing, load.bearer):
            local = hand[part].inv() * plan.things[name][part]
            worst.append(worst_of(_gone(local.translation), name, load.first))
    if worst:
        yield within("in one hand: not to slide", max(worst), 2.0)


def _profile_gate(plan: Plan, hands: Mapping[str, RigidTransform]) -> Gate:
    """Correlation of the speeds of hands along their paths with those of the style, at worst.

    A living hand slides a little on what it carries, and performed it does not: there its speed is
    compared with the one of a hand that had been rigidly on the object. The planned path is the
    model where none is recorded, or where a hand strikes so that the object moves as it did.
    """
    even, worst = plan.style.kind is Kind.EVEN, (1.0, -1, "")
    striking = {one.side for one in plan.source.releases if plan.style.force is ForceKind.SAME}
    for side, hand in hands.items():
        model = plan.hands[side] if even or side in striking else plan.style.hands[side]
        new, old = hand.translation, model.translation
        if min(way(new)[-1], way(old)[-1]) < MOVING_M + 2.0 * SETTLED_M:
            continue
        grips = [grip for grip in plan.grips if grip.hold.side == side]
        edges = {0, len(new) - 1}
        for hold in (one for one in plan.source.holds if one.side == side):
            goals = {goal.frame for goal in plan.goals.get(hold.thing, [])}
            edges |= {hold.first, hold.last, *goals & set(range(hold.first, hold.last + 1))}
        for first, last in itertools.pairwise(sorted(edges)):
            kept = (g for g in grips if g.hold.first <= first and last <= g.hold.last)
            grip = next(kept, None)
            if grip and not even and grip.hold.thing in plan.style.things:
                rigid = (plan.style.things[grip.hold.thing] * grip.pose).translation
            else:
                rigid = old
            one, two = (np.diff(way(path[first : last + 1])) for path in (new, rigid))
            if min(one.sum(), two.sum()) >= MOVING_M and len(one) > 3:
                value = float(np.corrcoef(one, two)[0, 1])
                worst = min(worst, (value, first, f"{side} hand"))
    return Gate("speed profile", worst[0], 0.98, "r", True, worst[1], worst[2])


TOUCHES_M = 0.005
"""Bodies that are no further apart touch, half of what a free hand keeps clear [m]."""

SIDES = ("right", "left")  # Hands are called by their side.
HEAD = "head"  # The performer's own part that objects meet.

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
    by_frame = attrgetter("frame")
    for frame, ending in itertools.groupby(sorted(steps, key=by_frame), key=by_frame):
        ended = list(ending)
        for step in ended:
            table = {p: on for p, on in table.items() if step.moved not in p or p[0] in SIDES}
            table.update(step.contacts)
        near = sorted({max(frame - 1, 0), frame, min(frame + 1, last)})
        actions = " and ".join(dict.fromkeys(step.action for step in ended))
        for pair, holds in table.items():
            if all((apart_m(pair, at) <= TOUCHES_M) != holds for at in near):
                verb = "touch" if holds else "do not touch"
                far = f"{1e3 * apart_m(pair, frame):.0f} mm apart by geometry"
                said = f"after {actions} {' and '.join(pair)} {verb} by the table, and are {far}"
                wrong.append((frame, said))
    frame, said = wrong[0] if wrong else (-1, "")
    return Gate("contacts asserted", float(len(wrong)), 0.0, "wrong", False, frame, said)


def contacts_of(
    conditions: Iterable[Condition], names: Mapping[str, str]
) -> tuple[tuple[Contact, bool], ...]:
    """The contacts among conditions, bodies by the names that they have here."""
    return tuple(
        ((names[condition.arguments[0]], names[condition.arguments[1]]), condition.holds)
        for condition in conditions
        if condition.kind == "contact" and set(condition.arguments) <= set(names)
    )
