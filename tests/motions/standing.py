"""Somebody who stands shifts the weight, lifts one foot for a while and sets it down idly."""

from typing import Unpack

import numpy as np

from capar.model.capture import Role, Shape, TagType
from motions import shapes
from motions.paths import Move, Moves, Path, Still, Vector, pose
from motions.performers import Performer
from motions.trials import Body, Meeting, Options, Sampling, Script, Trial, Truth, record

SHIFTS_S, SHIFTED_S = 0.6, 1.2
"""When the pelvis sets off to stand over the left foot, and has come there [s]."""

LIFTS_S, DOWN_S = 2.0, 4.2
"""When the right foot leaves the floor, and is on it again [s]."""

MOVE_S = 0.5
"""How long the foot takes up, and down [s]."""

BACK_S, END_S = 5.0, 6.4
"""When the pelvis sets off to stand between the feet again; the end [s]."""

UP = (0.0, 0.0, 1.0)
FOOT = (0.26, 0.09, 0.08)
"""Length, width and height of the foot of a person of 1.75 m [m]."""


def stand_on_one_leg(performer: Performer, **options: Unpack[Options]) -> Trial:
    """Feet apart, weight on both; all on the left; right up, idly down; weight on both."""
    aside = 0.06 * performer.stature_m
    length, width, height = (each * performer.size for each in FOOT)
    foot = shapes.box(length, width, height)
    left, right = pose((0.0, aside, 0.0)), pose((0.0, -aside, 0.0))
    lifted = pose((0.05, -aside, 0.2))
    steps = Moves(
        (
            Move(LIFTS_S, LIFTS_S + MOVE_S, right, lifted, launch_mps2=3.0),
            Move(DOWN_S - MOVE_S, DOWN_S, lifted, right, halt_mps2=3.0),
        )
    )
    hips = 0.55 * performer.stature_m
    middle, over = pose((0.02, 0.0, hips)), pose((0.02, 0.95 * aside, hips))
    pelvis = Moves(
        (
            Move(SHIFTS_S, SHIFTED_S, middle, over),
            Move(BACK_S, BACK_S + SHIFTED_S - SHIFTS_S, over, middle),
        )
    )
    sole: Vector = (0.0, 0.0, 0.0)
    meetings = (
        Meeting("left_foot", "floor", Still(left), sole, UP),
        Meeting("right_foot", "floor", steps, sole, UP, 0.0, None, LIFTS_S),
        Meeting("right_foot", "floor", steps, sole, UP, 0.0, DOWN_S, None),
    )
    names = {
        "left_foot": ("Stand", "StandOnOneLeg", "Stand"),
        "right_foot": ("Stand", "RestFoot", "Withdraw", "Rest", "Reach", "RestFoot", "Stand"),
    }
    truth = Truth(END_S, meetings, {"extended": names}, {})
    bodies = (
        _foot("left_foot", Still(left), foot),
        _foot("right_foot", steps, foot),
        Body("pelvis", pelvis, shapes.box(0.2, 0.3, 0.15), link="spine", role=Role.ATTENDS),
        Body("floor", Still(pose(np.zeros(3))), shapes.table(2.0, 2.0), TagType.FIXED, noisy=False),
    )
    return record(Script("stand_on_one_leg", performer, truth, bodies), Sampling(**options))


def _foot(name: str, path: Path, shape: Shape) -> Body:
    return Body(name, path, shape, link=f"{name.removesuffix('_foot')}_leg")
