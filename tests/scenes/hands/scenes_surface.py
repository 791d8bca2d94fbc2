"""Scenes in which a thing stays on its support while it moves: push, pull, slide, turn, wipe."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import LEFTWARD, RIGHTWARD, UP, min_jerk
from scenes.hands.performer import travel
from scenes.hands.scene import at_table, performer
from scenes.hands.scenes_place import cup
from scenes.hands.stage import Stage


def push_with_the_palm(s: Stage) -> None:
    """A box is pushed away over the table with the palm behind it."""
    table, box = s.table(), s.put("box", shapes.box(0.15, 0.2, 0.14), (0.5, -0.1))
    right = s.right(idle=0.2)
    right.reach(box, "-x", 0.8, fingers=UP, hold=0.4)
    right.take(box)
    travel(right, "Push", (0.3, 0.0, 0.0), 1.0, box, table, hold=0.4)
    right.leave(0.9)
    right.idle(0.2)


def push_with_a_fingertip(s: Stage) -> None:
    """A small box is pushed away with one finger, at once on contact, and left there."""
    performer(s, height=0.95, yaw_deg=70)
    table, box = s.table(), s.put("box", shapes.box(0.09, 0.12, 0.12), (0.5, -0.2))
    right = s.right(shapes.pointing_hand(), idle=0.2)
    right.reach(box, "-x", 0.8, fingers=RIGHTWARD)
    right.take(box)
    travel(right, "Push", (0.25, 0.0, 0.0), 0.9, box, table, hold=0.3)
    right.leave(0.9)
    right.idle(0.2)


def push_twice_with_a_pause(s: Stage) -> None:
    """A carton is pushed, held for half a second, and pushed on; the hand stays until the end."""
    performer(s, yaw_deg=-135, size=1.06)
    table, box = s.table(), s.put("box", shapes.box(0.16, 0.2, 0.16), (0.45, 0.1), yaw_deg=0)
    left = s.left(idle=0.2)
    left.reach(box, "-x", 0.8, fingers=UP, hold=0.3)
    left.take(box)
    for far in (0.18, 0.2):
        travel(left, "Push", (far, 0.0, 0.0), 0.8, box, table, hold=0.5)


def push_a_loaded_carton(s: Stage) -> None:
    """A carton with a ball in it is pushed away; the ball goes along."""
    performer(s, height=0.7, yaw_deg=310)
    table, box = s.table(), s.put("carton", shapes.carton(0.2, 0.24, 0.14), (0.5, -0.05))
    ball = s.put("ball", shapes.ball(0.04), (0.52, -0.02, s.height + 0.046))
    right = s.right(idle=0.2)
    right.reach(box, "-x", 0.8, fingers=UP, hold=0.3)
    right.take(box, ball)
    travel(right, "Push", (0.3, 0.0, 0.0), 1.1, box, table, hold=0.4)
    right.leave(1.0)
    right.idle(0.2)


def pull_by_a_handle(s: Stage) -> None:
    """A box is drawn towards the performer by the handle on its near side."""
    performer(s, yaw_deg=25)
    table, box = s.table(), s.put("box", shapes.drawer_box(0.16, 0.2, 0.16), (0.8, -0.1))
    right = s.right(shapes.gripping_hand(0.04, 0.04), idle=0.2)
    right.reach(box, "-x", 0.9, up=0.6, fingers=RIGHTWARD, hold=0.4)
    right.take(box)
    travel(right, "Pull", (-0.25, 0.0, 0.0), 1.0, box, table, hold=0.4)
    right.leave(0.7)
    right.idle(0.2)


def pull_quickly(s: Stage) -> None:
    """The left hand draws a box near without holding still before."""
    performer(s, height=0.82, yaw_deg=-95)
    table, box = s.table(), s.put("box", shapes.drawer_box(0.12, 0.14, 0.16), (0.75, 0.15))
    left = s.left(shapes.gripping_hand(0.04, 0.04), idle=0.15)
    left.reach(box, "-x", 0.8, up=0.6, fingers=LEFTWARD)
    left.take(box)
    travel(left, "Pull", (-0.22, 0.0, 0.0), 0.7, box, table, hold=0.6)


def slide_from_above(s: Stage) -> None:
    """A hand pressed on a book slides it to the left."""
    performer(s, yaw_deg=180)
    table, book = s.table(), s.put("book", shapes.box(0.24, 0.18, 0.04, "book"), (0.55, -0.25))
    right = s.right(idle=0.2)
    right.reach(book, "+z", 0.9, up=1.0, hold=0.4)
    right.take(book)
    travel(right, "Slide", (0.0, 0.35, 0.0), 1.1, book, table, hold=0.4)
    right.leave(0.9)
    right.idle(0.2)


def slide_and_stay(s: Stage) -> None:
    """A book is slid away at once on contact; the hand stays on it."""
    performer(s, height=0.6, yaw_deg=-25, size=0.9)
    table, book = s.table(), s.put("book", shapes.box(0.24, 0.18, 0.05, "book"), (0.5, 0.2))
    left = s.left(idle=0.2)
    left.reach(book, "+z", 0.9, up=1.0)
    left.take(book)
    travel(left, "Slide", (0.1, -0.3, 0.0), 0.9, book, table, hold=1.0)


def slide_twice(s: Stage) -> None:
    """A book is slid to the left and, after a pause, back to the right."""
    performer(s, yaw_deg=105)
    table, book = s.table(), s.put("book", shapes.box(0.26, 0.2, 0.03, "book"), (0.5, -0.1))
    right = s.right(idle=0.2)
    right.reach(book, "+z", 0.8, up=1.0, hold=0.3)
    right.take(book)
    for far in (0.3, -0.3):
        travel(right, "Slide", (0.0, far, 0.0), 0.9, book, table, hold=0.5)
    right.leave(0.8)
    right.idle(0.2)


def turn_on_the_table(s: Stage) -> None:
    """A mug is turned by seventy degrees where it stands."""
    table, mug = at_table(s, yaw_deg=-70), cup(s, (0.5, -0.05))
    right = s.right(idle=0.2)
    right.reach(mug, "-y", 0.9, up=0.6, hold=0.4)
    right.take(mug)
    right.spin((0.5, -0.05, 0.0), UP, 70.0, 1.1)
    right.step("Turn", mug, table)
    right.hold(0.4, mug, table)
    right.leave(1.0)
    right.idle(0.2)


def wipe_the_table(s: Stage) -> None:
    """A cloth under the hand goes to and fro on the table three times."""
    performer(s, height=0.8, yaw_deg=50)
    table, cloth = s.table(), s.put("cloth", shapes.box(0.28, 0.2, 0.012, "cloth"), (0.52, -0.05))
    right = s.right(idle=0.2)
    right.reach(cloth, "+z", 0.8, up=1.0, hold=0.4)
    right.take(cloth)
    right.swing((0.0, 0.12, 0.0), 1.0, 3)
    right.step("Wipe", cloth, table)
    right.hold(0.4, cloth, table)
    right.leave(0.8)
    right.idle(0.2)


def wipe_quickly(s: Stage) -> None:
    """The left hand wipes to and fro five times and stays on the cloth."""
    performer(s, height=0.9, yaw_deg=-150, size=1.05)
    table, cloth = s.table(), s.put("cloth", shapes.box(0.28, 0.2, 0.015, "cloth"), (0.55, 0.1))
    left = s.left(idle=0.2)
    left.reach(cloth, "+z", 0.8, up=1.0, hold=0.3)
    left.take(cloth)
    left.swing((0.05, 0.07, 0.0), 1.6, 5)
    left.step("Wipe", cloth, table)
    left.hold(0.6, cloth, table)


def roll_a_ball(s: Stage) -> None:
    """A ball rolls away under the palm, which goes twice as far as the ball."""
    performer(s, yaw_deg=-85)
    radius = 0.06
    table = s.table()
    ball = s.put("ball", shapes.ball(radius), (0.48, -0.1, s.height + radius))
    right = s.right(idle=0.2)
    right.reach(ball, "+z", 0.9, up=1.0, along=0.04, hold=0.4)
    far, duration, start = 0.08, 0.9, right.clock
    base = ball.body.at(start)

    def rolled(since: np.ndarray) -> np.ndarray:
        way = far * min_jerk(since / duration)
        out = np.tile(base, (len(way), 1, 1))
        angles = way / radius
        out[:, 0, 0], out[:, 0, 2] = np.cos(angles), np.sin(angles)
        out[:, 2, 0], out[:, 2, 2] = -np.sin(angles), np.cos(angles)
        out[:, 0, 3] += way
        return out

    ball.body.play(start, start + duration, rolled)
    ball.free.append((start, start + duration))
    travel(right, "Roll", (2 * far, 0.0, 0.0), duration, ball, table, hold=0.4)
    right.leave(0.9)
    right.idle(0.2)


def push_with_a_stick(s: Stage) -> None:
    """A stick held in the air is brought to a box, and after a pause pushes it away."""
    at_table(s, yaw_deg=12)
    stick = s.put(
        "stick",
        shapes.Form("stick", (shapes.block((-0.15, -0.012, -0.012), (0.15, 0.012, 0.012)),)),
        (0.45, -0.1, s.height + 0.07),
    )
    box = s.put("box", shapes.box(0.12, 0.16, 0.14), (0.8, -0.1))
    right = s.right()
    right.begin_at(stick, "-x", up=0.5, fingers=UP)
    right.take(stick)
    right.hold(0.5, stick)
    travel(right, "MoveObjTo", (0.14, 0.0, 0.0), 0.7, stick, box, hold=0.4)
    right.take_along(stick, box)
    travel(right, "Push", (0.15, 0.0, 0.0), 0.8, stick, box, hold=0.6)
