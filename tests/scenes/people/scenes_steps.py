"""Scenes of feet that step, turn, stand alone, or rest on something."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.expectation import Step
from scenes.hands.paths import Poses, Times, pose, quintic
from scenes.hands.scene import performer
from scenes.people.body import Person, foot_place
from scenes.people.limbs import SOLE_M, Limb
from scenes.people.person import person
from scenes.people.registry import scene
from scenes.people.stage import PeopleStage


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


@scene
def step_forward_and_close(s: PeopleStage) -> None:
    """The right foot steps forward, the left one is put beside it."""
    performer(s, yaw_deg=25)
    p = person(s, hang=True)
    p.stand(0.8)
    body_goes(p, (0.45, 0.0, 0.0), 0.55, "right")
    quiet_end(p, 0.8)


@scene
def step_aside(s: PeopleStage) -> None:
    """A small person steps to the left with the left foot, and the right one follows."""
    performer(s, yaw_deg=-95)
    p = person(s, hang=True, size=0.85)
    p.stand(0.7)
    body_goes(p, (0.0, 0.3, 0.0), 0.5, "left")
    quiet_end(p, 0.9)


@scene
def step_out_and_back(s: PeopleStage) -> None:
    """The left foot steps out ahead, stands there for a second, and steps back; hands are kept."""
    performer(s, yaw_deg=140)
    p = person(s, hang=True, size=1.04)
    home = p.trunk.at(0.0)
    p.stride("left", home @ pose((0.35, 0.0, 0.0)), 0.7, 1.25)
    p.stride("left", home, 2.3, 2.9)
    p.clock = 2.9
    quiet_end(p, 0.8)


@scene
def turn_aside_by_two_steps(s: PeopleStage) -> None:
    """Somebody turns to the left by sixty degrees on the spot, one step of each foot."""
    performer(s, yaw_deg=-35)
    p = person(s, hang=True)
    p.stand(0.8)
    body_goes(p, (0.0, 0.0, 0.0), 0.5, "left", 60.0)
    quiet_end(p, 0.8)


@scene
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


@scene
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


@scene
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


@scene
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


@scene
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


@scene
def stand_on_the_right_leg(s: PeopleStage) -> None:
    """A tall person holds the left foot up behind for a second; the hands do not move."""
    performer(s, yaw_deg=100)
    p = person(s, hang=True, size=1.08)
    p.trunk.first[:3, 3] += (0.0, -0.07, 0.0)
    for hand in p.hands.values():
        hand.body.first[:3, 3] += (0.0, -0.07, 0.0)
    one_legged(p, "left", lift=1.0, held=1.2, by=(-0.2, 0.0, 0.3), end=0.9)
    p.left_foot.aliases["Withdraw"] = "ResumePosture"


@scene
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


@scene
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
