"""Scenes with knives, spatulas, spoons and ladles: cutting, spreading and stirring."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.performer import Hand
from scenes.hands.scene import performer
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.household import builders
from scenes.household.builders import HAFT, scene
from scenes.objects import forms
from scenes.objects.builders import AHEAD, UP, Grip, begin_with, home_again, seize, travel

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


@scene
def cheese_cut_aslant(s: Stage) -> None:
    """A knife that points to the left is lowered on a cheese, saws six times at once, and stays."""
    performer(s, height=0.79, yaw_deg=-9)
    s.table()
    cheese = s.put("cheese", shapes.box(0.16, 0.16, 0.07, "cheese"), (0.66, -0.02))
    right = s.right()
    knife = held_knife(s, right, (0.66, -0.02), 0.07 + 0.12, 25.0)
    right.hold(0.5, knife)
    travel(right, "Lower", (0.0, 0.0, -0.12), 0.7, knife, cheese)
    saw(right, knife, cheese, 25.0, 0.045, 1.6, 6)
    right.hold(0.7, knife, cheese)


@scene
def bread_cut_twice_and_steadied(s: Stage) -> None:
    """The left hand steadies a bread; the right hand saws, pauses, saws on and goes up."""
    performer(s, height=0.84, yaw_deg=146, size=1.03)
    s.table()
    bread = s.put("bread", shapes.box(0.12, 0.3, 0.11, "bread"), (0.66, 0.05))
    right, left = s.right(), s.left()
    knife = held_knife(s, right, (0.66, -0.03), 0.11 + 0.16, 0.0)
    left.idle(0.2)
    left.reach(bread, "+y", 0.9, up=0.55)
    right.hold(left.clock + 0.2, knife)
    travel(right, "Lower", (0.0, 0.0, -0.16), 0.9, knife, bread)
    right.hold(0.5, knife, bread)
    saw(right, knife, bread, 0.0, 0.06, 1.0, 3)
    right.hold(0.6, knife, bread)
    saw(right, knife, bread, 0.0, 0.06, 1.3, 4)
    right.hold(0.4, knife, bread)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, knife)
    right.hold(0.6, knife)
    left.hold(right.clock - left.clock, bread)


@scene
def sausage_cut_by_the_left_hand(s: Stage) -> None:
    """A left-handed child brings a knife down on a sausage, saws slowly, and keeps it there."""
    performer(s, height=0.55, yaw_deg=-73, size=0.82, agent="child")
    s.table()
    sausage = s.put("sausage", shapes.box(0.05, 0.26, 0.05, "sausage"), (0.6, 0.1))
    left = s.left()
    knife = held_knife(s, left, (0.6, 0.08), 0.05 + 0.1, -15.0)
    left.hold(0.6, knife)
    travel(left, "Lower", (0.0, 0.0, -0.1), 0.9, knife, sausage)
    left.hold(0.4, knife, sausage)
    saw(left, knife, sausage, -15.0, 0.05, 0.7, 3)
    left.hold(0.5, knife, sausage)


@scene
def knife_laid_on_a_loaf_and_taken_off(s: Stage) -> None:
    """A knife is lowered on a loaf, rests there for two seconds without a stroke, and goes up."""
    performer(s, height=0.72, yaw_deg=201)
    s.table()
    loaf = s.put("loaf", shapes.box(0.12, 0.24, 0.1, "loaf"), (0.66, -0.1))
    right = s.right()
    knife = held_knife(s, right, (0.66, -0.1), 0.1 + 0.14, 8.0)
    right.hold(0.4, knife)
    travel(right, "Lower", (0.0, 0.0, -0.14), 1.0, knife, loaf)
    right.hold(2.0, knife, loaf)
    travel(right, "Lift", (0.0, 0.0, 0.16), 0.9, knife)
    right.hold(0.5, knife)


@scene
def cake_spread_with_a_spatula(s: Stage) -> None:
    """A flat spatula is lowered on a cake and goes to and fro across its own length."""
    performer(s, height=0.77, yaw_deg=39, size=0.97)
    s.table()
    cake = s.put("cake", shapes.box(0.24, 0.24, 0.08, "cake"), (0.68, -0.08))
    blade = shapes.block((0.12, -0.02, -0.002), (0.32, 0.02, 0.002))
    handle = shapes.block((0.0, -0.01, -0.002), (0.13, 0.01, 0.02))
    form = shapes.Form("spatula", (handle, blade))
    tool = s.put("spatula", form, (0.44, -0.08, s.height + 0.08 + 0.13 + 0.002))
    right = s.right()
    begin_with(right, tool, HAFT)
    right.hold(0.5, tool)
    travel(right, "Lower", (0.0, 0.0, -0.13), 0.8, tool, cake)
    right.hold(0.4, tool, cake)
    right.swing((0.0, 0.06, 0.0), 1.1, 5)
    right.step("Wipe", tool, cake)
    right.hold(0.4, tool, cake)
    travel(right, "Lift", (0.0, 0.0, 0.15), 0.8, tool)
    right.hold(0.5, tool)


@scene
def cup_stirred_to_and_fro(s: Stage) -> None:
    """The right hand lowers a spoon into a mug that the left hand holds, and stirs to and fro."""
    performer(s, height=0.75, yaw_deg=-140)
    s.table()
    mug = s.put("mug", shapes.vessel(0.055, 0.11, "mug"), (0.5, -0.05))
    spoon = s.put("spoon", builders.tall_spoon(0.24), (0.5, -0.05, s.height + 0.185))
    right, left = s.right(GRIPPED), s.left()
    right.begin_at(spoon, "+z", up=1.0, fingers=AHEAD)
    right.take(spoon)
    left.idle(0.2)
    left.reach(mug, "+y", 0.9, up=0.6, aside=(0.0, 0.0, 0.0))
    right.hold(left.clock + 0.3, spoon)
    travel(right, "Lower", (0.0, 0.0, -0.18), 0.9, spoon, mug)
    right.hold(0.4, spoon, mug)
    right.swing((0.028, 0.0, 0.0), 1.8, 6)
    right.step("Stir", spoon, mug)
    right.hold(0.5, spoon, mug)
    left.hold(right.clock - left.clock, mug)


@scene
def bowl_on_the_palm_stirred(s: Stage) -> None:
    """A bowl lies on the left palm in the air; the right hand stirs in it and lifts the spoon."""
    performer(s, height=0.7, yaw_deg=76, size=1.04)
    s.table()
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
    travel(right, "Lift", (0.0, 0.0, 0.18), 0.9, spoon)
    right.hold(0.5, spoon)
    left.hold(right.clock, dish)


@scene
def ladle_in_a_pot_stirred_and_taken_out(s: Stage) -> None:
    """A ladle that stands in a pot is taken, stirs five rounds slowly, and is lifted out."""
    performer(s, height=0.66, yaw_deg=-31, size=0.94, agent="old_man")
    s.table()
    pot = s.put("pot", forms.pot(0.14, 0.13), (0.52, -0.06))
    tool = s.put("ladle", builders.soup_ladle(), (0.55, -0.06, s.height + 0.006))
    right = s.right(shapes.gripping_hand(0.06, 0.04))
    right.idle(0.25)
    seize(right, tool, Grip((-0.02, 0.0, 0.3), UP, AHEAD), 1.2, hold=0.5)
    right.circle(0.035, 0.8, 5)
    right.step("Stir", tool, pot)
    right.hold(0.6, tool, pot)
    travel(right, "Lift", (0.0, 0.0, 0.26), 1.2, tool)
    right.hold(0.9, tool)


@scene
def spoon_stood_in_a_pot_without_stirring(s: Stage) -> None:
    """A spoon is lowered into a pot, held upright in it for two seconds, and let go of."""
    performer(s, height=0.81, yaw_deg=112)
    s.table()
    pot = s.put("pot", forms.pot(0.1, 0.14), (0.55, 0.12))
    spoon = s.put("spoon", builders.tall_spoon(0.32), (0.55, 0.12, s.height + 0.226))
    left = s.left(GRIPPED)
    left.begin_at(spoon, "+z", up=1.0, fingers=AHEAD)
    left.take(spoon)
    left.hold(0.5, spoon)
    travel(left, "Lower", (0.0, 0.0, -0.22), 1.0, spoon, pot)
    left.hold(2.0, spoon, pot)
    home_again(left, 1.0)
