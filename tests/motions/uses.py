"""What people do with a thing in the hand: each a closed form, its steps written beforehand."""

from collections.abc import Callable
from typing import Unpack

import numpy as np

from capar.model.capture import TagType
from motions import figure, shapes
from motions.handled import BLOCK, Leg, Stage, beside, gripped, handle, place
from motions.paths import Still, aimed, pose
from motions.performers import Performer
from motions.trials import Body, Options, Trial

TAKE, LEAVE = ("Reach", "Touch"), ("ResumePosture",)
UP, DOWN = Leg((0.0, 0.0, 0.25)), Leg((0.0, 0.0, -0.25))
LIFTED, LOWERED = (*TAKE, "Lift", "Touch"), ("Touch", "Lower", "TouchWith", *LEAVE)

ROD = (0.016, 0.016, 0.30)
BLADE = (0.40, 0.012, 0.04)


def _bowl(performer: Performer, ahead_m: float) -> Body:
    at = place(performer).translation + np.array([ahead_m, 0.0, 0.0])
    return Body("bowl", Still(pose(at)), shapes.bowl(0.11, 0.09), TagType.MOBILE, mass_kg=0.4)


def carry(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A block is lifted, carried aside in the air, and lowered to the table."""
    legs = (UP, Leg((0.0, 0.35, 0.0)), DOWN)
    return handle(performer, "carry", legs, (*LIFTED, "Carry", *LOWERED), **options)


def tilt(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A block is lifted, leant over by 50 degrees, and held so."""
    legs = (UP, Leg(turn=(0.87, 0.0, 0.0)), Leg(turn=(-0.87, 0.0, 0.0)), DOWN)
    return handle(performer, "tilt", legs, (*LIFTED, "Tilt", "Touch", "Tilt", *LOWERED), **options)


def turn(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A block is lifted, turned about the vertical by 60 degrees, and lowered."""
    legs = (UP, Leg(turn=(0.0, 0.0, 1.05)), DOWN)
    return handle(performer, "turn", legs, (*LIFTED, "Turn", *LOWERED), **options)


def shake(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A block is lifted, shaken, and lowered."""
    legs = (UP, Leg(seconds=2.0, swing=(0.0, 0.06, 0.0)), DOWN)
    return handle(performer, "shake", legs, (*LIFTED, "Shake", *LOWERED), **options)


def wipe(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A block is moved to and fro on the table."""
    legs = (Leg(seconds=2.0, swing=(0.0, 0.10, 0.0)),)
    return handle(performer, "wipe", legs, (*TAKE, "Wipe", "TouchWith", *LEAVE), **options)


def push(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A palm behind a block moves it away over the table."""
    back = aimed(x=(0.0, 0.0, 1.0), z=(-1.0, 0.0, 0.0))
    stage = Stage(shapes.box(*BLOCK), gripped(performer, (-1.0, 0.0, 0.0), back))
    legs = (Leg((0.25, 0.0, 0.0)),)
    return handle(performer, "push", legs, (*TAKE, "Push", "TouchWith", *LEAVE), stage, **options)


def pull(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A hand that has hold of a block's near side draws it nearer over the table."""
    front = aimed(x=(0.0, 0.0, 1.0), z=(-1.0, 0.0, 0.0))
    stage = Stage(shapes.box(*BLOCK), gripped(performer, (-1.0, 0.0, 0.0), front))
    legs = (Leg((-0.1, 0.0, 0.0)),)
    return handle(performer, "pull", legs, (*TAKE, "Pull", "TouchWith", *LEAVE), stage, **options)


def slide(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A palm at a block's side moves it along, neither from behind nor from before."""
    return handle(
        performer,
        "slide",
        (Leg((0.25, 0.0, 0.0)),),
        (*TAKE, "Slide", "TouchWith", *LEAVE),
        **options,
    )


def turn_on_table(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A block is turned about the vertical where it stands."""
    legs = (Leg(turn=(0.0, 0.0, 1.05)),)
    return handle(performer, "turn_on_table", legs, (*TAKE, "Turn", "TouchWith", *LEAVE), **options)


def pour(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A block as a jug is brought over a bowl, leant over it, and set upright again.

    Nobody was found who can, standing in balance (POSSIBLE.md).
    """
    stage = Stage(shapes.box(*BLOCK), beside(performer), (_bowl(performer, 0.3),), kind="jug")
    over = Leg((0.3, 0.0, 0.0))
    legs = (
        UP,
        over,
        Leg(turn=(0.0, 1.7, 0.0)),
        Leg(turn=(0.0, -1.7, 0.0)),
        Leg((-0.3, 0.0, 0.0)),
        DOWN,
    )
    steps = (*LIFTED, "Carry", "Touch", "Pour", "Touch", "Tilt", "Touch", "Carry", *LOWERED)
    return handle(performer, "pour", legs, steps, stage, **options)


def stir(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A rod is lowered into a bowl, moved to and fro in it, and raised again."""
    grip = pose(
        (0.0, -(ROD[1] / 2 - figure.GRIP_DEPTH + figure.thickness(performer)), 0.25),
        beside(performer).rotation,
    )
    stage = Stage(shapes.box(*ROD), grip, (_bowl(performer, 0.0),), held=True, height_m=0.22)
    into = Leg((0.0, 0.0, -0.2))
    legs = (into, Leg(seconds=2.0, swing=(0.05, 0.0, 0.0)), Leg((0.0, 0.0, 0.2)))
    steps = ("Touch", "Lower", "Touch", "Stir", "Touch", "Raise", "Touch")
    return handle(performer, "stir", legs, steps, stage, **options)


def cut(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A blade is lowered on a loaf, drawn to and fro along its length on it, and raised again."""
    out = BLADE[1] / 2 - figure.GRIP_DEPTH + figure.thickness(performer)
    grip = pose((-0.15, -out, 0.02), beside(performer).rotation)
    at = place(performer).translation + np.array([0.13, 0.0, 0.0])
    loaf = Body("loaf", Still(pose(at)), shapes.box(0.08, 0.2, 0.1), TagType.MOBILE, mass_kg=0.5)
    stage = Stage(shapes.box(*BLADE), grip, (loaf,), held=True, height_m=0.3)
    strokes = Leg(seconds=2.0, swing=(0.04, 0.0, 0.0))
    legs = (Leg((0.0, 0.0, -0.2)), strokes, Leg((0.0, 0.0, 0.2)))
    steps = ("Touch", "Lower", "TouchWith", "Cut", "TouchWith", "Lift", "Touch")
    return handle(performer, "cut", legs, steps, stage, **options)


USES: tuple[Callable[..., Trial], ...] = (
    carry, tilt, turn, shake, wipe, push, pull, slide, turn_on_table, pour, stir, cut,
)  # fmt: skip
