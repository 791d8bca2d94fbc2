"""One hands a mug to another, who faces her: two people, each with a right hand that is watched."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.capture import Agent, Capture, TagType
from motions import figure, shapes
from motions.paths import Move, Moves, Path, Riding, Still, aimed, pose
from motions.performers import TALL_MAN, WOMAN, Performer
from motions.trials import Body, Meeting, Sampling, Script, Trial, Truth, record

GIVER, TAKER = WOMAN, TALL_MAN
GIVING, TAKING = "right_hand", "guest_hand"
MUG = (0.08, 0.08, 0.20)
"""A tall mug, wide enough for two palms, one at each side [m]."""

APART_M = 1.3
TAKEN_S, LIFTED_S, OFFERED_S, ACCEPTED_S, LEFT_S = 1.5, 1.9, 2.7, 3.3, 3.8
CARRIED_S, HOME_S, BACK_S, END_S = 4.3, 5.1, 5.0, 5.6
"""When the mug is taken, lifted, held out, accepted, let go, carried off and held again [s]."""

STEPS = {
    GIVING: ("Reach", "Touch", "Lift", "Touch", "HandOver"),
    TAKING: ("Accept", "Touch", "Carry", "Touch"),
}
"""By what the words mean; who rests before or afterwards does that too."""


@dataclass(frozen=True, eq=False)
class Facing:
    """The path of one who stands elsewhere and faces the other way."""

    own: Path

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        return opposite() * self.own.at(times)


def opposite() -> RigidTransform:
    """``T_world_person`` of the one who takes: in front of the giver, turned to her."""
    return pose((APART_M, 0.0, 0.0), Rotation.from_euler("z", np.pi))


def hand_over(*, taker: Agent | None = None) -> Trial:
    """She takes a mug from the table, holds it out, he takes it, she lets go, he carries it off.

    Args:
        taker: Whose the hand that takes is; None: another agent's than the one that gives.
    """
    standing = pose((0.5, 0.0, GIVER.table_m))
    offered = pose((0.62, 0.0, GIVER.table_m + 0.3))
    carried = pose((0.85, 0.02, GIVER.table_m + 0.32))
    mug = Moves(
        (
            Move(LIFTED_S, OFFERED_S, standing, offered, launch_mps2=3.0, halt_mps2=3.0),
            Move(CARRIED_S, HOME_S, offered, carried, launch_mps2=3.0, halt_mps2=3.0),
        )
    )
    giving = _giving(mug, standing, offered)
    taking = _taking(mug, offered)
    meetings = (
        _palm(GIVER, GIVING, giving, -1.0, TAKEN_S, LEFT_S),
        _palm(TAKER, TAKING, taking, 1.0, ACCEPTED_S, None),
        Meeting("mug", "table", mug, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.0, None, LIFTED_S),
    )
    truth = Truth(END_S, meetings, {"extended": STEPS}, {GIVING: (), TAKING: ()})
    table = pose((0.4, 0.0, GIVER.table_m))
    bodies = (
        figure.hand_body(GIVER, GIVING, giving),
        figure.hand_body(TAKER, TAKING, taking),
        Body("mug", mug, shapes.box(*MUG), TagType.MOBILE, mass_kg=0.4),
        Body("table", Still(table), shapes.table(0.5, 1.0), TagType.FIXED, noisy=False),
    )
    trial = record(Script("hand_over", GIVER, truth, bodies), Sampling())
    return Trial(_of_two(trial.capture, taker or TAKER.agent), truth)


def _of_two(capture: Capture, taker: Agent) -> Capture:
    """The capture with the second hand as another agent's right hand, or her own left one."""
    others = () if taker == capture.agent else (taker,)
    side = "right" if others else "left"
    sensors = tuple(
        replace(each, side=side, link=f"{side}_arm", agent=taker.name)
        if each.name == TAKING
        else each
        for each in capture.sensors
    )
    return replace(capture, sensors=sensors, others=others)


def _grip(performer: Performer, side: float) -> RigidTransform:
    """``T_mug_hand``: the palm on one side of the mug, the fingers away from the body."""
    aside = MUG[1] / 2.0 - figure.GRIP_DEPTH + figure.thickness(performer)
    ahead = (-side, 0.0, 0.0)
    return pose((side * 0.01, side * aside, 0.10), aimed(x=ahead, z=(0.0, side, 0.0)))


def _giving(mug: Path, standing: RigidTransform, offered: RigidTransform) -> Path:
    grip = _grip(GIVER, -1.0)
    reach = figure.reach(
        GIVER, GIVING, goal=standing * grip, arrive=(0.05, 0.2, 0.0), start_s=0.3, end_s=TAKEN_S
    )
    back = figure.withdraw(
        GIVER, GIVING, begin=offered * grip, depart=(-0.05, -0.2, 0.0), start_s=LEFT_S, end_s=BACK_S
    )
    return Riding(Moves((reach, back)), mug, grip, TAKEN_S, LEFT_S)


def _taking(mug: Path, offered: RigidTransform) -> Path:
    grip = _grip(TAKER, 1.0)
    goal = opposite().inv() * offered * grip
    reach = figure.reach(
        TAKER, TAKING, goal=goal, arrive=(0.05, 0.2, 0.0), start_s=2.0, end_s=ACCEPTED_S
    )
    return Riding(Facing(Moves((reach,))), mug, grip, ACCEPTED_S)


def _palm(
    performer: Performer, name: str, hand: Path, side: float, begin: float, end: float | None
) -> Meeting:
    palm = (0.0, 0.0, -figure.thickness(performer))
    return Meeting(name, "mug", hand, palm, (0.0, side, 0.0), figure.GRIP_DEPTH, begin, end)
