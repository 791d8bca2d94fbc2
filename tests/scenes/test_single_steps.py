"""One action is one step: slow ways, pours, low hops, ways over a table, catches."""

import numpy as np
import pytest
from combinations import in_turn
from scipy.interpolate import CubicHermiteSpline

from scenes.hands import shapes
from scenes.hands.paths import AHEAD
from scenes.hands.performer import GRAVITY, PRESS, Hand, travel
from scenes.hands.scene import Scene, at_table
from scenes.hands.scenes_blows import palm_up
from scenes.hands.scenes_place import fetch, finish
from scenes.hands.stage import Stage
from scenes.objects.builders import Grip, begin_with
from scenes.score import Outcome, observed, report


def outward(side: str) -> float:
    """Direction along y in which a hand's own side lies: 1 or -1."""
    return -1.0 if side == "right" else 1.0


def outcomes_of(write, rate_hz: float, noise_mm: float) -> list[Outcome]:
    """What is observed of a scene, for each hand."""
    scene = Scene(write.__name__, "", write, Stage)
    return observed(scene.name, scene, rate_hz, noise_mm / 1000.0, np.radians(0.1), seed=0)


def right(write, rate_hz: float, noise_mm: float, border_s: float = 0.1) -> None:
    """What is observed of a scene is what was performed, with borders within a time [s]."""
    outcomes = outcomes_of(write, rate_hz, noise_mm)
    assert all(each.named and each.worst_border_s <= border_s for each in outcomes), report(
        outcomes
    )


TRACKERS = [(30.0, 0.5), (60.0, 1.5), (120.0, 0.5), (120.0, 1.5)]
"""Rates [Hz] and noises [mm]."""


def varied(names: tuple[str, ...], cases: list[tuple[object, ...]]) -> pytest.MarkDecorator:
    """Cases, each with a rate and a noise."""
    return pytest.mark.parametrize(("rate_hz", "noise_mm", *names), in_turn(TRACKERS, cases))


@varied(("side", "duration", "far"), [("right", 8.0, 0.0), ("left", 6.0, 0.12)])
def test_slow_reach_is_one_step(rate_hz, noise_mm, side, duration, far) -> None:
    def scene(s: Stage) -> None:
        sign = outward(side)
        at_table(s, yaw_deg=31, size=0.94)
        tin = s.put("tin", shapes.box(0.09, 0.07, 0.12, "tin"), (0.46 + far, -0.08 * sign))
        hand = s.hand(side)
        hand.rest(1.2)
        hand.reach(tin, "+y" if sign > 0 else "-y", duration, speed=0.05, hold=1.0)
        hand.leave(duration, speed=0.05)
        hand.rest(0.8)

    # A hand counts as at rest for 0.3 s after it set off, and noise hides a slow one longer.
    right(scene, rate_hz, noise_mm, 0.5 if noise_mm < 1.0 else 1.3)


@varied(
    ("side", "duration", "way"), [("right", 15.0, 0.5), ("left", 11.0, 0.28), ("right", 20.0, 0.8)]
)
def test_slow_carry_is_one_step(rate_hz, noise_mm, side, duration, way) -> None:
    def scene(s: Stage) -> None:
        sign = outward(side)
        at_table(s, yaw_deg=-64, height=0.82)
        jar = s.put("jar", shapes.box(0.06, 0.08, 0.13, "jar"), (0.45, sign * 0.3, s.height + 0.2))
        hand = s.hand(side)
        begin_with(hand, jar, Grip((0.0, sign * 0.04, 0.07), (0.0, sign, 0.0), AHEAD))
        hand.hold(1.0, jar)
        travel(hand, "Carry", (0.0, -sign * way, 0.0), duration, jar)
        hand.hold(1.0, jar)

    right(scene, rate_hz, noise_mm, 0.05 * duration)


@varied(
    ("side", "tilt_deg", "tip_s", "stay_s", "back_s"),
    [
        ("right", 100.0, 0.9, 1.2, 0.9),
        ("left", 75.0, 1.4, 0.6, 1.4),
        ("right", 120.0, 1.6, 2.5, 0.8),
    ],
)
def test_righting_after_pouring_is_no_pour(
    rate_hz, noise_mm, side, tilt_deg, tip_s, stay_s, back_s
) -> None:
    def scene(s: Stage) -> None:
        sign = outward(side)
        table = at_table(s, yaw_deg=115, height=0.78)
        jug = s.put("jug", shapes.vessel(0.04, 0.16, "jug"), (0.5, sign * 0.22))
        s.put("pot", shapes.vessel(0.1, 0.08, "pot"), (0.5, sign * 0.04))
        hand = s.hand(side, idle=0.2)
        outer = "-y" if sign < 0 else "+y"
        fetch(hand, jug, outer, 0.9, 0.5, 0.3)
        travel(hand, "Lift", (0.0, 0.0, 0.2), 0.8, jug, hold=0.5)
        lip = (0.5, sign * 0.18, s.height + 0.36)
        hand.spin(lip, AHEAD, sign * tilt_deg, tip_s)
        hand.step("Pour", jug)
        hand.hold(stay_s, jug)
        hand.spin(lip, AHEAD, -sign * tilt_deg, back_s)
        hand.step("Tilt", jug)
        hand.hold(0.5, jug)
        travel(hand, "Lower", (0.0, 0.0, -0.2), 0.9, jug, table)
        finish(hand, jug, table, 0.3, 0.9)

    right(scene, rate_hz, noise_mm)


@varied(
    ("side", "up", "aside", "times", "halt"),
    [
        ("right", 0.03, 0.2, (0.8, 1.4, 0.8), 0.0),
        ("left", 0.035, 0.3, (0.4, 1.0, 0.5), 0.25),
        ("right", 0.025, 0.12, (0.5, 0.6, 0.5), 0.2),
        ("left", 0.03, 0.25, (0.4, 0.7, 0.4), None),
    ],
)
def test_low_hop_is_one_step(rate_hz, noise_mm, side, up, aside, times, halt) -> None:
    """A cup goes up a little, aside and down again, with brief halts between or in one sweep."""

    def scene(s: Stage) -> None:
        sign = outward(side)
        table = at_table(s, yaw_deg=203, size=1.04)
        cup = s.put("cup", shapes.vessel(0.04, 0.1, "cup"), (0.48, sign * 0.25))
        hand = s.hand(side, idle=0.2)
        fetch(hand, cup, "-y" if sign < 0 else "+y", 0.9, 0.6, 0.4)
        if halt is not None:
            hand.move((0.0, 0.0, up), times[0])
            hand.idle(halt)
            hand.move((0.0, -sign * aside, 0.0), times[1])
            hand.idle(halt)
            hand.move((0.0, 0.0, -up), times[2])
        else:
            hand.over(up, (0.0, -sign * aside), up, times=times)
        hand.step("MoveObjTo", cup, table)
        finish(hand, cup, table, 0.4, 0.9)

    right(scene, rate_hz, noise_mm)


@varied(
    ("side", "gap", "way", "low_s"),
    [("right", 0.003, 0.1, 0.25), ("left", 0.002, 0.14, 0.3), ("right", 0.004, 0.12, 0.2)],
)
def test_way_low_over_a_table_is_no_reach(rate_hz, noise_mm, side, gap, way, low_s) -> None:
    """From one thing to the next the hand goes so near over the table that it might touch it."""

    def scene(s: Stage) -> None:
        sign = outward(side)
        at_table(s, yaw_deg=-20, height=0.76)
        first = s.put("tin", shapes.box(0.07, 0.07, 0.14, "tin"), (0.44, sign * 0.12))
        second = s.put("box", shapes.box(0.1, 0.08, 0.16), (0.6, -sign * 0.22))
        hand = s.hand(side, idle=0.2)
        outer = "-y" if sign < 0 else "+y"
        hand.reach(first, outer, 0.9, hold=0.5)
        hand.let_go()
        start = hand.now[:3, 3]
        low = np.array([start[0] + 0.02, sign * 0.3, s.height + 0.04 * s.size + gap])
        goal = hand.place(second, outer, up=0.5, fingers=AHEAD)[:3, 3]
        sweep(hand, [start, low, low + np.array([way, 0.0, 0.0]), goal], [0.6, low_s, 0.8])
        hand.meet(second)
        hand.step("Reach", second)
        hand.hold(0.5, second)

    (found,) = outcomes_of(scene, rate_hz, noise_mm)
    assert not any("table" in step for step in found.found), report([found])


@varied(
    ("side", "over", "hold", "size"),
    [("right", 0.0025, 0.0, 0.07), ("left", 0.001, 0.3, 0.06), ("right", 0.004, 0.5, 0.055)],
)
def test_hand_that_brushes_the_table_reaches_the_thing(
    rate_hz, noise_mm, side, over, hold, size
) -> None:
    """What is taken and put down is so low that the hand's edge comes to the table beside it."""

    def scene(s: Stage) -> None:
        sign = outward(side)
        table = at_table(s, yaw_deg=70, height=0.71)
        tin = s.put("tin", shapes.box(size, size, size, "tin"), (0.45, sign * 0.1))
        hand = s.hand(side, idle=0.2)
        outer = "-y" if sign < 0 else "+y"
        fetch(hand, tin, outer, 0.9, (0.04 + over) / size, hold)
        hand.lift_carry_lower(tin, table, up=0.14, by=(0.05, -sign * 0.3), down=0.14)
        finish(hand, tin, table, hold, 0.9)

    right(scene, rate_hz, noise_mm)


def sweep(hand: Hand, places: list, times: list[float]) -> None:
    """Go through places, with a speed between and none at the ends."""
    knots = np.concatenate([[0.0], np.cumsum(times)])
    points = np.array(places)
    slopes = np.zeros(points.shape)
    slopes[1:-1] = (points[2] - points[1]) / times[1]
    curve = CubicHermiteSpline(knots, points, slopes)
    base = hand.now[:3, 3]
    hand.body.shift(hand.clock, hand.clock + knots[-1], lambda since: curve(since) - base)
    hand.clock += knots[-1]


@varied(
    ("before", "side", "wait", "going", "up_mps"),
    [
        ("gets ready", "left", 1.3, 0.5, 1.6),
        ("gets ready", "right", 0.9, 0.3, 1.3),
        ("sways", "right", 2.0, 0.45, 1.5),
        ("rests", "left", 1.1, 0.7, 2.0),
        ("stays", "left", 1.4, 0.3, 2.2),
    ],
)
def test_catch_begins_with_the_hand(rate_hz, noise_mm, before, side, wait, going, up_mps) -> None:
    """The other hand tosses a bag; whatever this one did before is no part of the catch."""

    def scene(s: Stage) -> None:
        sign = outward(side)
        at_table(s, yaw_deg=140, height=0.8)
        place = (0.35, -sign * 0.3, s.height + 0.2)
        bag = s.put("bag", shapes.box(0.07, 0.06, 0.03, "bag"), place)
        other = s.hand("left" if side == "right" else "right")
        other.begin_at(bag, "-z", up=0.0, fingers=AHEAD)
        other.home = other.body.first
        other.take(bag)
        swing, flight = 0.35, 2.0 * up_mps / GRAVITY
        other.hold(wait + going - swing - flight, bag)
        other.throw(bag, (0.0, sign * 0.7, up_mps), swing, flight)
        other.fly(other.home, 0.9)
        other.step("ResumePosture", bag)
        other.idle(0.2)
        caught = palm_up(bag.body.at(wait + going)[:3, 3] + (0.0, 0.0, PRESS))
        hand = s.hand(side)
        ready = caught.copy()
        ready[:3, 3] += (-0.03, sign * 0.05, -0.06)
        hand.body.first = {"stays": caught, "gets ready": hand.home}.get(before, ready)
        if before == "gets ready":
            hand.fly(ready, wait - 0.2)
            hand.idle(0.2)
            hand.step("PostureChange")
        elif before == "sways":
            hand.swing((0.0, 0.03, 0.0), 1.0, round(wait))
            hand.step("PostureChange")
        else:
            hand.rest(wait if before == "rests" else wait + going - flight)
        if before != "stays":
            hand.fly(caught, going)
        hand.until(wait + going)
        hand.meet(bag)
        hand.step("Catch", bag)
        hand.take(bag)
        hand.hold(other.clock - hand.clock, bag)

    right(scene, rate_hz, noise_mm)
