"""How the new hand lies on the new object: the same points touch, turned as little as may be."""

import itertools
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.recording import HAND_SEGMENTS
from capar.body.virtual_scenes import Thing
from capar.model.capture import Shape
from capar.regeneration.body_frames import BodyFrames
from capar.regeneration.collisions import Surroundings
from capar.regeneration.goals import TOUCH_M, touching_shift
from capar.regeneration.holds import led_holds, usual_pose
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver
from capar.regeneration.sources import Hold, Source, contact_points, hand_surface

YAWS = (0.0, 0.2, -0.2, 0.4, -0.4, 0.6, -0.6, 0.8, -0.8, 1.05, -1.05)
"""Turns about the axis of a round object that are tried, outwards positive [rad]."""

PITCHES = (0.0, 0.15, -0.15, 0.3, -0.3, 0.5, -0.5)
"""Turns about the normal of the palm that are tried [rad]."""

TILTS = (0.0, -0.1, 0.1, -0.2, 0.2, 0.3)
"""Turns across the palm, fingers to the object positive, that are tried [rad]."""

DRAWN_M, DRAWN_TILTS = (0.03, 0.06, 0.09, 0.12), (0.0, -0.2, 0.2)
"""How far a hand is drawn back along its fingers, so that its forearm leaves the object [m], and
the turns across the palm that are tried with each [rad]."""

PITCH_WEIGHT, TILT_WEIGHT = 2.0, 4.0
"""How much worse these turns are than one about a round object [1]."""

OUT_M = 0.1  # How far a recorded hand is brought to the surface of what it holds at most [m].

LOOSE_M = 0.003
"""A hand that is then farther off its surface or deeper inside does not take it [m]."""

CLEAR_M = 0.014  # How far a hand stays above what the object stands on, if it did so before [m].
ROUND_SHARE = 0.02  # Largest deviation of a round object's radius [1].


@dataclass(frozen=True)
class Turn:
    """How far a grip is turned from the recorded one."""

    yaw: float = 0.0
    """About the axis of a round object [rad]."""

    pitch: float = 0.0
    """About the normal of the palm [rad]."""

    tilt: float = 0.0
    """Across the palm, the fingers towards the object [rad]."""

    drawn_m: float = 0.0
    """How far the hand is drawn back along its fingers [m]."""


@dataclass(frozen=True, eq=False)
class Grip:
    """Where a hand lies on an object."""

    hold: Hold
    pose: RigidTransform
    """``T_thing_hand``, the frame on the hand."""

    turn: Turn
    raised_m: float
    """How far it was raised to stay clear of what the object stands on [m]."""

    out_m: float = 0.0
    """How far it was moved off the object so that it just touches; negative towards it [m]."""

    gap_m: float = 0.0
    """How far the hand is from the object then, negative inside: none where it touches [m]."""

    beside: str = ""
    """By which other object the hand is led that it holds besides; empty where it is this one."""

    beyond_m: float = 0.0
    """How far the middle of either of two objects that are held together is past the edge of the
    hand [m]."""

    @property
    def missed_m(self) -> float:
        """How much too far the hand is from where it would hold the object [m]."""
        return max(abs(self.gap_m), LOOSE_M + self.beyond_m if self.beyond_m > 0.0 else 0.0)


def turns(thing: Thing) -> list[Turn]:
    """The turns to try on an object, the smallest first."""
    yaws = YAWS if is_round(thing.shape) else YAWS[:1]
    found = [Turn(yaw, pitch) for yaw in yaws for pitch in PITCHES]
    found += [Turn(0.0, pitch, tilt) for pitch in PITCHES for tilt in TILTS[1:]]

    def size(turn: Turn) -> float:
        return abs(turn.yaw) + PITCH_WEIGHT * abs(turn.pitch) + TILT_WEIGHT * abs(turn.tilt)

    return sorted(found, key=size)


def drawn_turns() -> list[Turn]:
    """What is tried where an arm would be inside what its hand takes: nearer the fingertips."""
    return [Turn(tilt=tilt, drawn_m=drawn_m) for drawn_m in DRAWN_M for tilt in DRAWN_TILTS]


def is_round(shape: Shape) -> bool:
    """Whether a shape's outline from above is a circle about its z axis."""
    hull = trimesh.convex.convex_hull(np.array(shape.vertices))
    radii = np.linalg.norm(hull.vertices[:, :2], axis=1)
    outer = radii[radii > 0.5 * radii.max()]
    return len(outer) >= 16 and bool(np.ptp(outer) < ROUND_SHARE * radii.max())


class Gripping:
    """Grips of one body on the objects of one scene."""

    def __init__(self, source: Source, scene: Scene, old: BodyFrames, new: BodyFrames) -> None:
        self.source, self.scene, self.new = source, scene, new
        self.around = Surroundings(new.human, scene)
        self.posture = Solver(new.human, (*scene.place, scene.floor_m), scene.heading).rest
        self.shapes: dict[str, tuple[Shape, Shape]] = {}
        """The recorded hand's surface and the new one's by side, each in the frame on it."""

        for side, track in source.hands.items():
            recorded = source.capture.sensor(track.sensor).shape
            assert recorded is not None  # checked when the source was made
            own = hand_surface(new.human, side)
            self.shapes[side] = (
                _seen_from(track.frame.pose, recorded), _seen_from(new.hands[side].pose, own)
            )  # fmt: skip
        holds = led_holds(source.holds, source.co_held)
        self.recorded = {hold: self._recorded(hold) for hold in holds}

    def grips(self, holds: Iterable[Hold], turn: Turn) -> list[Grip]:
        """Grips of some holds, and of what these hands hold besides."""
        return self.with_co_held([self.grip(hold, turn) for hold in holds])

    def grip(self, hold: Hold, turn: Turn) -> Grip:
        """The recorded grip in the new measures, turned, touching, and clear of the support."""
        relative, on_hand, on_thing = self.recorded[hold]
        old, new = self.source.scene, self.scene
        before, after = old.thing(hold.thing), new.thing(hold.thing)
        extents = self.source.hands[hold.side].frame.extents
        point = on_hand * self.new.hands[hold.side].extents / extents
        spot = on_thing * after.size / np.maximum(before.size, 1e-9)
        gap = relative.apply(on_hand) - on_thing
        turned = relative.rotation * Rotation.from_euler("ZY", [turn.pitch, turn.tilt])
        pose = RigidTransform.from_components(spot + gap - turned.apply(point), turned)
        if is_round(after.shape):  # it is gripped as seen from where the performer faces
            facing = (new.heading - after.heading) - (old.heading - before.heading)
            outwards = -turn.yaw if hold.side == "right" else turn.yaw
            about = Rotation.from_euler("z", facing + outwards)
            pose = RigidTransform.from_rotation(about) * pose
        pose = pose * RigidTransform.from_translation([-turn.drawn_m, 0.0, 0.0])
        raised = 0.0
        if new.support(hold.thing):  # what the hand stays clear of, if it did so before
            above, now = (
                float(at.apply(np.array(shape.vertices))[:, 2].min() - thing.shape.bounds[0, 2])
                for at, shape, thing in zip(
                    (relative, pose), self.shapes[hold.side], (before, after), strict=True
                )
            )
            raised = max(0.0, min(CLEAR_M, above) - now)
        pose = RigidTransform.from_translation([0.0, 0.0, raised]) * pose
        held = [(hold, RigidTransform.identity())]
        beside = (one.hold for one in self.source.co_held if one.lead == hold)
        held += [(one, self._seat(one.thing, hold.thing).inv()) for one in beside]
        out = touching_shift(
            lambda by_m: min(self._gap(one, seat * pose, by_m) for one, seat in held), OUT_M
        )
        left_m = self._gap(hold, pose, out) - TOUCH_M
        pose = pose * RigidTransform.from_translation([0.0, 0.0, -out])
        return Grip(hold, pose, turn, raised, out, left_m)

    def with_co_held(self, grips: list[Grip]) -> list[Grip]:
        """The same, with how these hands lie on what they hold besides."""
        out = list(grips)
        for grip, pair in itertools.product(grips, self.source.co_held):
            if pair.lead == grip.hold:
                seat = self._seat(pair.hold.thing, grip.hold.thing)
                pose = seat.inv() * grip.pose
                gap = self._gap(pair.hold, pose, 0.0) - TOUCH_M
                beyond = self._beyond(grip, seat, pair.hold.thing)
                beside = grip.hold.thing
                out.append(
                    replace(
                        grip, hold=pair.hold, pose=pose, gap_m=gap, beside=beside, beyond_m=beyond
                    )
                )
        return out

    def _seat(self, name: str, lead: str) -> RigidTransform:
        """``T_lead_thing`` as they stand."""
        return self.scene.thing(lead).pose.inv() * self.scene.thing(name).pose

    def _beyond(self, grip: Grip, seat: RigidTransform, name: str) -> float:
        """How far the middle of either object is past the edge of the hand [m].

        Along the line on which they lie beside each other, in the plane of the palm.
        """
        local = grip.pose.inv()
        middle = local.apply(seat.apply(self.scene.thing(name).shape.bounds.mean(axis=0)))
        first = local.apply(self.scene.thing(grip.hold.thing).shape.bounds.mean(axis=0))
        along = (middle - first) * [1.0, 1.0, 0.0]
        along /= max(float(np.linalg.norm(along)), 1e-9)
        own = np.array(self.shapes[grip.hold.side][1].vertices) @ along
        return float(max(middle @ along - own.max(), own.min() - first @ along))

    def _recorded(
        self, hold: Hold
    ) -> tuple[RigidTransform, Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
        """``T_thing_hand`` and the middle of the contact on the hand's frame and on the object."""
        relative = recorded_grip(self.source, hold)
        thing = self.source.scene.thing(hold.thing).shape
        return relative, *contact_points(self.shapes[hold.side][0], thing, relative.inv())

    def _gap(self, hold: Hold, pose: RigidTransform, by_m: float) -> float:
        """How far a hand is from an object when it is moved so far against its palm [m]."""
        names = [f"{hold.side}_{each}" for each in HAND_SEGMENTS]
        away = pose * RigidTransform.from_translation([0.0, 0.0, -by_m])
        self.around.pose(self.posture, {hold.thing: self.new.rest[hold.side] * away.inv()})
        found = (p.distance_m for p in self.around.near(names) if p.thing == hold.thing)
        return min(found, default=1.0)


def recorded_grip(source: Source, hold: Hold) -> RigidTransform:
    """``T_thing_hand`` as it was recorded, in the median of the hold."""
    part = slice(hold.first, hold.last + 1)
    return usual_pose(source.paths[hold.thing][part].inv() * source.hands[hold.side].path[part])


def _seen_from(frame: RigidTransform, shape: Shape) -> Shape:
    return Shape(frame.inv().apply(np.array(shape.vertices)), np.array(shape.faces))
