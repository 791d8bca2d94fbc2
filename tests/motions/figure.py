"""A standing person: where the hands hang, how they reach and return, and where the head looks."""

from collections.abc import Sequence

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.capture import Role, TagType
from motions import shapes
from motions.paths import Move, Moves, Path, Swaying, Vector, aimed, pose
from motions.performers import Performer
from motions.trials import Body

GRIP_DEPTH = 0.006
"""How far a hand's solid lies inside what it holds, as skin gives way [m]."""

EYE = (shapes.HEAD[0] + 0.002, 0.0, 0.03)
"""Between the eyes, in front of the head [m]."""

LOOK_S = 0.45
"""How long the head takes to turn to something [s]."""

GENTLE_MPS2 = 6.0
"""How hard the hand is stopped by what it touches, and lets go of it [m/s^2]."""

FIRM_MPS2 = 8.0
"""The same for what it takes to move at once [m/s^2]."""

Look = tuple[float, Vector]
"""When the head begins to turn [s], and the place that it then looks at [m]."""


def side(hand: str) -> float:
    """The sign of the y axis at that hand."""
    return 1.0 if hand.startswith("left") else -1.0


def thickness(performer: Performer) -> float:
    """Of the hand [m]."""
    return shapes.HAND[2] * performer.size


def length(performer: Performer) -> float:
    """Of the hand [m]."""
    return shapes.HAND[0] * performer.size


def hanging(performer: Performer, hand: str) -> RigidTransform:
    """The hand of one who stands and has not begun: fingers down, back outward."""
    out = side(hand)
    place = (0.02, out * 0.15 * performer.stature_m, 0.47 * performer.stature_m)
    return pose(place, aimed(x=(0.0, 0.0, -1.0), z=(0.0, out, 0.0)))


def reach(
    performer: Performer,
    hand: str,
    *,
    goal: RigidTransform,
    arrive: Vector,
    start_s: float,
    end_s: float,
    halt_mps2: float = GENTLE_MPS2,
) -> Move:
    """From hanging to a goal, reached along ``arrive`` [m], in the performer's way."""
    begin = hanging(performer, hand)
    rise = float(goal.translation[2] - begin.translation[2]) + performer.rise_m
    depart = (-0.05, side(hand) * performer.swing_m, 0.85 * rise)
    return Move(start_s, end_s, begin, goal, depart=depart, arrive=arrive, halt_mps2=halt_mps2)


def withdraw(
    performer: Performer,
    hand: str,
    *,
    begin: RigidTransform,
    depart: Vector,
    start_s: float,
    end_s: float,
    launch_mps2: float = GENTLE_MPS2,
) -> Move:
    """Back to a posture like the first one, leaving along ``depart`` [m]."""
    end = hanging(performer, hand)
    end = pose(end.translation + np.array([0.02, 0.01 * side(hand), 0.01]), end.rotation)
    drop = float(begin.translation[2] - end.translation[2]) + performer.rise_m
    arrive = (-0.05, -side(hand) * performer.swing_m, -0.85 * drop)
    return Move(
        start_s,
        end_s,
        begin,
        end,
        depart=depart,
        arrive=arrive,
        launch_mps2=launch_mps2,
    )


def head_path(performer: Performer, looks: Sequence[Look]) -> Path:
    """The head of one who looks ahead, then at one place after the other, and sways."""
    place = np.array([0.06, 0.0, performer.stature_m - shapes.HEAD[2]])
    ahead = pose(place)
    moves = [Move(0.0, 0.01, ahead, ahead)]
    for start, target in looks:
        moves.append(Move(start, start + LOOK_S, moves[-1].end, facing(place, target)))
    return Swaying(Moves(tuple(moves)), performer.sway_m)


def facing(place: np.ndarray, target: Vector) -> RigidTransform:
    """The head's pose whose line of sight from between the eyes meets the target."""
    eye, rotation = place, Rotation.identity()
    for _ in range(20):
        rotation = aimed(x=np.asarray(target) - eye, z=(0.0, 0.0, 1.0))
        eye = place + rotation.apply(EYE)
    return pose(place, rotation)


def ahead(performer: Performer) -> Vector:
    """A far place at the height of the eyes [m]."""
    return (10.0, 0.0, performer.stature_m - shapes.HEAD[2] + EYE[2])


def hand_body(performer: Performer, name: str, path: Path) -> Body:
    """The hand as an acting sensor."""
    return Body(name, path, shapes.hand(performer.size), link=f"{name.removesuffix('_hand')}_arm")


def head_body(path: Path, *, tag: TagType | None = None) -> Body:
    """The head as a sensor that attends, and, with a tag, as an object too."""
    return Body("head", path, shapes.head(), tag, "neck", Role.ATTENDS, EYE)
