"""What changes from one body and stance to another: hands, eyes and the posture at rest."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.body.scripts import SIDES
from capar.body.skeleton import eyes_between
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver
from capar.regeneration.sources import HandFrame, Source, body_hand_frame


@dataclass(frozen=True, eq=False)
class BodyFrames:
    """A body where it stands: its hands and eyes at ease."""

    human: Human
    hands: Mapping[str, HandFrame]
    """By side, in the frame of the hand's segment."""

    palms: Mapping[str, RigidTransform]
    """``T_hand_palm`` by side, from the frame on the hand."""

    rest: Mapping[str, RigidTransform]
    """``T_world_hand`` by side when standing at ease."""

    eyes: RigidTransform
    """``T_world_eyes`` of the standing body, looking ahead."""


def body_frames(human: Human, scene: Scene) -> BodyFrames:
    """The frames of a body that stands at ease in a scene."""
    solver = Solver(human, (*scene.place, scene.floor_m), scene.heading)
    hands = {side: body_hand_frame(human, side) for side in SIDES}
    palms = {}
    for side, frame in hands.items():
        site = human.model.site(f"{side}_palm")
        turn = Rotation.from_quat(site.quat, scalar_first=True)
        palms[side] = frame.pose.inv() * RigidTransform.from_components(site.pos, turn)
    rest = {side: solver.palm(side) * palms[side].inv() for side in SIDES}
    turn = Rotation.from_euler("z", scene.heading)
    spot = np.array([*scene.place, scene.floor_m]) + turn.apply(eyes_between(human.measures))
    return BodyFrames(human, hands, palms, rest, RigidTransform.from_components(spot, turn))


def rest_pose(
    source: Source, old: BodyFrames, new: BodyFrames, side: str, frame: int
) -> RigidTransform:
    """Where a hand that was free at a frame is on the new body: as far from ease as it was."""
    away = old.rest[side].inv() * source.hands[side].path[frame]
    return new.rest[side] * _enlarged(away, _ratio(old, new))


def free_pose(
    source: Source,
    old: BodyFrames,
    new: BodyFrames,
    side: str,
    frames: tuple[int, int],
    held: RigidTransform | None,
) -> RigidTransform:
    """Where a hand that was free at the first frame is, holding something at the second, if so.

    As far from ease as it was, or from where it takes the object or lets it go, if it was nearer to
    that: a recording may begin when the hand is about to arrive.
    """
    free, holding = (source.hands[side].path[frame] for frame in frames)
    gone, at_ease = free.translation - holding.translation, old.rest[side].translation
    if held is None or np.linalg.norm(gone) >= np.linalg.norm(free.translation - at_ease):
        return rest_pose(source, old, new, side, frames[0])
    ahead = (new.eyes * old.eyes.inv()).rotation
    turned = ahead * free.rotation * holding.rotation.inv() * ahead.inv() * held.rotation
    spot = held.translation + _ratio(old, new) * ahead.apply(gone)
    return RigidTransform.from_components(spot, turned)


def head_path(source: Source, old: BodyFrames, new: BodyFrames) -> RigidTransform:
    """The eyes' path on the new body: as far from standing as they were."""
    away = old.eyes.inv() * source.eyes
    return new.eyes * _enlarged(away, _ratio(old, new))


def head_ratio(old: BodyFrames, new: BodyFrames) -> Float[np.ndarray, "3"]:
    """How much larger the new head is along the eyes' axes [1]."""
    names = ("head_length", "head_breadth")
    flat = [new.human.measures[name] / old.human.measures[name] for name in names]
    return np.array([*flat, _ratio(old, new)])


def _ratio(old: BodyFrames, new: BodyFrames) -> float:
    return new.human.measures["stature"] / old.human.measures["stature"]


def _enlarged(pose: RigidTransform, factor: float) -> RigidTransform:
    return RigidTransform.from_components(pose.translation * factor, pose.rotation)
