"""A person who stands, steps, walks, bends and sinks, and what people do with objects."""

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from capar.model.capture import TagType
from scenes.hands import shapes
from scenes.hands.paths import Body, Poses, Times, Vector, about, facing, min_jerk, pose
from scenes.hands.performer import Hand
from scenes.hands.stage import Watcher
from scenes.hands.things import Thing
from scenes.people.stage import SOLE_M, Chest, Limb, PeopleStage, Rider, foot_form, smooth

TALL_M = 1.74
"""Stature of somebody of size 1 [m]."""

STANCE_M = 0.1
"""Distance of a foot's middle from the body's, standing [m]."""

SWAY_M = 0.02
"""How far the body goes aside over the foot that bears it, walking [m]."""

BOB_M = 0.012
"""How far it rises and sinks at each step [m]."""

SHIFT_S = 0.3
"""How long before the first step the body shifts [s]."""

START_S = 0.6
"""How long the body needs until it walks evenly [s]."""

SWING = (0.1, 0.9)
"""Shares of a step's time at which the foot leaves the floor and lands."""


@dataclass(frozen=True)
class Beat:
    """The steps of a walk."""

    start: float
    """When the first one begins [s]."""

    pace: float
    """Time of a step [s]."""

    count: int
    lead: float
    """1 if the right foot is first, -1 if the left one is."""

    def swing(self, times: Times) -> Times:
        """How far the body is over the left foot, and the right hand back, from -1 to 1."""
        share = (times - self.start) / self.pace
        fade = min_jerk(share / 0.8) * min_jerk((self.count - share) / 0.8)
        return np.asarray(self.lead * fade * np.sin(np.pi * share))


@dataclass
class Person:
    """Somebody of a size: a pelvis, an upper body, and limbs that act."""

    stage: PeopleStage
    name: str
    size: float
    trunk: Body
    chest: Chest
    head: Thing
    hands: dict[str, Limb] = field(default_factory=dict)
    feet: dict[str, Limb] = field(default_factory=dict)
    local: dict[str, np.ndarray] = field(default_factory=dict)
    """Where hands are at home on the upper body."""

    clock: float = 0.0
    """Until when the body's motion is written [s]."""

    @property
    def right(self) -> Limb:
        """The right hand."""
        return self.hands["right"]

    @property
    def left(self) -> Limb:
        """The left hand."""
        return self.hands["left"]

    @property
    def right_foot(self) -> Limb:
        """The right foot."""
        return self.feet["right"]

    @property
    def left_foot(self) -> Limb:
        """The left foot."""
        return self.feet["left"]

    @property
    def heading(self) -> np.ndarray:
        """Where the body faces at its clock, as a matrix of ahead, left and up."""
        return np.asarray(self.trunk.at(self.clock)[:3, :3])

    def stand(self, duration: float) -> None:
        """Stay where one is."""
        self.clock += duration

    def until(self, *limbs: Limb) -> None:
        """Stay until limbs have done what they do."""
        self.clock = max(self.clock, *(each.clock for each in limbs))

    def go_home_at(self, time: float) -> None:
        """Let homes of hands be where the body is at a time [s]."""
        for side, hand in self.hands.items():
            hand.home = self.chest.at(time) @ self.local[side]

    def along(
        self,
        hand: Limb,
        start: float,
        end: float,
        swing_rad: float = 0.0,
        beat: "Beat | None" = None,
    ) -> None:
        """Let a hand go along with the upper body, and swing about the shoulder with a walk."""
        hand.until(start)
        own = np.linalg.inv(self.chest.at(start)) @ hand.body.at(start)
        shoulder = (0.0, own[1, 3], 0.82 * TALL_M * self.size)

        def law(since: Times) -> Poses:
            angle = swing_rad * beat.swing(since + start) if beat else np.zeros(len(since))
            return self.chest.poses(since + start) @ about(shoulder, (0.0, 1.0, 0.0), angle) @ own

        hand.body.play(start, end, law)
        hand.clock = end

    def walk(
        self,
        way: float,
        *,
        speed: float = 1.0,
        first: str = "right",
        swing_rad: float = 0.22,
        straight: bool = False,
        busy: tuple[Limb, ...] = (),
        write: bool = True,
    ) -> None:
        """Walk so far ahead [m], or back if below zero; hands that are not busy go along.

        Args:
            way: Distance [m].
            speed: While walking evenly [m/s].
            first: The foot that steps first.
            swing_rad: How far empty hands swing.
            straight: Whether the body neither sways nor bobs.
            busy: Hands that are moved otherwise.
            write: Whether hands' steps end where the walk ends.
        """
        length = (0.36 + 0.24 * speed) * self.size
        count = max(round(abs(way) / length) + 1, 3)
        length = way / (count - 1)
        pace = abs(length) / speed
        start, base = self.clock, self.trunk.at(self.clock)
        begin, end = start + SHIFT_S, start + SHIFT_S + count * pace
        beat = Beat(begin, pace, count, 1.0 if first == "right" else -1.0)
        self._advance(start, end, beat, way, 0.0 if straight else 1.0)
        for number in range(1, count + 1):
            side = first if number % 2 else _other(first)
            goal = pose(((min(number, count - 1)) * length, 0.0, 0.0))
            lift, land = (begin + (number - 1 + share) * pace for share in SWING)
            self.stride(side, base @ goal, lift, land, "Walk")
        self.clock = end
        for hand in (each for each in self.hands.values() if each not in busy):
            self._taken_along(hand, start, end, beat, swing_rad, write=write)
        self.go_home_at(end)

    def _taken_along(
        self, hand: Limb, start: float, end: float, beat: "Beat", swing_rad: float, *, write: bool
    ) -> None:
        held = hand.touched
        if hand.clock < start:
            hand.wait(start, *([held] if held else []))
        sign = 1.0 if hand.side == "right" else -1.0
        self.along(hand, start, end, 0.0 if held else sign * swing_rad, beat)
        if write and held:
            hand.step("Carry", held)
        elif write:
            hand.step("PostureChange")

    def _advance(self, start: float, end: float, beat: "Beat", way: float, sway: float) -> None:
        base = self.trunk.at(start)

        def law(since: Times) -> Poses:
            times = since + start
            out = np.tile(base, (len(since), 1, 1))
            ahead = way * smooth(since / (end - start), min(START_S / (end - start), 0.4))
            over = sway * SWAY_M * self.size * beat.swing(times)
            share = (times - beat.start) / beat.pace
            fade = min_jerk(share) * min_jerk(beat.count - share)
            bob = -sway * BOB_M * fade * (1.0 - np.cos(2.0 * np.pi * share)) / 2.0
            out[:, :3, 3] += np.stack([ahead, over, bob], axis=1) @ base[:3, :3].T
            return out

        self.trunk.play(start, end, law)

    def sidle(self, way: float, count: int, *, pace: float) -> None:
        """Walk sideways, to the left or, below zero, to the right; hands are moved otherwise.

        Args:
            way: Distance [m].
            count: How many steps each foot does; the other one follows at once.
            pace: Time of a step [s].
        """
        start, base = self.clock, self.trunk.at(self.clock)
        lead = "left" if way > 0 else "right"
        span = SHIFT_S + 2 * count * pace
        self.trunk.shift(start, start + span, lambda since: np.outer(
            way * smooth(since / span, START_S / span), base[:3, 1]))  # fmt: skip
        for number in range(2 * count):
            goal = pose((0.0, way * (number // 2 + 1) / count, 0.0))
            lift, land = (start + SHIFT_S + (number + share) * pace for share in SWING)
            self.stride(lead if number % 2 == 0 else _other(lead), base @ goal, lift, land, "Walk")
        self.clock = start + span

    def roll_heel(self, side: str, angle_deg: float, start: float, end: float) -> None:
        """Raise a heel, the toes keeping the ground."""
        foot = self.feet[side]
        toes = foot.body.at(start) @ pose((0.17 * self.size, 0.0, -SOLE_M * self.size))
        angle = np.radians(angle_deg)
        foot.body.turn(
            start,
            end,
            toes[:3, 3],
            toes[:3, 1],
            lambda since: angle * min_jerk(since / (end - start)),
        )

    def stride(
        self,
        side: str,
        ground: np.ndarray,
        lift: float,
        land: float,
        name: str = "Step",
        *,
        high: float = 0.07,
        onto: Thing | None = None,
        stance: str = "Stand",
    ) -> None:
        """Move a foot to its place under a body that stands on a pose of the ground."""
        foot = self.feet[side]
        goal = ground @ foot_place(side, self.size)
        self.put_foot(foot, goal, lift, land, name, high=high, onto=onto, stance=stance)

    def put_foot(
        self,
        foot: Limb,
        goal: np.ndarray,
        lift: float,
        land: float,
        name: str = "Step",
        *,
        high: float = 0.07,
        onto: Thing | None = None,
        stance: str = "Stand",
    ) -> None:
        """Take a foot off what it stands on, and set it down at a pose."""
        foot.clock = lift
        old = foot.let_go()
        foot.step(stance, old)
        first, duration = foot.now, land - lift
        turn = Rotation.from_matrix(first[:3, :3].T @ goal[:3, :3]).as_rotvec()
        way = goal[:3, 3] - first[:3, 3]

        def law(since: Times) -> Poses:
            share = since / duration
            late = 0.2 if way[2] > 0 else 0.0
            early = 0.2 if way[2] < 0 else 0.0
            done = smooth((share - late) / (1.0 - late - early))
            bump = 16.0 * share**2 * (1.0 - share) ** 2
            climb = min_jerk(share / 0.6) if way[2] > 0 else min_jerk((share - 0.4) / 0.6)
            out = np.tile(np.eye(4), (len(since), 1, 1))
            out[:, :2, 3] = first[:2, 3] + np.outer(done, way[:2])
            out[:, 2, 3] = first[2, 3] + way[2] * climb + high * bump
            turned = Rotation.from_matrix(first[:3, :3]) * Rotation.from_rotvec(
                np.outer(min_jerk(share), turn)
            )
            pitch = 0.2 * bump * np.sin(2.0 * np.pi * share)
            nod = Rotation.from_rotvec(np.outer(pitch, (0.0, 1.0, 0.0)))
            out[:, :3, :3] = (turned * nod).as_matrix()
            return out

        foot.body.play(lift, land, law)
        foot.clock = land
        ground = onto or old
        foot.meet(ground)
        foot.step(name, ground, *([old] if old is not ground else []))

    def shift(self, by: Vector, duration: float, turn_deg: float = 0.0) -> None:
        """Move the body from rest to rest by a displacement in its own axes [m]; feet stay."""
        start, base = self.clock, self.trunk.at(self.clock)

        def law(since: Times) -> Poses:
            done = min_jerk(since / duration)
            out = np.tile(base, (len(since), 1, 1))
            out[:, :3, 3] += np.outer(done, base[:3, :3] @ np.asarray(by, dtype=float))
            turns = Rotation.from_euler("z", turn_deg * done[:, None], degrees=True)
            out[:, :3, :3] = base[:3, :3] @ turns.as_matrix()
            return out

        self.trunk.play(start, start + duration, law)
        self.clock += duration
        self.go_home_at(self.clock)

    def bend(self, angle_deg: float, duration: float, start: float | None = None) -> None:
        """Bend the upper body forward by an angle; it does not move the body's clock on."""
        begin = self.clock if start is None else start
        self.chest.bends.append((begin, begin + duration, float(np.radians(angle_deg))))
        self.go_home_at(begin + duration)

    def hands_along(self, start: float, name: str = "PostureChange") -> None:
        """Let all hands go along with what the body did since a time [s]."""
        for hand in self.hands.values():
            held = hand.touched
            hand.wait(start, *([held] if held else []))
            self.along(hand, start, self.clock)
            hand.step(name, *([held] if held else []))

    def finish(self, end: float) -> None:
        """Let hands that wait for the others do so to the end [s]."""
        for hand in self.hands.values():
            held = hand.touched
            hand.wait(end, *([held] if held else []))


def _other(side: str) -> str:
    return "left" if side == "right" else "right"


def foot_place(side: str, size: float) -> np.ndarray:
    """A foot's pose on the ground under a body that stands."""
    sign = -1.0 if side == "right" else 1.0
    return pose((0.02 * size, sign * STANCE_M * size, SOLE_M * size))


def person(
    stage: PeopleStage,
    name: str = "",
    *,
    at: Vector = (0.0, 0.0),
    facing_deg: float = 0.0,
    size: float = 1.0,
    hands: tuple[str, ...] = ("right", "left"),
    feet: tuple[str, ...] = ("right", "left"),
    form: shapes.Form | None = None,
    hang: bool = False,
    ground: Thing | None = None,
) -> Person:
    """Somebody who stands at a place; hands before the body at elbow height, or hanging down.

    Args:
        stage: Where.
        name: Of the person; limbs are called after it if there are several.
        at: Place on the floor [m].
        facing_deg: Which way the body faces.
        size: Relative to an adult of middle stature.
        hands: The hands that are tracked.
        feet: The feet that are tracked.
        form: Of the hands, where they are not flat.
        hang: Whether hands hang at the sides.
        ground: What the feet stand on, if not the floor.
    """
    prefix = f"{name}_" if name else ""
    agent = name or "agent"
    stage.people[agent] = round(TALL_M * size, 3)
    ground = ground or stage.floor
    level = ground.site("+z", 1.0, 0.0)[0][2]
    turn = Rotation.from_euler("z", facing_deg, degrees=True)
    trunk = Body(f"{prefix}trunk", pose((*at, level), turn))
    chest = Chest(f"{prefix}chest", trunk.first, trunk=trunk, hip_m=0.52 * TALL_M * size)
    ball = shapes.ball(0.1 * size, "head")
    place = pose((0.02 * size, 0.0, 0.93 * TALL_M * size))
    head = Thing(Rider(f"{prefix}head", place, carrier=chest), ball, TagType.SELF)
    back = Rider(f"{prefix}l5", pose((-0.1 * size, 0.0, 0.57 * TALL_M * size)), carrier=trunk)
    stage.things.append(head)
    stage.watchers.append(Watcher(head.body, "head", agent, ball))
    stage.watchers.append(Watcher(back, "l5", agent))
    made = Person(stage, agent, size, trunk, chest, head)
    for side in hands:
        made.local[side] = _at_home(side, size, hang=hang)
        shape = (form or shapes.flat_hand(side)).scaled(size)
        home = trunk.first @ made.local[side]
        body = Body(f"{prefix}{side}_hand", home)
        made.hands[side] = Limb(body, side, shape, home, member="hand", agent=agent)
    for side in feet:
        spot = trunk.first @ foot_place(side, size)
        body = Body(f"{prefix}{side}_foot", spot)
        made.feet[side] = Limb(body, side, foot_form(size), spot, member="foot", agent=agent)
        made.feet[side].meet(ground)
    stage.hands.extend([*made.hands.values(), *made.feet.values()])
    return made


def _at_home(side: str, size: float, *, hang: bool) -> np.ndarray:
    sign = -1.0 if side == "right" else 1.0
    inward = (0.0, -sign, 0.0)
    if hang:
        return pose((0.02, sign * 0.3 * size, 0.76 * size), facing(inward, (0.0, 0.0, -1.0)))
    return pose((0.18 * size, sign * 0.27 * size, 1.0 * size), facing(inward, (1.0, 0.0, 0.0)))


def mug(s: PeopleStage, at: Vector, name: str = "mug") -> Thing:
    """A mug of usual size."""
    return s.put(name, shapes.vessel(0.042, 0.1), at)


def take_up(
    hand: Hand, thing: Thing, side: str, *, lift: float, after: float = 0.6, reach_s: float = 0.9,
    up: float = 0.6,
) -> None:  # fmt: skip
    """Reach, hold, lift and hold in the air."""
    hand.reach(thing, side, reach_s, up=up)
    hand.hold(0.4, thing)
    hand.take(thing)
    hand.move((0.0, 0.0, lift), 0.9)
    hand.step("Lift", thing)
    if after:
        hand.hold(after, thing)


def set_down(hand: Hand, thing: Thing, goal: Thing, down: float, *, hold: float = 0.5) -> None:
    """Lower onto a goal, hold, and go home."""
    hand.move((0.0, 0.0, -down), 0.9)
    hand.step("Lower", thing, goal)
    hand.hold(hold, thing, goal)
    hand.leave(0.9)


def hold_between(p: Person, thing: Thing, *, up: float = 0.5) -> None:
    """Hold a thing between both palms from the first frame on."""
    p.right.begin_at(thing, "-y", up=up, fingers=(1.0, 0.0, 0.0))
    p.left.begin_at(thing, "+y", up=up, fingers=(1.0, 0.0, 0.0))
    p.right.take(thing)
    p.left.join(thing)


def together(p: Person, thing: Thing, goal: Thing, *, down: float, hold: float) -> None:
    """Lower what both hands hold onto a goal, hold it there, and take both hands away."""
    right, left = p.right, p.left
    left.until(right.clock)
    since = len(right.steps)
    left.release()
    left.join(thing)
    right.move((0.0, 0.0, -down), 1.0)
    right.step("Lower", thing, goal)
    right.hold(hold, thing, goal)
    left.part(right, since)
    for hand in (right, left):
        hand.leave(0.9)
        hand.idle(0.2)
