"""Scenes with mallets, rakes, sticks, scrapers, cloths and brushes: blows, pushes and wiping."""

from scenes.hands import shapes
from scenes.hands.performer import Hand
from scenes.hands.scene import performer
from scenes.hands.scenes_place import fetch, finish
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.household import builders
from scenes.household.builders import HAFT, scene
from scenes.objects import forms
from scenes.objects.builders import (
    AHEAD,
    UP,
    begin_with,
    home_again,
    pillar,
    seize,
    shelf,
    travel,
    wall,
)

PEG_M = 0.06
"""How far a peg stands out of its board [m]."""


def peg_in_a_board(s: Stage, at: tuple[float, float]) -> Thing:
    """A thick peg in a board on the table; both are fast."""
    s.put("board", shapes.box(0.24, 0.24, 0.03, "board"), at, tag="fixed")
    made = shapes.Form("peg", (shapes.disc(0.014, 0.0, PEG_M),))
    return s.put("peg", made, (*at, s.height + 0.03), tag="fixed")


def strike(hand: Hand, tool: Thing, target: Thing, by: tuple[float, float, float]) -> None:
    """Bring a tool on a target at 1.1 m/s; it stops there."""
    hand.move(by, 0.33, arrive=1.1)
    hand.step("Hit", tool, target)


@scene
def peg_hit_three_times(s: Stage) -> None:
    """A mallet is raised over a peg and comes down three times, with short stops on it."""
    performer(s, height=0.7, yaw_deg=17, size=1.03, agent="carpenter")
    s.table()
    right, peg = s.right(), peg_in_a_board(s, (0.72, -0.12))
    tool = s.put("mallet", builders.mallet(), (0.445, -0.12, s.height + 0.03 + PEG_M + 0.06 + 0.02))
    begin_with(right, tool, HAFT)
    right.hold(0.5, tool)
    travel(right, "Raise", (0.0, 0.0, 0.16), 0.7, tool)
    strike(right, tool, peg, (0.0, 0.0, -0.18))
    for rest in (0.25, 0.25):
        right.hold(rest, tool, peg)
        travel(right, "Lift", (0.0, 0.0, 0.18), 0.6, tool)
        strike(right, tool, peg, (0.0, 0.0, -0.18))
    right.hold(0.7, tool, peg)


@scene
def gong_struck_with_a_mallet(s: Stage) -> None:
    """The left hand draws a mallet back and strikes an upright gong with its end, on the level."""
    performer(s, height=0.76, yaw_deg=-118)
    s.table()
    gong = s.put("gong", shapes.box(0.02, 0.4, 0.4, "gong"), (0.85, 0.1), tag="fixed")
    left = s.left()
    tool = s.put("mallet", builders.mallet(), (0.85 - 0.01 - 0.3 - 0.04, 0.1, s.height + 0.25))
    begin_with(left, tool, HAFT)
    left.hold(0.5, tool)
    travel(left, "Carry", (-0.14, 0.0, 0.0), 0.7, tool)
    strike(left, tool, gong, (0.18, 0.0, 0.0))
    left.hold(0.6, tool, gong)


@scene
def mallet_taken_from_a_bench_and_used(s: Stage) -> None:
    """A mallet is lifted off a bench, carried over a peg, held, and brought down hard."""
    performer(s, height=0.68, yaw_deg=95, size=1.05)
    s.table()
    bench = s.put("bench", shapes.box(0.2, 0.1, 0.1, "bench"), (0.6, 0.2), tag="fixed")
    right, peg = s.right(), peg_in_a_board(s, (0.72, -0.25))
    tool = s.put("mallet", builders.mallet(), (0.48, 0.2, s.height + 0.1 + 0.013))
    right.idle(0.2)
    seize(right, tool, HAFT, 1.0, hold=0.4)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.8, tool)
    right.hold(0.4, tool)
    travel(right, "Carry", (-0.035, -0.45, 0.0), 1.1, tool)
    right.hold(0.5, tool)
    fall = bench.body.first[2, 3] + 0.333 - 0.06 - (s.height + 0.03 + PEG_M)
    strike(right, tool, peg, (0.0, 0.0, -fall))
    right.hold(0.8, tool, peg)


@scene
def drum_touched_and_then_hit(s: Stage) -> None:
    """An upright stick is let down gently on a drum, taken up again, and brought down hard."""
    performer(s, height=0.62, yaw_deg=-55, size=0.98)
    s.table()
    drum = s.put(
        "drum", shapes.Form("drum", (shapes.disc(0.15, 0.0, 0.18),)), (0.6, -0.05), tag="fixed"
    )
    stick = s.put("stick", shapes.rod(0.3, 0.009, "stick"), (0.6, -0.05, s.height + 0.18 + 0.2))
    right = s.right(shapes.gripping_hand(0.05, 0.04))
    right.begin_at(stick, "+z", up=1.0, fingers=AHEAD)
    right.take(stick)
    right.hold(0.5, stick)
    travel(right, "Lower", (0.0, 0.0, -0.2), 1.6, stick, drum)
    right.hold(0.6, stick, drum)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, stick)
    right.hold(0.5, stick)
    strike(right, stick, drum, (0.0, 0.0, -0.2))
    right.hold(0.7, stick, drum)


@scene
def block_raked_near(s: Stage) -> None:
    """A rake held behind a block is drawn up to it, waits, and draws the block near."""
    performer(s, height=0.73, yaw_deg=165)
    s.table()
    block = s.put("block", shapes.box(0.1, 0.1, 0.06, "block"), (0.82, -0.1))
    right = s.right()
    tool = s.put("rake", builders.rake(), (0.87 + 0.06 - 0.385, -0.1, s.height + 0.105))
    begin_with(right, tool, HAFT)
    right.hold(0.5, tool)
    travel(right, "MoveObjTo", (-0.0602, 0.0, 0.0), 0.7, tool, block)
    right.hold(0.4, tool, block)
    right.take_along(tool, block)
    travel(right, "Pull", (-0.26, 0.0, 0.0), 1.3, tool, block)
    right.hold(0.6, tool, block)


@scene
def can_pushed_aside_with_a_stick(s: Stage) -> None:
    """The side of a stick in the left hand meets a can, rests on it, and pushes it to the right."""
    performer(s, height=0.86, yaw_deg=-35, size=1.07, agent="tall_woman")
    s.table()
    can = s.put("can", shapes.box(0.08, 0.08, 0.12, "can"), (0.72, 0.05))
    left = s.left()
    tool = s.put("stick", forms.stick(0.34), (0.4, 0.05 + 0.04 + 0.012 + 0.15, s.height + 0.06))
    begin_with(left, tool, HAFT)
    left.hold(0.5, tool)
    travel(left, "MoveObjTo", (0.0, -0.1502, 0.0), 0.9, tool, can)
    left.hold(0.5, tool, can)
    left.take_along(tool, can)
    travel(left, "Push", (0.0, -0.3, 0.0), 1.5, tool, can)
    left.hold(0.5, tool, can)


@scene
def dough_pushed_with_a_scraper_at_once(s: Stage) -> None:
    """A scraper comes up to a lump of dough and pushes it on without a halt, fast."""
    performer(s, height=0.75, yaw_deg=58)
    s.table()
    dough = s.put("dough", shapes.box(0.12, 0.14, 0.06, "dough"), (0.62, -0.08))
    right = s.right()
    tool = s.put("scraper", builders.scraper(), (0.56 - 0.28 - 0.14, -0.08, s.height + 0.07))
    begin_with(right, tool, HAFT)
    right.hold(0.4, tool)
    right.move((0.1402, 0.0, 0.0), 0.7, arrive=0.3)
    right.step("MoveObjTo", tool, dough)
    right.take_along(tool, dough)
    right.move((0.25, 0.0, 0.0), 0.9, depart=0.3)
    right.step("Push", tool, dough)
    right.hold(0.7, tool, dough)


@scene
def wall_wiped_with_a_cloth(s: Stage) -> None:
    """A cloth in the hand is laid against a wall, wiped up and down on it, and taken off."""
    performer(s, height=0.8, yaw_deg=-164)
    behind = wall(s, 0.72)
    cloth = s.put("cloth", shapes.box(0.014, 0.16, 0.2, "cloth"), (0.713 - 0.12, -0.15, s.height))
    right = s.right()
    right.begin_at(cloth, "-x", up=0.5, fingers=UP)
    right.take(cloth)
    right.hold(0.5, cloth)
    travel(right, "MoveObjTo", (0.1202, 0.0, 0.0), 0.9, cloth, behind)
    right.hold(0.5, cloth, behind)
    right.swing((0.0, 0.0, 0.1), 0.9, 4)
    right.step("Wipe", cloth, behind)
    right.hold(0.5, cloth, behind)
    travel(right, "Carry", (-0.15, 0.0, 0.0), 0.8, cloth)
    right.hold(0.5, cloth)


@scene
def shelf_brushed_twice(s: Stage) -> None:
    """A brush on a shelf is taken and goes to and fro aslant, rests, and goes round in circles."""
    performer(s, height=0.6, yaw_deg=30, size=1.06)
    board = shelf(s, (0.62, -0.05, 1.0), size=(0.5, 0.7))
    tool = s.put("brush", builders.brush(), (0.6, -0.1, 1.0))
    right = s.right(home=(0.15, -0.3, 1.15))
    right.idle(0.2)
    fetch(right, tool, "+z", 0.9, 1.0, 0.4)
    right.swing((0.07, 0.07, 0.0), 1.4, 4)
    right.step("Wipe", tool, board)
    right.hold(0.7, tool, board)
    right.circle(0.07, 0.9, 3)
    right.step("Wipe", tool, board)
    right.hold(0.4, tool, board)
    home_again(right, 0.9)


@scene
def block_wiped_while_it_is_held(s: Stage) -> None:
    """The left hand holds a chopping block; the right hand wipes it with a sponge, and lifts."""
    performer(s, height=0.74, yaw_deg=-91, size=0.96)
    s.table()
    block = s.put("chopping_block", shapes.box(0.26, 0.26, 0.09, "block"), (0.52, 0.02))
    sponge = s.put("sponge", shapes.box(0.12, 0.08, 0.035, "sponge"), (0.5, -0.32))
    right, left = s.right(), s.left()
    left.idle(0.2)
    left.reach(block, "+y", 0.8, up=0.55)
    right.idle(0.2)
    fetch(right, sponge, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(sponge, block, up=0.22, by=(0.02, 0.33), down=0.13)
    right.hold(0.4, sponge, block)
    right.circle(0.05, 1.2, 5)
    right.step("Wipe", sponge, block)
    right.hold(0.4, sponge, block)
    travel(right, "Lift", (0.0, 0.0, 0.15), 0.8, sponge)
    right.hold(0.5, sponge)
    left.hold(right.clock - left.clock, block)


@scene
def brush_carried_over_a_stool_and_not_used(s: Stage) -> None:
    """A brush is brought from the table to a stool, laid on it and left there."""
    performer(s, height=0.72, yaw_deg=126)
    s.table(width=0.9)
    stool = pillar(s, "stool", (0.48, 0.75, 0.5), (0.32, 0.36), "stool")
    tool = s.put("brush", builders.brush(), (0.5, 0.22))
    left = s.left()
    left.idle(0.2)
    fetch(left, tool, "+z", 0.9, 1.0, 0.3)
    travel(left, "Lift", (0.0, 0.0, 0.12), 0.7, tool)
    left.hold(0.4, tool)
    travel(left, "Carry", (-0.02, 0.53, 0.0), 1.0, tool)
    left.hold(0.4, tool)
    travel(left, "Lower", (0.0, 0.0, -0.34), 1.0, tool, stool)
    finish(left, tool, stool, 0.4, 1.1)
