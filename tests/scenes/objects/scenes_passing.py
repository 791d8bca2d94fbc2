"""Scenes in which a thing goes from one hand of the performer to the other."""

from scenes.hands import shapes
from scenes.hands.performer import Hand
from scenes.hands.scene import performer
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing
from scenes.objects import forms
from scenes.objects.builders import scene, travel


def handed(giver: Hand, taker: Hand, thing: Thing, *, far: float) -> None:
    """Carry a thing to the other hand, which comes, takes it and keeps it."""
    sign = -1.0 if giver.side == "right" else 1.0
    travel(giver, "Carry", (0.0, -sign * far, 0.0), 0.9, thing)
    giver.clock += 0.35
    taker.idle(0.2)
    side = "+y" if giver.side == "right" else "-y"
    taker.reach(thing, side, giver.clock - 0.2, name="Receive", when=giver.clock)
    giver.hold(taker.clock + 0.5 - giver.clock, thing)
    taker.until(giver.clock)
    giver.leave(1.2, name="Give")
    giver.idle(0.2)
    taker.hold(0.4, thing)
    taker.take(thing)
    giver.alternative = other_names(giver, Give="ResumePosture")
    taker.alternative = other_names(taker, Receive="Reach")


@scene
def ball_passed_and_put_on_a_box(s: Stage) -> None:
    """The right hand gives a ball to the left hand, which lowers it onto a box."""
    performer(s, yaw_deg=35)
    s.table()
    box = s.put("box", shapes.box(0.14, 0.14, 0.1), (0.45, -0.02))
    ball = s.put("ball", shapes.ball(0.06), (0.45, -0.3, s.height + 0.28))
    right, left = s.right(), s.left()
    right.begin_at(ball, "-y", up=0.5, fingers=(1.0, 0.0, 0.0))
    right.take(ball)
    right.hold(0.5, ball)
    handed(right, left, ball, far=0.28)
    travel(left, "Lower", (0.0, 0.0, -0.12), 0.7, ball, box)
    left.hold(0.4, ball, box)


@scene
def ball_passed_through_a_frame(s: Stage) -> None:
    """The left hand passes a ball through a window frame to the right hand, which keeps it."""
    performer(s, height=0.85, yaw_deg=-150, size=1.05)
    s.table()
    s.put("window", forms.frame(0.5, 0.5), (0.5, 0.1), tag="fixed")
    ball = s.put("ball", shapes.ball(0.06), (0.5, 0.36, s.height + 0.25))
    left, right = s.left(home=(0.15, 0.4, s.height + 0.15)), s.right()
    left.begin_at(ball, "+y", up=0.5, fingers=(1.0, 0.0, 0.0))
    left.take(ball)
    left.hold(0.5, ball)
    handed(left, right, ball, far=0.3)
    travel(right, "Carry", (0.0, -0.2, 0.0), 0.6, ball)
    right.hold(left.clock - right.clock, ball)
