"""One hand takes a block from a table and does one thing with it after the other."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Unpack

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.capture import Shape, TagType
from motions import figure, shapes
from motions.paths import Move, Moves, Path, Riding, Still, Vector, aimed, pose
from motions.performers import Performer
from motions.trials import Body, Options, Sampling, Script, Trial, Truth, record

HAND = "right_hand"
BLOCK = (0.06, 0.06, 0.18)
REACH_S, PAUSE_S, HOME_S, REST_S = 1.4, 0.5, 1.2, 0.8
SWING_HZ = 2.0

ASIDE = aimed(x=(1.0, 0.0, 0.0), z=(0.0, -1.0, 0.0))
"""A palm on the right side of a thing, its fingers forward."""


@dataclass(frozen=True, eq=False)
class Swung:
    """A path with a swing to and fro on top of it, which grows and fades smoothly."""

    own: Path
    reach: Vector
    start_s: float
    end_s: float

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        ramp = np.clip(np.minimum(times - self.start_s, self.end_s - times) * SWING_HZ, 0.0, 1.0)
        wave = np.sin(2.0 * np.pi * SWING_HZ * (times - self.start_s)) * np.sin(ramp * np.pi / 2)
        own = self.own.at(times)
        return RigidTransform.from_components(
            own.translation + wave[:, None] * np.asarray(self.reach), own.rotation
        )


@dataclass(frozen=True)
class Leg:
    """One motion of the thing, and a pause after it."""

    by: Vector = (0.0, 0.0, 0.0)
    """How far it goes [m]."""

    turn: Vector = (0.0, 0.0, 0.0)
    """How it turns about its own axes [rad]."""

    seconds: float = 0.9
    swing: Vector | None = None
    """How far it swings to and fro instead [m]."""

    pause: bool = True


@dataclass(frozen=True, eq=False)
class Stage:
    """What the thing is, how it is gripped, and what else there is."""

    thing: Shape
    grip: RigidTransform
    """``T_thing_hand``."""

    others: tuple[Body, ...] = ()
    held: bool = False
    """Whether the hand has it from the first frame to the last."""

    height_m: float = 0.0
    """How high above the table it begins [m]."""

    kind: str = "block"
    """What the thing is."""


def handle(
    performer: Performer,
    name: str,
    legs: Sequence[Leg],
    steps: Sequence[str],
    stage: Stage | None = None,
    **options: Unpack[Options],
) -> Trial:
    """Reach, hold, the legs with pauses between them, hold, let go, and rest."""
    scene = stage or Stage(shapes.box(*BLOCK), beside(performer))
    begin = place(performer, scene.height_m)
    taken = 0.0 if scene.held else REACH_S * performer.pace
    thing, ready = _course(performer, begin, legs, taken + PAUSE_S)
    first, last = (thing.at(np.array([each]))[0] * scene.grip for each in (taken, ready))
    home = ready + (REST_S if scene.held else HOME_S * performer.pace + REST_S)
    hand: Path = Riding(Still(first), thing, scene.grip, 0.0)
    if not scene.held:
        away = scene.grip.rotation.apply((0.0, 0.0, 0.12))
        reach = figure.reach(
            performer, HAND, goal=first, arrive=tuple(-away), start_s=0.1, end_s=taken
        )
        back = figure.withdraw(
            performer, HAND, begin=last, depart=tuple(away), start_s=ready, end_s=home - REST_S
        )
        hand = Riding(Moves((reach, back)), thing, scene.grip, taken, ready)
    bodies = (
        figure.hand_body(performer, HAND, hand),
        Body("block", thing, scene.thing, TagType.MOBILE, mass_kg=0.5, kind=scene.kind),
        table(performer),
        *scene.others,
    )
    truth = Truth(home, (), {"extended": {HAND: tuple(steps)}}, {})
    return record(Script(name, performer, truth, bodies), Sampling(**options))


def place(performer: Performer, above_m: float = 0.0) -> RigidTransform:
    """Where the thing stands on the table, or above it."""
    return pose((0.5, -0.12 + performer.aside_m, performer.table_m + above_m))


def beside(performer: Performer) -> RigidTransform:
    """The palm lies on the block's right side."""
    return gripped(performer, (0.0, -1.0, 0.0), ASIDE)


def gripped(performer: Performer, side: Vector, rotation: Rotation) -> RigidTransform:
    """``T_block_hand`` where a palm lies on one of the block's sides."""
    out = BLOCK[0] / 2.0 - figure.GRIP_DEPTH + figure.thickness(performer)
    return pose(np.asarray(side) * out + np.array([0.0, 0.0, 0.12]), rotation)


def table(performer: Performer) -> Body:
    """The table, which stands fixed."""
    where = pose((0.75, 0.0, performer.table_m))
    return Body("table", Still(where), shapes.table(0.8, 1.6), TagType.FIXED, noisy=False)


def _course(
    performer: Performer, begin: RigidTransform, legs: Sequence[Leg], start_s: float
) -> tuple[Path, float]:
    """The thing's path, and when it has come to its end and was held there for a moment."""
    moves = [Move(0.0, 0.01, begin, begin)]
    swings, now = [], start_s
    for leg in legs:
        end = now + leg.seconds * performer.pace
        here = moves[-1].end
        there = pose(
            here.translation + np.asarray(leg.by), here.rotation * Rotation.from_rotvec(leg.turn)
        )
        moves.append(Move(now, end, here, there))
        if leg.swing:
            swings.append((leg.swing, now, end))
        now = end + PAUSE_S * leg.pause
    path: Path = Moves(tuple(moves))
    for reach, first, last in swings:
        path = Swung(path, reach, first, last)
    return path, now if legs[-1].pause else now + PAUSE_S
