"""PickUpWithBothHands (thesis 5.2.4): hold a box on the table, lift, lower, let go together."""

from collections.abc import Mapping
from typing import Unpack

import numpy as np
from scipy.spatial.transform import RigidTransform

from capar.model.capture import TagType
from motions import figure, shapes
from motions.paths import Move, Moves, Path, Riding, Still, aimed, pose
from motions.performers import Performer
from motions.trials import Body, Meeting, Options, Sampling, Script, Trial, Truth, record

BOX = (0.30, 0.36, 0.24)
HANDS = ("right_hand", "left_hand")
STAND_S = 0.3
UP = (0.0, 0.0, 1.0)

STEPS: Mapping[str, tuple[str, ...]] = {
    "thesis": ("Reach", "TouchWith", "MoveObj", "TouchWith", "ResumePosture"),
    "extended": ("Reach", "Touch", "MoveObj", "TouchWith", "ResumePosture"),
}
"""The published second step is MoveObj, by noise of the box; its author calls TouchWith right."""


def pick_up_with_both_hands(performer: Performer, **options: Unpack[Options]) -> Trial:
    """Both hands hold a box on the table, lift and lower it in one go, and let go together."""
    taken, lift, top, down, release, home = _instants(performer)
    standing = pose((0.52, 0.5 * performer.aside_m, performer.table_m))
    raised = pose(standing.translation + np.array([-0.05, 0.0, 0.22 * performer.stature_m]))
    lowered = pose(standing.translation + np.array([0.01, 0.01, 0.0]))
    box = Moves(
        (
            Move(
                lift, top, standing, raised, depart=(0.0, 0.0, 0.12), launch_mps2=2.5, halt_mps2=4.0
            ),
            Move(
                top, down, raised, lowered, arrive=(0.0, 0.0, -0.12), launch_mps2=4.0, halt_mps2=5.0
            ),
        )
    )
    hands = {name: _hand(performer, name, box, (taken, lift, release, home)) for name in HANDS}
    meetings = (
        *(_held(performer, name, path, taken, release) for name, path in hands.items()),
        Meeting("box", "table", box, (0.0, 0.0, 0.0), UP, 0.0, None, lift),
        Meeting("box", "table", box, (0.0, 0.0, 0.0), UP, 0.0, down, None),
    )
    truth = Truth(
        home + 0.2,
        meetings,
        {profile: dict.fromkeys(HANDS, steps) for profile, steps in STEPS.items()},
        dict.fromkeys(HANDS, (taken, lift, down, release)),
    )
    bodies = _bodies(performer, hands, box, standing, release)
    script = Script("pick_up_with_both_hands", performer, truth, bodies)
    return record(script, Sampling(**options))


def _instants(performer: Performer) -> tuple[float, ...]:
    """When the box is held, lifted, up, down again and let go, and the hands are home."""
    return tuple(
        float(each) for each in np.cumsum([1.5, 0.4, 0.62, 0.62, 0.3, 1.1]) * performer.pace
    )


def _grip(performer: Performer, name: str) -> RigidTransform:
    """``T_box_hand``: the fingers point away from the person and the palm lies on the side."""
    out = figure.side(name)
    aside = BOX[1] / 2.0 - figure.GRIP_DEPTH + figure.thickness(performer)
    return pose((-0.02, out * aside, 0.14), aimed(x=(1.0, 0.0, 0.0), z=(0.0, out, 0.0)))


def _hand(
    performer: Performer, name: str, box: Path, instants: tuple[float, float, float, float]
) -> Path:
    taken, lift, release, home = instants
    grip, out = _grip(performer, name), figure.side(name)
    first, last = (box.at(np.array([each]))[0] * grip for each in (lift, release))
    reach = figure.reach(
        performer, name, goal=first, arrive=(0.06, -0.28 * out, -0.02), start_s=STAND_S,
        end_s=taken,
    )  # fmt: skip
    back = figure.withdraw(
        performer, name, begin=last, depart=(-0.04, 0.26 * out, 0.02), start_s=release, end_s=home
    )
    return Riding(Moves((reach, back)), box, grip, lift, release)


def _held(performer: Performer, name: str, hand: Path, taken: float, release: float) -> Meeting:
    palm = (0.0, 0.0, -figure.thickness(performer))
    normal = (0.0, figure.side(name), 0.0)
    return Meeting(name, "box", hand, palm, normal, figure.GRIP_DEPTH, taken, release)


def _bodies(
    performer: Performer,
    hands: Mapping[str, Path],
    box: Path,
    standing: RigidTransform,
    release: float,
) -> tuple[Body, ...]:
    x, y, z = standing.translation
    looks = ((0.2, (x, y, z + 0.12)), (release + 0.1, figure.ahead(performer)))
    table = pose((0.75, 0.0, performer.table_m))
    return (
        *(figure.hand_body(performer, name, path) for name, path in hands.items()),
        figure.head_body(figure.head_path(performer, looks)),
        Body("box", box, shapes.box(*BOX), TagType.MOBILE, mass_kg=2.5),
        Body("table", Still(table), shapes.table(0.8, 1.6), TagType.FIXED, noisy=False),
    )
