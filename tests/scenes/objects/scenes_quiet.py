"""Scenes in which nothing is moved: furniture is touched or leant on, hands pass near things."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.stage import Stage
from scenes.objects import forms
from scenes.objects.builders import (
    UP,
    apple,
    cabinet,
    crate,
    home_again,
    pillar,
    scene,
    shelf,
    wall,
)


@scene
def lean_on_the_table(s: Stage) -> None:
    """Both palms are laid on the table, stay for three seconds and are taken away."""
    performer(s, yaw_deg=-60)
    table = s.table(depth=0.6)
    hands = [s.right(), s.left()]
    for hand, aside in zip(hands, (-0.25, 0.25), strict=True):
        hand.idle(0.2)
        hand.reach(table, "+z", 0.9, up=1.0, aside=(-0.1, aside, 0.0))
        hand.hold(3.0, table)
        home_again(hand, 0.9)


@scene
def lean_on_a_wall(s: Stage) -> None:
    """The left palm leans on a wall for two seconds; an apple lies on the table."""
    performer(s, height=0.8, yaw_deg=40, size=1.06)
    s.table()
    apple(s, (0.5, -0.3))
    behind = wall(s, 0.75)
    left = s.left()
    left.idle(0.2)
    left.reach(behind, "-x", 1.0, up=0.8, fingers=UP, aside=(0.0, 0.2, 0.0))
    left.hold(2.0, behind)
    home_again(left, 1.0)


@scene
def touch_a_shelf_from_below(s: Stage) -> None:
    """The palm is put to a shelf from below and stays there."""
    performer(s, height=0.6, yaw_deg=150)
    board = shelf(s, (0.55, -0.15, 1.15))
    right = s.right()
    right.idle(0.2)
    right.reach(board, "-z", 1.1, up=0.0)
    right.hold(1.0, board)


@scene
def touch_a_cabinet(s: Stage) -> None:
    """The palm lies on top of a cabinet whose drawer is shut, and goes home."""
    performer(s, height=0.7, yaw_deg=-15, size=0.96)
    s.table()
    chest = cabinet(s, (0.6, 0.1, s.height + 0.012))
    left = s.left()
    left.idle(0.2)
    left.reach(chest.body, "+z", 1.0, up=1.0, aside=(-0.05, 0.0, 0.0))
    left.hold(0.8, chest.body)
    home_again(left, 1.0)


@scene
def touch_a_stool(s: Stage) -> None:
    """A child lays the left hand on a stool for a quarter of a second."""
    performer(s, height=0.4, yaw_deg=105, size=0.76, agent="child")
    stool = pillar(s, "stool", (0.4, 0.1, 0.4), (0.3, 0.3), "stool")
    left = s.left()
    left.idle(0.15)
    left.reach(stool, "+z", 0.7, up=1.0)
    left.hold(0.25, stool)
    left.leave(0.7)
    left.idle(0.15)


@scene
def past_a_pot(s: Stage) -> None:
    """The hand goes past a pot with a lid, six centimetres from its side, and touches nothing."""
    performer(s, yaw_deg=85)
    s.table()
    s.put("pot", forms.pot(), (0.62, 0.0))
    s.put("lid", forms.round_lid(0.112), (0.62, 0.0, s.height + 0.12))
    right = s.right(home=(0.3, -0.35, s.height + 0.12))
    right.idle(0.2)
    right.go((0.3, 0.3, s.height + 0.14), 1.3)
    right.idle(0.2)


@scene
def over_a_crate_and_back(s: Stage) -> None:
    """The hand goes over the opening of a crate, rests there for a second, and goes home."""
    performer(s, height=0.76, yaw_deg=-120)
    s.table()
    crate(s, (0.6, -0.1))
    apple(s, (0.6, -0.1, s.height + 0.008))
    right = s.right(home=(0.12, -0.28, s.height + 0.25))
    right.idle(0.2)
    right.go((0.58, -0.1, s.height + 0.24), 1.0)
    right.rest(1.0)
    right.go(None, 1.0)
    right.idle(0.2)


@scene
def into_a_crate_and_out(s: Stage) -> None:
    """The hand is put into a large crate, rests in it without touching, and is taken out."""
    performer(s, height=0.65, yaw_deg=25, size=1.02)
    s.table()
    s.put("crate", forms.open_box(0.5, 0.5, 0.2, "crate"), (0.62, 0.05))
    left = s.left(home=(0.55, 0.1, s.height + 0.4))
    left.idle(0.2)
    left.go((0.55, 0.1, s.height + 0.12), 0.9)
    left.rest(0.9)
    left.go(None, 0.9)
    left.idle(0.2)


@scene
def apple_kept_in_the_air(s: Stage) -> None:
    """An apple is held still above a bowl from the first frame to the last."""
    performer(s, yaw_deg=-5)
    s.table()
    s.put("bowl", shapes.vessel(0.12, 0.07, "bowl"), (0.55, -0.1))
    fruit = apple(s, (0.55, -0.1, s.height + 0.2))
    right = s.right()
    right.begin_at(fruit, "-y", up=0.5, fingers=(1.0, 0.0, 0.0))
    right.take(fruit)
    right.hold(3.0, fruit)


@scene
def hands_rest_beside_furniture(s: Stage) -> None:
    """Both hands rest in the air before a cabinet and a bowl with an apple in it."""
    performer(s, height=0.82, yaw_deg=135)
    s.table()
    cabinet(s, (0.65, 0.25, s.height + 0.012))
    s.put("bowl", shapes.vessel(0.12, 0.07, "bowl"), (0.5, -0.25))
    apple(s, (0.5, -0.25, s.height + 0.005))
    for hand in (s.right(), s.left()):
        hand.rest(2.5)
