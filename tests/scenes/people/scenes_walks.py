"""Walking, stepping, kicking, sitting low, and doors."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import NEAR, UP, Poses, Times, about, pose, quintic
from scenes.hands.performer import PRESS, travel
from scenes.hands.scene import performer
from scenes.hands.things import Step, Thing
from scenes.household.builders import gate
from scenes.objects.builders import Grip, Hinge, cabinet, cupboard, seize
from scenes.people.body import (
    Person,
    foot_place,
    hold_between,
    mug,
    person,
    set_down,
    take_up,
    together,
)
from scenes.people.stage import SOLE_M, Limb, PeopleStage


def stroll(s: PeopleStage, p: Person, way: float, *, before: float, after: float, speed: float,
           first: str = "right") -> None:  # fmt: skip
    """Stand, walk with empty hands, and stand."""
    p.stand(before)
    p.walk(way, speed=speed, first=first)
    p.stand(after)
    p.finish(p.clock)


def walk_across_the_room(s: PeopleStage) -> None:
    """Somebody stands, walks two and a half metres at an easy pace, and stands."""
    performer(s, yaw_deg=40)
    p = person(s, hang=True, at=(-1.2, 0.0))
    stroll(s, p, 2.5, before=0.8, after=0.9, speed=1.0)


def walk_slowly(s: PeopleStage) -> None:
    """A small old person walks at half a metre a second, the left foot first."""
    performer(s, yaw_deg=-70)
    p = person(s, hang=True, size=0.88, at=(-0.5, 0.3))
    stroll(s, p, 1.4, before=1.0, after=1.0, speed=0.5, first="left")


def walk_briskly(s: PeopleStage) -> None:
    """A tall person walks three metres fast."""
    performer(s, yaw_deg=155)
    p = person(s, hang=True, size=1.08, at=(-1.5, -0.2))
    stroll(s, p, 3.1, before=0.7, after=0.8, speed=1.35)


def walk_to_a_table_and_take_a_mug(s: PeopleStage) -> None:
    """Somebody walks up to a table, stands for a moment, and takes the mug that is there."""
    performer(s, yaw_deg=15)
    p = person(s, at=(-1.6, 0.1))
    s.desk((0.65, 0.0, 0.76))
    mug = s.put("mug", shapes.vessel(0.042, 0.1), (0.55, -0.1, 0.76))
    p.stand(0.7)
    p.walk(1.65, speed=0.9)
    right = p.right
    right.rest(0.7)
    right.reach(mug, "-y", 0.9, up=0.6, hold=0.4)
    right.take(mug)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.9, mug, hold=0.8)
    p.until(right)
    p.finish(p.clock)


def reach_while_arriving(s: PeopleStage) -> None:
    """The left hand goes for a box without any halt where the walk ends."""
    performer(s, yaw_deg=-125)
    p = person(s, at=(-1.3, -0.2), size=1.05)
    s.desk((0.62, 0.0, 0.8))
    box = s.put("box", shapes.box(0.12, 0.12, 0.12), (0.5, 0.0, 0.8))
    p.stand(0.2)
    p.walk(1.3, speed=1.1, first="left", busy=(p.left,))
    p.along(p.left, 0.2, p.clock)
    p.left.reach(box, "+y", 0.8)
    p.left.hold(0.9, box)
    p.until(p.left)
    p.finish(p.clock)


def carry_a_mug_to_another_table(s: PeopleStage) -> None:
    """A mug is lifted off one table, carried two metres, and put down on another one."""
    performer(s, yaw_deg=80, offset=(0.4, -0.2))
    p = person(s, at=(-0.9, 0.0))
    s.desk((-0.6, -0.62, 0.74), (0.6, 0.6), "first_table")
    goal = s.desk((1.4, -0.62, 0.74), (0.6, 0.6), "second_table")
    cup = mug(s, (-0.55, -0.42, 0.74))
    p.right.idle(0.2)
    take_up(p.right, cup, "+y", lift=0.25, up=0.85)
    p.until(p.right)
    p.walk(2.0, speed=0.9)
    p.right.hold(0.5, cup)
    set_down(p.right, cup, goal, 0.25)
    p.right.idle(0.2)
    p.until(p.right)
    p.finish(p.clock)


def carry_a_box_to_a_table(s: PeopleStage) -> None:
    """A large box that both hands hold is carried to a table and put down on it."""
    performer(s, yaw_deg=-20)
    p = person(s, at=(-1.4, 0.0), size=1.06)
    table = s.desk((0.65, 0.0, 0.72))
    box = s.put("box", shapes.box(0.24, 0.3, 0.2), (-0.95, 0.0, 0.92))
    hold_between(p, box)
    p.stand(0.8)
    p.walk(1.45, speed=0.8)
    for hand in (p.right, p.left):
        hand.hold(0.6, box)
    together(p, box, table, down=0.2, hold=0.5)
    p.until(p.right)


def carry_a_tray_with_a_cup(s: PeopleStage) -> None:
    """A child carries a tray with a cup on it three steps ahead and keeps it."""
    performer(s, yaw_deg=200)
    p = person(s, at=(-0.6, 0.2), size=0.78)
    tray = s.put("tray", shapes.tray(0.24, 0.32), (-0.3, 0.2, 0.78))
    cup = s.put("cup", shapes.vessel(0.035, 0.08, "cup"), (-0.28, 0.22, 0.788))
    hold_between(p, tray)
    p.right.take_along(tray, cup)
    p.stand(0.9)
    p.walk(0.95, speed=0.6, first="left")
    p.stand(0.9)
    p.finish(p.clock)


def walk_backwards(s: PeopleStage) -> None:
    """Somebody walks a metre and a half backwards."""
    performer(s, yaw_deg=-160)
    p = person(s, hang=True, at=(0.8, 0.0), size=0.95)
    stroll(s, p, -1.5, before=0.8, after=0.8, speed=0.7, first="left")


def walk_there_and_back(s: PeopleStage) -> None:
    """Somebody walks ahead, stands for a second, and walks backwards to the first place."""
    performer(s, yaw_deg=115)
    p = person(s, hang=True, at=(-0.7, 0.4))
    p.stand(0.7)
    p.walk(1.3, speed=0.9)
    p.stand(1.2)
    p.walk(-1.3, speed=0.7, first="left")
    p.stand(0.8)
    p.finish(p.clock)


def take_a_ball_and_walk_off_with_it(s: PeopleStage) -> None:
    """A ball is lifted off a table with the left hand and carried backwards away from it."""
    performer(s, yaw_deg=60)
    p = person(s, at=(0.1, 0.0), size=0.92)
    s.desk((0.7, 0.0, 0.7))
    ball = s.put("ball", shapes.ball(0.06), (0.55, 0.12, 0.76))
    p.left.idle(0.2)
    take_up(p.left, ball, "+y", lift=0.2, up=0.5)
    p.until(p.left)
    p.walk(-1.1, speed=0.6)
    p.left.hold(0.7, ball)
    p.until(p.left)
    p.finish(p.clock)


def put_a_bottle_down_and_walk_off(s: PeopleStage) -> None:
    """A bottle is put down on a table; hand and body go away from it at once, backwards."""
    performer(s, yaw_deg=10)
    p = person(s, at=(0.1, 0.0))
    table = s.desk((0.65, 0.0, 0.78))
    bottle = s.put("bottle", shapes.bottle(), (0.5, -0.15, 0.98))
    p.right.begin_at(bottle, "-y", up=0.35, fingers=(1.0, 0.0, 0.0))
    p.right.take(bottle)
    p.right.hold(0.7, bottle)
    p.right.move((0.0, 0.0, -0.2), 0.9)
    p.right.step("Lower", bottle, table)
    p.right.hold(0.5, bottle, table)
    p.right.leave(0.8, name="ResumePosture")
    p.until(p.right)
    p.stand(0.8)
    p.walk(-1.2, speed=0.8)
    p.stand(0.7)
    p.finish(p.clock)


def quiet_end(p: Person, duration: float) -> None:
    """Stand for a while, as hands do too."""
    p.stand(duration)
    p.finish(p.clock)


def two_steps(
    p: Person, ground: np.ndarray, first: str, *, start: float, swing_s: float, gap_s: float = 0.15
) -> None:
    """Both feet step, one after the other, to where the body will stand."""
    other = "left" if first == "right" else "right"
    p.stride(first, ground, start, start + swing_s)
    p.stride(other, ground, start + swing_s + gap_s, start + 2.0 * swing_s + gap_s)


def body_goes(p: Person, by: tuple[float, float, float], swing_s: float, first: str,
              turn_deg: float = 0.0) -> None:  # fmt: skip
    """The body goes somewhere by two steps; hands go along."""
    start = p.clock
    p.shift(by, 2.0 * swing_s + 0.55, turn_deg)
    two_steps(p, p.trunk.at(p.clock), first, start=start + 0.2, swing_s=swing_s)
    p.hands_along(start)


def step_forward_and_close(s: PeopleStage) -> None:
    """The right foot steps forward, the left one is put beside it."""
    performer(s, yaw_deg=25)
    p = person(s, hang=True)
    p.stand(0.8)
    body_goes(p, (0.45, 0.0, 0.0), 0.55, "right")
    quiet_end(p, 0.8)


def step_aside(s: PeopleStage) -> None:
    """A small person steps to the left with the left foot, and the right one follows."""
    performer(s, yaw_deg=-95)
    p = person(s, hang=True, size=0.85)
    p.stand(0.7)
    body_goes(p, (0.0, 0.3, 0.0), 0.5, "left")
    quiet_end(p, 0.9)


def step_out_and_back(s: PeopleStage) -> None:
    """The left foot steps out ahead, stands there for a second, and steps back; hands are kept."""
    performer(s, yaw_deg=140)
    p = person(s, hang=True, size=1.04)
    home = p.trunk.at(0.0)
    p.stride("left", home @ pose((0.35, 0.0, 0.0)), 0.7, 1.25)
    p.stride("left", home, 2.3, 2.9)
    p.clock = 2.9
    quiet_end(p, 0.8)


def turn_aside_by_two_steps(s: PeopleStage) -> None:
    """Somebody turns to the left by sixty degrees on the spot, one step of each foot."""
    performer(s, yaw_deg=-35)
    p = person(s, hang=True)
    p.stand(0.8)
    body_goes(p, (0.0, 0.0, 0.0), 0.5, "left", 60.0)
    quiet_end(p, 0.8)


def turn_round_by_four_steps(s: PeopleStage) -> None:
    """Somebody turns on the spot to the right, by two steps of each foot."""
    performer(s, yaw_deg=70)
    p = person(s, hang=True, size=0.94)
    p.stand(0.7)
    start = p.clock
    for side in ("right", "right"):
        base = p.clock
        p.shift((0.0, 0.0, 0.0), 1.6, -50.0)
        two_steps(p, p.trunk.at(p.clock), side, start=base + 0.2, swing_s=0.5)
    for hand in p.hands.values():
        hand.wait(start)
        p.along(hand, start, p.clock)
        hand.step("PostureChange")
    quiet_end(p, 0.8)
    for foot in p.feet.values():
        foot.aliases["Step"] = "Walk"


def step_onto_a_platform(s: PeopleStage) -> None:
    """Both feet step up onto a low platform, one after the other."""
    performer(s, yaw_deg=-50)
    platform = s.put(
        "platform", shapes.box(0.6, 0.8, 0.15, "platform"), (0.6, 0.0, 0.0), tag="fixed"
    )
    p = person(s, hang=True)
    p.stand(0.8)
    start = p.clock
    p.shift((0.55, 0.0, 0.15), 2.0)
    up = p.trunk.at(p.clock)
    p.stride("right", up, start + 0.2, start + 0.9, onto=platform, high=0.1)
    p.stride("left", up, start + 1.1, start + 1.8, onto=platform, high=0.1)
    p.hands_along(start)
    quiet_end(p, 0.8)


def step_down_from_a_platform(s: PeopleStage) -> None:
    """Somebody who stands on a platform steps down to the floor, the left foot first."""
    performer(s, yaw_deg=165)
    platform = s.put(
        "platform", shapes.box(0.5, 0.8, 0.18, "platform"), (0.0, 0.0, 0.0), tag="fixed"
    )
    p = person(s, hang=True, size=1.05, ground=platform)
    p.stand(0.7)
    start = p.clock
    p.shift((0.5, 0.0, -0.18), 2.0)
    down = p.trunk.at(p.clock)
    p.stride("left", down, start + 0.2, start + 0.9, onto=s.floor, high=0.08)
    p.stride("right", down, start + 1.1, start + 1.8, onto=s.floor, high=0.08)
    p.hands_along(start)
    quiet_end(p, 0.9)


def step_over_a_beam(s: PeopleStage) -> None:
    """Both feet are lifted over a beam that lies on the floor; neither touches it."""
    performer(s, yaw_deg=5)
    s.put("beam", shapes.box(0.08, 1.0, 0.1, "beam"), (0.32, 0.0, 0.0), tag="fixed")
    p = person(s, hang=True)
    p.stand(0.8)
    start = p.clock
    p.shift((0.65, 0.0, 0.0), 2.3)
    over = p.trunk.at(p.clock)
    p.stride("right", over, start + 0.2, start + 1.0, high=0.26)
    p.stride("left", over, start + 1.2, start + 2.0, high=0.26)
    p.hands_along(start)
    quiet_end(p, 0.8)


def raise_foot(p: Person, foot: Limb, by: tuple[float, float, float], lift: float) -> None:
    """Take a foot off the floor and hold it in the air [s], as two steps begun."""
    foot.clock = lift
    ground = foot.let_go()
    foot.step("Stand", ground)
    start = foot.now
    way = p.heading @ np.array(by)
    base = start.copy()

    def law(since: Times) -> Poses:
        done = quintic(since / 0.8, 0.0, 0.0)
        out = np.tile(base, (len(since), 1, 1))
        out[:, :3, 3] += np.outer(done, way)
        return out

    foot.body.play(lift, lift + 0.8, law)
    foot.clock = lift + 0.8
    foot.step("Withdraw", ground)


def put_back(p: Person, foot: Limb) -> None:
    """Set a foot that is in the air down on the floor beside the other one."""
    start, goal = foot.now, p.trunk.at(foot.clock) @ foot_place(foot.side, p.size)
    way, begin = goal[:3, 3] - start[:3, 3], foot.clock

    def law(since: Times) -> Poses:
        out = np.tile(start, (len(since), 1, 1))
        out[:, :3, 3] += np.outer(quintic(since / 0.8, 0.0, 0.0), way)
        return out

    foot.body.play(begin, begin + 0.8, law)
    foot.clock += 0.8
    foot.meet(p.stage.floor)
    foot.step("Step", p.stage.floor)


def one_legged(p: Person, side: str, *, lift: float, held: float, by: tuple[float, float, float],
               end: float) -> None:  # fmt: skip
    """Stand on the other foot for a while."""
    foot, other = p.feet[side], p.feet["left" if side == "right" else "right"]
    raise_foot(p, foot, by, lift)
    foot.rest(held)
    put_back(p, foot)
    other.clock = lift
    other.step("Stand", p.stage.floor)
    other.clock = foot.clock
    other.step("StandOnOneLeg", p.stage.floor)
    p.clock = foot.clock
    quiet_end(p, end)


def stand_on_the_left_leg(s: PeopleStage) -> None:
    """The right foot is raised, held up for two seconds, and set down again."""
    performer(s, yaw_deg=-15)
    p = person(s, hang=True)
    p.stand(0.6)
    lean = p.clock
    p.shift((0.0, 0.09, 0.0), 0.8)
    for hand in p.hands.values():
        hand.wait(lean)
        p.along(hand, lean, p.clock)
        hand.step("PostureChange")
    one_legged(p, "right", lift=p.clock + 0.5, held=2.0, by=(-0.05, 0.0, 0.25), end=0.8)
    p.right_foot.aliases["Withdraw"] = "ResumePosture"


def stand_on_the_right_leg(s: PeopleStage) -> None:
    """A tall person holds the left foot up behind for a second; the hands do not move."""
    performer(s, yaw_deg=100)
    p = person(s, hang=True, size=1.08)
    p.trunk.first[:3, 3] += (0.0, -0.07, 0.0)
    for hand in p.hands.values():
        hand.body.first[:3, 3] += (0.0, -0.07, 0.0)
    one_legged(p, "left", lift=1.0, held=1.2, by=(-0.2, 0.0, 0.3), end=0.9)
    p.left_foot.aliases["Withdraw"] = "ResumePosture"


def rest_a_foot_on_a_stool(s: PeopleStage) -> None:
    """The left foot is put on a low stool and stays there; the body stays over the right one."""
    performer(s, yaw_deg=30)
    stool = s.put("stool", shapes.box(0.3, 0.3, 0.22, "stool"), (0.42, 0.15, 0.0), tag="fixed")
    p = person(s, hang=True)
    p.trunk.first[:3, 3] += (0.0, -0.08, 0.0)
    for hand in p.hands.values():
        hand.body.first[:3, 3] += (0.0, -0.08, 0.0)
    foot = p.left_foot
    goal = pose((0.4, 0.13, 0.22 + SOLE_M))
    p.put_foot(foot, goal, 0.9, 1.7, onto=stool, high=0.08)
    foot.clock += 2.0
    foot.step("RestFoot", stool)
    p.clock = foot.clock
    p.finish(p.clock)


def shift_the_weight(s: PeopleStage) -> None:
    """The body goes over the right foot, stays there, and comes back; both feet keep the floor."""
    performer(s, yaw_deg=-5)
    p = person(s, hang=True)
    p.stand(0.8)
    start = p.clock
    p.shift((0.0, -0.1, 0.0), 0.9)
    p.hands_along(start)
    p.stand(1.5)
    back = p.clock
    p.shift((0.0, 0.1, 0.0), 0.9)
    p.hands_along(back)
    left = p.left_foot
    left.clock = start + 0.9
    left.step("Stand", s.floor)
    left.clock = back
    left.step("RestFoot", s.floor)
    left.alternative = (Step("Stand", ("floor",), 0.0, p.clock + 0.8),)
    quiet_end(p, 0.8)


def kick(s: PeopleStage, p: Person, side: str, *, lift: float, speed: float) -> None:
    """A foot swings at a ball that lies before it, and is set down where it stood."""
    s.contact_minimum_s = 0.0
    foot, radius, duration, contact = p.feet[side], 0.11, 0.5, 0.02
    first = foot.body.first.copy()
    rise, way = 0.05, 0.38 * p.size
    toe, high = 0.17 * p.size, rise + 0.045 * p.size
    reach = float(np.sqrt(radius**2 - max(radius - high, 0.0) ** 2))
    spot = first[:3, 3] + p.heading @ np.array([way + toe + reach - 0.001, 0.0, 0.0])
    ball = s.put("ball", shapes.ball(radius), (spot[0], spot[1], radius))
    foot.clock = lift
    foot.let_go()
    foot.step("Stand", s.floor)

    def swing(since: Times) -> Poses:
        out = np.tile(first, (len(since), 1, 1))
        share = since / duration
        done = quintic(share, 0.0, speed * duration / way)
        out[:, :3, 3] += np.outer(way * done, p.heading[:, 0])
        out[:, 2, 3] += rise * quintic(np.clip(share / 0.7, 0.0, 1.0), 0.0, 0.0)
        return out

    foot.body.play(lift, lift + duration, swing)
    foot.clock = lift + duration
    foot.step("Kick", ball, s.floor)
    roll_off(p, ball, foot.clock, contact, speed, radius)
    foot.meet(ball)
    foot.join(ball)
    foot.held[-1].law = straight(foot, p, foot.clock, contact, speed)
    foot.clock += contact
    foot.let_go()
    come_back(p, foot, first, speed, 0.9)
    foot.step("Step", s.floor, ball)
    p.clock = foot.clock


def straight(
    foot: Limb, p: Person, start: float, contact: float, speed: float
) -> Callable[[Times], Poses]:
    """The foot's way while it pushes the ball."""
    base = foot.body.poses(np.array([start - 1e-9]))[0]

    def law(times: Times) -> Poses:
        since = np.clip(times - start, 0.0, contact)
        out = np.tile(base, (len(times), 1, 1))
        out[:, :3, 3] += np.outer(speed * since, p.heading[:, 0])
        return out

    return law


def roll_off(
    p: Person, ball: Thing, start: float, contact: float, speed: float, radius: float
) -> None:
    """The ball is pushed for a moment and rolls on, slower and slower."""
    base, brake = ball.body.at(start), 0.8
    ahead, aside = p.heading[:, 0], p.heading[:, 1]

    def law(since: Times) -> Poses:
        late = np.clip(since, 0.0, speed / brake)
        way = speed * late - brake * late**2 / 2.0
        out = about(base[:3, 3], aside, way / radius) @ base
        out[:, :3, 3] += np.outer(way, ahead)
        return np.asarray(out)

    ball.body.play(start, start + speed / brake, law)
    ball.free.append((start, start + speed / brake))


def come_back(p: Person, foot: Limb, first: np.ndarray, speed: float, duration: float) -> None:
    """The foot swings on a little and returns to where it stood."""
    start, begin = foot.now, foot.clock
    way = float((start - first)[:3, 3] @ p.heading[:, 0])

    def law(since: Times) -> Poses:
        share = since / duration
        out = np.tile(first, (len(since), 1, 1))
        slope = -speed * duration / way
        done = quintic(share, slope, 0.0)
        out[:, :3, 3] += np.outer(way * (1.0 - done), p.heading[:, 0])
        late = quintic(np.clip((share - 0.4) / 0.6, 0.0, 1.0), 0.0, 0.0)
        out[:, 2, 3] += (start - first)[2, 3] * (1.0 - late)
        return out

    foot.body.play(begin, begin + duration, law)
    foot.clock += duration
    foot.meet(p.stage.floor)


def stand_while_kicking(p: Person, side: str, lift: float) -> None:
    """The other foot bears all while one is off the floor."""
    other = p.feet["left" if side == "right" else "right"]
    other.clock = lift
    other.step("Stand", p.stage.floor)
    other.clock = p.clock
    other.step("StandOnOneLeg", p.stage.floor)
    other.alternative = (Step("Stand", ("floor",), 0.0, p.clock + 0.9),)
    foot = p.feet[side]
    alone = [replace(each, objects=each.objects[:1]) for each in foot.steps]
    foot.alternative = (*alone, Step("Stand", ("floor",), foot.clock, foot.clock + 0.9))


def kick_a_ball(s: PeopleStage) -> None:
    """The right foot kicks a ball, which rolls away, and is set down again."""
    performer(s, yaw_deg=-60)
    p = person(s, hang=True)
    kick(s, p, "right", lift=0.8, speed=1.8)
    stand_while_kicking(p, "right", 0.8)
    quiet_end(p, 0.9)


def kick_a_ball_gently(s: PeopleStage) -> None:
    """A child kicks a ball with the left foot, at no more than a metre a second."""
    performer(s, yaw_deg=145)
    p = person(s, hang=True, size=0.8)
    kick(s, p, "left", lift=1.0, speed=1.3)
    stand_while_kicking(p, "left", 1.0)
    quiet_end(p, 0.9)


def down_and_up(p: Person, hand: str) -> float:
    """The body sinks and bends in 1.4 s; the hand that does nothing goes along."""
    start = p.clock
    p.bend(35.0, 1.4)
    p.shift((-0.05, 0.0, -0.42 * p.size), 1.4)
    other = p.hands["left" if hand == "right" else "right"]
    other.wait(start)
    p.along(other, start, p.clock)
    other.step("PostureChange")
    return start


def rise(p: Person, hand: str, seconds: float = 1.4) -> None:
    """The body stands up again; the hand that does nothing goes along."""
    start = p.clock
    p.bend(-35.0, seconds)
    p.shift((0.05, 0.0, 0.42 * p.size), seconds)
    other = p.hands["left" if hand == "right" else "right"]
    other.wait(start)
    p.along(other, start, p.clock)
    other.step("PostureChange")


def pick_a_block_off_the_floor(s: PeopleStage) -> None:
    """Somebody squats, takes a block off the floor, and stands up with it."""
    performer(s, yaw_deg=55)
    p = person(s)
    block = s.put("block", shapes.box(0.1, 0.1, 0.16, "block"), (0.5, -0.15, 0.0))
    p.stand(0.7)
    p.right.rest(0.7)
    down_and_up(p, "right")
    p.right.reach(block, "-y", 1.4, up=0.6)
    p.right.hold(0.5, block)
    p.right.take(block)
    p.until(p.right)
    rise(p, "right")
    p.right.move((-0.12, 0.0, 0.85), 1.4)
    p.right.step("Lift", block)
    p.right.hold(0.7, block)
    p.finish(p.right.clock)


def put_a_bottle_on_the_floor(s: PeopleStage) -> None:
    """A tall left-hander squats, puts a bottle on the floor, and stands up without it."""
    performer(s, yaw_deg=-120)
    p = person(s, size=1.06)
    bottle = s.put("bottle", shapes.bottle(0.036, 0.24), (0.5, 0.18, 0.8))
    left = p.left
    left.begin_at(bottle, "+y", up=0.4, fingers=(1.0, 0.0, 0.0))
    left.take(bottle)
    left.hold(0.8, bottle)
    p.stand(0.8)
    down_and_up(p, "left")
    travel(left, "Lower", (0.0, 0.0, -0.8), 1.4, bottle, s.floor, hold=0.6)
    p.until(left)
    p.stand(0.35)
    rise(p, "left", 2.2)
    left.leave(1.4)
    left.wait(p.clock + 0.2)
    p.finish(left.clock)


def kneel_on_one_knee(s: PeopleStage) -> None:
    """The right foot steps back, the body sinks until the knee is on the floor, and stays low."""
    performer(s, yaw_deg=5)
    p = person(s)
    back = p.trunk.at(0.0).copy()
    back[:3, 3] += (-0.45, 0.0, 0.0)
    p.stand(0.8)
    p.stride("right", back, 0.8, 1.5)
    p.stand(0.7)
    start = p.clock
    p.shift((-0.1, 0.0, -0.4), 1.2)
    p.roll_heel("right", 55.0, start, p.clock)
    p.hands_along(start)
    p.stand(1.2)
    p.finish(p.clock)


def chair(s: PeopleStage, x: float, height: float) -> None:
    """A chair's seat behind somebody, with its front edge at x."""
    seat = shapes.box(0.4, 0.42, 0.04, "chair")
    s.put("chair", seat, (x - 0.2, 0.0, height - 0.04), tag="fixed")


def sit_down(s: PeopleStage) -> None:
    """Somebody sits down on a chair; the hands go along, the feet keep the floor."""
    performer(s, yaw_deg=-40)
    p = person(s)
    chair(s, -0.12, 0.44)
    p.stand(0.8)
    start = p.clock
    p.bend(25.0, 0.8)
    p.bend(-25.0, 0.7, start + 0.8)
    p.shift((-0.35, 0.0, -0.42), 1.5)
    p.hands_along(start)
    p.stand(1.5)
    p.finish(p.clock)
    seated(p, start + 1.5, p.clock)


def seated(p: Person, since: float, until: float) -> None:
    """The feet of somebody who sits stand too (spec 10); that they rest is the alternative."""
    borders = (("Stand", 0.0, since), ("RestFoot", since, until), ("Stand", until, p.clock))
    for foot in p.feet.values():
        foot.alternative = tuple(
            Step(name, ("floor",), start, end) for name, start, end in borders if start < end
        )


def stand_up_from_a_chair(s: PeopleStage) -> None:
    """A small person who sits stands up, and stays so."""
    performer(s, yaw_deg=115)
    p = person(s, size=0.9)
    chair(s, -0.1, 0.4)
    sitting(p, (-0.32, 0.0, -0.38))
    p.stand(1.0)
    start = p.clock
    p.shift((0.32, 0.0, 0.38), 1.4)
    p.hands_along(start)
    p.stand(0.9)
    p.finish(p.clock)
    seated(p, 0.0, start)


def sitting(p: Person, by: tuple[float, float, float]) -> None:
    """Let somebody sit at the first frame."""
    p.trunk.first[:3, 3] += by
    for hand in p.hands.values():
        hand.body.first[:3, 3] += by
        hand.home = hand.body.first


def drink_while_seated(s: PeopleStage) -> None:
    """Somebody who sits at a table takes a mug to the mouth, drinks, and puts it back."""
    performer(s, yaw_deg=-75)
    p = person(s)
    chair(s, -0.12, 0.44)
    sitting(p, (-0.3, 0.0, -0.42))
    table = s.desk((0.4, 0.0, 0.7), (0.6, 1.2))
    start = np.array((0.3, -0.1, 0.7))
    cup = mug(s, start)
    right = p.right
    for hand in p.hands.values():
        hand.body.first[:3, 3] += (0.0, 0.0, 0.25)
        hand.home = hand.body.first
    right.rest(0.6)
    right.reach(cup, "-y", 0.9, up=0.6, along=-0.025, hold=0.4)
    right.take(cup)
    face = p.head.body.at(0.0)[:3, 3] + (0.1 * p.size, 0.0, 0.0)
    goal = np.add(face, (0.042 - PRESS, 0.0, -0.1))
    travel(right, "MoveObjTo", goal - start, 1.2, cup, p.head, arrive=0.12)
    right.dip(face, (0.0, 1.0, 0.0), -42.0, 1.3)
    right.step("Drink", cup, p.head)
    travel(right, "MoveObjTo", start - goal, 1.2, cup, table, depart=0.12)
    right.hold(0.5, cup, table)
    right.leave(0.9)
    right.rest(0.6)
    p.finish(right.clock)
    p.until(right)
    seated(p, 0.0, p.clock)


def push_a_gate_open_on_the_way(s: PeopleStage) -> None:
    """Somebody walks up to a gate, pushes it open while walking on, and walks through."""
    performer(s, yaw_deg=30)
    p = person(s, at=(-1.5, 0.58))
    door = gate(s, (0.0, 0.0, 0.0), width=0.95)
    p.stand(0.7)
    p.walk(1.1, speed=0.8)
    right = p.right
    right.rest(0.6)
    face = Grip((-0.008, 0.42, 0.95), NEAR, UP)
    seize(right, door.leaf, face, 0.9, hold=0.4)
    p.until(right)
    p.walk(0.6, speed=0.5, busy=(right,))
    swing = Hinge(door.hinge.point, door.hinge.axis, -1.0)
    swing.turn(right, 80.0, p.clock - right.clock)
    right.step("Open", door.leaf, door.body)
    right.hold(0.5, door.leaf, door.body)
    right.leave(1.0)
    right.rest(0.6)
    p.until(right)
    p.walk(1.1, speed=0.9, first="left", swing_rad=0.1)
    p.stand(0.7)
    p.finish(p.clock)


def open_a_drawer_by_a_step_back(s: PeopleStage) -> None:
    """A drawer is pulled open while the right foot steps back."""
    performer(s, yaw_deg=-95)
    p = person(s, form=shapes.gripping_hand(0.04, 0.04), hands=("right",))
    s.desk((0.8, -0.1, 0.85), (0.5, 0.6), "dresser_top")
    chest = cabinet(s, (0.6, -0.1, 0.95))
    s.put("leg", shapes.box(0.3, 0.3, 0.088, "block"), (0.78, -0.1, 0.85), tag="fixed")
    right = p.right
    right.rest(0.6)
    seize(right, chest.drawer, chest.grip, 0.9, hold=0.5)
    begin = right.clock
    travel(right, "Open", (-0.2, 0.0, 0.0), 1.0, chest.drawer, chest.body, hold=0.6)
    back = p.trunk.at(0.0) @ pose((-0.3, 0.0, 0.0))
    p.stride("right", back, begin + 0.1, begin + 0.75)
    p.clock = begin
    p.shift((-0.15, 0.0, 0.0), 1.0)
    right.home = p.chest.at(p.clock) @ p.local["right"]
    right.leave(0.9)
    right.rest(0.6)


def open_a_cupboard_after_a_walk(s: PeopleStage) -> None:
    """Somebody walks up to a cupboard, opens its door, and leaves it open."""
    performer(s, yaw_deg=170)
    p = person(s, at=(-1.4, 0.0), form=shapes.gripping_hand(0.04, 0.04), hands=("left",))
    s.desk((0.9, 0.0, 0.9), (0.6, 0.8))
    cup = cupboard(s, (0.75, 0.0, 0.912), side="right")
    p.stand(0.7)
    p.walk(1.45, speed=1.0, first="left")
    left = p.left
    left.rest(0.6)
    seize(left, cup.leaf, cup.grip, 0.9, hold=0.4)
    cup.hinge.turn(left, 55.0, 1.3)
    left.step("Open", cup.leaf, cup.body)
    left.hold(0.5, cup.leaf, cup.body)
    left.leave(0.9)
    left.rest(0.6)
