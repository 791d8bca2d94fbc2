"""Scenes with high and low places: shelves, stools, the floor, steps, and motion in the air."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import min_jerk
from scenes.hands.performer import Hand
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw, fetch, finish
from scenes.hands.scenes_two_hands import both_leave, both_reach
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing
from scenes.household.builders import glass, jar, scene, tin_box
from scenes.objects.builders import AHEAD, floor, home_again, paused, pillar, shelf, travel


def round_a_corner(hand: Hand, thing: Thing, radius: float, duration: float) -> None:
    """Carry along a level quarter circle that sets out ahead and ends towards the left [m]."""

    def law(since: np.ndarray) -> np.ndarray:
        angle = np.pi / 2.0 * min_jerk(since / duration)
        return radius * np.stack([np.sin(angle), 1.0 - np.cos(angle), 0.0 * angle], axis=1)

    hand.body.shift(hand.clock, hand.clock + duration, law)
    hand.clock += duration
    hand.step("Carry", thing)


@scene
def vase_down_from_a_high_shelf(s: Stage) -> None:
    """A vase is lifted off a high shelf, brought forward and let down to a low table, slowly."""
    performer(s, height=0.5, yaw_deg=7, size=1.08, agent="tall_man")
    table = s.table()
    shelf(s, (0.78, -0.1, 1.25), size=(0.3, 0.6))
    vase = jar(s, (0.72, -0.1, 1.25), "vase", 0.2)
    right = s.right(home=(0.2, -0.42, 1.3))
    right.idle(0.2)
    fetch(right, vase, "-y", 1.2, 0.5, 0.6)
    travel(right, "Lift", (0.0, 0.0, 0.08), 0.7, vase)
    right.hold(0.5, vase)
    travel(right, "Carry", (-0.25, -0.05, 0.0), 1.1, vase)
    right.hold(0.5, vase)
    travel(right, "Lower", (0.0, 0.0, -0.83), 2.2, vase, table)
    finish(right, vase, table, 0.5, 1.3)


@scene
def box_up_from_the_floor(s: Stage) -> None:
    """Both hands lift a box off the floor, bring it over a low table, set it down and stay."""
    performer(s, height=0.45, yaw_deg=-122, size=1.02)
    floor(s)
    table = s.put("low_table", shapes.box(0.5, 0.6, 0.45, "table"), (0.62, 0.7, 0.0), tag="fixed")
    box = tin_box(s, (0.45, -0.25, 0.0), "box", (0.24, 0.28, 0.22))
    hands = both_reach(s, box, 1.4, 0.7, 0.4)
    right, left = hands
    since = len(right.steps)
    left.join(box)
    right.take(box)
    paused(
        right,
        box,
        table,
        up=0.6,
        by=(0.17, 0.95),
        down=0.15,
        holds=(0.4, 0.0),
        times=(1.3, 1.6, 0.8),
    )
    right.hold(0.7, box, table)
    left.part(right, since)


@scene
def tin_round_a_corner(s: Stage) -> None:
    """A tin is lifted, held, carried round a quarter circle on the level, held, and set down."""
    performer(s, height=0.71, yaw_deg=48)
    table = s.table()
    tin = tin_box(s, (0.45, -0.35), "tin", (0.07, 0.07, 0.13))
    right = s.right()
    right.idle(0.2)
    fetch(right, tin, "+z", 0.9, 1.0, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.16), 0.7, tin)
    right.hold(0.4, tin)
    round_a_corner(right, tin, 0.32, 1.4)
    right.hold(0.4, tin)
    travel(right, "Lower", (0.0, 0.0, -0.16), 0.8, tin, table)
    finish(right, tin, table, 0.3, 1.0)


@scene
def bottle_up_and_down_in_the_air(s: Stage) -> None:
    """A bottle that is held in the air is raised, held for a second, lowered by half, and kept."""
    performer(s, height=0.77, yaw_deg=-18, size=0.97)
    s.table()
    flask = s.put("bottle", shapes.bottle(0.035, 0.22), (0.5, 0.12, s.height + 0.15))
    left = s.left()
    left.begin_at(flask, "+y", up=0.35, fingers=AHEAD)
    left.take(flask)
    left.hold(0.6, flask)
    travel(left, "Raise", (0.0, 0.0, 0.32), 1.1, flask)
    left.hold(1.0, flask)
    travel(left, "Lower", (0.0, 0.0, -0.16), 0.8, flask)
    left.hold(0.7, flask)


@scene
def glass_moved_low_from_stool_to_stool(s: Stage) -> None:
    """A glass goes from one stool to another, ten centimetres over both, fast."""
    performer(s, height=0.6, yaw_deg=133)
    pillar(s, "near_stool", (0.45, -0.4, 0.55), (0.34, 0.34), "stool")
    far = pillar(s, "far_stool", (0.6, 0.3, 0.55), (0.34, 0.34), "stool")
    ware = glass(s, (0.45, -0.4, 0.55))
    right = s.right()
    right.idle(0.15)
    fetch(right, ware, "-y", 0.8, 0.65, 0.0)
    right.lift_carry_lower(ware, far, up=0.1, by=(0.15, 0.7), down=0.1, times=(0.55, 1.3, 0.55))
    home_again(right, 0.9)


@scene
def jar_held_and_stood_on_a_stool_and_taken_again(s: Stage) -> None:
    """A jar that hangs in the air is stood on a stool, rests in the hand, and is lifted again."""
    performer(s, height=0.7, yaw_deg=-45, size=1.04)
    stool = pillar(s, "stool", (0.48, 0.2, 0.5), (0.36, 0.36), "stool")
    tin = jar(s, (0.48, 0.2, 0.78), height=0.17)
    left = s.left()
    left.begin_at(tin, "+y", up=0.6, fingers=AHEAD)
    left.take(tin)
    left.hold(0.5, tin)
    travel(left, "Lower", (0.0, 0.0, -0.28), 1.0, tin, stool)
    left.hold(1.2, tin, stool)
    travel(left, "Lift", (0.0, 0.0, 0.22), 0.9, tin)
    left.hold(0.6, tin)


@scene
def block_from_the_floor_by_a_child(s: Stage) -> None:
    """A child quickly takes a block from the floor and puts it on a low bench."""
    performer(s, height=0.32, yaw_deg=92, size=0.76, agent="child", offset=(-0.7, 1.1))
    floor(s)
    bench = pillar(s, "bench", (0.45, -0.2, 0.3), (0.3, 0.3), "bench")
    cube = s.put("block", shapes.box(0.055, 0.055, 0.055, "block"), (0.4, 0.25, 0.0))
    left = s.left(claw())
    left.idle(0.1)
    fetch(left, cube, "+z", 0.7, 1.0, 0.0)
    left.lift_carry_lower(cube, bench, up=0.42, by=(0.05, -0.45), down=0.12, times=(0.7, 0.8, 0.5))
    finish(left, cube, bench, 0.3, 0.8)


@scene
def tin_up_a_step(s: Stage) -> None:
    """A tin goes up from the table onto a step in one motion that hardly sinks at its end."""
    performer(s, height=0.74, yaw_deg=-150)
    s.table()
    step = s.put("step", shapes.box(0.3, 0.4, 0.15, "step"), (0.6, 0.2, s.height), tag="fixed")
    tin = tin_box(s, (0.5, -0.3), "tin", (0.06, 0.06, 0.14))
    right = s.right()
    right.idle(0.2)
    fetch(right, tin, "+z", 0.9, 1.0, 0.4)
    right.over(0.18, (0.08, 0.45), 0.03, times=(0.8, 1.0, 0.5), overlap=0.2)
    right.step("MoveObjTo", tin, step)
    finish(right, tin, step, 0.4, 1.0)
    right.alternative = other_names(right, MoveObjTo="PutDown")


@scene
def jar_carried_in_three_legs_with_a_long_stop(s: Stage) -> None:
    """A jar is carried in three legs on the level, with stops of half a second and five seconds."""
    performer(s, height=0.65, yaw_deg=24, size=0.92, agent="old_woman")
    table = s.table()
    tin = jar(s, (0.45, -0.35))
    right = s.right()
    right.idle(0.2)
    fetch(right, tin, "-y", 1.3, 0.6, 0.8)
    travel(right, "Lift", (0.0, 0.0, 0.2), 1.1, tin)
    right.hold(0.5, tin)
    for by, rest in (((0.2, 0.1), 0.5), ((0.0, 0.3), 5.0), ((-0.15, 0.1), 0.6)):
        travel(right, "Carry", (*by, 0.0), 1.4, tin)
        right.hold(rest, tin)
    travel(right, "Lower", (0.0, 0.0, -0.2), 1.2, tin, table)
    finish(right, tin, table, 0.4, 1.2)


@scene
def tin_swung_high_and_far(s: Stage) -> None:
    """The left hand swings a tin over a wall of books in a high arc, and fast."""
    performer(s, height=0.82, yaw_deg=-77, size=1.07, agent="tall_man")
    table = s.table()
    s.put("books", shapes.box(0.24, 0.12, 0.22, "books"), (0.5, 0.0), tag="fixed")
    tin = tin_box(s, (0.5, 0.38), "tin", (0.07, 0.07, 0.12))
    left = s.left()
    left.idle(0.15)
    fetch(left, tin, "+z", 0.8, 1.0, 0.0)
    left.lift_carry_lower(tin, table, up=0.42, by=(0.0, -0.7), down=0.42, times=(0.75, 1.1, 0.8))
    left.hold(0.7, tin, table)


@scene
def box_lowered_to_the_floor(s: Stage) -> None:
    """Both hands hold a box in the air from the first frame and let it down to the floor."""
    performer(s, height=0.5, yaw_deg=159)
    ground = floor(s)
    box = tin_box(s, (0.45, 0.0, 0.55), "box", (0.26, 0.3, 0.2))
    right, left = s.right(), s.left()
    for hand, side in ((right, "-y"), (left, "+y")):
        hand.begin_at(box, side, up=0.6, fingers=AHEAD)
    left.join(box)
    right.take(box)
    right.hold(0.6, box)
    travel(right, "Lower", (0.0, 0.0, -0.55), 1.5, box, ground)
    right.hold(0.5, box, ground)
    left.part(right, 0)
    both_leave([right, left], 0.9)


@scene
def jar_from_a_low_board_to_a_high_one(s: Stage) -> None:
    """A jar is lifted off a stool, carried over a shelf and lowered there, with two pauses."""
    performer(s, height=0.7, yaw_deg=-100, size=1.03)
    pillar(s, "stool", (0.5, -0.4, 0.6), (0.36, 0.36), "stool")
    board = shelf(s, (0.62, 0.2, 1.0), size=(0.36, 0.4))
    tin = jar(s, (0.5, -0.4, 0.6), height=0.18)
    right = s.right()
    right.idle(0.2)
    fetch(right, tin, "-y", 1.0, 0.6, 0.4)
    paused(
        right,
        tin,
        board,
        up=0.49,
        by=(0.1, 0.6),
        down=0.09,
        holds=(0.5, 0.5),
        times=(1.3, 1.3, 0.6),
    )
    finish(right, tin, board, 0.5, 1.2)
