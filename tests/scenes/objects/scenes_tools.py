"""Scenes in which a held tool acts on a thing: hammer, knife, spoon, cloth, broom, ladle."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import AHEAD, NEAR, UP
from scenes.hands.performer import Hand, travel
from scenes.hands.scene import at_table, performer
from scenes.hands.scenes_place import fetch, finish
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.objects import forms
from scenes.objects.builders import Grip, begin_with, floor, home_again, seize, toy

END = Grip((0.0, 0.0, 0.0), NEAR, UP)
"""The end of a handle that lies along x from its origin."""

SLOWING = 3.0
"""Deceleration of a puck that slides on a table [m/s2]."""


def _board_and_nail(s: Stage) -> Thing:
    """A nail that stands in a board on the table; both are fast."""
    s.put("board", shapes.box(0.3, 0.3, 0.04, "board"), (0.72, -0.1), tag="fixed")
    return s.put("nail", forms.nail(), (0.72, -0.1, s.height + 0.04), tag="fixed")


def held_hammer(s: Stage, hand: Hand) -> Thing:
    """A hammer in the hand from the first frame, its head three centimetres over the nail."""
    tool = s.put("hammer", forms.hammer(), (0.475, -0.1, s.height + 0.04 + 0.05 + 0.05 + 0.03))
    begin_with(hand, tool, END)
    return tool


def strike(hand: Hand, tool: Thing, nail: Thing, *, down: float, hold: float) -> None:
    """Bring a hammer down on a nail at more than a metre a second, and stay."""
    travel(hand, "Hit", (0.0, 0.0, -down), 0.35, tool, nail, arrive=1.1)
    hand.hold(hold, tool, nail)


def nail_hit_once(s: Stage) -> None:
    """A hammer that is held in the air is raised and hits a nail once."""
    at_table(s, yaw_deg=30)
    nail, right = _board_and_nail(s), s.right()
    tool = held_hammer(s, right)
    right.hold(0.5, tool)
    travel(right, "Raise", (0.0, 0.0, 0.17), 0.7, tool)
    strike(right, tool, nail, down=0.2, hold=0.8)


def nail_hit_twice(s: Stage) -> None:
    """A left-handed carpenter hits a nail twice, with half a second on it between."""
    at_table(s, height=0.9, yaw_deg=-125, size=1.06, agent="carpenter")
    nail, left = _board_and_nail(s), s.left()
    tool = held_hammer(s, left)
    left.hold(0.6, tool)
    travel(left, "Raise", (0.0, 0.0, 0.17), 0.7, tool)
    strike(left, tool, nail, down=0.2, hold=0.5)
    travel(left, "Lift", (0.0, 0.0, 0.2), 0.7, tool)
    strike(left, tool, nail, down=0.2, hold=0.6)


def nail_only_touched_with_a_hammer(s: Stage) -> None:
    """A hammer is lowered gently on a nail and kept there."""
    at_table(s, height=0.7, yaw_deg=80)
    nail, right = _board_and_nail(s), s.right()
    tool = held_hammer(s, right)
    right.hold(0.4, tool)
    travel(right, "Raise", (0.0, 0.0, 0.15), 0.8, tool, hold=0.5)
    travel(right, "Lower", (0.0, 0.0, -0.18), 1.6, tool, nail, hold=0.8)


def loaf_and_knife(s: Stage, hand: Hand) -> tuple[Thing, Thing]:
    """A loaf on the table, and a knife in the hand with its edge fifteen centimetres over it."""
    loaf = s.put("loaf", shapes.box(0.1, 0.22, 0.1, "loaf"), (0.7, 0.0))
    knife = s.put("knife", forms.knife(), (0.47, 0.0, s.height + 0.1 + 0.15 + 0.02))
    begin_with(hand, knife, END)
    return loaf, knife


def loaf_cut(s: Stage) -> None:
    """A knife is lowered on a loaf, rests there, saws to and fro four times, and stays."""
    at_table(s, yaw_deg=-50)
    right = s.right()
    loaf, knife = loaf_and_knife(s, right)
    right.hold(0.5, knife)
    travel(right, "Lower", (0.0, 0.0, -0.15), 0.8, knife, loaf, hold=0.4)
    right.swing((0.05, 0.0, 0.0), 1.2, 4)
    right.step("Cut", knife, loaf)
    right.hold(0.5, knife, loaf)


def loaf_cut_quickly(s: Stage) -> None:
    """The left hand saws as soon as the knife is on the loaf, and takes the knife up again."""
    at_table(s, height=0.92, yaw_deg=160, size=1.04)
    left = s.left()
    loaf, knife = loaf_and_knife(s, left)
    left.hold(0.4, knife)
    travel(left, "Lower", (0.0, 0.0, -0.15), 0.6, knife, loaf)
    left.swing((0.04, 0.0, 0.0), 2.0, 5)
    left.step("Cut", knife, loaf)
    travel(left, "Lift", (0.0, 0.0, 0.18), 0.7, knife, hold=0.5)


def pot_stirred(s: Stage) -> None:
    """A spoon that stands in a pot in the hand goes round five times, and is taken out."""
    at_table(s, height=0.85, yaw_deg=-10)
    pot = s.put("pot", forms.pot(), (0.5, -0.1))
    spoon = s.put("spoon", shapes.rod(0.26, 0.005), (0.54, -0.1, s.height + 0.206))
    right = s.right(shapes.gripping_hand(0.05, 0.04))
    right.begin_at(spoon, "+z", up=1.0, fingers=AHEAD)
    right.take(spoon)
    right.hold(0.4, spoon)
    travel(right, "Lower", (0.0, 0.0, -0.2), 0.9, spoon, pot, hold=0.4)
    right.circle(0.04, 1.0, 5)
    right.step("Stir", spoon, pot)
    right.hold(0.3, spoon, pot)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.9, spoon, hold=0.6)


def pot_stirred_and_steadied(s: Stage) -> None:
    """The left hand stirs quickly while the right hand lies on the pot's side."""
    at_table(s, height=0.75, yaw_deg=120, size=0.96)
    pot = s.put("pot", forms.pot(), (0.5, 0.05))
    spoon = s.put("spoon", shapes.rod(0.28, 0.005), (0.535, 0.05, s.height + 0.176))
    left, right = s.left(shapes.gripping_hand(0.05, 0.04)), s.right()
    left.begin_at(spoon, "+z", up=1.0, fingers=AHEAD)
    left.take(spoon)
    left.hold(0.5, spoon)
    travel(left, "Lower", (0.0, 0.0, -0.17), 0.8, spoon, pot)
    left.circle(0.035, 1.6, 5)
    left.step("Stir", spoon, pot)
    left.hold(0.8, spoon, pot)
    right.idle(0.2)
    right.reach(pot, "-y", 0.9, up=0.6)
    right.hold(left.clock - right.clock, pot)


def board_wiped(s: Stage) -> None:
    """A cloth is taken from the table, put on a board and wiped to and fro on it."""
    at_table(s, yaw_deg=210)
    board = s.put("board", shapes.box(0.4, 0.5, 0.04, "board"), (0.6, 0.3), tag="fixed")
    cloth = s.put("cloth", shapes.box(0.2, 0.16, 0.015, "cloth"), (0.5, -0.3))
    right = s.right(idle=0.2)
    fetch(right, cloth, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(cloth, board, up=0.2, by=(0.08, 0.55), down=0.16)
    right.hold(0.4, cloth, board)
    right.swing((0.0, 0.1, 0.0), 1.2, 4)
    right.step("Wipe", cloth, board)
    finish(right, cloth, board, 0.4, 1.0)


def table_wiped_in_circles(s: Stage) -> None:
    """A cloth goes round on the table under the left hand, at once on contact."""
    performer(s, height=0.66, yaw_deg=-35, size=0.9, agent="girl")
    table, cloth = s.table(), s.put("cloth", shapes.box(0.2, 0.16, 0.015, "cloth"), (0.55, 0.1))
    left = s.left(idle=0.15)
    left.reach(cloth, "+z", 0.8, up=1.0)
    left.take(cloth)
    left.circle(0.08, 1.0, 4)
    left.step("Wipe", cloth, table)
    left.hold(0.5, cloth, table)
    home_again(left, 0.8)


def pointed(s: Stage, hand: Hand, far: float) -> tuple[Thing, Thing]:
    """A stick held in the air, its tip so far from a block on the table [m]."""
    block = toy(s, (0.75, -0.05), size=0.12)
    tool = s.put("stick", forms.stick(), (0.75 - 0.06 - far - 0.3, -0.05, s.height + 0.06))
    begin_with(hand, tool, END)
    return block, tool


def block_pushed_with_a_stick(s: Stage) -> None:
    """A stick meets a block and pushes it on without a halt."""
    at_table(s, yaw_deg=65)
    right = s.right()
    block, tool = pointed(s, right, 0.15)
    right.hold(0.5, tool)
    travel(right, "MoveObjTo", (0.15, 0.0, 0.0), 0.9, tool, block, arrive=0.25)
    right.take_along(tool, block)
    travel(right, "Push", (0.18, 0.0, 0.0), 1.0, tool, block, depart=0.25)
    right.hold(0.7, tool, block)


def block_touched_with_a_stick(s: Stage) -> None:
    """A stick is brought to a block, kept on it for a second, and drawn back."""
    at_table(s, height=0.95, yaw_deg=-155, size=1.07)
    left = s.left()
    block, tool = pointed(s, left, 0.12)
    left.hold(0.6, tool)
    travel(left, "MoveObjTo", (0.12, 0.0, 0.0), 0.9, tool, block, hold=1.0)
    travel(left, "Carry", (-0.15, 0.0, 0.0), 0.9, tool, hold=0.5)


def block_swept_with_a_broom(s: Stage) -> None:
    """A broom held over the floor is brought to a block and, after a pause, sweeps it away."""
    performer(s, height=0.74, yaw_deg=95)
    floor(s)
    block = toy(s, (0.75, -0.15, 0.0), size=0.16)
    tool = s.put("broom", forms.broom(), (0.45, -0.15, 0.05))
    right = s.right()
    begin_with(right, tool, Grip((-0.012, 0.0, 0.9), NEAR, UP))
    right.hold(0.5, tool)
    travel(right, "MoveObjTo", (0.19, 0.0, 0.0), 0.9, tool, block, hold=0.4)
    right.take_along(tool, block)
    travel(right, "Push", (0.3, 0.0, 0.0), 1.2, tool, block, hold=0.5)


def puck_struck_with_a_stick(s: Stage) -> None:
    """The side of a stick strikes a puck, which slides away over the table."""
    performer(s, yaw_deg=-100)
    s.contact_minimum_s = 0.0
    s.table()
    puck = toy(s, (0.7, -0.05), "puck", 0.1)
    tool = s.put("stick", forms.stick(), (0.42, -0.05 - 0.062 - 0.25, s.height + 0.065))
    right = s.right()
    begin_with(right, tool, END)
    right.hold(0.5, tool)
    travel(right, "Hit", (0.0, 0.25, 0.0), 0.4, tool, puck, arrive=1.1)
    speed, start = 0.9, right.clock

    def slide(since: np.ndarray) -> np.ndarray:
        early = np.clip(since, 0.0, speed / SLOWING)
        return np.outer(speed * early - SLOWING * early**2 / 2.0, (0.0, 1.0, 0.0))

    puck.body.shift(start, start + speed / SLOWING, slide)
    puck.free.append((start, start + speed / SLOWING))
    right.hold(0.9, tool)


def ladle_from_a_pot_to_a_bowl(s: Stage) -> None:
    """A ladle is taken out of a pot, carried over a bowl, emptied into it and kept there."""
    at_table(s, height=0.7, yaw_deg=0, size=1.02)
    s.put("pot", forms.pot(), (0.5, -0.25))
    s.put("bowl", shapes.vessel(0.1, 0.06, "bowl"), (0.55, 0.3))
    tool = s.put("ladle", forms.ladle(), (0.5, -0.25, s.height + 0.006))
    right = s.right(shapes.gripping_hand(0.06, 0.04), idle=0.2)
    seize(right, tool, Grip((-0.02, 0.0, 0.28), UP, AHEAD), 1.0, hold=0.3)
    travel(right, "Lift", (0.0, 0.0, 0.25), 1.0, tool, hold=0.4)
    travel(right, "Carry", (0.05, 0.48, 0.0), 1.3, tool, hold=0.4)
    right.dip((0.55, 0.23, s.height + 0.27), AHEAD, -95.0, 1.8)
    right.step("Pour", tool)
    right.hold(0.6, tool)
