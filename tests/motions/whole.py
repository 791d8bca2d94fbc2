"""A whole person: feet that walk, stand and kick on a floor, and hands that meet each other."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Unpack

import numpy as np
import trimesh

from capar.model.capture import Role, Shape, TagType
from motions import figure, shapes
from motions.encounters import Kicked
from motions.paths import Move, Moves, Path, Riding, Still, Vector, aimed, pose
from motions.performers import Performer
from motions.trials import Body, Options, Sampling, Script, Trial, Truth, record

FOOT = (0.26, 0.10, 0.08)
HEEL_LENGTH = 0.17
"""Length of the rear part of a foot, up to the ball [m]; the toes take the rest."""

BEGIN_S, STEP_S, SWING_S = 0.8, 0.65, 0.55
"""When the first step begins, from one step to the next, and how long a foot takes [s]."""

TOE_OFF_S, TOE_ON_S = 0.08, 0.06
"""How much later than the heel the toes leave the floor, and come down on it [s]."""

BALL = 0.11
LEFT, RIGHT = "left", "right"
SPREAD = {RIGHT: -1.0, LEFT: 1.0}


@dataclass(frozen=True)
class Stride:
    """One step of one foot along the way."""

    side: str
    begin_s: float
    end_s: float
    from_m: float
    to_m: float


def strides(performer: Performer, count: int, *, length_m: float) -> tuple[Stride, ...]:
    """Steps in turn, the right foot first; the last one closes up beside the other foot."""
    places = {RIGHT: 0.0, LEFT: 0.0}
    out = []
    for index in range(count):
        side = (RIGHT, LEFT)[index % 2]
        ahead = length_m * min(index + 1, count - 1)
        begin = BEGIN_S + index * STEP_S * performer.pace
        out.append(Stride(side, begin, begin + SWING_S * performer.pace, places[side], ahead))
        places[side] = ahead
    return tuple(out)


def walk(
    performer: Performer, *, parts: bool = False, length: float = 0.3, **options: Unpack[Options]
) -> Trial:
    """Five steps in turn over a floor, and standing before and after.

    Args:
        performer: Who walks.
        parts: Whether heel and toes are tracked one by one, or each foot as one.
        length: Of a step, as a share of the stature [1]; none is treading on the spot.
        options: How it is recorded.
    """
    taken = strides(performer, 5, length_m=length * performer.stature_m)
    end = taken[-1].end_s + 0.9
    names = {
        "right_foot": ("Stand", "Walk") * 3 + ("Stand",),
        "left_foot": ("Stand", "Walk") * 2 + ("Stand",),
    }
    bodies = [
        body
        for side in (RIGHT, LEFT)
        for body in (_parts if parts else _whole)(performer, side, taken)
    ]
    truth = Truth(end, (), {"extended": names}, {})
    script = Script("walk", performer, truth, (*bodies, _floor()))
    return record(script, Sampling(**options))


def stand_and_kick(performer: Performer, **options: Unpack[Options]) -> Trial:
    """The weight goes over from both feet to the left one; the right one kicks a ball."""
    aside = 0.06 * performer.stature_m
    left, right = pose((0.0, aside, 0.0)), pose((0.0, -aside, 0.0))
    back, front = pose((-0.35, -aside, 0.06)), pose((0.55, -aside, 0.06))
    leaves, swings, struck = 1.8, 3.0, 3.3
    through = 2 * struck - swings
    home, end = through + 0.9, through + 2.2
    foot = Moves(
        (
            Move(leaves, leaves + 0.6, right, back, launch_mps2=3.0),
            Move(swings, through, back, front),
            Move(through, home, front, right, halt_mps2=3.0),
        )
    )
    met = 0.1 + FOOT[0] / 2.0 + BALL - 0.001
    ball = Kicked(foot, (met, -aside, BALL), struck, struck + 0.03, 4.0)
    hips = 0.55 * performer.stature_m
    middle, over = pose((0.0, 0.0, hips)), pose((0.0, 0.95 * aside, hips))
    pelvis = Moves((Move(0.5, 1.2, middle, over), Move(home + 0.2, home + 0.9, over, middle)))
    bodies = (
        Body("left_foot", Still(left), shapes.box(*FOOT), link="left_leg"),
        Body("right_foot", foot, shapes.box(*FOOT), link="right_leg"),
        Body("pelvis", pelvis, shapes.box(0.2, 0.3, 0.15), link="spine", role=Role.ATTENDS),
        Body("ball", ball, shapes.ball(BALL), TagType.MOBILE, mass_kg=0.4),
        _floor(),
    )
    names = {
        "left_foot": ("Stand", "StandOnOneLeg", "Stand"),
        "right_foot": (
            "Stand",
            "RestFoot",
            "Withdraw",
            "Kick",
            "ResumePosture",
            "Reach",
            "RestFoot",
            "Stand",
        ),
    }
    truth = Truth(end, (), {"extended": names}, {})
    return record(Script("stand_and_kick", performer, truth, bodies), Sampling(**options))


def clap_freely(performer: Performer, **options: Unpack[Options]) -> Trial:
    """Two hands, neither of them declared as an object, meet palm to palm and part."""
    met, end = 1.2 * performer.pace, 3.2 * performer.pace
    paths = {}
    for name in ("right_hand", "left_hand"):
        out = figure.side(name)
        apart = out * (figure.thickness(performer) - 0.003)
        goal = pose(
            (0.35, apart, 0.7 * performer.stature_m), aimed(x=(1.0, 0.0, 0.0), z=(0.0, out, 0.0))
        )
        paths[name] = Moves(
            (
                figure.reach(performer, name, goal=goal, arrive=(0.05, -0.2 * out, 0.02),
                             start_s=0.1, end_s=met),
                figure.withdraw(performer, name, begin=goal, depart=(-0.05, 0.2 * out, 0.0),
                                start_s=met, end_s=end - 0.8),
            )
        )  # fmt: skip
    bodies = tuple(figure.hand_body(performer, name, path) for name, path in paths.items())
    steps = ("Clap", "ResumePosture")
    truth = Truth(end, (), {"extended": dict.fromkeys(paths, steps)}, {})
    return record(Script("clap_freely", performer, truth, bodies), Sampling(**options))


def touch_own_hand(performer: Performer, **options: Unpack[Options]) -> Trial:
    """The left hand is held out at rest; the right one is laid on its back, stays, and returns."""
    height = 0.6 * performer.stature_m
    held = pose((0.35, 0.0, height), aimed(x=(0.0, -1.0, 0.0), z=(0.0, 0.0, 1.0)))
    met = 1.3 * performer.pace
    leaves, home = met + 0.9, met + 0.9 + 1.2 * performer.pace
    over = figure.thickness(performer) - 0.003
    goal = pose((0.35, 0.0, height + over), aimed(x=(1.0, 0.0, 0.0), z=(0.0, 0.0, 1.0)))
    hand = Moves(
        (
            figure.reach(performer, "right_hand", goal=goal, arrive=(0.03, 0.0, -0.25),
                         start_s=0.2, end_s=met),
            figure.withdraw(performer, "right_hand", begin=goal, depart=(-0.03, 0.0, 0.25),
                            start_s=leaves, end_s=home),
        )
    )  # fmt: skip
    bodies = (
        figure.hand_body(performer, "right_hand", hand),
        figure.hand_body(performer, "left_hand", Still(held)),
    )
    names = {"right_hand": ("Reach", "Touch", "ResumePosture"), "left_hand": ()}
    truth = Truth(home + 0.8, (), {"extended": names}, {})
    return record(Script("touch_own_hand", performer, truth, bodies), Sampling(**options))


def pinch(performer: Performer, *, fingers: bool, **options: Unpack[Options]) -> Trial:
    """Thumb and index finger take a block on a table from above, raise it and hold it.

    Args:
        performer: Who takes it.
        fingers: Whether palm and fingers are tracked one by one, or the hand as one body.
        options: How it is recorded.
    """
    table = performer.table_m
    block = pose((0.5, -0.1, table))
    goal = pose((0.46, -0.1, table + 0.12))
    raised = pose(goal.translation + np.array([0.0, 0.0, 0.25]), goal.rotation)
    met = 1.4 * performer.pace
    lifts, up = met + 0.5, met + 0.5 + 0.9 * performer.pace
    hand = Moves(
        (
            figure.reach(performer, "right_hand", goal=goal, arrive=(0.0, 0.0, -0.25),
                         start_s=0.3, end_s=met),
            Move(lifts, up, goal, raised, launch_mps2=figure.FIRM_MPS2),
        )
    )  # fmt: skip
    grip = pose((0.04, 0.0, -0.12))
    thing = Riding(Still(block), hand, grip, lifts)
    parts = {f"right_{name}": _part(*place) for name, place in PARTS.items()}
    if not fingers:
        parts = {"right_hand": _in_one(*parts.values())}
    bodies = (
        *(Body(name, hand, shape, link="right_arm") for name, shape in parts.items()),
        Body("block", thing, shapes.box(0.04, 0.04, 0.06), TagType.MOBILE, mass_kg=0.1),
        Body("table", Still(pose((0.7, 0.0, table))), shapes.table(0.8, 1.6), TagType.FIXED,
             noisy=False),
    )  # fmt: skip
    names = {"right_hand": ("Reach", "Touch", "Lift", "Touch")}
    truth = Truth(up + 0.8, (), {"extended": names}, {})
    return record(Script("pinch", performer, truth, bodies), Sampling(**options))


PARTS: dict[str, tuple[Vector, Vector]] = {
    "palm": ((0.09, 0.085, 0.03), (-0.055, 0.0, -0.015)),
    "thumb": ((0.016, 0.016, 0.08), (0.04, 0.025, -0.07)),
    "index": ((0.016, 0.016, 0.08), (0.04, -0.025, -0.07)),
    "middle": ((0.08, 0.016, 0.016), (0.045, -0.05, -0.02)),
    "ring": ((0.08, 0.016, 0.016), (0.045, -0.07, -0.02)),
    "pinky": ((0.08, 0.016, 0.016), (0.045, -0.09, -0.02)),
}
"""Lengths of the parts of a hand about to pinch, and where their middles are in its frame [m]."""


def _in_one(*parts: Shape) -> Shape:
    """Shapes in one frame as one shape."""
    counts = np.cumsum([0, *(len(each.vertices) for each in parts)])
    faces = [each.faces + start for each, start in zip(parts, counts, strict=False)]
    vertices = np.concatenate([each.vertices for each in parts])
    return Shape(vertices, np.concatenate(faces), description="hand in one")


def _part(size: Vector, middle: Vector) -> Shape:
    mesh = trimesh.creation.box(extents=size)
    mesh.apply_translation(middle)
    return shapes.shape(mesh, f"part of {size[0]:g} x {size[1]:g} x {size[2]:g} m")


def _whole(performer: Performer, side: str, taken: Sequence[Stride]) -> list[Body]:
    path = _foot_path(performer, side, taken, 0.0, later_s=(0.0, 0.0))
    return [Body(f"{side}_foot", path, shapes.box(*FOOT), link=f"{side}_leg")]


def _parts(performer: Performer, side: str, taken: Sequence[Stride]) -> list[Body]:
    """Heel and toes, which roll off and on one after the other."""
    toes = FOOT[0] - HEEL_LENGTH
    heel_path = _foot_path(performer, side, taken, -toes / 2.0, later_s=(0.0, 0.0))
    toe_path = _foot_path(performer, side, taken, HEEL_LENGTH / 2.0, later_s=(TOE_OFF_S, TOE_ON_S))
    heel = shapes.box(HEEL_LENGTH - 0.01, FOOT[1], FOOT[2])
    toe = shapes.box(toes - 0.01, FOOT[1], 0.04)
    return [
        Body(f"{side}_heel", heel_path, heel, link=f"{side}_leg"),
        Body(f"{side}_toe", toe_path, toe, link=f"{side}_leg"),
    ]


def _foot_path(
    performer: Performer,
    side: str,
    taken: Sequence[Stride],
    ahead_m: float,
    *,
    later_s: tuple[float, float],
) -> Path:
    aside = SPREAD[side] * 0.06 * performer.stature_m
    lift: Vector = (0.1, 0.0, 0.25)
    lower: Vector = (0.1, 0.0, -0.2)
    return Moves(
        tuple(
            Move(
                each.begin_s + later_s[0], each.end_s + later_s[1],
                pose((each.from_m + ahead_m, aside, 0.0)), pose((each.to_m + ahead_m, aside, 0.0)),
                depart=lift, arrive=lower,
                launch_mps2=figure.FIRM_MPS2, halt_mps2=figure.FIRM_MPS2,
            )
            for each in taken
            if each.side == side
        )
    )  # fmt: skip


def _floor() -> Body:
    where = pose((1.0, 0.0, 0.0))
    return Body("floor", Still(where), shapes.table(8.0, 4.0), TagType.FIXED, noisy=False)


WHOLE: tuple[Callable[..., Trial], ...] = (walk, stand_and_kick, clap_freely, touch_own_hand)
