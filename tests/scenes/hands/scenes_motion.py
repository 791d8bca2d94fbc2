"""Scenes in which a held thing is turned, tilted, poured, shaken, stirred or drunk from."""

from dataclasses import replace

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import AHEAD, UP
from scenes.hands.performer import PRESS, Hand, travel
from scenes.hands.scene import at_table, performer
from scenes.hands.scenes_place import cup, fetch, finish
from scenes.hands.stage import Stage


def turn_in_the_air(s: Stage) -> None:
    """A mug is lifted, held, turned by eighty degrees about its upright axis and kept."""
    at_table(s, yaw_deg=77)
    mug = cup(s, (0.5, -0.05))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, mug, hold=0.5)
    right.spin((0.5, -0.05, 0.0), UP, 80.0, 1.1)
    right.step("Turn", mug)
    right.hold(0.6, mug)


def tilt_in_the_air(s: Stage) -> None:
    """A box is lifted, held, tilted by fifty degrees to the left and kept so."""
    at_table(s, height=0.82, yaw_deg=-33)
    box = s.put("box", shapes.box(0.1, 0.08, 0.14), (0.5, -0.1))
    right = s.right(idle=0.2)
    fetch(right, box, "-y", 0.9, 0.6, 0.4)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.9, box, hold=0.5)
    right.spin((0.5, -0.1, s.height + 0.3), AHEAD, -50.0, 1.0)
    right.step("Tilt", box)
    right.hold(0.7, box)


def pour_into_a_bowl(s: Stage) -> None:
    """A bottle is lifted, tipped over a bowl and back, and put down."""
    table, flask = at_table(s, yaw_deg=-12), s.put("bottle", shapes.bottle(), (0.5, -0.2))
    s.put("bowl", shapes.vessel(0.085, 0.06, "bowl"), (0.5, -0.02))
    right = s.right(idle=0.2)
    fetch(right, flask, "-y", 0.9, 0.4, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, flask, hold=0.4)
    right.dip((0.5, -0.2, s.height + 0.28), AHEAD, -105.0, 1.8)
    right.step("Pour", flask)
    right.hold(0.4, flask)
    travel(right, "Lower", (0.0, 0.0, -0.2), 0.9, flask, table)
    finish(right, flask, table, 0.3, 0.9)


def shake_a_bottle(s: Stage) -> None:
    """A bottle is lifted, shaken up and down six times and put back."""
    performer(s, height=0.95, yaw_deg=175, size=1.04)
    table, flask = s.table(), s.put("bottle", shapes.bottle(), (0.55, -0.15))
    right = s.right(idle=0.2)
    fetch(right, flask, "-y", 0.9, 0.4, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.8, flask, hold=0.5)
    right.swing((0.0, 0.0, 0.04), 3.0, 6)
    right.step("Shake", flask)
    right.hold(0.5, flask)
    travel(right, "Lower", (0.0, 0.0, -0.22), 0.9, flask, table)
    finish(right, flask, table, 0.3, 0.9)


def stir_in_a_bowl(s: Stage) -> None:
    """A spoon held above a bowl is lowered to its bottom and goes round four times."""
    at_table(s, yaw_deg=65)
    bowl = s.put("bowl", shapes.vessel(0.1, 0.07, "bowl"), (0.5, -0.1))
    spoon = s.put("spoon", shapes.rod(0.22, 0.005), (0.53, -0.1, s.height + 0.155))
    right = s.right(shapes.gripping_hand(0.05, 0.04))
    right.begin_at(spoon, "+z", up=1.0, fingers=AHEAD)
    right.take(spoon)
    right.hold(0.5, spoon)
    travel(right, "Lower", (0.0, 0.0, -0.15), 0.8, spoon, bowl, hold=0.3)
    right.circle(0.035, 1.2, 4)
    right.step("Stir", spoon, bowl)
    right.hold(0.6, spoon, bowl)


def drink_from_a_mug(s: Stage) -> None:
    """A mug is taken to the mouth, drunk from, and put back on the table."""
    performer(s, height=0.74, yaw_deg=-15)
    right = drink(s, hold=0.3, tilt_deg=40.0)
    steps = list(right.steps)
    steps[-3] = replace(steps[-3], name="PutDown")
    right.alternative = tuple(steps)


def drink_quickly(s: Stage) -> None:
    """A tall woman drinks without holding still before she lifts the mug."""
    performer(s, height=0.92, yaw_deg=125, size=1.05, agent="tall_woman")
    drink(s, hold=0.0, tilt_deg=50.0)


def drink(s: Stage, *, hold: float, tilt_deg: float) -> Hand:
    """Reach a mug, take it to the mouth, drink and put it back."""
    table, head = s.table(), s.head()
    start = (0.5, -0.1, s.height)
    mug = cup(s, start)
    right = s.right(idle=0.2)
    right.reach(mug, "-y", 0.9, up=0.6, along=-0.025)
    if hold:
        right.hold(hold, mug)
    right.take(mug)
    face = head.body.first[:3, 3] + (0.095 * s.size, 0.0, 0.0)
    goal = np.add(face, (0.042 - PRESS, 0.0, -0.1))
    travel(right, "MoveObjTo", goal - start, 1.1, mug, head, arrive=0.12)
    right.dip(face, (0.0, 1.0, 0.0), -tilt_deg, 1.2)
    right.step("Drink", mug, head)
    travel(right, "MoveObjTo", start - goal, 1.1, mug, table, depart=0.12)
    finish(right, mug, table, 0.5, 0.9)
    return right
