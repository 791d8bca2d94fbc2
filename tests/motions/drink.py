"""DrinkFromMug (thesis 5.2.1): reach, bring to the mouth, drink, put down, let go, return."""

from typing import Unpack

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.capture import Purpose, TagType
from motions import figure, shapes
from motions.paths import Move, Moves, Path, Riding, Still, aimed, pose
from motions.performers import Performer
from motions.trials import Body, Meeting, Options, Sampling, Script, Trial, Truth, record

STEPS = ("Reach", "MoveObjTo", "MoveObj", "MoveObjTo", "TouchWith", "ResumePosture")
PUBLISHED_SHARES = (0.445274, 0.171642, 0.0472637, 0.121891, 0.0472637, 0.179104)

PURPOSES = (
    Purpose("PickUp", action="Reach"),
    Purpose("Drink", goal="head"),
    Purpose("PutDown", action="MoveObjTo", goal="table"),
    Purpose("Release"),
)
"""What each step is done for (thesis 4.6.2)."""

REACH_S = 1.2
LAST_S = 0.062
LET_GO_MPS2 = 9.0
SIP_DEPTH = 0.001

STANDING = Rotation.from_rotvec([0.0, 0.0, np.radians(-15.0)])
"""How the mug stands: its handle to the right, and a little towards the person."""

DRUNK = Rotation.from_rotvec([0.0, 0.0, np.radians(35.0)])
"""How it is turned at the mouth: its handle to the right, and away from the face."""

RIM = tuple(DRUNK.inv().apply((-shapes.MUG_RADIUS + 0.002, 0.0, shapes.MUG_HEIGHT)))
"""The place of the rim that lies at the mouth, in the mug's frame [m]."""

LEANT = np.radians(-8.0)
EMPTIED = np.radians(-50.0)


def drink_from_mug(performer: Performer, **options: Unpack[Options]) -> Trial:
    """One who stands at a table drinks from the mug on it; 3.9 s by the tall man.

    Only the woman could: the tall man's mouth is too high, the child's wrist turned too far
    (POSSIBLE.md).
    """
    grasp, mouth, sipped, down, release, done = _instants(performer)
    end = done + LAST_S
    table = (0.75, 0.0, performer.table_m)
    place = np.array([0.47, -0.10 + performer.aside_m, performer.table_m])
    looks = (
        (0.25, (place[0], place[1], place[2] + 0.07)),
        (grasp + 0.02, figure.ahead(performer)),
        (sipped + 0.03, (place[0], place[1], place[2] + 0.05)),
        (release + 0.1, figure.ahead(performer)),
    )
    head = figure.head_path(performer, looks)
    mug = Moves(_mug_moves(place, head, (grasp, mouth, sipped, down)))
    grip = _grip(performer)
    taken = mug.at(np.array([grasp]))[0] * grip
    left = mug.at(np.array([release]))[0] * grip
    own = Moves(
        (
            figure.reach(
                performer,
                "right_hand",
                goal=taken,
                arrive=(0.07, 0.27, -0.03),
                start_s=grasp - REACH_S * performer.pace**0.5,
                end_s=grasp,
                halt_mps2=figure.FIRM_MPS2,
            ),
            figure.withdraw(
                performer,
                "right_hand",
                begin=left,
                depart=(-0.07, -0.25, 0.04),
                start_s=release,
                end_s=done,
                launch_mps2=LET_GO_MPS2,
            ),
        )
    )
    hand = Riding(own, mug, grip, grasp, release)
    meetings = (
        Meeting("right_hand", "mug", hand, _fingertip(performer),
                tuple(STANDING.apply((0.0, -1.0, 0.0))),
                figure.GRIP_DEPTH, grasp, release),
        Meeting("mug", "table", mug, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.0, None, grasp),
        Meeting("mug", "table", mug, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.0, down, None),
        Meeting("mug", "head", mug, RIM, (1.0, 0.0, 0.0), SIP_DEPTH, mouth, sipped),
    )  # fmt: skip
    steps = {"thesis": {"right_hand": STEPS}, "extended": {"right_hand": STEPS}}
    truth = Truth(end, meetings, steps, {"right_hand": (grasp, mouth, sipped, down, release)})
    script = Script(
        "drink_from_mug",
        performer,
        truth,
        (
            figure.hand_body(performer, "right_hand", hand),
            figure.head_body(head, tag=TagType.SELF),
            Body("mug", mug, shapes.mug(), TagType.MOBILE, mass_kg=0.35),
            Body("table", Still(pose(table)), shapes.table(0.8, 1.6), TagType.FIXED, noisy=False),
        ),
        purposes=PURPOSES,
    )
    return record(script, Sampling(**options))


def _instants(performer: Performer) -> tuple[float, ...]:
    """When the mug is taken, at the mouth, emptied, put down and let go, and the hand home."""
    return tuple(
        float(each) for each in np.cumsum([1.708, 0.68, 0.182, 0.468, 0.182, 0.6]) * performer.pace
    )


def _grip(performer: Performer) -> RigidTransform:
    """``T_mug_hand``: the fingers point left and lie on the handle, the knuckles away."""
    fingertips = -shapes.HANDLE_REACH + figure.GRIP_DEPTH
    place = (figure.thickness(performer) / 2.0, fingertips - figure.length(performer) / 2.0, 0.09)
    return pose(place, aimed(x=(0.0, 1.0, 0.0), z=(1.0, 0.0, 0.0)))


def _fingertip(performer: Performer) -> tuple[float, float, float]:
    """Of the fingers' end the point that meets the outermost of the handle [m]."""
    below = shapes.HANDLE_HEIGHT - 0.09
    return (figure.length(performer) / 2.0, below, -figure.thickness(performer) / 2.0)


def _mug_moves(
    place: np.ndarray, head: Path, instants: tuple[float, float, float, float]
) -> tuple[Move, ...]:
    grasp, mouth, sipped, down = instants
    lips = head.at(np.array([mouth]))[0].apply(shapes.mouth() - np.array([SIP_DEPTH, 0.0, 0.0]))
    standing = pose(place, STANDING)
    first = _at_lips(lips, LEANT)
    last = _at_lips(lips, EMPTIED)
    return (
        Move(grasp, mouth, standing, first, depart=(0.0, 0.0, 0.18), arrive=(-0.16, 0.0, 0.06),
             launch_mps2=12.0, halt_mps2=12.0),
        Sip(mouth, sipped, first, last),
        Move(sipped, down, last,
             pose(place + np.array([0.015, -0.02, 0.0]), STANDING),
             depart=(0.17, 0.0, -0.02), arrive=(0.0, 0.0, -0.18), launch_mps2=12.0, halt_mps2=12.0),
    )  # fmt: skip


def _at_lips(lips: np.ndarray, lean_rad: float) -> RigidTransform:
    rotation = Rotation.from_rotvec([0.0, lean_rad, 0.0]) * DRUNK
    return pose(lips - rotation.apply(RIM), rotation)


class Sip(Move):
    """A turn of the mug about the place of its rim that lies at the mouth."""

    def at(self, times: np.ndarray) -> RigidTransform:
        """``T_world_mug`` at each time [s]."""
        s = self.share(times)[:, None]
        turn = (self.begin.rotation.inv() * self.end.rotation).as_rotvec()
        rotation = self.begin.rotation * Rotation.from_rotvec(s * turn)
        lips = self.begin.apply(np.asarray(RIM))
        return RigidTransform.from_components(lips - rotation.apply(RIM), rotation)
