"""TouchFromRest, TouchCycle and SlideObject (thesis 5.2.2, 5.2.3): a box on a table."""

from typing import Unpack

import numpy as np
from scipy.spatial.transform import RigidTransform

from capar.model.capture import TagType
from motions import figure, shapes
from motions.paths import Move, Moves, Path, Riding, Still, aimed, pose
from motions.performers import Performer
from motions.trials import Body, Meeting, Options, Sampling, Script, Trial, Truth, record

BOX = (0.22, 0.16, 0.12)
STAND_S = 0.3
REACH_S = 1.5
HAND = "right_hand"


def touch_from_rest(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A flat hand is laid on a box and stays there."""
    touched = REACH_S * performer.pace
    end = touched + 1.1 * performer.pace
    hand = Moves((_lay(performer, touched),))
    meeting = _on_box(performer, hand, touched, None)
    truth = Truth(end, (meeting, _resting(performer)), _steps("Reach", "Touch"), {HAND: (touched,)})
    script = Script("touch_from_rest", performer, truth, _bodies(performer, hand, touched, end))
    return record(script, Sampling(**options))


def touch_cycle(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A flat hand is laid on a box for a while and goes back."""
    touched = REACH_S * performer.pace
    leaves = touched + 0.6 * performer.pace
    home = leaves + 1.1 * performer.pace
    laid = _lay(performer, touched)
    back = figure.withdraw(
        performer, HAND, begin=laid.end, depart=(-0.04, 0.0, 0.27), start_s=leaves, end_s=home
    )
    hand = Moves((laid, back))
    meeting = _on_box(performer, hand, touched, leaves)
    truth = Truth(
        home + 0.2,
        (meeting, _resting(performer)),
        _steps("Reach", "Touch", "ResumePosture"),
        {HAND: (touched, leaves)},
    )
    script = Script("touch_cycle", performer, truth, _bodies(performer, hand, touched, leaves))
    return record(script, Sampling(**options))


def slide_object(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A palm is set against a box and at once slides it over the table, to the end."""
    pushed = REACH_S * performer.pace
    end = pushed + 0.7 * performer.pace
    standing = _standing(performer)
    goal = pose(standing.translation + np.array([0.34, 0.03, 0.0]))
    box = Moves((Move(pushed, end + 0.02, standing, goal, launch_mps2=8.0, halt_mps2=3.0),))
    grip = _palm_against(performer)
    reach = figure.reach(
        performer, HAND, goal=standing * grip, arrive=(0.3, 0.0, -0.03), start_s=STAND_S,
        end_s=pushed, halt_mps2=figure.FIRM_MPS2,
    )  # fmt: skip
    hand = Riding(Moves((reach,)), box, grip, pushed)
    palm = (0.0, 0.0, -figure.thickness(performer))
    meeting = Meeting(HAND, "box", hand, palm, (-1.0, 0.0, 0.0), figure.GRIP_DEPTH, pushed, None)
    truth = Truth(
        end, (meeting, _resting(performer)), _steps("Reach", "MoveObj"), {HAND: (pushed,)}
    )
    bodies = _bodies(performer, hand, pushed, end, box=box)
    script = Script("slide_object", performer, truth, bodies)
    return record(script, Sampling(**options))


def _standing(performer: Performer) -> RigidTransform:
    return pose((0.55, -0.12 + performer.aside_m, performer.table_m))


def _lay(performer: Performer, touched: float) -> Move:
    """A hand comes from above to lie on the box, the palm down."""
    height = BOX[2] - figure.GRIP_DEPTH + figure.thickness(performer)
    place = _standing(performer).translation + np.array([-0.04, 0.0, height])
    goal = pose(place, aimed(x=(1.0, 0.0, 0.0), z=(0.0, 0.0, 1.0)))
    return figure.reach(
        performer, HAND, goal=goal, arrive=(0.06, 0.0, -0.3), start_s=STAND_S, end_s=touched
    )


def _palm_against(performer: Performer) -> RigidTransform:
    """``T_box_hand``: the fingers point up and the palm lies on the side towards the person."""
    behind = -BOX[0] / 2.0 + figure.GRIP_DEPTH - figure.thickness(performer)
    return pose((behind, 0.0, 0.14), aimed(x=(0.0, 0.0, 1.0), z=(-1.0, 0.0, 0.0)))


def _on_box(performer: Performer, hand: Path, touched: float, leaves: float | None) -> Meeting:
    palm = (0.0, 0.0, -figure.thickness(performer))
    return Meeting(HAND, "box", hand, palm, (0.0, 0.0, 1.0), figure.GRIP_DEPTH, touched, leaves)


def _resting(performer: Performer) -> Meeting:
    return Meeting("box", "table", Still(_standing(performer)), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))


def _steps(*names: str) -> dict[str, dict[str, tuple[str, ...]]]:
    return {profile: {HAND: names} for profile in ("thesis", "extended")}


def _bodies(
    performer: Performer, hand: Path, touched: float, leaves: float, *, box: Path | None = None
) -> tuple[Body, ...]:
    standing = _standing(performer)
    x, y, z = standing.translation
    looks = ((0.2, (x, y, z + 0.08)), (leaves + 0.1, figure.ahead(performer)))
    table = pose((0.75, 0.0, performer.table_m))
    return (
        figure.hand_body(performer, HAND, hand),
        figure.head_body(figure.head_path(performer, looks)),
        Body("box", box or Still(standing), shapes.box(*BOX), TagType.MOBILE, mass_kg=0.6),
        Body("table", Still(table), shapes.table(0.8, 1.6), TagType.FIXED, noisy=False),
    )
