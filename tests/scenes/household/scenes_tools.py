"""Tools that cut, wipe, sweep and strike."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import AHEAD, UP
from scenes.hands.performer import Hand, travel
from scenes.hands.scene import at_table, performer
from scenes.hands.scenes_place import fetch, finish
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.household import builders
from scenes.household.builders import HAFT
from scenes.objects import forms
from scenes.objects.builders import Grip, begin_with, home_again, pillar, seize, shelf, wall

GRIPPED = shapes.gripping_hand(0.05, 0.04)
"""A hand that takes the upper end of an upright spoon."""


def held_knife(s: Stage, hand: Hand, tip: tuple[float, float], over: float, yaw: float) -> Thing:
    """A long knife in the hand, the middle of its blade so far over a point, turned [m, degrees].

    Its edge is at ``over`` above the table, its handle towards the performer.
    """
    turn = np.radians(yaw)
    x, y = tip[0] - 0.29 * np.cos(turn), tip[1] - 0.29 * np.sin(turn)
    knife = s.put("knife", builders.long_knife(), (x, y, s.height + over + 0.022), yaw_deg=yaw)
    begin_with(hand, knife, HAFT)
    return knife


def saw(
    hand: Hand, knife: Thing, target: Thing, yaw: float, far: float, rate: float, cycles: int
) -> None:
    """Go to and fro along a blade that is turned by an angle [degrees], so far each way [m]."""
    turn = np.radians(yaw)
    hand.swing((far * np.cos(turn), far * np.sin(turn), 0.0), rate, cycles)
    hand.step("Cut", knife, target)


def cheese_cut_aslant(s: Stage) -> None:
    """A knife that points to the left is lowered on a cheese, saws six times at once, and stays."""
    at_table(s, height=0.79, yaw_deg=-9)
    cheese = s.put("cheese", shapes.box(0.16, 0.16, 0.07, "cheese"), (0.66, -0.02))
    right = s.right()
    knife = held_knife(s, right, (0.66, -0.02), 0.07 + 0.12, 25.0)
    right.hold(0.5, knife)
    travel(right, "Lower", (0.0, 0.0, -0.12), 0.7, knife, cheese)
    saw(right, knife, cheese, 25.0, 0.045, 1.6, 6)
    right.hold(0.7, knife, cheese)


def bread_cut_twice_and_steadied(s: Stage) -> None:
    """The left hand steadies a bread; the right hand saws, pauses, saws on and goes up."""
    at_table(s, height=0.84, yaw_deg=146, size=1.03)
    bread = s.put("bread", shapes.box(0.12, 0.3, 0.11, "bread"), (0.66, 0.05))
    right, left = s.right(), s.left()
    knife = held_knife(s, right, (0.66, -0.03), 0.11 + 0.16, 0.0)
    left.idle(0.2)
    left.reach(bread, "+y", 0.9, up=0.55)
    right.hold(left.clock + 0.2, knife)
    travel(right, "Lower", (0.0, 0.0, -0.16), 0.9, knife, bread, hold=0.5)
    saw(right, knife, bread, 0.0, 0.06, 1.0, 3)
    right.hold(0.6, knife, bread)
    saw(right, knife, bread, 0.0, 0.06, 1.3, 4)
    right.hold(0.4, knife, bread)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, knife, hold=0.6)
    left.hold(right.clock - left.clock, bread)


def sausage_cut_by_the_left_hand(s: Stage) -> None:
    """A left-handed child brings a knife down on a sausage, saws slowly, and keeps it there."""
    at_table(s, height=0.55, yaw_deg=-73, size=0.82, agent="child")
    sausage = s.put("sausage", shapes.box(0.05, 0.26, 0.05, "sausage"), (0.6, 0.1))
    left = s.left()
    knife = held_knife(s, left, (0.6, 0.08), 0.05 + 0.1, -15.0)
    left.hold(0.6, knife)
    travel(left, "Lower", (0.0, 0.0, -0.1), 0.9, knife, sausage, hold=0.4)
    saw(left, knife, sausage, -15.0, 0.05, 0.7, 3)
    left.hold(0.5, knife, sausage)


def knife_laid_on_a_loaf_and_taken_off(s: Stage) -> None:
    """A knife is lowered on a loaf, rests there for two seconds without a stroke, and goes up."""
    at_table(s, height=0.72, yaw_deg=201)
    loaf = s.put("loaf", shapes.box(0.12, 0.24, 0.1, "loaf"), (0.66, -0.1))
    right = s.right()
    knife = held_knife(s, right, (0.66, -0.1), 0.1 + 0.14, 8.0)
    right.hold(0.4, knife)
    travel(right, "Lower", (0.0, 0.0, -0.14), 1.0, knife, loaf, hold=2.0)
    travel(right, "Lift", (0.0, 0.0, 0.16), 0.9, knife, hold=0.5)


def cake_spread_with_a_spatula(s: Stage) -> None:
    """A flat spatula is lowered on a cake and goes to and fro across its own length."""
    at_table(s, height=0.77, yaw_deg=39, size=0.97)
    cake = s.put("cake", shapes.box(0.24, 0.24, 0.08, "cake"), (0.68, -0.08))
    blade = shapes.block((0.12, -0.02, -0.002), (0.32, 0.02, 0.002))
    handle = shapes.block((0.0, -0.01, -0.002), (0.13, 0.01, 0.02))
    form = shapes.Form("spatula", (handle, blade))
    tool = s.put("spatula", form, (0.44, -0.08, s.height + 0.08 + 0.13 + 0.002))
    right = s.right()
    begin_with(right, tool, HAFT)
    right.hold(0.5, tool)
    travel(right, "Lower", (0.0, 0.0, -0.13), 0.8, tool, cake, hold=0.4)
    right.swing((0.0, 0.06, 0.0), 1.1, 5)
    right.step("Wipe", tool, cake)
    right.hold(0.4, tool, cake)
    travel(right, "Lift", (0.0, 0.0, 0.15), 0.8, tool, hold=0.5)


def cup_stirred_to_and_fro(s: Stage) -> None:
    """The right hand lowers a spoon into a mug that the left hand holds, and stirs to and fro."""
    at_table(s, height=0.75, yaw_deg=-140)
    mug = s.put("mug", shapes.vessel(0.055, 0.11, "mug"), (0.5, -0.05))
    spoon = s.put("spoon", builders.tall_spoon(0.24), (0.5, -0.05, s.height + 0.185))
    right, left = s.right(GRIPPED), s.left()
    right.begin_at(spoon, "+z", up=1.0, fingers=AHEAD)
    right.take(spoon)
    left.idle(0.2)
    left.reach(mug, "+y", 0.9, up=0.6, aside=(0.0, 0.0, 0.0))
    right.hold(left.clock + 0.3, spoon)
    travel(right, "Lower", (0.0, 0.0, -0.18), 0.9, spoon, mug, hold=0.4)
    right.swing((0.028, 0.0, 0.0), 1.8, 6)
    right.step("Stir", spoon, mug)
    right.hold(0.5, spoon, mug)
    left.hold(right.clock - left.clock, mug)


def bowl_on_the_palm_stirred(s: Stage) -> None:
    """A bowl lies on the left palm in the air; the right hand stirs in it and lifts the spoon."""
    at_table(s, height=0.7, yaw_deg=76, size=1.04)
    dish = s.put("bowl", shapes.vessel(0.1, 0.07, "bowl", 0.012), (0.5, 0.1, s.height + 0.2))
    spoon = s.put("spoon", builders.tall_spoon(0.26), (0.53, 0.1, s.height + 0.362))
    left, right = s.left(), s.right(GRIPPED)
    left.begin_at(dish, "-z", up=0.0, fingers=AHEAD)
    left.take(dish)
    right.begin_at(spoon, "+z", up=1.0, fingers=AHEAD)
    right.take(spoon)
    right.hold(0.6, spoon)
    travel(right, "Lower", (0.0, 0.0, -0.15), 0.9, spoon, dish)
    right.circle(0.03, 1.3, 5)
    right.step("Stir", spoon, dish)
    right.hold(0.5, spoon, dish)
    travel(right, "Lift", (0.0, 0.0, 0.18), 0.9, spoon, hold=0.5)
    left.hold(right.clock, dish)


def ladle_in_a_pot_stirred_and_taken_out(s: Stage) -> None:
    """A ladle that stands in a pot is taken, stirs five rounds slowly, and is lifted out."""
    at_table(s, height=0.66, yaw_deg=-31, size=0.94, agent="old_man")
    pot = s.put("pot", forms.pot(0.14, 0.13), (0.52, -0.06))
    tool = s.put("ladle", builders.soup_ladle(), (0.55, -0.06, s.height + 0.006))
    right = s.right(shapes.gripping_hand(0.06, 0.04), idle=0.25)
    seize(right, tool, Grip((-0.02, 0.0, 0.3), UP, AHEAD), 1.2, hold=0.5)
    right.circle(0.035, 0.8, 5)
    right.step("Stir", tool, pot)
    right.hold(0.6, tool, pot)
    travel(right, "Lift", (0.0, 0.0, 0.26), 1.2, tool, hold=0.9)


def spoon_stood_in_a_pot_without_stirring(s: Stage) -> None:
    """A spoon is lowered into a pot, held upright in it for two seconds, and let go of."""
    at_table(s, height=0.81, yaw_deg=112)
    pot = s.put("pot", forms.pot(0.1, 0.14), (0.55, 0.12))
    spoon = s.put("spoon", builders.tall_spoon(0.32), (0.55, 0.12, s.height + 0.226))
    left = s.left(GRIPPED)
    left.begin_at(spoon, "+z", up=1.0, fingers=AHEAD)
    left.take(spoon)
    left.hold(0.5, spoon)
    travel(left, "Lower", (0.0, 0.0, -0.22), 1.0, spoon, pot, hold=2.0)
    home_again(left, 1.0)


PEG_M = 0.06
"""How far a peg stands out of its board [m]."""


def peg_in_a_board(s: Stage, at: tuple[float, float]) -> Thing:
    """A thick peg in a board on the table; both are fast."""
    s.put("board", shapes.box(0.24, 0.24, 0.03, "board"), at, tag="fixed")
    made = shapes.Form("peg", (shapes.disc(0.014, 0.0, PEG_M),))
    return s.put("peg", made, (*at, s.height + 0.03), tag="fixed")


def strike(hand: Hand, tool: Thing, target: Thing, by: tuple[float, float, float]) -> None:
    """Bring a tool on a target at 1.1 m/s; it stops there."""
    travel(hand, "Hit", by, 0.33, tool, target, arrive=1.1)


def peg_hit_three_times(s: Stage) -> None:
    """A mallet is raised over a peg and comes down three times, with short stops on it."""
    at_table(s, height=0.7, yaw_deg=17, size=1.03, agent="carpenter")
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


def gong_struck_with_a_mallet(s: Stage) -> None:
    """The left hand draws a mallet back and strikes an upright gong with its end, on the level."""
    at_table(s, height=0.76, yaw_deg=-118)
    gong = s.put("gong", shapes.box(0.02, 0.4, 0.4, "gong"), (0.85, 0.1), tag="fixed")
    left = s.left()
    tool = s.put("mallet", builders.mallet(), (0.85 - 0.01 - 0.3 - 0.04, 0.1, s.height + 0.25))
    begin_with(left, tool, HAFT)
    left.hold(0.5, tool)
    travel(left, "Carry", (-0.14, 0.0, 0.0), 0.7, tool)
    strike(left, tool, gong, (0.18, 0.0, 0.0))
    left.hold(0.6, tool, gong)


def mallet_taken_from_a_bench_and_used(s: Stage) -> None:
    """A mallet is lifted off a bench, carried over a peg, held, and brought down hard."""
    at_table(s, height=0.68, yaw_deg=95, size=1.05)
    bench = s.put("bench", shapes.box(0.2, 0.1, 0.1, "bench"), (0.6, 0.2), tag="fixed")
    right, peg = s.right(), peg_in_a_board(s, (0.72, -0.25))
    tool = s.put("mallet", builders.mallet(), (0.48, 0.2, s.height + 0.1 + 0.013))
    right.idle(0.2)
    seize(right, tool, HAFT, 1.0, hold=0.4)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.8, tool, hold=0.4)
    travel(right, "Carry", (-0.035, -0.45, 0.0), 1.1, tool, hold=0.5)
    fall = bench.body.first[2, 3] + 0.333 - 0.06 - (s.height + 0.03 + PEG_M)
    strike(right, tool, peg, (0.0, 0.0, -fall))
    right.hold(0.8, tool, peg)


def drum_touched_and_then_hit(s: Stage) -> None:
    """An upright stick is let down gently on a drum, taken up again, and brought down hard."""
    at_table(s, height=0.62, yaw_deg=-55, size=0.98)
    drum = s.put(
        "drum", shapes.Form("drum", (shapes.disc(0.15, 0.0, 0.18),)), (0.6, -0.05), tag="fixed"
    )
    stick = s.put("stick", shapes.rod(0.3, 0.009, "stick"), (0.6, -0.05, s.height + 0.18 + 0.2))
    right = s.right(shapes.gripping_hand(0.05, 0.04))
    right.begin_at(stick, "+z", up=1.0, fingers=AHEAD)
    right.take(stick)
    right.hold(0.5, stick)
    travel(right, "Lower", (0.0, 0.0, -0.2), 1.6, stick, drum, hold=0.6)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, stick, hold=0.5)
    strike(right, stick, drum, (0.0, 0.0, -0.2))
    right.hold(0.7, stick, drum)


def block_raked_near(s: Stage) -> None:
    """A rake held behind a block is drawn up to it, waits, and draws the block near."""
    at_table(s, height=0.73, yaw_deg=165)
    block = s.put("block", shapes.box(0.1, 0.1, 0.06, "block"), (0.82, -0.1))
    right = s.right()
    tool = s.put("rake", builders.rake(), (0.87 + 0.06 - 0.385, -0.1, s.height + 0.105))
    begin_with(right, tool, HAFT)
    right.hold(0.5, tool)
    travel(right, "MoveObjTo", (-0.0602, 0.0, 0.0), 0.7, tool, block, hold=0.4)
    right.take_along(tool, block)
    travel(right, "Pull", (-0.26, 0.0, 0.0), 1.3, tool, block, hold=0.6)


def can_pushed_aside_with_a_stick(s: Stage) -> None:
    """The side of a stick in the left hand meets a can, rests on it, and pushes it to the right."""
    at_table(s, height=0.86, yaw_deg=-35, size=1.07, agent="tall_woman")
    can = s.put("can", shapes.box(0.08, 0.08, 0.12, "can"), (0.72, 0.05))
    left = s.left()
    tool = s.put("stick", forms.stick(0.34), (0.4, 0.05 + 0.04 + 0.012 + 0.15, s.height + 0.06))
    begin_with(left, tool, HAFT)
    left.hold(0.5, tool)
    travel(left, "MoveObjTo", (0.0, -0.1502, 0.0), 0.9, tool, can, hold=0.5)
    left.take_along(tool, can)
    travel(left, "Push", (0.0, -0.3, 0.0), 1.5, tool, can, hold=0.5)


def dough_pushed_with_a_scraper_at_once(s: Stage) -> None:
    """A scraper comes up to a lump of dough and pushes it on without a halt, fast."""
    at_table(s, height=0.75, yaw_deg=58)
    dough = s.put("dough", shapes.box(0.12, 0.14, 0.06, "dough"), (0.62, -0.08))
    right = s.right()
    tool = s.put("scraper", builders.scraper(), (0.56 - 0.28 - 0.14, -0.08, s.height + 0.07))
    begin_with(right, tool, HAFT)
    right.hold(0.4, tool)
    travel(right, "MoveObjTo", (0.1402, 0.0, 0.0), 0.7, tool, dough, arrive=0.3)
    right.take_along(tool, dough)
    travel(right, "Push", (0.25, 0.0, 0.0), 0.9, tool, dough, depart=0.3)
    right.hold(0.7, tool, dough)


def wall_wiped_with_a_cloth(s: Stage) -> None:
    """A cloth in the hand is laid against a wall, wiped up and down on it, and taken off."""
    performer(s, height=0.8, yaw_deg=-164)
    behind = wall(s, 0.72)
    cloth = s.put("cloth", shapes.box(0.014, 0.16, 0.2, "cloth"), (0.713 - 0.12, -0.15, s.height))
    right = s.right()
    right.begin_at(cloth, "-x", up=0.5, fingers=UP)
    right.take(cloth)
    right.hold(0.5, cloth)
    travel(right, "MoveObjTo", (0.1202, 0.0, 0.0), 0.9, cloth, behind, hold=0.5)
    right.swing((0.0, 0.0, 0.1), 0.9, 4)
    right.step("Wipe", cloth, behind)
    right.hold(0.5, cloth, behind)
    travel(right, "Carry", (-0.15, 0.0, 0.0), 0.8, cloth, hold=0.5)


def shelf_brushed_twice(s: Stage) -> None:
    """A brush on a shelf is taken and goes to and fro aslant, rests, and goes round in circles."""
    performer(s, height=0.6, yaw_deg=30, size=1.06)
    board = shelf(s, (0.62, -0.05, 1.0), size=(0.5, 0.7))
    tool = s.put("brush", builders.brush(), (0.6, -0.1, 1.0))
    right = s.right(home=(0.15, -0.3, 1.15), idle=0.2)
    fetch(right, tool, "+z", 0.9, 1.0, 0.4)
    right.swing((0.07, 0.07, 0.0), 1.4, 4)
    right.step("Wipe", tool, board)
    right.hold(0.7, tool, board)
    right.circle(0.07, 0.9, 3)
    right.step("Wipe", tool, board)
    right.hold(0.4, tool, board)
    home_again(right, 0.9)


def block_wiped_while_it_is_held(s: Stage) -> None:
    """The left hand holds a chopping block; the right hand wipes it with a sponge, and lifts."""
    at_table(s, height=0.74, yaw_deg=-91, size=0.96)
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
    travel(right, "Lift", (0.0, 0.0, 0.15), 0.8, sponge, hold=0.5)
    left.hold(right.clock - left.clock, block)


def brush_carried_over_a_stool_and_not_used(s: Stage) -> None:
    """A brush is brought from the table to a stool, laid on it and left there."""
    at_table(s, height=0.72, yaw_deg=126, width=0.9)
    stool = pillar(s, "stool", (0.48, 0.75, 0.5), (0.32, 0.36), "stool")
    tool = s.put("brush", builders.brush(), (0.5, 0.22))
    left = s.left(idle=0.2)
    fetch(left, tool, "+z", 0.9, 1.0, 0.3)
    travel(left, "Lift", (0.0, 0.0, 0.12), 0.7, tool, hold=0.4)
    travel(left, "Carry", (-0.02, 0.53, 0.0), 1.0, tool, hold=0.4)
    travel(left, "Lower", (0.0, 0.0, -0.34), 1.0, tool, stool)
    finish(left, tool, stool, 0.4, 1.1)
