"""Short trials for rows of the feature table that the longer ones do not show by themselves."""

from typing import Unpack

import numpy as np
from scipy.spatial.transform import RigidTransform

from capar.model.capture import TagType
from motions import figure, shapes
from motions.paths import Move, Moves, Path, Riding, Still, aimed, pose
from motions.performers import Performer
from motions.trials import Body, Meeting, Options, Sampling, Script, Trial, Truth, record

HAND = "right_hand"
UP = (0.0, 0.0, 1.0)
STAMP = (0.05, 0.05, 0.14)
BOX = (0.22, 0.16, 0.12)
PROFILES = ("thesis", "extended")


def hit(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A flat hand strikes a drum and springs back: Hit, since the user says that force passes."""
    struck = 1.2 * performer.pace
    home = struck + 1.1 * performer.pace
    skin = np.array([0.45, -0.1 + performer.aside_m, performer.table_m])
    place = skin + np.array([0.0, 0.0, figure.thickness(performer) - figure.GRIP_DEPTH])
    goal = pose(place, aimed(x=(1.0, 0.0, 0.0), z=UP))
    hand = Moves(
        (
            figure.reach(performer, HAND, goal=goal, arrive=(0.08, 0.0, -0.3), start_s=0.3,
                         end_s=struck, halt_mps2=figure.FIRM_MPS2),
            figure.withdraw(performer, HAND, begin=goal, depart=(-0.05, 0.0, 0.3),
                            start_s=struck, end_s=home, launch_mps2=figure.FIRM_MPS2),
        )
    )  # fmt: skip
    meeting = Meeting(HAND, "drum", hand, _palm(performer), UP, figure.GRIP_DEPTH, struck, struck)
    truth = Truth(home + 0.2, (meeting,), _steps("Hit", "ResumePosture"), {HAND: (struck,)})
    drum = Body("drum", Still(pose(skin)), shapes.drum(), TagType.FIXED, noisy=False)
    bodies = (figure.hand_body(performer, HAND, hand), drum)
    script = Script("hit", performer, truth, bodies, force_transfer=True)
    return record(script, Sampling(**options))


def touch_with(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A stamp in the hand from the start is set upon a box, and pressed: MoveObjTo, TouchWith."""
    set_down = 0.9 * performer.pace
    top = np.array([0.5, -0.1 + performer.aside_m, performer.table_m + BOX[2]])
    lift = pose(top + np.array([-0.1, -0.15, 0.25]))
    stamp = Moves((Move(0.0, set_down, lift, pose(top), arrive=(0.0, 0.0, -0.15),
                        launch_mps2=2.0, halt_mps2=6.0),))  # fmt: skip
    end = set_down + 0.8 * performer.pace
    meetings = (
        Meeting(HAND, "stamp", stamp, (0.0, 0.0, 0.0), UP, figure.GRIP_DEPTH),
        Meeting("stamp", "box", stamp, (0.0, 0.0, 0.0), UP, 0.0, set_down, None),
    )
    truth = Truth(end, meetings, _steps("MoveObjTo", "TouchWith"), {HAND: (set_down,)})
    box = pose(top - np.array([0.0, 0.0, BOX[2]]))
    bodies = (
        *_held_stamp(performer, stamp),
        Body("box", Still(box), shapes.box(*BOX), TagType.FIXED, noisy=False),
    )
    return record(Script("touch_with", performer, truth, bodies), Sampling(**options))


def move_obj(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A block in the hand wipes over the table from the first frame to the last: MoveObj."""
    end = 1.2 * performer.pace
    begin = np.array([0.45, 0.1 + performer.aside_m, performer.table_m])
    goal = pose(begin + np.array([0.1, -0.4, 0.0]))
    stamp = Moves((Move(0.0, end, pose(begin), goal, launch_mps2=2.0, halt_mps2=2.0),))
    meetings = (
        Meeting(HAND, "stamp", stamp, (0.0, 0.0, 0.0), UP, figure.GRIP_DEPTH),
        Meeting("stamp", "table", stamp, (0.0, 0.0, 0.0), UP),
    )
    truth = Truth(end, meetings, _steps("MoveObj"), {HAND: ()})
    bodies = (*_held_stamp(performer, stamp), _table(performer))
    return record(Script("move_obj", performer, truth, bodies), Sampling(**options))


def touch(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A flat hand lies on the table all along: Touch."""
    end = 1.0 * performer.pace
    hand = Still(_flat(performer))
    meeting = Meeting(HAND, "table", hand, _palm(performer), UP, figure.GRIP_DEPTH)
    truth = Truth(end, (meeting,), _steps("Touch"), {HAND: ()})
    bodies = (figure.hand_body(performer, HAND, hand), _table(performer))
    return record(Script("touch", performer, truth, bodies), Sampling(**options))


def move_obj_to(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A block in the hand is set down, and still held for a moment: MoveObjTo, TouchWith."""
    set_down = 1.0 * performer.pace
    goal = np.array([0.5, -0.1 + performer.aside_m, performer.table_m])
    lift = pose(goal + np.array([-0.1, -0.2, 0.3]))
    move = Move(
        0.0, set_down, lift, pose(goal), arrive=(0.0, 0.0, -0.2), launch_mps2=4.0, halt_mps2=6.0
    )
    stamp = Moves((move,))
    meetings = (
        Meeting(HAND, "stamp", stamp, (0.0, 0.0, 0.0), UP, figure.GRIP_DEPTH),
        Meeting("stamp", "table", stamp, (0.0, 0.0, 0.0), UP, 0.0, set_down, None),
    )
    steps = _steps("MoveObjTo", "TouchWith")
    truth = Truth(set_down + 0.3, meetings, steps, {HAND: (set_down,)})
    bodies = (*_held_stamp(performer, stamp), _table(performer))
    return record(Script("move_obj_to", performer, truth, bodies), Sampling(**options))


def resume_posture(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A hand that lay on the table at the start goes back at once: ResumePosture.

    The contact's true end, a few frames on, is a border in ``extended``; ``thesis`` sees its
    first crossing only, which is the first frame.
    """
    home = 1.1 * performer.pace
    back = figure.withdraw(
        performer,
        HAND,
        begin=_flat(performer),
        depart=(-0.05, 0.0, 0.25),
        start_s=0.0,
        end_s=home,
        launch_mps2=figure.GENTLE_MPS2,
    )
    hand = Moves((back,))
    meeting = Meeting(HAND, "table", hand, _palm(performer), UP, figure.GRIP_DEPTH, None, 0.0)
    steps: dict[str, dict[str, tuple[str, ...]]] = {
        "thesis": {HAND: ("ResumePosture",)},
        "extended": {HAND: ("Touch", "ResumePosture")},
    }
    truth = Truth(home + 0.2, (meeting,), steps, {HAND: ()})
    bodies = (figure.hand_body(performer, HAND, hand), _table(performer))
    return record(Script("resume_posture", performer, truth, bodies), Sampling(**options))


def _palm(performer: Performer) -> tuple[float, float, float]:
    return (0.0, 0.0, -figure.thickness(performer))


def _flat(performer: Performer) -> RigidTransform:
    height = performer.table_m + figure.thickness(performer) - figure.GRIP_DEPTH
    return pose((0.5, -0.1 + performer.aside_m, height), aimed(x=(1.0, 0.0, 0.0), z=UP))


def _held_stamp(performer: Performer, stamp: Path) -> tuple[Body, Body]:
    """A block whose upper part is in the palm of a hand that is always with it."""
    aside = -STAMP[1] / 2.0 + figure.GRIP_DEPTH - figure.thickness(performer)
    grip = pose((0.0, aside, 0.115), aimed(x=(1.0, 0.0, 0.0), z=(0.0, -1.0, 0.0)))
    hand = Riding(stamp, stamp, grip, 0.0)
    return (
        figure.hand_body(performer, HAND, hand),
        Body("stamp", stamp, shapes.box(*STAMP), TagType.MOBILE, mass_kg=0.3),
    )


def _table(performer: Performer) -> Body:
    place = Still(pose((0.75, 0.0, performer.table_m)))
    return Body("table", place, shapes.table(0.8, 1.6), TagType.FIXED, noisy=False)


def _steps(*names: str) -> dict[str, dict[str, tuple[str, ...]]]:
    return {profile: {HAND: names} for profile in PROFILES}
