"""A can that lies on a table is rolled away over it, under a flat hand."""

from dataclasses import dataclass
from typing import Unpack

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.capture import TagType
from motions import figure, shapes
from motions.paths import Move, Moves, Path, Riding, Still, aimed, pose
from motions.performers import Performer
from motions.trials import Body, Meeting, Options, Sampling, Script, Trial, Truth, record

CAN = (0.045, 0.14)
"""Radius and length [m]."""

WAY_M = 0.1
"""How far the can rolls; a hand that does not slip on it goes twice as far [m]."""

HAND = "right_hand"
UP = (0.0, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class Rolling:
    """A body of a radius whose middle follows a way along x, and turns without slipping."""

    middle: Path
    radius_m: float

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        place = self.middle.at(times).translation
        angle = (place[:, 0] - place[0, 0]) / self.radius_m
        turn = Rotation.from_rotvec(angle[:, None] * np.array([0.0, 1.0, 0.0]))
        return RigidTransform.from_components(place, turn)


def roll_object(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A flat hand is laid on a can and at once rolls it over the table, to the end."""
    touched = 1.5 * performer.pace
    end = touched + 0.8 * performer.pace
    begin = np.array([0.5, -0.12 + performer.aside_m, performer.table_m + CAN[0]])
    middle = Moves((_along(begin, WAY_M, touched, end),))
    height = CAN[0] - figure.GRIP_DEPTH + figure.thickness(performer)
    laid = pose(begin + np.array([-0.05, 0.0, height]), aimed(x=(1.0, 0.0, 0.0), z=UP))
    reach = figure.reach(
        performer, HAND, goal=laid, arrive=(0.06, 0.0, -0.3), start_s=0.1, end_s=touched,
        halt_mps2=figure.FIRM_MPS2,
    )  # fmt: skip
    rest = pose((0.0, 0.0, 0.0), laid.rotation)
    follows = Moves((_along(laid.translation, 2.0 * WAY_M, touched, end),))
    hand = Riding(Moves((reach,)), follows, rest, touched)
    palm = (0.0, 0.0, -figure.thickness(performer))
    meetings = (
        Meeting(HAND, "can", hand, palm, UP, figure.GRIP_DEPTH, touched, None),
        Meeting("can", "table", Still(pose(begin)), (0.0, 0.0, -CAN[0]), UP),
    )
    steps = {"thesis": {HAND: ("Reach", "MoveObj")}, "extended": {HAND: ("Reach", "Roll")}}
    bodies = (
        figure.hand_body(performer, HAND, hand),
        Body("can", Rolling(middle, CAN[0]), shapes.roller(*CAN), TagType.MOBILE, mass_kg=0.4),
        Body(
            "table", Still(pose((0.75, 0.0, performer.table_m))), shapes.table(0.8, 1.6),
            TagType.FIXED, noisy=False,
        ),
    )  # fmt: skip
    truth = Truth(end, meetings, steps, {HAND: (touched,)})
    return record(Script("roll_object", performer, truth, bodies), Sampling(**options))


def _along(begin: np.ndarray, way_m: float, start_s: float, end_s: float) -> Move:
    """A straight way along x, set off at once."""
    goal = pose(begin + np.array([way_m, 0.0, 0.0]))
    return Move(start_s, end_s + 0.02, pose(begin), goal, launch_mps2=1.5, halt_mps2=1.0)
